/* The static solution of the discrete problem: internal force and tangent solve it by Newton's method, and it is the one that an
   independent finite element code finds on the same mesh (DOLFINx 0.5.2, P1 elements, Newton to 1e-9; neo-Hookean and St
   Venant-Kirchhoff cantilever 1 x 0.1 x 0.1 m clamped at x = 0, E 3 MPa, rho 1000, g 9.81 in -z; mesh beam_h1.msh with 464
   elements). */
#include "unit/tled/body.h"
#include <petscksp.h>

#define TOL 1e-8 /* both codes' Newton tolerance, relative to the displacement */

/* solve f(u) = load * m g with the clamp held; returns the number of iterations */
static PetscInt Newton(TLED tled, Vec u, PetscReal load)
{
  const PetscBool *held;
  const PetscReal *mass;
  PetscReal       *r, *x, step, size;
  PetscInt         n, n_held = 0, *rows, it;
  Vec              residual, du;
  Mat              K = NULL;
  KSP              ksp;
  PC               pc;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDIsConstrained(tled, &held));
  assert_petsc(TLEDGetMass(tled, &mass));
  assert_petsc(PetscMalloc1(3 * n, &rows));
  for (PetscInt k = 0; k < 3 * n; k++)
    if (held[k / 3]) rows[n_held++] = k;
  assert_petsc(VecDuplicate(u, &residual));
  assert_petsc(VecDuplicate(u, &du));
  assert_petsc(KSPCreate(PETSC_COMM_SELF, &ksp));
  assert_petsc(KSPSetType(ksp, KSPPREONLY));
  assert_petsc(KSPGetPC(ksp, &pc));
  assert_petsc(PCSetType(pc, PCLU));
  for (it = 0; it < 25; it++) {
    assert_petsc(TLEDInternalForce(tled, u, residual));
    assert_petsc(VecGetArray(residual, &r));
    for (PetscInt a = 0; a < n; a++) {
      r[3 * a + 2] += load * 9.81 * mass[a];
      for (PetscInt k = 0; k < 3 && held[a]; k++) r[3 * a + k] = 0.0;
    }
    assert_petsc(VecRestoreArray(residual, &r));
    assert_petsc(TLEDTangent(tled, u, &K));
    assert_petsc(MatZeroRowsColumns(K, n_held, rows, 1e6, NULL, NULL));
    assert_petsc(KSPSetOperators(ksp, K, K));
    assert_petsc(KSPSolve(ksp, residual, du));
    assert_petsc(VecAXPY(u, -1.0, du));
    assert_petsc(VecNorm(du, NORM_2, &step));
    assert_petsc(VecNorm(u, NORM_2, &size));
    if (step < 1e-11 * size) break;
  }
  assert_petsc(VecGetArray(u, &x));
  for (PetscInt k = 0; k < n_held; k++) assert_true(x[rows[k]] == 0.0);
  assert_petsc(VecRestoreArray(u, &x));
  assert_petsc(KSPDestroy(&ksp));
  assert_petsc(MatDestroy(&K));
  assert_petsc(VecDestroy(&residual));
  assert_petsc(VecDestroy(&du));
  assert_petsc(PetscFree(rows));
  return it;
}

typedef struct {
  const char *mesh;
  int         material;
  double      poisson, tip[3], energy; /* tip centre [m], strain energy [J] */
} Reference;

static void Solve(const Reference *ref)
{
  TLEDParams      *p;
  TLED             tled = NewBody(ref->mesh, &p);
  TLEDStats        stats;
  const PetscReal *x;
  Vec              u;
  PetscInt         it = 0, tip;

  p->elastic.material = ref->material;
  p->elastic.poisson  = ref->poisson;
  AddName(&p->fixed, "clamp");
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
  for (int step = 1; step <= 8; step++) it = Newton(tled, u, step / 8.0);
  assert_true(it < 15); /* quadratic at the end: the tangent is the derivative of the force */
  tip = NodeAt(tled, 1.0, 0.05, 0.05);
  assert_petsc(VecGetArrayRead(u, &x));
  for (int k = 0; k < 3; k++) assert_close(x[3 * tip + k], ref->tip[k], TOL, ref->tip[2]);
  assert_petsc(VecRestoreArrayRead(u, &x));
  assert_petsc(TLEDGetStats(tled, &stats));
  assert_close(stats.strain, ref->energy, TOL, ref->energy);
  assert_petsc(TLEDDestroy(&tled));
}

static void Cantilever_NeoHookean(void **state)
{
  const Reference a = {"tests/meshes/beam_h1.msh",
                       TLED_MATERIAL_NEO_HOOKEAN,
                       0.3,
                       {-0.04142484237735666, -0.0009972955093733896, -0.2709548025632535},
                       5.317299312167156};
  const Reference b = {"tests/meshes/beam_h1.msh",
                       TLED_MATERIAL_NEO_HOOKEAN,
                       0.45,
                       {-0.025593659167204127, -0.0013157307281949477, -0.21439682744396152},
                       4.234257721621486};

  (void)state;
  Solve(&a);
  Solve(&b);
}

static void Cantilever_StVenantKirchhoff(void **state)
{
  const Reference a = {"tests/meshes/beam_h1.msh",
                       TLED_MATERIAL_ST_VENANT_KIRCHHOFF,
                       0.3,
                       {-0.042361426579887194, -0.0007976745029058303, -0.27165781027625807},
                       5.341168338410373};
  const Reference b = {"tests/meshes/beam_h1.msh",
                       TLED_MATERIAL_ST_VENANT_KIRCHHOFF,
                       0.45,
                       {-0.02631445146114603, -0.0011003582678427604, -0.21481358917485185},
                       4.248196232583419};

  (void)state;
  Solve(&a);
  Solve(&b);
}

CHECK_MAIN(cmocka_unit_test(Cantilever_NeoHookean), cmocka_unit_test(Cantilever_StVenantKirchhoff))
