/* sph_pbf.c - position-based fluids [Macklin & Mueller, ACM TOG 32 (2013) 104, doi:10.1145/2461912.2461984].

   From x* = x + dt v*, with gradients, density and planes at the places that the particles have reached (the lists stay those of x), repeat
     C_i = rho_i/rho0 - 1,  lambda_i = -C_i/(sum_k |grad_k C_i|^2 + epsilon)                                    eq. 1, 8, 11
     x_i += (1/rho0) [sum_j (lambda_i + lambda_j + s_corr) m grad W_ij + lambda_i G_i]                           eq. 12 to 14, walls: G
   With q_i = -lambda_i/rho0 [m^5/kg] this is x += -D^T q with the D of those places, so that dt^2 p~ is the sum of all q, and v = (x - x_old)/dt the
   kick of every other solver. With a free surface that sum is kept from becoming negative, the bound of the other solvers; without, the
   paper's equality, particles at a surface are drawn inwards, and s_corr is there against their clumping.

   The paper starts every step from nothing (pbf_warm_start 0), so that still water is the work of every step anew. Half of the last pressure, the default,
   takes half the iterations to the same noise of forces and loses less energy; above 0.7 forces are noisy (docs/verification/fluid.md).

   epsilon is `pbf_relaxation` times sum |grad C|^2 of a full lattice and `artificial_pressure` times the lambda of C = 1 there: both are the same at every
   resolution, unlike the paper's.

   Momentum: every iteration acts between pairs, so it is kept to round-off, and walls get what they gave: planes at the places where it was given,
   proxies by G of the start of the step, towards which phi is linear. Angular momentum is not: an impulse along x_i - x_j as they are during the
   iteration acts on a velocity that carries the particle from where it was: dt |grad v| of the moment is wrong (tests/unit/sph/test_pbf.c shows it).

   Pairs that meet within the step, beyond the support at its start, are not seen; nor is a surface that was out of reach. */
#include <math.h>

#include "sph_impl.h"

typedef struct {
  PetscReal *place;    /* n x 3, x of the iteration [m]                            */
  PetscReal *moved;    /* n x 3, displacement by the constraints so far [m]        */
  PetscReal *solid;    /* n x 3, G of surfaces at the start of the step [kg/m^4]   */
  PetscReal *walls;    /* n x 3, G at the place                                    */
  PetscReal *sum;      /* n, dt^2 p~                                               */
  PetscReal *step;     /* n, its change in one iteration                           */
  PetscReal  full;     /* rho0^2 sum |grad C|^2 of a full lattice [kg^2/m^8] */
  PetscReal  force[6]; /* of the fluid on the planes along their axes, by pressure [N] */
} Positions;

static PetscErrorCode SetUp(SPH sph)
{
  Positions *q;

  PetscFunctionBegin;
  PetscCall(PetscNew(&q));
  sph->method_data = q;
  q->full          = sph->prototype;
  PetscCall(SPHAddArray_Internal(sph, &q->place, 3 * sizeof(PetscReal)));
  PetscCall(SPHAddArray_Internal(sph, &q->moved, 3 * sizeof(PetscReal)));
  PetscCall(SPHAddArray_Internal(sph, &q->solid, 3 * sizeof(PetscReal)));
  PetscCall(SPHAddArray_Internal(sph, &q->walls, 3 * sizeof(PetscReal)));
  PetscCall(SPHAddArray_Internal(sph, &q->sum, sizeof(PetscReal)));
  PetscCall(SPHAddArray_Internal(sph, &q->step, sizeof(PetscReal)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SPH sph)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(sph->method_data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* force that `step` puts on the planes, by their gradient at the places, `later` after the step's beginning */
static void AddPlanes(SPH sph, PetscReal dt, PetscReal later)
{
  Positions *q = (Positions *)sph->method_data;
  const int  n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  PetscReal  sums[6];

  if (!sph->walls) return;
#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal *impulse = sph->partial + c * SPH_SUMS;

    for (int k = 0; k < 6; k++) impulse[k] = 0.0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      PetscReal open, part[6];

      if (q->step[i] == 0.0) continue;
      SPHPlanesAt_Internal(sph, later, q->place + 3 * i, &open, part);
      for (int k = 0; k < 6; k++) impulse[k] += q->step[i] * sph->response[i] * part[k];
    }
  }
  SPHSumPartials(sph, 6, sums);
  for (int k = 0; k < 6; k++) q->force[k] += sph->mass / (dt * dt) * sums[k];
}

/* place = x + dt v* and what the last pressure, times pbf_warm_start, does to it; what surfaces do to a particle is frozen */
static void Begin(SPH sph, PetscReal dt)
{
  Positions      *q      = (Positions *)sph->method_data;
  const int       n      = (int)sph->n;
  const PetscReal to_sum = sph->params.pbf_warm_start * PetscSqr(dt / sph->params.density);

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    q->sum[i] = q->step[i] = to_sum * sph->p[i];
    sph->response[i]       = sph->open_surfaces[i];
    for (int k = 0; k < 3; k++) {
      q->place[3 * i + k] = sph->x[3 * i + k];
      q->solid[3 * i + k] = sph->G[3 * i + k] - sph->open_surfaces[i] * sph->G_planes[3 * i + k];
    }
  }
  for (int k = 0; k < 6; k++) q->force[k] = 0.0;
  AddPlanes(sph, dt, 0.0);
  sph->table->SetPressure(&sph->loops, q->step, NULL);
  sph->table->Acceleration(&sph->loops);
  sph->table->GetVector(&sph->loops, q->moved);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < 3 * n; i++) q->place[i] += dt * sph->v_star[i] + q->moved[i];
}

