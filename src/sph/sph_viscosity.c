/* sph_viscosity.c - viscosity between particles, explicit, and the friction of no-slip walls, implicit (method 1); the noise filter. */
#include "sph_impl.h"

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

/* v* += dt (viscous acceleration of v), then friction with every wall at once, implicitly, so that a particle close to a wall
   takes the wall's velocity instead of overshooting it:  v* = (v* + dt sum_k k_k v_k)/(1 + dt sum_k k_k) */
PetscErrorCode SPHViscousPredict_Internal(SPH sph, PetscReal dt)
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal rho0 = sph->params.density;
  const PetscBool moving = SPHPlanesMove_Internal(sph);
  PetscReal       loss;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(sph->accel, 3 * n));
  sph->table->SetVelocity(&sph->loops, sph->v);
  sph->table->Viscosity(&sph->loops, sph->params.viscous_form == SPH_VISCOUS_MONAGHAN ? SPH_PAIRS_MONAGHAN : SPH_PAIRS_MORRIS, sph->mu_pairs / (rho0 * rho0), sph->accel);

  // sum of k and of k v_wall; walls that move have given their part to v* before the division
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    sph->response[i] = sph->friction_planes[i] * sph->open_surfaces[i];
    for (int q = 0; q < 3; q++) sph->v_star[3 * i + q] += dt * sph->accel[3 * i + q];
  }
  for (PetscInt s = 0; s < sph->n_surfaces; s++) {
    const SPHContacts *c = &sph->contacts[s];
#pragma omp parallel for schedule(static)
    for (PetscInt t = 0; t < c->n_touched; t++) {
      const PetscInt   i = c->particle[t];
      const PetscReal *g = c->grad + 3 * t, g2 = g[0] * g[0] + g[1] * g[1] + g[2] * g[2], k = sph->surfaces[s].friction[t];

      sph->response[i] += k;
      for (PetscInt b = c->start[t]; c->velocity && g2 > 0 && b < c->start[t + 1]; b++) {
        const PetscReal *share = c->share + 3 * b, *v = c->velocity + 3 * c->proxy[b];
        const PetscReal  weight = (share[0] * g[0] + share[1] * g[1] + share[2] * g[2]) / g2;
        for (int q = 0; q < 3; q++) sph->v_star[3 * i + q] += dt * k * weight * v[q];
      }
    }
  }

  // implicit friction; energy that pairs and walls take from the flow
#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal sum = 0.0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal k = sph->response[i];
      PetscReal       drag[3] = {0, 0, 0};

      if (moving) sum += SPHPlaneDrag_Internal(sph, i, drag);
      for (int q = 0; q < 3; q++) {
        sph->v_star[3 * i + q] = (sph->v_star[3 * i + q] + dt * drag[q]) / (1.0 + dt * k);
        sum -= sph->v_star[3 * i + q] * (sph->accel[3 * i + q] - k * sph->v_star[3 * i + q] + 2.0 * drag[q]);
      }
    }
    sph->partial[c * SPH_SUMS] = sum;
  }
  SPHSumPartials(sph, 1, &loss);
  sph->viscous_loss += sph->mass * dt * loss;
  PetscFunctionReturn(PETSC_SUCCESS);
}
