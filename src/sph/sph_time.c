/* sph_time.c - the time step, what happens before pressure, and the integrator (method 1.3). */
#include <math.h>

#include "mat3.h"
#include "sph_impl.h"

/* largest |v| of the particles and of the planes [m/s]; surfaces are the coupler's (CouplerLimitStep()) */
static PetscReal LargestSpeed(SPH sph)
{
  const int n       = (int)sph->n;
  PetscReal largest = 0.0;

#pragma omp parallel for schedule(static) reduction(max : largest)
  for (int i = 0; i < n; i++) {
    const PetscReal *v = sph->v + 3 * i;
    largest            = PetscMax(largest, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
  return PetscMax(sqrt(largest), SPHFastestPlane_Internal(sph));
}

/* step of water at rest [s]: gravity and what a moving tank adds to it; without either as good as any */
static PetscReal QuietStep(SPH sph)
{
  const PetscReal g = Norm3(sph->gravity) + SPHFrameAcceleration_Internal(sph);

  return 0.05 * sqrt(sph->h / (g > 0 ? g : 1.0));
}

/*@
  SPHGetTimeStep - largest permitted step for the current state

  Equation (method 1.3, after Monaghan 1992):
  dt = min( cfl dx/|v|max, 0.25 sqrt(h/|a|max), 0.05 sqrt(h/g), 0.1 h/|U|, max_time_step ), and at most 1.1 times the last one

  and min( 0.125 h^2/nu, 0.8/K_ii ) where viscosity is explicit (sph_viscosity.c).
  |v|max is of particles and planes, |a|max that of the last step, g with the largest acceleration of a moving tank, U the mean velocity that is
  asked for. Without motion and without gravity a step of 0.05 sqrt(h/(1 m/s^2)) is as good as any.

  Options Database Keys:
+ -sph_cfl <0.4>         - path of a particle in a step over spacing
. -sph_time_step <0>     - fixed step [s]
- -sph_max_time_step <0> - upper bound [s]
@*/
PetscErrorCode SPHGetTimeStep(SPH sph, PetscReal *dt)
{
  const SPHParams *par = &sph->params;
  const PetscReal  speed = LargestSpeed(sph);
  PetscReal        step = QuietStep(sph);

  PetscFunctionBegin;
  if (par->time_step > 0) {
    *dt = par->time_step;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (sph->flow_speed > 0) step = PetscMin(step, 0.1 * sph->h / sph->flow_speed);
  if (speed > 0) step = PetscMin(step, par->cfl * par->spacing / speed);
  if (sph->accel_max > 0) step = PetscMin(step, 0.25 * sqrt(sph->h / sph->accel_max));
  if (sph->method->LimitStep) PetscCall(sph->method->LimitStep(sph, &step));
  if (par->max_time_step > 0) step = PetscMin(step, par->max_time_step);
  if (sph->dt_last > 0) step = PetscMin(step, 1.1 * sph->dt_last);
  if (par->viscosity > 0 && par->viscosity_solver != SPH_VISCOSITY_IMPLICIT) {
    const PetscReal explicit_step = SPHViscousStep_Internal(sph);
    if (par->viscosity_solver == SPH_VISCOSITY_EXPLICIT || explicit_step > 0.5 * step) step = PetscMin(step, explicit_step);
  }
  *dt = step;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Body force that holds the mean velocity U at its target U0: a proportional and an integral part,
    f = 3 (U0 - U)/T + I,  dI/dt = 4 (U0 - U)/T^2,  T = h/|U0|
  without drag damped at 3/4 of the critical, with drag more: U follows within a few T, and I becomes the drag per mass.
*/
static void ControlMeanVelocity(SPH sph, PetscReal dt)
{
  const int        n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal *target = sph->params.mean_velocity, T = sph->h / Norm3(target);
  PetscReal        mean[3];

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s[3] = {0, 0, 0};
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++)
      for (int k = 0; k < 3; k++) s[k] += sph->v[3 * i + k];
    for (int k = 0; k < 3; k++) sph->partial[c * SPH_SUMS + k] = s[k];
  }
  SPHSumPartials(sph, 3, mean);
  for (int k = 0; k < 3; k++) {
    if (target[k] == 0.0) continue;
    const PetscReal lag = target[k] - mean[k] / n;
    sph->body_force[k]  = 3.0 * lag / PetscMax(T, 6.0 * dt) + sph->control[k];
    sph->control[k] += 4.0 * dt * lag / PetscSqr(PetscMax(T, 6.0 * dt));
  }
}

/*@
  SPHPredict - density, and the velocity v* that gravity, viscosity and the mean-velocity controller give without pressure

  Equation:
  rho_i = sum_j m W_ij + rho0 phi_i;  v*_i = v_i + dt (g + f + viscous);  rate_i = (D v*)_i

  Call after SPHSetContacts() (or SPHUpdateNeighbors() when there are no surfaces).
@*/
PetscErrorCode SPHPredict(SPH sph, PetscReal dt)
{
  const int        n    = (int)sph->n;
  const PetscReal  rho0 = sph->params.density;
  const PetscReal *from = sph->frame ? sph->v_star : sph->v;
  PetscReal        a[3];

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SPH_Predict, sph, 0, 0, 0));
  sph->iterations = sph->iterations_before = 0;
  if (Norm3(sph->params.mean_velocity) > 0) ControlMeanVelocity(sph, dt);
  SPHMovePlanes_Internal(sph, dt);
  for (int k = 0; k < 3; k++) a[k] = sph->gravity[k];
  if (sph->frame) SPHFramePredict_Internal(sph, dt, a);
  for (int k = 0; k < 3; k++) a[k] += sph->body_force[k];
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    sph->rho[i] = sph->rho_pairs[i] + rho0 * (1.0 - sph->open[i]);
    for (int k = 0; k < 3; k++) sph->v_star[3 * i + k] = from[3 * i + k] + dt * a[k];
  }
  if (sph->params.viscosity > 0) ByCall(SPHViscousPredict_Internal(sph, dt));
  if (sph->filter_rate > 0) PetscCall(SPHFilterPredict_Internal(sph, dt));
  if (sph->params.xsph > 0) PetscCall(SPHSmoothPredict_Internal(sph));
  if (sph->params.vorticity_confinement > 0) PetscCall(SPHConfinePredict_Internal(sph, dt));
  if (sph->method->Predict) PetscCall(sph->method->Predict(sph, dt));
  if (sph->n_openings) PetscCall(SPHOpenPredict_Internal(sph, dt));
  if (!sph->method->ignores_rate) {
    sph->table->SetVelocity(&sph->loops, sph->v_star);
    sph->table->Rate(&sph->loops, 1.0, NULL, sph->rate);
  }
  PetscCall(PetscLogEventEnd(SPH_Predict, sph, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Wrap(PetscReal x, PetscReal lo, PetscReal hi)
{
  if (x >= lo && x < hi) return x;
  x -= (hi - lo) * floor((x - lo) / (hi - lo));
  return x < hi ? x : lo;
}

/*@
  SPHKick - first half of the end of a step: v = v* + dt a_p, stops at planar walls (sph_stop.c); positions stay

.seealso: SPHDrift(), SPHAdvance()
@*/
PetscErrorCode SPHKick(SPH sph, PetscReal dt)
{
  const int n      = (int)sph->n;
  PetscReal accel2 = 0.0;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SPH_Advance, sph, 0, 0, 0));
  if (sph->frame) SPHFrameWork_Internal(sph);
  if (sph->method->Accelerate) PetscCall(sph->method->Accelerate(sph, dt));
  else SPHPressureAcceleration_Internal(sph);
  if (sph->n_openings) SPHOpenHold_Internal(sph);
#pragma omp parallel for schedule(static) reduction(max : accel2)
  for (int i = 0; i < n; i++) {
    PetscReal a2 = 0.0;

    for (int k = 0; k < 3; k++) {
      const PetscReal v = sph->v_star[3 * i + k] + dt * sph->accel[3 * i + k], a = (v - sph->v[3 * i + k]) / dt;

      sph->v[3 * i + k] = v;
      a2 += a * a;
    }
    accel2 = PetscMax(accel2, a2);
  }
  sph->accel_max = sqrt(accel2);
  SPHStopAtPlanes_Internal(sph, dt);
  for (int k = 0; k < 18; k++) sph->wall_work -= dt * sph->wall_force[k] * sph->plane_velocity[k];
  if (sph->frame) SPHFrameWork_Internal(sph);
  PetscCall(PetscLogEventEnd(SPH_Advance, sph, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x += dt v */
static void Drift(SPH sph, PetscReal dt, PetscReal *path)
{
  const int n      = (int)sph->n;
  PetscReal speed2 = 0.0;

#pragma omp parallel for schedule(static) reduction(max : speed2)
  for (int i = 0; i < n; i++) {
    PetscReal v2 = 0.0;

    for (int k = 0; k < 3; k++) {
      sph->x[3 * i + k] += dt * sph->v[3 * i + k];
      v2 += sph->v[3 * i + k] * sph->v[3 * i + k];
    }
    speed2 = PetscMax(speed2, v2);
  }
  *path = dt * sqrt(speed2);
}

/*
  Water can explode without a number going wrong or a wall being passed. A particle that passes its whole neighbourhood in a fixed step, twice
  the support, ends the run; steps that the program chooses follow the speed one step later, so that there a shot far beyond
  does, and a speed at which the step would be a ten-thousandth of that of water at rest: kilometres a second, which only water has that is pressed
  where there is no room for it.
*/
static PetscErrorCode CheckPath(SPH sph, PetscReal dt, PetscReal path)
{
  const PetscBool fixed   = (PetscBool)(sph->params.time_step > 0);
  const PetscReal limit   = fixed ? 2.0 : 20.0; // supports
  const PetscReal fastest_ever = sph->params.cfl * sph->params.spacing / (1e-4 * QuietStep(sph));
  PetscReal       fastest = 0.0;
  PetscInt        worst   = 0;
  char            advice[80];

  PetscFunctionBegin;
  if (path <= limit * sph->h && (fixed || path <= dt * fastest_ever)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < sph->n; i++) {
    const PetscReal speed = Norm3(sph->v + 3 * i);
    if (speed > fastest) {
      fastest = speed;
      worst   = i;
    }
  }
  if (fixed) PetscCall(PetscSNPrintf(advice, sizeof(advice), "sph.time_step is too long here, leave it out or take %.1g s", (double)(0.25 * dt)));
  else PetscCall(PetscSNPrintf(advice, sizeof(advice), "the pressure there explodes, or water has no room"));
  PetscCall(PetscSNPrintf(sph->breakdown, sizeof(sph->breakdown), "step %d, at its end: fluid particle %d at (%g, %g, %g) m goes %g m in one step of %g s, %g m/s: %s", (int)sph->step,
                          (int)sph->id[worst], (double)sph->x[3 * worst], (double)sph->x[3 * worst + 1], (double)sph->x[3 * worst + 2], (double)path, (double)dt, (double)fastest, advice));
  PetscFunctionReturn(BY_ERR_BREAKDOWN);
}

/*@
  SPHDrift - second half of the end of a step: x += dt v, periodic axes wrapped

  Errors:
  BY_ERR_BREAKDOWN when a particle is not a number or left the domain through a wall, or a fixed step takes one past its whole neighbourhood, or one is
  so fast that steps would never end
@*/
PetscErrorCode SPHDrift(SPH sph, PetscReal dt)
{
  const int n = (int)sph->n;
  PetscReal path;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SPH_Advance, sph, 0, 0, 0));
  if (sph->shifting > 0) {
    PetscCall(SPHShift_Internal(sph, dt));
    SPHStopAtPlanes_Internal(sph, dt); // shifting changes velocities
  }
  ByCall(SPHTick_Internal(sph, dt));
  if (sph->method->Drift) PetscCall(sph->method->Drift(sph, dt, &path));
  else Drift(sph, dt, &path);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 3; k++)
      if (sph->periodic >> k & 1) sph->x[3 * i + k] = Wrap(sph->x[3 * i + k], sph->min[k], sph->max[k]);
  sph->grid_drift += path;
  sph->dt_last = dt;
  sph->step++;
  ByCall(SPHCheckState_Internal(sph, "at its end"));
  ByCall(CheckPath(sph, dt, path));
  PetscCall(PetscLogEventEnd(SPH_Advance, sph, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHAdvance - end of the step of a fluid alone: SPHKick() and SPHDrift(), symplectic Euler
@*/
PetscErrorCode SPHAdvance(SPH sph, PetscReal dt)
{
  PetscFunctionBegin;
  PetscCall(SPHKick(sph, dt));
  ByCall(SPHDrift(sph, dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* between SPHKick() and SPHDrift(): change the velocity [m/s] of a particle that meets a body, and move it [m] */
PetscErrorCode SPHStop(SPH sph, PetscInt particle, const PetscReal change[3], const PetscReal shift[3])
{
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    sph->v[3 * particle + k] += change[k];
    sph->x[3 * particle + k] += shift[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
