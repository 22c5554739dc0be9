/* tled_breakdown.c - when a body cannot go on: elements turned inside out, numbers lost, a step that is not stable, a critical step below
   the user's limit; which element it is, where and when. */
#include "tled/tled_impl.h"

#define FLOOR 1e-6   /* strain: energies up to that of such a strain in the whole body are no sign of anything            */
#define NEAREST 0.99 /* of the critical step: for longer steps the bound on the energy of a stable motion is this one's   */
#define BEYOND 1.005 /* of the critical step, which is known to a thousandth: no motion is stable, and                     */
#define SIGN 0.1     /* so much of the energy from nowhere is a sign of it                                                 */

/* centre of an element in the deformed body */
static void Centre(TLED tled, PetscInt e, const PetscReal u[], double x[3])
{
  const TLEDMesh *mesh = &tled->mesh;

  for (int k = 0; k < 3; k++) x[k] = 0.0;
  for (int a = 0; a < 4; a++) {
    const PetscInt node = mesh->tets[mesh->n_corners * e + a];
    for (int k = 0; k < 3; k++) x[k] += 0.25 * (mesh->X[3 * node + k] + u[3 * node + k]);
  }
}

/* Write the breakdown message: the first broken element in the file's numbers, its place and det F, the time. Returns
   BY_ERR_BREAKDOWN. */
