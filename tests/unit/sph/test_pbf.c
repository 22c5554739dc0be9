/* position-based fluids (method 1.2): its constraint, its multiplier, its momentum, its artificial pressure; XSPH and vorticity confinement */
#include "fluid.h"

#include "sph/sph_impl.h"

#define N 200

/* a jittered block of 5 x 5 x 8, too dense by `squeeze`, with walls or without; its box is open where it has none */
static SPH Block(unsigned walls, PetscReal squeeze, void (*change)(SPHParams *))
{
  const PetscReal dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {0.05, 0.05, 0.2}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(dx);

  sph->params.solver        = SPH_SOLVER_PBF;
  sph->params.noise_damping = 0.0;
  sph->params.tolerance     = 1e-4;
  if (change) change(&sph->params);
  assert_petsc(SPHSetDomain(sph, lo, hi, walls, 0));
  if (walls) assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 5, 5, 8, dx, 0.1, NULL);
  for (int i = 0; i < 3 * N; i++) sph->x[i] = 0.02 + (1.0 - squeeze) * (sph->x[i] - 0.02);
  for (int i = 0; i < N; i++) {
    const PetscReal *x = sph->x + 3 * i;
    sph->v[3 * i]     = 0.3 * sin(90 * x[2]) - 3.0 * (x[1] - 0.02);
    sph->v[3 * i + 1] = 3.0 * (x[0] - 0.02) + 0.2 * cos(7.0 * i);
    sph->v[3 * i + 2] = -1.0 * x[2];
  }
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  return sph;
}

static PetscReal ConstraintAt(SPH sph, const PetscReal x[], int i)
{
  PetscReal rho[N], open, part[6];

  sph->table->Density(&sph->loops, x, rho);
  SPHPlanesAt_Internal(sph, 0.0, x + 3 * i, &open, part);
  return (rho[i] + RHO0 * (1.0 - open)) / RHO0 - 1.0;
}

/* sum_k |grad_k C_i|^2 rho0^2 by differences of C_i over every particle's place is the diagonal that lambda_i divides by */
static void MultiplierHasTheConstraintsGradient(void **state)
{
  const PetscReal e = 1e-6;
  SPH             sph = Block(31, 0.0, NULL);
  PetscReal       x[3 * N], diagonal[N];

  (void)state;
  sph->table->Diagonal(&sph->loops, diagonal);
  for (int k = 0; k < 3 * N; k++) x[k] = sph->x[k];
  for (int i = 0; i < N; i += 33) {
    PetscReal sum = 0.0;

    for (int k = 0; k < 3 * N; k++) {
      PetscReal up, down;
      x[k] = sph->x[k] + e;
      up   = ConstraintAt(sph, x, i);
      x[k] = sph->x[k] - e;
      down = ConstraintAt(sph, x, i);
      x[k] = sph->x[k];
      sum += PetscSqr((up - down) / (2 * e));
    }
    assert_close(sum * RHO0 * RHO0, diagonal[i], 1e-6, diagonal[i]); // (e/h)^2 of central differences, twice the kernel's third derivative
  }
  assert_petsc(SPHDestroy(&sph));
}

/* one particle's own step with its own lambda is a Newton step: it takes C_i from 1 % to second order */
static void StepTakesAParticlesErrorAway(void **state)
{
  SPH       sph = Block(31, 0.0, NULL);
  PetscReal x[3 * N], p[N], a[3 * N], diagonal[N];

  (void)state;
  sph->table->Diagonal(&sph->loops, diagonal);
  for (int i = 62; i < N; i += 41) {
    const PetscReal before = ConstraintAt(sph, sph->x, i), wanted = 0.01; // C_i - 0.01 as the constraint: the sign of the step is known
    PetscReal       after;

    for (int j = 0; j < N; j++) p[j] = j == i ? SPHConstraintStep(RHO0 * wanted, diagonal[i], 0.0) : 0.0;
    sph->table->SetPressure(&sph->loops, p, NULL);
    sph->table->Acceleration(&sph->loops);
    sph->table->GetVector(&sph->loops, a);
    for (int k = 0; k < 3 * N; k++) x[k] = sph->x[k] + a[k];
    after = ConstraintAt(sph, x, i);
    assert_close(before - after, wanted, 0.02, wanted); // the step is 1e-3 h: curvature of C
  }
  assert_petsc(SPHDestroy(&sph));
}

static void Momentum(SPH sph, PetscReal P[3], PetscReal L[3])
{
  SPHStats stats;

  assert_petsc(SPHGetStats(sph, &stats));
  for (int k = 0; k < 3; k++) {
    P[k] = stats.momentum[k];
    L[k] = stats.angular[k];
  }
}

static void Step(SPH sph, PetscReal dt)
{
  assert_petsc(SPHPredict(sph, dt));
  assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
  assert_petsc(SPHAdvance(sph, dt));
}

static void Everything(SPHParams *par)
{
  par->artificial_pressure   = 0.05;
  par->xsph                  = 0.05;
  par->vorticity_confinement = 0.01;
}

static void Converge(SPHParams *par)
{
  par->tolerance      = 1e-8;
  par->max_iterations = 20000;
}

