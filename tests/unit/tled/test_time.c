/* Advancing in time: free fall, momentum, energies, snapshots, threads, constraints, breakdown. */
#include "unit/tled/body.h"
#include <omp.h>

#define ROUND 1e-12 /* sums of a few thousand terms and steps in double precision */

static void Spin(const PetscReal X[3], PetscReal v[3]) /* a rotation about z and a stretch: the body turns and vibrates */
{
  v[0] = -20.0 * (X[1] - 0.05) + 5.0 * X[0];
  v[1] = 20.0 * (X[0] - 0.4);
  v[2] = 3.0 * X[2] - 1.0;
}

static TLED FreeBody(int element, TLEDParams **p)
{
  TLED tled = NewBody("tests/meshes/beam_h1.msh", p);

  (*p)->element = element;
  (*p)->elastic.poisson = element == TLED_ELEMENT_ANP ? 0.45 : 0.3;
  return tled;
}

static void FreeFall_IsExact(void **state)
{
  const PetscReal  g[3] = {0.1, 0.0, -9.81};
  TLEDParams      *p;
  TLED             tled = FreeBody(TLED_ELEMENT_T4, &p);
  const PetscReal *x, *v, *X;
  PetscInt         n, substeps;

  (void)state;
  p->velocity[1] = 2.0;
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDAdvance(tled, 0.05, &substeps));
  assert_petsc(TLEDAdvance(tled, 0.03, &substeps));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(TLEDGetPositions(tled, &x, &v));
  for (PetscInt a = 0; a < n; a++) {
    for (int k = 0; k < 3; k++) {
      const double v0 = k == 1 ? 2.0 : 0.0;
      assert_close(x[3 * a + k] - X[3 * a + k], v0 * 0.08 + 0.5 * g[k] * 0.0064, ROUND, 1.0);
      assert_close(v[3 * a + k], v0 + g[k] * 0.08, ROUND, 2.0);
    }
  }
  assert_petsc(TLEDDestroy(&tled));
}

/* momentum and angular momentum of a free body are constant, and its energy drifts by the integrator's order only */
static void FreeBody_KeepsMomentaAndEnergy(void **state)
{
  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    TLEDParams *p;
    TLED        tled = FreeBody(element, &p);
    TLEDStats   s0, s;
    Vec         v;
    double      e0;

    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetVectors(tled, NULL, &v, NULL));
    SetVec(tled, v, Spin);
    assert_petsc(TLEDGetStats(tled, &s0));
    e0 = s0.kinetic + s0.strain;
    for (int i = 0; i < 5; i++) assert_petsc(TLEDAdvance(tled, 0.01, NULL));
    assert_petsc(TLEDGetStats(tled, &s));
    for (int k = 0; k < 3; k++) {
      assert_close(s.momentum[k], s0.momentum[k], ROUND, 200.0);
      assert_close(s.angular[k], s0.angular[k], ROUND, 50.0);
    }
    assert_true(s.strain > 0.05 * e0);
    assert_close(s.kinetic + s.strain, e0, 5e-3, e0); /* steps at 0.9 of the critical one: the highest modes' energy wavers */
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* the moment that held forces give over the substeps is what the angular momentum gains */
static void AngularImpulse_IsTheGain(void **state)
{
  TLEDParams      *p;
  TLED             tled = FreeBody(TLED_ELEMENT_T4, &p);
  TLEDStats        s0, s;
  const PetscReal *impulse;
  Vec              v, f;

  (void)state;
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetVectors(tled, NULL, &v, &f));
  SetVec(tled, v, Spin);
  SetVec(tled, f, Spin);
  assert_petsc(TLEDGetStats(tled, &s0));
  assert_petsc(TLEDAdvance(tled, 0.01, NULL));
  assert_petsc(TLEDGetStats(tled, &s));
  assert_petsc(TLEDGetAngularImpulse(tled, &impulse));
  for (int k = 0; k < 3; k++) assert_close(s.angular[k] - s0.angular[k], impulse[k], ROUND, 50.0);
  assert_petsc(TLEDDestroy(&tled));
}

