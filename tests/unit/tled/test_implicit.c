/* The implicit solver in small: what it must refuse, what must not change an answer. Accuracy: test_static.c and tests/convergence. */
#include "unit/tled/body.h"
#include "tled/tled_implicit.h"

static TLED Beam(TLEDParams **p)
{
  const PetscReal g[3] = {0.0, 0.0, -9.81};
  TLED            tled = NewBody("tests/meshes/beam_h1.msh", p);

  AddName(&(*p)->fixed, "clamp");
  assert_petsc(TLEDSetGravity(tled, g));
  return tled;
}

/* values of the tip's uz and the stats after a static solve with one load step or a quarter first, from rest or from a state out of balance */
static PetscReal StaticTip(PetscReal load_step, PetscBool disturb, TLEDImplicitStats *it)
{
  TLEDParams         *p;
  TLED                tled = Beam(&p);
  TLEDImplicit        implicit;
  TLEDImplicitParams *ip;
  const PetscReal    *x;
  PetscReal          *u, uz;
  Vec                 U;

  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetVectors(tled, &U, NULL, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &x));
  assert_petsc(VecGetArray(U, &u));
  for (PetscInt k = 0; k < 579 && disturb; k++) u[k] = k % 3 == 1 ? 0.1 * x[k - 1] * x[k - 1] : 0.0; /* bent to the side */
  assert_petsc(VecRestoreArray(U, &u));
  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
  assert_petsc(TLEDImplicitGetParams(implicit, &ip));
  ip->load_step = load_step;
  assert_petsc(TLEDImplicitSolveStatic(implicit, 0.0));
  assert_petsc(TLEDImplicitGetStats(implicit, it));
  assert_petsc(TLEDGetPositions(tled, &x, NULL));
  uz = x[3 * NodeAt(tled, 1.0, 0.05, 0.05) + 2] - 0.05;
  assert_petsc(TLEDImplicitDestroy(&implicit));
  assert_petsc(TLEDDestroy(&tled));
  return uz;
}

/* the way to equilibrium does not matter: load steps, a start that is out of balance */
static void Way_DoesNotMatter(void **state)
{
  TLEDImplicitStats it;
  const PetscReal   once = StaticTip(1.0, PETSC_FALSE, &it);

  (void)state;
  assert_int_equal(it.load_steps, 1);
  assert_close(StaticTip(0.25, PETSC_FALSE, &it), once, 1e-10, once);
  assert_true(it.load_steps > 1);
  assert_close(StaticTip(1.0, PETSC_TRUE, &it), once, 1e-10, once);
}

/* one call of eight steps, and eight calls of one, are the same; so is a body whose state was taken away and put back */
static void Calls_DoNotMatter(void **state)
{
  PetscReal uz[2];

  (void)state;
  for (int i = 0; i < 2; i++) {
    TLEDParams      *p;
    TLED             tled = Beam(&p);
    TLEDImplicit     implicit;
    const PetscReal *x;

    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
    for (int k = 0; k < (i ? 8 : 1); k++) assert_petsc(TLEDImplicitAdvance(implicit, 1e-3, i ? 1 : 8));
    assert_petsc(TLEDGetPositions(tled, &x, NULL));
    uz[i] = x[3 * NodeAt(tled, 1.0, 0.05, 0.05) + 2] - 0.05;
    assert_petsc(TLEDImplicitDestroy(&implicit));
    assert_petsc(TLEDDestroy(&tled));
  }
  assert_close(uz[0], uz[1], 1e-13, uz[0]);
}

/* a free body under gravity falls as g t^2/2 and turns as it was turning; no force, no rounding of a missing support */
static void FreeBody_Falls(void **state)
{
  const PetscReal  g[3] = {0.0, 0.0, -9.81};
  TLEDParams      *p;
  TLED             tled = NewBody("tests/meshes/beam_h1.msh", &p);
  TLEDImplicit     implicit;
  TLEDStats        before, after;
  const PetscReal *u;
  PetscReal       *v;
  const PetscReal *X;
  PetscInt         n;
  Vec              U, V;

  (void)state;
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(TLEDGetVectors(tled, &U, &V, NULL));
  assert_petsc(VecGetArray(V, &v));
  for (PetscInt a = 0; a < n; a++) v[3 * a + 1] = X[3 * a] - 0.5, v[3 * a] = 0.05 - X[3 * a + 1]; /* one turn a 6.3 s */
  assert_petsc(VecRestoreArray(V, &v));
  assert_petsc(TLEDGetStats(tled, &before));
  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
  assert_petsc(TLEDImplicitAdvance(implicit, 0.01, 20));
  assert_petsc(TLEDGetStats(tled, &after));
  assert_close(after.momentum[2], -9.81 * 0.2 * 10.0, 1e-9, 20.0); /* mass 10 kg */
  assert_close(after.momentum[0], before.momentum[0], 1e-9, 20.0);
  assert_petsc(VecGetArrayRead(U, &u));
  const PetscInt a = NodeAt(tled, 1.0, 0.05, 0.05);
  const double   x = u[3 * a] + 0.5, y = u[3 * a + 1];
  assert_close(u[3 * a + 2], -0.5 * 9.81 * 0.04, 1e-5, 0.2); /* the swelling, on a mesh that is not symmetric */
  assert_close(atan2(y, x), 0.2, 1e-3, 0.2); /* a spin of 1 rad/s; the body swells a little by it */
  assert_petsc(VecRestoreArrayRead(U, &u));
  assert_petsc(TLEDImplicitDestroy(&implicit));
  assert_petsc(TLEDDestroy(&tled));
}

