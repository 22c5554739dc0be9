/* Hard static cases: nearly incompressible, squeezed and stretched far, slivers, one layer of elements, stiffness contrast. */
#include "hard/hard.h"

/* A cube of Poisson's ratio 0.4999 bonded to the floor and pressed from above, 4 cells an edge: the sinking of its top over that by
   quadratic elements of half the size. Linear tetrahedra are too stiff, though cells that mirror
   each other lock little; the others must be right. */
static void NearlyIncompressible_IsPressed(void **state)
{
  const double low[] = {0.0, 0.0, 0.9, 0.97}, high[] = {0.0, 0.97, 1.1, 1.02};
  double       exact = 0.0;

  (void)state;
  for (int element = TLED_ELEMENT_AUTO; element <= TLED_ELEMENT_T10; element++) { /* the first is the reference */
    const int   quadratic = element == TLED_ELEMENT_AUTO || element == TLED_ELEMENT_T10, n = element == TLED_ELEMENT_T10 ? 2 : 4;
    const Block block     = {.n = {n, n, n}, .size = {0.2, 0.2, 0.2}, .order = quadratic ? 2 : 1};
    TLED        body[2];
    char        name[80];

    for (int i = 0; i < 2; i++) {
      TLEDParams    *p;
      TLEDLoadParams load;
      body[i]            = NewBlock(&block, &p);
      p->element         = element;
      p->elastic.poisson = 0.4999;
      AddName(&p->fixed, "zmin");
      assert_petsc(KeysSetDefaults(TLEDLoadKeys, &load));
      AddName(&load.groups, "zmax");
      load.traction[2] = -5e5;
      assert_petsc(TLEDAddLoad(body[i], "press", &load));
      assert_petsc(TLEDSetUp(body[i]));
      RemoveBlock(p);
    }
    Solve(body[0], 0.0);
    snprintf(name, sizeof name, "Poisson's ratio 0.4999, pressed block (%s)", element_name[element]);
    if (element == TLED_ELEMENT_AUTO) exact = MeanOf(body[0], "zmax", 2);
    else HardBetween(name, "sinking over that by fine quadratic elements", MeanOf(body[0], "zmax", 2) / exact, low[element], high[element]);
    if (element != TLED_ELEMENT_AUTO) {
      printf("hard: %s | steps of relaxation | %d | 400000\n", name, (int)Relax(body[1], 0.0));
      Hard(name, "relaxed against implicit", Difference(body[1], body[0]), 1e-6);
    }
    for (int i = 0; i < 2; i++) assert_petsc(TLEDDestroy(&body[i]));
  }
}

/* lateral stretch of a neo-Hookean bar stretched by l, free at its sides: mu (m^2 - 1) + lambda ln(l m^2) = 0 */
static double Lateral(double l, double mu, double lambda)
{
  double m = 1.0;

  for (int i = 0; i < 100; i++) m -= (mu * (m * m - 1.0) + lambda * log(l * m * m)) / (2.0 * mu * m + 2.0 * lambda / m);
  return m;
}

/* a bar between planes of symmetry, its end pulled by `way`; confined: its sides cannot give way */
static TLED PulledBar(const Block *block, int element, PetscBool confined, double way, double duration)
{
  TLEDParams *p;
  TLED        tled = NewBlock(block, &p);

  p->element = element;
  Hold(tled, "xmin", "x");
  Hold(tled, "ymin", "y");
  Hold(tled, "zmin", "z");
  if (confined) Hold(tled, "ymax", "y");
  if (confined) Hold(tled, "zmax", "z");
  if (way != 0.0) Pull(tled, "xmax", way, duration);
  assert_petsc(TLEDSetUp(tled));
  RemoveBlock(p);
  return tled;
}

/* largest difference of the displacement to the homogeneous one, over the size of the body then */
static double OffHomogeneous(TLED tled, double l, double m)
{
  const PetscReal *u, *X;
  PetscInt         n;
  Vec              vec;
  double           worst = 0.0, size = 0.0;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(TLEDGetVectors(tled, &vec, NULL, NULL));
  assert_petsc(VecGetArrayRead(vec, &u));
  for (PetscInt a = 0; a < n; a++) {
    const double exact[3] = {l * X[3 * a], m * X[3 * a + 1], m * X[3 * a + 2]};
    double       d[3];
    for (int k = 0; k < 3; k++) d[k] = X[3 * a + k] + u[3 * a + k] - exact[k];
    worst = fmax(worst, Norm3(d));
    size  = fmax(size, Norm3(exact));
  }
  assert_petsc(VecRestoreArrayRead(vec, &u));
  return worst / size;
}

/* A bar squeezed to a tenth between walls, and stretched to four times its length with free sides, neo-Hookean: the homogeneous state
   exactly. (With free sides it folds before it is squeezed to a tenth: another state then is the stable one.) */
