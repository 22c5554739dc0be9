/* sph_smooth.c - what position-based fluids do to velocities [Macklin & Mueller, ACM TOG 32 (2013) 104, sec. 5], for every solver that asks: XSPH
   (sph.xsph) and vorticity confinement (sph.vorticity_confinement). The paper applies both when a step has ended; here they open the next one, with the
   neighbours that particles have then.

   XSPH keeps momentum pair by pair. The force of confinement does not by itself: N x omega of a particle has no counterpart at another. Its mean over all
   particles is taken off. Neither keeps angular momentum. */
#include <math.h>

#include "sph_impl.h"

/* v* += c sum_j V (v_j - v_i) W_ij */
PetscErrorCode SPHSmoothPredict_Internal(SPH sph)
{
  PetscFunctionBegin;
  sph->table->SetVelocity(&sph->loops, sph->v);
  sph->table->Smooth(&sph->loops, sph->params.xsph, sph->v_star);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* omega_i = sum_j V grad W_ij x (v_j - v_i), component by component as the rate of a field: (grad x v)_x = sum (a_j - a_i) . grad W with a = (0, v_z, -v_y) */
static void Vorticity(SPH sph, PetscReal omega[])
{
  const int       n      = (int)sph->n;
  const PetscReal volume = 1.0 / sph->params.density; // gradients carry the mass

  for (int k = 0; k < 3; k++) {
    const int y = (k + 1) % 3, z = (k + 2) % 3;

#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++) {
      sph->accel[3 * i + k] = 0.0;
      sph->accel[3 * i + y] = sph->v[3 * i + z];
      sph->accel[3 * i + z] = -sph->v[3 * i + y];
    }
    sph->table->SetVelocity(&sph->loops, sph->accel);
    sph->table->Rate(&sph->loops, 1.0, NULL, sph->residual);

    // without the walls' part
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++) {
      const PetscReal wall = sph->accel[3 * i + y] * sph->G[3 * i + y] + sph->accel[3 * i + z] * sph->G[3 * i + z];
      omega[3 * i + k]     = -volume * (sph->residual[i] - wall);
    }
  }
}

/* eta_i = sum_j V (|omega_j| - |omega_i|) grad W_ij from two pressure accelerations, -D^T s and -D^T 1: s_i (-D^T 1)_i - (-D^T s)_i */
static void Slope(SPH sph, const PetscReal omega[], PetscReal eta[])
{
  const int       n      = (int)sph->n;
  const PetscReal volume = 1.0 / sph->params.density;

  for (int pass = 0; pass < 2; pass++) {
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++) {
      const PetscReal *w = omega + 3 * i;
      sph->residual[i]   = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
      sph->p_tilde[i]    = pass ? sph->residual[i] : 1.0;
    }
    sph->table->SetPressure(&sph->loops, sph->p_tilde, NULL);
    sph->table->Acceleration(&sph->loops);
    sph->table->GetVector(&sph->loops, sph->accel);
#pragma omp parallel for schedule(static)
    for (int i = 0; i < 3 * n; i++) eta[i] = pass ? eta[i] - volume * sph->accel[i] : volume * sph->residual[i / 3] * sph->accel[i];
  }
}

/* v* += dt (a - mean of a), a = epsilon N x omega */
PetscErrorCode SPHConfinePredict_Internal(SPH sph, PetscReal dt)
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal epsilon = sph->params.vorticity_confinement;
  PetscReal      *omega = sph->confine, *eta = sph->confine + 3 * (size_t)n, mean[3];

  PetscFunctionBegin;
  Vorticity(sph, omega);
  Slope(sph, omega, eta);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal sum[3] = {0, 0, 0};

    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      SPHConfinement(epsilon, eta + 3 * i, omega + 3 * i, sph->accel + 3 * i);
      for (int k = 0; k < 3; k++) sum[k] += sph->accel[3 * i + k];
    }
    for (int k = 0; k < 3; k++) sph->partial[c * SPH_SUMS + k] = sum[k];
  }
  SPHSumPartials(sph, 3, mean);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < 3 * n; i++) sph->v_star[i] += dt * (sph->accel[i] - mean[i % 3] / n);
  PetscFunctionReturn(PETSC_SUCCESS);
}
