/* laminar flows between planar walls: their profiles, their wall friction, and the body force that drives them (method 1); the operator of
   viscosity, and its implicit step */
#include "fluid.h"

#include "sph/sph_impl.h"

enum { LAYERS = 8 };
#define HEIGHT(dx) (1.03 * LAYERS * (dx))

/* a channel filled to 97 % (in an overfull one the pressure between walls acts as dry friction) 0 < z < H between no-slip walls, periodic along x and y, Reynolds number of order one */
static SPH Channel(PetscReal dx, PetscReal nu, int layers, int form, int solver)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {4 * dx, 4 * dx, 1.03 * layers * dx};
  SPH             sph = NewFluid(dx);

  sph->params.viscosity        = nu * RHO0;
  sph->params.noise_damping    = 0.0;
  sph->params.viscous_form     = form;
  sph->params.viscosity_solver = solver;
  assert_petsc(SPHSetDomain(sph, lo, hi, 3u << 4, 3));
  AddLattice(sph, 4, 4, layers, dx, 0.02, NULL);
  for (PetscInt i = 0; i < sph->n; i++) sph->x[3 * i + 2] *= 1.03;
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

/* Poiseuille with 16 layers, from its parabola: U = g H^2/(8 nu), the profile within 2 % rms; walls carry the driving force */
static void PoiseuilleProfile(void **state)
{
  const PetscReal dx = 0.01, H = 1.03 * 16 * dx, nu = 1e-3, g[3] = {8.0 * nu * 0.05 / (H * H), 0, 0};
  SPH             sph = Channel(dx, nu, 16, SPH_VISCOUS_MORRIS, SPH_VISCOSITY_AUTO);
  PetscReal       force, driving;

  (void)state;
  assert_petsc(SPHSetGravity(sph, g));
  for (PetscInt i = 0; i < sph->n; i++) sph->v[3 * i] = 0.2 * (sph->x[3 * i + 2] / H) * (1.0 - sph->x[3 * i + 2] / H);
  assert_petsc(SPHSetUp(sph));
  sph->filter_rate = 0.0;
  force = Run(sph, 2.0 * H * H / (9.87 * nu)); // the slowest mode decays as exp(-pi^2 nu t/H^2)
  driving = sph->mass * (PetscReal)sph->n * g[0];
  assert_close(force, driving, 0.02, driving);
  assert_close(ParabolaError(sph, H, 0.05), 0.0, 0.02, 1.0);
  assert_petsc(SPHDestroy(&sph));
}

/* the controller finds the force that Poiseuille's law gives, f = 12 nu Um/H^2, and holds the mean */
static void ControllerHoldsTheMean(void **state)
{
  const PetscReal dx = 0.01, H = HEIGHT(dx), nu = 1e-3, Um = 0.035;
  SPH             sph = Channel(dx, nu, LAYERS, SPH_VISCOUS_MORRIS, SPH_VISCOSITY_AUTO);
  SPHStats        stats;

  (void)state;
  sph->params.mean_velocity[0] = Um;
  for (PetscInt i = 0; i < sph->n; i++) sph->v[3 * i] = 6.0 * Um * (sph->x[3 * i + 2] / H) * (1.0 - sph->x[3 * i + 2] / H);
  assert_petsc(SPHSetUp(sph));
  sph->filter_rate = 0.0;
  (void)Run(sph, 3.0 * H * H / (9.87 * nu));
  assert_petsc(SPHGetStats(sph, &stats));
  assert_close(stats.momentum[0] / (sph->mass * (PetscReal)sph->n), Um, 0.02, Um);
  assert_close(stats.body_force[0], 12.0 * nu * Um / (H * H), 0.12, 12.0 * nu * Um / (H * H));
  assert_true(stats.body_force[1] == 0.0 && stats.body_force[2] == 0.0);
  assert_true(stats.viscous_loss > 0.0);
  assert_petsc(SPHDestroy(&sph));
}

/* a shear wave decays at nu k^2 in a periodic box of particles as disordered as in settled flow, which hold still: pairs alone, in both forms.
   Viscosity goes with the square of the volume that density tells, here 3 % off. */
