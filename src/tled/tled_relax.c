/* tled_relax.c - dynamic relaxation: the body comes to rest under loads and supports in a fictitious time.

   Central differences of M u'' + c M u' = r(u) with step 1, M chosen so that every mode is resolved as well as it can be:
     v <- (2 - c)/(2 + c) v + 2/(2 + c) M^-1 r,   u <- u + v,   r = P (f_ext - f_int)
   M_a is a bound of the stiffness at node a, from the elements around it, times a common factor that puts the highest frequency of
   M^-1 K, found by power iteration, at SAFETY times the limit 2: slivers and stiff parts only get more mass. c = 2 omega with the lowest
   frequency that the motion has, from the Rayleigh quotient of the last step, omega^2 = (v . dr)/(v . M v).

   On the way to the end, part s of 1, loads and supports are those of the time between, and what was out of balance at the start is given
   back as (1 - s) of it: any state is a fit start, and a load that is there from the beginning grows from nothing.

   References: P. Underwood, Dynamic relaxation, in Computational Methods for Transient Analysis (1983) 245-265; G. R. Joldes, A. Wittek,
   K. Miller, Int. J. Numer. Meth. Biomed. Engng 27 (2011) 173, doi:10.1002/cnm.1407 (adaptive parameters, error of the displacement);
   kinetic damping: J. R. H. Otter, A. C. Cassell, R. E. Hobbs, Dynamic relaxation, Proc. ICE 35 (1966) 633 */
#include "tled/tled_impl.h"

#define SAFETY 0.95       /* of the limit of stability; the power iteration finds the highest frequency to a thousandth            */
#define LOOK_STEPS 50     /* steps between two looks at the deformation                                                           */
#define CHANGED 0.1       /* of the smallest det F or the largest |F|^2: new masses                                                */
#define FIRST_STEPS 200   /* iterations of the first highest mode                                                                  */
#define FOLLOWING_STEPS 20
#define RAMP 50           /* steps of the first try in which loads and supports go to the end                                      */
#define RAMP_CELL 0.1     /* of an element's size: what a support moves in a step of it at most                                    */
#define N_TRIES 7         /* each with a ramp four times as long, when elements break                                              */
#define CALM 6.0          /* over omega: steps through which all is below the tolerance at the end. What a stiffer mode hid has come
                             out by then: it has fallen by e^6                                                                     */
#define STUCK 60.0        /* over omega: steps without a better state, after which damping is kinetic                              */
#define RISE 4.0          /* over the lowest omega^2 of late: what damping follows of a larger one                                 */
#define HIGH 3.0          /* of Rayleigh's quotient, whose limit of stability is 4: the highest modes grow                         */
#define LOWEST 1e-14      /* omega^2, of a motion without stiffness                                                                */

typedef struct {
  PetscReal *u;                        /* the body's, n_nodes x 3 like all but `mass`                                  */
  PetscReal *v, *r, *last, *pull;      /* velocity, residual of this and of the last step, residual at the start      */
  PetscReal *external, *held, *offset; /* external forces; supports' displacement, and how far u was from it at the start */
  PetscReal *start, *mode;             /* u at the start; highest mode                                                 */
  PetscReal *mass;                     /* fictitious, n_nodes                                                          */
  PetscReal  from, to;                 /* time of the start and the end [s]                                            */
  PetscReal  stretch[2];               /* smallest det F and largest |F|^2 when the masses were made                   */
  PetscReal  residual;                 /* |r| over the forces it is made of                                            */
  PetscReal  error;                    /* estimated, of u over the largest u                                           */
  PetscReal  omega2;                   /* lowest frequency^2 of late                                                   */
  PetscReal  quotient;                 /* Rayleigh's, of the last step                                                 */
  PetscReal  kinetic;                  /* energy of the last step                                                      */
  PetscReal  best;                     /* smallest error so far                                                        */
  PetscInt   best_step, calm;          /* when; steps since all is below the tolerance                                 */
  PetscBool  by_peaks;                 /* kinetic damping                                                              */
} Relax;