PetscErrorCode TLEDReportBroken_Private(TLED tled, const PetscReal u[], PetscReal time)
{
  const TLEDBlocks *b       = &tled->blocks;
  PetscInt          first   = -1, last = -1, n_broken = 0;
  double            J_first = 0.0, x[3];

  PetscFunctionBegin;
  for (int k = 0; k < TLED_LANES * b->n_packs * b->n_points; k++) {
    const int l = k / b->n_points;
    TLEDPoint p;
    if (b->element[l] < 0) continue;
    TLEDPointAt_Private(&tled->loops, tled->mesh.tets, l, k % b->n_points, u, &p);
    const double J = 1.0 + p.jm1;
    if (J > 0.0) continue;
    if (first < 0) first = b->element[l], J_first = J;
    if (last != b->element[l]) n_broken++;
    last = b->element[l];
  }
  if (first < 0) {
    PetscCall(PetscSNPrintf(tled->breakdown, TLED_MESSAGE, "body %s: the internal forces are not finite at time %g s",
                            ((PetscObject)tled)->name, (double)time));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  Centre(tled, first, u, x);
  PetscCall(PetscSNPrintf(
      tled->breakdown, TLED_MESSAGE,
      "body %s: element %" PetscInt_FMT " of the mesh file %s at (%.4g, %.4g, %.4g) m, time %.6g s: det F = %.3g (%" PetscInt_FMT
      " such elements)",
      ((PetscObject)tled)->name, tled->mesh.tag[first], PetscIsNanReal(J_first) ? "is lost (not a number)" : "turned inside out", x[0],
      x[1], x[2], (double)time, J_first, n_broken));
  PetscFunctionReturn(BY_ERR_BREAKDOWN);
}

/* element of the highest energy density [J/m^3] at u */
static PetscInt MostStrained(TLED tled, const PetscReal u[])
{
  const TLEDBlocks *b    = &tled->blocks;
  PetscInt          most = 0;
  double            top  = -1.0;

  TLEDKnowVolumes_Private(&tled->loops, u);
  for (int k = 0; k < TLED_LANES * b->n_packs * b->n_points; k++) {
    TLEDPoint p;
    if (b->element[k / b->n_points] < 0) continue;
    TLEDPointAt_Private(&tled->loops, tled->mesh.tets, k / b->n_points, k % b->n_points, u, &p);
    const double W = TLEDEnergy(p.law.law, p.law.fibre, p.seen);
    if (W > top) top = W, most = b->element[k / b->n_points];
  }
  return most;
}

/* element that has most of the energy of the highest mode found last */
static PetscInt MostInMode(TLED tled, const PetscReal u[])
{
  const TLEDBlocks *b    = &tled->blocks;
  PetscInt          most = 0;
  PetscReal         top  = -1.0;

  TLEDKnowVolumes_Private(&tled->loops, u);
  for (int l = 0; l < TLED_LANES * b->n_packs; l++) {
    if (b->element[l] < 0) continue;
    const PetscReal energy = TLEDModeEnergy_Private(tled, l, u);
    if (energy > top) top = energy, most = b->element[l];
  }
  return most;
}

static PetscReal Floor(TLED tled)
{
  PetscReal mu = 0.0;

  for (PetscInt k = 0; k < tled->n_materials; k++) mu = PetscMax(mu, tled->laws[k].mu);
  return FLOOR * FLOOR * mu * tled->volume;
}

/*
  TLEDWatch_Private - begin to watch the energy, and hold the critical step against the user's limit

  Called between substeps with the critical step known: when the body's state is not what the last substep left, and whenever the
  critical step has been renewed, so that what is watched is the last thousand substeps.

  Errors: BY_ERR_BREAKDOWN, reported, when the critical step is below the key step_limit
*/
PetscErrorCode TLEDWatch_Private(TLED tled, const PetscReal u[], const PetscReal v[], PetscReal time)
{
  TLEDState      *s        = &tled->state;
  const PetscReal limit    = tled->params.step_limit;
  const PetscReal critical = TLEDStableStep_Private(tled);
  PetscReal       kinetic = 0.0, gravity = 0.0, strain;
  double          x[3];

  PetscFunctionBegin;
  if (critical < limit) {
    const PetscInt e = MostInMode(tled, u);
    Centre(tled, e, u, x);
    PetscCall(PetscSNPrintf(tled->breakdown, TLED_MESSAGE,
                            "body %s: the critical step is %.4g s at time %.6g s, below step_limit %.4g s; element %" PetscInt_FMT
                            " of the mesh file at (%.4g, %.4g, %.4g) m has most of the highest mode",
                            ((PetscObject)tled)->name, (double)critical, (double)time, (double)limit, tled->mesh.tag[e], x[0], x[1],
                            x[2]));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  PetscCall(TLEDStrain_Private(tled, u, &strain, NULL, NULL));
  strain += TLEDContactEnergy_Private(tled, u);
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) {
    kinetic += 0.5 * tled->mass[a] * Dot3(&v[3 * a], &v[3 * a]);
    gravity += tled->mass[a] * Dot3(tled->gravity, &u[3 * a]);
  }
  s->put_in = kinetic + strain + Floor(tled);
  s->given  = s->external_work + s->support_work + gravity;
  s->owned  = kinetic + s->internal_work + s->damping_loss - s->given;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDIsUnstable_Private - whether the body has energy that nobody put in

  Kinetic energy + work done on the springs + loss by damping - work of loads, supports and gravity would be constant without the error of
  the time step. Central differences conserve, for a linear body, the kinetic energy plus (1 - (omega dt/2)^2) of the elastic one of each
  mode, so that the sum can grow by a factor of 1/(1 - (dt/critical)^2) at most while the step is stable (and only if all is in the
  highest mode); twice that over what the body had and was given is the limit. Above the critical step the energy of the highest mode
  grows by (r + sqrt(r^2 - 1))^4 a step, r = dt/critical, and passes any limit: there a tenth of what the body had is the limit, so
  that it stops before elements break.

  No PETSc inside and no work sharing: every thread of a parallel region gets the same answer. `sums` are the chunks' of the substeps
  that have not been added to the state yet.
*/
PetscBool TLEDIsUnstable_Private(TLED tled, PetscReal dt)
{
  const TLEDState *s        = &tled->state;
  const PetscInt   n_chunks = (tled->mesh.n_nodes + TLED_CHUNK - 1) / TLED_CHUNK;
  const PetscReal  critical = TLEDStableStep_Private(tled);
  const PetscReal  r        = dt < NEAREST * critical ? dt / critical : NEAREST;
  PetscReal owned = s->internal_work + s->damping_loss - s->external_work - s->support_work, given = s->external_work + s->support_work;

  for (PetscInt c = 0; c < n_chunks; c++) {
    const PetscReal *sum = &tled->sums[TLED_SUMS * c];
    owned += sum[TLED_SUM_KINETIC] - sum[TLED_SUM_GRAVITY] + TLEDStepBalance(sum) - sum[TLED_SUM_OPENED];
    given += sum[TLED_SUM_EXTERNAL] + sum[TLED_SUM_SUPPORT] + sum[TLED_SUM_GRAVITY];
  }
  const PetscReal more = given > s->given ? given - s->given : 0.0;
  const PetscReal limit = dt > BEYOND * critical ? SIGN : 2.0 / (1.0 - r * r);
  return owned - s->owned <= limit * (s->put_in + more) ? PETSC_FALSE : PETSC_TRUE;
}

/* Write the message of an unstable step of dt: the energies, the steps, the element with the highest energy density. Returns
   BY_ERR_BREAKDOWN. */
PetscErrorCode TLEDReportUnstable_Private(TLED tled, const PetscReal u[], PetscReal time, PetscReal dt)
{
  const PetscInt e = MostStrained(tled, u);
  double         x[3];

  PetscFunctionBegin;
  Centre(tled, e, u, x);
  PetscCall(PetscSNPrintf(tled->breakdown, TLED_MESSAGE,
                          "body %s: the motion is unstable at time %.6g s: it has energy that nobody gave it; the step is %.4g s, the critical one was %.4g s; element %" PetscInt_FMT
                          " of the mesh file at (%.4g, %.4g, %.4g) m is strained most",
                          ((PetscObject)tled)->name, (double)time, (double)dt,
                          (double)TLEDStableStep_Private(tled), tled->mesh.tag[e], x[0], x[1],
                          x[2]));
  PetscFunctionReturn(BY_ERR_BREAKDOWN);
}