static void ShearWaveDecays(void **state)
{
  const PetscReal dx = 0.01, L = 20 * dx, nu = 1e-3, k = 2.0 * PETSC_PI / L, lo[3] = {0, 0, 0}, hi[3] = {5 * dx, 5 * dx, L};

  (void)state;
  for (int form = 0; form < 2; form++) {
    SPH       sph = NewFluid(dx);
    PetscReal vKv = 0.0, vv = 0.0, density = 0.0;

    sph->params.viscosity    = nu * RHO0;
    sph->params.viscous_form = form;
    assert_petsc(SPHSetDomain(sph, lo, hi, 0, 7));
    AddLattice(sph, 5, 5, 20, dx, 0.2, NULL); // the disorder for which the coefficients are calibrated
    for (PetscInt i = 0; i < sph->n; i++) sph->v[3 * i] = 0.01 * sin(k * sph->x[3 * i + 2]);
    assert_petsc(SPHSetUp(sph));
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHPredict(sph, 1e-4));
    sph->table->Viscous(&sph->loops, form, sph->v, sph->accel);
    for (PetscInt i = 0; i < sph->n; i++) {
      vKv -= sph->v[3 * i] * sph->accel[3 * i];
      vv += sph->v[3 * i] * sph->v[3 * i];
      density += sph->rho[i] / (RHO0 * (PetscReal)sph->n);
    }
    assert_close(vKv / vv * density * density, nu * k * k, 0.03, nu * k * k);
    assert_petsc(SPHDestroy(&sph));
  }
}

static PetscReal Random(unsigned *seed)
{
  *seed = *seed * 1103515245u + 12345u;
  return 2.0 * ((*seed >> 16) & 0x7fff) / 32767.0 - 1.0;
}

/* w.Kv = v.Kw and v.Kv >= 0, in both forms; uniform flow feels nothing; Monaghan's form leaves a rigid rotation alone */
static void OperatorIsSymmetric(void **state)
{
  (void)state;
  for (int form = 0; form < 2; form++) {
    SPH        sph  = NewFluid(0.01);
    unsigned   seed = 7;
    PetscReal *a[4], *f[4], wKv = 0, vKw = 0, vKv = 0, size = 0, turn = 0;

    sph->params.viscosity    = 1.0;
    sph->params.viscous_form = form;
    AddLattice(sph, 6, 6, 6, 0.01, 0.2, NULL);
    assert_petsc(SPHSetUp(sph));
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHPredict(sph, 1e-4));
    for (int k = 0; k < 4; k++) {
      a[k] = (PetscReal *)malloc(sizeof(PetscReal) * 3 * (size_t)sph->n);
      f[k] = (PetscReal *)malloc(sizeof(PetscReal) * 3 * (size_t)sph->n);
      for (PetscInt i = 0; i < sph->n; i++) {
        const PetscReal *x = sph->x + 3 * i, spin[3] = {0, -x[2], x[1]};
        for (int q = 0; q < 3; q++) a[k][3 * i + q] = k < 2 ? Random(&seed) : k == 2 ? 1.0 + q : spin[q];
      }
      sph->table->Viscous(&sph->loops, form, a[k], f[k]);
    }
    for (PetscInt i = 0; i < sph->n; i++) {
      for (int q = 0; q < 3; q++) {
        const PetscInt m = 3 * i + q;
        wKv -= a[1][m] * f[0][m];
        vKw -= a[0][m] * f[1][m];
        vKv -= a[0][m] * f[0][m];
        size += PetscAbsReal(a[1][m] * f[0][m]);
        assert_true(f[2][m] == 0.0);
        turn = PetscMax(turn, PetscAbsReal(f[3][m]));
      }
    }
    assert_close(wKv, vKw, 1e-12, size);
    assert_true(vKv > 0.0);
    if (form == SPH_VISCOUS_MONAGHAN) assert_close(turn, 0.0, 1e-10, sph->viscous_norm * 0.04);
    for (int k = 0; k < 4; k++) {
      free(a[k]);
      free(f[k]);
    }
    assert_petsc(SPHDestroy(&sph));
  }
}

/* what the fluid gains and the walls get is what gravity gives, to round-off: explicit and implicit, in both forms, also in single precision,
   at a step 1000 times the explicit one; and the implicit equation holds */
