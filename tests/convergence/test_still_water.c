/* Still water: 20,160 particles as a lattice in a tank of five walls come to rest in 4 s. Prints the table of
   docs/verification/fluid-slice.md and checks its bars. STILL_WATER_N=8,8,14 makes it a short run (the bars are those of the large one). */
#include "unit/sph/fluid.h"

#define DEPTH   0.4  /* [m] of the lattice */
#define END     4.0  /* [s] */
#define FROM    2.0  /* means are taken from here on [s] */
#define GAUGES  12

typedef struct {
  PetscReal at[GAUGES][3], depth[GAUGES]; /* place, depth below the surface [m]   */
  PetscReal pressure[GAUGES];             /* mean over time of p/(rho g z)        */
  PetscReal force, square, offset, compression, iterations, time;
  PetscInt  steps, all_steps;
} Table;

static SPH Tank(PetscInt n[3], PetscReal *depth)
{
  const PetscReal dx = DEPTH / (PetscReal)n[2], lo[3] = {0, 0, 0}, hi[3] = {(PetscReal)n[0] * dx, (PetscReal)n[1] * dx, 2 * DEPTH}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(dx);
  SPHParams      *par;
  PetscReal       mass;

  assert_petsc(SPHGetParams(sph, &par));
  par->precision = SPH_PRECISION_SINGLE;
  assert_petsc(SPHSetFromOptions(sph));
  assert_petsc(SPHSetDomain(sph, lo, hi, 31, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, n[0], n[1], n[2], dx, 0.0, NULL);
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHGetMass(sph, &mass));
  *depth = (PetscReal)(n[0] * n[1] * n[2]) * mass / (RHO0 * hi[0] * hi[1]);
  return sph;
}

/* four places off the middle of the tank at a quarter, half and three quarters of the depth */
static void PlaceGauges(const PetscInt n[3], PetscReal depth, Table *t)
{
  const PetscReal dx = DEPTH / (PetscReal)n[2];

  for (int k = 0; k < GAUGES; k++) {
    t->depth[k] = 0.25 * (k / 4 + 1) * depth;
    t->at[k][0] = (0.5 + (k & 1 ? 0.12 : -0.12)) * (PetscReal)n[0] * dx;
    t->at[k][1] = (0.5 + (k & 2 ? 0.12 : -0.12)) * (PetscReal)n[1] * dx;
    t->at[k][2] = depth - t->depth[k];
  }
}

static void Measure(SPH sph, PetscReal depth, PetscReal dx, Table *t)
{
  const PetscReal *x;
  PetscReal        force[18], height = 0.0, p, v[3];
  PetscInt         n;
  PetscBool        inside;
  SPHStats         stats;

  assert_petsc(SPHGetStats(sph, &stats));
  assert_petsc(SPHGetWallForces(sph, force));
  assert_petsc(SPHGetSize(sph, &n));
  assert_petsc(SPHGetState(sph, &x, NULL, NULL, NULL, NULL));
  for (PetscInt i = 0; i < n; i++) height += x[3 * i + 2] / (PetscReal)n;
  for (int k = 0; k < GAUGES; k++) {
    assert_petsc(SPHInterpolate(sph, t->at[k], &p, v, &inside));
    assert_true(inside);
    t->pressure[k] += p / (RHO0 * 9.81 * t->depth[k]);
  }
  t->force -= force[14];
  t->square += force[14] * force[14];
  t->offset += (height - 0.5 * depth) / dx;
  t->compression = PetscMax(t->compression, stats.compression_mean);
  t->steps++;
}

static void StillWaterStandsStill(void **state)
{
  PetscInt  n[3] = {24, 24, 35};
  PetscReal depth, mass, weight, dt, noise;
  Table     t = {0};
  SPHStats  stats;
  SPH       sph;

  (void)state;
  if (getenv("STILL_WATER_N")) assert_int_equal(sscanf(getenv("STILL_WATER_N"), "%d,%d,%d", &n[0], &n[1], &n[2]), 3);
  sph = Tank(n, &depth);
  PlaceGauges(n, depth, &t);
  while (t.time < END) {
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHGetTimeStep(sph, &dt));
    assert_petsc(SPHPredict(sph, dt));
    assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
    assert_petsc(SPHGetStats(sph, &stats));
    assert_true(stats.converged || t.time < 0.1);
    t.iterations += (PetscReal)stats.iterations;
    t.all_steps++;
    if (t.time >= FROM) Measure(sph, depth, DEPTH / (PetscReal)n[2], &t);
    assert_petsc(SPHAdvance(sph, dt));
    t.time += dt;
  }
  assert_petsc(SPHGetStats(sph, &stats));
  assert_petsc(SPHGetMass(sph, &mass));
  weight = (PetscReal)(n[0] * n[1] * n[2]) * mass * 9.81;
  t.force /= (PetscReal)t.steps;
  noise = sqrt(PetscMax(0.0, t.square / (PetscReal)t.steps - t.force * t.force)) / weight;

  printf("particles %d, steps %d, operator applications a step %.1f\n", n[0] * n[1] * n[2], t.all_steps, t.iterations / (PetscReal)t.all_steps);
  printf("mean compression, largest of the second half   %.2e\n", t.compression);
  for (int k = 0; k < GAUGES; k++) printf("pressure at (%.3f, %.3f, %.3f) m / rho g z       %.4f\n", t.at[k][0], t.at[k][1], t.at[k][2], t.pressure[k] / (PetscReal)t.steps);
  printf("force on the floor / weight                    %.5f, noise %.2f %%\n", t.force / weight, 100.0 * noise);
  printf("rms speed at the end / sqrt(g H)               %.2f %%\n", 100.0 * stats.speed_rms / sqrt(9.81 * depth));
  printf("offset of the wetted surface                   %.3f dx\n", t.offset / (PetscReal)t.steps);

  assert_close(t.compression, 0.0, 1e-3, 1.0);
  for (int k = 0; k < GAUGES; k++) assert_close(t.pressure[k] / (PetscReal)t.steps, 1.0, 0.02, 1.0);
  assert_close(t.force, weight, 5e-3, weight);
  assert_close(noise, 0.0, 0.01, 1.0);
  assert_close(stats.speed_rms / sqrt(9.81 * depth), 0.0, 0.01, 1.0);
  assert_close(t.offset / (PetscReal)t.steps, 0.0, 0.1, 1.0);
  assert_petsc(SPHDestroy(&sph));
}

CHECK_MAIN(cmocka_unit_test(StillWaterStandsStill))
