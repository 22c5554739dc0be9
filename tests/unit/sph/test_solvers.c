/* What every pressure solver must do, whatever its way: a new solver is a new row of Rows[]. */
#include "floor.h"

#include <string.h>

#include "mat3.h"
#include "sph/sph_eos.h"

#ifdef _OPENMP
  #include <omp.h>
#endif

typedef struct {
  const char *name;
  int         solver, kernel, gradient_kernel;
  PetscReal   gamma;    /* wcsph                                                                                                   */
  PetscReal   weight;   /* mean floor force over weight, still water: what a quarter of a second of sloshing and sound leaves in a mean   */
  PetscReal   depth;    /* mean pressure at half depth over rho g z: discretisation at 12 layers, and compression                  */
  PetscReal   packed;   /* largest compression of the dam break                                                                    */
  PetscReal   momentum; /* of a drop, over m |v|: round-off where forces are equal and opposite                                    */
} Row;

static const Row Rows[] = {
  {"iisph",             SPH_SOLVER_IISPH,        0, 0, 7, 0.02, 0.05, 0.15, 1e-12},
  {"iisph_jacobi",      SPH_SOLVER_IISPH_JACOBI, 0, 0, 7, 0.02, 0.05, 0.15, 1e-12},
  {"pcisph",            SPH_SOLVER_PCISPH,       0, 0, 7, 0.02, 0.05, 0.15, 1e-12},
  {"wcsph",             SPH_SOLVER_WCSPH,        0, 0, 7, 0.02, 0.05, 0.15, 1e-12},
  {"wcsph, gamma 1",    SPH_SOLVER_WCSPH,        SPH_POLY6, 1 + SPH_SPIKY, 1, 0.03, 0.06, 0.15, 1e-12},
  {"dfsph",             SPH_SOLVER_DFSPH,        0, 0, 7, 0.02, 0.05, 0.15, 1e-12},
  {"pbf",               SPH_SOLVER_PBF,          0, 0, 7, 0.02, 0.05, 0.15, 1e-12},
  {"iisph, Mueller's",  SPH_SOLVER_IISPH,        SPH_POLY6, 1 + SPH_SPIKY, 7, 0.02, 0.10, 0.15, 1e-12}, // its gradient is not that of its density
  {"pbf, its kernels",  SPH_SOLVER_PBF,          SPH_POLY6, 1 + SPH_SPIKY, 7, 0.02, 0.10, 0.15, 1e-12},
};
#define N_ROWS (int)(sizeof(Rows)/sizeof(*Rows))

static SPH Fluid(const Row *row, PetscReal dx)
{
  SPH sph = NewFluid(dx);

  sph->params.solver          = row->solver;
  sph->params.kernel          = row->kernel;
  sph->params.gradient_kernel = row->gradient_kernel;
  sph->params.gamma           = row->gamma;
  return sph;
}

static PetscReal AdaptiveStep(SPH sph)
{
  PetscReal dt;

  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHGetTimeStep(sph, &dt));
  assert_petsc(SPHPredict(sph, dt));
  assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
  assert_petsc(SPHAdvance(sph, dt));
  return dt;
}

/* still water, 12 layers, periodic sides: means over the second half of 0.5 s, four times sqrt(H/g) */
static void StillWaterStandsOnItsFloor(void **state)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.04, 0.04, 0.2}, g[3] = {0, 0, -9.81};

  (void)state;
  for (int k = 0; k < N_ROWS; k++) {
    SPH       sph = Fluid(&Rows[k], 0.01);
    PetscReal force = 0.0, pressure = 0.0, total = 0.0, wall[18], mass;

    sph->params.precision = SPH_PRECISION_SINGLE;
    assert_petsc(SPHSetDomain(sph, lo, hi, 16, 3));
    assert_petsc(SPHSetGravity(sph, g));
    AddLattice(sph, 4, 4, 12, 0.01, 0.0, NULL);
    assert_petsc(SPHSetUp(sph));
    assert_petsc(SPHGetMass(sph, &mass));
    for (PetscReal time = 0.0; time < 0.5;) {
      const PetscReal at[3] = {0.02, 0.02, 0.06};
      const PetscReal dt    = AdaptiveStep(sph);
      PetscReal       p, v[3];
      PetscBool       inside;

      time += dt;
      if (time < 0.25) continue;
      assert_petsc(SPHGetWallForces(sph, wall));
      assert_petsc(SPHInterpolate(sph, at, &p, v, &inside));
      assert_true(inside);
      force += dt * -wall[14];
      pressure += dt * p;
      total += dt;
    }
    print_message("%-20s floor force/weight %.4f, pressure at half depth/rho g z %.4f\n", Rows[k].name, force / total / (192 * mass * 9.81), pressure / total / (RHO0 * 9.81 * 0.06));
    assert_close(force / total, -(-192.0 * mass * 9.81), Rows[k].weight, 192.0 * mass * 9.81);
    assert_close(pressure / total, RHO0 * 9.81 * 0.06, Rows[k].depth, RHO0 * 9.81 * 0.06);
    assert_petsc(SPHDestroy(&sph));
  }
}

