/* scheme_iterated.c - a step of fluid and bodies from the same instant (method 5.2, 5.3), asked again until both sides of the interface move alike.

   The unknown is the velocity w of the interface over the step, all bodies that answer in one vector. The fluid, asked with w, gives forces f(w); the
   bodies, run again from the beginning of the step under f, a mean velocity H. What both see alike is H(f(w)) = w. `explicit` stops after one
   evaluation; `mass` has the bodies' response S f in the pressure equation, so that w = b + S f, and iterates b <- H - S f when `passes` allow;
   `iterated` does so until both agree, with steps that learn from those before (relaxation.h); without a response it is the textbook's iteration,
   which must learn all of the Jacobian and begins with a small factor. */
#include "coupler_impl.h"
#include "relaxation.h"

#define QUIET 1e-3 /* [dx per step] the tolerance is relative to the interface's speed, and to this where it is at rest */

/* numbers of the surface's nodes in the interface's vector, for all bodies in water */
PetscErrorCode CouplerNumberInterface(Coupler c)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];
    const PetscInt *triangles;
    PetscInt        n;
    PetscBool      *wet;

    s->interface_start = c->n_interface;
    if (!s->proxy) continue;
    PetscCall(TLEDGetSurface(s->tled, PETSC_TRUE, &n, &triangles));
    PetscCall(PetscCalloc1(s->n_nodes, &wet));
    for (PetscInt i = 0; i < 3 * n; i++) wet[triangles[i]] = PETSC_TRUE;
    PetscCall(PetscMalloc1(s->n_nodes, &s->interface));
    for (PetscInt a = 0; a < s->n_nodes; a++)
      if (wet[a]) s->interface[s->n_interface++] = a;
    PetscCall(PetscFree(wet));
    c->n_interface += 3 * s->n_interface;
  }
  PetscCall(PetscCalloc2(c->n_interface, &c->interface, c->n_interface, &c->residual));
  PetscCall(RelaxationCreate(c->params.relaxation, c->responds && (c->params.scheme == COUPLER_SCHEME_MASS || c->params.response) ? 1.0 : c->params.relaxation_start, c->params.reuse, c->n_interface, &c->relaxation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* residual H - w of the bodies that are asked again, and its rms over the interface's speed; with `all` bodies that water touches in the latter */
static PetscErrorCode Residual(Coupler c, PetscReal dt, PetscBool all)
{
  SPHParams *params;
  PetscReal  difference = 0.0, size = 0.0, quiet;
  PetscInt   n = 0;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(c->sph, &params));
  quiet = QUIET * params->spacing / dt;
  PetscCall(PetscArrayzero(c->residual, c->n_interface));
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];

    for (PetscInt j = 0; j < s->n_interface && (s->iterates || (all && s->touched)); j++) {
      for (int i = 0; i < 3; i++) {
        const PetscReal H = s->mean_velocity[3 * s->interface[j] + i], r = H - s->seen[3 * s->interface[j] + i];

        if (s->iterates) c->residual[s->interface_start + 3 * j + i] = r;
        difference += r * r;
        size += H * H;
      }
      n++;
    }
  }
  c->mismatch = n ? PetscSqrtReal(difference / PetscMax(size, n * quiet * quiet)) : 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the walls' velocities for the next solve */