/* gradients, density and walls at the places; rho goes to residual[], what surfaces leave open to response[] */
static void Evaluate(SPH sph, PetscReal dt)
{
  Positions      *q    = (Positions *)sph->method_data;
  const int       n    = (int)sph->n;
  const PetscReal rho0 = sph->params.density;

  sph->table->Move(&sph->loops, q->place, sph->residual);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    PetscReal open, part[6], surfaces = sph->open_surfaces[i];

    if (surfaces < 1.0) surfaces = SPHSurfacesAt_Internal(sph, i, dt, q->place + 3 * i, q->solid + 3 * i);
    SPHPlanesAt_Internal(sph, dt, q->place + 3 * i, &open, part);
    sph->residual[i] += rho0 * (1.0 - open * surfaces);
    sph->response[i] = surfaces;
    for (int k = 0; k < 3; k++) q->walls[3 * i + k] = surfaces * (part[2 * k] + part[2 * k + 1]) + q->solid[3 * i + k];
  }
  sph->table->SetWalls(&sph->loops, q->walls);
}

/* mean compression, or its largest value where tolerance_norm asks; deviation where pressure may have either sign */
static PetscReal Error(SPH sph)
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n), bounded = sph->params.free_surface;
  const PetscReal rho0 = sph->params.density;
  PetscReal       sum, largest = 0.0;

#pragma omp parallel for schedule(static) reduction(max : largest)
  for (int c = 0; c < chunks; c++) {
    PetscReal s = 0.0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal excess = bounded ? PetscMax(0.0, sph->residual[i] - rho0) : PetscAbsReal(sph->residual[i] - rho0);
      s += excess;
      largest = PetscMax(largest, excess);
    }
    sph->partial[c * SPH_SUMS] = s;
  }
  SPHSumPartials(sph, 1, &sum);
  return (sph->params.tolerance_norm == SPH_NORM_LARGEST ? largest : sum / n) / rho0;
}

/* one iteration from what Evaluate() found */
static void Correct(SPH sph, PetscReal dt)
{
  Positions       *q    = (Positions *)sph->method_data;
  const SPHParams *par  = &sph->params;
  const int        n    = (int)sph->n, bounded = par->free_surface;
  const PetscReal  rho0 = par->density, epsilon = par->pbf_relaxation * q->full, tiny = 1e-8 * q->full;

  sph->table->Diagonal(&sph->loops, sph->direction);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    const PetscReal diagonal = sph->direction[i], sum = q->sum[i];
    PetscReal       next = diagonal > tiny ? sum + SPHConstraintStep(sph->residual[i] - rho0, diagonal, epsilon) : 0.0;

    if (bounded && next < 0) next = 0.0;
    q->step[i] = next - sum;
    q->sum[i]  = next;
  }
  AddPlanes(sph, dt, dt);
  sph->table->SetPressure(&sph->loops, q->step, NULL);
  sph->table->Acceleration(&sph->loops);
  sph->table->GetVector(&sph->loops, sph->accel);
  if (par->artificial_pressure > 0) {
    sph->table->Repulsion(&sph->loops, q->place, par->artificial_pressure * rho0 / q->full, par->artificial_pressure_distance * sph->h, par->artificial_pressure_exponent, sph->accel);
  }
#pragma omp parallel for schedule(static)
  for (int i = 0; i < 3 * n; i++) {
    q->place[i] += sph->accel[i];
    q->moved[i] += sph->accel[i];
  }
  sph->iterations++;
}

static PetscErrorCode Solve(SPH sph, const SPHOperator *op)
{
  Positions       *q   = (Positions *)sph->method_data;
  const SPHParams *par = &sph->params;
  const int        n   = (int)sph->n;
  const PetscReal  to_pressure = PetscSqr(par->density / op->dt);

  PetscFunctionBegin;
  Begin(sph, op->dt);
  for (;;) {
    Evaluate(sph, op->dt);
    if (par->pbf_iterations > 0) sph->converged = (PetscBool)(sph->iterations >= par->pbf_iterations);
    else sph->converged = (PetscBool)(sph->iterations >= 2 && Error(sph) <= par->tolerance);
    if (sph->converged || sph->iterations >= par->max_iterations) break;
    Correct(sph, op->dt);
  }
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->p[i] = to_pressure * q->sum[i];

  // gradients and walls of the step's configuration again
  sph->table->Move(&sph->loops, sph->x, sph->residual);
  sph->table->SetWalls(&sph->loops, sph->G);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the planes got their impulses where particles were during the iterations */
static PetscErrorCode PlaneForces(SPH sph, PetscReal force[6])
{
  const Positions *q = (const Positions *)sph->method_data;

  PetscFunctionBegin;
  for (int k = 0; k < 6; k++) force[k] = q->force[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Accelerate(SPH sph, PetscReal dt)
{
  const Positions *q = (const Positions *)sph->method_data;
  const int        n = (int)sph->n;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static)
  for (int i = 0; i < 3 * n; i++) sph->accel[i] = q->moved[i] / (dt * dt);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SPHSolverOps SPHSolverPBF = {
  .name = "pbf", .tolerance = 1e-3, .SetUp = SetUp, .Destroy = Destroy, .Solve = Solve, .PlaneForces = PlaneForces, .Accelerate = Accelerate};