static void FarDeformation_IsHomogeneous(void **state)
{
  const double mu = 3e6 / 2.6, lambda = 3e6 * 0.3 / (1.3 * 0.4), length = 0.2;

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_T10; element++) {
    const Block block = {.n = {4, 2, 2}, .size = {length, 0.1, 0.1}, .order = element == TLED_ELEMENT_T10 ? 2 : 1};
    for (int i = 0; i < 2; i++) {
      const double l = i ? 4.0 : 0.1, m = i ? Lateral(l, mu, lambda) : 1.0;
      TLED         tled = PulledBar(&block, element, i ? PETSC_FALSE : PETSC_TRUE, (l - 1.0) * length, 1.0);
      char         name[80];
      PetscReal    force[3], moment[3];

      snprintf(name, sizeof name, "%s (%s)", i ? "stretched by 300 per cent" : "squeezed by 90 per cent", element_name[element]);
      printf("hard: %s | steps of relaxation | %d | 400000\n", name, (int)Relax(tled, 1.0));
      Hard(name, "displacement against the homogeneous state", OffHomogeneous(tled, l, m), 1e-6);
      assert_petsc(TLEDGetReaction(tled, "xmax", force, moment));
      Hard(name, "reaction against P11 A", fabs(force[0] / (0.01 * (mu * (l - 1.0 / l) + lambda * log(l * m * m) / l)) - 1.0), 1e-6);
      assert_petsc(TLEDDestroy(&tled));
    }
  }
}

/* the same motion in time: slowly, it follows the homogeneous state and turns over no element */
static void FarDeformation_InTime(void **state)
{
  const double mu = 3e6 / 2.6, lambda = 3e6 * 0.3 / (1.3 * 0.4), length = 0.2;

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_T10; element++) {
    const Block block = {.n = {4, 2, 2}, .size = {length, 0.1, 0.1}, .order = element == TLED_ELEMENT_T10 ? 2 : 1};
    for (int i = 0; i < 2; i++) {
      const double   l = i ? 4.0 : 0.1, m = i ? Lateral(l, mu, lambda) : 1.0;
      TLED           tled = PulledBar(&block, element, i ? PETSC_FALSE : PETSC_TRUE, (l - 1.0) * length, 0.5); /* forty times a wave's way there and back */
      char           name[80];
      PetscErrorCode ierr;
      const char    *message;
      PetscInt       n;

      snprintf(name, sizeof name, "%s in 0.5 s (%s)", i ? "stretched by 300 per cent" : "squeezed by 90 per cent", element_name[element]);
      ierr = TLEDAdvance(tled, 0.5, &n);
      assert_petsc(TLEDGetBreakdown(tled, &message));
      if (ierr) fail_msg("%s: %s", name, message);
      printf("hard: %s | time steps | %d | -\n", name, (int)n);
      Hard(name, "displacement against the homogeneous state", OffHomogeneous(tled, l, m), 0.02);
      assert_petsc(TLEDDestroy(&tled));
    }
  }
}

/* flat tetrahedra with angles of one degree over the whole middle plane: the homogeneous state is still exact (the patch test), the step
   is short, mass scaling brings it back */
static void Slivers_PassThePatchTest(void **state)
{
  const double mu = 3e6 / 2.6, lambda = 3e6 * 0.3 / (1.3 * 0.4), l = 1.5, m = Lateral(l, mu, lambda);
  const Block  sound = {.n = {4, 4, 4}, .size = {0.2, 0.2, 0.2}, .order = 1};
  const Block  flat  = {.n = {4, 4, 4}, .size = {0.2, 0.2, 0.2}, .order = 1, .sliver = 1.0};

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    TLED      tled = PulledBar(&flat, element, PETSC_FALSE, (l - 1.0) * 0.2, 1.0), without = PulledBar(&sound, element, PETSC_FALSE, 0.0, 1.0);
    PetscReal short_step, step;
    char      name[80];
    PetscInt  steps[2];

    snprintf(name, sizeof name, "plane of slivers of 1 degree (%s)", element_name[element]);
    HardBetween(name, "smallest dihedral angle, deg", SmallestAngleOf(tled), 0.9, 1.1);
    assert_petsc(TLEDGetCriticalStep(tled, &short_step));
    assert_petsc(TLEDGetCriticalStep(without, &step));
    HardBetween(name, "critical step over that without slivers", short_step / step, 0.01, 0.5);
    steps[0] = Relax(tled, 1.0);
    Hard(name, "patch test: displacement against the homogeneous state", OffHomogeneous(tled, l, m), 1e-6);
    assert_petsc(TLEDDestroy(&without));
    without  = PulledBar(&sound, element, PETSC_FALSE, (l - 1.0) * 0.2, 1.0);
    steps[1] = Relax(without, 1.0);
    Hard(name, "steps of relaxation over those without slivers", (double)steps[0] / (double)steps[1], 10.0);
    assert_petsc(TLEDDestroy(&tled));
    assert_petsc(TLEDDestroy(&without));
  }
}