static void MomentumIsKept(void **state)
{
  const PetscReal g[3] = {0.3, 0.2, 0}, nu = 1.0;

  (void)state;
  for (int run = 0; run < 8; run++) {
    SPH        sph  = Channel(0.01, nu, LAYERS, run % 2, run / 2 % 2 ? SPH_VISCOSITY_IMPLICIT : SPH_VISCOSITY_EXPLICIT);
    unsigned   seed = 11;
    PetscReal  before[2] = {0, 0}, after[2] = {0, 0}, dt, *Kw, residual = 0, size = 0, *start;

    if (run >= 4) sph->params.precision = SPH_PRECISION_SINGLE;
    assert_petsc(SPHSetGravity(sph, g));
    assert_petsc(SPHSetUp(sph));
    dt = SPHViscousStep_Internal(sph) * (run / 2 % 2 ? 1000.0 : 1.0);
    assert_petsc(SPHUpdateNeighbors(sph));
    start = (PetscReal *)malloc(sizeof(PetscReal) * 3 * (size_t)sph->n);
    Kw    = (PetscReal *)malloc(sizeof(PetscReal) * 3 * (size_t)sph->n);
    for (PetscInt i = 0; i < 3 * sph->n; i++) start[i] = sph->v[i] = Random(&seed);
    assert_petsc(SPHPredict(sph, dt));
    assert_petsc(SPHPlaneForces_Internal(sph));
    sph->table->Viscous(&sph->loops, run % 2, sph->v_viscous, Kw);
    for (PetscInt i = 0; i < sph->n; i++) {
      for (int q = 0; q < 3; q++) {
        const PetscInt m = 3 * i + q;
        const PetscReal right = start[m] + dt * g[q];
        if (q < 2) before[q] += sph->mass * start[m];
        if (q < 2) after[q] += sph->mass * sph->v_star[m];
        residual += PetscSqr((1.0 + dt * sph->response[i]) * sph->v_viscous[m] - dt * Kw[m] - right);
        size += PetscSqr(right);
      }
    }
    for (int q = 0; q < 2; q++) {
      const PetscReal gained = after[q] - before[q] + dt * (sph->wall_force[12 + q] + sph->wall_force[15 + q]);
      assert_close(gained, sph->mass * (PetscReal)sph->n * g[q] * dt, 1e-13 * (run / 2 % 2 ? 1000.0 : 1.0), sph->mass * (PetscReal)sph->n);
    }
    if (run / 2 % 2) assert_close(sqrt(residual), 0.0, 1e-7, sqrt(size)); // rtol of the solve, 1e-8
    free(start);
    free(Kw);
    assert_petsc(SPHDestroy(&sph));
  }
}

/* a step of any length is stable: energy falls, and in honey the flow stops within one step */
static void ImplicitIsStable(void **state)
{
  const PetscReal nu[3] = {1e-6, 1e-2, 1.0};

  (void)state;
  for (int k = 0; k < 3; k++) {
    SPH       sph  = Channel(0.01, nu[k], LAYERS, SPH_VISCOUS_MORRIS, SPH_VISCOSITY_IMPLICIT);
    unsigned  seed = 3;
    PetscReal before = 0, after = 0;

    assert_petsc(SPHSetUp(sph));
    assert_petsc(SPHUpdateNeighbors(sph));
    for (PetscInt i = 0; i < 3 * sph->n; i++) {
      sph->v[i] = Random(&seed);
      before += PetscSqr(sph->v[i]);
    }
    assert_petsc(SPHPredict(sph, 1.0));
    for (PetscInt i = 0; i < 3 * sph->n; i++) after += PetscSqr(sph->v_star[i]);
    assert_true(after < before);
    if (k == 2) assert_true(after < 1e-4 * before);
    assert_petsc(SPHDestroy(&sph));
  }
}

/* honey at rest in a tank with side walls: its weight comes to rest on the floor though a step is long enough for friction to carry it; the packed
   lattice still spreads against its own viscosity, which the floor and the walls feel as a fifth of the weight */
static void HoneyAtRestHasItsPressure(void **state)
{
  const PetscReal dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {0.05, 0.05, 0.2}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(dx);
  PetscReal       force[18], weight, dt;

  (void)state;
  sph->params.viscosity = 1000.0;
  assert_petsc(SPHSetDomain(sph, lo, hi, 31, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 5, 5, 6, dx, 0.0, NULL);
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHPack(sph, 1e-4, 50, NULL, NULL));
  for (int step = 0; step < 60; step++) {
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHGetTimeStep(sph, &dt));
    assert_petsc(SPHPredict(sph, dt));
    assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
    assert_petsc(SPHGetWallForces(sph, force));
    assert_petsc(SPHAdvance(sph, dt));
  }
  weight = sph->mass * (PetscReal)sph->n * 9.81;
  assert_true(dt > 100.0 * SPHViscousStep_Internal(sph));
  assert_close(force[14], -weight, 0.35, weight);
  assert_close(force[2] + force[5] + force[8] + force[11], 0.0, 0.35, weight);
  assert_petsc(SPHDestroy(&sph));
}

CHECK_MAIN(cmocka_unit_test(PoiseuilleProfile), cmocka_unit_test(ControllerHoldsTheMean), cmocka_unit_test(ShearWaveDecays), cmocka_unit_test(OperatorIsSymmetric),
           cmocka_unit_test(MomentumIsKept), cmocka_unit_test(ImplicitIsStable), cmocka_unit_test(HoneyAtRestHasItsPressure))
