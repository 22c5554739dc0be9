/* sph_viscosity.c - viscosity between particles and the friction of no-slip walls (method 1); the noise filter.

   With K the pairs' operator (symmetric, positive semidefinite: weights of pairs are symmetric), k_i the friction of the walls at particle i and
   u_i sum_k k_ik v_k the push of walls that move, both per mass,
     explicit   (1 + dt k) w = v* - dt K v + dt u        particle by particle; stable for dt < 1/K_ii
     implicit   (1 + dt k + dt K) w = v* + dt u          conjugate gradients by PETSc (options -sph_viscosity_ksp_*), stable for every step
   Walls and proxies get back m k_ik (w_i - v_k), so that what the fluid loses is what they gain, to round-off; the fluid takes
   v* + dt (u - k w - K w), which differs from w by the residual of the solve and loses no momentum between particles.

   An implicit step that is long against the time of diffusion across the flow would let friction carry the weight of water at rest, which
   pressure has to: so v* has the pressure acceleration of the last step in it during the solve, and it is taken out again behind it
   [Van Kan, SIAM J. Sci. Stat. Comput. 7 (1986) 870]. */
#include <petscksp.h>

#include "sph_impl.h"

#define DENSEST  1.1 /* over rest density: viscosity counts a particle's volume as m/rho within these bounds, so that a channel filled to 97 % */
#define THINNEST 0.9 /* has the viscosity of the fluid; a free surface, where rho is half, is not a thin fluid                              */

/* of the implicit solve */
struct _SPHViscous {
  SPH       sph;
  PetscReal dt;
  PetscInt  n;      /* particles that the objects are made for */
  Mat       A;
  KSP       ksp;
  Vec       x, b;   /* without arrays of their own             */
};

/* v* -= dt rate L L v, the noise filter of sph_pair.h */
PetscErrorCode SPHFilterPredict_Internal(SPH sph, PetscReal dt)
{
  const int       n    = (int)sph->n;
  const PetscReal rate = PetscMin(sph->filter_rate, 0.25 / dt); // explicit: stable below 2/dt, monotone below 1/dt

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(sph->accel, 3 * n));
  sph->table->SetVelocity(&sph->loops, sph->v);
  sph->table->Filter(&sph->loops, -1.0 / sph->filter_norm, sph->accel);
  sph->table->SetVelocity(&sph->loops, sph->accel);
  sph->table->Filter(&sph->loops, dt * rate / sph->filter_norm, sph->v_star);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rest density over that of each particle, bounded, is its volume; friction of the walls, k in response[], their push, u in push[], and sum_k k |v_k|^2 in
   rate[], which is free until the end of the prediction */
static void Friction(SPH sph)
{
  const int       n    = (int)sph->n;
  const PetscReal rho0 = sph->params.density;
  const PetscBool moving = SPHPlanesMove_Internal(sph);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    const PetscReal part = 1.0 / PetscMin(DENSEST, PetscMax(THINNEST, sph->rho[i] / rho0));

    sph->volume[i]   = part / rho0;
    sph->response[i] = part * sph->friction_planes[i] * sph->open_surfaces[i];
    sph->rate[i]     = 0.0;
    for (int q = 0; q < 3; q++) sph->push[3 * i + q] = 0.0;
    if (moving) sph->rate[i] = part * SPHPlaneDrag_Internal(sph, i, sph->push + 3 * i);
    for (int q = 0; q < 3; q++) sph->push[3 * i + q] *= part;
  }
  for (PetscInt s = 0; s < sph->n_surfaces; s++) {
    const SPHContacts *c = &sph->contacts[s];
    PetscReal         *k = sph->surfaces[s].friction;
#pragma omp parallel for schedule(static)
    for (PetscInt t = 0; t < c->n_touched; t++) {
      const PetscInt   i = c->particle[t];
      const PetscReal *g = c->grad + 3 * t, g2 = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];

      k[t] *= rho0 * sph->volume[i];
      sph->response[i] += k[t];
      for (PetscInt b = c->start[t]; c->velocity && g2 > 0 && b < c->start[t + 1]; b++) {
        const PetscReal *share = c->share + 3 * b, *v = c->velocity + 3 * c->proxy[b];
        const PetscReal  weight = (share[0] * g[0] + share[1] * g[1] + share[2] * g[2]) / g2;
        for (int q = 0; q < 3; q++) {
          sph->push[3 * i + q] += k[t] * weight * v[q];
          sph->rate[i] += k[t] * weight * v[q] * v[q];
        }
      }
    }
  }
}

