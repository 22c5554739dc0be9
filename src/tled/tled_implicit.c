/* tled_implicit.c - the life of a TLEDImplicit, its residual and tangent for SNES, and the solvers it chooses. */
#include "tled/tled_implicit_impl.h"

#define ROUND_OFF 1e-6 /* times tolerance times stiffness times displacement: what is left of a force by round-off, added to the scale */
#define STALLED   1e-7 /* residual over forces at which a Newton step of the size of round-off is the end */

#define GROWTH    10.0 /* of the residual after the first Newton step at which it is given up */
#define CUTS      8    /* halvings of a Newton step that inverts an element */

#define ROW(key, type, unit, def, lo, hi, flags, help) \
  { \
    #key, type, offsetof(TLEDImplicitParams, key), unit, def, lo, hi, flags, NULL, help \
  }

const Key TLEDImplicitKeys[] = {
    ROW(tolerance, KEY_REAL, "1", "1e-10", 0, 1, KEY_LO_OPEN | KEY_HI_OPEN, "residual over the forces that make it up, at which Newton's method ends"),
    ROW(load_step, KEY_REAL, "1", "1", 0, 1, KEY_LO_OPEN, "first part of the load that is tried at once"),
    ROW(load_step_min, KEY_REAL, "1", "1e-4", 0, 1, KEY_LO_OPEN, "smallest part of the load before a static solve is given up"),
    ROW(rho_infinity, KEY_REAL, "1", "0.9", 0, 1, 0, "generalised-alpha: part of the highest frequencies' amplitude kept a step"),
    ROW(direct_below, KEY_INT, "1", "20000", 0, 1e9, 0, "unknowns below which linear systems are solved directly"),
    KEY_END};

