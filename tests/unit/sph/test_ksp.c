/* the IISPH system by PETSc's solvers (sph_ksp.c) against our own */
#include "fluid.h"

#include <math.h>

#include "sph/sph_impl.h"

#define N 200

/* pressures of one solve of a jittered block in a tank with its top open, by the solver that `option` and `type` name (NULL: MPRGP or CG) */
static void Solve(const char option[], const char type[], PetscReal tolerance, PetscBool free_surface, SPHResponse response, PetscReal p[N])
{
  const PetscReal dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {0.05, 0.05, 0.2}, g[3] = {0, 0, -9.81}, dt = 1e-3;
  SPH             sph = NewFluid(dx);
  PetscReal       w[N];

  if (option) assert_petsc(PetscOptionsSetValue(NULL, option, type));
  sph->params.tolerance      = tolerance;
  sph->params.max_iterations = 100000;
  sph->params.solver         = SPH_SOLVER_IISPH;
  sph->params.free_surface   = free_surface;
  sph->params.solver         = SPH_SOLVER_IISPH;
  assert_petsc(SPHSetDomain(sph, lo, hi, 31, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 5, 5, 8, dx, 0.1, NULL);
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  for (int i = 0; i < N; i++) w[i] = dt * sph->G[3 * i + 2] * 3.0;
  assert_petsc(SPHPredict(sph, dt));
  assert_petsc(SPHSolvePressure(sph, dt, response, w));
  assert_true(sph->converged);
  for (int i = 0; i < N; i++) p[i] = sph->p[i];
  assert_petsc(SPHDestroy(&sph));
  if (option) assert_petsc(PetscOptionsClearValue(NULL, option));
}

/* a compliant wall, A += w w^T */
static PetscErrorCode RankOne(void *ctx, PetscInt n, const PetscReal p[], PetscReal Ap[])
{
  const PetscReal *w = (const PetscReal *)ctx;
  PetscReal        sum = 0.0;

  for (PetscInt i = 0; i < n; i++) sum += w[i] * p[i];
  for (PetscInt i = 0; i < n; i++) Ap[i] += sum * w[i];
  return PETSC_SUCCESS;
}

static void Compare(const char option[], const char type[], PetscReal tolerance, PetscBool free_surface, SPHResponse response)
{
  PetscReal ours[N], theirs[N], least = 0.0;

  Solve(NULL, NULL, 1e-10, free_surface, response, ours);
  Solve(option, type, tolerance, free_surface, response, theirs);
  for (int i = 0; i < N; i++) {
    assert_close(theirs[i], ours[i], 1e5 * tolerance, RHO0 * 9.81 * 0.08); // residual over rho0 times the condition of A
    least = PetscMin(least, theirs[i]);
  }
  assert_true(free_surface ? least == 0.0 : least < 0.0);
}

static void KrylovMethodsFindTheBoundedSolution(void **state)
{
  (void)state;
  Compare("-sph_ksp_type", "cg", 1e-10, PETSC_TRUE, NULL);
  Compare("-sph_ksp_type", "minres", 1e-10, PETSC_TRUE, NULL);
  Compare("-sph_ksp_type", "gmres", 1e-10, PETSC_TRUE, NULL);
}

static void KrylovMethodsFindTheUnboundedSolution(void **state)
{
  (void)state;
  Compare("-sph_ksp_type", "cg", 1e-10, PETSC_FALSE, NULL);
  Compare("-sph_ksp_type", "minres", 1e-10, PETSC_FALSE, NULL);
}

static void TheyTakeTheResponseOfWalls(void **state)
{
  (void)state;
  Compare("-sph_ksp_type", "cg", 1e-10, PETSC_TRUE, RankOne);
  Compare("-sph_ksp_type", "minres", 1e-10, PETSC_FALSE, RankOne);
}

static void SolversForBoundsAgree(void **state)
{
  (void)state;
  assert_petsc(PetscOptionsSetValue(NULL, "-sph_tao_subset_type", "matrixfree"));
  Compare("-sph_tao_type", "gpcg", 1e-8, PETSC_TRUE, NULL);
  Compare("-sph_tao_type", "blmvm", 1e-8, PETSC_TRUE, NULL);
  assert_petsc(PetscOptionsClearValue(NULL, "-sph_tao_subset_type"));
}

CHECK_MAIN(cmocka_unit_test(KrylovMethodsFindTheBoundedSolution), cmocka_unit_test(KrylovMethodsFindTheUnboundedSolution), cmocka_unit_test(TheyTakeTheResponseOfWalls),
           cmocka_unit_test(SolversForBoundsAgree))