/* linear momentum of a free drop to round-off, with artificial pressure, XSPH and confinement; of the moment of the impulses dt |grad v| is lost */
static void MomentumIsKept(void **state)
{
  PetscReal error[2];

  (void)state;
  {
    SPH       sph = Block(0, 0.04, Everything);
    PetscReal before[3], after[3], L[3];

    Momentum(sph, before, L);
    Step(sph, 1e-3);
    Momentum(sph, after, L);
    assert_true(sph->iterations > 3);
    for (int k = 0; k < 3; k++) assert_close(after[k], before[k], 1e-13, N * sph->mass * 1.0);
    assert_petsc(SPHDestroy(&sph));
  }
  for (int s = 0; s < 2; s++) {
    SPH             sph = Block(0, 0.0, Converge);
    const PetscReal dt  = s ? 5e-4 : 1e-3;
    PetscReal       P[3], before[3], after[3];

    assert_petsc(SPHPack(sph, 1e-7, 200, NULL, NULL)); // a density error's displacement does not fall with dt
    Momentum(sph, P, before);
    Step(sph, dt);
    Momentum(sph, P, after);
    error[s] = PetscAbsReal(after[2] - before[2]) / PetscAbsReal(before[2]);
    assert_petsc(SPHDestroy(&sph));
  }
  print_message("angular momentum lost in a step: %.1e, in half of it: %.1e\n", (double)error[0], (double)error[1]);
  assert_true(error[0] > 1e-12 && error[0] < 1e-3);
  assert_true(error[1] < 0.6 * error[0]);
}

/* walls get what the fluid lost: gravity and wall forces are the change of momentum */
static void WallsGetTheImpulse(void **state)
{
  const PetscReal dt = 2e-3;
  SPH             sph = Block(31, 0.03, NULL);
  PetscReal       before[3], after[3], L[3], force[18], sum[3] = {0, 0, -9.81 * N * sph->mass};

  (void)state;
  Momentum(sph, before, L);
  Step(sph, dt);
  Momentum(sph, after, L);
  assert_petsc(SPHGetWallForces(sph, force));
  for (int k = 0; k < 18; k++) sum[k % 3] -= force[k];
  for (int k = 0; k < 3; k++) assert_close((after[k] - before[k]) / dt, sum[k], 1e-11, PetscAbsReal(force[14]));
  assert_petsc(SPHDestroy(&sph));
}

/* at the places where the step ends nothing is compressed, density evaluated anew; planes did not stop anything there */
static void DensityIsRightWhereTheStepEnds(void **state)
{
  SPH       sph = Block(31, 0.01, Converge);
  PetscReal sum = 0.0;

  (void)state;
  sph->params.tolerance_norm = SPH_NORM_LARGEST;
  assert_petsc(SPHPredict(sph, 2e-3));
  assert_petsc(SPHSolvePressure(sph, 2e-3, NULL, NULL));
  assert_true(sph->converged);
  for (int i = 0; i < N; i++) assert_true(sph->p[i] >= 0.0);
  assert_petsc(SPHAdvance(sph, 2e-3));
  for (int i = 0; i < N; i++) sum = PetscMax(sum, ConstraintAt(sph, sph->x, i));
  assert_close(sum, 0.0, 1.1e-8, 1.0); // the tolerance, of the largest
  assert_petsc(SPHDestroy(&sph));
}

/* solid rotation has vorticity 2 Omega inside and no slope of it, so no confinement there; XSPH leaves uniform motion alone */
static void ConfinementFollowsTheVorticity(void **state)
{
  const PetscReal eta[3] = {0, 3, 0}, omega[3] = {0, 0, 5}, lo[3] = {0, 0, 0}, hi[3] = {0.1, 0.1, 0.1};
  SPH             sph = NewFluid(0.01);
  PetscReal       a[3], P[3] = {0, 0, 0};

  (void)state;
  SPHConfinement(0.1, eta, omega, a); // y x z = x
  assert_close(a[0], 0.5, 1e-14, 1.0);
  assert_close(a[1] + a[2], 0.0, 1e-14, 1.0);
  sph->params.vorticity_confinement = 0.02;
  sph->params.noise_damping         = 0.0;
  assert_petsc(SPHSetDomain(sph, lo, hi, 0, 7));
  AddLattice(sph, 10, 10, 10, 0.01, 0.0, NULL);
  for (int i = 0; i < 1000; i++) {
    const PetscReal x = sph->x[3 * i] - 0.05, y = sph->x[3 * i + 1] - 0.05, w = exp(-(x * x + y * y) / 4e-4);
    sph->v[3 * i]     = -y * w;
    sph->v[3 * i + 1] = x * w;
  }
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHPredict(sph, 1e-3));
  // no momentum, and the push across the slope of |omega| spins the vortex up: work on it is positive
  PetscReal work = 0.0;
  for (int i = 0; i < 1000; i++) {
    for (int k = 0; k < 3; k++) {
      P[k] += sph->v_star[3 * i + k] - sph->v[3 * i + k];
      work += (sph->v_star[3 * i + k] - sph->v[3 * i + k]) * sph->v[3 * i + k];
    }
  }
  for (int k = 0; k < 3; k++) assert_close(P[k], 0.0, 1e-13, 1000 * 0.01);
  assert_true(work > 0.0);
  assert_petsc(SPHDestroy(&sph));
}

CHECK_MAIN(cmocka_unit_test(MultiplierHasTheConstraintsGradient), cmocka_unit_test(StepTakesAParticlesErrorAway), cmocka_unit_test(MomentumIsKept), cmocka_unit_test(WallsGetTheImpulse),
           cmocka_unit_test(DensityIsRightWhereTheStepEnds), cmocka_unit_test(ConfinementFollowsTheVorticity))
