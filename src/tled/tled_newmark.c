/* tled_newmark.c - implicit time steps by generalised-alpha.

   With 1 - alpha_m of the new and alpha_m of the old acceleration, 1 - alpha_f of the new and alpha_f of the old displacement and velocity,
   and forces taken there, at time t_n + (1 - alpha_f) dt:
     M a_m + alpha M v_f + f_int(u_f) = f_ext(t_f, u_f)
     u_{n+1} = u_n + dt v_n + dt^2 ((1/2 - beta) a_n + beta a_{n+1}),   v_{n+1} = v_n + dt ((1 - gamma) a_n + gamma a_{n+1})
   alpha_m = (2 rho - 1)/(rho + 1), alpha_f = rho/(rho + 1), gamma = 1/2 - alpha_m + alpha_f, beta = (1 - alpha_m + alpha_f)^2/4: second
   order, unconditionally stable for linear problems, rho the part of the highest frequencies' amplitude that is left after a step. rho = 1
   is the midpoint rule.
   [J. Chung and G. M. Hulbert, J. Appl. Mech. 60 (1993) 371, doi:10.1115/1.2900803] */
#include "tled/tled_implicit_impl.h"
#include "mat3.h"
#include <petsctime.h>

#define HALVINGS 8 /* of a time step that Newton's method does not solve */

typedef struct {
  PetscReal alpha_m, alpha_f, beta, gamma;
} Scheme;

static Scheme MakeScheme(PetscReal rho)
{
  Scheme s;

  s.alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
  s.alpha_f = rho / (rho + 1.0);
  s.gamma   = 0.5 - s.alpha_m + s.alpha_f;
  s.beta    = 0.25 * PetscSqr(1.0 - s.alpha_m + s.alpha_f);
  return s;
}

/* Relaxing stresses go on by dt to the state (u, v) at time t, and its forces are known: internal ones, contact's with them as it stores energy
   too, and those of loads and f without gravity's. BY_ERR_BREAKDOWN, not reported, when an element is inverted. */
