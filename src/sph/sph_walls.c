/* sph_walls.c - planes and surfaces reduced to phi and its gradient at every particle (method 2), and the forces on them.

   Union of planes k and surfaces s:  1 - phi_i = prod_k (1 - phi_ik) prod_s (1 - phi_is)
     grad phi_i = sum_k c_ik grad phi_ik,  c_ik = product of (1 - phi) over all the others
   Planes of one axis have no part of the kernel in common, so that theirs add: prod_k over planes is prod over axes (1 - phi_min - phi_max).
   Between axes the product errs by up to 0.0016 at an edge and 0.0042 in a corner (against the true volume beyond two or three planes), which
   moves the wetted surface there by 0.003 and 0.008 dx: less than its scatter. The pressure solve thus sees one vector G_i = rho0 grad phi_i,
   whatever there is around. */
#include <math.h>

#include "sph_impl.h"

/* phi_k of the planes that a particle at x touches, where they are `later` after the step's beginning, and the slope along the axis; returns how many */
static int TouchedPlanesLater(SPH sph, PetscReal later, const PetscReal x[3], int plane[6], PetscReal phi[6], PetscReal slope[6], PetscReal distance[6])
{
  int n = 0;

  for (int k = 0; k < 6; k++) {
    PetscReal sign, d;

    if (!(sph->walls >> k & 1)) continue;
    d = SPHPlaneDistance(sph, k, x, &sign);
    d -= sign * later * sph->plane_velocity[3 * k + k / 2];
    if (d >= sph->h) continue;
    plane[n]    = k;
    phi[n]      = PetscMin(1.0, sph->wall_factor * SPHHalfSpace(sph->params.kernel, d, sph->h));
    slope[n]    = sign * sph->wall_factor * SPHHalfSpaceSlope(sph->gradient_kernel, d, sph->h);
    distance[n] = d;
    if (sph->n_openings) {
      const PetscReal solid = SPHOpenSolid_Internal(sph, k, x);
      phi[n] *= solid;
      slope[n] *= solid;
    }
    n++;
  }
  return n;
}

static int TouchedPlanes(SPH sph, const PetscReal x[3], int plane[6], PetscReal phi[6], PetscReal slope[6], PetscReal distance[6])
{
  return TouchedPlanesLater(sph, 0.0, x, plane, phi, slope, distance);
}

/* what the planes of every axis but one leave open; axis -1: all */
static PetscReal OpenBut(int n, const int plane[], const PetscReal phi[], int axis)
{
  PetscReal open[3] = {1.0, 1.0, 1.0};

  for (int m = 0; m < n; m++) open[plane[m] / 2] -= phi[m];
  if (axis >= 0) open[axis] = 1.0;
  return PetscMax(0.0, open[0]) * PetscMax(0.0, open[1]) * PetscMax(0.0, open[2]);
}

/* what the other walls leave of a wall's part in G: with images their flux is folded back, nothing is lost */
static PetscReal FluxPart(SPH sph, PetscReal others) { return sph->wall_flux == 1.0 ? others : 1.0; }

/* A particle deep in a wall is a particle at distance `least` for friction: the first layer settles at 0.15 to 0.25 dx */
static PetscReal FrictionDistance(SPH sph, PetscReal d) { return PetscMax(d, 0.1 * sph->params.spacing); }

PetscErrorCode SPHFindPlanes_Internal(SPH sph)
{
  const int       n    = (int)sph->n;
  const PetscReal rho0 = sph->params.density, nu = sph->params.viscosity / rho0;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    int        plane[6];
    PetscReal  phi[6], slope[6], d[6], G[3] = {0, 0, 0}, friction = 0.0;
    const int  touched = TouchedPlanes(sph, sph->x + 3 * i, plane, phi, slope, d);

    for (int k = 0; k < touched; k++) {
      const PetscReal c = OpenBut(touched, plane, phi, plane[k] / 2);
      G[plane[k] / 2] += sph->wall_flux * rho0 * FluxPart(sph, c) * slope[k];
      if (!(sph->slip >> plane[k] & 1)) friction += SPHWallFriction(nu, c * PetscAbsReal(slope[k]), FrictionDistance(sph, d[k]));
    }
    sph->open[i]          = OpenBut(touched, plane, phi, -1);
    sph->open_surfaces[i] = 1.0;
    for (int k = 0; k < 3; k++) sph->G[3 * i + k] = sph->G_planes[3 * i + k] = G[k];
    sph->wall_rate[i]     = 0.0;
    if (sph->friction_planes) sph->friction_planes[i] = friction;
  }
  sph->table->SetWalls(&sph->loops, sph->G);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SPHPlanesMove_Internal(SPH sph)
{
  PetscBool move = PETSC_FALSE;

  for (int k = 0; k < 6; k++) move = (PetscBool)(move || (sph->motion[k] && (sph->walls >> k & 1)));
  return move;
}

