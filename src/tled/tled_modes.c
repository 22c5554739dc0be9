/* tled_modes.c - natural frequencies by SLEPc, the exact critical step, and the explicit solid's ring-down beside them. */
#include "tled/tled_assembly.h"
#include "tled/tled_implicit.h"
#ifdef BYSSUS_HAVE_SLEPC
#include <slepceps.h>
#endif

#define APART  1e3   /* times the mean stiffness: of constrained directions, so that their modes lie above all others         */
#define SHIFT  1e-6  /* times the mean of omega^2: shift-invert is done that far below zero, where a free body's K is regular */
#define FINER  8     /* points of a spectrum in 1/T                                                                           */

/*@ TLEDHaveModes - whether this program was built with SLEPc @*/
PetscErrorCode TLEDHaveModes(PetscBool *have)
{
  PetscFunctionBegin;
#ifdef BYSSUS_HAVE_SLEPC
  *have = PETSC_TRUE;
#else
  *have = PETSC_FALSE;
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

#ifdef BYSSUS_HAVE_SLEPC

/* what the eigenproblems are made of */
typedef struct {
  TLEDAssembly *assembly;
  Mat           A;       /* M^-1/2 P K P M^-1/2 + apart (I - P) [1/s^2] */
  Vec           root;    /* M^-1/2                                      */
  PetscReal     mean;    /* of its eigenvalues without the constraints [1/s^2] */
  EPS           eps;
} Problem;

static PetscErrorCode StartSlepc(void)
{
  PetscBool started;

  PetscFunctionBegin;
  PetscCall(SlepcInitialized(&started));
  if (started) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SlepcInitializeNoArguments());
  PetscCall(PetscRegisterFinalize(SlepcFinalize));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* M^-1/2 and the mean of trace(M^-1 K) from the assembly's rows */
static PetscErrorCode ScaleByMass(MPI_Comm comm, TLED tled, Problem *q)
{
  PetscReal *root, sum[2] = {0.0, 0.0};

  PetscFunctionBegin;
  sum[0] = TLEDAssemblyTrace_Private(q->assembly);
  for (PetscInt a = q->assembly->first; a < q->assembly->last; a++) sum[1] += 3.0 * tled->mass[a];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, comm));
  q->mean = sum[0] / sum[1];
  PetscCall(VecCreateMPI(comm, 3 * (q->assembly->last - q->assembly->first), PETSC_DETERMINE, &q->root));
  PetscCall(VecGetArrayWrite(q->root, &root));
  for (PetscInt a = q->assembly->first; a < q->assembly->last; a++)
    for (PetscInt i = 0; i < 3; i++) root[3 * (a - q->assembly->first) + i] = 1.0 / PetscSqrtReal(tled->mass[a]);
  PetscCall(VecRestoreArrayWrite(q->root, &root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the standard eigenproblem of the body's state; `apart` times the mean stiffness in the constrained directions */
static PetscErrorCode CreateProblem(MPI_Comm comm, TLED tled, PetscReal apart, Problem *q)
{
  const PetscReal *u;
  char             prefix[BY_NAME_MAX + 16];
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(q, sizeof *q));
  PetscCall(StartSlepc());
  PetscCall(TLEDAssemblyCreate_Private(comm, tled, &q->assembly));
  PetscCall(VecGetArrayRead(tled->u, &u));
  ierr = TLEDAssemblyFill_Private(tled, u, TLED_TANGENT_EXACT, q->assembly);
  if (ierr == BY_ERR_BREAKDOWN) ierr = TLEDReportBroken_Private(tled, u, tled->state.time);
  PetscCall(VecRestoreArrayRead(tled->u, &u));
  ByCall(ierr);
  PetscCall(ScaleByMass(comm, tled, q));
  TLEDAssemblyProject_Private(tled, apart * q->mean * tled->volume * tled->params.elastic.density / (PetscReal)tled->mesh.n_nodes, q->assembly);
  PetscCall(TLEDAssemblyMatrix_Private(q->assembly, &q->A));
  PetscCall(MatDiagonalScale(q->A, q->root, q->root));
  PetscCall(MatSetOption(q->A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(EPSCreate(comm, &q->eps));
  PetscCall(EPSSetOperators(q->eps, q->A, NULL));
  PetscCall(EPSSetProblemType(q->eps, EPS_HEP));
  PetscCall(PetscSNPrintf(prefix, sizeof prefix, "%s_modes_", ((PetscObject)tled)->name));
  PetscCall(EPSSetOptionsPrefix(q->eps, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyProblem(Problem *q)
{
  PetscFunctionBegin;
  PetscCall(EPSDestroy(&q->eps));
  PetscCall(MatDestroy(&q->A));
  PetscCall(VecDestroy(&q->root));
  PetscCall(TLEDAssemblyDestroy_Private(&q->assembly));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* eigenvalues nearest to zero by factoring A - shift */
static PetscErrorCode SolveLowest(Problem *q, PetscInt n)
{
  const PetscReal shift = -SHIFT * q->mean;
  ST              st;
  KSP             ksp;
  PC              pc;

  PetscFunctionBegin;
  PetscCall(EPSSetDimensions(q->eps, n, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(EPSSetWhichEigenpairs(q->eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSSetTarget(q->eps, shift));
  PetscCall(EPSSetTolerances(q->eps, 1e-11, 1000));
  PetscCall(EPSGetST(q->eps, &st));
  PetscCall(STSetType(st, STSINVERT));
  PetscCall(STGetKSP(st, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
#if PetscDefined(HAVE_MUMPS)
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
#else
  PetscCall(PCSetType(pc, PCLU));
#endif
  PetscCall(EPSSetFromOptions(q->eps));
  PetscCall(EPSSolve(q->eps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* shape number `at` of the result on every rank: M^-1/2 y, its largest number positive */
static PetscErrorCode GetShape(Problem *q, PetscInt at, PetscReal shape[])
{
  Vec              y, everywhere;
  VecScatter       scatter;
  const PetscReal *all;
  PetscInt         n, top = 0;

  PetscFunctionBegin;
  PetscCall(MatCreateVecs(q->A, &y, NULL));
  PetscCall(EPSGetEigenvector(q->eps, at, y, NULL));
  PetscCall(VecPointwiseMult(y, y, q->root));
  PetscCall(VecScatterCreateToAll(y, &scatter, &everywhere));
  PetscCall(VecScatterBegin(scatter, y, everywhere, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, y, everywhere, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetLocalSize(everywhere, &n));
  PetscCall(VecGetArrayRead(everywhere, &all));
  for (PetscInt k = 1; k < n; k++)
    if (PetscAbsReal(all[k]) > PetscAbsReal(all[top])) top = k;
  for (PetscInt k = 0; k < n; k++) shape[k] = all[top] < 0.0 ? -all[k] : all[k];
  PetscCall(VecRestoreArrayRead(everywhere, &all));
  PetscCall(VecDestroy(&everywhere));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(PETSC_SUCCESS);
}
#endif

/*@
  TLEDModes - the lowest natural frequencies of small vibrations about the body's state

  Collective

  Input Parameters:
+ comm - ranks that share the work; each has the same body
. tled - set up
- n    - how many

  Output Parameters:
+ frequency - n [Hz], ascending; minus the root of the modulus for an unstable mode
- shapes    - n x (n_nodes x 3), of unit mass norm; may be NULL

  With the lumped mass, M^-1/2 K M^-1/2 y = omega^2 y by SLEPc's Krylov-Schur method and a factorisation of the exact tangent (options
  -<body>_modes_eps_..., _st_...). Fibres and stresses of the state count, loads that follow it do not.

  Errors: PETSC_ERR_SUP without SLEPc, see TLEDHaveModes(); PETSC_ERR_CONV_FAILED when fewer than n are found

  Tests: tests/unit/tled/test_modes.c
@*/
PetscErrorCode TLEDModes(MPI_Comm comm, TLED tled, PetscInt n, PetscReal frequency[], PetscReal shapes[])
{
#ifdef BYSSUS_HAVE_SLEPC
  Problem     q;
  PetscInt    n_found, *order;
  PetscScalar value;

  PetscFunctionBegin;
  ByCall(CreateProblem(comm, tled, APART, &q));
  PetscCall(SolveLowest(&q, n));
  PetscCall(EPSGetConverged(q.eps, &n_found));
  PetscCheck(n_found >= n, comm, PETSC_ERR_CONV_FAILED, "%" PetscInt_FMT " of %" PetscInt_FMT " modes were found", n_found, n);
  PetscCall(PetscMalloc1(n, &order));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(EPSGetEigenvalue(q.eps, k, &value, NULL));
    frequency[k] = (PetscRealPart(value) < 0.0 ? -1.0 : 1.0) * PetscSqrtReal(PetscAbsScalar(value)) / (2.0 * PETSC_PI);
    order[k]     = k;
  }
  PetscCall(PetscSortRealWithArrayInt(n, frequency, order));
  for (PetscInt k = 0; k < n && shapes; k++) PetscCall(GetShape(&q, order[k], &shapes[3 * tled->mesh.n_nodes * k]));
  PetscCall(PetscFree(order));
  PetscCall(DestroyProblem(&q));
  PetscFunctionReturn(PETSC_SUCCESS);
#else
  PetscFunctionBegin;
  (void)tled, (void)n, (void)frequency, (void)shapes;
  SETERRQ(comm, PETSC_ERR_SUP, "natural frequencies need SLEPc, which this program was built without (Debian: slepc-dev)");
#endif
}

/*@
  TLEDExactCriticalStep - 2/omega_max [s] of the body's state, to round-off

  Collective. The largest eigenvalue by SLEPc's Krylov-Schur method; TLEDGetCriticalStep() estimates the same in fewer operations.

  Errors: PETSC_ERR_SUP without SLEPc

  Tests: tests/unit/tled/test_modes.c
@*/
PetscErrorCode TLEDExactCriticalStep(MPI_Comm comm, TLED tled, PetscReal *dt)
{
#ifdef BYSSUS_HAVE_SLEPC
  Problem     q;
  PetscInt    n_found;
  PetscScalar value;

  PetscFunctionBegin;
  ByCall(CreateProblem(comm, tled, 0.0, &q));
  PetscCall(EPSSetWhichEigenpairs(q.eps, EPS_LARGEST_REAL));
  PetscCall(EPSSetDimensions(q.eps, 1, 40, PETSC_DEFAULT));
  PetscCall(EPSSetTolerances(q.eps, 1e-12, 10000));
  PetscCall(EPSSetFromOptions(q.eps));
  PetscCall(EPSSolve(q.eps));
  PetscCall(EPSGetConverged(q.eps, &n_found));
  PetscCheck(n_found >= 1, comm, PETSC_ERR_CONV_FAILED, "the largest eigenvalue was not found");
  PetscCall(EPSGetEigenvalue(q.eps, 0, &value, NULL));
  *dt = 2.0 / PetscSqrtReal(PetscRealPart(value));
  PetscCall(DestroyProblem(&q));
  PetscFunctionReturn(PETSC_SUCCESS);
#else
  PetscFunctionBegin;
  (void)tled, (void)dt;
  SETERRQ(comm, PETSC_ERR_SUP, "the exact critical step needs SLEPc, which this program was built without (Debian: slepc-dev)");
#endif
}

/* add to the body's velocity that of the modes; each then moves by at most `amplitude` where it is largest */
static PetscErrorCode Excite(TLED tled, PetscInt n_modes, const PetscReal frequency[], const PetscReal shapes[], PetscReal amplitude)
{
  const PetscInt n = 3 * tled->mesh.n_nodes;
  PetscReal     *v;

  PetscFunctionBegin;
  PetscCall(VecGetArray(tled->v, &v));
  for (PetscInt m = 0; m < n_modes; m++) {
    PetscReal top = 0.0;
    for (PetscInt k = 0; k < n; k++) top = PetscMax(top, PetscAbsReal(shapes[n * m + k]));
    for (PetscInt k = 0; k < n; k++) v[k] += 2.0 * PETSC_PI * frequency[m] * amplitude / top * shapes[n * m + k];
  }
  PetscCall(VecRestoreArray(tled->v, &v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sample i of the records at the present state, displacements counted from u0 */
static PetscErrorCode Sample(TLED tled, const PetscReal u0[], PetscInt n_modes, const PetscReal shapes[], PetscInt node, PetscInt n_samples,
                             PetscInt i, PetscReal modal[], PetscReal record[])
{
  const PetscInt   n = 3 * tled->mesh.n_nodes;
  const PetscReal *u;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(tled->u, &u));
  for (PetscInt m = 0; m < n_modes; m++) {
    PetscReal sum = 0.0;
    for (PetscInt k = 0; k < n; k++) sum += shapes[n * m + k] * tled->mass[k / 3] * (u[k] - u0[k]);
    modal[n_samples * m + i] = sum;
  }
  for (PetscInt k = 0; k < 3 && record; k++) record[3 * i + k] = u[3 * node + k] - u0[3 * node + k];
  PetscCall(VecRestoreArrayRead(tled->u, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDRingDown - vibrations of the explicit solid after a push in the shapes of modes

  Input Parameters:
+ tled      - in equilibrium; its state is the same afterwards (TLEDSave() and TLEDRestore() are used)
. n_modes, frequency, shapes - what to excite, from TLEDModes()
. amplitude - [m], of each mode at the node where it is largest: small, so that the body answers linearly
. node      - whose motion is recorded
- dt, n_samples - between samples [s], and how many; the first is the start

  Output Parameters:
+ modal  - n_modes x n_samples: phi . M (u - u_start), each mode by itself [m sqrt(kg)]
- record - n_samples x 3: u - u_start of the node [m]; may be NULL

  Errors: BY_ERR_BREAKDOWN of TLEDAdvance()

.seealso: TLEDSpectrumPeak()
@*/
PetscErrorCode TLEDRingDown(TLED tled, PetscInt n_modes, const PetscReal frequency[], const PetscReal shapes[], PetscReal amplitude,
                            PetscInt node, PetscReal dt, PetscInt n_samples, PetscReal modal[], PetscReal record[])
{
  const PetscReal *u;
  PetscReal       *u0;
  PetscErrorCode   ierr = PETSC_SUCCESS;

  PetscFunctionBegin;
  PetscCall(TLEDSave(tled));
  PetscCall(PetscMalloc1(3 * tled->mesh.n_nodes, &u0));
  PetscCall(VecGetArrayRead(tled->u, &u));
  PetscCall(PetscArraycpy(u0, u, 3 * tled->mesh.n_nodes));
  PetscCall(VecRestoreArrayRead(tled->u, &u));
  PetscCall(Excite(tled, n_modes, frequency, shapes, amplitude));
  for (PetscInt i = 0; i < n_samples && !ierr; i++) {
    if (i) ierr = TLEDAdvance(tled, dt, NULL);
    PetscCall(Sample(tled, u0, n_modes, shapes, node, n_samples, i, modal, record));
  }
  PetscCall(PetscFree(u0));
  ByCall(ierr);
  PetscCall(TLEDRestore(tled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |sum of w_i (x_i - mean) e^(-2 pi j f i dt)|^2 with the Hann window w */
static PetscReal SpectrumAt(PetscInt n, PetscReal dt, const PetscReal x[], PetscReal mean, PetscReal f)
{
  PetscReal re = 0.0, im = 0.0;

  for (PetscInt i = 0; i < n; i++) {
    const PetscReal w = 0.5 - 0.5 * PetscCosReal(2.0 * PETSC_PI * ((PetscReal)i + 0.5) / (PetscReal)n), phase = 2.0 * PETSC_PI * f * dt * (PetscReal)i;
    re += w * (x[i] - mean) * PetscCosReal(phase);
    im += w * (x[i] - mean) * PetscSinReal(phase);
  }
  return re * re + im * im;
}

/*@
  TLEDSpectrumPeak - frequency [Hz] of the highest peak of a record between f_min and f_max

  The spectrum with a Hann window at points 1/(8 T) apart, T the length of the record, and a parabola through the logarithms of the
  highest point and its neighbours. Its error falls with T: a peak is 4/T wide, and modes nearer than that are not told apart.
@*/
PetscErrorCode TLEDSpectrumPeak(PetscInt n_samples, PetscReal dt, const PetscReal record[], PetscReal f_min, PetscReal f_max, PetscReal *frequency)
{
  const PetscReal step = 1.0 / (FINER * dt * (PetscReal)n_samples);
  PetscReal       mean = 0.0, best = f_min, top = 0.0, y[3];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n_samples; i++) mean += record[i] / (PetscReal)n_samples;
  for (PetscReal f = f_min; f <= f_max; f += step) {
    const PetscReal p = SpectrumAt(n_samples, dt, record, mean, f);
    if (p > top) top = p, best = f;
  }
  for (int k = 0; k < 3; k++) y[k] = PetscLogReal(SpectrumAt(n_samples, dt, record, mean, best + (k - 1) * step));
  *frequency = best + 0.5 * step * (y[0] - y[2]) / (y[0] - 2.0 * y[1] + y[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
