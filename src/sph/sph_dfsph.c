/* sph_dfsph.c - divergence-free SPH [Bender & Koschier, SCA 2015; IEEE TVCG 23 (2017), doi:10.1109/TVCG.2016.2578335].

   Two solves at the configuration of the step, both by the diagonal factor of the paper's eq. 8
     alpha_i/rho_i = 1/(|sum_j m grad W_ij + G_i|^2 + sum_j |m grad W_ij|^2) = 1/(D D^T)_ii
   1. divergence: the velocity v with which the last step ended (its neighbourhood is this step's) is made free of divergence, eq. 12
        p~ <- max(0, p~ + omega (alpha_i/rho_i) ((D v - wall's own motion)/dt - (D D^T p~)_i))
      except where particles are missing around i: what is below SPH_DFSPH_SPARSE of rest density may gather freely
   2. density: with that pressure's acceleration in v*, eq. 9
        p~ <- max(0, p~ + omega (alpha_i/rho_i) ((share (rho - rho0) + dt D v*)/dt^2 - (D D^T p~)_i))
   kappa_i/rho_i of the paper is p~_i here, and the step's pressure is the sum of both, so that walls and proxies get the whole impulse.
   omega = 1/2 as in the authors' own implementation; both bounds hold at free surfaces only. The density solve starts from the last
   pressure, the divergence solve from nothing: between steps it would have to be kept apart, and at rest it is next to nothing.
   Deviations: divergence is removed before gravity and viscosity act and not after positions move, which is the same place in the sequence of
   steps, but v* has seen the viscosity of v before it. */
#include <math.h>

#include "sph_impl.h"

#define SPH_DFSPH_OMEGA  0.5
#define SPH_DFSPH_SPARSE 0.65 /* [rho0] the paper asks for 20 neighbours of 30 */
#define SPH_DFSPH_WARM   0.5  /* part of the last pressure that the density solve starts from: 0.8 halves the iterations, but what is too much then stays,
                                 since the iteration ends when nothing is compressed: 1.6 rho g z in a shallow layer */

/* y <- y + omega (b - A y)/dt^2 until the mean (tolerance_norm: or the largest) of max(0, b - A y)/(S rho0), or of its absolute value without a free surface, is below
   `tolerance`, after `least` iterations or more; A y is left in Adirection */
static PetscErrorCode Iterate(SPH sph, const SPHOperator *op, PetscReal tolerance, int least, PetscBool *converged)
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n), bounded = sph->params.free_surface;
  const PetscReal step = SPH_DFSPH_OMEGA / (op->dt * op->dt), allowed = tolerance * sph->params.density;
  const PetscInt  first = sph->iterations;

  PetscFunctionBegin;
  *converged = PETSC_FALSE;
  while (sph->iterations - first < sph->params.max_iterations) {
    PetscReal sum, largest = 0.0;

    PetscCall(SPHApply_Internal(sph, op, sph->y, sph->Adirection));
#pragma omp parallel for schedule(static) reduction(max : largest)
    for (int c = 0; c < chunks; c++) {
      PetscReal left = 0.0;

      for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
        const PetscReal r = sph->rhs[i] - sph->Adirection[i], y = sph->y[i] + step * r;

        const PetscReal part = sph->root[i] * (bounded ? PetscMax(0.0, r) : PetscAbsReal(r));

        left += part;
        largest          = PetscMax(largest, part);
        sph->residual[i] = sph->y[i];
        sph->y[i]        = bounded && y < 0 ? 0.0 : y;
      }
      sph->partial[c * SPH_SUMS] = left;
    }
    SPHSumPartials(sph, 1, &sum);
    if (sph->iterations - first >= least && (sph->params.tolerance_norm == SPH_NORM_LARGEST ? largest : sum / n) <= allowed) {
      *converged = PETSC_TRUE;
      break;
    }
  }
  // the iterate whose residual is known
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->y[i] = sph->residual[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* part 1: y and, in Adirection, A y of the divergence; rhs is overwritten */
static PetscErrorCode SolveDivergence(SPH sph, const SPHOperator *op, PetscBool *converged)
{
  const int       n = (int)sph->n, bounded = sph->params.free_surface;
  const PetscReal sparse = SPH_DFSPH_SPARSE * sph->params.density;

  PetscFunctionBegin;
  sph->table->SetVelocity(&sph->loops, sph->v);
  sph->table->Rate(&sph->loops, op->dt, sph->scale, sph->rhs);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    sph->rhs[i] -= op->dt * sph->scale[i] * sph->wall_rate[i];
    if (bounded && sph->rho[i] < sparse) sph->rhs[i] = 0.0;
    sph->y[i] = 0.0;
  }
  PetscCall(Iterate(sph, op, sph->params.divergence_tolerance, 1, converged));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve(SPH sph, const SPHOperator *op)
{
  const int       n        = (int)sph->n;
  const PetscReal to_tilde = SPH_DFSPH_WARM / PetscSqr(sph->params.density);
  PetscReal      *density  = sph->direction;
  PetscBool       free_of_divergence;

  PetscFunctionBegin;
  SPHPrepare_Internal(sph, op->dt, 0.0);
  PetscCall(PetscArraycpy(density, sph->rhs, n));
  PetscCall(SolveDivergence(sph, op, &free_of_divergence));

  // what divergence left for density to do; p of the divergence waits in direction
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    const PetscReal divergence = sph->y[i];

    sph->rhs[i]       = density[i] - sph->Adirection[i];
    sph->direction[i] = divergence;
    sph->y[i]         = to_tilde * sph->root[i] * sph->p[i];
  }
  PetscCall(Iterate(sph, op, sph->params.tolerance, 2, &sph->converged));
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->y[i] += sph->direction[i];
  SPHStorePressure_Internal(sph);
  sph->converged = (PetscBool)(sph->converged && free_of_divergence);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SPHSolverOps SPHSolverDFSPH = {.name = "dfsph", .tolerance = 1e-4, .responds = PETSC_TRUE, .Solve = Solve};
