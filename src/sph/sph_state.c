/* sph_state.c - initial packing and restart. */
#include <math.h>

#include "sph_impl.h"

/*@
  SPHSetState - put a saved state in place of the current one

  Input Parameters:
+ sph - the fluid, set up; without openings with the same number of particles
. n   - number of particles
. id  - their ids, all different
. x   - positions [m], n x 3
. v   - velocities [m/s], n x 3
- p   - pressures [Pa], n, from which the next solve starts

  Errors:
  BY_ERR_INPUT when the number differs without openings, or an id is there twice: the file belongs to another scene

.seealso: SPHGetInternals()
@*/
PetscErrorCode SPHSetState(SPH sph, PetscInt n, const PetscInt id[], const PetscReal x[], const PetscReal v[], const PetscReal p[])
{
  PetscFunctionBegin;
  PetscCheck(sph->setup, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "SPHSetUp() comes first");
  if (n != sph->n && !sph->n_openings) PetscFunctionReturn(InputError("resume", "the saved state has %d fluid particles, the scene has %d", (int)n, (int)sph->n));
  PetscCall(SPHReserve_Internal(sph, n));
  PetscCall(PetscArraycpy(sph->order, id, n));
  PetscCall(PetscSortInt(n, sph->order));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt k = sph->order[i];
    if (k < 0 || (!sph->n_openings && k >= n) || (i && k == sph->order[i - 1])) PetscFunctionReturn(InputError("resume", "the saved state is damaged: fluid particle id %d is impossible", (int)k));
    sph->next_id = PetscMax(sph->next_id, k + 1);
  }
  sph->n       = n;
  sph->loops.n = (int)n;
  PetscCall(PetscArraycpy(sph->id, id, n));
  PetscCall(PetscArraycpy(sph->x, x, 3 * n));
  PetscCall(PetscArraycpy(sph->v, v, 3 * n));
  PetscCall(PetscArraycpy(sph->p, p, n));
  ByCall(SPHCheckState_Internal(sph, "in the saved state"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHGetInternals - numbers beside the particles that the next step depends on, for a restart that gives the same bits

  Output Parameter:
. state - SPH_INTERNALS numbers: step, last dt, largest acceleration, controller (6), viscous loss, norm of the operator, time, work of
          walls and of the tank's motion
@*/
PetscErrorCode SPHGetInternals(SPH sph, PetscReal state[SPH_INTERNALS])
{
  PetscFunctionBegin;
  state[0] = (PetscReal)sph->step;
  state[1] = sph->dt_last;
  state[2] = sph->accel_max;
  for (int k = 0; k < 3; k++) {
    state[3 + k] = sph->body_force[k];
    state[6 + k] = sph->control[k];
  }
  state[9]  = sph->viscous_loss;
  state[10] = sph->norm;
  state[11] = sph->time;
  state[12] = sph->wall_work;
  state[13] = sph->frame_work;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHSetInternals(SPH sph, const PetscReal state[SPH_INTERNALS])
{
  PetscFunctionBegin;
  sph->step      = (PetscInt)state[0];
  sph->dt_last   = state[1];
  sph->accel_max = state[2];
  for (int k = 0; k < 3; k++) {
    sph->body_force[k] = state[3 + k];
    sph->control[k]    = state[6 + k];
  }
  sph->viscous_loss = state[9];
  sph->norm         = state[10];
  sph->time         = state[11];
  sph->wall_work    = state[12];
  sph->frame_work   = state[13];
  SPHPlace_Internal(sph);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mean of max(0, rho - rho0)/rho0 */
static PetscReal MeanCompression(SPH sph)
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal rho0 = sph->params.density;
  PetscReal       sum;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s = 0.0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) s += PetscMax(0.0, sph->rho[i] / rho0 - 1.0);
    sph->partial[c * SPH_SUMS] = s;
  }
  SPHSumPartials(sph, 1, &sum);
  return sum / n;
}

static PetscReal LargestCompression(SPH sph)
{
  PetscReal largest = 0.0;

  for (PetscInt i = 0; i < sph->n; i++) largest = PetscMax(largest, sph->rho[i] / sph->params.density - 1.0);
  return largest;
}

/* x += the displacement of "pressure" sph->p with dt = 1, at most a tenth of the spacing */
static void Displace(SPH sph)
{
  const int       n = (int)sph->n;
  const PetscReal limit = 0.1 * sph->params.spacing;

  SPHPressureAcceleration_Internal(sph);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    const PetscReal *a      = sph->accel + 3 * i;
    const PetscReal  length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]), part = length > limit ? limit / length : 1.0;

    for (int k = 0; k < 3; k++) {
      PetscReal x = sph->x[3 * i + k] + part * a[k];
      if (sph->periodic >> k & 1) {
        const PetscReal period = sph->max[k] - sph->min[k];
        x -= period * floor((x - sph->min[k]) / period);
      }
      sph->x[3 * i + k] = x;
    }
  }
}

/*@
  SPHPack - push an initial cloud apart until nothing is compressed; velocities and time are untouched, pressures are zero afterwards

  Input Parameters:
+ sph        - the fluid, set up
. tol        - mean compression to reach; the largest is to come below 20 times it
. max_sweeps - at most so many sweeps
. contacts   - called after each neighbour update; it must call SPHSetContacts() (NULL: no surfaces)
- ctx        - its context

  Each sweep solves the pressure problem of a unit step at rest, b = rho - rho0, and moves every particle by what that pressure gives, at
  most a tenth of the spacing. Pressure is never negative, so that particles part and never gather: no volume is lost.
  Walls count by their calibrated factor, which lets the first layer lie where density keeps it; with isph, which never asks for density, by
  what a lattice beyond them would give, so that the layers at a wall stay as full as inside and forces on walls are sums over all of the fluid there.
@*/
PetscErrorCode SPHPack(SPH sph, PetscReal tol, PetscInt max_sweeps, PetscErrorCode (*contacts)(void *, SPH), void *ctx)
{
  const PetscReal relax = sph->relax_time, tolerance = sph->params.tolerance, flux = sph->wall_flux, factor = sph->wall_factor;
  const PetscInt  n = sph->n;

  PetscFunctionBegin;
  PetscCheck(sph->setup, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "SPHSetUp() comes first");
  sph->packing = PETSC_TRUE;
  if (flux != 1.0) { // walls with images
    sph->wall_flux    = 1.0;
    sph->wall_factor  = SPHLatticeWallFactor_Internal(sph);
    sph->surface_part = sph->wall_factor / factor;
  }
  for (PetscInt sweep = 0; sweep <= max_sweeps; sweep++) {
    ByCall(SPHUpdateNeighbors(sph));
    if (contacts) ByCall(contacts(ctx, sph));
    for (PetscInt i = 0; i < n; i++) {
      sph->rho[i]  = sph->rho_pairs[i] + sph->params.density * (1.0 - sph->open[i]);
      sph->rate[i] = sph->wall_rate[i] = 0.0;
    }
    if (sweep == max_sweeps || (MeanCompression(sph) < tol && LargestCompression(sph) < 20.0 * tol)) break;
    sph->relax_time       = 0.0;
    sph->params.tolerance = PetscMax(SPHSolverIISPH.tolerance, 0.05 * tol);
    ByCall(SPHPackSolve_Internal(sph));
    sph->relax_time       = relax;
    sph->params.tolerance = tolerance;
    Displace(sph);
  }
  sph->packing      = PETSC_FALSE;
  sph->wall_flux    = flux;
  sph->wall_factor  = factor;
  sph->surface_part = 1.0;
  PetscCall(PetscArrayzero(sph->p, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}
