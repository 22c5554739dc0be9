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

/* a = (f_ext - f_int)/m - alpha v at the body's state, unless it is known from the last step */
static PetscErrorCode KnowAcceleration(TLEDImplicit im, const PetscReal u[], const PetscReal v[])
{
  const TLED       tled = im->tled;
  const PetscReal  beta = tled->params.stiffness_damping, time = tled->state.time;
  PetscObjectState now_u, now_v;

  PetscFunctionBegin;
  PetscCall(PetscObjectStateGet((PetscObject)tled->u, &now_u));
  PetscCall(PetscObjectStateGet((PetscObject)tled->v, &now_v));
  if (im->stepped && now_u == im->state_u && now_v == im->state_v && time == im->state_time) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TLEDExternalForces_Private(im->tled, time, u, im->f_ext));
  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++) im->y[k] = u[k] + beta * v[k];
  ByCall(TLEDCommitViscous_Private(tled, im->y, 0.0)); /* what was done to u from outside was a jump */
  im->problem.history = 0.0;
  ByCall(TLEDImplicitForces_Private(im, im->y, im->f_int));
  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++)
    im->a[k] = (im->f_ext[k] - im->f_int[k]) / tled->mass[k / 3] - tled->params.damping * v[k];
  PetscCall(TLEDProject_Private(im->tled, im->a));
  PetscFunctionReturn(PETSC_SUCCESS);
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
    PetscCall(Update(im, s, t + dt, dt, x, u, v, a));
    for (PetscInt k = 0; k < n; k++) im->y[k] = u[k] + im->tled->params.stiffness_damping * v[k];
    ByCall(TLEDCommitViscous_Private(im->tled, im->y, dt));
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

/*@
  TLEDImplicitAdvance - move the body by n_steps implicit steps

  Collective

  Input Parameters:
+ implicit - the solver
. dt       - time step [s], > 0; of any length when the vibrations are small. Large ones need some fifty steps a period: with 24 the
             midpoint rule gained a third of the energy of a beam that swings by half its length, with 43 it kept it within 0.1 %
- n_steps  - how many

  Lumped mass, damping, constraints and loads are those of the explicit solid, so that both solve the same equations of motion. External
  forces are taken at the time and place of the internal ones.

  Errors: BY_ERR_BREAKDOWN when a step and its parts of down to dt/256 are not solved

  Tests: tests/unit/tled/test_implicit.c

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
  PetscCall(PetscObjectStateGet((PetscObject)tled->u, &im->state_u));
  PetscCall(PetscObjectStateGet((PetscObject)tled->v, &im->state_v));
  im->state_time = tled->state.time;
  im->stepped    = ierr ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscTime(&t1));
  im->stats.seconds = t1 - t0;
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