/*@
  TLEDImplicitCreate - an implicit solver for a body

  Collective

  Input Parameters:
+ comm - ranks that share the work; each has the same body
- tled - set up; it must outlive the solver

  Output Parameter:
. implicit - TLEDImplicitDestroy() frees it

.seealso: TLEDImplicitSolveStatic(), TLEDImplicitAdvance()
@*/
PetscErrorCode TLEDImplicitCreate(MPI_Comm comm, TLED tled, TLEDImplicit *implicit)
{
  TLEDImplicit   im;
  const PetscInt n = 3 * tled->mesh.n_nodes;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, comm, PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDImplicitCreate()");
  PetscCall(PetscNew(&im));
  im->comm         = comm;
  im->tled         = tled;
  im->problem.load = 1.0;
  PetscCall(KeysSetDefaults(TLEDImplicitKeys, &im->params));
  PetscCall(PetscSNPrintf(im->prefix, sizeof im->prefix, "%s_implicit_", ((PetscObject)tled)->name));
  PetscCall(PetscCalloc6(n, &im->y, n, &im->f_int, n, &im->f_ext, n, &im->residual, n, &im->v, n, &im->a));
  PetscCall(PetscCalloc5(n, &im->start, n, &im->trial, n, &im->inner, n, &im->outer, 3 * n, &im->last[0]));
  im->last[1] = im->last[0] + n, im->last[2] = im->last[1] + n;
  PetscCall(PetscCalloc4(n, &im->problem.constant, n, &im->problem.held_at, n, &im->problem.u0, n, &im->problem.rate));
  *implicit = im;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDImplicitGetParams - the parameters, to be read or, before the first solve, changed @*/
PetscErrorCode TLEDImplicitGetParams(TLEDImplicit im, TLEDImplicitParams **params)
{
  PetscFunctionBegin;
  *params = &im->params;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDImplicitSetFromOptions - parameters from the options database, -<body>_implicit_<key> @*/
PetscErrorCode TLEDImplicitSetFromOptions(TLEDImplicit im)
{
  PetscFunctionBegin;
  ByCall(KeysSetFromOptions(TLEDImplicitKeys, im->prefix, &im->params));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDImplicitGetStats - what the last solve took @*/
PetscErrorCode TLEDImplicitGetStats(TLEDImplicit im, TLEDImplicitStats *stats)
{
  PetscFunctionBegin;
  *stats = im->stats;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDImplicitGetSNES - PETSc's nonlinear solver, borrowed, to be set before the first solve @*/
PetscErrorCode TLEDImplicitGetSNES(TLEDImplicit im, SNES *snes)
{
  PetscFunctionBegin;
  PetscCall(TLEDImplicitSetUp_Private(im));
  *snes = im->snes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDImplicitView - the parameters, and the solvers once there are any @*/
PetscErrorCode TLEDImplicitView(TLEDImplicit im, PetscViewer viewer)
{
  PetscFunctionBegin;
  if (!viewer) PetscCall(PetscViewerASCIIGetStdout(im->comm, &viewer));
  PetscCall(KeysView(TLEDImplicitKeys, &im->params, viewer));
  if (im->snes) PetscCall(SNESView(im->snes, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDImplicitDestroy - free it; NULL is fine @*/
PetscErrorCode TLEDImplicitDestroy(TLEDImplicit *implicit)
{
  TLEDImplicit im = implicit ? *implicit : NULL;

  PetscFunctionBegin;
  if (!im) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESDestroy(&im->snes));
  PetscCall(VecDestroy(&im->x));
  PetscCall(VecDestroy(&im->r));
  PetscCall(VecDestroy(&im->everywhere));
  PetscCall(VecScatterDestroy(&im->scatter));
  PetscCall(MatDestroy(&im->K));
  PetscCall(MatDestroy(&im->P));
  PetscCall(TLEDAssemblyDestroy_Private(&im->assembly));
  PetscCall(PetscFree6(im->y, im->f_int, im->f_ext, im->residual, im->v, im->a));
  PetscCall(PetscFree5(im->start, im->trial, im->inner, im->outer, im->last[0]));
  PetscCall(PetscFree4(im->problem.constant, im->problem.held_at, im->problem.u0, im->problem.rate));
  PetscCall(PetscFree(*implicit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal TLEDImplicitNorm_Private(PetscInt n, const PetscReal x[])
{
  PetscReal sum = 0.0;

  for (PetscInt k = 0; k < n; k++) sum += x[k] * x[k];
  return PetscSqrtReal(sum);
}

/* y = P x for one node */
static void ProjectNode(const PetscReal P[9], const PetscReal x[3], PetscReal y[3])
{
  for (PetscInt i = 0; i < 3; i++) y[i] = P[3 * i] * x[0] + P[3 * i + 1] * x[1] + P[3 * i + 2] * x[2];
}

/* internal forces at y, of a step of the problem's time over which stresses relax; BY_ERR_BREAKDOWN, not reported, when an element is
   inverted */
PetscErrorCode TLEDImplicitForces_Private(TLEDImplicit im, const PetscReal y[], PetscReal f[])
{
  PetscFunctionBegin;
  TLEDSetViscous_Private(im->tled, TLED_VISCOUS_STEP, im->problem.history);
  ByCall(TLEDForces_Private(im->tled, y, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* displacement at which forces are taken, in im->y; with_rate adds that of stiffness damping */
static void TakenAt(TLEDImplicit im, const PetscReal x[], PetscBool with_rate)
{
  const TLEDImplicitProblem *q = &im->problem;

  for (PetscInt k = 0; k < 3 * im->tled->mesh.n_nodes; k++) {
    im->y[k] = q->share * x[k] + (1.0 - q->share) * q->u0[k];
    if (with_rate) im->y[k] += q->viscous * (x[k] - q->u0[k]) + q->rate[k];
  }
}

/* Residual of the problem at x, all nodes; also the scale that it is measured with. BY_ERR_BREAKDOWN, not reported, when an element
   is inverted. */
PetscErrorCode TLEDImplicitResidual_Private(TLEDImplicit im, const PetscReal x[], PetscReal r[])
{
  const TLEDImplicitProblem *q = &im->problem;
  const PetscInt             n = 3 * im->tled->mesh.n_nodes;
  PetscReal                  inertia = 0.0;

  PetscFunctionBegin;
  TakenAt(im, x, PETSC_FALSE);
  PetscCall(TLEDExternalForces_Private(im->tled, q->time, im->y, im->f_ext));
  if (q->viscous > 0.0) TakenAt(im, x, PETSC_TRUE);
  ByCall(TLEDImplicitForces_Private(im, im->y, im->f_int));
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal m = q->inertia * im->tled->mass[k / 3] * (x[k] - q->u0[k]) + q->constant[k];
    im->f_ext[k] *= q->load;
    r[k] = im->f_int[k] - im->f_ext[k] + m;
    inertia += m * m;
  }
  im->scale = TLEDImplicitNorm_Private(n, im->f_int) + TLEDImplicitNorm_Private(n, im->f_ext) + PetscSqrtReal(inertia) + ROUND_OFF * im->held * TLEDImplicitNorm_Private(n, x);
  for (PetscInt a = 0; a < im->tled->mesh.n_nodes; a++) {
    const PetscReal *P = TLEDConstraintProjector_Private(im->tled, a);
    PetscReal        d[3], free_d[3], free_r[3];
    if (!P) continue;
    for (PetscInt i = 0; i < 3; i++) d[i] = x[3 * a + i] - q->held_at[3 * a + i];
    ProjectNode(P, d, free_d);
    ProjectNode(P, &r[3 * a], free_r);
    for (PetscInt i = 0; i < 3; i++) r[3 * a + i] = free_r[i] + im->held * (d[i] - free_d[i]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the distributed x on every rank */
static PetscErrorCode Everywhere(TLEDImplicit im, Vec x)
{
  PetscFunctionBegin;
  PetscCall(VecScatterBegin(im->scatter, x, im->everywhere, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(im->scatter, x, im->everywhere, INSERT_VALUES, SCATTER_FORWARD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* this rank's part of values that every rank has */
static PetscErrorCode OwnPart(TLEDImplicit im, const PetscReal values[], Vec x)
{
  PetscReal *own;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(x, &own));
  PetscCall(PetscArraycpy(own, &values[3 * im->assembly->first], 3 * (im->assembly->last - im->assembly->first)));
  PetscCall(VecRestoreArrayWrite(x, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SNES's function; outside its domain, with an inverted element, it is infinite and the line search cuts its step */
static PetscErrorCode FormFunction(SNES snes, Vec x, Vec r, void *ctx)
{
  TLEDImplicit     im = (TLEDImplicit)ctx;
  const PetscReal *all;
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  (void)snes;
  PetscCall(Everywhere(im, x));
  PetscCall(VecGetArrayRead(im->everywhere, &all));
  ierr = TLEDImplicitResidual_Private(im, all, im->residual);
  PetscCall(VecRestoreArrayRead(im->everywhere, &all));
  if (ierr == BY_ERR_BREAKDOWN) {
    PetscCall(VecSet(r, PETSC_INFINITY));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ierr);
  PetscCall(OwnPart(im, im->residual, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TLEDAddBlock of the loads that follow the surface */
static PetscErrorCode AddExternal(void *ctx, PetscInt a, PetscInt b, const PetscReal K[9])
{
  TLEDImplicit im = (TLEDImplicit)ctx;

  PetscFunctionBegin;
  if (a != b) im->follows = PETSC_TRUE;
  TLEDAssemblyAdd_Private(im->assembly, a, b, im->problem.share * im->problem.load, K);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Loads that follow the surface have no potential in general: solvers for symmetric matrices are changed for others. */
static PetscErrorCode AllowUnsymmetric(TLEDImplicit im)
{
  KSP       ksp;
  PC        pc;
  PetscBool cg, cholesky;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(im->snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPCG, &cg));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCCHOLESKY, &cholesky));
  if (cg) PetscCall(KSPSetType(ksp, KSPGMRES));
  if (cholesky) {
    PetscCall(PCSetType(pc, PCLU));
#if PetscDefined(HAVE_MUMPS)
    PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
#endif
  }
  PetscCall(MatSetOption(im->K, MAT_SYMMETRIC, PETSC_FALSE));
  if (im->P) PetscCall(MatSetOption(im->P, MAT_SYMMETRIC, PETSC_FALSE));
  im->unsymmetric = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* tangent of the residual, forces taken at `at`, into the assembly's blocks */
static PetscErrorCode FillTangent(TLEDImplicit im, const PetscReal x[], TLEDTangentKind kind)
{
  const TLEDImplicitProblem *q = &im->problem;

  PetscFunctionBegin;
  TakenAt(im, x, q->viscous > 0.0 ? PETSC_TRUE : PETSC_FALSE);
  ByCall(TLEDAssemblyFill_Private(im->tled, im->y, kind, im->assembly));
  if (q->share + q->viscous != 1.0) TLEDAssemblyScale_Private(im->assembly, q->share + q->viscous);
  TakenAt(im, x, PETSC_FALSE);
  PetscCall(TLEDExternalTangent_Private(im->tled, q->time, im->y, AddExternal, im));
  if (q->inertia > 0.0) TLEDAssemblyAddMass_Private(im->tled, q->inertia, im->assembly);
  TLEDAssemblyProject_Private(im->tled, im->held, im->assembly);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* tangent at the displacement x that every rank has, into im->K, and into im->P what multigrid is made of: that of the direct neighbours,
   which for anp is not K */
static PetscErrorCode AssembleTangent(TLEDImplicit im, const PetscReal x[])
{
  PetscFunctionBegin;
  if (im->by_factors) {
    ByCall(FillTangent(im, x, TLED_TANGENT_RESPONSE));
    PetscCall(TLEDAssemblyMatrix_Private(im->assembly, &im->P));
  }
  ByCall(FillTangent(im, x, TLED_TANGENT_EXACT));
  if (im->by_factors) PetscCall(TLEDAssemblyOperator_Private(im->assembly, &im->K));
  else PetscCall(TLEDAssemblyMatrix_Private(im->assembly, &im->K));
  if (im->follows && im->snes && !im->unsymmetric) PetscCall(AllowUnsymmetric(im));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FormTangent(SNES snes, Vec x, Mat A, Mat P, void *ctx)
{
  TLEDImplicit     im = (TLEDImplicit)ctx;
  const PetscReal *all;
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  (void)A;
  (void)P;
  PetscCall(Everywhere(im, x));
  PetscCall(VecGetArrayRead(im->everywhere, &all));
  ierr = AssembleTangent(im, all);
  PetscCall(VecRestoreArrayRead(im->everywhere, &all));
  if (ierr == BY_ERR_BREAKDOWN) PetscCall(SNESSetJacobianDomainError(snes));
  else PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is Newton's method lost? The first full step of a body that bends makes the residual larger, those after it must not, and four of
   them must halve it (measured: where they do not, thirty do not converge either). */
static PetscBool Lost(TLEDImplicit im, PetscInt it, PetscReal f)
{
  PetscReal *past = im->past;
  PetscBool  lost = PETSC_FALSE;

  if (it >= 2 && f > GROWTH * PetscMax(past[0], past[1])) lost = PETSC_TRUE;
  if (it >= 6 && f > 0.5 * past[2 + it % PAST]) lost = PETSC_TRUE;
  if (it < 2) past[it] = f;
  past[2 + it % PAST] = f;
  return lost;
}

/* the end of Newton's method: residual over the forces that make it up, nothing left to gain, or no hope */
static PetscErrorCode TestConvergence(SNES snes, PetscInt it, PetscReal x, PetscReal step, PetscReal f, SNESConvergedReason *reason,
                                      void *ctx)
{
  TLEDImplicit im = (TLEDImplicit)ctx;
  PetscReal    rtol;

  PetscFunctionBegin;
  PetscCall(SNESGetTolerances(snes, NULL, &rtol, NULL, NULL, NULL));
  *reason            = SNES_CONVERGED_ITERATING;
  im->stats.residual = im->scale > 0.0 ? f / im->scale : 0.0;
  if (PetscIsInfOrNanReal(f)) *reason = SNES_DIVERGED_FNORM_NAN;
  else if (f <= rtol * im->scale) *reason = SNES_CONVERGED_FNORM_RELATIVE;
  else if (it && f <= STALLED * im->scale && step <= 1e-14 * x) *reason = SNES_CONVERGED_SNORM_RELATIVE;
  else if (Lost(im, it, f)) *reason = SNES_DIVERGED_DTOL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Newton's full step, halved while it turns an element inside out. A residual that grows is no reason to go less far: a slender body
   that bends is stretched first, and a search for the smallest residual creeps (measured on the cantilevers of test_static.c: 6 to 15
   iterations against 19 to 60 and more with PETSc's bt, cp, l2, nleqerr). */
static PetscErrorCode FullStep(SNESLineSearch search, void *ctx)
{
  SNES      snes;
  Vec       x, f, y, w, g;
  PetscReal lambda = 1.0, x_norm, y_norm, f_norm;

  PetscFunctionBegin;
  (void)ctx;
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  PetscCall(SNESLineSearchGetVecs(search, &x, &f, &y, &w, &g));
  for (PetscInt cut = 0; cut <= CUTS; cut++, lambda *= 0.5) {
    PetscCall(VecWAXPY(w, -lambda, y, x));
    PetscCall(SNESComputeFunction(snes, w, f));
    PetscCall(VecNorm(f, NORM_2, &f_norm));
    if (!PetscIsInfOrNanReal(f_norm)) break;
  }
  PetscCall(VecNorm(y, NORM_2, &y_norm));
  PetscCall(VecCopy(w, x));
  PetscCall(VecNorm(x, NORM_2, &x_norm));
  PetscCall(SNESLineSearchSetNorms(search, x_norm, f_norm, lambda * y_norm));
  PetscCall(SNESLineSearchSetReason(search, PetscIsInfOrNanReal(f_norm) ? SNES_LINESEARCH_FAILED_NANORINF : SNES_LINESEARCH_SUCCEEDED));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rigid motions are what multigrid must know of elasticity */
static PetscErrorCode SetNearNullSpace(TLEDImplicit im)
{
  MatNullSpace rigid;
  Vec          X;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(im->x, &X));
  PetscCall(OwnPart(im, im->tled->mesh.X, X));
  PetscCall(MatNullSpaceCreateRigidBody(X, &rigid));
  PetscCall(MatSetNearNullSpace(im->P ? im->P : im->K, rigid));
  PetscCall(MatNullSpaceDestroy(&rigid));
  PetscCall(VecDestroy(&X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multigrid's own options where the user gives none. Its estimate of a smoother's largest eigenvalue by GMRES is too small for nearly
   incompressible bodies, and the cycle loses its sign; by conjugate gradients it holds. Levels of less than some hundred unknowns have
   aggregates with fewer nodes than rigid motions, on which smoothing fails: they are solved directly. */
static PetscErrorCode DefaultMultigrid(TLEDImplicit im)
{
  static const char *const option[][2] = {{"pc_gamg_esteig_ksp_type", "cg"}, {"mg_levels_pc_type", "sor"}, {"pc_gamg_coarse_eq_limit", "1000"}};

  PetscFunctionBegin;
  for (size_t i = 0; i < sizeof option / sizeof *option; i++) {
    char      name[BY_NAME_MAX + 64];
    PetscBool given;
    PetscCall(PetscSNPrintf(name, sizeof name, "-%s%s", im->prefix, option[i][0]));
    PetscCall(PetscOptionsHasName(NULL, NULL, name, &given));
    if (!given) PetscCall(PetscOptionsSetValue(NULL, name, option[i][1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* solvers for this size, which the options may change */
static PetscErrorCode ChooseSolvers(TLEDImplicit im)
{
  SNESLineSearch search;
  KSP            ksp;
  PC             pc;

  PetscFunctionBegin;
  PetscCall(SNESSetType(im->snes, SNESNEWTONLS));
  PetscCall(SNESGetLineSearch(im->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHSHELL));
  PetscCall(SNESLineSearchShellSetUserFunc(search, FullStep, NULL));
  PetscCall(SNESSetTolerances(im->snes, 0.0, im->params.tolerance, 0.0, 30, PETSC_MAX_INT));
  PetscCall(SNESGetKSP(im->snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  if (3 * im->tled->mesh.n_nodes < im->params.direct_below) {
    PetscCall(KSPSetType(ksp, KSPPREONLY));
#if PetscDefined(HAVE_MUMPS)
    PetscCall(PCSetType(pc, PCCHOLESKY)); /* MUMPS factors indefinite matrices too, in half the time of LU */
    PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
#else
    PetscCall(PCSetType(pc, PCLU));
#endif
  } else {
    PetscCall(KSPSetType(ksp, KSPCG));
    PetscCall(KSPSetTolerances(ksp, 1e-8, 0.0, PETSC_DEFAULT, 1000));
    PetscCall(PCSetType(pc, PCGAMG));
    PetscCall(DefaultMultigrid(im));
  }
  PetscCall(SNESSetFromOptions(im->snes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* everything that the first solve needs; the matrix at the undeformed body gives pattern and size of its numbers */
PetscErrorCode TLEDImplicitSetUp_Private(TLEDImplicit im)
{
  const PetscInt n_nodes = im->tled->mesh.n_nodes;
  PetscReal      sum[2]  = {0.0, 0.0};

  PetscFunctionBegin;
  if (im->snes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TLEDAssemblyCreate_Private(im->comm, im->tled, &im->assembly));
  PetscCall(PetscArrayzero(im->y, 3 * n_nodes));
  PetscCall(TLEDAssemblyFill_Private(im->tled, im->y, TLED_TANGENT_RESPONSE, im->assembly));
  sum[0] = TLEDAssemblyTrace_Private(im->assembly);
  sum[1] = 3.0 * (PetscReal)(im->assembly->last - im->assembly->first);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, im->comm));
  im->held = sum[0] / sum[1];
  im->problem.share = 1.0;
  im->by_factors    = im->tled->loops.anp && 3 * n_nodes >= im->params.direct_below ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(AssembleTangent(im, im->problem.u0));
  PetscCall(MatSetOption(im->K, MAT_SYMMETRIC, PETSC_TRUE));
  if (im->P) PetscCall(MatSetOption(im->P, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatCreateVecs(im->P ? im->P : im->K, &im->x, &im->r));
  PetscCall(VecSetBlockSize(im->x, 3));
  PetscCall(VecScatterCreateToAll(im->x, &im->scatter, &im->everywhere));
  PetscCall(SetNearNullSpace(im));
  PetscCall(SNESCreate(im->comm, &im->snes));
  PetscCall(SNESSetOptionsPrefix(im->snes, im->prefix));
  PetscCall(SNESSetFunction(im->snes, im->r, FormFunction, im));
  PetscCall(SNESSetJacobian(im->snes, im->K, im->P ? im->P : im->K, FormTangent, im));
  PetscCall(SNESSetConvergenceTest(im->snes, TestConvergence, im, NULL));
  PetscCall(ChooseSolvers(im));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A factorisation that failed must not be used again: the next solve begins with a new one. */
static PetscErrorCode ForgetFactors(KSP ksp)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCReset(pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDImplicitNewton_Private - solve the problem

  Input/Output Parameter:
. x - first guess, then the solution, all nodes, the same on every rank

  Output Parameter:
. converged - false leaves x without meaning; also when a node went so far that it could have passed an obstacle's surface

  When the linear solver for positive matrices fails, GMRES is tried from the same guess.
*/
PetscErrorCode TLEDImplicitNewton_Private(TLEDImplicit im, PetscReal x[], PetscBool *converged)
{
  const PetscReal    *all;
  SNESConvergedReason reason;
  KSP                 ksp;
  PetscBool           cg;
  PetscInt            n;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(im->snes, &ksp));
  for (PetscInt attempt = 0; attempt < 2; attempt++) {
    PetscCall(OwnPart(im, x, im->x));
    PetscCall(SNESSolve(im->snes, NULL, im->x));
    PetscCall(SNESGetConvergedReason(im->snes, &reason));
    PetscCall(SNESGetIterationNumber(im->snes, &n));
    im->stats.newton += n;
    PetscCall(SNESGetLinearSolveIterations(im->snes, &n));
    im->stats.linear += n;
    if (reason == SNES_DIVERGED_LINEAR_SOLVE) PetscCall(ForgetFactors(ksp));
    PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPCG, &cg));
    if (reason != SNES_DIVERGED_LINEAR_SOLVE || !cg) break;
    PetscCall(KSPSetType(ksp, KSPGMRES));
    PetscCall(KSPGMRESSetRestart(ksp, 200));
  }
  *converged = reason > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (*converged) {
    PetscCall(Everywhere(im, im->x));
    PetscCall(VecGetArrayRead(im->everywhere, &all));
    PetscCall(PetscArraycpy(x, all, 3 * im->tled->mesh.n_nodes));
    PetscCall(VecRestoreArrayRead(im->everywhere, &all));
    *converged = TLEDContactKeepsSides_Private(im->tled, im->problem.u0, x);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dx = K^-1 rhs with the tangent at the displacement x of the problem, the same on every rank; constrained directions of rhs must be zero */
PetscErrorCode TLEDImplicitLinear_Private(TLEDImplicit im, const PetscReal x[], const PetscReal rhs[], PetscReal dx[], PetscBool *solved)
{
  const PetscReal   *all;
  KSP                ksp;
  KSPConvergedReason reason;

  PetscFunctionBegin;
  ByCall(AssembleTangent(im, x));
  PetscCall(SNESGetKSP(im->snes, &ksp));
  PetscCall(KSPSetOperators(ksp, im->K, im->P ? im->P : im->K));
  PetscCall(OwnPart(im, rhs, im->r));
  PetscCall(KSPSolve(ksp, im->r, im->x));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  *solved = reason > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*solved) PetscCall(ForgetFactors(ksp));
  PetscCall(Everywhere(im, im->x));
  PetscCall(VecGetArrayRead(im->everywhere, &all));
  PetscCall(PetscArraycpy(dx, all, 3 * im->tled->mesh.n_nodes));
  PetscCall(VecRestoreArrayRead(im->everywhere, &all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* make (u, v) at `time` the state of the body; v NULL: a static one */
PetscErrorCode TLEDImplicitFinish_Private(TLEDImplicit im, const PetscReal u[], const PetscReal v[], PetscReal time)
{
  const TLED     tled = im->tled;
  const PetscInt n    = 3 * tled->mesh.n_nodes;
  PetscReal     *to;
  PetscErrorCode ierr = PETSC_SUCCESS;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(tled->u, &to));
  PetscCall(PetscArraycpy(to, u, n));
  PetscCall(VecRestoreArrayWrite(tled->u, &to));
  PetscCall(VecGetArrayWrite(tled->v, &to));
  if (v) PetscCall(PetscArraycpy(to, v, n));
  else PetscCall(PetscArrayzero(to, n));
  PetscCall(VecRestoreArrayWrite(tled->v, &to));
  TLEDSetViscous_Private(tled, TLED_VISCOUS_STEP, 0.0);
  if (!v) ierr = TLEDCommitViscous_Private(tled, u, PETSC_MAX_REAL); /* a state that broke was reported before */
  if (ierr != BY_ERR_BREAKDOWN) PetscCall(ierr);
  tled->state.time     = time;
  tled->state.critical = 0.0; /* the body may have deformed much */
  tled->state.is_static = v ? 0.0 : 1.0;
  tled->force_valid    = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
