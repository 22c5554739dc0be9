/* tled_static.c - equilibrium by Newton's method along a way of loads and constraints, in steps that adapt. */
#include "tled/tled_implicit_impl.h"
#include <petsctime.h>

#define EASY 5   /* Newton iterations of a step after which the next may be twice as long */
#define FINE 1e-6 /* of a prescribed move: how far it is tried to find what the body answers to first order */

#define SETTLE_STEPS 100  /* of settling, tries included                                                  */
#define BEGIN        0.1  /* drag at the first step of settling, times stiffness over mass of a mean node */
#define FIRMEST      1e3  /* drag at which settling is given up, in the same measure                      */
#define FAINTEST     1e-9 /* drag that is not made less                                                   */
#define LESS         0.1  /* drag after an easy step over that before it                                  */

/* What leads from the start to the end. */
typedef struct {
  PetscReal  t_start, t_end;
  PetscReal *imbalance;  /* f_ext - f_int at the start, which is taken away bit by bit [N]                   */
  PetscBool  grows;      /* all loads grow from nothing instead, and f_int alone is taken away               */
  PetscReal *offset;     /* u - prescribed displacement at the start, taken away too; constrained directions [m] */
} Way;

/* the problem at part s of the way */
static PetscErrorCode SetPart(TLEDImplicit im, const Way *way, PetscReal s)
{
  TLEDImplicitProblem *q = &im->problem;
  const PetscInt       n = 3 * im->tled->mesh.n_nodes;

  PetscFunctionBegin;
  q->time = way->t_start + s * (way->t_end - way->t_start);
  PetscCall(TLEDPrescribed_Private(im->tled, q->time, q->held_at, NULL, NULL));
  q->load = way->grows ? s : 1.0;
  for (PetscInt k = 0; k < n; k++) {
    q->constant[k] = (1.0 - s) * way->imbalance[k];
    q->held_at[k] += (1.0 - s) * way->offset[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the state where the way begins: what is out of balance there */
static PetscErrorCode BeginWay(TLEDImplicit im, const PetscReal u[], PetscReal t_end, Way *way)
{
  TLEDImplicitProblem *q = &im->problem;
  const PetscInt       n = 3 * im->tled->mesh.n_nodes;

  PetscFunctionBegin;
  way->t_start = im->tled->state.time, way->t_end = t_end;
  q->share = 1.0, q->inertia = q->viscous = 0.0, q->history = PETSC_MAX_REAL;
  PetscCall(PetscArrayzero(q->u0, n));
  PetscCall(PetscCalloc2(n, &way->imbalance, n, &way->offset));
  PetscCall(TLEDPrescribed_Private(im->tled, way->t_start, q->held_at, NULL, NULL));
  for (PetscInt k = 0; k < n; k++) way->offset[k] = u[k];
  PetscCall(TLEDProject_Private(im->tled, way->offset));
  for (PetscInt k = 0; k < n; k++) way->offset[k] = u[k] - way->offset[k] - q->held_at[k];
  PetscCall(TLEDExternalForces_Private(im->tled, way->t_start, u, im->f_ext));
  ByCall(TLEDImplicitForces_Private(im, u, im->f_int));
  /* Loads that follow a body at rest grow as such: held back by a force that does not follow, they would make it unstable on the way.
     Contact does not grow. */
  if (!im->tled->contact.n && TLEDImplicitNorm_Private(n, im->f_int) < 0.5 * TLEDImplicitNorm_Private(n, im->f_ext)) way->grows = PETSC_TRUE;
  for (PetscInt k = 0; k < n; k++) way->imbalance[k] = (way->grows ? 0.0 : im->f_ext[k]) - im->f_int[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x = P x + what is prescribed */
static PetscErrorCode Hold(TLEDImplicit im, PetscReal x[])
{
  PetscFunctionBegin;
  PetscCall(TLEDProject_Private(im->tled, x));
  for (PetscInt k = 0; k < 3 * im->tled->mesh.n_nodes; k++) x[k] += im->problem.held_at[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The equilibria last found and their parts of the way: what the next one is guessed from. */
typedef struct {
  PetscInt   n;    /* how many, 3 at most                 */
  PetscReal  s[3]; /* parts, the last one first           */
  PetscReal *u[3]; /* displacements there, n_nodes x 3 [m] */
} Found;

/* x at part s, by the polynomial through what was found; u[0] when that is one */
static void Extrapolate(const Found *f, PetscInt n, PetscReal s, PetscReal x[])
{
  PetscReal weight[3] = {1.0, 1.0, 1.0};

  for (PetscInt i = 0; i < 3 && i < f->n; i++)
    for (PetscInt j = 0; j < 3 && j < f->n; j++)
      if (j != i) weight[i] *= (s - f->s[j]) / (f->s[i] - f->s[j]);
  for (PetscInt k = 0; k < n; k++) {
    x[k] = f->u[0][k];
    for (PetscInt i = 1; i < 3 && i < f->n; i++) x[k] += weight[i] * (f->u[i][k] - f->u[0][k]); /* the weights add up to one */
  }
}

/* u, found at part s, is one more; the oldest of three is forgotten */
static void Remember(Found *f, PetscInt n, PetscReal s, const PetscReal u[])
{
  PetscReal *room = f->u[2];

  for (int i = 2; i > 0; i--) f->u[i] = f->u[i - 1], f->s[i] = f->s[i - 1];
  f->u[0] = room, f->s[0] = s;
  for (PetscInt k = 0; k < n; k++) room[k] = u[k];
  f->n = PetscMin(3, f->n + 1);
}

/* First guess at part s: along what was found. At the start a prescribed move is answered to first order,
   x = u + move - K^-1 P K move, so that the elements beside the moved nodes do not take it all. */
static PetscErrorCode Guess(TLEDImplicit im, const Found *found, PetscReal s, PetscReal x[])
{
  const PetscReal *u = found->u[0];
  const PetscInt n = 3 * im->tled->mesh.n_nodes;
  PetscReal     *move = im->residual, *answer = im->f_ext, size = 0.0;
  PetscBool      solved;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  Extrapolate(found, n, s, x);
  PetscCall(Hold(im, x));
  if (found->n > 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < n; k++) move[k] = x[k] - u[k], size = PetscMax(size, PetscAbsReal(move[k]));
  if (size == 0.0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < n; k++) im->y[k] = u[k] + FINE * move[k]; /* K move by a difference of the forces */
  ierr = TLEDImplicitForces_Private(im, im->y, answer);
  if (ierr == BY_ERR_BREAKDOWN) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ierr);
  for (PetscInt k = 0; k < n; k++) im->y[k] = u[k] - FINE * move[k];
  ierr = TLEDImplicitForces_Private(im, im->y, im->f_int);
  if (ierr == BY_ERR_BREAKDOWN) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ierr);
  for (PetscInt k = 0; k < n; k++) answer[k] = (im->f_int[k] - answer[k]) / (2.0 * FINE);
  PetscCall(TLEDProject_Private(im->tled, answer));
  ierr = TLEDImplicitLinear_Private(im, u, answer, im->f_int, &solved);
  if (ierr == BY_ERR_BREAKDOWN) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ierr);
  for (PetscInt k = 0; k < n && solved; k++) x[k] += im->f_int[k];
  if (solved) PetscCall(Hold(im, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Go to the problem's equilibrium as a body in a very viscous fluid would: f_int - f_ext + drag M (x - u) = 0, again and again with less and less
   drag, each solved by Newton's method. It finds the way to a stable equilibrium where the tangent is singular (a body that only contact will
   hold, and that does not touch yet) and where it is not positive (a body that snaps to another form). */
static PetscErrorCode Settle(TLEDImplicit im, const PetscReal u[], PetscReal x[], PetscBool *converged)
{
  TLEDImplicitProblem *q    = &im->problem;
  const PetscInt       n    = 3 * im->tled->mesh.n_nodes;
  const PetscReal      unit = im->held * (PetscReal)(n / 3) / im->tled->mass_total;
  PetscReal            drag = BEGIN * unit;
  PetscErrorCode       ierr;

  PetscFunctionBegin;
  *converged = PETSC_FALSE;
  for (PetscInt step = 0; step < SETTLE_STEPS && !*converged && drag <= FIRMEST * unit; step++) {
    const PetscInt before = im->stats.newton;
    PetscBool      moved;
    q->inertia = drag;
    PetscCall(PetscArraycpy(x, q->u0, n));
    PetscCall(Hold(im, x));
    PetscCall(TLEDImplicitNewton_Private(im, x, &moved));
    if (!moved) {
      drag /= LESS;
      continue;
    }
    PetscCall(PetscArraycpy(q->u0, x, n));
    q->inertia = 0.0;
    ierr       = TLEDImplicitResidual_Private(im, x, im->residual);
    if (ierr == BY_ERR_BREAKDOWN) break;
    PetscCall(ierr);
    *converged = TLEDImplicitNorm_Private(n, im->residual) <= im->params.tolerance * im->scale ? PETSC_TRUE : PETSC_FALSE;
    if (im->stats.newton - before <= EASY) drag = PetscMax(LESS * drag, FAINTEST * unit);
  }
  q->inertia = 0.0;
  PetscCall(PetscArraycpy(q->u0, u, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one load step to part s; with `settle` the body is let go there when Newton's method fails */
static PetscErrorCode LoadStep(TLEDImplicit im, const Found *found, PetscReal s, PetscBool settle, PetscReal x[], PetscBool *converged)
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(im->problem.u0, found->u[0], 3 * im->tled->mesh.n_nodes));
  PetscCall(Guess(im, found, s, x));
  PetscCall(TLEDImplicitNewton_Private(im, x, converged));
  if (!*converged && settle) PetscCall(Settle(im, found->u[0], x, converged));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* load steps from u to the end; u is the last equilibrium found, part where it is */
static PetscErrorCode FollowWay(TLEDImplicit im, const Way *way, PetscReal u[], PetscReal *part)
{
  const PetscInt n     = 3 * im->tled->mesh.n_nodes;
  PetscReal     *x     = im->trial, s = 0.0, ds = im->params.load_step;
  Found          found = {0};
  PetscBool      converged, settle;

  PetscFunctionBegin;
  for (int i = 0; i < 3; i++) found.u[i] = im->last[i];
  Remember(&found, n, s, u);
  while (s < 1.0) {
    const PetscReal next   = s + ds > 1.0 - 1e-9 ? 1.0 : s + ds;
    const PetscInt  before = im->stats.newton;
    *part = s;
    PetscCall(SetPart(im, way, next));
    settle = im->tled->contact.n || 0.5 * (next - s) < im->params.load_step_min ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(LoadStep(im, &found, next, settle, x, &converged));
    if (!converged) {
      im->stats.cuts++;
      ds = 0.5 * (next - s);
      if (ds < im->params.load_step_min) PetscFunctionReturn(BY_ERR_BREAKDOWN);
      continue;
    }
    PetscCall(PetscArraycpy(u, x, n));
    s = next;
    Remember(&found, n, s, u);
    im->stats.load_steps++;
    if (im->stats.newton - before <= EASY) ds *= 2.0;
  }
  *part = 1.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDImplicitSolveStatic - from the body's state to equilibrium

  Collective

  Input Parameters:
+ implicit - the solver
- time     - whose loads and constraints are to be balanced [s]; it becomes the body's time

  The way there has a parameter s from 0 to 1: f_int(u) = f_ext(t(s), u) - (1 - s) (f_ext - f_int at the start) or, from a body nearly at
  rest, f_int(u) = s f_ext(t(s), u) + (1 - s) f_int at the start, with the prescribed displacements of t(s) treated alike. Each load step
  is solved by Newton's method, from the parabola through the last three; one that fails, or that turns an element inside out, is tried
  again with half the step; at contact, or when steps become too short, the body is first let settle, by implicit steps of the motion in a
  very viscous fluid.

  Errors: BY_ERR_BREAKDOWN when steps become shorter than load_step_min; TLEDGetBreakdown() tells how far the load went

  Tests: tests/unit/tled/test_static.c, test_implicit.c
@*/
PetscErrorCode TLEDImplicitSolveStatic(TLEDImplicit im, PetscReal time)
{
  const TLED       tled = im->tled;
  const PetscReal *u;
  PetscReal        part = 0.0;
  PetscLogDouble   t0, t1;
  Way              way = {0};
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  PetscCall(PetscTime(&t0));
  PetscCall(PetscMemzero(&im->stats, sizeof im->stats));
  PetscCall(TLEDImplicitSetUp_Private(im));
  PetscCall(VecGetArrayRead(tled->u, &u));
  PetscCall(PetscArraycpy(im->start, u, 3 * tled->mesh.n_nodes));
  PetscCall(VecRestoreArrayRead(tled->u, &u));
  ierr = BeginWay(im, im->start, time, &way);
  if (ierr == BY_ERR_BREAKDOWN) ierr = TLEDReportBroken_Private(tled, im->start, tled->state.time);
  else if (!ierr) {
    ierr = FollowWay(im, &way, im->start, &part);
    if (ierr == BY_ERR_BREAKDOWN)
      PetscCall(PetscSNPrintf(tled->breakdown, TLED_MESSAGE,
                              "body %s: no equilibrium beyond %.4g of the load: Newton's method fails for a load step of %.2g (residual "
                              "over forces %.2g), time %.6g s",
                              ((PetscObject)tled)->name, (double)part, (double)im->params.load_step_min,
                              (double)im->stats.residual, (double)im->problem.time));
    PetscCall(TLEDImplicitFinish_Private(im, im->start, NULL, part < 1.0 ? way.t_start + part * (time - way.t_start) : time));
  }
  im->problem.load = 1.0;
  PetscCall(PetscFree2(way.imbalance, way.offset));
  PetscCall(PetscTime(&t1));
  im->stats.seconds = t1 - t0;
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
