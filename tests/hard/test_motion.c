/* Hard cases in time: a hundred turns of a spinning body, ten periods of a large vibration, the critical step of real meshes. */
#include "hard/hard.h"

#define TURNS 100
#define SPIN 50.0 /* [rad/s]; the corners move at a fifth of the speed of sound */

static void Spin(const PetscReal X[3], PetscReal v[3])
{
  v[0] = -SPIN * (X[1] - 0.1);
  v[1] = SPIN * (X[0] - 0.15);
  v[2] = 0.0;
}

/* root mean square distance of the nodes from the axis */
static double Radius(TLED tled)
{
  const PetscReal *x;
  PetscInt         n;
  double           sum = 0.0;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetPositions(tled, &x, NULL));
  for (PetscInt a = 0; a < n; a++) sum += pow(x[3 * a] - 0.15, 2.0) + pow(x[3 * a + 1] - 0.1, 2.0);
  return sqrt(sum / n);
}

/* a free block turns a hundred times: its angular momentum stays to round-off, its energy to the error of the step, and it does not grow:
   the radius, which breathes, is the same in the mean over the last ten turns as over the first ten */
static void Spin_OfAHundredTurns(void **state)
{
  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_T10; element++) {
    const Block block = {.n = {3, 2, 2}, .size = {0.3, 0.2, 0.2}, .order = element == TLED_ELEMENT_T10 ? 2 : 1};
    TLEDParams *p;
    TLED        tled = NewBlock(&block, &p);
    TLEDStats   s0, s;
    Vec         v;
    double      energy = 0.0, angular = 0.0, first = 0.0, last = 0.0;
    PetscInt    n, steps = 0;
    char        name[80];

    p->element = element;
    assert_petsc(TLEDSetUp(tled));
    RemoveBlock(p);
    assert_petsc(TLEDGetVectors(tled, NULL, &v, NULL));
    SetVec(tled, v, Spin);
    assert_petsc(TLEDGetStats(tled, &s0));
    for (int i = 0; i < 20 * TURNS; i++) {
      assert_petsc(TLEDAdvance(tled, 2.0 * 3.14159265358979323846 / SPIN / 20.0, &n));
      assert_petsc(TLEDGetStats(tled, &s));
      steps += n;
      energy  = fmax(energy, fabs(s.kinetic + s.strain - s0.kinetic) / s0.kinetic);
      angular = fmax(angular, fabs(s.angular[2] / s0.angular[2] - 1.0));
      if (i < 200) first += Radius(tled) / 200.0;
      if (i >= 20 * TURNS - 200) last += Radius(tled) / 200.0;
    }
    snprintf(name, sizeof name, "spin of 100 turns (%s)", element_name[element]);
    printf("hard: %s | time steps | %d | -\n", name, (int)steps);
    Hard(name, "angular momentum, largest relative change", angular, 1e-10); /* round-off of that many steps */
    Hard(name, "energy, largest change over the kinetic one", energy, 1e-3);
    Hard(name, "radius, last ten turns over the first ten, minus 1", fabs(last / first - 1.0), 1e-3);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* slope of the straight line through y(i), times n: the drift over all of it */
static double Drift(int n, const double y[])
{
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;

  for (int i = 0; i < n; i++) sx += i, sy += y[i], sxx += (double)i * i, sxy += i * y[i];
  return n * (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

#define SAMPLES 1000

/* a cantilever dropped under its weight, which swings through half its length or more, ten periods without damping: the total energy stays
   within 0.1 per cent of the largest kinetic energy, and no straight line rises through it */
static void LargeVibration_KeepsItsEnergy(void **state)
{
  const PetscReal g[3] = {0.0, 0.0, -9.81};

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_T10; element++) {
    const Block block = {.n = {10, 1, 1}, .size = {1.0, 0.1, 0.1}, .order = 2};
    TLEDParams *p;
    TLED        tled = element == TLED_ELEMENT_T10 ? NewBlock(&block, &p) : NewBody("tests/meshes/beam_h1.msh", &p);
    double      error[SAMPLES], worst = 0.0, top = 0.0, deep = 0.0;
    const char *tip = element == TLED_ELEMENT_T10 ? "xmax" : "tip";
    char        name[80];
    PetscInt    n, steps = 0;

    p->element = element;
    if (element == TLED_ELEMENT_ANP) p->elastic.poisson = 0.45;
    AddName(&p->fixed, element == TLED_ELEMENT_T10 ? "xmin" : "clamp");
    assert_petsc(TLEDSetGravity(tled, g));
    assert_petsc(TLEDSetUp(tled));
    if (element == TLED_ELEMENT_T10) RemoveBlock(p);
    for (int i = 0; i < SAMPLES; i++) {
      TLEDStats s;
      assert_petsc(TLEDAdvance(tled, 10.0 / 0.88228 / SAMPLES, &n)); /* at least ten periods: the exact beam's is the longest */
      assert_petsc(TLEDGetStats(tled, &s));
      steps += n;
      error[i] = s.kinetic + s.strain + s.gravity_potential;
      worst    = fmax(worst, fabs(error[i]));
      top      = fmax(top, s.kinetic);
      deep     = fmax(deep, -MeanOf(tled, tip, 2));
    }
    snprintf(name, sizeof name, "ten periods of a large vibration (%s)", element_name[element]);
    printf("hard: %s | time steps | %d | -\n", name, (int)steps);
    HardBetween(name, "deepest deflection over length", deep, 0.35, 0.9);
    Hard(name, "energy error over the largest kinetic energy", worst / top, 1e-3);
    Hard(name, "its drift over the ten periods", fabs(Drift(SAMPLES, error)) / top, 1e-4);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* critical step of the reference beams against 2/omega_max of an independent code (DOLFINx 0.5.2, SLEPc 3.18.2: P1, lumped mass, clamped
   at x = 0, E 3 MPa, nu 0.3, rho 1000) */
static void CriticalStep_OfTheBeams(void **state)
{
  const char  *mesh[3]  = {"tests/meshes/beam_h1.msh", "tests/meshes/beam_h2.msh", "tests/meshes/beam_h3.msh"};
  const double exact[3] = {3.041771723301798e-4, 2.702779378e-4, 1.7532841941510162e-4};

  (void)state;
  for (int i = 0; i < 3; i++) {
    TLEDParams *p;
    TLED        tled = NewBody(mesh[i], &p);
    PetscReal   dt;
    char        name[80];

    AddName(&p->fixed, "clamp");
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetCriticalStep(tled, &dt));
    snprintf(name, sizeof name, "critical step of beam_h%d", i + 1);
    Hard(name, "relative error of the power iteration", fabs(dt / exact[i] - 1.0), 0.02);
    assert_petsc(TLEDDestroy(&tled));
  }
}

CHECK_MAIN(cmocka_unit_test(Spin_OfAHundredTurns), cmocka_unit_test(LargeVibration_KeepsItsEnergy),
           cmocka_unit_test(CriticalStep_OfTheBeams))
