/* sph_patch.c - what is measured on a rectangle: pressure on a part of a planar wall, flow through an opening.

   A particle at distance d from a plane acts on it through its kernel's cross-section, W(sqrt(d^2 + t^2)) at tangential distance t, whose
   integral over the plane is A(d) = -lambda'(d). The part of the section inside a rectangle, over the part inside the walls that bound
   the plane, is the part of its force that the rectangle carries: rectangles that cover a wall carry the wall's force. */
#include <math.h>

#include "sph_impl.h"

#define CUTS 16 /* squares along each side of the midpoint rule: parts within 2e-3 */

/* integral of W(sqrt(d^2 + u^2 + w^2)) over lo < (u, w) < hi by the midpoint rule */
static PetscReal SectionIntegral(SPH sph, PetscReal d, const PetscReal lo[2], const PetscReal hi[2])
{
  const PetscReal du = (hi[0] - lo[0]) / CUTS, dw = (hi[1] - lo[1]) / CUTS;
  PetscReal       sum = 0.0;

  for (int b = 0; b < CUTS; b++) {
    const PetscReal w = lo[1] + (b + 0.5) * dw;
    for (int a = 0; a < CUTS; a++) {
      const PetscReal u = lo[0] + (a + 0.5) * du;
      sum += SPHKernelW(sph->params.kernel, sqrt(d * d + u * u + w * w), sph->h);
    }
  }
  return sum * du * dw;
}

/* part of the section of a particle at `at`, distance d from the plane across `axis`, that lies in the rectangle lo..hi; 0 to 1 */
static PetscReal SectionPart(SPH sph, int axis, PetscReal d, const PetscReal at[3], const PetscReal lo[3], const PetscReal hi[3])
{
  const PetscReal radius = sqrt(PetscMax(0.0, sph->h * sph->h - d * d));
  PetscReal       all_lo[2], all_hi[2], in_lo[2], in_hi[2];
  PetscBool       whole = PETSC_TRUE;

  for (int k = 0; k < 2; k++) {
    const int a = (axis + 1 + k) % 3;

    // the section's square, cut by walls, then by the rectangle
    all_lo[k] = (sph->walls >> (2 * a) & 1) ? PetscMax(-radius, sph->min[a] - at[a]) : -radius;
    all_hi[k] = (sph->walls >> (2 * a + 1) & 1) ? PetscMin(radius, sph->max[a] - at[a]) : radius;
    in_lo[k]  = PetscMax(all_lo[k], lo[a] - at[a]);
    in_hi[k]  = PetscMin(all_hi[k], hi[a] - at[a]);
    if (!(in_hi[k] > in_lo[k])) return 0.0;
    if (in_lo[k] > all_lo[k] || in_hi[k] < all_hi[k]) whole = PETSC_FALSE;
  }
  if (whole) return 1.0;
  const PetscReal all = SectionIntegral(sph, d, all_lo, all_hi);
  return all > 0 ? PetscMin(1.0, SectionIntegral(sph, d, in_lo, in_hi) / all) : 0.0;
}

/* the same over the periodic images of the particle along the plane */
static PetscReal SectionParts(SPH sph, int axis, PetscReal d, const PetscReal at[3], const PetscReal lo[3], const PetscReal hi[3])
{
  const int       u = (axis + 1) % 3, w = (axis + 2) % 3, nu = (int)(sph->periodic >> u & 1), nw = (int)(sph->periodic >> w & 1);
  PetscReal       part = 0.0, image[3] = {at[0], at[1], at[2]};

  for (int a = -nu; a <= nu; a++) {
    for (int b = -nw; b <= nw; b++) {
      image[u] = at[u] + a * (sph->max[u] - sph->min[u]);
      image[w] = at[w] + b * (sph->max[w] - sph->min[w]);
      part += SectionPart(sph, axis, d, image, lo, hi);
    }
  }
  return PetscMin(1.0, part);
}