/* energy balance with everything that takes or gives energy: error of the order of the step squared */
static void Energies_Balance(void **state)
{
  const PetscReal g[3] = {0.0, 0.0, -9.81};

  (void)state;
  for (int kind = 0; kind < 4; kind++) {
    TLEDParams *p;
    TLED        tled = FreeBody(kind == 3 ? TLED_ELEMENT_ANP : TLED_ELEMENT_T4, &p);
    TLEDStats   s;
    double      balance, size;

    AddName(&p->fixed, "clamp");
    p->safety      = 0.2;
    p->velocity[0] = 2.0, p->velocity[2] = 1.0;
    if (kind == 1) p->damping = 20.0;
    if (kind == 2) p->stiffness_damping = 1e-3;
    if (kind != 2) {
      AddName(&p->prescribed, "tip");
      p->prescribed_velocity[0] = 0.5;
      p->prescribed_velocity[1] = 0.3;
    }
    assert_petsc(TLEDSetGravity(tled, g));
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetStats(tled, &s));
    balance = -s.kinetic;
    size    = s.kinetic;
    assert_petsc(TLEDAdvance(tled, 0.05, NULL));
    assert_petsc(TLEDGetStats(tled, &s));
    balance += s.kinetic + s.strain + s.gravity_potential + s.damping_loss - s.external_work;
    if (kind == 1 || kind == 2) assert_true(s.damping_loss > 0.01 * size);
    if (kind != 2) assert_true(fabs(s.external_work) > 0.1 * size);
    assert_close(balance, 0.0, 2e-3, size); /* (omega dt)^2/12 of the modes that are excited */
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* back to the snapshot and forward again gives the same bits; so does a checkpoint in another object */
static void SaveAndRestore_AreExact(void **state)
{
  TLEDParams      *p, *q;
  TLED             tled = FreeBody(TLED_ELEMENT_T4, &p), other = FreeBody(TLED_ELEMENT_T4, &q);
  const PetscReal *x;
  PetscReal       *first, *carried, t;
  PetscInt         n, n_carried, n1, n2;
  Vec              u, v, f, u2, v2, f2;

  (void)state;
  p->damping = q->damping = 1.0;
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDSetUp(other));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetVectors(tled, &u, &v, &f));
  assert_petsc(TLEDGetVectors(other, &u2, &v2, &f2));
  SetVec(tled, v, Spin);
  SetVec(tled, f, Spin);
  assert_petsc(TLEDAdvance(tled, 0.02, NULL));
  assert_petsc(TLEDSave(tled));
  assert_petsc(VecCopy(u, u2));
  assert_petsc(VecCopy(v, v2));
  assert_petsc(VecCopy(f, f2));
  assert_petsc(TLEDGetState(tled, &n_carried, NULL));
  assert_petsc(PetscMalloc2(3 * n, &first, n_carried, &carried));
  assert_petsc(TLEDGetState(tled, &n_carried, carried));
  assert_petsc(TLEDSetState(other, n_carried, carried));
  assert_petsc(TLEDAdvance(tled, 0.03, &n1));
  assert_petsc(TLEDGetPositions(tled, &x, NULL));
  assert_petsc(PetscArraycpy(first, x, 3 * n));
  assert_petsc(TLEDRestore(tled));
  assert_petsc(TLEDGetTime(tled, &t));
  assert_close(t, 0.02, 1e-15, 1.0);
  assert_petsc(TLEDAdvance(tled, 0.03, &n2));
  assert_petsc(TLEDGetPositions(tled, &x, NULL));
  assert_int_equal(n1, n2);
  assert_memory_equal(x, first, 3 * n * sizeof *x);
  assert_petsc(TLEDAdvance(other, 0.03, &n2));
  assert_petsc(TLEDGetPositions(other, &x, NULL));
  assert_int_equal(n1, n2);
  assert_memory_equal(x, first, 3 * n * sizeof *x);
  assert_petsc(PetscFree2(first, carried));
  assert_petsc(TLEDDestroy(&tled));
  assert_petsc(TLEDDestroy(&other));
}