/* a jittered, spinning drop in free space bursts and keeps its momentum */
static void DropKeepsItsMomentum(void **state)
{
  (void)state;
  for (int k = 0; k < N_ROWS; k++) {
    const PetscReal v[3] = {1.0, -0.5, 0.25};
    SPH             sph  = Fluid(&Rows[k], 0.01);
    PetscReal       fastest = 0.0;
    SPHStats        stats;

    AddLattice(sph, 5, 5, 5, 0.01, 0.2, v);
    assert_petsc(SPHSetUp(sph));
    for (int s = 0; s < 15; s++) (void)AdaptiveStep(sph);
    assert_petsc(SPHGetStats(sph, &stats));
    for (int a = 0; a < 3; a++) assert_close(stats.momentum[a], 125.0 * sph->mass * v[a], Rows[k].momentum, 125.0 * sph->mass * Norm3(v));
    for (int i = 0; i < 125; i++) fastest = PetscMax(fastest, PetscAbsReal(sph->v[3 * i] - 1.0));
    assert_true(fastest > 1e-3); // something pushed
    assert_petsc(SPHDestroy(&sph));
  }
}

/* water on a moving floor of proxies, between planes: what the fluid loses, each proxy and plane gets, step by step */
static void ReactionIsTheImpulse(void **state)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.05, 0.05, 0.2}, g[3] = {0, 0, -9.81};

  (void)state;
  for (int k = 0; k < N_ROWS; k++) {
    SPH       sph = Fluid(&Rows[k], 0.01);
    Floor     floor;
    PetscReal pushed = 0.0;

    assert_petsc(SPHSetDomain(sph, lo, hi, 15, 0));
    assert_petsc(SPHSetGravity(sph, g));
    AddLattice(sph, 5, 5, 7, 0.01, 0.1, NULL);
    assert_petsc(SPHSetUp(sph));
    for (int s = 0; s < 5; s++) {
      const PetscReal dt = 1e-3;
      SPHStats        before, after;
      PetscReal       wall[18], sum[3] = {0, 0, 0};

      assert_petsc(SPHUpdateNeighbors(sph));
      assert_petsc(SPHGetStats(sph, &before));
      Touch(sph, 2, &floor);
      for (int b = 0; b < 4; b++) floor.velocity[3 * b + 2] = 0.3;
      assert_petsc(SPHSetContacts(sph, 1, &floor.contacts));
      assert_petsc(SPHPredict(sph, dt));
      assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
      assert_petsc(SPHGetForces(sph));
      assert_petsc(SPHAdvance(sph, dt));
      assert_petsc(SPHGetWallForces(sph, wall)); // with the impulses of the stops
      assert_petsc(SPHGetStats(sph, &after));
      for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 4; b++) sum[a] += floor.force[3 * b + a];
        assert_close(sum[a], floor.contacts.total[a], 1e-12, 175.0 * sph->mass * 9.81);
        for (int w = 0; w < 6; w++) sum[a] += wall[3 * w + a];
        const PetscReal lost = 175.0 * sph->mass * g[a] * dt - (after.momentum[a] - before.momentum[a]);
        if (PetscAbsReal(dt * sum[a] - lost) > 1e-11 * 175.0 * sph->mass * 0.3) print_message("%s, step %d, axis %d:\n", Rows[k].name, s, a);
        assert_close(dt * sum[a], lost, 1e-11, 175.0 * sph->mass * 0.3); // sums of numbers that cancel
      }
      pushed = PetscMax(pushed, PetscAbsReal(floor.contacts.total[2]));
    }
    assert_true(pushed > 0.1 * 175.0 * sph->mass * 9.81);
    assert_petsc(SPHDestroy(&sph));
  }
}

