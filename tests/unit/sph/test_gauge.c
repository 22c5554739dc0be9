/* gauges, ledger sums and initial packing */
#include "fluid.h"

#include "sph/sph_impl.h"

static SPH Pool(unsigned walls, unsigned periodic, PetscReal spread, PetscReal jitter)
{
  const PetscReal dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {0.08, 0.08, 0.3}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(dx);

  assert_petsc(SPHSetDomain(sph, lo, hi, walls, periodic));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 8, 8, 10, spread * dx, jitter, NULL);
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  return sph;
}

/* a constant field is met exactly, inside, at a wall, through a periodic side and after particles have moved; a linear one within 5 % of
   its change over h; far away nothing is found */
static void InterpolationIsExactForConstants(void **state)
{
  SPH       sph = Pool(16, 3, 1.0, 0.1);
  PetscReal p, v[3];
  PetscBool inside;

  (void)state;
  for (PetscInt i = 0; i < sph->n; i++) {
    sph->p[i] = 777.0;
    for (int k = 0; k < 3; k++) sph->v[3 * i + k] = 0.1 * (k + 1);
  }
  for (int moved = 0; moved < 2; moved++) {
    const PetscReal places[4][3] = {{0.04, 0.04, 0.05}, {0.0, 0.079, 0.0}, {0.04, 0.04, 0.105}, {0.04, 0.04, 0.2}};

    for (int k = 0; k < 4; k++) {
      assert_petsc(SPHInterpolate(sph, places[k], &p, v, &inside));
      assert_int_equal((int)inside, k < 3);
      assert_close(p, k < 3 ? 777.0 : 0.0, 1e-12, 777.0);
      assert_close(v[1], k < 3 ? 0.2 : 0.0, 1e-12, 0.2);
    }
    if (moved) break;
    for (PetscInt i = 0; i < 3 * sph->n; i++) sph->v_star[i] = sph->v[i];
    for (PetscInt i = 0; i < sph->n; i++) sph->p[i] = 0.0;
    assert_petsc(SPHAdvance(sph, 0.03)); // 0.6 dx along z, particles wrap around along x and y
    for (PetscInt i = 0; i < sph->n; i++) sph->p[i] = 777.0;
  }
  for (PetscInt i = 0; i < sph->n; i++) sph->p[i] = 1000.0 * sph->x[3 * i + 2];
  const PetscReal at[3] = {0.033, 0.051, 0.058};
  assert_petsc(SPHInterpolate(sph, at, &p, v, &inside));
  assert_close(p, 58.0, 0.05, 1000.0 * sph->h);
  assert_petsc(SPHDestroy(&sph));
}

/* the height of a lattice is its volume over the area, in the middle and in a corner between walls */
static void HeightIsVolumeOverArea(void **state)
{
  SPH       sph = Pool(31, 0, 1.0, 0.0);
  PetscReal height, full = 10 * sph->mass / (RHO0 * 1e-4);

  (void)state;
  for (int k = 0; k < 3; k++) {
    const PetscReal places[3][3] = {{0.043, 0.041, 0.0}, {0.001, 0.002, 0.0}, {0.0799, 0.04, 0.1}};
    assert_petsc(SPHGetHeight(sph, places[k], &height));
    assert_close(height, full, 0.04, full); // lattice sum of the column's weight at h = 2 dx
  }
  assert_petsc(SPHDestroy(&sph));
}