/* the same bits on one, two and three threads, on a mesh of several blocks */
static void Threads_GiveTheSameBits(void **state)
{
  const int threads = omp_get_max_threads();

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    PetscReal *first = NULL;
    TLEDStats  s1, s;
    for (int n_threads = 1; n_threads <= 3; n_threads++) {
      TLEDParams      *p;
      TLED             tled = NewBody("tests/meshes/beam_h2.msh", &p);
      const PetscReal *x;
      PetscInt         n;
      Vec              v;

      omp_set_num_threads(n_threads);
      p->element = element;
      p->damping = 3.0;
      assert_petsc(TLEDSetUp(tled));
      assert_petsc(TLEDGetVectors(tled, NULL, &v, NULL));
      SetVec(tled, v, Spin);
      assert_petsc(TLEDAdvance(tled, 0.01, NULL));
      assert_petsc(TLEDGetSize(tled, &n, NULL));
      assert_petsc(TLEDGetPositions(tled, &x, NULL));
      assert_petsc(TLEDGetStats(tled, &s));
      if (n_threads == 1) {
        assert_petsc(PetscMalloc1(3 * n, &first));
        assert_petsc(PetscArraycpy(first, x, 3 * n));
        s1 = s;
      }
      assert_memory_equal(x, first, 3 * n * sizeof *x);
      assert_memory_equal(&s, &s1, sizeof s);
      assert_petsc(TLEDDestroy(&tled));
    }
    assert_petsc(PetscFree(first));
  }
  omp_set_num_threads(threads);
}

/* fixed nodes stay, prescribed ones move as told, and the flags say which is which */
static void Constraints_Hold(void **state)
{
  TLEDParams      *p;
  TLED             tled = FreeBody(TLED_ELEMENT_T4, &p);
  const PetscReal *x, *v, *X;
  const PetscBool *held;
  const PetscInt  *clamp, *tip;
  PetscInt         n_clamp, n_tip, n, n_held = 0;
  PetscBool        is_free;

  (void)state;
  AddName(&p->fixed, "clamp");
  AddName(&p->prescribed, "tip");
  p->prescribed_velocity[2] = -1.5;
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDAdvance(tled, 0.02, NULL));
  assert_petsc(TLEDGetGroup(tled, "clamp", &n_clamp, &clamp));
  assert_petsc(TLEDGetGroup(tled, "tip", &n_tip, &tip));
  assert_petsc(TLEDGetPositions(tled, &x, &v));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(TLEDIsConstrained(tled, &held));
  assert_petsc(TLEDIsFree(tled, &is_free));
  assert_false(is_free);
  assert_true(n_clamp > 3 && n_tip > 3);
  for (PetscInt i = 0; i < n_clamp; i++) {
    const PetscInt a = clamp[i];
    assert_true(held[a] && X[3 * a] == 0.0);
    for (int k = 0; k < 3; k++) assert_true(x[3 * a + k] == X[3 * a + k] && v[3 * a + k] == 0.0);
  }
  for (PetscInt i = 0; i < n_tip; i++) {
    assert_true(held[tip[i]]);
    assert_close(x[3 * tip[i] + 2], X[3 * tip[i] + 2] - 0.03, ROUND, 1.0);
  }
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  for (PetscInt a = 0; a < n; a++) n_held += held[a];
  assert_int_equal(n_held, n_clamp + n_tip);
  assert_petsc(TLEDGetGroup(tled, "no such group", &n, NULL));
  assert_int_equal(n, 0);
  assert_petsc(TLEDDestroy(&tled));
}

/* an element that is turned inside out ends the run with its number, place and time */
static void Breakdown_IsReported(void **state)
{
  TLEDParams    *p;
  TLED           tled = FreeBody(TLED_ELEMENT_T4, &p);
  const char    *message;
  PetscErrorCode ierr;

  (void)state;
  AddName(&p->fixed, "clamp");
  AddName(&p->prescribed, "tip");
  p->prescribed_velocity[0] = -50.0; /* crushes the beam in 20 ms */
  assert_petsc(TLEDSetUp(tled));
  ierr = TLEDAdvance(tled, 0.03, NULL);
  assert_int_equal((int)ierr, (int)BY_ERR_BREAKDOWN);
  assert_petsc(TLEDGetBreakdown(tled, &message));
  assert_non_null(strstr(message, "body body: element "));
  assert_non_null(strstr(message, "time 0.0"));
  assert_non_null(strstr(message, "det F = "));
  assert_petsc(TLEDDestroy(&tled));
  assert_null(tled);
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(FreeFall_IsExact), cmocka_unit_test(FreeBody_KeepsMomentaAndEnergy),
           cmocka_unit_test(AngularImpulse_IsTheGain), cmocka_unit_test(Energies_Balance),
           cmocka_unit_test(SaveAndRestore_AreExact), cmocka_unit_test(Threads_GiveTheSameBits), cmocka_unit_test(Constraints_Hold),
           cmocka_unit_test(Breakdown_IsReported))
