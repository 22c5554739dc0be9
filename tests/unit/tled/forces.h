/* forces.h - what the forces of every element must do, on any body: patch test, rigid motion, gradient of the energy, tangent. */
#ifndef BY_TEST_FORCES_H
#define BY_TEST_FORCES_H

#include "unit/tled/body.h"
#include "unit/tled/patch_reference.h"

#define ROUND 1e-12 /* of the largest force: sums of a few dozen corners */

static const double *map; /* the affine map of the test, row-major F */

static inline void Affine(const PetscReal X[3], PetscReal u[3])
{
  for (int i = 0; i < 3; i++) u[i] = map[3 * i] * X[0] + map[3 * i + 1] * X[1] + map[3 * i + 2] * X[2] - X[i] + 0.3 * (i + 1);
}

static inline void Wavy(const PetscReal X[3], PetscReal u[3])
{
  u[0] = 0.05 * sin(3 * X[1] + X[2]) + 0.04 * X[0] * X[0];
  u[1] = 0.06 * cos(2 * X[0]) - 0.05 * X[1] * X[2];
  u[2] = 0.04 * sin(4 * X[2] + X[0] * X[1]) + 0.03 * X[2];
}

/* An affine deformation gives the same stress everywhere, that of the independent code: inner nodes are in balance, each face feels P N, the
   energy is W V. On a linear face the corners take a third each; on a straight quadratic one the nodes of its edges do, which are
   the corners of the middle one of its four triangles. */
static inline void CheckPatch(TLED tled, int law)
{
  const PetscInt  *tri;
  const PetscReal *X, *f;
  PetscInt         n_tri, n, n_corners, step;
  Vec              u, force;
  TLEDStats        s;

  assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
  assert_petsc(VecDuplicate(u, &force));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, &n_corners, NULL, &X));
  step = n_corners == 10 ? 4 : 1;
  assert_petsc(TLEDGetSurface(tled, PETSC_FALSE, &n_tri, &tri));
  for (int i = 0; i < PATCH_STATES; i++) {
    const PatchReference *r        = &patch_reference[law][i];
    double               *expected = calloc(3 * (size_t)n, sizeof *expected);
    map                            = r->F;
    SetVec(tled, u, Affine);
    assert_petsc(TLEDInternalForce(tled, u, force));
    for (PetscInt t = step - 1; t < n_tri; t += step) { /* a third of P A N to each corner */
      double a[3], b[3], area[3];
      for (int k = 0; k < 3; k++)
        a[k] = X[3 * tri[3 * t + 1] + k] - X[3 * tri[3 * t] + k], b[k] = X[3 * tri[3 * t + 2] + k] - X[3 * tri[3 * t] + k];
      area[0] = 0.5 * step * (a[1] * b[2] - a[2] * b[1]), area[1] = 0.5 * step * (a[2] * b[0] - a[0] * b[2]),
      area[2] = 0.5 * step * (a[0] * b[1] - a[1] * b[0]);
      for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
          expected[3 * tri[3 * t + c] + k] +=
              (r->P[3 * k] * area[0] + r->P[3 * k + 1] * area[1] + r->P[3 * k + 2] * area[2]) / 3.0;
    }
    assert_petsc(VecGetArrayRead(force, &f));
    for (PetscInt k = 0; k < 3 * n; k++) assert_close(f[k], expected[k], ROUND, 1e6);
    assert_petsc(VecRestoreArrayRead(force, &f));
    assert_petsc(TLEDGetStats(tled, &s));
    assert_close(s.strain, r->W, ROUND, r->W);
    free(expected);
  }
  assert_petsc(VecDestroy(&force));
}

/* a turn by 2.1 about y, and a shift: no force, no energy, the same volume */
static inline void CheckRigidMotion(TLED tled)
{
  const double Q[9] = {cos(2.1), 0.0, sin(2.1), 0.0, 1.0, 0.0, -sin(2.1), 0.0, cos(2.1)};
  Vec          u, f;
  PetscReal    top;
  TLEDStats    stats;

  map = Q;
  assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
  assert_petsc(VecDuplicate(u, &f));
  SetVec(tled, u, Affine);
  assert_petsc(TLEDInternalForce(tled, u, f));
  assert_petsc(VecNorm(f, NORM_INFINITY, &top));
  assert_close(top, 0.0, ROUND, 1e6);
  assert_petsc(TLEDGetStats(tled, &stats));
  assert_close(stats.strain, 0.0, ROUND, 1e6);
  assert_close(stats.volume, stats.volume_reference, ROUND, 1.0);
  assert_petsc(VecDestroy(&f));
}

/* f = dW/du along a direction and K = df/du at a wavy displacement, by central differences */
static inline void CheckDerivatives(TLED tled)
{
  const PetscReal eps = 1e-6;
  Vec             u, u0, d, f, up, down, Kd;
  Mat             K = NULL;
  PetscReal       work, slope, size, error;
  PetscBool       symmetric;
  TLEDStats       s1, s2;
  PetscRandom     random;

  assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
  assert_petsc(VecDuplicate(u, &u0));
  assert_petsc(VecDuplicate(u, &d));
  assert_petsc(VecDuplicate(u, &f));
  assert_petsc(VecDuplicate(u, &up));
  assert_petsc(VecDuplicate(u, &down));
  assert_petsc(VecDuplicate(u, &Kd));
  SetVec(tled, u0, Wavy);
  assert_petsc(PetscRandomCreate(PETSC_COMM_SELF, &random));
  assert_petsc(VecSetRandom(d, random));
  assert_petsc(PetscRandomDestroy(&random));
  assert_petsc(TLEDInternalForce(tled, u0, f));
  assert_petsc(VecDot(f, d, &work));
  assert_petsc(VecWAXPY(u, eps, d, u0));
  assert_petsc(TLEDGetStats(tled, &s1));
  assert_petsc(TLEDInternalForce(tled, u, up));
  assert_petsc(VecWAXPY(u, -eps, d, u0));
  assert_petsc(TLEDGetStats(tled, &s2));
  assert_petsc(TLEDInternalForce(tled, u, down));
  slope = (s1.strain - s2.strain) / (2 * eps);
  assert_close(slope, work, 1e-7, work); /* round-off of the energies over the step: 1e-16 W/eps */
  assert_petsc(TLEDTangent(tled, u0, &K));
  assert_petsc(TLEDTangent(tled, u0, &K)); /* the second call writes into the same matrix */
  assert_petsc(MatMult(K, d, Kd));
  assert_petsc(VecAXPY(up, -1.0, down));
  assert_petsc(VecScale(up, 1.0 / (2 * eps)));
  assert_petsc(VecNorm(up, NORM_2, &size));
  assert_petsc(VecAXPY(up, -1.0, Kd));
  assert_petsc(VecNorm(up, NORM_2, &error));
  assert_close(error, 0.0, 1e-8, size);
  assert_petsc(MatIsSymmetric(K, 1e-6, &symmetric)); /* absolute, N/m; entries are about 1e6 */
  assert_true(symmetric);
  assert_petsc(MatDestroy(&K));
  assert_petsc(VecDestroy(&u0));
  assert_petsc(VecDestroy(&d));
  assert_petsc(VecDestroy(&f));
  assert_petsc(VecDestroy(&up));
  assert_petsc(VecDestroy(&down));
  assert_petsc(VecDestroy(&Kd));
}

#endif
