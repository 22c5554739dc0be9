/* sph_ksp.c - the IISPH system as a PETSc shell matrix, solved by any KSP: -sph_ksp_type cg, minres, ... chooses it.

   Minimise E(y) = 1/2 y A y - b y over y >= 0 (scaled as in sph_pressure.c) by projected Newton steps [Bertsekas, SIAM J. Control Optim. 20
   (1982) 221; with a full step the primal-dual active set iteration, Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865]:
     held  = {y = 0 and g >= 0},  g = A y - b       pressure is zero and is not wanted
     A_ff d = -g_f                                   KSP on the rest; rows of held particles are those of the identity
     y = max(0, y + t d),  t = 1, 1/4, 1/16          the first that lowers E, else a projected gradient step
   Without a free surface nothing is held, and one KSP solve does it. The measure that ends the iteration is that of MPRGP: the mean of
   |projected g|/S over particles with pressure or wanting it. The KSP gains the factor -sph_ksp_rtol (0.1) at a time while the held set
   still changes, and all that is missing once it does not. PETSc's own solvers for bounds, TAO, are reached by -sph_tao_type. */
#include <math.h>
#include <petscksp.h>
#include <petsctao.h>

#include "sph_impl.h"

typedef struct {
  SPH                sph;
  const SPHOperator *op;      /* of the current solve                    */
  PetscInt           n;       /* unknowns that the objects are made for  */
  PetscBool          by_tao;
  Mat                A;       /* shell                                   */
  KSP                ksp;
  Tao                tao;
  Vec                d, g, y; /* step, -gradient, and y where TAO works  */
  PetscReal         *masked;  /* n, input of the operator                */
  char              *held;    /* n, 1: y = 0 and stays                   */
  PetscReal          rtol;
} Krylov;

/* what a gradient says about the solution it belongs to */
typedef struct {
  PetscReal residual; /* sum of |projected gradient| / S [kg/m^3]      */
  PetscReal count;    /* particles with pressure or wanting it         */
  PetscReal energy;   /* E                                             */
  PetscReal descent;  /* squared norm of the projected gradient        */
} State;

PetscErrorCode SPHWantsKSP_Internal(SPH sph, PetscBool *wanted)
{
  PetscBool ksp, tao;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(((PetscObject)sph)->options, "sph_", "-ksp_type", &ksp));
  PetscCall(PetscOptionsHasName(((PetscObject)sph)->options, "sph_", "-tao_type", &tao));
  *wanted = (PetscBool)(ksp || tao);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* out = A in on free particles, dt^2 in (the diagonal of A) on the others */