/* rectangles that cover a wall, corners and edges included, carry its force together; each side of a symmetric wall the same */
static void PatchesCarryTheForceOfTheWall(void **state)
{
  SPH             sph = Pool(31, 0, 1.0, 0.1);
  const PetscReal cuts[4] = {-1.0, 0.031, 0.052, 1.0};
  PetscReal       sum = 0.0, covered = 0.0, forces[18];
  PetscInt        patch;

  (void)state;
  for (PetscInt i = 0; i < sph->n; i++) sph->p[i] = 981.0 * (0.1 - sph->x[3 * i + 2]);
  for (int k = 0; k < 9; k++) {
    const PetscReal lo[3] = {0, cuts[k % 3], cuts[k / 3]}, hi[3] = {0, cuts[k % 3 + 1], cuts[k / 3 + 1]};
    assert_petsc(SPHAddPatch(sph, 1, lo, hi, &patch));
    assert_int_equal(patch, k);
  }
  assert_petsc(SPHPlaneForces_Internal(sph));
  for (PetscInt k = 0; k < 9; k++) {
    PetscReal force, area;

    assert_petsc(SPHGetPatch(sph, k, &force, &area));
    sum += force;
    covered += area;
  }
  assert_petsc(SPHGetWallForces(sph, forces));
  assert_close(covered, 0.08 * 0.3, 1e-14, 0.024);
  assert_close(sum, forces[3], 4e-3, forces[3]); // the midpoint rule of CUTS squares
  assert_petsc(SPHDestroy(&sph));
}

/* a stop at the wall is part of the patch's force as it is of the wall's */
static void PatchesFeelStops(void **state)
{
  const PetscReal x[3] = {0.001, 0.05, 0.05}, v[3] = {-3, 0, 0}, lo[3] = {0, 0, 0}, hi[3] = {0.1, 0.1, 0.1};
  SPH             sph  = NewFluid(0.01);
  PetscReal       force, forces[18];
  PetscInt        patch;

  (void)state;
  assert_petsc(SPHSetDomain(sph, lo, hi, 1, 0));
  assert_petsc(SPHAddParticles(sph, 1, x, v));
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHAddPatch(sph, 0, lo, hi, &patch));
  OneStep(sph, 1e-3);
  assert_petsc(SPHGetPatch(sph, patch, &force, NULL));
  assert_petsc(SPHGetWallForces(sph, forces));
  assert_true(force > 0.0);
  assert_close(force, -forces[0], 1e-12, force);
  assert_petsc(SPHDestroy(&sph));
}

/* volume through a rectangle while a lattice drifts by one spacing: velocity x area x time, whole and half, through periodic sides and in a duct */
static void FlowRateCountsTheVolume(void **state)
{
  for (int duct = 0; duct < 2; duct++) {
    SPH             sph = Pool(duct ? 12 : 0, duct ? 1 : 3, 1.0, 0.0);
    const PetscReal lo[3] = {0.04, 0, -1}, whole[3] = {0.04, 0.08, 1}, half[3] = {0.04, 0.04, 1};
    PetscReal       through[2] = {0, 0}, rate;

    (void)state;
    for (PetscInt i = 0; i < sph->n; i++) sph->v[3 * i] = 2.0;
    for (int step = 0; step < 20; step++) {
      for (int k = 0; k < 2; k++) {
        assert_petsc(SPHGetFlowRate(sph, 0, lo, k ? half : whole, &rate));
        through[k] += rate * 2.5e-4;
      }
      for (PetscInt i = 0; i < sph->n; i++) sph->x[3 * i] = fmod(sph->x[3 * i] + 2.0 * 2.5e-4, 0.08);
    }
    const PetscReal volume = 80.0 * sph->mass / RHO0; // a layer of 8 x 10 particles
    assert_close(through[0], volume, 1e-4, volume);   // a sum over 20 steps for the integral
    assert_close(through[1], 0.5 * volume, 2e-3, volume);
    assert_petsc(SPHDestroy(&sph));
  }
}

