/* sph_gauge.c - what is measured in the fluid: values at a point, height of the water, energies and errors. */
#include <math.h>

#include "sph_impl.h"

/* displacement from x to particle i, through the nearest periodic image */
static void Displacement(SPH sph, int i, const PetscReal at[3], PetscReal d[3])
{
  for (int k = 0; k < 3; k++) {
    const PetscReal period = sph->loops.grid.period[k];
    d[k]                   = sph->x[3 * i + k] - at[k];
    if (period > 0) d[k] -= period * rint(d[k] / period);
  }
}

/* visit the particles of all cells that overlap the box at +- reach; particles may have moved by grid_drift since they were sorted */
void SPHVisitBox_Internal(SPH sph, const PetscReal at[3], const PetscReal reach[3], SPHVisit visit, void *ctx)
{
  const SPHGrid *g = &sph->loops.grid;
  int            lo[3], hi[3];

  for (int k = 0; k < 3; k++) {
    const PetscReal r = reach[k] + sph->grid_drift;
    PetscReal       a = floor((at[k] - r - g->lo[k]) / g->cell[k]), b = floor((at[k] + r - g->lo[k]) / g->cell[k]);

    if (g->periodic[k] && b - a + 1 >= g->n[k]) {
      a = 0;
      b = g->n[k] - 1;
    }
    if (!g->periodic[k]) {
      a = PetscMin(PetscMax(a, 0.0), g->n[k] - 1.0);
      b = PetscMin(PetscMax(b, 0.0), g->n[k] - 1.0);
    }
    lo[k] = (int)a;
    hi[k] = (int)b;
  }
  for (int z = lo[2]; z <= hi[2]; z++) {
    for (int y = lo[1]; y <= hi[1]; y++) {
      for (int x = lo[0]; x <= hi[0]; x++) {
        const int cx = ((x % g->n[0]) + g->n[0]) % g->n[0], cy = ((y % g->n[1]) + g->n[1]) % g->n[1], cz = ((z % g->n[2]) + g->n[2]) % g->n[2];
        const int c = cx + g->n[0] * (cy + g->n[1] * cz);
        for (int i = g->start[c]; i < g->start[c + 1]; i++) {
          PetscReal d[3];
          Displacement(sph, i, at, d);
          visit(sph, i, d, ctx);
        }
      }
    }
  }
}

typedef struct {
  PetscReal weight, pressure, velocity[3];
} PointSums;

static void AddPoint(SPH sph, int i, const PetscReal d[3], void *ctx)
{
  PointSums      *s = (PointSums *)ctx;
  const PetscReal w = SPHKernelW(sph->params.kernel, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), sph->h);

  s->weight += w;
  s->pressure += w * sph->p[i];
  for (int k = 0; k < 3; k++) s->velocity[k] += w * sph->v[3 * i + k];
}

