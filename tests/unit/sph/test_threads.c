/* the same bits on one and on two threads, in both precisions, with walls, periodic sides, viscosity and the controller */
#include "fluid.h"

#include <omp.h>
#include <string.h>

static void Run(int threads, int precision, int solver, PetscReal x[])
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.12, 0.1, 0.3}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(0.01);
  SPHParams      *par;
  const PetscReal *state_x, *p;
  PetscInt        n;

  omp_set_num_threads(threads);
  assert_petsc(SPHGetParams(sph, &par));
  par->precision        = precision;
  par->solver           = solver;
  par->tolerance        = solver == SPH_SOLVER_IISPH_JACOBI ? 1e-3 : 1e-5;
  par->viscosity        = 1e-3;
  par->mean_velocity[0] = 0.1;
  assert_petsc(SPHSetDomain(sph, lo, hi, 12 | 16, 1));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 12, 10, 12, 0.01, 0.1, NULL);
  assert_petsc(SPHSetUp(sph));
  for (int s = 0; s < 5; s++) OneStep(sph, 1e-3);
  assert_petsc(SPHGetSize(sph, &n));
  assert_petsc(SPHGetState(sph, &state_x, NULL, &p, NULL, NULL));
  memcpy(x, state_x, sizeof(PetscReal) * 3 * (size_t)n);
  memcpy(x + 3 * n, p, sizeof(PetscReal) * (size_t)n);
  assert_petsc(SPHDestroy(&sph));
}

static void ThreadsDoNotChangeTheResult(void **state)
{
  static PetscReal a[4 * 1440], b[4 * 1440];

  (void)state;
  for (int variant = 0; variant < 3; variant++) {
    Run(1, variant & 1, variant / 2 ? SPH_SOLVER_IISPH_JACOBI : SPH_SOLVER_IISPH, a);
    Run(2, variant & 1, variant / 2 ? SPH_SOLVER_IISPH_JACOBI : SPH_SOLVER_IISPH, b);
    assert_memory_equal(a, b, sizeof(a));
    Run(3, variant & 1, variant / 2 ? SPH_SOLVER_IISPH_JACOBI : SPH_SOLVER_IISPH, b);
    assert_memory_equal(a, b, sizeof(a));
  }
}

CHECK_MAIN(cmocka_unit_test(ThreadsDoNotChangeTheResult))
