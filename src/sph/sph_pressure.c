/* sph_pressure.c - the pressure that keeps the fluid at rest density (method 1.1): what the solvers share, right-hand side and operator,
   and the choice among them.

   One unknown a particle, p~ = p/rho0^2. With D the density rate of a velocity and a = -D^T p~ the pressure acceleration
     A = dt^2 D D^T (+ the response of compliant walls, method 5.3)
     b = min(1, dt/tau) max(rho - rho0, excess of a wall) + dt (D v* - wall's own motion)
     p~ >= 0,  A p~ >= b,  equality where p~ > 0
   A is symmetric and positive semidefinite. Solvers work on y = p~/S, S = diag(D D^T)^(-1/2), which keeps the bound. */
#include <math.h>

#include "sph_impl.h"

/* out = S (dt^2 D D^T + response) S y */
PetscErrorCode SPHApply_Internal(SPH sph, const SPHOperator *op, const PetscReal y[], PetscReal out[])
{
  const SPHLoopTable *table = sph->table;
  const int           n     = (int)sph->n;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SPH_Apply, sph, 0, 0, 0));
  table->SetPressure(&sph->loops, y, sph->scale);
  if (op->compact) {
    table->Laplacian(&sph->loops, 2.0 * sph->params.density * op->dt * op->dt, sph->scale, out);
  } else {
    table->Acceleration(&sph->loops);
    table->Rate(&sph->loops, -op->dt * op->dt, sph->scale, out);
  }
  if (op->response) {
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++) {
      sph->p_tilde[i]  = sph->scale[i] * y[i];
      sph->response[i] = 0.0;
    }
    PetscCall(op->response(op->ctx, sph->n, sph->p_tilde, sph->response));
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++) out[i] += sph->scale[i] * sph->response[i];
  }
  sph->iterations++;
  PetscCall(PetscLogEventEnd(SPH_Apply, sph, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* S from the diagonal, b scaled, y from the last pressure times `warm` */
void SPHPrepare_Internal(SPH sph, PetscReal dt, PetscReal warm)
{
  const int       n     = (int)sph->n;
  const PetscReal rho0  = sph->params.density, to_tilde = warm / (rho0 * rho0);
  const PetscReal tau   = sph->relax_time < 0 ? 10.0 * dt : sph->relax_time, relax = tau > dt ? dt / tau : 1.0;
  const PetscReal tiny  = 1e-8 * rho0 * rho0 / (sph->h * sph->h); // a diagonal of a full neighbourhood is near rho0^2/h^2

  sph->table->Diagonal(&sph->loops, sph->root);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    // a particle that touches nothing has no pressure
    const PetscBool known = (PetscBool)(sph->kind && sph->kind[i] != SPH_FREE); // no unknown where velocity or pressure is prescribed
    const PetscReal root = sph->root[i] > tiny && !known ? sqrt(sph->root[i]) : 0.0, S = root > 0 ? 1.0 / root : 0.0;
    const PetscReal excess = sph->rho[i] - rho0;
    const PetscReal b      = SPHSourceShare(excess / rho0, relax) * excess + dt * (sph->rate[i] - sph->wall_rate[i]);

    sph->root[i]  = root;
    sph->scale[i] = S;
    sph->rhs[i]   = S * b;
    sph->y[i]     = S > 0 ? to_tilde * sph->p[i] / S : 0.0;
    if (sph->params.free_surface && sph->y[i] < 0) sph->y[i] = 0.0;
  }
}

/* p = rho0^2 S y */
void SPHStorePressure_Internal(SPH sph)
{
  const int       n          = (int)sph->n;
  const PetscReal from_tilde = sph->params.density * sph->params.density;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->p[i] = from_tilde * sph->scale[i] * sph->y[i];
}

void SPHPressureAcceleration_Internal(SPH sph)
{
  const int       n        = (int)sph->n;
  const PetscReal to_tilde = 1.0 / (sph->params.density * sph->params.density);

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->p_tilde[i] = to_tilde * sph->p[i];
  sph->table->SetPressure(&sph->loops, sph->p_tilde, NULL);
  sph->table->Acceleration(&sph->loops);
  sph->table->GetVector(&sph->loops, sph->accel);
}

PetscErrorCode SPHCheckPressure_Internal(SPH sph)
{
  const int n   = (int)sph->n;
  int       bad = n;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static) reduction(min : bad)
  for (int i = 0; i < n; i++)
    if (!isfinite(sph->p[i]) && i < bad) bad = i;
  if (bad < n) {
    const PetscReal *x = sph->x + 3 * bad;
    PetscCall(PetscSNPrintf(sph->breakdown, sizeof(sph->breakdown), "step %d, pressure solve: the pressure of fluid particle %d is not a number: position (%g, %g, %g) m, density %g kg/m^3",
                            (int)sph->step, (int)sph->id[bad], (double)x[0], (double)x[1], (double)x[2], (double)sph->rho[bad]));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the solvers in the order of SPHSolver, after auto */
static const SPHSolverOps *const Solvers[] = {&SPHSolverIISPH, &SPHSolverIISPHJacobi, &SPHSolverISPH, &SPHSolverDFSPH, &SPHSolverPCISPH, &SPHSolverPBF, &SPHSolverWCSPH};

const SPHSolverOps *SPHFindSolver_Internal(const SPHParams *params)
{
  if (params->solver != SPH_SOLVER_AUTO) return Solvers[params->solver - 1];
  return params->free_surface || !SPHSolverISPH.Solve ? &SPHSolverIISPH : &SPHSolverISPH;
}

/*@
  SPHSolvePressure - find the pressure that brings v* to rest density at the end of the step

  Collective, after SPHPredict(); velocities of the contacts are read now, so that a coupler may change them and call again

  Input Parameters:
+ sph      - the fluid
. dt       - step of SPHPredict() [s]
. response - term of compliant walls in the operator, or NULL
- ctx      - its context

  Options Database Keys:
+ -sph_solver (auto|iisph|...) - see SPHSolver
. -sph_ksp_type <type>       - iisph by a KSP of PETSc (sph_ksp.c)
. -sph_tolerance <0>         - iisph: mean |projected residual| / rho0 over particles with pressure; iisph_jacobi: mean compression
- -sph_max_iterations <200>  - operator applications; reaching them is told by SPHStats.converged

  Errors:
  BY_ERR_BREAKDOWN when a pressure is not a number

  References: in the file of each solver

  Tests: tests/unit/sph/test_pressure.c, test_solvers.c
@*/
PetscErrorCode SPHSolvePressure(SPH sph, PetscReal dt, SPHResponse response, void *ctx)
{
  const SPHOperator op = {dt, response, ctx, PETSC_FALSE};

  PetscFunctionBegin;
  PetscCheck(!response || sph->method->responds, PetscObjectComm((PetscObject)sph), PETSC_ERR_SUP, "solver %s takes no response of compliant walls: ask SPHGetSolver()", sph->method->name);
  PetscCall(PetscLogEventBegin(SPH_Pressure, sph, 0, 0, 0));
  PetscCall(SPHWallRate_Internal(sph));
  sph->iterations_before += sph->iterations;
  sph->iterations = 0;
  ByCall(sph->method->Solve(sph, &op));
  if (sph->n_openings) SPHOpenPressure_Internal(sph);
  ByCall(SPHCheckPressure_Internal(sph));
  PetscCall(SPHPlaneForces_Internal(sph));
  PetscCall(PetscLogEventEnd(SPH_Pressure, sph, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
