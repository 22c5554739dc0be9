/* tled_mass.c - the lumped mass, the largest stable step of each element alone, and mass added to elements whose step is short. */
#include "tled/tled_impl.h"
#include "tled/tled_t10.h"
#include <petscblaslapack.h>

#define MOST_NODES 10
#define MOST_ROWS (3 * MOST_NODES) /* displacements of an element */
#define SLACK 3.0   /* body's critical step over the least of its elements' at most, in a mesh without slivers          */
#define N_TRIALS 40 /* times that mass scaling may come closer to the step asked for                                  */
#define N_STEPS 200 /* iterations of the critical step in each                                                        */
#define CLOSER 0.99 /* at least so much in each, since the critical step itself is found to a thousandth               */
#define NEARLY 0.9  /* of the step asked for: all elements come closer                                                */
#define PART 1e-3   /* of the largest energy of an element in the highest mode: it takes part                          */

/* Volume [m^3] and masses of an element's nodes [kg]: equal shares, and by diagonal scaling for ten nodes. */
static double ElementMasses(TLED tled, int l, double m[])
{
  const TLEDBlocks *b       = &tled->blocks;
  const PetscReal   density = tled->materials[b->material[l / TLED_LANES]].density;
  double            G[3 * MOST_NODES], V0, volume = 0.0;

  for (int point = 0; point < b->n_points; point++) {
    tled->loops.ops->point(b, l, point, G, &V0);
    volume += V0;
  }
  if (tled->mesh.n_corners == 10) {
    double X[30];
    for (int k = 0; k < 30; k++) X[k] = tled->mesh.X[3 * tled->mesh.tets[10 * b->element[l] + k / 3] + k % 3];
    (void)TLEDLumpT10(X, m);
    for (int a = 0; a < 10; a++) m[a] *= density;
  } else
    for (int a = 0; a < 4; a++) m[a] = 0.25 * density * volume;
  return volume;
}

static const PetscInt *Corners(TLED tled, int l) { return &tled->mesh.tets[tled->mesh.n_corners * tled->blocks.element[l]]; }

/*
  TLEDLumpMass_Private - nodal masses and the volume, from the elements

  Each node's mass is the sum of its elements' shares, in the order of the elements. Mass scaling comes on top
  (TLEDScaleMass_Private).
*/
PetscErrorCode TLEDLumpMass_Private(TLED tled)
{
  const TLEDBlocks *b = &tled->blocks;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(tled->mesh.n_nodes, &tled->mass));
  tled->volume = 0.0;
  for (int l = 0; l < TLED_LANES * b->n_packs; l++) {
    double m[MOST_NODES];
    if (b->element[l] < 0) continue;
    tled->volume += ElementMasses(tled, l, m);
    for (PetscInt a = 0; a < tled->mesh.n_corners; a++) tled->mass[Corners(tled, l)[a]] += m[a];
  }
  tled->mass_total = 0.0;
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) tled->mass_total += tled->mass[a];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDStiffnessAt_Private - stiffness of the element in a lane [N/m]

  Input Parameters:
+ tled - with laws, blocks and, when u is given and the element averages volumes, loops.nodal at u
. lane - place of the element, not padding
- u    - displacement [m], NULL for the reference state

  Output Parameter:
. K - 3n x 3n, row-major, rows 3 a + i

  For `anp` it is the stiffness with the averaged gradient held, which is an upper bound at small strain: the mean of volume changes
  has no more energy than the volume changes.
*/
void TLEDStiffnessAt_Private(TLED tled, int lane, const PetscReal u[], double K[])
{
  const TLEDLoops *w = &tled->loops;
  const int        n = w->ops->n_corners;

  for (int k = 0; k < 9 * n * n; k++) K[k] = 0.0;
  for (int point = 0; point < w->blocks->n_points; point++) {
    TLEDPoint p;
    TLEDPointAt_Private(w, tled->mesh.tets, lane, point, u, &p);
    TLEDElementStiffness(&p.law, p.seen, p.G, n, p.V0, K);
  }
}

