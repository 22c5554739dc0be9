/* Natural frequencies against an independent finite element code on the same meshes with the same lumped masses (DOLFINx 0.5.2 with SLEPc
   3.18.2, P1 elements, vertex quadrature of the mass; beam 1 x 0.1 x 0.1 m clamped at x = 0, E 3 MPa, nu 0.3, rho 1000), the highest one
   against the power iteration of the critical step, and the explicit solid's ring-down. */
#include "unit/tled/body.h"
#include "tled/tled_implicit.h"

#define N 6

static const struct {
  const char *mesh;
  double      frequency[N], omega_max; /* [Hz], [rad/s] */
} lumped[] = {
    {"h1", {1.1501146641734612, 1.158987861426809, 6.829834214157479, 6.997053030623273, 9.812738086611741, 13.769971885099489}, 6575.11538982},
    {"h2", {0.9974365112880985, 1.0014907901563652, 5.924857733101848, 5.9616627884322, 9.08292573954082, 13.766972735650276}, 7399.789795441899},
    {"h3", {0.9413105351263548, 0.943215040120007, 5.6309305219729735, 5.63725449566391, 8.596512712008144, 13.750420346449241}, 11407.163664621543},
};

static TLED Beam(const char mesh[], TLEDParams **p)
{
  char path[64];
  TLED tled;

  snprintf(path, sizeof path, "tests/meshes/beam_%s.msh", mesh);
  tled = NewBody(path, p);
  AddName(&(*p)->fixed, "clamp");
  return tled;
}

static void LowestFrequencies_AreTheOtherCodes(void **state)
{
  (void)state;
  for (size_t i = 0; i < 3; i++) {
    TLEDParams *p;
    TLED        tled = Beam(lumped[i].mesh, &p);
    PetscReal   f[N], worst = 0.0;

    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDModes(PETSC_COMM_SELF, tled, N, f, NULL));
    for (int k = 0; k < N; k++) worst = fmax(worst, fabs(f[k] / lumped[i].frequency[k] - 1));
    printf("%s: the %d lowest frequencies, %.6f to %.6f Hz, within %.1e\n", lumped[i].mesh, N, f[0], f[N - 1], worst);
    assert_close(worst, 0.0, 1e-6, 1.0); /* what was asked; both codes' eigenvalue tolerance is smaller */
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* power iteration finds the critical step within 2 % (the bar), SLEPc's own to the digits of the other code's */
static void CriticalStep_IsNearTheExactOne(void **state)
{
  (void)state;
  for (size_t i = 0; i < 3; i++) {
    TLEDParams *p;
    TLED        tled = Beam(lumped[i].mesh, &p);
    PetscReal   exact, found;

    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDExactCriticalStep(PETSC_COMM_SELF, tled, &exact));
    assert_petsc(TLEDGetCriticalStep(tled, &found));
    printf("%s: critical step %.6e s, power iteration %+.3f %%, other code %+.1e\n", lumped[i].mesh, exact, 100 * (found / exact - 1),
           2 / lumped[i].omega_max / exact - 1);
    assert_close(exact, 2 / lumped[i].omega_max, 1e-6, exact);
    assert_close(found, exact, 0.02, exact);
    assert_true(found >= exact * (1 - 1e-9)); /* from below in omega */
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* a body that nothing holds: six rigid motions, then vibrations; orthonormal in mass */
static void FreeBody_HasSixRigidModes(void **state)
{
  TLEDParams      *p;
  TLED             tled = NewBody("tests/meshes/beam_h1.msh", &p);
  PetscReal        f[9], *shapes;
  const PetscReal *mass;
  PetscInt         n;

  (void)state;
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMass(tled, &mass));
  assert_petsc(PetscMalloc1(9 * 3 * n, &shapes));
  assert_petsc(TLEDModes(PETSC_COMM_SELF, tled, 9, f, shapes));
  for (int k = 0; k < 6; k++) assert_close(f[k], 0.0, 1e-4, f[6]); /* sqrt of round-off of omega_max^2 */
  assert_true(f[6] > 1.0);
  for (int i = 0; i < 9; i++)
    for (int k = 0; k <= i; k++) {
      double sum = 0.0;
      for (PetscInt j = 0; j < 3 * n; j++) sum += mass[j / 3] * shapes[3 * n * i + j] * shapes[3 * n * k + j];
      assert_close(sum, i == k, 1e-8, 1.0);
    }
  assert_petsc(PetscFree(shapes));
  assert_petsc(TLEDDestroy(&tled));
}

/* The explicit solid rings at the modes' frequencies: the nearer, the longer it is listened to. Lowest two, 0.8 % apart, each in its own
   coordinate. */
static void RingDown_IsAtTheModes(void **state)
{
  enum { MODES = 2 };
  static const double seconds[] = {2.0, 4.0, 8.0};
  const double        dt = 0.02;
  TLEDParams         *p;
  TLED                tled = Beam("h1", &p);
  PetscReal           f[MODES], *shapes, *modal, last = 1.0;
  PetscInt            n, tip;

  (void)state;
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(PetscMalloc2(MODES * 3 * n, &shapes, MODES * 2000, &modal));
  assert_petsc(TLEDModes(PETSC_COMM_SELF, tled, MODES, f, shapes));
  tip = NodeAt(tled, 1.0, 0.05, 0.05);
  for (size_t i = 0; i < sizeof seconds / sizeof *seconds; i++) {
    const PetscInt m     = (PetscInt)(seconds[i] / dt);
    PetscReal      worst = 0.0, peak;
    assert_petsc(TLEDRingDown(tled, MODES, f, shapes, 1e-4, tip, dt, m, modal, NULL));
    for (int k = 0; k < MODES; k++) {
      assert_petsc(TLEDSpectrumPeak(m, dt, &modal[m * k], 0.5, 3.0, &peak));
      worst = fmax(worst, fabs(peak / f[k] - 1));
    }
    printf("ring-down of %4.1f s: within %.1e of the modes\n", seconds[i], worst);
    assert_true(worst < 0.8 * last);
    last = worst;
  }
  assert_close(last, 0.0, 2e-5, 1.0); /* measured 4e-6 */
  assert_petsc(PetscFree2(shapes, modal));
  assert_petsc(TLEDDestroy(&tled));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(LowestFrequencies_AreTheOtherCodes), cmocka_unit_test(CriticalStep_IsNearTheExactOne),
                                     cmocka_unit_test(FreeBody_HasSixRigidModes), cmocka_unit_test(RingDown_IsAtTheModes)};
  PetscBool               have;
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL) || TLEDHaveModes(&have)) return 1;
  failed = have ? cmocka_run_group_tests(tests, NULL, NULL) : 77; /* skipped without SLEPc */
  return PetscFinalize() || (failed && have) ? 1 : failed;
}