/*@
  SPHAddPatch - watch the pressure on a rectangle of a planar wall, from the next step on

  Input Parameters:
+ sph      - the fluid, with its domain
. wall     - 0..5 for xmin xmax ymin ymax zmin zmax
- min, max - corners of a box [m]; its extent along the wall counts, less what is beyond the wall's own edges

  Output Parameter:
. patch - its number, for SPHGetPatch()

  Errors:
  PETSC_ERR_ARG_OUTOFRANGE when the side is no wall; a rectangle beside the wall has no area: SPHGetPatch() tells
@*/
PetscErrorCode SPHAddPatch(SPH sph, PetscInt wall, const PetscReal min[3], const PetscReal max[3], PetscInt *patch)
{
  SPHPatch *p;

  PetscFunctionBegin;
  PetscCheck(wall >= 0 && wall < 6 && (sph->walls >> wall & 1), PetscObjectComm((PetscObject)sph), PETSC_ERR_ARG_OUTOFRANGE, "side %d of the domain is not a wall", (int)wall);
  PetscCall(PetscRealloc(sizeof(SPHPatch) * (size_t)(sph->n_patches + 1), &sph->patches));
  *patch  = sph->n_patches++;
  p       = &sph->patches[*patch];
  p->wall = (int)wall;
  p->area = 1.0;
  p->force = 0.0;
  for (int k = 0; k < 3; k++) {
    p->min[k] = PetscMax(min[k], sph->min[k]);
    p->max[k] = PetscMin(max[k], sph->max[k]);
    if (k != wall / 2) p->area *= PetscMax(0.0, p->max[k] - p->min[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHGetPatch - force of the fluid on a patch along the wall's outward normal in the last step, stops at the wall included

  Output Parameters (each may be NULL):
+ force - [N], positive when the fluid presses; force over area is the mean pressure
- area  - [m^2] of the rectangle on the wall
@*/
PetscErrorCode SPHGetPatch(SPH sph, PetscInt patch, PetscReal *force, PetscReal *area)
{
  PetscFunctionBegin;
  PetscCheck(patch >= 0 && patch < sph->n_patches, PetscObjectComm((PetscObject)sph), PETSC_ERR_ARG_OUTOFRANGE, "patch %d of %d", (int)patch, (int)sph->n_patches);
  if (force) *force = sph->patches[patch].force;
  if (area) *area = sph->patches[patch].area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* force of pressure on all patches, for the current positions; called wherever the forces on planes are found */
void SPHPatchForces_Internal(SPH sph)
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);

  for (PetscInt q = 0; q < sph->n_patches; q++) {
    SPHPatch *p    = &sph->patches[q];
    const int axis = p->wall / 2;

#pragma omp parallel for schedule(static)
    for (int c = 0; c < chunks; c++) {
      PetscReal force = 0.0;

      for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
        PetscReal       sign;
        const PetscReal d = SPHPlaneDistance(sph, p->wall, sph->x + 3 * i, &sign);

        if (d >= sph->h || sph->p[i] == 0.0) continue;
        const PetscReal part = SectionParts(sph, axis, d, sph->x + 3 * i, p->min, p->max);
        if (part > 0) force -= sign * part * SPHPlanePressure_Internal(sph, i, p->wall);
      }
      sph->partial[c * SPH_SUMS] = force;
    }
    SPHSumPartials(sph, 1, &p->force);
  }
}

/* what a particle that is stopped at a wall adds: impulse [N s] over dt along the outward normal; one thread at a time */
void SPHPatchStop_Internal(SPH sph, int wall, int i, PetscReal force)
{
  for (PetscInt q = 0; q < sph->n_patches; q++) {
    SPHPatch *p = &sph->patches[q];

    if (p->wall == wall) p->force += force * SectionParts(sph, wall / 2, 0.0, sph->x + 3 * i, p->min, p->max);
  }
}

/*@
  SPHGetFlowRate - volume that flows through a rectangle across an axis [m^3/s], positive along the axis, for the current state

  Input Parameters:
+ sph      - the fluid, sorted
. axis     - 0, 1, 2: normal of the rectangle
. min, max - corners [m]; the plane is at min[axis]

  Equation:
  Q = sum_j (m/rho0) v_j . n A(d_j) s_j,  A(d) = int W dA over the plane at distance d, s_j the part of that section in the rectangle

  Along a particle's way int A(d) v . n dt = 1: each volume is counted once as it crosses, spread over its kernel, so that the integral over
  time is the volume that has crossed, exactly. Counting crossings gives the same in spikes of a particle each.
@*/
PetscErrorCode SPHGetFlowRate(SPH sph, PetscInt axis, const PetscReal min[3], const PetscReal max[3], PetscReal *rate)
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal period = (sph->periodic >> axis & 1) ? sph->max[axis] - sph->min[axis] : 0.0;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal sum = 0.0;

    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal *x = sph->x + 3 * i;
      PetscReal        d = x[axis] - min[axis];

      if (period > 0) d -= period * rint(d / period);
      d = PetscAbsReal(d);
      if (d >= sph->h) continue;
      sum += sph->v[3 * i + axis] * SPHPlaneDensity(sph->params.kernel, d, sph->h) * SectionParts(sph, (int)axis, d, x, min, max);
    }
    sph->partial[c * SPH_SUMS] = sum;
  }
  SPHSumPartials(sph, 1, rate);
  *rate *= sph->mass / sph->params.density;
  PetscFunctionReturn(PETSC_SUCCESS);
}