/* keep the velocities that friction has seen: a coupler may change them before the forces are asked for */
static PetscErrorCode KeepVelocities(SPH sph)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < sph->n_surfaces; s++) {
    const SPHContacts *c = &sph->contacts[s];
    SPHSurfaceWork    *w = &sph->surfaces[s];

    if (c->n_proxies > w->proxies) {
      w->proxies = c->n_proxies + c->n_proxies / 2;
      PetscCall(PetscFree(w->velocity));
      PetscCall(PetscMalloc1(3 * w->proxies, &w->velocity));
    }
    if (c->velocity) PetscCall(PetscArraycpy(w->velocity, c->velocity, 3 * c->n_proxies));
    else PetscCall(PetscArrayzero(w->velocity, 3 * c->n_proxies));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* out = (1 + dt k + dt K) in */
static PetscErrorCode Mult(Mat A, Vec in, Vec out)
{
  SPHViscous       s;
  const PetscReal *x;
  PetscReal       *y;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &s));
  const int        n = (int)s->n;
  const PetscReal *k = s->sph->response;
  PetscCall(VecGetArrayRead(in, &x));
  PetscCall(VecGetArrayWrite(out, &y));
  s->sph->table->Viscous(&s->sph->loops, s->sph->params.viscous_form == SPH_VISCOUS_MONAGHAN, x, y);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++)
    for (int q = 0; q < 3; q++) y[3 * i + q] = (1.0 + s->dt * k[i]) * x[3 * i + q] - s->dt * y[3 * i + q];
  PetscCall(VecRestoreArrayWrite(out, &y));
  PetscCall(VecRestoreArrayRead(in, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetDiagonal(Mat A, Vec diagonal)
{
  SPHViscous s;
  PetscReal *d;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(VecGetArrayWrite(diagonal, &d));
  s->sph->table->ViscousDiagonal(&s->sph->loops, s->sph->params.viscous_form == SPH_VISCOUS_MONAGHAN, d);
  for (PetscInt i = 0; i < 3 * s->n; i++) d[i] = 1.0 + s->dt * (s->sph->response[i / 3] + d[i]);
  PetscCall(VecRestoreArrayWrite(diagonal, &d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroySolver(SPHViscous s)
{
  PetscFunctionBegin;
  PetscCall(KSPDestroy(&s->ksp));
  PetscCall(MatDestroy(&s->A));
  PetscCall(VecDestroy(&s->x));
  PetscCall(VecDestroy(&s->b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHViscousDestroy_Internal(SPH sph)
{
  PetscFunctionBegin;
  if (!sph->viscous) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DestroySolver(sph->viscous));
  PetscCall(PetscFree(sph->viscous));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* solver for the particles that there are now */
static PetscErrorCode MakeSolver(SPH sph)
{
  const PetscInt n = 3 * sph->n;
  SPHViscous     s;
  PC             pc;

  PetscFunctionBegin;
  if (!sph->viscous) PetscCall(PetscNew(&sph->viscous));
  s = sph->viscous;
  if (s->n == sph->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DestroySolver(s));
  s->sph = sph;
  s->n   = sph->n;
  PetscCall(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))Mult));
  PetscCall(MatShellSetOperation(s->A, MATOP_GET_DIAGONAL, (void (*)(void))GetDiagonal));
  PetscCall(MatSetOption(s->A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatSetOption(s->A, MAT_SPD, PETSC_TRUE));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, NULL, &s->x));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, NULL, &s->b));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &s->ksp));
  PetscCall(KSPSetOptionsPrefix(s->ksp, "sph_viscosity_"));
  PetscCall(KSPSetOperators(s->ksp, s->A, s->A));
  PetscCall(KSPSetType(s->ksp, KSPCG));
  PetscCall(KSPGetPC(s->ksp, &pc));
  PetscCall(PCSetType(pc, PCJACOBI));
  PetscCall(KSPSetInitialGuessNonzero(s->ksp, PETSC_TRUE));
  PetscCall(KSPSetNormType(s->ksp, KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetTolerances(s->ksp, 1e-8, 1e-50, 1e50, 5000));
  PetscCall(KSPSetFromOptions(s->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* w, in v_viscous, of the implicit step; the last velocity is the first guess */
static PetscErrorCode SolveImplicit(SPH sph, PetscReal dt)
{
  const int          n = (int)sph->n;
  KSPConvergedReason reason;
  PetscInt           iterations;
  PetscReal          residual;

  PetscFunctionBegin;
  PetscCall(MakeSolver(sph));
  sph->viscous->dt = dt;
#pragma omp parallel for schedule(static)
  for (int i = 0; i < 3 * n; i++) {
    sph->accel[i]     = sph->v_star[i] + dt * sph->push[i];
    sph->v_viscous[i] = sph->v[i];
  }
  PetscCall(VecPlaceArray(sph->viscous->b, sph->accel));
  PetscCall(VecPlaceArray(sph->viscous->x, sph->v_viscous));
  PetscCall(PetscObjectStateIncrease((PetscObject)sph->viscous->A)); // of a new step: the preconditioner is made again
  PetscCall(KSPSetOperators(sph->viscous->ksp, sph->viscous->A, sph->viscous->A));
  PetscCall(KSPSolve(sph->viscous->ksp, sph->viscous->b, sph->viscous->x));
  PetscCall(VecResetArray(sph->viscous->b));
  PetscCall(VecResetArray(sph->viscous->x));
  PetscCall(KSPGetConvergedReason(sph->viscous->ksp, &reason));
  PetscCall(KSPGetIterationNumber(sph->viscous->ksp, &iterations));
  PetscCall(KSPGetResidualNorm(sph->viscous->ksp, &residual));
  sph->viscous_solves++;
  sph->viscous_iterations += iterations;
  if (reason < 0) {
    PetscCall(PetscSNPrintf(sph->breakdown, sizeof(sph->breakdown), "step %d, viscosity: the implicit solve %s after %d iterations, residual %g m/s", (int)sph->step,
                            KSPConvergedReasons[reason], (int)iterations, (double)residual));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* v* += dt (acceleration by the last step's pressure at the positions of now); solvers with an acceleration of their own go without */
static PetscErrorCode AddLastPressure(SPH sph, PetscReal dt)
{
  const int n = (int)sph->n;

  PetscFunctionBegin;
  if (sph->method->Accelerate) PetscFunctionReturn(PETSC_SUCCESS); // of a solve that is still to come
  SPHPressureAcceleration_Internal(sph);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < 3 * n; i++) sph->v_star[i] += dt * sph->accel[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* largest explicit step [s]: 1/K_ii of a full lattice, and the bound of method 1.3 */
PetscReal SPHViscousStep_Internal(SPH sph)
{
  const PetscReal nu = sph->params.viscosity / sph->params.density;
  return nu > 0 ? PetscMin(0.125 * sph->h * sph->h / nu, 0.8 / (nu * sph->viscous_norm)) : PETSC_MAX_REAL;
}

/* v* += viscosity and friction of a step, explicit or implicit */
PetscErrorCode SPHViscousPredict_Internal(SPH sph, PetscReal dt)
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n), central = sph->params.viscous_form == SPH_VISCOUS_MONAGHAN;
  const PetscBool implicit = (PetscBool)(sph->params.viscosity_solver == SPH_VISCOSITY_IMPLICIT ||
                                         (sph->params.viscosity_solver == SPH_VISCOSITY_AUTO && dt > (1.0 + 1e-9) * SPHViscousStep_Internal(sph)));
  PetscReal       loss;

  PetscFunctionBegin;
  Friction(sph);
  PetscCall(KeepVelocities(sph));
  sph->table->ViscousWeights(&sph->loops, central, sph->mu_pairs, sph->volume);
  if (implicit) {
    PetscCall(AddLastPressure(sph, dt));
    ByCall(SolveImplicit(sph, dt));
    PetscCall(AddLastPressure(sph, -dt));
    sph->table->Viscous(&sph->loops, central, sph->v_viscous, sph->accel);
  } else {
    sph->table->Viscous(&sph->loops, central, sph->v, sph->accel);
#pragma omp parallel for schedule(static)
    for (int i = 0; i < 3 * n; i++) sph->v_viscous[i] = (sph->v_star[i] + dt * (sph->accel[i] + sph->push[i])) / (1.0 + dt * sph->response[i / 3]);
  }

  // the velocity after it, and the energy that pairs and walls take from the flow
#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal sum = 0.0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal k = sph->response[i];

      sum += sph->rate[i];
      for (int q = 0; q < 3; q++) { // heat of friction: k |w - v_wall|^2
        const PetscReal w = sph->v_viscous[3 * i + q], a = sph->accel[3 * i + q] + sph->push[3 * i + q] - k * w;
        sph->v_star[3 * i + q] += dt * a;
        sum -= w * (a + sph->push[3 * i + q]);
      }
    }
    sph->partial[c * SPH_SUMS] = sum;
  }
  SPHSumPartials(sph, 1, &loss);
  sph->viscous_loss += sph->mass * dt * loss;
  PetscFunctionReturn(PETSC_SUCCESS);
}
