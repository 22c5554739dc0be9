/* body.h - bodies for the tests of the solid: a mesh of tests/meshes with its parameters, and small linear algebra on raw arrays.
 */
#ifndef BY_TEST_BODY_H
#define BY_TEST_BODY_H

#include "check.h"
#include "tled/tled.h"
#include <string.h>

/* path of a mesh beneath the source tree */
static inline const char *MeshPath(const char name[])
{
  static char path[PETSC_MAX_PATH_LEN];
  const char *source = getenv("BYSSUS_SOURCE");

  snprintf(path, sizeof path, "%s/%s", source ? source : ".", name);
  return path;
}

/* a created body, parameters set but not set up: the reference beam's material (E 3 MPa, rho 1000) */
static inline TLED NewBody(const char mesh[], TLEDParams **params)
{
  TLED tled;

  assert_petsc(TLEDCreate(PETSC_COMM_SELF, "body", &tled));
  assert_petsc(TLEDGetParams(tled, params));
  snprintf((*params)->mesh, sizeof(*params)->mesh, "%s", MeshPath(mesh));
  (*params)->elastic.young   = 3e6;
  (*params)->elastic.density = 1000.0;
  (*params)->elastic.poisson = 0.3;
  (*params)->element = TLED_ELEMENT_T4;
  return tled;
}

static inline void AddName(Names *names, const char name[]) { snprintf(names->name[names->n++], BY_NAME_MAX, "%s", name); }

/* set a vector to values of a function of the reference position */
static inline void SetVec(TLED tled, Vec vec, void (*value)(const PetscReal X[3], PetscReal out[3]))
{
  const PetscReal *X;
  PetscReal       *v;
  PetscInt         n;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(VecGetArrayWrite(vec, &v));
  for (PetscInt a = 0; a < n; a++) value(&X[3 * a], &v[3 * a]);
  assert_petsc(VecRestoreArrayWrite(vec, &v));
}

/* number of the node at a reference position, within 1e-9 */
static inline PetscInt NodeAt(TLED tled, double x, double y, double z)
{
  const PetscReal *X;
  PetscInt         n;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  for (PetscInt a = 0; a < n; a++)
    if (fabs(X[3 * a] - x) + fabs(X[3 * a + 1] - y) + fabs(X[3 * a + 2] - z) < 1e-9) return a;
  fail_msg("no node at %g %g %g", x, y, z);
  return -1;
}

#endif
