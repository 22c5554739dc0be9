/* Mass scaling: the step asked for is reached, only short elements get mass, what is reported is what is there, momentum is exact. */
#include "unit/tled/block.h"

static const Block with_cap = {.n = {4, 4, 4}, .size = {0.4, 0.4, 0.4}, .order = 1, .cap = 1.0};

static double Total(TLED tled)
{
  const PetscReal *mass;
  PetscInt         n;
  double           sum = 0.0;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMass(tled, &mass));
  for (PetscInt a = 0; a < n; a++) sum += mass[a];
  return sum;
}

static PetscReal Critical(TLED tled)
{
  PetscReal dt;

  assert_petsc(TLEDGetCriticalStep(tled, &dt));
  return dt;
}

/* a body of the box, with the step asked for */
static TLED Scaled(const Block *b, double step, int element)
{
  TLEDParams *p;
  TLED        tled = NewBlock(b, &p);

  p->mass_scaling = step;
  p->element      = element;
  assert_petsc(TLEDSetUp(tled));
  RemoveBlock(p);
  return tled;
}

/* A sliver shortens the step many times; asked for that of the mesh without it, it comes back. The mass: of height h over faces of area A
   it is A/(h L) times as stiff as a sound element of length L, about 60 at one degree, and its four corners need as many times the mass
   of a sound node: 4 x 60 of the 729 nodes, at most. */
static void Sliver_GetsTheStepAskedFor(void **state)
{
  const Block without = {.n = {8, 8, 8}, .size = {0.8, 0.8, 0.8}, .order = 1};
  const Block with    = {.n = {8, 8, 8}, .size = {0.8, 0.8, 0.8}, .order = 1, .cap = 1.0};

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    TLED      sound = Scaled(&without, 0.0, element), sliver = Scaled(&with, 0.0, element), scaled;
    PetscReal asked = 0.9 * Critical(sound), before = Critical(sliver), after, added, percent;

    assert_true(SmallestAngleOf(sliver) > 0.5 && SmallestAngleOf(sliver) < 1.05);
    scaled = Scaled(&with, asked, element);
    after  = Critical(scaled);
    assert_petsc(TLEDGetAddedMass(scaled, &added, &percent));
    printf("hard: sliver of 1 degree (%s) | critical step before, asked, after, s | %.3g %.3g %.3g | after >= asked\n",
           element == TLED_ELEMENT_T4 ? "t4" : "anp", before, asked, after);
    printf("hard: sliver of 1 degree (%s) | added mass, per cent | %.4g | 33\n", element == TLED_ELEMENT_T4 ? "t4" : "anp", percent);
    assert_true(before < 0.3 * asked);
    assert_true(after >= asked * (1.0 - 2e-3)); /* the iteration ends when omega^2 grows by less than 1e-4 a step */
    assert_true(after < 1.5 * asked);
    assert_true(percent > 0.0 && percent < 33.0);
    assert_close(Total(scaled) - Total(sliver), added, 1e-12, Total(sliver));
    assert_close(100.0 * added / Total(sliver), percent, 1e-12, percent);
    assert_petsc(TLEDDestroy(&sound));
    assert_petsc(TLEDDestroy(&sliver));
    assert_petsc(TLEDDestroy(&scaled));
  }
}

/* a step that the body has anyway costs nothing */
static void LongEnough_AddsNothing(void **state)
{
  TLED      tled = Scaled(&with_cap, 0.0, TLED_ELEMENT_T4), same;
  PetscReal added, percent;

  (void)state;
  same = Scaled(&with_cap, 0.99 * Critical(tled), TLED_ELEMENT_T4);
  assert_petsc(TLEDGetAddedMass(same, &added, &percent));
  assert_true(added == 0.0 && percent == 0.0);
  assert_true(Total(same) == Total(tled));
  assert_petsc(TLEDDestroy(&tled));
  assert_petsc(TLEDDestroy(&same));
}

/* asked for more than any element has, all get mass, and the step is still the one asked for */
static void WholeBody_CanBeScaled(void **state)
{
  const Block even = {.n = {3, 3, 3}, .size = {0.3, 0.3, 0.3}, .order = 1};
  TLED        plain = Scaled(&even, 0.0, TLED_ELEMENT_T4), tled;
  PetscReal   asked = 3.0 * Critical(plain), percent;

  (void)state;
  tled = Scaled(&even, asked, TLED_ELEMENT_T4);
  assert_true(Critical(tled) >= asked * (1.0 - 2e-3) && Critical(tled) < 1.1 * asked);
  assert_petsc(TLEDGetAddedMass(tled, NULL, &percent));
  assert_true(percent > 600.0 && percent < 900.0); /* nine times the mass, and a little for elements that are not alike */
  assert_petsc(TLEDDestroy(&plain));
  assert_petsc(TLEDDestroy(&tled));
}

/* the added mass falls and moves like any other: total momentum is m (v + g t) to round-off */
static void Momentum_IsExact(void **state)
{
  const PetscReal g[3] = {0.3, 0.0, -9.81};
  TLEDParams     *p;
  TLED            tled = NewBlock(&with_cap, &p);
  const double    t    = 0.05;
  TLEDStats       s;

  (void)state;
  p->mass_scaling = 1e-3;
  p->velocity[1]  = 2.0;
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  RemoveBlock(p);
  assert_petsc(TLEDAdvance(tled, t, NULL));
  assert_petsc(TLEDGetStats(tled, &s));
  for (int k = 0; k < 3; k++) assert_close(s.momentum[k], Total(tled) * (p->velocity[k] + g[k] * t), 1e-12, 2.0 * Total(tled));
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(Sliver_GetsTheStepAskedFor), cmocka_unit_test(LongEnough_AddsNothing),
           cmocka_unit_test(WholeBody_CanBeScaled), cmocka_unit_test(Momentum_IsExact))