/* what planes that move give one particle: friction times velocity [m/s^2], times velocity again, and the density rate [kg/(m^3 s)] */
static PetscReal FromPlanes(SPH sph, int i, PetscReal drag[3], PetscReal *power)
{
  const PetscReal rho0 = sph->params.density, nu = sph->params.viscosity / rho0;
  PetscReal       phi[6], slope[6], d[6], rate = 0.0;
  int             plane[6];
  const int       touched = TouchedPlanes(sph, sph->x + 3 * i, plane, phi, slope, d);

  for (int k = 0; k < touched; k++) {
    const PetscReal *v = sph->plane_velocity + 3 * plane[k], c = OpenBut(touched, plane, phi, plane[k] / 2) * sph->open_surfaces[i];

    rate += sph->wall_flux * rho0 * FluxPart(sph, c) * slope[k] * v[plane[k] / 2];
    if (!drag || sph->slip >> plane[k] & 1) continue;
    const PetscReal friction = SPHWallFriction(nu, c * PetscAbsReal(slope[k]), FrictionDistance(sph, d[k]));
    for (int a = 0; a < 3; a++) {
      drag[a] += friction * v[a];
      *power += friction * v[a] * v[a];
    }
  }
  return rate;
}

PetscReal SPHPlaneDrag_Internal(SPH sph, int i, PetscReal drag[3])
{
  PetscReal power = 0.0;

  for (int a = 0; a < 3; a++) drag[a] = 0.0;
  (void)FromPlanes(sph, i, drag, &power);
  return power;
}

void SPHPlanesAt_Internal(SPH sph, PetscReal dt, const PetscReal x[3], PetscReal *open, PetscReal part[6])
{
  PetscReal phi[6], slope[6], d[6];
  int       plane[6];
  const int touched = TouchedPlanesLater(sph, dt, x, plane, phi, slope, d);

  *open = OpenBut(touched, plane, phi, -1);
  for (int k = 0; k < 6; k++) part[k] = 0.0;
  for (int k = 0; k < touched; k++) {
    part[plane[k]] = sph->params.density * OpenBut(touched, plane, phi, plane[k] / 2) * slope[k];
  }
}

PetscReal SPHSurfacesAt_Internal(SPH sph, int i, PetscReal dt, const PetscReal x[3], const PetscReal solid[3])
{
  const PetscReal planes = sph->open[i] / PetscMax(sph->open_surfaces[i], 1e-12);
  PetscReal       rate   = -dt * sph->wall_rate[i];

  if (SPHPlanesMove_Internal(sph)) rate += dt * FromPlanes(sph, i, NULL, NULL);
  for (int k = 0; k < 3; k++) rate += solid[k] * (x[k] - sph->x[3 * i + k]);
  return PetscMin(1.0, PetscMax(0.0, sph->open_surfaces[i] - rate / (sph->params.density * PetscMax(planes, 1e-12))));
}