/* A pull that follows the beam's tip, with its weight: no potential, an unsymmetric tangent. It is exact: at the end each Newton
   iteration squares the residual, so that few are needed; the explicit solid relaxes to the same place. The pull follows the tip where it
   turns, and so lets it turn further, but the beam stays stable (below: with sixteen weights). */
static void FollowerLoad_KeepsNewtonQuadratic(void **state)
{
  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    TLEDParams       *p;
    TLED              tled = Beam(&p);
    TLEDLoadParams    pull;
    TLEDImplicit      implicit;
    TLEDImplicitStats it;
    const PetscReal  *x;
    PetscReal         uz;
    PetscInt          tip;
    Vec               u;

    p->element         = element;
    p->elastic.poisson = element == TLED_ELEMENT_ANP ? 0.45 : 0.3;
    assert_petsc(KeysSetDefaults(TLEDLoadKeys, &pull));
    AddName(&pull.groups, "tip");
    pull.pressure = -1e3; /* a tenth of the weight */
    assert_petsc(TLEDAddLoad(tled, "pull", &pull));
    assert_petsc(TLEDSetUp(tled));
    tip = NodeAt(tled, 1.0, 0.05, 0.05);
    assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
    assert_petsc(TLEDImplicitSolveStatic(implicit, 0.0));
    assert_petsc(TLEDImplicitGetStats(implicit, &it));
    assert_petsc(TLEDImplicitDestroy(&implicit));
    assert_petsc(TLEDGetPositions(tled, &x, NULL));
    uz = x[3 * tip + 2] - 0.05;
    assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
    assert_petsc(VecSet(u, 0.0));
    assert_petsc(TLEDRelax(tled, 0.0, 1e-7, 200000, NULL, NULL));
    assert_petsc(TLEDGetPositions(tled, &x, NULL));
    printf("pulled beam: uz %.9f m, explicit %+.1e of it; %d Newton iterations\n", uz, (x[3 * tip + 2] - 0.05) / uz - 1, (int)it.newton);
    assert_true(it.newton <= 25); /* measured 7, and 21 in two load steps */
    assert_close(x[3 * tip + 2] - 0.05, uz, 1e-6, uz);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* a pull of sixteen weights bends the beam by 0.81 of its length, in some load steps that let it grow as it follows; explicit steps from there
   show that it is an equilibrium: the body stays */
static void StrongFollowerLoad_IsFound(void **state)
{
  TLEDParams       *p;
  TLED              tled = Beam(&p);
  TLEDLoadParams    pull;
  TLEDImplicit      implicit;
  TLEDImplicitStats it;
  const PetscReal  *x;
  PetscInt          tip;

  (void)state;
  assert_petsc(KeysSetDefaults(TLEDLoadKeys, &pull));
  AddName(&pull.groups, "tip");
  pull.pressure = -1.6e5;
  assert_petsc(TLEDAddLoad(tled, "pull", &pull));
  assert_petsc(TLEDSetUp(tled));
  tip = NodeAt(tled, 1.0, 0.05, 0.05);
  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
  assert_petsc(TLEDImplicitSolveStatic(implicit, 0.0));
  assert_petsc(TLEDImplicitGetStats(implicit, &it));
  assert_petsc(TLEDImplicitDestroy(&implicit));
  assert_petsc(TLEDGetPositions(tled, &x, NULL));
  const PetscReal uz = x[3 * tip + 2] - 0.05;
  assert_true(it.newton <= 100); /* measured 60 in 7 load steps */
  assert_petsc(TLEDAdvance(tled, 0.2, NULL));
  assert_petsc(TLEDGetPositions(tled, &x, NULL));
  printf("strong pull: uz %.6f m, moved by %.1e m in 0.2 s; %d Newton iterations\n", uz, x[3 * tip + 2] - 0.05 - uz, (int)it.newton);
  assert_true(uz < -0.8);
  assert_close(x[3 * tip + 2] - 0.05, uz, 1e-8, uz); /* nothing moves it but what Newton's method left */
  assert_petsc(TLEDDestroy(&tled));
}

/* a load that turns elements inside out whatever the steps are: a breakdown that says how far it went, not a wrong answer */
static void ImpossibleLoad_BreaksDown(void **state)
{
  const PetscReal     g[3] = {-1e6, 0.0, 0.0};
  TLEDParams         *p;
  TLED                tled = Beam(&p);
  TLEDImplicit        implicit;
  TLEDImplicitParams *ip;
  const char         *why;

  (void)state;
  p->elastic.material = TLED_MATERIAL_ST_VENANT_KIRCHHOFF; /* no resistance to being crushed to nothing */
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
  assert_petsc(TLEDImplicitGetParams(implicit, &ip));
  ip->load_step_min = 1e-3;
  assert_int_equal(TLEDImplicitSolveStatic(implicit, 0.0), BY_ERR_BREAKDOWN);
  assert_petsc(TLEDGetBreakdown(tled, &why));
  printf("%s\n", why);
  assert_non_null(strstr(why, "no equilibrium beyond"));
  assert_petsc(TLEDImplicitDestroy(&implicit));
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(Way_DoesNotMatter), cmocka_unit_test(Calls_DoNotMatter), cmocka_unit_test(FreeBody_Falls), cmocka_unit_test(FollowerLoad_KeepsNewtonQuadratic),
           cmocka_unit_test(StrongFollowerLoad_IsFound), cmocka_unit_test(ImpossibleLoad_BreaksDown))
