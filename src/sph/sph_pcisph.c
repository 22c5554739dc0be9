/* sph_pcisph.c - predictive-corrective incompressible SPH [Solenthaler & Pajarola, ACM Trans. Graph. 28 (2009) 40, doi:10.1145/1531326.1531346].

   Pressure is corrected until the density at the predicted positions is right:
     x* = x + dt v* - dt^2 D^T p~,   err = rho(x*) - rho0,   p~ += delta err,   p~ >= 0 with a free surface
   rho(x*) is summed over the lists of the step at positions x*, planes as they are there, surfaces to first order with their own motion
   (SPHAddWallDensity_Internal); gradients stay those of the step, so that one p~ a particle is all that acts (the paper's line 17 leaves
   both readings). At least three corrections (the paper's section 2.4.2), from p~ = 0.

   delta is the paper's eq. 8 for a prototype with a full lattice, 1/(2 dt^2 sum |m grad W|^2); where a particle has a larger diagonal than the
   prototype, because it is crowded, delta is that of its own, or the correction would overshoot. */
#include "sph_impl.h"

#define LEAST_CORRECTIONS 3
#define GROWN             1.2  /* errors this much above the least seen will not come down again */
#define MOST_OF_A_STEP    0.02 /* of rest density that a step takes back: a crowded start is pressed out and not shot out */

/* Density at x + dt v* - dt^2 D^T p~ for p~ in p_tilde: into `rho`; x* into `x` */
static void PredictDensity(SPH sph, const SPHOperator *op, PetscReal x[], PetscReal rho[])
{
  const int       n  = (int)sph->n;
  const PetscReal dt = op->dt;

  sph->table->SetPressure(&sph->loops, sph->p_tilde, NULL);
  sph->table->Acceleration(&sph->loops);
  sph->table->GetVector(&sph->loops, sph->accel);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < 3 * n; i++) x[i] = sph->x[i] + dt * (sph->v_star[i] + dt * sph->accel[i]);
  sph->table->Density(&sph->loops, x, rho);
  SPHAddWallDensity_Internal(sph, dt, x, rho);
}

/* p~ += delta (rho - target); tells the sum and the largest of what is compressed [kg/m^3]. The target is rest density, or on the way to it
   when relax_time is given. */
static void Correct(SPH sph, PetscReal dt, const PetscReal rho[], const PetscReal delta[], PetscReal *sum, PetscReal *largest)
{
  const int       n    = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal rho0 = sph->params.density, tau = sph->relax_time < 0 ? 10.0 * dt : sph->relax_time, relax = tau > dt ? dt / tau : 1.0;
  PetscReal       top  = 0.0;

#pragma omp parallel for schedule(static) reduction(max : top)
  for (int c = 0; c < chunks; c++) {
    PetscReal s = 0.0;

    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal excess = sph->rho[i] - rho0, left = PetscMax((1.0 - SPHSourceShare(excess / rho0, relax)) * excess, excess - MOST_OF_A_STEP * rho0);
      const PetscReal err    = rho[i] - rho0 - left;
      PetscReal       p = sph->p_tilde[i] + delta[i] * err;

      if (sph->params.free_surface && p < 0) p = 0.0;
      sph->p_tilde[i] = p;
      s += PetscMax(0.0, err);
      top = PetscMax(top, err);
    }
    sph->partial[c * SPH_SUMS] = s;
  }
  SPHSumPartials(sph, 1, sum);
  *largest = top;
}

/* delta of every particle; the largest eigenvalue of the system, estimated once, limits it where supports are wide (the paper's is stable
   below 2.3 dx, at 3 dx it would be twice too large) */
static PetscErrorCode FindDelta(SPH sph, const SPHOperator *op, PetscReal delta[])
{
  const int n = (int)sph->n;

  PetscFunctionBegin;
  if (!(sph->norm > 0)) {
    SPHPrepare_Internal(sph, op->dt, 0.0);
    PetscCall(SPHFindNorm_Internal(sph, op));
  }
  sph->table->Diagonal(&sph->loops, delta);
  const PetscReal omega = sph->norm > 0 ? PetscMin(0.5, 1.8 / sph->norm) : 0.5;
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) delta[i] = omega / (op->dt * op->dt * PetscMax(sph->prototype, delta[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corrections until the compression is allowed. A crowd in a corner can be more than the gradients of the step can disperse: then errors
   grow again, and the pressure that gave the least is what is taken (in y). */
static PetscErrorCode Solve(SPH sph, const SPHOperator *op)
{
  const int       n    = (int)sph->n;
  const PetscReal rho0 = sph->params.density, allowed = sph->params.tolerance * rho0;
  const PetscBool mean = (PetscBool)(sph->params.tolerance_norm == SPH_NORM_MEAN);
  PetscReal      *delta = sph->scale, *rho = sph->residual, *x = sph->x_alt, least = PETSC_MAX_REAL; // x_alt is free between two sorts

  PetscFunctionBegin;
  PetscCall(FindDelta(sph, op, delta));
  PetscCall(PetscArrayzero(sph->p_tilde, n));
  sph->converged = PETSC_FALSE;
  while (sph->iterations < sph->params.max_iterations) {
    PetscReal sum, largest, error;

    PredictDensity(sph, op, x, rho);
    PetscCall(PetscArraycpy(sph->rhs, sph->p_tilde, n));
    Correct(sph, op->dt, rho, delta, &sum, &largest);
    error = mean ? sum / n : largest;
    sph->iterations++;
    if (sph->iterations >= LEAST_CORRECTIONS && error < allowed) {
      sph->converged = PETSC_TRUE;
      break;
    }
    if (error < least) {
      least = error;
      PetscCall(PetscArraycpy(sph->y, sph->rhs, n));
    } else if (error > GROWN * least || sph->iterations == sph->params.max_iterations) {
      PetscCall(PetscArraycpy(sph->p_tilde, sph->y, n));
      break;
    }
  }
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->p[i] = rho0 * rho0 * sph->p_tilde[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SPHSolverOps SPHSolverPCISPH = {.name = "pcisph", .tolerance = 1e-2, .ignores_rate = PETSC_TRUE, .Solve = Solve};
