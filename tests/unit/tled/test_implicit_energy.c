/* The ledger of implicit time steps: what a body has is what it had, and what loads and supports gave, less what damping took. */
#include "unit/tled/body.h"
#include "tled/tled_implicit.h"

#define DURATION 0.1 /* about half a swing of the beam [s] */

typedef struct {
  const char *name;
  PetscReal   damping, stiffness_damping, prony, pressure, shake; /* [1/s] [s] [1] [Pa] [m] */
  PetscBool   floor;
} Case;

/* the cantilever of the reference cases, let go under its weight with more on it */
static TLED Beam(const Case *c)
{
  const PetscReal      g[3] = {0.0, 0.0, -9.81}, point[3] = {0.0, 0.0, -0.01}, up[3] = {0.0, 0.0, 1.0};
  TLEDParams          *p;
  TLED                 tled = NewBody("tests/meshes/beam_h1.msh", &p);
  TLEDConstraintParams clamp;
  TLEDLoadParams       push;

  p->damping           = c->damping;
  p->stiffness_damping = c->stiffness_damping;
  p->safety            = 0.1;
  if (c->prony > 0.0) {
    p->elastic.material             = TLED_MATERIAL_NEO_HOOKEAN_ISO;
    p->elastic.prony_alpha.n        = p->elastic.prony_tau.n = 1;
    p->elastic.prony_alpha.value[0] = c->prony, p->elastic.prony_tau.value[0] = 0.05;
  }
  assert_petsc(KeysSetDefaults(TLEDConstraintKeys, &clamp));
  AddName(&clamp.groups, "clamp");
  if (c->shake != 0.0) {
    clamp.kind            = TLED_CONSTRAINT_MOTION;
    clamp.translation[2]  = c->shake;
    clamp.course.kind     = COURSE_RAMP;
    clamp.course.duration = DURATION;
  }
  assert_petsc(TLEDAddConstraint(tled, "hold", &clamp));
  assert_petsc(KeysSetDefaults(TLEDLoadKeys, &push));
  AddName(&push.groups, "tip");
  push.pressure = c->pressure;
  if (c->pressure != 0.0) assert_petsc(TLEDAddLoad(tled, "push", &push));
  p->contact_stiffness = 1e6; /* soft: landing takes several steps */
  if (c->floor) assert_petsc(TLEDAddContactPlane(tled, "floor", point, up));
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  return tled;
}

static double Energy(const TLEDStats *s) { return s->kinetic + s->strain + s->gravity_potential + s->contact_energy; }

static TLEDStats Run(const Case *c, PetscInt n_steps)
{
  TLED         tled = Beam(c);
  TLEDImplicit implicit;
  TLEDStats    s;

  if (n_steps) {
    assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
    assert_petsc(TLEDImplicitAdvance(implicit, DURATION / (PetscReal)n_steps, n_steps));
    assert_petsc(TLEDImplicitDestroy(&implicit));
  } else assert_petsc(TLEDAdvance(tled, DURATION, NULL));
  assert_petsc(TLEDGetStats(tled, &s));
  assert_petsc(TLEDDestroy(&tled));
  return s;
}

/* off balance, and off the explicit solid's works, by what falls with the square of the step: by 16 over a quarter of it */
static void Ledger_BalancesToTheSchemesOrder(void **state)
{
  static const Case cases[] = {
      {"mass damping, a pressure that follows", 5.0, 0.0, 0.0, 2e3, 0.0, 0},
      {"stiffness damping, a moved clamp", 0.0, 2e-4, 0.0, 0.0, 0.1, 0},
      {"relaxing stresses", 0.0, 0.0, 0.5, 0.0, 0.0, 0},
      {"a floor, mass damping", 2.0, 0.0, 0.0, 0.0, 0.0, 1},
  };

  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const TLEDStats explicit_one = Run(&cases[i], 0);
    double          off[2], work[2], loss[2], size = 0.0;
    for (int k = 0; k < 2; k++) {
      const TLEDStats s = Run(&cases[i], 25 << 2 * k);
      size    = fabs(s.gravity_potential) + s.kinetic + s.strain;
      off[k]  = fabs(Energy(&s) - s.external_work + s.damping_loss) / size; /* it had none */
      work[k] = fabs(s.external_work - explicit_one.external_work) / size;
      loss[k] = fabs(s.damping_loss - explicit_one.damping_loss) / size;
    }
    printf("%s: lost %.2f, given %.2f of the energy; off balance by %.1e and %.1e, work by %.1e, %.1e, loss by %.1e, %.1e\n", cases[i].name,
           explicit_one.damping_loss / size, explicit_one.external_work / size, off[0], off[1], work[0], work[1], loss[0], loss[1]);
    assert_true(off[0] > 10.0 * off[1] && off[1] < 1e-3);   /* measured 12 to 17 times; 16 is second order */
    assert_true(loss[0] > 10.0 * loss[1] && loss[1] < 1e-3);
    assert_true(work[1] < 1e-3);
  }
}

/* either solver goes on where the other one stopped, losses included */
static void Solvers_HandOver(void **state)
{
  const Case      c            = {"stiffness damping, relaxing stresses, a moved clamp", 0.0, 2e-4, 0.3, 0.0, 0.1, 0};
  const TLEDStats explicit_one = Run(&c, 0);
  TLED            tled         = Beam(&c);
  TLEDImplicit    implicit;
  TLEDStats       s;

  (void)state;
  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
  assert_petsc(TLEDImplicitAdvance(implicit, 0.04 / 40, 40));
  assert_petsc(TLEDAdvance(tled, 0.02, NULL));
  assert_petsc(TLEDImplicitAdvance(implicit, 0.04 / 40, 40));
  assert_petsc(TLEDGetStats(tled, &s));
  const double size = fabs(s.gravity_potential) + s.kinetic + s.strain;
  printf("implicit, explicit, implicit: lost %.3f, explicit %.3f; off balance by %.1e\n", s.damping_loss / size,
         explicit_one.damping_loss / size, (Energy(&s) - s.external_work + s.damping_loss) / size);
  assert_close(Energy(&s), s.external_work - s.damping_loss, 1e-3, size); /* measured above with 100 steps: 2e-4 */
  assert_close(s.damping_loss, explicit_one.damping_loss, 1e-3, size);
  assert_petsc(TLEDImplicitDestroy(&implicit));
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(Ledger_BalancesToTheSchemesOrder), cmocka_unit_test(Solvers_HandOver))
