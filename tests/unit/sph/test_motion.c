/* motions that are known exactly: free fall, momenta of a closed drop, restarts, breakdowns (method 6) */
#include "fluid.h"

#include <string.h>

#include "sph/sph_impl.h"

/* no pressure arises in a lattice drop that falls: velocity g t, path as symplectic Euler sums it, dt^2 n (n + 1)/2 g */
static void FreeFallIsExact(void **state)
{
  const PetscReal dt = 1e-3, g[3] = {0.3, 0, -9.81};
  const int       steps = 20;
  SPH             sph   = NewFluid(0.01);
  PetscReal       x0[81];

  (void)state;
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 3, 3, 3, 0.0105, 0.0, NULL); // nowhere denser than rest density
  memcpy(x0, sph->x, sizeof(x0));
  assert_petsc(SPHSetUp(sph));
  for (int s = 0; s < steps; s++) OneStep(sph, dt);
  for (int i = 0; i < 27; i++) {
    for (int k = 0; k < 3; k++) {
      assert_close(sph->v[3 * i + k], steps * dt * g[k], 1e-12, 1.0);
      assert_close(sph->x[3 * i + k], x0[3 * sph->id[i] + k] + 0.5 * dt * dt * steps * (steps + 1) * g[k], 1e-13, 1.0);
    }
  }
  assert_petsc(SPHDestroy(&sph));
}

/* a compressed, spinning drop without walls bursts: momentum and angular momentum stay, in both precisions, with viscosity too */
static void ClosedDropKeepsItsMomenta(void **state)
{
  const double tolerance[2] = {1e-5, 1e-12}; // round-off of the pair loops over 50 steps

  (void)state;
  for (int variant = 0; variant < 4; variant++) {
    const PetscReal v[3]      = {0.2, 0.1, -0.3};
    SPH             sph       = NewFluid(0.01);
    PetscReal       moving, scale, spin, momentum[3], angular[3];
    SPHStats        stats;

    sph->params.precision = variant & 1;
    sph->params.viscosity = variant / 2 ? 0.5 : 0.0;
    sph->params.viscous_form = SPH_VISCOUS_MONAGHAN;
    sph->params.noise_damping = 0.0;
    AddLattice(sph, 6, 6, 6, 0.0095, 0.1, v);
    for (int i = 0; i < 216; i++) {
      sph->v[3 * i] -= 3.0 * (sph->x[3 * i + 1] - 0.03);
      sph->v[3 * i + 1] += 3.0 * (sph->x[3 * i] - 0.03);
    }
    assert_petsc(SPHSetUp(sph));
    sph->filter_rate = 50.0; // the filter keeps momenta too
    assert_petsc(SPHGetStats(sph, &stats));
    for (int k = 0; k < 3; k++) {
      momentum[k] = stats.momentum[k];
      angular[k]  = stats.angular[k];
    }
    for (int s = 0; s < 50; s++) OneStep(sph, 5e-4);
    assert_petsc(SPHGetStats(sph, &stats));
    moving = 216 * sph->mass * 0.37;
    spin   = moving * 0.03;
    scale  = tolerance[variant & 1];
    for (int k = 0; k < 3; k++) {
      assert_close(stats.momentum[k], momentum[k], scale, moving);
      assert_close(stats.angular[k], angular[k], scale, spin);
    }
    assert_true(stats.speed_max > 0.4); // it did burst
    assert_petsc(SPHDestroy(&sph));
  }
}

static SPH Tank(void)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.06, 0.06, 0.2}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(0.01);

  sph->params.precision = SPH_PRECISION_SINGLE;
  sph->params.viscosity = 1e-3;
  assert_petsc(SPHSetDomain(sph, lo, hi, 31, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 3, 6, 8, 0.01, 0.0, NULL);
  assert_petsc(SPHSetUp(sph));
  return sph;
}

static void Steps(SPH sph, int n)
{
  for (int s = 0; s < n; s++) {
    PetscReal dt;
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHGetTimeStep(sph, &dt));
    assert_petsc(SPHPredict(sph, dt));
    assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
    assert_petsc(SPHAdvance(sph, dt));
  }
}

/* 20 steps = 10 steps, saved, put into a new fluid, 10 more: the same bits */
static void RestartGivesTheSameBits(void **state)
{
  SPH              a = Tank(), b = Tank();
  const PetscReal *x, *v, *p;
  const PetscInt  *id;
  PetscInt         n;
  PetscReal        internals[SPH_INTERNALS];

  (void)state;
  Steps(a, 10);
  assert_petsc(SPHGetSize(a, &n));
  assert_petsc(SPHGetState(a, &x, &v, &p, NULL, &id));
  assert_petsc(SPHGetInternals(a, internals));
  assert_petsc(SPHSetState(b, n, id, x, v, p));
  assert_petsc(SPHSetInternals(b, internals));
  Steps(a, 10);
  Steps(b, 10);
  assert_memory_equal(a->x, b->x, sizeof(PetscReal) * 3 * (size_t)n);
  assert_memory_equal(a->p, b->p, sizeof(PetscReal) * (size_t)n);
  assert_petsc(SPHDestroy(&a));
  assert_petsc(SPHDestroy(&b));
}

/* what cannot go on says so, with step, particle and place */
static void BreakdownsNameTheParticle(void **state)
{
  SPH         sph = Tank();
  const char *message;
  PetscReal   x;

  (void)state;
  Steps(sph, 1);
  x               = sph->v[3 * 7];
  sph->v[3 * 7]   = NAN;
  assert_int_equal((int)SPHUpdateNeighbors(sph), (int)BY_ERR_BREAKDOWN);
  assert_petsc(SPHGetBreakdown(sph, &message));
  assert_non_null(strstr(message, "step 1"));
  assert_non_null(strstr(message, "not a number"));
  sph->v[3 * 7]     = x;
  sph->x[3 * 7 + 2] = -0.03;
  assert_int_equal((int)SPHUpdateNeighbors(sph), (int)BY_ERR_BREAKDOWN);
  assert_petsc(SPHGetBreakdown(sph, &message));
  assert_non_null(strstr(message, "through a wall"));
  assert_petsc(SPHDestroy(&sph));
}

/* the first step follows from gravity; later ones grow by a tenth at most and obey a fixed step */
static void TimeStepObeysItsLimits(void **state)
{
  SPH       sph = Tank();
  PetscReal dt, h;

  (void)state;
  assert_petsc(SPHGetSupport(sph, &h));
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHGetTimeStep(sph, &dt));
  assert_close(dt, 0.05 * sqrt(h / 9.81), 1e-12, dt);
  for (PetscInt i = 0; i < sph->n; i++) sph->v[3 * i] = 20.0;
  assert_petsc(SPHGetTimeStep(sph, &dt));
  assert_close(dt, 0.4 * 0.01 / 20.0, 1e-12, dt);
  sph->dt_last = 1e-5;
  assert_petsc(SPHGetTimeStep(sph, &dt));
  assert_close(dt, 1.1e-5, 1e-12, dt);
  sph->params.time_step = 3e-4;
  assert_petsc(SPHGetTimeStep(sph, &dt));
  assert_true(dt == 3e-4);
  assert_petsc(SPHDestroy(&sph));
}

CHECK_MAIN(cmocka_unit_test(FreeFallIsExact), cmocka_unit_test(ClosedDropKeepsItsMomenta), cmocka_unit_test(RestartGivesTheSameBits), cmocka_unit_test(BreakdownsNameTheParticle),
           cmocka_unit_test(TimeStepObeysItsLimits))
