/* laminar flows between planar walls: their profiles, their wall friction, and the body force that drives them (method 1) */
#include "fluid.h"

#include "sph/sph_impl.h"

enum { LAYERS = 8 };
#define HEIGHT(dx) (1.03 * LAYERS * (dx))

/* a channel filled to 97 % (in an overfull one the pressure between walls acts as dry friction) 0 < z < H between no-slip walls, periodic along x and y, Reynolds number of order one */
static SPH Channel(PetscReal dx, PetscReal nu)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {4 * dx, 4 * dx, HEIGHT(dx)};
  SPH             sph = NewFluid(dx);

  sph->params.viscosity     = nu * RHO0;
  sph->params.max_time_step = 7e-3;
  sph->params.noise_damping = 0.0;
  assert_petsc(SPHSetDomain(sph, lo, hi, 3u << 4, 3));
  AddLattice(sph, 4, 4, LAYERS, dx, 0.02, NULL);
  return sph;
}

/* runs until `end`; returns the mean over the last quarter of the force on both walls along x */
static PetscReal Run(SPH sph, PetscReal end)
{
  PetscReal t = 0.0, dt, force[18], impulse = 0.0, since = 0.0;

  while (t < end) {
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHGetTimeStep(sph, &dt));
    assert_petsc(SPHPredict(sph, dt));
    assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
    assert_petsc(SPHGetWallForces(sph, force));
    assert_petsc(SPHAdvance(sph, dt));
    t += dt;
    if (t < 0.75 * end) continue;
    impulse += dt * (force[12] + force[15]);
    since += dt;
  }
  return impulse / since;
}

/* rms difference from u(z) = 4 U (z/H)(1 - z/H), over U */
static PetscReal ParabolaError(SPH sph, PetscReal H, PetscReal U)
{
  PetscReal sum = 0.0;

  for (PetscInt i = 0; i < sph->n; i++) {
    const PetscReal z = sph->x[3 * i + 2] / H;
    sum += PetscSqr(sph->v[3 * i] / U - 4.0 * z * (1.0 - z));
  }
  return sqrt(sum / (PetscReal)sph->n);
}

/* Poiseuille: U = g H^2/(8 nu); walls carry the whole driving force */
static void PoiseuilleProfile(void **state)
{
  const PetscReal dx = 0.01, H = HEIGHT(dx), nu = 1e-3, g[3] = {8.0 * nu * 0.05 / (H * H), 0, 0};
  SPH             sph = Channel(dx, nu);
  PetscReal       force, driving;

  (void)state;
  assert_petsc(SPHSetGravity(sph, g));
  assert_petsc(SPHSetUp(sph));
  sph->filter_rate = 0.0;
  force = Run(sph, 5.0 * H * H / (9.87 * nu)); // the slowest mode decays as exp(-pi^2 nu t/H^2); the first half shakes the lattice down
  driving = sph->mass * (PetscReal)sph->n * g[0];
  assert_close(force, driving, 0.05, driving);
  assert_close(ParabolaError(sph, H, 0.05), 0.0, 0.1, 1.0);
  assert_petsc(SPHDestroy(&sph));
}

/* the controller finds the force that Poiseuille's law gives, f = 12 nu Um/H^2, and holds the mean */
static void ControllerHoldsTheMean(void **state)
{
  const PetscReal dx = 0.01, H = HEIGHT(dx), nu = 1e-3, Um = 0.035;
  SPH             sph = Channel(dx, nu);
  SPHStats        stats;

  (void)state;
  sph->params.mean_velocity[0] = Um;
  assert_petsc(SPHSetUp(sph));
  sph->filter_rate = 0.0;
  (void)Run(sph, 5.0 * H * H / (9.87 * nu));
  assert_petsc(SPHGetStats(sph, &stats));
  assert_close(stats.momentum[0] / (sph->mass * (PetscReal)sph->n), Um, 0.02, Um);
  assert_close(stats.body_force[0], 12.0 * nu * Um / (H * H), 0.15, 12.0 * nu * Um / (H * H));
  assert_true(stats.body_force[1] == 0.0 && stats.body_force[2] == 0.0);
  assert_true(stats.viscous_loss > 0.0);
  assert_petsc(SPHDestroy(&sph));
}

/* a shear wave decays as exp(-nu k^2 t) in a periodic box: viscosity between particles alone, in both forms */
static void ShearWaveDecays(void **state)
{
  const PetscReal dx = 0.01, L = 20 * dx, nu = 1e-3, k = 2.0 * PETSC_PI / L, lo[3] = {0, 0, 0}, hi[3] = {5 * dx, 5 * dx, L};

  (void)state;
  for (int form = 0; form < 2; form++) {
    SPH       sph       = NewFluid(dx);
    PetscReal amplitude = 0.0;

    sph->params.viscosity    = nu * RHO0;
    sph->params.viscous_form = form;
    sph->params.tolerance    = 1e-6;
    assert_petsc(SPHSetDomain(sph, lo, hi, 0, 7));
    AddLattice(sph, 5, 5, 20, dx, 0.2, NULL); // the disorder for which the coefficients are calibrated
    for (PetscInt i = 0; i < sph->n; i++) sph->v[3 * i] = 0.01 * sin(k * sph->x[3 * i + 2]);
    assert_petsc(SPHSetUp(sph));
    (void)Run(sph, 0.5 / (nu * k * k));
    for (PetscInt i = 0; i < sph->n; i++) amplitude += 2.0 / (PetscReal)sph->n * sph->v[3 * i] * sin(k * sph->x[3 * i + 2]);
    assert_close(amplitude, 0.01 * exp(-0.5), 0.03, 0.01);
    assert_petsc(SPHDestroy(&sph));
  }
}

CHECK_MAIN(cmocka_unit_test(PoiseuilleProfile), cmocka_unit_test(ControllerHoldsTheMean), cmocka_unit_test(ShearWaveDecays))