static void DamBreak(const Row *row, int precision, PetscReal end, int most, PetscReal x[], PetscReal *largest)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.4, 0.08, 0.4}, g[3] = {0, 0, -9.81};
  SPH             sph = Fluid(row, 0.02);
  PetscReal       time = 0.0, energy = 0.0;
  SPHStats        stats;

  sph->params.precision = precision;
  assert_petsc(SPHSetDomain(sph, lo, hi, 3 | 16, 2));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 6, 4, 8, 0.02, 0.0, NULL);
  assert_petsc(SPHSetUp(sph));
  *largest = 0.0;
  for (int s = 0; time < end && s < most; s++) {
    time += AdaptiveStep(sph);
    assert_petsc(SPHGetStats(sph, &stats));
    if (s == 0) energy = stats.kinetic + stats.potential;
    if (time > 0.1) *largest = PetscMax(*largest, stats.compression_max);
    assert_true(stats.kinetic + stats.potential < 1.15 * energy); // the lattice, too dense along walls, gives back a tenth at once
  }
  if (end < 1.0) assert_true(stats.kinetic > 0.02 * energy && stats.speed_max < 4.0); // it ran, and no faster than sqrt(2 g H) doubled
  for (PetscInt i = 0; i < 3 * sph->n; i++) x[i] = sph->x[i];
  for (PetscInt i = 0; i < sph->n; i++) assert_true(sph->x[3 * i] > 0.0 && sph->x[3 * i] < 0.4 && sph->x[3 * i + 2] > 0.0);
  assert_petsc(SPHDestroy(&sph));
}

/* a column of 192 particles collapses, meets the far wall and comes back: nothing is lost, nothing flies */
static void DamBreakStaysInItsTank(void **state)
{
  static PetscReal x[576];

  (void)state;
  for (int k = 0; k < N_ROWS; k++) {
    PetscReal largest;

    DamBreak(&Rows[k], SPH_PRECISION_SINGLE, 0.35, 100000, x, &largest);
    print_message("%-20s largest compression %.3f\n", Rows[k].name, largest);
    assert_true(largest < Rows[k].packed);
  }
}

static void ThreadsDoNotChangeTheResult(void **state)
{
#ifdef _OPENMP
  static PetscReal a[576], b[576];

  (void)state;
  for (int k = 0; k < N_ROWS; k++) {
    PetscReal largest;
    const int before = omp_get_max_threads();

    omp_set_num_threads(1);
    DamBreak(&Rows[k], SPH_PRECISION_SINGLE, 1.0, 12, a, &largest);
    omp_set_num_threads(2);
    DamBreak(&Rows[k], SPH_PRECISION_SINGLE, 1.0, 12, b, &largest);
    omp_set_num_threads(before);
    assert_memory_equal(a, b, sizeof(a));
  }
#else
  (void)state;
#endif
}

/* names mean the solver that they say; the response of compliant walls is taken, or refused before it is lost */
static void NamesAreTheSolvers(void **state)
{
  static const char *const names[] = {"iisph", "iisph", "iisph_jacobi", "isph", "dfsph", "pcisph", "pbf", "wcsph"};

  (void)state;
  for (int k = 0; k < 8; k++) {
    SPH         sph = NewFluid(0.01);
    const char *name;

    sph->params.solver = k;
    assert_petsc(SPHGetSolver(sph, &name, NULL));
    assert_string_equal(name, names[k]);
    assert_petsc(SPHDestroy(&sph));
  }
}