/* the free surface of a lattice is half a spacing above its last layer: in the middle, in a corner, under a splash; a dry floor has none */
static void SurfaceIsWhereDensityHalves(void **state)
{
  const PetscReal g[3] = {0, 0, -9.81}, lo[3] = {0, 0, 0}, hi[3] = {0.16, 0.08, 0.3}, splash[6] = {0.04, 0.04, 0.2, 0.04, 0.04, 0.21}, dx = 0.01;
  const PetscReal places[4][3] = {{0.043, 0.041, 0.0}, {0.001, 0.002, 0.0}, {0.04, 0.04, 0.05}, {0.14, 0.04, 0.0}};
  SPH             sph = NewFluid(dx);
  PetscReal       height;

  (void)state;
  assert_petsc(SPHSetDomain(sph, lo, hi, 31, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 8, 8, 10, dx, 0.0, NULL);
  assert_petsc(SPHAddParticles(sph, 2, splash, NULL));
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  for (int k = 0; k < 4; k++) {
    assert_petsc(SPHGetSurface(sph, places[k], &height));
    if (k < 3) assert_close(height, 0.1, 0.1, dx); // a lattice's kernel sum at the face, and the step of the walk
    else assert_close(height, 0.0, 1e-9, dx);
  }
  assert_petsc(SPHDestroy(&sph));
}

/* energies and momenta of two particles, by hand */
static void StatsAreTheSums(void **state)
{
  const PetscReal x[6] = {0.01, 0.02, 0.03, 0.3, 0.1, 0.2}, v[6] = {1, 2, 3, -1, 0.5, 0}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(0.01);
  SPHStats        s;

  (void)state;
  assert_petsc(SPHSetGravity(sph, g));
  assert_petsc(SPHAddParticles(sph, 2, x, v));
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHPredict(sph, 1e-3));
  assert_petsc(SPHGetStats(sph, &s));
  assert_close(s.kinetic, 0.5 * sph->mass * (14.0 + 1.25), 1e-14, s.kinetic);
  assert_close(s.potential, sph->mass * 9.81 * 0.23, 1e-14, s.potential);
  assert_close(s.momentum[1], sph->mass * 2.5, 1e-14, s.momentum[1]);
  assert_close(s.angular[2], sph->mass * (0.01 * 2 - 0.02 * 1 + 0.3 * 0.5 + 0.1), 1e-14, s.angular[2]);
  assert_close(s.speed_max, sqrt(14.0), 1e-14, 4.0);
  assert_true(s.compression_max == 0.0);
  assert_petsc(SPHDestroy(&sph));
}

/* a cloud 3 % too close and shaken comes to rest density without loss: every particle stays in the tank, away from walls, its height grows,
   and velocities are untouched */
static void PackingLosesNoVolume(void **state)
{
  SPH       sph = Pool(31, 0, 0.99, 0.15);
  SPHStats  stats;
  PetscReal before = 0.0, after = 0.0, lowest = 1.0;

  (void)state;
  for (PetscInt i = 0; i < sph->n; i++) before += sph->x[3 * i + 2];
  assert_petsc(SPHPredict(sph, 1e-3));
  assert_petsc(SPHGetStats(sph, &stats));
  assert_true(stats.compression_mean > 0.02);
  assert_petsc(SPHPack(sph, 1e-3, 50, NULL, NULL));
  assert_petsc(SPHPredict(sph, 1e-3));
  assert_petsc(SPHGetStats(sph, &stats));
  assert_true(stats.compression_mean < 1e-3);
  assert_true(stats.kinetic == 0.0);
  for (PetscInt i = 0; i < sph->n; i++) {
    after += sph->x[3 * i + 2];
    for (int k = 0; k < 6; k++) {
      PetscReal sign;
      if (sph->walls >> k & 1) lowest = PetscMin(lowest, SPHPlaneDistance(sph, k, sph->x + 3 * i, &sign));
    }
  }
  assert_true(after > before);
  assert_true(lowest > 0.0);
  assert_petsc(SPHDestroy(&sph));
}

CHECK_MAIN(cmocka_unit_test(InterpolationIsExactForConstants), cmocka_unit_test(HeightIsVolumeOverArea), cmocka_unit_test(PatchesCarryTheForceOfTheWall), cmocka_unit_test(PatchesFeelStops),
           cmocka_unit_test(FlowRateCountsTheVolume), cmocka_unit_test(SurfaceIsWhereDensityHalves), cmocka_unit_test(StatsAreTheSums), cmocka_unit_test(PackingLosesNoVolume))