static PetscErrorCode EndForces(TLEDImplicit im, PetscReal t, PetscReal dt, const PetscReal u[], const PetscReal v[])
{
  const TLED      tled = im->tled;
  const PetscReal beta = tled->params.stiffness_damping;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++) im->y[k] = u[k] + beta * v[k];
  if (tled->loops.viscous) ByCall(TLEDCommitViscous_Private(tled, im->y, dt)); /* leaves the forces in tled->trial */
  else ByCall(TLEDForces_Private(tled, im->y, tled->trial));
  PetscCall(TLEDExternalForces_Private(tled, t, u, im->outer));
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) {
    PetscReal push[3] = {0.0, 0.0, 0.0};
    if (tled->contact.n) (void)TLEDContactAt_Private(tled, a, &u[3 * a], push, NULL, NULL);
    for (PetscInt i = 0; i < 3; i++) {
      im->inner[3 * a + i] = tled->trial[3 * a + i] - push[i];
      im->outer[3 * a + i] -= tled->mass[a] * tled->gravity[i] + push[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* has anything that forces depend on been changed since the last step? */
static PetscErrorCode IsKnown(TLEDImplicit im, PetscBool *known)
{
  const Vec        vec[3] = {im->tled->u, im->tled->v, im->tled->f};
  PetscObjectState now;

  PetscFunctionBegin;
  *known = im->stepped && im->state_time == im->tled->state.time ? PETSC_TRUE : PETSC_FALSE;
  for (int i = 0; i < 3; i++) {
    PetscCall(PetscObjectStateGet((PetscObject)vec[i], &now));
    if (now != im->state[i]) *known = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a = (f_ext - f_int)/m - alpha v at the body's state, unless it is known from the last step */
static PetscErrorCode KnowAcceleration(TLEDImplicit im, const PetscReal u[], const PetscReal v[])
{
  const TLED       tled = im->tled;
  PetscObjectState now;
  PetscBool        known;

  PetscFunctionBegin;
  PetscCall(IsKnown(im, &known));
  if (known) PetscFunctionReturn(PETSC_SUCCESS);
  ByCall(EndForces(im, tled->state.time, 0.0, u, v)); /* what was done to u from outside was a jump */
  PetscCall(PetscObjectStateGet((PetscObject)tled->u, &now));
  if (!tled->force_valid || now != tled->force_state) { /* losses of stresses count from here on */
    PetscCall(TLEDStrain_Private(tled, u, &tled->state.internal_work, NULL, NULL));
    tled->state.internal_work += TLEDContactEnergy_Private(tled, u);
  }
  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++)
    im->a[k] = (im->outer[k] - im->inner[k]) / tled->mass[k / 3] + tled->gravity[k % 3] - tled->params.damping * v[k];
  PetscCall(TLEDProject_Private(tled, im->a));
  PetscCall(TLEDPrescribed_Private(tled, tled->state.time, NULL, NULL, im->residual));
  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++) im->a[k] += im->residual[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Works of the forces of one end of the step (sign -1: the old, +1: the new) over half its way, from problem.u0 to x, as TLEDStepOpenHeld()
   and TLEDStepCloseHeld() count them: the two ends together are the trapezoidal rule, and supports give what their parts gain in speed. */
static void AddWorks(TLEDImplicit im, PetscReal sign, PetscReal dt, const PetscReal x[], const PetscReal v[])
{
  const TLED       tled = im->tled;
  TLEDState       *s    = &tled->state;
  const PetscReal *g    = tled->gravity;

  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) {
    const PetscReal *P = TLEDConstraintProjector_Private(tled, a), m = tled->mass[a];
    PetscReal        du[3], free_du[3], free_v[3];
    for (PetscInt i = 0; i < 3; i++) {
      du[i]      = x[3 * a + i] - im->problem.u0[3 * a + i];
      free_du[i] = du[i], free_v[i] = v[3 * a + i];
    }
    if (P) Mul3(P, du, free_du), Mul3(P, &v[3 * a], free_v);
    for (PetscInt i = 0; i < 3; i++) {
      const PetscReal outer = im->outer[3 * a + i], inner = im->inner[3 * a + i], held_v = v[3 * a + i] - free_v[i];
      s->external_work += 0.5 * outer * du[i];
      s->internal_work += 0.5 * inner * du[i];
      s->damping_loss += 0.5 * dt * tled->params.damping * m * free_v[i] * free_v[i];
      s->support_work += 0.5 * ((inner - outer - m * g[i]) * (du[i] - free_du[i]) + sign * m * held_v * held_v);
    }
  }
}

/* the problem of one step of dt from (u, v, a) at time t */
static PetscErrorCode SetStep(TLEDImplicit im, const Scheme *s, PetscReal t, PetscReal dt, const PetscReal u[], const PetscReal v[],
                              const PetscReal a[])
{
  TLEDImplicitProblem *q     = &im->problem;
  const PetscReal      keep  = 1.0 - s->alpha_f, alpha = im->tled->params.damping, damping = im->tled->params.stiffness_damping;
  const PetscReal      to_v  = s->gamma / (s->beta * dt), to_a = 1.0 / (s->beta * dt * dt); /* of x - u0 */

  PetscFunctionBegin;
  q->time    = t + keep * dt;
  q->share   = keep;
  q->history = keep * dt;
  q->inertia = (1.0 - s->alpha_m) * to_a + alpha * keep * to_v;
  q->viscous = damping * keep * to_v;
  PetscCall(TLEDPrescribed_Private(im->tled, t + dt, q->held_at, NULL, NULL));
  for (PetscInt k = 0; k < 3 * im->tled->mesh.n_nodes; k++) {
    const PetscReal v_rest = (1.0 - s->gamma / s->beta) * v[k] + dt * (1.0 - 0.5 * s->gamma / s->beta) * a[k];
    const PetscReal a_rest = -v[k] / (s->beta * dt) - (0.5 / s->beta - 1.0) * a[k];
    const PetscReal v_f    = keep * v_rest + s->alpha_f * v[k];
    q->u0[k]               = u[k];
    q->rate[k]             = damping * v_f;
    q->constant[k]         = im->tled->mass[k / 3] * ((1.0 - s->alpha_m) * a_rest + s->alpha_m * a[k] + alpha * v_f);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* velocity and acceleration that belong to the new displacement x; those of the constrained directions are the constraints' */
static PetscErrorCode Update(TLEDImplicit im, const Scheme *s, PetscReal t_new, PetscReal dt, const PetscReal x[], PetscReal u[],
                             PetscReal v[], PetscReal a[])
{
  const PetscInt n = 3 * im->tled->mesh.n_nodes;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal a_new = (x[k] - u[k]) / (s->beta * dt * dt) - v[k] / (s->beta * dt) - (0.5 / s->beta - 1.0) * a[k];
    v[k] += dt * ((1.0 - s->gamma) * a[k] + s->gamma * a_new);
    a[k] = a_new;
    u[k] = x[k];
  }
  PetscCall(TLEDProject_Private(im->tled, v));
  PetscCall(TLEDProject_Private(im->tled, a));
  PetscCall(TLEDPrescribed_Private(im->tled, t_new, NULL, im->y, im->residual));
  for (PetscInt k = 0; k < n; k++) v[k] += im->y[k], a[k] += im->residual[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step from time t by dt; when Newton's method fails, two steps of half the length. */
static PetscErrorCode Step(TLEDImplicit im, const Scheme *s, PetscReal t, PetscReal dt, PetscInt depth, PetscReal u[], PetscReal v[],
                           PetscReal a[])
{
  const PetscInt n = 3 * im->tled->mesh.n_nodes;
  PetscReal     *x = im->trial;
  PetscBool      converged = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SetStep(im, s, t, dt, u, v, a));
  for (PetscInt attempt = 0; attempt < 2 && !converged; attempt++) { /* guesses: constant acceleration, then no motion */
    for (PetscInt k = 0; k < n; k++) x[k] = attempt ? u[k] : u[k] + dt * v[k] + 0.5 * dt * dt * a[k];
    PetscCall(TLEDProject_Private(im->tled, x));
    for (PetscInt k = 0; k < n; k++) x[k] += im->problem.held_at[k];
    PetscCall(TLEDImplicitNewton_Private(im, x, &converged));
  }
  if (converged) {
    AddWorks(im, -1.0, dt, x, v);
    PetscCall(Update(im, s, t + dt, dt, x, u, v, a));
    ByCall(EndForces(im, t + dt, dt, u, v));
    AddWorks(im, 1.0, dt, x, v);
    im->state_time = t + dt;
    im->stats.load_steps++;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  im->stats.cuts++;
  if (depth == HALVINGS) PetscFunctionReturn(BY_ERR_BREAKDOWN);
  ByCall(Step(im, s, t, 0.5 * dt, depth + 1, u, v, a));
  ByCall(Step(im, s, t + 0.5 * dt, 0.5 * dt, depth + 1, u, v, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Steps(TLEDImplicit im, PetscReal dt, PetscInt n_steps, PetscReal u[], PetscReal v[])
{
  const Scheme   s    = MakeScheme(im->params.rho_infinity);
  const TLED     tled = im->tled;
  const PetscReal t0  = tled->state.time;
  PetscErrorCode ierr = PETSC_SUCCESS;
  PetscInt       i;

  PetscFunctionBegin;
  ierr = KnowAcceleration(im, u, v);
  if (ierr == BY_ERR_BREAKDOWN) PetscFunctionReturn(TLEDReportBroken_Private(tled, u, t0));
  PetscCall(ierr);
  im->state_time = t0;
  for (i = 0; i < n_steps && !ierr; i++) ierr = Step(im, &s, t0 + (PetscReal)i * dt, dt, 0, u, v, im->a);
  if (ierr == BY_ERR_BREAKDOWN)
    PetscCall(PetscSNPrintf(tled->breakdown, TLED_MESSAGE,
                            "body %s: Newton's method fails at time %.6g s for an implicit step of %.2g s (residual over forces %.2g)",
                            ((PetscObject)tled)->name, (double)im->problem.time, (double)(dt / PetscPowReal(2.0, HALVINGS)),
                            (double)im->stats.residual));
  else PetscCall(ierr);
  PetscCall(TLEDImplicitFinish_Private(im, u, v, ierr ? im->state_time : t0 + (PetscReal)n_steps * dt));
  PetscFunctionReturn(ierr);
}

/* after the last step: its forces go on to a step of either solver, unless the state is changed */
static PetscErrorCode Remember(TLEDImplicit im, PetscBool whole)
{
  const TLED tled   = im->tled;
  const Vec  vec[3] = {tled->u, tled->v, tled->f};

  PetscFunctionBegin;
  for (int i = 0; i < 3; i++) PetscCall(PetscObjectStateGet((PetscObject)vec[i], &im->state[i]));
  im->state_time = tled->state.time;
  im->stepped    = whole;
  if (whole) PetscCall(PetscArraycpy(tled->force, im->inner, 3 * tled->mesh.n_nodes));
  tled->force_state = im->state[0];
  tled->force_valid = whole;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDImplicitAdvance - move the body by n_steps implicit steps

  Collective

  Input Parameters:
+ implicit - the solver
. dt       - time step [s], > 0; of any length when the vibrations are small. Large ones need some fifty steps a period: with 24 the
             midpoint rule gained a third of the energy of a beam that swings by half its length, with 43 it kept it within 0.1 %
- n_steps  - how many

  Lumped mass, damping, constraints and loads are those of the explicit solid, so that both solve the same equations of motion. External
  forces are taken at the time and place of the internal ones. The works of TLEDGetStats() go on, by the trapezoidal rule: the balance of
  energy is off by what the scheme is.

  Errors: BY_ERR_BREAKDOWN when a step and its parts of down to dt/256 are not solved

  Tests: tests/unit/tled/test_implicit.c, test_implicit_energy.c, test_implicit_contact.c

.seealso: TLEDAdvance()
@*/
PetscErrorCode TLEDImplicitAdvance(TLEDImplicit im, PetscReal dt, PetscInt n_steps)
{
  const TLED       tled = im->tled;
  const PetscInt   n    = 3 * tled->mesh.n_nodes;
  const PetscReal *from;
  PetscLogDouble   t0, t1;
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  PetscCheck(dt > 0.0 && !PetscIsInfOrNanReal(dt), im->comm, PETSC_ERR_ARG_OUTOFRANGE, "dt = %g, expected a finite number > 0 [s]",
             (double)dt);
  PetscCall(PetscTime(&t0));
  PetscCall(PetscMemzero(&im->stats, sizeof im->stats));
  PetscCall(TLEDImplicitSetUp_Private(im));
  PetscCall(VecGetArrayRead(tled->u, &from));
  PetscCall(PetscArraycpy(im->start, from, n));
  PetscCall(VecRestoreArrayRead(tled->u, &from));
  PetscCall(VecGetArrayRead(tled->v, &from));
  PetscCall(PetscArraycpy(im->v, from, n));
  PetscCall(VecRestoreArrayRead(tled->v, &from));
  ierr = Steps(im, dt, n_steps, im->start, im->v);
  PetscCall(Remember(im, ierr ? PETSC_FALSE : PETSC_TRUE));
  PetscCall(PetscTime(&t1));
  im->stats.seconds = t1 - t0;
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
