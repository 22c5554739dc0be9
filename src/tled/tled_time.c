/* tled_time.c - advancing the body: substeps of the stable size, the works that go with them, breakdown. */
#include "tled/tled_contact.h"
#include "tled/tled_impl.h"

#define RENEW_STEPS 64     /* substeps between two looks at the deformation at most                                */
#define LOOK_FIRST 8       /* substeps before the first                                                             */
#define LOOK_STRETCH 0.01  /* relative change of those below between two looks: the critical step goes with their square or so */
#define RENEW_STRETCH 0.03 /* relative change of the smallest det F or largest |F|^2 that asks for a new critical step */
#define RENEW_LATEST 1024  /* substeps after which it is renewed anyway                                             */
#define FIRST_STEPS 100    /* iterations of the first critical step                                                 */
#define FOLLOWING_STEPS 12 /* of the following ones, which start from the last mode                                 */

/* internal forces at u, raw arrays; BY_ERR_BREAKDOWN, not reported, when an element is inverted or NaN */
PetscErrorCode TLEDForces_Private(TLED tled, const PetscReal u[], PetscReal f[])
{
  PetscFunctionBegin;
#pragma omp parallel num_threads(TLEDThreads_OpenMP(&tled->loops))
  {
    TLEDElementForces_OpenMP(&tled->loops, u);
    TLEDGatherForces_OpenMP(&tled->loops, f);
  }
  if (TLEDElementsBroken_OpenMP(&tled->loops)) PetscFunctionReturn(BY_ERR_BREAKDOWN);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* largest stable step of the state [s]: the critical one, shortened by contact and stiffness damping */
PetscReal TLEDStableStep_Private(TLED tled)
{
  const PetscReal critical = tled->state.critical;

  if (critical == PETSC_MAX_REAL) return PETSC_MAX_REAL;
  return TLEDStableStep(TLEDContactStep(critical, tled->contact.rate), tled->params.stiffness_damping);
}

/* largest step that is taken [s]: the one that the user fixed, or the stable one times the safety factor */
static PetscReal LargestStep(TLED tled)
{
  const PetscReal stable = TLEDStableStep_Private(tled);

  if (tled->params.step > 0.0) return tled->params.step;
  return stable == PETSC_MAX_REAL ? stable : tled->params.safety * stable;
}

static PetscInt CountSubsteps(TLED tled, PetscReal dt)
{
  return PetscMax(1, (PetscInt)PetscCeilReal(dt / LargestStep(tled) * (1.0 - 1e-12)));
}

/* how much the larger of the two stretches has changed, relative */
static PetscReal Change(const PetscReal now[2], const PetscReal then[2])
{
  return PetscMax(PetscAbsReal(now[0] - then[0]) / PetscAbsReal(then[0]), PetscAbsReal(now[1] - then[1]) / then[1]);
}

/* Know the critical step at u: computed when it is not known, after RENEW_LATEST substeps, and when the body has deformed since. It
   is looked at so often that the body deforms by less than LOOK_STRETCH between two looks, as fast as it did up to now. It depends on
   the state alone. */
static PetscErrorCode RenewCritical(TLED tled, const PetscReal u[], PetscReal time)
{
  TLEDState     *s     = &tled->state;
  PetscReal      steps = LOOK_FIRST, change = 0.0, stretch[2];
  PetscErrorCode ierr;

  PetscFunctionBegin;
  if (tled->contact.n && !(tled->contact.rate > 0.0)) tled->contact.rate = TLEDContactRate_Private(tled, tled->mass);
  if (s->critical > 0.0 && s->since < s->look) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TLEDStrain_Private(tled, u, NULL, NULL, stretch));
  if (s->critical > 0.0) {
    change = Change(stretch, s->stretch);
    steps  = PetscMax(1.0, PetscMin(RENEW_STEPS, PetscFloorReal(LOOK_STRETCH / PetscMax(change / s->since, 1e-300))));
  }
  s->look = s->since + steps;
  if (s->critical > 0.0 && s->since < RENEW_LATEST && change <= RENEW_STRETCH) PetscFunctionReturn(PETSC_SUCCESS);
  TLEDSetViscous_Private(tled, TLED_VISCOUS_INSTANT, 0.0);
  ierr = TLEDCriticalStep_Private(tled, u, s->critical > 0.0 ? FOLLOWING_STEPS : FIRST_STEPS, &s->critical);
  TLEDSetViscous_Private(tled, TLED_VISCOUS_STEP, 0.0);
  if (ierr == BY_ERR_BREAKDOWN) PetscFunctionReturn(TLEDReportBroken_Private(tled, u, time));
  PetscCall(ierr);
  s->stretch[0] = stretch[0], s->stretch[1] = stretch[1];
  s->since = 0.0, s->look = steps;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the substeps work on. */
typedef struct {
  PetscReal       *u, *v, *probe;
  const PetscReal *f;
  TLEDStep         step;
  PetscReal        beta;  /* stiffness damping [s]                                       */
  PetscReal        start; /* time at which these substeps begin [s]                      */
  PetscReal        end;   /* time of the end of the last one, of which there are `left` */
  PetscInt         left;
} Work;

/* a node that is held or moved: its part of the support's motion, then the step */
static void OpenHeld(TLED tled, const Work *w, int a, const double force[3], const double f_ext[3], double u[3], double v[3], double sum[])
{
  const TLEDHeld *h = &tled->constraints.held[tled->constraints.held_of[a]];
  double          target[3];

  TLEDHeldPart(h, tled->constraints.next, &tled->mesh.X[3 * a], MOTION_DISPLACEMENT, target);
  TLEDStepOpenHeld(&w->step, h->P, target, tled->mass[a], force, f_ext, u, v, sum);
}

static void CloseHeld(TLED tled, const Work *w, int a, const double force[3], const double f_ext[3], double v[3], double sum[])
{
  const TLEDHeld *h = &tled->constraints.held[tled->constraints.held_of[a]];
  double          velocity[3];

  TLEDHeldPart(h, tled->constraints.now, &tled->mesh.X[3 * a], MOTION_VELOCITY, velocity);
  TLEDStepCloseHeld(&w->step, h->P, velocity, tled->mass[a], force, f_ext, v, sum);
}

/* time at the end of substep s, counted from `start`; exactly `end` for the last */
static PetscReal TimeAfter(const Work *w, PetscInt s) { return s + 1 < w->left ? w->start + (PetscReal)(s + 1) * w->step.dt : w->end; }

/* What follows a course at the end of substep s: the supports' motion then and after the next substep, and the loads. All threads
   call it. */
static void FollowCourses(TLED tled, const Work *w, PetscInt s)
{
  TLEDConstraints *c = &tled->constraints;

  if (!c->moves && !tled->loads.n) return;
#pragma omp single
  {
    RigidMotion *passed = c->now;
    c->now             = c->next;
    c->next            = passed;
    if (c->moves) TLEDMotionsAt_Private(c, TimeAfter(w, s + 1), c->next);
    if (tled->loads.n) TLEDLoadsAt_Private(&tled->loads, TimeAfter(w, s));
  }
  if (tled->loads.n_faces) TLEDFaceForces_OpenMP(&tled->loads, &tled->mesh, w->u);
}

/* contact takes its part of a node's internal forces: both are gradients of stored energy */
static void AddContact(TLED tled, PetscInt a, const double u[3], double force[3], double *deep)
{
  double push[3] = {0.0, 0.0, 0.0};

  (void)TLEDContactAt_Private(tled, a, u, push, NULL, deep);
  for (int k = 0; k < 3; k++) force[k] -= push[k];
}

/* One pass over the nodes, chunk by chunk: close the substep before (gathering its forces) and open the next. All threads
   call it. */
static void NodePass(TLED tled, const Work *w, int close, int open)
{
  const TLEDLoops  *loops = &tled->loops;
  const TLEDBlocks *b     = loops->blocks;
  const int         n = b->n_nodes, n_chunks = (n + TLED_CHUNK - 1) / TLED_CHUNK;

#pragma omp for schedule(static)
  for (int chunk = 0; chunk < n_chunks; chunk++) {
    double   *sum = &tled->sums[TLED_SUMS * chunk];
    const int end = (chunk + 1) * TLED_CHUNK < n ? (chunk + 1) * TLED_CHUNK : n;
    sum[TLED_SUM_KINETIC] = sum[TLED_SUM_GRAVITY] = sum[TLED_SUM_OPENED] = 0.0;
    for (int a = chunk * TLED_CHUNK; a < end; a++) {
      double       *force = &tled->force[3 * a], *u = &w->u[3 * a], *v = &w->v[3 * a], loaded[3];
      const double *f_ext = &w->f[3 * a];
      if (tled->loads.n) {
        for (int i = 0; i < 3; i++) loaded[i] = f_ext[i];
        TLEDAddLoads_Private(&tled->loads, a, loaded);
        f_ext = loaded;
      }
      if (close) {
        double f[3] = {0.0, 0.0, 0.0};
        for (int k = b->slot_offset[a]; k < b->slot_offset[a + 1]; k++)
          for (int i = 0; i < 3; i++) f[i] += loops->partial[3 * b->slot[k] + i];
        if (tled->contact.n) AddContact(tled, a, u, f, &sum[TLED_SUM_DEEP]);
        for (int i = 0; i < 3; i++) force[i] = f[i];
        if (tled->motion[a] == TLED_FREE) TLEDStepClose(&w->step, tled->mass[a], force, f_ext, v, sum);
        else if (tled->motion[a] == TLED_HELD) CloseHeld(tled, w, a, force, f_ext, v, sum);
        if (tled->is_free) TLEDStepMoment(&w->step, &tled->mesh.X[3 * a], u, f_ext, sum);
        TLEDStepEnergy(&w->step, tled->mass[a], u, v, sum);
      }
      if (open) {
        const double closed = TLEDStepBalance(sum);
        if (tled->is_free) TLEDStepMoment(&w->step, &tled->mesh.X[3 * a], u, f_ext, sum);
        if (tled->motion[a] == TLED_FREE) TLEDStepOpen(&w->step, tled->mass[a], force, f_ext, u, v, sum);
        else if (tled->motion[a] == TLED_HELD) OpenHeld(tled, w, a, force, f_ext, u, v, sum);
        sum[TLED_SUM_OPENED] += TLEDStepBalance(sum) - closed;
        for (int i = 0; i < 3 && w->beta > 0.0; i++) w->probe[3 * a + i] = u[i] + w->beta * v[i];
      }
    }
  }
}

/* m substeps; returns how many were taken whole, fewer than m when an element broke or the motion is unstable */
static PetscInt Substeps(TLED tled, const Work *w, PetscInt m)
{
  PetscInt done = m;

#pragma omp parallel num_threads(TLEDThreads_OpenMP(&tled->loops))
  {
    PetscInt s;
    FollowCourses(tled, w, -1);
    NodePass(tled, w, 0, 1);
    for (s = 0; s < m; s++) {
      FollowCourses(tled, w, s);
      TLEDElementForces_OpenMP(&tled->loops, w->beta > 0.0 ? w->probe : w->u);
      if (TLEDElementsBroken_OpenMP(&tled->loops)) break; /* the same answer on every thread */
      NodePass(tled, w, 1, s + 1 < m);
      if (TLEDIsUnstable_Private(tled, w->step.dt)) break; /* so is this */
    }
#pragma omp single
    done = s;
  }
  return done;
}

/* forces (of elements and contact) at the current u unless they are known from the last substep */
static PetscErrorCode KnowForces(TLED tled, const PetscReal u[])
{
  PetscObjectState state;
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  PetscCall(PetscObjectStateGet((PetscObject)tled->u, &state));
  if (tled->force_valid && state == tled->force_state) PetscFunctionReturn(PETSC_SUCCESS);
  tled->state.put_in = 0.0; /* u was changed: its energy is another */
  TLEDSetViscous_Private(tled, TLED_VISCOUS_COMMIT, 0.0); /* what was done to u from outside was a jump */
  ierr = TLEDForces_Private(tled, u, tled->force);
  TLEDSetViscous_Private(tled, TLED_VISCOUS_STEP, 0.0);
  if (tled->loops.viscous || tled->params.stiffness_damping > 0.0) { /* losses of stresses count from here on */
    PetscCall(TLEDStrain_Private(tled, u, &tled->state.internal_work, NULL, NULL));
    tled->state.internal_work += TLEDContactEnergy_Private(tled, u);
  }
  if (ierr == BY_ERR_BREAKDOWN) PetscFunctionReturn(TLEDReportBroken_Private(tled, u, tled->state.time));
  PetscCall(ierr);
  for (PetscInt a = 0; a < tled->mesh.n_nodes && tled->contact.n; a++) AddContact(tled, a, &u[3 * a], &tled->force[3 * a], NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* add up the chunks' works in order; returns how often a node was deep in an obstacle */
static PetscReal AddWorks(TLED tled)
{
  const PetscInt n_chunks = (tled->mesh.n_nodes + TLED_CHUNK - 1) / TLED_CHUNK;
  PetscReal      deep     = 0.0;

  for (PetscInt c = 0; c < n_chunks; c++) {
    PetscReal *sum = &tled->sums[TLED_SUMS * c];
    tled->state.external_work += sum[TLED_SUM_EXTERNAL];
    tled->state.support_work += sum[TLED_SUM_SUPPORT];
    tled->state.damping_loss += sum[TLED_SUM_DAMPING];
    tled->state.internal_work += sum[TLED_SUM_INTERNAL];
    for (PetscInt k = 0; k < 3; k++) tled->state.moment[k] += sum[TLED_SUM_MOMENT + k];
    deep += sum[TLED_SUM_DEEP];
    for (PetscInt k = 0; k < TLED_SUMS; k++) sum[k] = 0.0;
  }
  return deep;
}

static PetscErrorCode AdvanceArrays(TLED tled, PetscReal dt, Work *w, PetscInt *n_substeps)
{
  const PetscReal start  = tled->state.time;
  PetscReal       passed = 0.0, h = 0.0;
  PetscInt        left = 0;

  PetscFunctionBegin;
  *n_substeps = 0;
  PetscCall(PetscArrayzero(tled->state.moment, 3));
  ByCall(KnowForces(tled, w->u));
  tled->force_valid = PETSC_FALSE; /* until this call has come to its end */
  do {
    tled->state.time = start + passed;
    ByCall(RenewCritical(tled, w->u, start + passed));
    if (tled->state.put_in == 0.0 || tled->state.since == 0.0) ByCall(TLEDWatch_Private(tled, w->u, w->v, start + passed));
    if (!left || h > LargestStep(tled) * (1.0 + 1e-9)) { /* at first, and when the body has stiffened */
      left = CountSubsteps(tled, dt - passed);
      h    = (dt - passed) / (PetscReal)left;
    }
    const PetscInt m    = PetscMin(left, PetscMax(1, (PetscInt)(tled->state.look - tled->state.since)));
    w->step.dt          = h;
    w->start = start + passed, w->end = start + dt, w->left = left;
    TLEDSetViscous_Private(tled, TLED_VISCOUS_COMMIT, h);
    const PetscInt  done     = Substeps(tled, w, m);
    const PetscBool unstable = TLEDIsUnstable_Private(tled, h);
    const PetscReal deep     = AddWorks(tled);
    TLEDSetViscous_Private(tled, TLED_VISCOUS_STEP, 0.0);
    *n_substeps += done;
    tled->state.since += (PetscReal)done;
    passed += h * (PetscReal)done;
    left -= done;
    if (done < m) {
      tled->state.time = start + passed + h;
      /* the step after an unstable one was begun: it is taken back */
      for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes && unstable && done + 1 < m; k++) w->u[k] -= h * w->v[k];
      if (unstable) PetscFunctionReturn(TLEDReportUnstable_Private(tled, w->u, start + passed + h, h));
      PetscFunctionReturn(TLEDReportBroken_Private(tled, w->beta > 0.0 ? w->probe : w->u, start + passed + h));
    }
    if (deep > 0.0) {
      tled->state.time = start + passed;
      PetscFunctionReturn(TLEDContactReport_Private(tled, w->u, start + passed));
    }
  } while (left);
  tled->state.time      = start + dt;
  tled->state.is_static = 0.0;
  tled->force_valid     = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDAdvance - move the body by `dt` under the external force held in f

  Collective

  Input Parameters:
+ tled - the body, set up
- dt   - time to advance [s], > 0

  Output Parameter:
. n_substeps - substeps taken (may be NULL)

  Central differences in velocity form (tled_step.h, method 3): the fewest equal substeps not longer than safety times the critical
  step; u and v are at the same time before and after. With stiffness damping beta, the internal forces are taken at u + beta v.

  Errors: BY_ERR_BREAKDOWN when an element turns inside out, a number is lost, the motion is unstable (tled_breakdown.c) or the critical
  step is below the key step_limit; TLEDGetBreakdown() tells which, where and when

  Cost: one force evaluation per substep, no allocation.  Tests: tests/unit/tled/test_time.c

.seealso: TLEDGetSubsteps(), TLEDSave(), TLEDGetCriticalStep()
@*/
PetscErrorCode TLEDAdvance(TLED tled, PetscReal dt, PetscInt *n_substeps)
{
  const TLEDParams *p = &tled->params;
  Work              w;
  PetscInt          n = 0, k;
  PetscObjectState  speed_state;
  PetscErrorCode    ierr;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDAdvance()");
  PetscCheck(dt > 0.0 && !PetscIsInfOrNanReal(dt), PetscObjectComm((PetscObject)tled), PETSC_ERR_ARG_OUTOFRANGE,
             "dt = %g, expected a finite number > 0 [s]", (double)dt);
  PetscCall(PetscLogEventBegin(TLED_EVENT_ADVANCE, tled, 0, 0, 0));
  PetscCall(PetscObjectStateGet((PetscObject)tled->v, &speed_state));
  if (speed_state != tled->speed_state) tled->state.put_in = 0.0;
  w.probe      = tled->probe;
  w.beta       = p->stiffness_damping;
  w.step.alpha = p->damping;
  for (k = 0; k < 3; k++) w.step.gravity[k] = tled->gravity[k];
  PetscCall(VecGetArray(tled->u, &w.u));
  PetscCall(VecGetArray(tled->v, &w.v));
  PetscCall(VecGetArrayRead(tled->f, &w.f));
  ierr = AdvanceArrays(tled, dt, &w, &n);
  PetscCall(VecRestoreArrayRead(tled->f, &w.f));
  PetscCall(VecRestoreArray(tled->v, &w.v));
  PetscCall(VecRestoreArray(tled->u, &w.u));
  PetscCall(PetscObjectStateGet((PetscObject)tled->u, &tled->force_state));
  PetscCall(PetscObjectStateGet((PetscObject)tled->v, &tled->speed_state));
  tled->substeps += n;
  if (n_substeps) *n_substeps = n;
  PetscCall(PetscLogEventEnd(TLED_EVENT_ADVANCE, tled, 0, 0, 0));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* know the critical step of the current state */
static PetscErrorCode RenewNow(TLED tled)
{
  const PetscReal *u;
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes first");
  PetscCall(VecGetArrayRead(tled->u, &u));
  ierr = RenewCritical(tled, u, tled->state.time);
  PetscCall(VecRestoreArrayRead(tled->u, &u));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDGetSubsteps - how many substeps TLEDAdvance() would begin to take for `dt` [s]

.seealso: TLEDAdvance()
@*/
PetscErrorCode TLEDGetSubsteps(TLED tled, PetscReal dt, PetscInt *n_substeps)
{
  PetscFunctionBegin;
  ByCall(RenewNow(tled));
  *n_substeps = CountSubsteps(tled, dt);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDGetCriticalStep - largest stable step of the current state [s], without the safety factor

  2/omega_max by power iteration, shortened when there is contact or stiffness damping; computed afresh by this call. PETSC_MAX_REAL
when no node is free.

  Errors: BY_ERR_BREAKDOWN when an element of the current state is inverted

.seealso: TLEDAdvance()
@*/
PetscErrorCode TLEDGetCriticalStep(TLED tled, PetscReal *dt)
{
  PetscFunctionBegin;
  tled->state.critical = 0.0;
  ByCall(RenewNow(tled));
  *dt = TLEDStableStep_Private(tled);
  PetscFunctionReturn(PETSC_SUCCESS);
}