/* A strip of 0.4 m, one layer of elements of 0.01 m thick, between planes of symmetry at its long sides, clamped at one end, under a small
   weight: the tip's deflection over that of the plate, q L^4 12 (1 - nu^2)/(8 E t^3). Cells of 0.025 m. Linear tetrahedra lock in bending,
   anp no less: the pressure is not what locks here. Quadratic ones must be right. */
static void OneLayer_ThinPlate(void **state)
{
  const double    E = 3e6, nu = 0.3, L = 0.4, t = 0.01;
  const PetscReal down[3] = {0.0, 0.0, -1e-2};
  const double    plate   = 1000.0 * 1e-2 * t * L * L * L * L * 12.0 * (1.0 - nu * nu) / (8.0 * E * t * t * t);
  const double    low[] = {0.0, 0.0, 0.0, 0.97}, high[] = {0.0, 0.5, 0.5, 1.01};

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_T10; element++) {
    const Block block = {.n = {16, 4, 1}, .size = {L, 0.1, t}, .order = element == TLED_ELEMENT_T10 ? 2 : 1};
    TLEDParams *p;
    TLED        tled = NewBlock(&block, &p);
    char        name[80];

    p->element         = element;
    p->elastic.poisson = nu;
    AddName(&p->fixed, "xmin");
    Hold(tled, "ymin", "y");
    Hold(tled, "ymax", "y");
    assert_petsc(TLEDSetGravity(tled, down));
    assert_petsc(TLEDSetUp(tled));
    RemoveBlock(p);
    Solve(tled, 0.0);
    snprintf(name, sizeof name, "one layer across a plate of 1/40 (%s)", element_name[element]);
    HardBetween(name, "deflection over the plate's", -MeanOf(tled, "xmax", 2) / plate, low[element], high[element]);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* Half of a bar is a million times as stiff as the other: relaxation takes about as long as for a bar of the soft stuff alone, and the
   answer is the implicit one. Averaged volumes bend the soft half more easily than plain elements do, which takes averages that the
   materials do not share: with one for both the stiff half holds two layers of elements of the soft one. */
static void StiffnessContrast_OfAMillion(void **state)
{
  const PetscReal side[3]   = {0.0, 0.0, -0.6};
  double          t4 = 0.0;

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_T10; element++) {
    const Block block = {.n = {8, 2, 2}, .size = {0.4, 0.1, 0.1}, .order = element == TLED_ELEMENT_T10 ? 2 : 1, .n_lower = 4};
    TLED        body[3];
    char        name[80];
    PetscInt    steps[2];

    for (int i = 0; i < 3; i++) {
      TLEDParams        *p;
      TLEDMaterialParams stiff;
      body[i]          = NewBlock(&block, &p);
      p->element       = element;
      p->elastic.young = 3e3;
      stiff            = p->elastic;
      stiff.young      = 3e9;
      AddName(&stiff.volumes, "lower");
      if (i < 2) assert_petsc(TLEDAddMaterial(body[i], "stiff", &stiff));
      AddName(&p->fixed, "xmin");
      assert_petsc(TLEDSetGravity(body[i], side));
      assert_petsc(TLEDSetUp(body[i]));
      RemoveBlock(p);
    }
    snprintf(name, sizeof name, "stiffness contrast 1e6 (%s)", element_name[element]);
    Solve(body[0], 0.0);
    steps[0] = Relax(body[1], 0.0);
    steps[1] = Relax(body[2], 0.0);
    if (element == TLED_ELEMENT_T4) t4 = MeanOf(body[0], "xmax", 2);
    HardBetween(name, "deflection over that of t4", MeanOf(body[0], "xmax", 2) / t4, element == TLED_ELEMENT_T4 ? 1.0 : 1.1, 1.6);
    Hard(name, "relaxed against implicit", Difference(body[1], body[0]), 1e-6);
    Hard(name, "steps of relaxation over those of the soft stuff alone", (double)steps[0] / (double)steps[1], 3.0);
    for (int i = 0; i < 3; i++) assert_petsc(TLEDDestroy(&body[i]));
  }
}

CHECK_MAIN(cmocka_unit_test(NearlyIncompressible_IsPressed), cmocka_unit_test(FarDeformation_IsHomogeneous),
           cmocka_unit_test(FarDeformation_InTime), cmocka_unit_test(Slivers_PassThePatchTest), cmocka_unit_test(OneLayer_ThinPlate),
           cmocka_unit_test(StiffnessContrast_OfAMillion))