/* sum_b |K_ab| of an element's nodes, Frobenius norms */
static void AddRows(PetscInt n, const double K[], const PetscInt node[], PetscReal sum[])
{
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt j = 0; j < n; j++) {
      PetscReal square = 0.0;
      for (PetscInt k = 0; k < 9; k++) square += PetscSqr(K[3 * n * (3 * i + k / 3) + 3 * j + k % 3]);
      sum[node[i]] += PetscSqrtReal(square);
    }
  }
}

/* Fictitious masses at u: for each node the sum over its elements of sum_b |K_ab|, which bounds M^-1 K by one in every mode (block
   Gershgorin); then a common factor that makes the bound sharp; and what contact may push with
   on top. */
static PetscErrorCode MakeMasses(TLED tled, Relax *x, PetscInt n_steps)
{
  const TLEDBlocks  *b       = &tled->blocks;
  const TLEDContact *contact = &tled->contact;
  const PetscInt     n       = tled->mesh.n_corners;
  double             K[9 * TLED_CORNERS_MAX * TLED_CORNERS_MAX];
  PetscReal          top;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(x->mass, tled->mesh.n_nodes));
  TLEDKnowVolumes_Private(&tled->loops, x->u);
  for (int l = 0; l < TLED_LANES * b->n_packs; l++) {
    const int e = b->element[l];
    if (e < 0) continue;
    TLEDStiffnessAt_Private(tled, l, x->u, K);
    AddRows(n, K, &tled->mesh.tets[n * e], x->mass);
  }
  ByCall(TLEDHighestMode_Private(tled, x->mass, x->u, n_steps, x->mode, &top));
  for (PetscInt a = 0; a < tled->mesh.n_nodes && top > 0.0; a++) x->mass[a] *= top / (4.0 * SAFETY * SAFETY);
  for (PetscInt a = 0; a < tled->mesh.n_nodes && contact->n; a++)
    x->mass[a] += contact->crowding * contact->stiffness * contact->area[a] / (4.0 * SAFETY * SAFETY);
  PetscCall(TLEDStrain_Private(tled, x->u, NULL, NULL, x->stretch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Changed(PetscReal now, PetscReal then) { return PetscAbsReal(now - then) > CHANGED * then ? PETSC_TRUE : PETSC_FALSE; }

/* new masses when the body has deformed, or when the highest modes grow */
static PetscErrorCode LookAtMasses(TLED tled, Relax *x)
{
  PetscReal stretch[2];

  PetscFunctionBegin;
  PetscCall(TLEDStrain_Private(tled, x->u, NULL, NULL, stretch));
  if (x->quotient > HIGH) PetscCall(PetscArraycpy(x->mode, x->v, 3 * tled->mesh.n_nodes)); /* it is the mode to begin with */
  if (x->quotient > HIGH || Changed(stretch[0], x->stretch[0]) || Changed(stretch[1], x->stretch[1]))
    ByCall(MakeMasses(tled, x, FOLLOWING_STEPS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* supports go to part s of the way */
static PetscErrorCode MoveSupports(TLED tled, Relax *x, PetscReal s)
{
  const TLEDConstraints *c = &tled->constraints;

  PetscFunctionBegin;
  PetscCall(TLEDPrescribed_Private(tled, x->from + s * (x->to - x->from), x->held, NULL, NULL));
  PetscCall(TLEDProject_Private(tled, x->u));
  for (PetscInt i = 0; i < c->n_held; i++)
    for (PetscInt k = 3 * c->node[i]; k < 3 * c->node[i] + 3; k++) x->u[k] += x->held[k] + (1.0 - s) * x->offset[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r at part s of the way, its size over that of the forces, and the largest M^-1 r over the largest u; the free directions of the internal
   forces alone go to tled->force */
static PetscErrorCode FindResidual(TLED tled, Relax *x, PetscReal s, PetscReal *reach)
{
  const PetscInt n = 3 * tled->mesh.n_nodes;
  PetscReal      sum[3] = {0.0, 0.0, 0.0}, acceleration = 0.0, displacement = 0.0;

  PetscFunctionBegin;
  ByCall(TLEDForces_Private(tled, x->u, tled->force));
  PetscCall(TLEDExternalForces_Private(tled, x->from + s * (x->to - x->from), x->u, x->external));
  for (PetscInt k = 0; k < n; k++) {
    sum[0] += PetscSqr(tled->force[k]), sum[1] += PetscSqr(x->external[k]);
    x->r[k] = x->external[k] - tled->force[k] - (1.0 - s) * x->pull[k];
  }
  PetscCall(TLEDProject_Private(tled, x->r));
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) {
    const PetscReal r2 = Dot3(&x->r[3 * a], &x->r[3 * a]);
    sum[2] += r2;
    acceleration = PetscMax(acceleration, r2 / PetscSqr(x->mass[a]));
    displacement = PetscMax(displacement, Dot3(&x->u[3 * a], &x->u[3 * a]));
  }
  x->residual = sum[2] > 0.0 ? PetscSqrtReal(sum[2] / PetscMax(sum[0], sum[1])) : 0.0;
  *reach      = sum[2] > 0.0 ? PetscSqrtReal(acceleration / PetscMax(displacement, 1e-300)) : 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what the last step tells: Rayleigh's quotient of its motion, the lowest frequency of late, kinetic energy */
static void Learn(TLED tled, Relax *x)
{
  PetscReal up = 0.0, down = 0.0;

  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) {
    for (PetscInt k = 3 * a; k < 3 * a + 3; k++) up += x->v[k] * (x->last[k] - x->r[k]);
    down += x->mass[a] * Dot3(&x->v[3 * a], &x->v[3 * a]);
  }
  x->kinetic  = 0.5 * down;
  x->quotient = down > 0.0 ? up / down : 0.0;
  if (x->quotient > 0.0 && x->quotient < x->omega2) x->omega2 = PetscMax(x->quotient, LOWEST);
  else x->omega2 *= 1.0 + 0.05 * PetscSqrtReal(x->omega2);
}

/* one step of the motion with the residual known */
static void Move(TLED tled, Relax *x, PetscReal c)
{
  const PetscReal keep = (2.0 - c) / (2.0 + c), gain = 2.0 / (2.0 + c);

  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++) {
    x->last[k] = x->r[k];
    x->v[k]    = keep * x->v[k] + gain * x->r[k] / x->mass[k / 3];
    x->u[k] += x->v[k];
  }
}

/* 2 omega, near the lowest of late: near the end round-off makes the last quotient large; none when damping is kinetic, which stops the
   body at each peak of its energy instead */
static PetscReal Damping(TLED tled, Relax *x, PetscBool ramp, PetscReal kinetic_before)
{
  const PetscReal most = ramp ? 1.0 : RISE * x->omega2;

  if (!x->by_peaks) return 2.0 * PetscSqrtReal(PetscMin(0.9, PetscMax(x->omega2, PetscMin(x->quotient, most))));
  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes && x->kinetic < kinetic_before; k++) x->v[k] = 0.0;
  return 0.0;
}

/* whether the state is good enough, and has been for long enough */
static PetscBool IsAtRest(Relax *x, PetscInt step, PetscReal tolerance)
{
  const PetscReal period = 1.0 / PetscSqrtReal(x->omega2);

  if (x->error < 0.7 * x->best) x->best = x->error, x->best_step = step;
  if ((PetscReal)(step - x->best_step) > STUCK * period) x->by_peaks = PETSC_TRUE, x->best_step = step;
  x->calm = x->residual <= tolerance && x->error <= tolerance ? x->calm + 1 : 0;
  return (PetscReal)x->calm > CALM * period || (x->residual == 0.0 && x->calm) ? PETSC_TRUE : PETSC_FALSE;
}

/* From the start to rest with a ramp of n_ramp steps. BY_ERR_BREAKDOWN, not reported, when an element breaks; *steps counts on, and
   *at_rest tells whether max_steps sufficed. */
static PetscErrorCode Try(TLED tled, Relax *x, PetscInt n_ramp, PetscReal tolerance, PetscInt max_steps, PetscInt *steps,
                          PetscBool *at_rest)
{
  PetscReal reach, kinetic = 0.0;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(x->v, 3 * tled->mesh.n_nodes));
  x->omega2 = 1.0, x->quotient = 0.0, x->best = PETSC_MAX_REAL, x->best_step = 0, x->calm = 0, x->by_peaks = PETSC_FALSE;
  ByCall(MakeMasses(tled, x, FIRST_STEPS));
  for (PetscInt n = 0; *steps < max_steps; n++, (*steps)++) {
    const PetscReal s = PetscMin(1.0, (PetscReal)n / (PetscReal)n_ramp);
    if (n <= n_ramp && tled->constraints.n_held) PetscCall(MoveSupports(tled, x, s));
    if (n % LOOK_STEPS == LOOK_STEPS - 1) ByCall(LookAtMasses(tled, x));
    ByCall(FindResidual(tled, x, s, &reach));
    if (n) Learn(tled, x);
    x->error = reach / x->omega2;
    if (n == n_ramp) x->best = PETSC_MAX_REAL, x->best_step = n, x->omega2 = 1.0;
    if (n > n_ramp && IsAtRest(x, n, tolerance)) {
      *at_rest = PETSC_TRUE;
      break;
    }
    Move(tled, x, Damping(tled, x, (PetscBool)(n <= n_ramp), kinetic));
    kinetic = x->kinetic;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what is out of balance at the start: forces, and the supports' places; also the first ramp, from how far these go */
static PetscErrorCode Begin(TLED tled, Relax *x, PetscInt *n_ramp)
{
  const TLEDConstraints *c    = &tled->constraints;
  const PetscReal        size = PetscPowReal(tled->volume / (PetscReal)tled->mesh.n_tets, 1.0 / 3.0);
  PetscReal              far = 0.0;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(x->start, x->u, 3 * tled->mesh.n_nodes));
  PetscCall(PetscArraycpy(x->offset, x->u, 3 * tled->mesh.n_nodes));
  PetscCall(TLEDProject_Private(tled, x->offset));
  PetscCall(TLEDPrescribed_Private(tled, x->from, x->held, NULL, NULL));
  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++) x->offset[k] = x->u[k] - x->offset[k] - x->held[k];
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) x->mass[a] = 1.0;
  PetscCall(PetscArrayzero(x->pull, 3 * tled->mesh.n_nodes));
  PetscReal reach;
  ByCall(FindResidual(tled, x, 0.0, &reach));
  PetscCall(PetscArraycpy(x->pull, x->r, 3 * tled->mesh.n_nodes));
  PetscCall(TLEDPrescribed_Private(tled, x->to, x->held, NULL, NULL));
  for (PetscInt i = 0; i < c->n_held; i++) {
    PetscReal d[3];
    for (PetscInt k = 0; k < 3; k++) d[k] = x->held[3 * c->node[i] + k] - x->u[3 * c->node[i] + k];
    far = PetscMax(far, Norm3(d));
  }
  *n_ramp = PetscMax(RAMP, (PetscInt)(far / (RAMP_CELL * size)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RelaxArrays(TLED tled, Relax *x, PetscReal tolerance, PetscInt max_steps, PetscInt *steps)
{
  PetscInt       n_ramp  = RAMP;
  PetscBool      at_rest = PETSC_FALSE;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ierr = Begin(tled, x, &n_ramp);
  for (PetscInt k = 0; k < N_TRIES && !ierr; k++, n_ramp *= 4) {
    ierr = Try(tled, x, n_ramp, tolerance, max_steps, steps, &at_rest);
    if (ierr != BY_ERR_BREAKDOWN || k + 1 == N_TRIES || *steps >= max_steps) break;
    PetscCall(PetscArraycpy(x->u, x->start, 3 * tled->mesh.n_nodes));
    ierr = PETSC_SUCCESS;
  }
  if (ierr == BY_ERR_BREAKDOWN) PetscFunctionReturn(TLEDReportBroken_Private(tled, x->u, x->to));
  PetscCall(ierr);
  if (!at_rest) {
    PetscCall(PetscSNPrintf(tled->breakdown, TLED_MESSAGE,
                            "body %s: not at rest at time %g s after %" PetscInt_FMT
                            " steps of dynamic relaxation: residual %.3g of the forces, displacement good to about %.3g, asked %.3g",
                            ((PetscObject)tled)->name, (double)x->to, *steps, (double)x->residual, (double)x->error,
                            (double)tolerance));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDRelax - bring the body to rest under the loads and supports of a time, by dynamic relaxation

  Collective

  Input Parameters:
+ tled      - the body, set up; its state is the start
. time      - of the loads and supports at the end [s]; on the way they go through the times between
. tolerance - the answer is good when the residual over the forces that make it up (2-norms) and the estimated error of u over the
              largest displacement are both below it; > 0
- max_steps - at most that many steps

  Output Parameters:
+ steps    - steps taken (may be NULL)
- residual - of the state reached, over the forces (may be NULL)

  The state after it: u static, v = 0, time `time`. The error of u is estimated by the largest M^-1 r over the lowest frequency^2 that the
  motion has shown, which is what the lowest mode would need to come to rest, and has to stay below the tolerance for six times the time
  1/omega of that mode.

  Errors: BY_ERR_BREAKDOWN when max_steps do not suffice or an element breaks however slowly the loads grow; TLEDGetBreakdown() says which

  Cost: one force evaluation a step; about 20/omega steps with omega the lowest frequency over half the highest.
  Tests: tests/unit/tled/test_relax.c

.seealso: TLEDAdvance(), TLEDImplicitSolveStatic()
@*/
PetscErrorCode TLEDRelax(TLED tled, PetscReal time, PetscReal tolerance, PetscInt max_steps, PetscInt *steps, PetscReal *residual)
{
  const PetscInt n = 3 * tled->mesh.n_nodes;
  PetscInt       taken = 0;
  Relax          x;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDRelax()");
  PetscCheck(tolerance > 0.0, PetscObjectComm((PetscObject)tled), PETSC_ERR_ARG_OUTOFRANGE, "tolerance = %g, expected a number > 0",
             (double)tolerance);
  PetscCall(PetscMemzero(&x, sizeof x));
  PetscCall(PetscMalloc6(n, &x.v, n, &x.r, n, &x.last, n, &x.pull, n, &x.external, n / 3, &x.mass));
  PetscCall(PetscMalloc4(n, &x.held, n, &x.offset, n, &x.start, n, &x.mode));
  PetscCall(PetscArrayzero(x.mode, n));
  x.from = tled->state.time, x.to = time;
  PetscCall(VecGetArray(tled->u, &x.u));
  TLEDSetViscous_Private(tled, TLED_VISCOUS_STEP, PETSC_MAX_REAL); /* at rest, everything has relaxed */
  ierr = RelaxArrays(tled, &x, tolerance, max_steps, &taken);
  TLEDSetViscous_Private(tled, TLED_VISCOUS_STEP, 0.0);
  if (!ierr) ierr = TLEDCommitViscous_Private(tled, x.u, PETSC_MAX_REAL);
  PetscCall(VecRestoreArray(tled->u, &x.u));
  PetscCall(VecSet(tled->v, 0.0));
  tled->state.time      = time;
  tled->state.is_static = 1.0;
  tled->state.critical  = 0.0;
  PetscCall(PetscFree6(x.v, x.r, x.last, x.pull, x.external, x.mass));
  PetscCall(PetscFree4(x.held, x.offset, x.start, x.mode));
  if (steps) *steps = taken;
  if (residual) *residual = x.residual;
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
