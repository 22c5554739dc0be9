/* The critical step against 2/omega_max of the assembled system by an independent code (DOLFINx 0.5.2 and SLEPc 3.18.2: lumped
   mass, P1 elements, beam clamped at x = 0, E 3 MPa, nu 0.3, rho 1000). */
#include "unit/tled/body.h"

static void CriticalStep_IsTheTrueOne(void **state)
{
  const char  *mesh[2]  = {"tests/meshes/beam_h1.msh", "tests/meshes/beam_h2.msh"};
  const double exact[2] = {0.0003041771712625034, 0.00027027794779142973};

  (void)state;
  for (int i = 0; i < 2; i++) {
    TLEDParams *p;
    TLED        tled = NewBody(mesh[i], &p);
    PetscReal   dt;
    PetscInt    n;

    AddName(&p->fixed, "clamp");
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetCriticalStep(tled, &dt));
    assert_close(dt, exact[i], 2e-3, exact[i]); /* the iteration ends when omega^2 grows by less than 1e-4 a step */
    assert_petsc(TLEDGetSubsteps(tled, 10.5 * 0.9 * dt, &n));
    assert_int_equal(n, 11);
    assert_petsc(TLEDDestroy(&tled));
  }
}

static void Stretch(const PetscReal X[3], PetscReal u[3])
{
  u[0] = 0.0 * X[0];
  u[1] = -0.4 * (X[1] - 0.05);
  u[2] = -0.4 * (X[2] - 0.05);
}

/* the step follows the deformation: squeezed elements need a shorter one */
static void CriticalStep_FollowsTheDeformation(void **state)
{
  TLEDParams *p;
  TLED        tled = NewBody("tests/meshes/beam_h1.msh", &p);
  PetscReal   before, after;
  Vec         u;

  (void)state;
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetCriticalStep(tled, &before));
  assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
  SetVec(tled, u, Stretch);
  assert_petsc(TLEDGetCriticalStep(tled, &after));
  assert_true(after < 0.8 * before);
  assert_petsc(TLEDDestroy(&tled));
}

/* with stiffness damping the shortened step is stable and a longer one is not: the bound is sharp */
static void StiffnessDamping_ShortensTheStep(void **state)
{
  (void)state;
  for (int i = 0; i < 2; i++) {
    const PetscReal g[3] = {0.0, 0.0, -0.1};
    TLEDParams     *p;
    TLED            tled = NewBody("tests/meshes/beam_h1.msh", &p);
    PetscErrorCode  ierr;
    TLEDStats       s;

    AddName(&p->fixed, "clamp");
    p->stiffness_damping = 5e-4;
    p->safety            = i ? 1.15 : 0.98;
    assert_petsc(TLEDSetGravity(tled, g));
    assert_petsc(TLEDSetUp(tled));
    ierr = TLEDAdvance(tled, 0.5, NULL);
    assert_petsc(TLEDGetStats(tled, &s));
    if (i) assert_true(ierr == BY_ERR_BREAKDOWN || !(s.kinetic < 1.0));
    else {
      assert_petsc(ierr);
      assert_true(s.kinetic + s.strain < 0.02); /* what gravity can give, J */
    }
    assert_petsc(TLEDDestroy(&tled));
  }
}

CHECK_MAIN(cmocka_unit_test(CriticalStep_IsTheTrueOne), cmocka_unit_test(CriticalStep_FollowsTheDeformation),
           cmocka_unit_test(StiffnessDamping_ShortensTheStep))
