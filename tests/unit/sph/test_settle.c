/* Water that was settled stands still from its first step, under hydrostatic pressure, and settling takes no time. */
#include "fluid.h"

#define DX 0.05
#define G  9.81

static SPH NewTank(void)
{
  const PetscReal min[3] = {0, 0, 0}, max[3] = {0.3, 0.3, 1.0}, g[3] = {0, 0, -G};
  SPH             sph = NewFluid(DX);

  assert_petsc(SPHSetDomain(sph, min, max, 1 + 2 + 4 + 8 + 16, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 6, 6, 8, DX, 0.1, NULL);
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHPack(sph, 1e-3, 100, NULL, NULL));
  return sph;
}

/* largest speed over sqrt(gH), and largest error of the floor's force over the weight, in the first 0.1 s */
static void Start(SPH sph, PetscReal *speed, PetscReal *force)
{
  PetscReal mass, t = 0.0;
  PetscInt  n;

  assert_petsc(SPHGetSize(sph, &n));
  assert_petsc(SPHGetMass(sph, &mass));
  *speed = *force = 0.0;
  while (t < 0.1) {
    PetscReal dt, wall[18];
    SPHStats  stats;

    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHGetTimeStep(sph, &dt));
    OneStep(sph, dt);
    t += dt;
    assert_petsc(SPHGetStats(sph, &stats));
    assert_petsc(SPHGetWallForces(sph, wall));
    *speed = fmax(*speed, stats.speed_max / sqrt(G * 0.4));
    *force = fmax(*force, fabs(-wall[3 * 4 + 2] / (n * mass * G) - 1.0));
  }
}

static void settled_water_stands_still(void **state)
{
  SPH       raw = NewTank(), settled = NewTank();
  PetscReal rest, speed[2], force[2], before[SPH_INTERNALS], after[SPH_INTERNALS];

  (void)state;
  assert_petsc(SPHGetInternals(settled, before));
  assert_petsc(SPHSettle(settled, 1e-2, 600, NULL, NULL, &rest));
  assert_petsc(SPHGetInternals(settled, after));
  for (int k = 0; k < SPH_INTERNALS - 1 && k < 10; k++) assert_close(after[k], before[k], 0.0, 1); // clock, controller, losses
  Start(raw, &speed[0], &force[0]);
  Start(settled, &speed[1], &force[1]);
  print_message("rest %.3g g; speed %.3g and settled %.3g of sqrt(gH); floor force off by %.3g and settled %.3g\n", rest, speed[0], speed[1], force[0], force[1]);
  assert_close(rest, 0.0, 0.03, 1);
  assert_close(speed[1], 0.0, 0.05, 1); // the method's own noise is a half to one per cent rms
  assert_close(force[1], 0.0, 0.02, 1);
  assert_true(speed[0] > 4.0 * speed[1]); // there is something to settle
  assert_petsc(SPHDestroy(&raw));
  assert_petsc(SPHDestroy(&settled));
}

CHECK_MAIN(cmocka_unit_test(settled_water_stands_still))
