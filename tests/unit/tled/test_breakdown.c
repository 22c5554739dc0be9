/* Breakdown: a step beyond the critical one is caught before the result is garbage, one below it never; the user's limit on the step. */
#include "unit/tled/block.h"

static const PetscReal g[3] = {0.0, 0.0, -9.81};

/* the beam released under its weight with a step of `ratio` times the critical one */
static TLED Released(int element, double ratio, PetscReal *step)
{
  TLEDParams *p;
  TLED        tled = NewBody("tests/meshes/beam_h1.msh", &p);
  PetscReal   critical;

  p->element = element;
  if (element == TLED_ELEMENT_ANP) p->elastic.poisson = 0.45;
  AddName(&p->fixed, "clamp");
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetCriticalStep(tled, &critical));
  p->step = *step = ratio * critical;
  return tled;
}

static double TopSpeed(TLED tled)
{
  TLEDStats s;

  assert_petsc(TLEDGetStats(tled, &s));
  return s.speed_max;
}

/* 0.99 runs a whole swing; 1.05 and 1.01 are caught soon, and what is left is not garbage: no node is faster than ten times what a
   beam can be that has fallen through its own length */
static void Step_BeyondTheCritical_IsCaught(void **state)
{
  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    const char *name = element == TLED_ELEMENT_T4 ? "t4" : "anp";
    PetscReal   step;
    TLED        tled = Released(element, 0.99, &step);
    TLEDStats   s;
    PetscInt    n;

    assert_petsc(TLEDAdvance(tled, 4000.0 * step, &n));
    assert_int_equal(n, 4000);
    assert_petsc(TLEDGetStats(tled, &s));
    printf("hard: step 0.99 of the critical (%s) | energy error over the strain energy after %d steps | %.2g | 0.02\n", name, (int)n,
           (s.kinetic + s.strain + s.gravity_potential) / s.strain);
    assert_close(s.kinetic + s.strain + s.gravity_potential, 0.0, 0.02, s.strain); /* at 0.99 high modes have 50 times their energy */
    assert_petsc(TLEDDestroy(&tled));
    for (int i = 0; i < 2; i++) {
      const double   ratio = i ? 1.01 : 1.05;
      const char    *message;
      PetscErrorCode ierr;
      PetscReal      t;

      tled = Released(element, ratio, &step);
      ierr = TLEDAdvance(tled, 4000.0 * step, &n);
      assert_int_equal((int)ierr, (int)BY_ERR_BREAKDOWN);
      assert_petsc(TLEDGetBreakdown(tled, &message));
        assert_non_null(strstr(message, "body body: the motion is unstable at time 0.0"));
      assert_non_null(strstr(message, "the step is "));
      assert_non_null(strstr(message, " of the mesh file at ("));
      assert_petsc(TLEDGetTime(tled, &t));
      assert_close(t, (n + 1) * step, 1e-9, t);
      printf("hard: step %.2f of the critical (%s) | caught after steps | %d | %d\n", ratio, name, (int)n, i ? 400 : 120);
      printf("hard: step %.2f of the critical (%s) | fastest node then, m/s | %.3g | 44\n", ratio, name, TopSpeed(tled));
      assert_true(n < (i ? 400 : 120)); /* round-off grows by 1.88 (1.15) a step: e^37 in 58 (260) steps */
      assert_true(TopSpeed(tled) < 44.0);
      assert_petsc(TLEDDestroy(&tled));
    }
  }
}

/* it is caught as well when the steps come in many short calls, with a force that changes between them */
static void Instability_IsCaughtOverManyCalls(void **state)
{
  PetscReal      step;
  TLED           tled = Released(TLED_ELEMENT_T4, 1.05, &step);
  PetscErrorCode ierr = PETSC_SUCCESS;
  PetscInt       n    = 0;
  Vec            f;

  (void)state;
  assert_petsc(TLEDGetVectors(tled, NULL, NULL, &f));
  for (n = 0; n < 200 && !ierr; n++) {
    assert_petsc(VecSet(f, 1e-3 * (n % 3)));
    ierr = TLEDAdvance(tled, step, NULL);
  }
  assert_int_equal((int)ierr, (int)BY_ERR_BREAKDOWN);
  assert_true(n < 120);
  assert_petsc(TLEDDestroy(&tled));
}

static void Shake(const PetscReal X[3], PetscReal v[3]) /* no two nodes alike: all modes, the highest most */
{
  for (int k = 0; k < 3; k++) v[k] = 0.3 * sin(1e4 * (X[0] + 1.7 * X[1] + 2.3 * X[2]) + k);
}

/* a body whose highest modes have nearly all the energy never trips the watch, up to 0.99 of the critical step */
static void HighModes_AreNoInstability(void **state)
{
  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    for (int i = 0; i < 2; i++) {
      PetscReal step;
      TLED      tled = Released(element, i ? 0.99 : 0.9, &step);
      Vec       v;
      PetscInt  n;

      assert_petsc(TLEDGetVectors(tled, NULL, &v, NULL));
      SetVec(tled, v, Shake);
      assert_petsc(TLEDAdvance(tled, 1500.0 * step, &n));
      assert_petsc(TLEDDestroy(&tled));
    }
  }
}

/* the user's limit: a body that is pressed has an ever shorter step */
static void StepLimit_EndsTheRun(void **state)
{
  const Block          block = {.n = {3, 3, 3}, .size = {0.3, 0.3, 0.3}, .order = 1};
  TLEDParams          *p;
  TLED                 tled = NewBlock(&block, &p);
  TLEDConstraintParams c;
  const char          *message;
  PetscReal            critical, before, t;
  PetscErrorCode       ierr;

  (void)state;
  AddName(&p->fixed, "xmin");
  assert_petsc(KeysSetDefaults(TLEDConstraintKeys, &c));
  c.kind = TLED_CONSTRAINT_MOTION;
  AddName(&c.groups, "xmax");
  c.translation[0]  = -0.15;
  c.course.kind     = COURSE_LINEAR;
  c.course.duration = 0.5;
  assert_petsc(TLEDAddConstraint(tled, "press", &c));
  assert_petsc(TLEDSetUp(tled));
  RemoveBlock(p);
  assert_petsc(TLEDGetCriticalStep(tled, &before));
  p->step_limit = 0.8 * before;
  ierr          = TLEDAdvance(tled, 0.5, NULL);
  assert_int_equal((int)ierr, (int)BY_ERR_BREAKDOWN);
  assert_petsc(TLEDGetBreakdown(tled, &message));
  assert_non_null(strstr(message, "body body: the critical step is "));
  assert_non_null(strstr(message, " s, below step_limit "));
  assert_non_null(strstr(message, " of the mesh file at ("));
  assert_non_null(strstr(message, "has most of the highest mode"));
  assert_petsc(TLEDGetTime(tled, &t));
  assert_true(t > 0.05 && t < 0.45);
  p->step_limit = 0.0;
  assert_petsc(TLEDGetCriticalStep(tled, &critical));
  assert_true(critical < 0.81 * before && critical > 0.76 * before);
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(Step_BeyondTheCritical_IsCaught), cmocka_unit_test(Instability_IsCaughtOverManyCalls),
           cmocka_unit_test(HighModes_AreNoInstability), cmocka_unit_test(StepLimit_EndsTheRun))