static PetscErrorCode NextVelocity(Coupler c)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(c->interface, c->n_interface));
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];

    for (PetscInt j = 0; j < s->n_interface && s->iterates; j++)
      for (int i = 0; i < 3; i++) c->interface[s->interface_start + 3 * j + i] = s->wall_velocity[3 * s->interface[j] + i];
  }
  PetscCall(RelaxationNext(c->relaxation, c->interface, c->residual));
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];

    for (PetscInt j = 0; j < s->n_interface && s->iterates; j++)
      for (int i = 0; i < 3; i++) s->wall_velocity[3 * s->interface[j] + i] = c->interface[s->interface_start + 3 * j + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what each body does in this step, and the velocity that its walls begin with */
static PetscErrorCode Begin(Coupler c, PetscReal dt, PetscInt *most)
{
  PetscFunctionBegin;
  c->compliant = PETSC_FALSE;
  *most        = 1;
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];

    /* a body that no water touches needs neither a trial run nor a second one */
    s->touched  = (PetscBool)(c->contacts[k].n_touched > 0);
    s->answers  = (PetscBool)(s->touched && (s->scheme == COUPLER_SCHEME_MASS || (s->scheme == COUPLER_SCHEME_ITERATED && c->responds && c->params.response)));
    s->iterates = (PetscBool)(s->touched && (s->scheme == COUPLER_SCHEME_ITERATED || (s->answers && c->params.passes > 1)));
    if (s->iterates) *most = s->scheme == COUPLER_SCHEME_MASS ? c->params.passes : c->params.iterations;
    if (s->answers) {
      c->compliant = PETSC_TRUE;
      PetscCall(CouplerArms(c, k));
    }
    if (!s->proxy) continue;
    PetscCall(PetscArraycpy(s->last_force, s->force, 3 * s->n_nodes));
    ByCall(CouplerPredictWall(c, s, dt));
    PetscCall(CouplerBaseVelocity(s));
  }
  if (*most > 1) PetscCall(RelaxationBegin(c->relaxation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves of the fluid and runs of the bodies until the interface's residual is below the tolerance; the bodies have then made the step */
static PetscErrorCode Iterate(Coupler c, PetscReal dt, PetscInt most)
{
  PetscFunctionBegin;
  for (c->solves = 1;; c->solves++) {
    ByCall(CouplerSolveFluid(c, dt));
    for (PetscInt k = 0; k < c->n_bodies; k++) {
      CouplerSurface *s = &c->surface[k];

      if (s->iterates) ByCall(CouplerAdvanceBody(c, s, dt));
    }
    PetscCall(CouplerTimer(c, PHASE_SOLID));
    PetscCall(Residual(c, dt, PETSC_FALSE));
    if (most > 1) PetscCall(PetscInfo(c, "step %" PetscInt_FMT ", solve %" PetscInt_FMT ": interface residual %.3g\n", c->step + 1, c->solves, (double)c->mismatch));
    if (c->mismatch <= c->params.tolerance || c->solves >= most) break;
    PetscCall(NextVelocity(c));
    for (PetscInt k = 0; k < c->n_bodies; k++)
      if (c->surface[k].iterates) PetscCall(CouplerReturnBody(&c->surface[k]));
    PetscCall(CouplerTimer(c, PHASE_TRANSFER));
  }
  if (most > 1 && c->mismatch > c->params.tolerance) c->n_unsettled++;
  for (PetscInt k = 0; k < c->n_bodies; k++)
    if (!c->surface[k].iterates) ByCall(CouplerAdvanceBody(c, &c->surface[k], dt));
  PetscCall(Residual(c, dt, PETSC_TRUE));
  PetscCall(CouplerTimer(c, PHASE_SOLID));
  c->solves_sum += c->solves;
  c->mismatch_sum += c->mismatch;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* fluid and bodies over dt from the same instant (method 5.2, steps 1 to 4) */
PetscErrorCode CouplerCoupledStep(Coupler c, PetscReal dt)
{
  PetscInt most;

  PetscFunctionBegin;
  PetscCall(CouplerMoveObstacles(c, dt));
  PetscCall(CouplerUpdateContacts(c));
  PetscCall(CouplerTimer(c, PHASE_PROXIES));
  ByCall(Begin(c, dt, &most));
  PetscCall(CouplerTimer(c, PHASE_SOLID));
  ByCall(SPHPredict(c->sph, dt));
  PetscCall(CouplerTimer(c, PHASE_PRESSURE));
  ByCall(Iterate(c, dt, most));
  for (PetscInt k = 0; k < c->n_bodies; k++)
    if (c->surface[k].proxy) CouplerAddWork(c, &c->surface[k], dt);
  PetscCall(SPHKick(c->sph, dt));
  PetscCall(CouplerTimer(c, PHASE_PRESSURE));
  PetscCall(CouplerStop(c, dt));
  PetscCall(CouplerArriveObstacles(c, dt));
  PetscCall(CouplerTimer(c, PHASE_TRANSFER));
  ByCall(SPHDrift(c->sph, dt));
  PetscCall(CouplerTimer(c, PHASE_PRESSURE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