/* Critical step [s] of the element alone, with its own masses: 2/sqrt of the largest eigenvalue of M^-1/2 K M^-1/2. */
static PetscErrorCode ElementStep(TLED tled, int l, PetscReal *dt)
{
  double       K[MOST_ROWS * MOST_ROWS], m[MOST_NODES];
  PetscScalar  values[MOST_ROWS], work[8 * MOST_ROWS];
  PetscBLASInt n = (PetscBLASInt)(3 * tled->mesh.n_corners), n_work = 8 * MOST_ROWS, info;

  PetscFunctionBegin;
  TLEDStiffnessAt_Private(tled, l, NULL, K);
  (void)ElementMasses(tled, l, m);
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++) K[n * i + j] /= PetscSqrtReal(m[i / 3] * m[j / 3]);
  LAPACKsyev_("N", "U", &n, K, &n, values, work, &n_work, &info);
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK syev failed with info %d", (int)info);
  *dt = 2.0 / PetscSqrtReal(values[n - 1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What mass scaling works on. */
typedef struct {
  PetscReal  asked;       /* critical step to be reached [s]                                    */
  PetscReal *dt;          /* n_tets: critical step of each element alone [s]                    */
  PetscReal *slack;       /* n_tets: its element counts as having the step slack dt             */
  PetscReal *own;         /* n_nodes: masses without what is added [kg]                         */
} Scaling;

static PetscErrorCode ElementSteps(TLED tled, PetscReal dt[], PetscReal *least)
{
  const TLEDBlocks *b = &tled->blocks;

  PetscFunctionBegin;
  *least = PETSC_MAX_REAL;
  for (int l = 0; l < TLED_LANES * b->n_packs; l++) {
    if (b->element[l] < 0) continue;
    PetscCall(ElementStep(tled, l, &dt[b->element[l]]));
    *least = PetscMin(*least, dt[b->element[l]]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodal masses with every element's share multiplied by (asked/(slack dt_e))^2 where that is above one. */
static PetscErrorCode AddMass(TLED tled, const Scaling *s)
{
  const TLEDBlocks *b = &tled->blocks;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(tled->mass, s->own, tled->mesh.n_nodes));
  tled->mass_added = 0.0, tled->n_scaled = 0;
  for (int l = 0; l < TLED_LANES * b->n_packs; l++) {
    const int       e     = b->element[l];
    const PetscReal ratio = e < 0 ? 0.0 : s->asked / (s->slack[e] * s->dt[e]);
    double          m[MOST_NODES];
    if (!(ratio > 1.0)) continue;
    (void)ElementMasses(tled, l, m);
    for (PetscInt a = 0; a < tled->mesh.n_corners; a++) {
      const PetscReal more = (ratio * ratio - 1.0) * m[a];
      tled->mass[Corners(tled, l)[a]] += more;
      tled->mass_added += more;
    }
    tled->n_scaled++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* elastic energy of an element in the highest mode found last, at displacement u as TLEDStiffnessAt_Private() */
PetscReal TLEDModeEnergy_Private(TLED tled, int l, const PetscReal u[])
{
  const PetscInt n = 3 * tled->mesh.n_corners, *corner = Corners(tled, l);
  double         K[MOST_ROWS * MOST_ROWS], x[MOST_ROWS], sum = 0.0;

  TLEDStiffnessAt_Private(tled, l, u, K);
  for (PetscInt i = 0; i < n; i++) x[i] = tled->mode[3 * corner[i / 3] + i % 3];
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++) sum += x[i] * K[n * i + j] * x[j];
  return sum;
}

/* Multiply the slack of elements by `factor`, down to 1: of all of them when the step is nearly the one asked for, else of those
   that take part in the highest mode. */
static void TakeSlack(TLED tled, Scaling *s, PetscReal factor, PetscReal *energy)
{
  const TLEDBlocks *b   = &tled->blocks;
  PetscReal         top = 0.0;

  for (int l = 0; l < TLED_LANES * b->n_packs && factor < NEARLY; l++) {
    if (b->element[l] < 0) continue;
    energy[b->element[l]] = TLEDModeEnergy_Private(tled, l, NULL);
    top                   = PetscMax(top, energy[b->element[l]]);
  }
  for (PetscInt e = 0; e < tled->mesh.n_tets; e++)
    if (factor >= NEARLY || energy[e] > PART * top) s->slack[e] = PetscMax(1.0, s->slack[e] * factor);
}

/*
  TLEDScaleMass_Private - add mass to the elements that keep the critical step below the key mass_scaling

  Called once, at the reference state, when the loops are ready. The critical step of each element alone, dt_e, bounds that of the body
  from below, but not sharply: in a good mesh the body's is two to three times the least of them. Hence an element gets mass where
  slack_e dt_e is below the step asked for, which brings it there. slack_e begins at three and falls, for the elements that take part
  in the highest mode, until the critical step by power iteration is the one asked for; slack_e = 1 for all suffices for certain. The
  mass weighs and moves like any other.

  Reference: K_e and M_e bound the assembled eigenvalues: B. Irons & G. Treharne, A bound theorem in eigenvalues, 1971
  Tests: tests/unit/tled/test_mass.c
*/
PetscErrorCode TLEDScaleMass_Private(TLED tled)
{
  const PetscInt   n = tled->mesh.n_tets;
  Scaling          s = {tled->params.mass_scaling, NULL, NULL, NULL};
  PetscReal       *energy, least, critical;
  const PetscReal *u;

  PetscFunctionBegin;
  if (!(s.asked > 0.0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc4(n, &s.dt, n, &s.slack, n, &energy, tled->mesh.n_nodes, &s.own));
  PetscCall(PetscArraycpy(s.own, tled->mass, tled->mesh.n_nodes));
  PetscCall(VecGetArrayRead(tled->u, &u));
  PetscCall(TLEDCriticalStep_Private(tled, u, N_STEPS, &critical));
  if (critical < s.asked) {
    PetscCall(ElementSteps(tled, s.dt, &least));
    for (PetscInt e = 0; e < n; e++) s.slack[e] = PetscMax(1.0, PetscMin(SLACK, critical / least));
    PetscCall(AddMass(tled, &s));
    PetscCall(TLEDCriticalStep_Private(tled, u, N_STEPS, &critical));
  }
  for (PetscInt trial = 1; trial <= N_TRIALS && critical < s.asked; trial++) {
    TakeSlack(tled, &s, PetscMin(CLOSER, critical / s.asked), energy);
    for (PetscInt e = 0; e < n && trial == N_TRIALS; e++) s.slack[e] = 1.0;
    PetscCall(AddMass(tled, &s));
    PetscCall(TLEDCriticalStep_Private(tled, u, N_STEPS, &critical));
  }
  PetscCall(VecRestoreArrayRead(tled->u, &u));
  PetscCall(PetscFree4(s.dt, s.slack, energy, s.own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDGetAddedMass - what mass scaling (key mass_scaling) has added

  Output Parameters (either may be NULL):
+ mass    - [kg]
- percent - of the mass that the body had before

.seealso: TLEDGetMass(), TLEDGetCriticalStep()
@*/
PetscErrorCode TLEDGetAddedMass(TLED tled, PetscReal *mass, PetscReal *percent)
{
  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDGetAddedMass()");
  if (mass) *mass = tled->mass_added;
  if (percent) *percent = 100.0 * tled->mass_added / tled->mass_total;
  PetscFunctionReturn(PETSC_SUCCESS);
}
