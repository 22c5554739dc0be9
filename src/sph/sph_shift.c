/* sph_shift.c - particle shifting: particles move a little down the gradient of their concentration, and take the velocity of where they arrive.

     dr_i = -s dt |grad v|_i h^2 grad C_i,  grad C_i = sum_j V weight grad W_ij + grad phi_i,  v_i += (grad v)_i dr_i
   [Lind, Xu, Stansby & Rogers 2012 eq. 23-28; Skillen, Lind, Stansby & Rogers 2013 eq. 25]. The rate of deformation |grad v| stands in the place of
   Skillen's |v|/h: what disorders particles is deformation, and nothing that moves like a rigid body or rests is shifted. At a free surface,
   where the neighbourhood is not full, nothing is shifted. */
#include <math.h>

#include "mat3.h"
#include "sph_impl.h"

#define SPH_SHIFT_STABLE 0.05 /* of h^2: a larger step of this explicit diffusion overshoots            */
#define SPH_SHIFT_MOST   0.2  /* longest shift in a step [dx]                                           */
#define SPH_SHIFT_FLAT   1.0  /* fullness below which particles are led aside                             */
#define SPH_SHIFT_NUDGE  3.0  /* [dx] per unit of strain of a neighbourhood without thickness             */
#define SPH_SHIFT_FULL   0.92 /* neighbourhoods less full than this are at a free surface                  */

/* a lattice that is strained stays even, grad C = 0, until lines of particles break up at once: where a neighbourhood has been flattened,
   each particle is led aside along a direction of its own, which breaks the symmetry while it is harmless */
static void Nudge(SPH sph, PetscInt i, PetscReal strain, PetscReal dr[3])
{
  const PetscReal part = SPH_SHIFT_NUDGE * sph->params.spacing * strain * PetscMax(0.0, 1.0 - sph->compact.fullness[i] / SPH_SHIFT_FLAT);

  for (int k = 0; k < 3; k++) dr[k] += part * sin(12.9898 * (double)sph->id[i] + 78.233 * k);
}

/* A particle whose velocity is not that of its surroundings is not seen by the divergence, and a shift along its own gradient would feed it:
   it is told by its deviation from the others, which a smooth flow makes small beside h times the local and half the rms |grad v| (0.05 in
   vortices of 16 dx), takes no shift's velocity, and is led back. 0 no stray, 1 a stray. */
static PetscReal Stray(PetscReal deviation, PetscReal expected)
{
  return expected > 0 ? PetscMin(1.0, PetscMax(0.0, 4.0 * deviation / expected - 1.0)) : 0.0;
}

/* rms of |grad v| [1/s] */
static PetscReal TypicalRate(SPH sph)
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  PetscReal sum;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s = 0;
    for (int k = 9 * SPH_FIRST(c); k < 9 * SPH_LAST(c, n); k++) s += PetscSqr(sph->compact.velocity_gradient[k]);
    sph->partial[c * SPH_SUMS] = s;
  }
  SPHSumPartials(sph, 1, &sum);
  return sqrt(sum / n);
}

/* no shift ends nearer to a plane than SPH_STOP_GAP; a particle that is nearer, drawn into a wall by suction, is shifted out */
static void KeepIn(SPH sph, const PetscReal x[3], PetscReal dr[3])
{
  const PetscReal gap = SPH_STOP_GAP * sph->params.spacing, most = SPH_SHIFT_MOST * sph->params.spacing;

  for (int k = 0; k < 6; k++) {
    PetscReal       sign;
    const PetscReal d = SPHPlaneDistance(sph, k, x, &sign);

    if (!(sph->walls >> k & 1) || d + sign * dr[k / 2] >= gap) continue;
    dr[k / 2] = sign * PetscMin(most, gap - d);
  }
}

PetscErrorCode SPHShift_Internal(SPH sph, PetscReal dt)
{
  SPHCompactWork *w    = &sph->compact;
  const int       n    = (int)sph->n;
  const PetscReal rho0 = sph->params.density, h2 = sph->h * sph->h, most = SPH_SHIFT_MOST * sph->params.spacing;
  PetscReal       typical;

  PetscFunctionBegin;
  if (sph->method != &SPHSolverISPH) PetscCall(SPHCompact_Internal(sph, sph->Adirection)); // isph has it from its solve
  SPHVelocityGradient_Internal(sph, sph->v, sph->accel);
  typical = TypicalRate(sph);
  sph->table->Concentration(&sph->loops, SPHKernelW(sph->params.kernel, sph->params.spacing, sph->h), w->shift);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    const PetscReal *L = w->velocity_gradient + 9 * i;
    PetscReal       *dr = w->shift + 3 * i, rate2 = 0, C[3], length, v[3];

    for (int k = 0; k < 9; k++) rate2 += L[k] * L[k];
    SPHWallConcentration_Internal(sph, i, C);
    for (int k = 0; k < 3; k++) C[k] += dr[k] / rho0;
    for (int k = 0; k < 3; k++) dr[k] = -PetscMin(sph->shifting * dt * sqrt(rate2), SPH_SHIFT_STABLE) * h2 * C[k];
    if (!sph->params.free_surface) Nudge(sph, i, dt * sqrt(rate2), dr);
    if (sph->params.free_surface && w->fullness[i] < SPH_SHIFT_FULL) dr[0] = dr[1] = dr[2] = 0.0;
    length = Norm3(dr);
    if (length > most)
      for (int k = 0; k < 3; k++) dr[k] *= most / length;
    KeepIn(sph, sph->x + 3 * i, dr);
    Mul3(L, dr, v);
    const PetscReal stray = Stray(Norm3(sph->accel + 3 * i), sph->h * (sqrt(rate2) + 0.5 * typical));
    for (int k = 0; k < 3; k++) {
      sph->x[3 * i + k] += dr[k];
      sph->v[3 * i + k] += (1.0 - stray) * v[k] - 0.2 * stray * sph->accel[3 * i + k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