/*@
  SPHInterpolate - pressure and velocity at a point, Shepard-normalised: sum V A W / sum V W [Yuan eq. 31]

  Output Parameters:
+ pressure - [Pa]
. velocity - [m/s], 3
- inside   - PETSC_FALSE where no fluid is within h; then both are zero
@*/
PetscErrorCode SPHInterpolate(SPH sph, const PetscReal at[3], PetscReal *pressure, PetscReal velocity[3], PetscBool *inside)
{
  const PetscReal reach[3] = {sph->h, sph->h, sph->h};
  PointSums       s        = {0, 0, {0, 0, 0}};

  PetscFunctionBegin;
  PetscCheck(sph->loops.capacity > 0, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "SPHUpdateNeighbors() comes first");
  SPHVisitBox_Internal(sph, at, reach, AddPoint, &s);
  *inside   = (PetscBool)(s.weight > 0);
  *pressure = s.weight > 0 ? s.pressure / s.weight : 0.0;
  for (int k = 0; k < 3; k++) velocity[k] = s.weight > 0 ? s.velocity[k] / s.weight : 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* axis along which gravity acts most; z without gravity */
static int VerticalAxis(SPH sph)
{
  int axis = 2;

  for (int k = 0; k < 3; k++)
    if (PetscAbsReal(sph->gravity[k]) > PetscAbsReal(sph->gravity[axis])) axis = k;
  return axis;
}

/* weight of a horizontal distance in a column: cubic B-spline, without its norm, which divides out */
static PetscReal ColumnWeight(PetscReal q) { return q >= 1 ? 0.0 : q < 0.5 ? 1.0 - 6.0 * q * q * (1.0 - q) : 2.0 * (1.0 - q) * (1.0 - q) * (1.0 - q); }

typedef struct {
  int       axis;
  PetscReal sum;
} ColumnSum;

static void AddColumn(SPH sph, int i, const PetscReal d[3], void *ctx)
{
  ColumnSum *s  = (ColumnSum *)ctx;
  PetscReal  r2 = 0.0;

  (void)i;
  for (int k = 0; k < 3; k++)
    if (k != s->axis) r2 += d[k] * d[k];
  s->sum += ColumnWeight(sqrt(r2) / sph->h);
}

/*@
  SPHGetHeight - depth of water [m] in the column of radius h around a point, along the axis of gravity

  The volume of the fluid in the column over its cross-section, weighted by a spline of radius h; the part of the cross-section
  beyond planar walls does not count. Bodies in the column count as missing water.
@*/
PetscErrorCode SPHGetHeight(SPH sph, const PetscReal at[3], PetscReal *height)
{
  const int axis = VerticalAxis(sph), u = (axis + 1) % 3, w = (axis + 2) % 3, m = 24;
  PetscReal reach[3] = {sph->h, sph->h, sph->h}, area = 0.0;
  ColumnSum s        = {axis, 0.0};

  PetscFunctionBegin;
  PetscCheck(sph->loops.capacity > 0, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "SPHUpdateNeighbors() comes first");
  reach[axis] = (sph->loops.grid.n[axis] + 2) * sph->loops.grid.cell[axis] + PetscAbsReal(at[axis] - sph->loops.grid.lo[axis]);
  SPHVisitBox_Internal(sph, at, reach, AddColumn, &s);

  // integral of the weight over the part of the cross-section that is in the domain, by the midpoint rule on m x m squares
  for (int b = 0; b < m; b++) {
    for (int a = 0; a < m; a++) {
      const PetscReal du = (2.0 * (a + 0.5) / m - 1.0) * sph->h, dw = (2.0 * (b + 0.5) / m - 1.0) * sph->h;
      const PetscReal pu = at[u] + du, pw = at[w] + dw;
      const int       beyond = ((sph->walls >> (2 * u) & 1) && pu < sph->plane[2 * u]) || ((sph->walls >> (2 * u + 1) & 1) && pu > sph->plane[2 * u + 1]) ||
                         ((sph->walls >> (2 * w) & 1) && pw < sph->plane[2 * w]) || ((sph->walls >> (2 * w + 1) & 1) && pw > sph->plane[2 * w + 1]);
      if (!beyond) area += ColumnWeight(sqrt(du * du + dw * dw) / sph->h);
    }
  }
  area *= PetscSqr(2.0 * sph->h / m);
  *height = area > 0 ? s.sum * sph->mass / sph->params.density / area : 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AddPart(SPH sph, int i, const PetscReal d[3], void *ctx)
{
  (void)i;
  *(PetscReal *)ctx += SPHKernelW(sph->params.kernel, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), sph->h);
}

/* part of the kernel's volume around a place that is full: of fluid, or beyond the floor; what is beyond the other walls does not count */
static PetscReal FullPart(SPH sph, const PetscReal at[3], int floor_plane)
{
  const PetscReal reach[3] = {sph->h, sph->h, sph->h};
  PetscReal       sum = 0.0, open = 1.0, below = 0.0;

  SPHVisitBox_Internal(sph, at, reach, AddPart, &sum);
  for (int k = 0; k < 6; k++) {
    PetscReal sign, part;

    if (!(sph->walls >> k & 1)) continue;
    part = SPHHalfSpace(sph->params.kernel, SPHPlaneDistance(sph, k, at, &sign), sph->h);
    if (k == floor_plane) below = part;
    else open *= 1.0 - part;
  }
  return sum * sph->mass / sph->params.density / PetscMax(open, 0.05) + below;
}

/*@
  SPHGetSurface - height of the free surface [m] above the floor of the domain: the first place, upwards from `at`, where the part of the
  kernel's volume that is fluid falls below one half

  Of a column that has splashes this is the surface of what stands on the floor; SPHGetHeight() is its whole volume over its area. A film
  thinner than a spacing or two is found as well as the particles stand for it. 0 where `at` is dry. Above a body put `at` on its top.
@*/
PetscErrorCode SPHGetSurface(SPH sph, const PetscReal at[3], PetscReal *height)
{
  const SPHGrid  *g    = &sph->loops.grid;
  const int       axis = VerticalAxis(sph), falls = sph->gravity[axis] > 0, floor_plane = 2 * axis + falls; // gravity along +axis: the floor is at max
  const PetscReal up   = falls ? -1.0 : 1.0, step = 0.125 * sph->h;
  const PetscReal floor_at = falls ? sph->max[axis] : sph->has_domain ? sph->min[axis] : g->lo[axis];
  PetscReal       x[3] = {at[0], at[1], at[2]}, part, next;
  const PetscInt  n    = (PetscInt)(((g->n[axis] + 2) * g->cell[axis] + PetscAbsReal(at[axis] - g->lo[axis]) + sph->h) / step);

  PetscFunctionBegin;
  PetscCheck(sph->loops.capacity > 0, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "SPHUpdateNeighbors() comes first");
  *height = 0.0;
  if (up * (x[axis] - floor_at) < 0) x[axis] = floor_at;
  part = FullPart(sph, x, floor_plane);
  for (PetscInt k = 0; k < n && part >= 0.5 - 1e-12; k++, part = next) {
    x[axis] += up * step;
    next    = FullPart(sph, x, floor_plane);
    *height = up * (x[axis] - floor_at);
    if (next < 0.5) *height -= step * (0.5 - next) / (part - next);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHGetStats - energies, momenta, density errors of the current state, and the last pressure solve

  Density is that of the last SPHPredict(); potential energy is - m g . x, with g as
  seen from the tank. Kinetic, potential and lost energy grow by what walls, tank and bodies do on the fluid.
@*/
PetscErrorCode SPHGetStats(SPH sph, SPHStats *stats)
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal m = sph->mass, rho0 = sph->params.density;
  PetscReal       most = 0.0, fastest = 0.0, first[SPH_SUMS], second[1];

  PetscFunctionBegin;
  for (int pass = 0; pass < 2; pass++) {
#pragma omp parallel for schedule(static) reduction(max : most, fastest)
    for (int c = 0; c < chunks; c++) {
      PetscReal s[SPH_SUMS] = {0};

      for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
        const PetscReal *x = sph->x + 3 * i, *v = sph->v + 3 * i, *g = sph->gravity_now;
        const PetscReal  v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        const PetscReal  excess = sph->kind && sph->kind[i] != SPH_FREE ? 0.0 : PetscMax(0.0, sph->rho[i] / rho0 - 1.0); // beyond openings nothing looks after it

        if (pass == 1) {
          s[0] += excess;
          continue;
        }
        s[0] += v2;
        s[1] -= g[0] * x[0] + g[1] * x[1] + g[2] * x[2];
        for (int k = 0; k < 3; k++) s[2 + k] += v[k];
        s[5] += x[1] * v[2] - x[2] * v[1];
        s[6] += x[2] * v[0] - x[0] * v[2];
        s[7] += x[0] * v[1] - x[1] * v[0];
        most    = PetscMax(most, excess);
        fastest = PetscMax(fastest, v2);
      }
      for (int k = 0; k < SPH_SUMS; k++) sph->partial[c * SPH_SUMS + k] = s[k];
    }
    if (pass == 0) SPHSumPartials(sph, SPH_SUMS, first);
    else SPHSumPartials(sph, 1, second);
  }
  stats->kinetic   = 0.5 * m * first[0];
  stats->potential = m * first[1];
  for (int k = 0; k < 3; k++) {
    stats->momentum[k]   = m * first[2 + k];
    stats->angular[k]    = m * first[5 + k];
    stats->body_force[k] = sph->body_force[k];
  }
  stats->particles        = n;
  stats->compression_mean = second[0] / PetscMax(1, n);
  stats->compression_max  = most;
  stats->speed_max        = sqrt(fastest);
  stats->speed_rms        = sqrt(first[0] / PetscMax(1, n));
  stats->viscous_loss     = sph->viscous_loss;
  stats->wall_work        = sph->wall_work;
  stats->frame_work       = sph->frame_work;
  stats->iterations       = sph->iterations_before + sph->iterations;
  stats->viscous_solves     = sph->viscous_solves;
  stats->viscous_iterations = sph->viscous_iterations;
  stats->converged        = sph->converged;
  PetscFunctionReturn(PETSC_SUCCESS);
}