static PetscErrorCode MultFree(Mat A, Vec in, Vec out)
{
  Krylov *k;
  const PetscReal     *x;
  PetscReal           *y;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &k));
  const int       n   = (int)k->n;
  const PetscReal dt2 = k->op->dt * k->op->dt;
  PetscCall(VecGetArrayRead(in, &x));
  PetscCall(VecGetArrayWrite(out, &y));
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) k->masked[i] = k->held[i] ? 0.0 : x[i];
  PetscCall(SPHApply_Internal(k->sph, k->op, k->masked, y));
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++)
    if (k->held[i]) y[i] = dt2 * x[i];
  PetscCall(VecRestoreArrayWrite(out, &y));
  PetscCall(VecRestoreArrayRead(in, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* diag(S D D^T S) = 1 wherever a particle touches something */
static PetscErrorCode GetDiagonal(Mat A, Vec diagonal)
{
  Krylov *k;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &k));
  PetscCall(VecSet(diagonal, k->op->dt * k->op->dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TAO wants the gradient and E at a point of its own */
static PetscErrorCode FormGradient(Tao tao, Vec at, PetscReal *energy, Vec gradient, void *ctx)
{
  Krylov *k = (Krylov *)ctx;
  const PetscReal     *b = k->sph->rhs, *y;
  PetscReal           *g, sum = 0.0;

  PetscFunctionBegin;
  (void)tao;
  PetscCall(VecGetArrayRead(at, &y));
  PetscCall(VecGetArrayWrite(gradient, &g));
  PetscCall(SPHApply_Internal(k->sph, k->op, y, g));
  for (PetscInt i = 0; i < k->n; i++) {
    g[i] -= b[i];
    sum += 0.5 * y[i] * (g[i] - b[i]);
  }
  *energy = sum;
  PetscCall(VecRestoreArrayWrite(gradient, &g));
  PetscCall(VecRestoreArrayRead(at, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FormHessian(Tao tao, Vec at, Mat H, Mat P, void *ctx)
{
  PetscFunctionBegin;
  (void)tao;
  (void)at;
  (void)H;
  (void)P;
  (void)ctx;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the measure of every solver of the bounded problem, from y and the gradient */
static State Measure(SPH sph, const PetscReal y[], const PetscReal g[])
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n), bounded = sph->params.free_surface;
  PetscReal       sums[4];
  State           s;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal *out = sph->partial + c * SPH_SUMS;

    out[0] = out[1] = out[2] = out[3] = 0.0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal projected = bounded && !(y[i] > 0) ? PetscMin(g[i], 0.0) : g[i];

      out[0] += PetscAbsReal(projected) * sph->root[i];
      out[1] += sph->root[i] > 0 && (!bounded || y[i] > 0 || g[i] < 0) ? 1.0 : 0.0;
      out[2] += 0.5 * y[i] * (g[i] - sph->rhs[i]);
      out[3] += projected * projected;
    }
  }
  SPHSumPartials(sph, 4, sums);
  s.residual = sums[0];
  s.count    = sums[1];
  s.energy   = sums[2];
  s.descent  = sums[3];
  return s;
}

static PetscErrorCode TestTao(Tao tao, void *ctx)
{
  Krylov *k   = (Krylov *)ctx;
  SPH                  sph = k->sph;
  Vec                  at, gradient;
  const PetscReal     *y, *g;
  State                s;

  PetscFunctionBegin;
  PetscCall(TaoGetSolution(tao, &at));
  PetscCall(TaoGetGradient(tao, &gradient, NULL, NULL));
  PetscCall(VecGetArrayRead(at, &y));
  PetscCall(VecGetArrayRead(gradient, &g));
  s = Measure(sph, y, g);
  PetscCall(VecRestoreArrayRead(gradient, &g));
  PetscCall(VecRestoreArrayRead(at, &y));
  sph->converged = (PetscBool)(s.residual <= sph->params.tolerance * sph->params.density * s.count);
  if (sph->converged) PetscCall(TaoSetConvergedReason(tao, TAO_CONVERGED_USER));
  else PetscCall(TaoSetConvergedReason(tao, sph->iterations < sph->params.max_iterations ? TAO_CONTINUE_ITERATING : TAO_DIVERGED_MAXITS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHDestroyKSP_Internal(SPH sph)
{
  Krylov *k = (Krylov *)sph->method_data;

  PetscFunctionBegin;
  if (!k) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TaoDestroy(&k->tao));
  PetscCall(KSPDestroy(&k->ksp));
  PetscCall(MatDestroy(&k->A));
  PetscCall(VecDestroy(&k->d));
  PetscCall(VecDestroy(&k->g));
  PetscCall(VecDestroy(&k->y));
  PetscCall(PetscFree2(k->masked, k->held));
  PetscCall(PetscFree(sph->method_data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateTao(Krylov *k)
{
  Vec lower, upper;
  KSP ksp;
  PC  pc;

  PetscFunctionBegin;
  PetscCall(TaoCreate(PETSC_COMM_SELF, &k->tao));
  PetscCall(TaoSetOptionsPrefix(k->tao, "sph_"));
  PetscCall(TaoSetObjectiveAndGradient(k->tao, k->g, FormGradient, k));
  PetscCall(TaoSetHessian(k->tao, k->A, k->A, FormHessian, k));
  PetscCall(VecDuplicate(k->y, &lower));
  PetscCall(VecDuplicate(k->y, &upper));
  PetscCall(VecSet(lower, k->sph->params.free_surface ? 0.0 : PETSC_NINFINITY));
  PetscCall(VecSet(upper, PETSC_INFINITY));
  PetscCall(TaoSetVariableBounds(k->tao, lower, upper));
  PetscCall(VecDestroy(&lower));
  PetscCall(VecDestroy(&upper));
  PetscCall(TaoSetSolution(k->tao, k->y));
  PetscCall(TaoSetConvergenceTest(k->tao, TestTao, k));
  PetscCall(TaoSetFromOptions(k->tao));

  // the default preconditioner needs an assembled matrix
  PetscCall(TaoGetKSP(k->tao, &ksp));
  if (ksp) {
    PetscCall(KSPGetPC(ksp, &pc));
    PetscCall(PCSetType(pc, PCNONE));
    PetscCall(KSPSetFromOptions(ksp));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* objects for the number of particles there is now */
static PetscErrorCode Create(SPH sph)
{
  const PetscInt       n = sph->n;
  Krylov *k;
  PC                   pc;

  PetscFunctionBegin;
  k = (Krylov *)sph->method_data;
  if (k && k->n == n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SPHDestroyKSP_Internal(sph));
  PetscCall(PetscNew(&k));
  sph->method_data = k;
  k->sph           = sph;
  k->n             = n;
  PetscCall(PetscMalloc2(n, &k->masked, n, &k->held));
  PetscCall(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, k, &k->A));
  PetscCall(MatShellSetOperation(k->A, MATOP_MULT, (void (*)(void))MultFree));
  PetscCall(MatShellSetOperation(k->A, MATOP_GET_DIAGONAL, (void (*)(void))GetDiagonal));
  PetscCall(MatSetOption(k->A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatCreateVecs(k->A, &k->d, &k->g));
  PetscCall(VecDuplicate(k->d, &k->y));
  PetscCall(PetscOptionsHasName(((PetscObject)sph)->options, "sph_", "-tao_type", &k->by_tao));
  if (k->by_tao) {
    PetscCall(CreateTao(k));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(KSPCreate(PETSC_COMM_SELF, &k->ksp));
  PetscCall(KSPSetOptionsPrefix(k->ksp, "sph_"));
  PetscCall(KSPSetOperators(k->ksp, k->A, k->A));
  PetscCall(KSPGetPC(k->ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(KSPSetTolerances(k->ksp, 0.1, 0.0, 1e10, PETSC_DEFAULT));
  PetscCall(KSPSetFromOptions(k->ksp));
  PetscCall(KSPGetTolerances(k->ksp, &k->rtol, NULL, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveByTao(SPH sph)
{
  Krylov *k = (Krylov *)sph->method_data;
  PetscReal           *y;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(k->held, k->n));
  PetscCall(VecGetArrayWrite(k->y, &y));
  PetscCall(PetscArraycpy(y, sph->y, k->n));
  PetscCall(VecRestoreArrayWrite(k->y, &y));
  PetscCall(TaoSolve(k->tao));
  PetscCall(VecGetArray(k->y, &y));
  PetscCall(PetscArraycpy(sph->y, y, k->n));
  PetscCall(VecRestoreArray(k->y, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* residual[] = A y - b and what it says */
static PetscErrorCode Gradient(SPH sph, const SPHOperator *op, State *s)
{
  const int n = (int)sph->n;

  PetscFunctionBegin;
  PetscCall(SPHApply_Internal(sph, op, sph->y, sph->residual));
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->residual[i] -= sph->rhs[i];
  *s = Measure(sph, sph->y, sph->residual);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the held set from y and its gradient; returns how many changed */
static int Hold(SPH sph)
{
  Krylov *k = (Krylov *)sph->method_data;
  const int            n = (int)sph->n, bounded = sph->params.free_surface;
  int                  changed = 0;

#pragma omp parallel for schedule(static) reduction(+ : changed)
  for (int i = 0; i < n; i++) {
    const char held = sph->root[i] == 0.0 || (bounded && !(sph->y[i] > 0) && sph->residual[i] >= 0);
    changed += held != k->held[i];
    k->held[i] = held;
  }
  return changed;
}

/* d of A_ff d = -g_f into direction[] */
static PetscErrorCode FindStep(SPH sph, PetscReal factor)
{
  Krylov *k = (Krylov *)sph->method_data;
  const PetscReal     *d;
  PetscReal           *g;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(k->g, &g));
  for (PetscInt i = 0; i < k->n; i++) g[i] = k->held[i] ? 0.0 : -sph->residual[i];
  PetscCall(VecRestoreArrayWrite(k->g, &g));
  PetscCall(KSPSetTolerances(k->ksp, factor, 0.0, 1e10, (int)PetscMax(1, sph->params.max_iterations - sph->iterations)));
  PetscCall(KSPSolve(k->ksp, k->g, k->d));
  PetscCall(VecGetArrayRead(k->d, &d));
  PetscCall(PetscArraycpy(sph->direction, d, k->n));
  PetscCall(VecRestoreArrayRead(k->d, &d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = max(0, from + t d) */
static void Step(SPH sph, const PetscReal from[], PetscReal t, const PetscReal d[])
{
  const int n = (int)sph->n, bounded = sph->params.free_surface;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    const PetscReal y = from[i] + t * d[i];
    sph->y[i]         = bounded && y < 0 ? 0.0 : y;
  }
}

/* along direction[] to a point of lower energy, else along the gradient; `s` is of the point where it starts, then of that where it ends */
static PetscErrorCode Descend(SPH sph, const SPHOperator *op, State *s)
{
  const PetscReal slack = 1e-7, before = s->energy + slack * PetscAbsReal(s->energy); // single precision knows E no better
  const int       n    = (int)sph->n;
  PetscReal      *from = sph->Adirection, *old = sph->p_tilde;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(from, sph->y, n));
  for (PetscReal t = 1.0; t > 0.05; t *= 0.25) {
    Step(sph, from, t, sph->direction);
    PetscCall(Gradient(sph, op, s));
    if (s->energy <= before || !sph->params.free_surface) PetscFunctionReturn(PETSC_SUCCESS);
  }
  // 1/|A| along the gradient where the step began lowers E for certain
  Step(sph, from, 0.0, sph->direction);
  PetscCall(Gradient(sph, op, s));
  PetscCall(PetscArraycpy(old, sph->residual, n));
  Step(sph, from, -1.0 / (sph->norm * op->dt * op->dt), old);
  PetscCall(Gradient(sph, op, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  SPHSolveKSP_Internal - the bounded (free surface) or the plain problem by a KSP of the user's choice, or by TAO

  Options Database Keys:
+ -sph_ksp_type <type>  - cg, minres, cr, fcg, ...; its presence chooses this solver. -sph_pc_type: none or jacobi, the matrix is a shell
. -sph_ksp_rtol <0.1>   - factor that a KSP solve gains while the set of particles without pressure changes
- -sph_tao_type <type>  - gpcg (with -sph_tao_subset_type matrixfree), bqpip, blmvm, bncg, ... instead

  Tests: tests/unit/sph/test_ksp.c
*/
PetscErrorCode SPHSolveKSP_Internal(SPH sph, const SPHOperator *op)
{
  const PetscReal tolerance = sph->params.tolerance * sph->params.density;
  PetscBool       settled   = PETSC_FALSE;
  Krylov         *k;
  State           s;

  PetscFunctionBegin;
  PetscCall(Create(sph));
  k              = (Krylov *)sph->method_data;
  k->op          = op;
  sph->converged = PETSC_FALSE;
  if (k->by_tao) {
    PetscCall(SolveByTao(sph));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Gradient(sph, op, &s));
  for (;;) {
    const PetscReal missing = 0.7 * tolerance * s.count / s.residual;

    if (!(s.residual > tolerance * s.count)) {
      sph->converged = (PetscBool)isfinite(s.residual);
      break;
    }
    if (sph->iterations >= sph->params.max_iterations) break;
    settled = (PetscBool)(Hold(sph) == 0 || !sph->params.free_surface);
    PetscCall(FindStep(sph, settled ? missing : PetscMax(missing, k->rtol)));
    PetscCall(Descend(sph, op, &s));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