/* the equation of state: no pressure at rest density, slope c^2 there, the plain one for gamma 1; what is estimated keeps Mach 0.1 */
static void EquationOfStateIsTaits(void **state)
{
  const double c = 30.0, e = 1e-4;

  (void)state;
  for (double gamma = 1.0; gamma < 8.0; gamma += 3.0) {
    assert_true(SPHTait(RHO0, RHO0, c, gamma) == 0.0);
    assert_close((SPHTait(RHO0 + e, RHO0, c, gamma) - SPHTait(RHO0 - e, RHO0, c, gamma)) / (2 * e), c * c, 1e-8, c * c); // differences
  }
  assert_close(SPHTait(1.07 * RHO0, RHO0, c, 1.0), c * c * 70.0, 1e-12, c * c * 70.0);
  assert_close(SPHTait(2.0 * RHO0, RHO0, c, 7.0), RHO0 * c * c / 7.0 * 127.0, 1e-12, RHO0 * c * c * 18.0);
  assert_close(SPHSoundSpeed(10.0, 3.0, 9.81, 0.0), 30.0, 1e-15, 30.0);

  // the step: c dt is a part of the support, and of it less with viscosity
  assert_close(SPHAcousticStep(0.4, 0.0, c, 0.02) * c, 0.4 * 0.02, 1e-15, 0.02);
  assert_true(SPHAcousticStep(0.4, 1.0, c, 0.02) < SPHAcousticStep(0.4, 0.0, c, 0.02));

  SPH             sph   = Fluid(&Rows[3], 0.01);
  const PetscReal lo[3] = {0, 0, -0.1}, hi[3] = {1, 1, 1}, g[3] = {0, 0, -10.0}, v[3] = {0, 3, 0};
  PetscReal       dt;

  assert_petsc(SPHSetDomain(sph, lo, hi, 16, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 5, 5, 5, 0.01, 0.0, v);
  assert_petsc(SPHSetUp(sph));
  assert_close(sph->sound_speed, 10.0 * sqrt(9.0 + 2.0 * 10.0 * 0.145), 1e-12, 50.0); // the highest particle stands 0.145 m above the floor
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHGetTimeStep(sph, &dt));
  assert_close(dt, SPHAcousticStep(0.4, 0.02, sph->sound_speed, sph->h), 1e-14, dt);
  assert_petsc(SPHDestroy(&sph));
}

/* plane walls at predicted positions: what the search finds there a step later */
static void WallDensityIsThatOfTheNextStep(void **state)
{
  const PetscReal dt = 1e-3, lo[3] = {0, 0, 0}, hi[3] = {0.05, 0.05, 0.2}, g[3] = {1, 2, -9.81};
  SPH             sph = Fluid(&Rows[2], 0.01);
  PetscReal       rho[175] = {0}, found[175];

  (void)state;
  assert_petsc(SPHSetDomain(sph, lo, hi, 31, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 5, 5, 7, 0.01, 0.1, g); // it flies towards a corner
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHPredict(sph, dt));
  assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
  assert_petsc(SPHAdvance(sph, dt));
  SPHAddWallDensity_Internal(sph, dt, sph->x, rho);
  for (int i = 0; i < 175; i++) found[sph->id[i]] = rho[i];
  assert_petsc(SPHUpdateNeighbors(sph));
  for (int i = 0; i < 175; i++) assert_close(found[sph->id[i]], RHO0 * (1.0 - sph->open[i]), 1e-13, RHO0);
  assert_petsc(SPHDestroy(&sph));
}

/* pcisph: the density that it has predicted for the last correction is what the next step finds, and tolerance bounds its largest */
static void PredictedDensityComesTrue(void **state)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.08, 0.08, 0.2}, g[3] = {0, 0, -9.81};
  SPH             sph = Fluid(&Rows[2], 0.01);
  SPHStats        stats;

  (void)state;
  sph->params.tolerance = 1e-3;
  assert_petsc(SPHSetDomain(sph, lo, hi, 31, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 8, 8, 8, 0.01, 0.05, NULL);
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHPack(sph, 1e-4, 100, NULL, NULL));
  for (int s = 0; s < 10; s++) {
    (void)AdaptiveStep(sph);
    assert_true(sph->converged && sph->iterations >= 3);
  }
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHPredict(sph, 1e-3));
  assert_petsc(SPHGetStats(sph, &stats));
  assert_true(stats.compression_max < 1.5e-3); // the last correction comes after the last test, and pairs at the end of their reach are not in the lists
  assert_true(stats.compression_max > 1e-5);
  assert_petsc(SPHDestroy(&sph));
}

CHECK_MAIN(cmocka_unit_test(StillWaterStandsOnItsFloor), cmocka_unit_test(DropKeepsItsMomentum), cmocka_unit_test(ReactionIsTheImpulse), cmocka_unit_test(DamBreakStaysInItsTank),
           cmocka_unit_test(ThreadsDoNotChangeTheResult), cmocka_unit_test(NamesAreTheSolvers), cmocka_unit_test(EquationOfStateIsTaits),
           cmocka_unit_test(WallDensityIsThatOfTheNextStep), cmocka_unit_test(PredictedDensityComesTrue))