static PetscErrorCode AllocateSurfaces(SPH sph, PetscInt n, const SPHContacts contacts[])
{
  PetscFunctionBegin;
  if (n > sph->surfaces_allocated) {
    PetscCall(PetscRealloc(sizeof(SPHSurfaceWork) * (size_t)n, &sph->surfaces));
    PetscCall(PetscArrayzero(sph->surfaces + sph->surfaces_allocated, n - sph->surfaces_allocated));
    sph->surfaces_allocated = n;
  }
  for (PetscInt s = 0; s < n; s++) {
    SPHSurfaceWork *w = &sph->surfaces[s];
    if (contacts[s].n_touched <= w->capacity) continue;
    w->capacity = contacts[s].n_touched + contacts[s].n_touched / 2;
    PetscCall(PetscFree2(w->union_factor, w->friction));
    PetscCall(PetscMalloc2(w->capacity, &w->union_factor, w->capacity, &w->friction));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* distance [m] of touched particle t from its surface, as lambda tells it */
PetscReal SPHSurfaceDistance_Internal(SPH sph, const SPHContacts *contacts, PetscInt t)
{
  return sph->h * SPHHalfSpaceDistance(sph->params.kernel, contacts->phi[t] / sph->wall_factor);
}

/* pressure [Pa] of particle i at a wall at distance d along the unit vector -n */
static PetscReal WallPressure(SPH sph, PetscInt i, PetscReal d, const PetscReal n[3])
{
  const PetscReal *gradient = sph->wall_gradient ? sph->wall_gradient + 3 * i : NULL;

  return gradient ? sph->p[i] - d * (gradient[0] * n[0] + gradient[1] * n[1] + gradient[2] * n[2]) : sph->p[i];
}

/* force [N] of the pressure of particle i on plane k at distance d along the plane's axis; slope [1/m] of the union */
static PetscReal PlanePressure(SPH sph, PetscInt i, int k, PetscReal d, PetscReal slope)
{
  PetscReal normal[3] = {0, 0, 0};

  normal[k / 2] = k % 2 ? -1.0 : 1.0;
  return sph->mass * WallPressure(sph, i, PetscMax(0.0, d), normal) / sph->params.density * sph->wall_flux * slope;
}

/* friction of touched particle t of a surface, from its distance as lambda tells it */
static PetscReal SurfaceFriction(SPH sph, const SPHContacts *contacts, PetscInt t, PetscReal union_factor)
{
  const PetscReal *grad  = contacts->grad + 3 * t;
  const PetscReal  slope = union_factor * sqrt(grad[0] * grad[0] + grad[1] * grad[1] + grad[2] * grad[2]);
  const PetscReal  d     = contacts->slip ? 0.0 : SPHSurfaceDistance_Internal(sph, contacts, t);

  return contacts->slip ? 0.0 : SPHWallFriction(sph->params.viscosity / sph->params.density, slope, FrictionDistance(sph, d));
}

/* Factor in G of a surface with images: wall_flux, times the area of the proxies that are touched over what the particles' sum makes of it where a
   closed flow wets all of it. The sum depends on where the first layers lie, which isph does not fix by density: by it the lift of a ball of radius
   4 dx was 0.78 to 1.06 of the true one, as the ball was packed; with the areas it is 0.97. */
static PetscErrorCode FluxOfSurface(SPH sph, const SPHContacts *contacts, PetscReal *flux)
{
  const PetscReal volume = sph->mass / sph->params.density;
  PetscReal       area = 0.0, sum = 0.0;
  PetscBool      *touched;

  PetscFunctionBegin;
  *flux = sph->wall_flux;
  if (!contacts->area || sph->params.free_surface) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(contacts->n_proxies, &touched));
  for (PetscInt t = 0; t < contacts->n_touched; t++) {
    const PetscReal *g = contacts->grad + 3 * t;
    sum += volume * sph->wall_flux * sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    for (PetscInt b = contacts->start[t]; b < contacts->start[t + 1]; b++) {
      area += touched[contacts->proxy[b]] ? 0.0 : contacts->area[contacts->proxy[b]];
      touched[contacts->proxy[b]] = PETSC_TRUE;
    }
  }
  if (sum > 0) *flux *= PetscMin(1.25, PetscMax(0.8, area / sum));
  PetscCall(PetscFree(touched));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHSetContacts - the surfaces that the particles touch at their current positions

  Input Parameters:
+ sph        - the fluid, neighbours current
. n_surfaces - how many
- contacts   - one struct a surface, borrowed until the next call or SPHUpdateNeighbors()

.seealso: SPHGetForces(), SPHGetUnionFactors()
@*/
PetscErrorCode SPHSetContacts(SPH sph, PetscInt n_surfaces, SPHContacts contacts[])
{
  const PetscReal rho0 = sph->params.density;
  const int       n    = (int)sph->n;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SPH_Contacts, sph, 0, 0, 0));
  if (sph->n_surfaces > 0) PetscCall(SPHFindPlanes_Internal(sph));
  PetscCall(AllocateSurfaces(sph, n_surfaces, contacts));
  sph->n_surfaces = n_surfaces;
  sph->contacts   = contacts;

  // forward: c = planes x the surfaces before; open = product so far
  for (PetscInt s = 0; s < n_surfaces; s++) {
    SPHSurfaceWork *w = &sph->surfaces[s];
#pragma omp parallel for schedule(static)
    for (PetscInt t = 0; t < contacts[s].n_touched; t++) {
      const PetscInt i   = contacts[s].particle[t];
      w->union_factor[t] = sph->open[i];
      sph->open[i] *= PetscMax(0.0, 1.0 - sph->surface_part * contacts[s].phi[t]);
    }
  }

  // backward: c x the surfaces after
  for (PetscInt s = n_surfaces - 1; s >= 0; s--) {
    SPHSurfaceWork *w = &sph->surfaces[s];
    PetscReal       flux = 1.0;

    if (sph->wall_flux != 1.0) PetscCall(FluxOfSurface(sph, &contacts[s], &flux));
#pragma omp parallel for schedule(static)
    for (PetscInt t = 0; t < contacts[s].n_touched; t++) {
      const PetscInt i = contacts[s].particle[t];
      w->union_factor[t] *= sph->surface_part * sph->open_surfaces[i] * (contacts[s].coefficient > 0 ? contacts[s].coefficient : 1.0);
      sph->open_surfaces[i] *= PetscMax(0.0, 1.0 - sph->surface_part * contacts[s].phi[t]);
      if (sph->params.viscosity > 0) w->friction[t] = SurfaceFriction(sph, &contacts[s], t, w->union_factor[t]);
      if (sph->wall_flux != 1.0) w->union_factor[t] = flux * (contacts[s].coefficient > 0 ? contacts[s].coefficient : 1.0); // from here on the factor in G
    }
  }

  // G = planes x surfaces' product + sum of the surfaces
  if (n_surfaces > 0) {
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++)
      for (int k = 0; k < 3; k++) sph->G[3 * i + k] = FluxPart(sph, sph->open_surfaces[i]) * sph->G_planes[3 * i + k];
    for (PetscInt s = 0; s < n_surfaces; s++) {
#pragma omp parallel for schedule(static)
      for (PetscInt t = 0; t < contacts[s].n_touched; t++)
        for (int k = 0; k < 3; k++) sph->G[3 * contacts[s].particle[t] + k] += rho0 * sph->surfaces[s].union_factor[t] * contacts[s].grad[3 * t + k];
    }
    sph->table->SetWalls(&sph->loops, sph->G);
  }
  PetscCall(PetscLogEventEnd(SPH_Contacts, sph, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHGetUnionFactors(SPH sph, PetscInt surface, const PetscReal *c[])
{
  PetscFunctionBegin;
  PetscCheck(surface >= 0 && surface < sph->n_surfaces, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "surface %d of %d", (int)surface, (int)sph->n_surfaces);
  *c = sph->surfaces[surface].union_factor;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* wall_rate_i = sum_b rho0 c share . v_b + sum_k v_k . G_ik, the density rate that the walls' own motion takes away */
/* velocity of the wall where touched particle t is, as proxy b has it: the body turns as a whole, and what acts a distance away from the surface does so
   there (the transpose of ProxyTransfer()) */
static void WallVelocity(const SPHContacts *q, PetscInt t, PetscInt b, PetscReal v[3])
{
  double r[3], turn[3];

  for (int k = 0; k < 3; k++) v[k] = q->velocity[3 * b + k];
  if (!q->rotation || !q->place) return;
  Sub3(q->position + 3 * t, q->place + 3 * b, r);
  Cross3(q->rotation, r, turn);
  for (int k = 0; k < 3; k++) v[k] += turn[k];
}

PetscErrorCode SPHWallRate_Internal(SPH sph)
{
  const PetscReal rho0 = sph->params.density;
  const int       n    = (int)sph->n;

  PetscFunctionBegin;
  if (SPHPlanesMove_Internal(sph)) {
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++) sph->wall_rate[i] = FromPlanes(sph, i, NULL, NULL);
  }
  for (PetscInt s = 0; s < sph->n_surfaces && !SPHPlanesMove_Internal(sph); s++) {
    const SPHContacts *q = &sph->contacts[s];
#pragma omp parallel for schedule(static)
    for (PetscInt t = 0; t < q->n_touched; t++) sph->wall_rate[q->particle[t]] = 0.0;
  }
  for (PetscInt s = 0; s < sph->n_surfaces; s++) {
    const SPHContacts *q = &sph->contacts[s];
    if (!q->velocity) continue;
#pragma omp parallel for schedule(static)
    for (PetscInt t = 0; t < q->n_touched; t++) {
      PetscReal rate = 0.0;
      for (PetscInt b = q->start[t]; b < q->start[t + 1]; b++) {
        const PetscReal *share = q->share + 3 * b;
        PetscReal        v[3];

        WallVelocity(q, t, q->proxy[b], v);
        rate += share[0] * v[0] + share[1] * v[1] + share[2] * v[2];
      }
      sph->wall_rate[q->particle[t]] += rho0 * sph->surfaces[s].union_factor[t] * rate;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Density of the walls as predictor-corrector solvers need it, at positions x dt after those of the step: planes by closed form at x, surfaces
  to first order in the path, and the walls' own motion as wall_rate tells it:
    phi = 1 - open_planes(x) open_surfaces + sum_s c_s grad phi_s . (x - x0) - dt wall_rate/rho0,  never negative
*/
void SPHAddWallDensity_Internal(SPH sph, PetscReal dt, const PetscReal x[], PetscReal rho[])
{
  const int       n    = (int)sph->n;
  const PetscReal rho0 = sph->params.density;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    int       plane[6];
    PetscReal phi[6], slope[6], d[6], part;
    const int touched = TouchedPlanes(sph, x + 3 * i, plane, phi, slope, d);

    part = rho0 * (1.0 - sph->open_surfaces[i] * OpenBut(touched, plane, phi, -1)) - dt * sph->wall_rate[i];
    for (int k = 0; k < 3 && sph->n_surfaces; k++) part += (sph->G[3 * i + k] - sph->open_surfaces[i] * sph->G_planes[3 * i + k]) * (x[3 * i + k] - sph->x[3 * i + k]);
    rho[i] += PetscMax(0.0, part);
  }
}

/* force of pressure and friction on the six planes from the current positions, pressure and v* */
PetscErrorCode SPHPlaneForces_Internal(SPH sph)
{
  const int       n      = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal rho0   = sph->params.density, nu = sph->params.viscosity / rho0;

  PetscReal       pressure[6];
  const PetscBool of_solver = (PetscBool)(sph->method->PlaneForces != NULL);

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(sph->wall_force, 18));
  if (of_solver) PetscCall(sph->method->PlaneForces(sph, pressure));
  for (int axis = 0; axis < 3; axis++) {
    PetscReal sums[6];

    if (!(sph->walls >> (2 * axis) & 3)) continue;
#pragma omp parallel for schedule(static)
    for (int c = 0; c < chunks; c++) {
      PetscReal force[6] = {0, 0, 0, 0, 0, 0};

      for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
        int       plane[6];
        PetscReal phi[6], slope[6], d[6];
        const int touched = TouchedPlanes(sph, sph->x + 3 * i, plane, phi, slope, d);

        for (int k = 0; k < touched; k++) {
          const PetscReal part = OpenBut(touched, plane, phi, axis) * sph->open_surfaces[i];
          const PetscReal *v   = sph->plane_velocity + 3 * plane[k];
          PetscReal      *f    = force + 3 * (plane[k] % 2);

          if (plane[k] / 2 != axis) continue;
          if (!of_solver) f[axis] += PlanePressure(sph, i, plane[k], d[k], FluxPart(sph, part) * slope[k]);
          if (nu > 0 && !(sph->slip >> plane[k] & 1)) {
            const PetscReal friction = sph->mass * rho0 * sph->volume[i] * SPHWallFriction(nu, part * PetscAbsReal(slope[k]), FrictionDistance(sph, d[k]));
            for (int a = 0; a < 3; a++) f[a] += friction * (sph->v_viscous[3 * i + a] - v[a]);
          }
        }
      }
      for (int k = 0; k < 6; k++) sph->partial[c * SPH_SUMS + k] = force[k];
    }
    SPHSumPartials(sph, 6, sums);
    for (int k = 0; k < 6; k++) sph->wall_force[6 * axis + k] = sums[k];
    for (int k = 0; of_solver && k < 2; k++) sph->wall_force[6 * axis + 3 * k + axis] += pressure[2 * axis + k];
  }
  if (sph->n_patches) SPHPatchForces_Internal(sph);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SPHPlanePressure_Internal(SPH sph, int i, int k)
{
  int       plane[6];
  PetscReal phi[6], slope[6], d[6];
  const int touched = TouchedPlanes(sph, sph->x + 3 * i, plane, phi, slope, d);

  for (int m = 0; m < touched; m++)
    if (plane[m] == k) return PlanePressure(sph, i, k, d[m], FluxPart(sph, OpenBut(touched, plane, phi, k / 2) * sph->open_surfaces[i]) * slope[m]);
  return 0.0;
}

/* force on proxies of one surface; one thread, because particles share proxies: the touched are few */
static void SurfaceForces(SPH sph, SPHContacts *q, const SPHSurfaceWork *w)
{
  const PetscReal rho0 = sph->params.density, nu = sph->params.viscosity / rho0;

  for (int k = 0; k < 3; k++) q->total[k] = q->moment[k] = 0.0;
  q->power = 0.0;
  if (q->force)
    for (PetscInt b = 0; b < 3 * q->n_proxies; b++) q->force[b] = 0.0;
  for (PetscInt t = 0; t < q->n_touched; t++) {
    const PetscInt   i        = q->particle[t];
    const PetscReal *x        = q->position + 3 * t, *grad = q->grad + 3 * t;
    const PetscReal  grad2 = grad[0] * grad[0] + grad[1] * grad[1] + grad[2] * grad[2], size = sqrt(grad2);
    const PetscReal  normal[3] = {size > 0 ? -grad[0] / size : 0.0, size > 0 ? -grad[1] / size : 0.0, size > 0 ? -grad[2] / size : 0.0};
    const PetscReal  pressure  = sph->mass * WallPressure(sph, i, sph->wall_gradient ? SPHSurfaceDistance_Internal(sph, q, t) : 0.0, normal) / rho0 * w->union_factor[t];
    const PetscReal  friction = nu > 0 && grad2 > 0 ? sph->mass * w->friction[t] / grad2 : 0.0;
    PetscReal        sum[3]   = {0, 0, 0};

    for (PetscInt b = q->start[t]; b < q->start[t + 1]; b++) {
      const PetscReal *share  = q->share + 3 * b, *slid = nu > 0 && w->velocity ? w->velocity + 3 * q->proxy[b] : NULL;
      const PetscReal  weight = friction * (share[0] * grad[0] + share[1] * grad[1] + share[2] * grad[2]);

      PetscReal v[3] = {0, 0, 0};

      if (q->velocity) WallVelocity(q, t, q->proxy[b], v);
      for (int k = 0; k < 3; k++) {
        const PetscReal f = pressure * share[k] + (slid ? weight * (sph->v_viscous[3 * i + k] - slid[k]) : 0.0);
        sum[k] += f;
        if (q->force) q->force[3 * q->proxy[b] + k] += f;
        q->power += f * v[k];
      }
    }
    for (int k = 0; k < 3; k++) q->total[k] += sum[k];
    q->moment[0] += x[1] * sum[2] - x[2] * sum[1];
    q->moment[1] += x[2] * sum[0] - x[0] * sum[2];
    q->moment[2] += x[0] * sum[1] - x[1] * sum[0];
  }
}

/*@
  SPHGetForces - write the force of the fluid on every proxy, total, moment and power of every surface

  Call after SPHSolvePressure(); may be called again after another solve. Pressure: + m p~_i rho0 c_ik share. Friction of
  viscous flows is shared in proportion to share . grad.
@*/
PetscErrorCode SPHGetForces(SPH sph)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SPH_Forces, sph, 0, 0, 0));
  for (PetscInt s = 0; s < sph->n_surfaces; s++) SurfaceForces(sph, &sph->contacts[s], &sph->surfaces[s]);
  PetscCall(PetscLogEventEnd(SPH_Forces, sph, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHGetPlanes(SPH sph, PetscReal plane[6])
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(plane, sph->plane, 6));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHGetWallPowers(SPH sph, PetscReal power[6])
{
  PetscFunctionBegin;
  for (int k = 0; k < 6; k++) {
    power[k] = 0.0;
    for (int a = 0; a < 3; a++) power[k] += sph->wall_force[3 * k + a] * sph->plane_velocity[3 * k + a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHGetWallForces(SPH sph, PetscReal force[18])
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(force, sph->wall_force, 18));
  PetscFunctionReturn(PETSC_SUCCESS);
}
