/* sph_stop.c - no particle ends a step inside a wall. Pressure keeps a fluid out, but it answers to density: a lone particle at impact
   speed can still end a step inside by a tenth of dx. Where the step would end nearer than SPH_STOP_GAP dx, the normal velocity relative to
   the wall is cut so that it ends there (a plastic impact), and the wall gets the opposite impulse. Still water never comes so near. Walls
   that move are met where they end the step. The coupler does the same at the triangles of bodies (coupler_stop.c). */
#include "sph_impl.h"

#define SPH_STOP_BACK 0.1  /* part of a penetration that is taken back in one step        */

/* what the speed away from a wall at distance `gap` at the start of the step lacks for the step to end at the stop; 0 when nothing */
static PetscReal Lacking(SPH sph, PetscReal gap, PetscReal speed, PetscReal dt)
{
  const PetscReal stop  = SPH_STOP_GAP * sph->params.spacing;
  const PetscReal least = gap >= stop ? (stop - gap) / dt : SPH_STOP_BACK * (stop - gap) / dt;
  return PetscMax(0.0, least - speed);
}

/* what the stops at the planes add to the patches that are watched */
static void StopAtPatches(SPH sph, PetscReal dt)
{
  for (int i = 0; i < (int)sph->n; i++) {
    for (int k = 0; k < 6; k++) {
      PetscReal sign, gap, lacking;

      if (!(sph->walls >> k & 1)) continue;
      gap     = SPHPlaneDistance(sph, k, sph->x + 3 * i, &sign);
      lacking = Lacking(sph, gap, sign * sph->v[3 * i + k / 2], dt);
      if (lacking > 0) SPHPatchStop_Internal(sph, k, i, sph->mass * lacking / dt);
    }
  }
}

/* stop at the planes, before x moves; the impulse goes into wall_force */
void SPHStopAtPlanes_Internal(SPH sph, PetscReal dt)
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  PetscReal sums[6];

  if (!sph->walls) return;
  if (sph->n_patches) StopAtPatches(sph, dt);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal *impulse = sph->partial + c * SPH_SUMS;

    for (int k = 0; k < 6; k++) impulse[k] = 0.0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      for (int k = 0; k < 6; k++) {
        PetscReal sign, gap, lacking;

        if (!(sph->walls >> k & 1) || (sph->n_openings && SPHOpenSolid_Internal(sph, k, sph->x + 3 * i) < 0.5)) continue;
        gap     = SPHPlaneDistance(sph, k, sph->x + 3 * i, &sign);
        lacking = Lacking(sph, gap, sign * (sph->v[3 * i + k / 2] - sph->plane_velocity[3 * k + k / 2]), dt);
        sph->v[3 * i + k / 2] += sign * lacking;
        impulse[k] -= sign * lacking;
      }
    }
  }
  SPHSumPartials(sph, 6, sums);
  for (int k = 0; k < 6; k++) sph->wall_force[3 * k + k / 2] += sph->mass * sums[k] / dt;
}
