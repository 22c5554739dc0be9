/* fluid.h - small fluids for the tests of sph. */
#ifndef BY_TEST_FLUID_H
#define BY_TEST_FLUID_H

#include "check.h"
#include "sph/sph.h"

#define RHO0 1000.0

/* n x n x n_z lattice of spacing dx with its first particle at half a spacing from the origin, each displaced by up to jitter dx */
static inline void AddLattice(SPH sph, PetscInt nx, PetscInt ny, PetscInt nz, PetscReal dx, PetscReal jitter, const PetscReal velocity[3])
{
  const PetscInt n = nx * ny * nz;
  PetscReal     *x = (PetscReal *)malloc(sizeof(*x) * 3 * (size_t)n), *v = (PetscReal *)malloc(sizeof(*v) * 3 * (size_t)n);
  PetscInt       m = 0;
  unsigned       seed = 12345;

  for (PetscInt k = 0; k < nz; k++) {
    for (PetscInt j = 0; j < ny; j++) {
      for (PetscInt i = 0; i < nx; i++, m++) {
        const PetscReal at[3] = {(i + 0.5) * dx, (j + 0.5) * dx, (k + 0.5) * dx};
        for (int q = 0; q < 3; q++) {
          seed         = seed * 1103515245u + 12345u;
          x[3 * m + q] = at[q] + jitter * dx * (2.0 * ((seed >> 16) & 0x7fff) / 32767.0 - 1.0);
          v[3 * m + q] = velocity ? velocity[q] : 0.0;
        }
      }
    }
  }
  assert_petsc(SPHAddParticles(sph, n, x, v));
  free(x);
  free(v);
}

/* a fluid with defaults, spacing dx, double precision */
static inline SPH NewFluid(PetscReal dx)
{
  SPH        sph;
  SPHParams *par;

  assert_petsc(SPHCreate(PETSC_COMM_SELF, &sph));
  assert_petsc(SPHGetParams(sph, &par));
  par->spacing   = dx;
  par->density   = RHO0;
  par->precision = SPH_PRECISION_DOUBLE;
  return sph;
}

/* one step without surfaces */
static inline void OneStep(SPH sph, PetscReal dt)
{
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHPredict(sph, dt));
  assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
  assert_petsc(SPHAdvance(sph, dt));
}

#endif
