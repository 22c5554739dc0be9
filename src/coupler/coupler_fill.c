/* coupler_fill.c - water at the start: lattices in boxes, spheres, cylinders and closed surfaces, carved out where bodies, obstacles and walls
   are, packed to rest density; then the velocities of its fields. */
#include "coupler_impl.h"
#include "sph/sph_field.h"

/* A particle starts no nearer than this many spacings to a wetted surface: where the first layer settles (method 2). */
#define START_GAP 0.2

typedef struct {
  PetscInt   n, capacity;
  PetscReal *x;
  PetscInt  *block; /* which of sph.fill a particle is of */
} Cloud;

static PetscErrorCode CloudAdd(Cloud *cloud, const PetscReal x[3], PetscInt block)
{
  PetscFunctionBegin;
  if (cloud->n == cloud->capacity) {
    cloud->capacity = 2 * cloud->capacity + 1024;
    PetscCall(PetscRealloc(sizeof(PetscReal) * 3 * (size_t)cloud->capacity, &cloud->x));
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)cloud->capacity, &cloud->block));
  }
  for (int k = 0; k < 3; k++) cloud->x[3 * cloud->n + k] = x[k];
  cloud->block[cloud->n++] = block;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* keep the particles for which keep[i] is set */
static void CloudFilter(Cloud *cloud, PetscInt first, const PetscBool keep[])
{
  PetscInt n = first;

  for (PetscInt i = first; i < cloud->n; i++) {
    if (!keep[i - first]) continue;
    for (int k = 0; k < 3; k++) cloud->x[3 * n + k] = cloud->x[3 * i + k];
    cloud->block[n++] = cloud->block[i];
  }
  cloud->n = n;
}

/*
  Steps and numbers of layers of a cubic lattice in a box. Along directions in which the box spans the domain between two walls or periodic
  sides, layers fill it exactly; the spacing along the others makes up for that, so that a particle's share of the box is dx^3. A box that
  spans all three has a share of its own, which is returned; else 0.
*/
static PetscReal LatticeSteps(const PetscReal min[3], const PetscReal max[3], PetscReal dx, SPH sph, PetscReal step[3], PetscInt n[3])
{
  PetscReal low[3], high[3], stretch = 1.0;
  unsigned  walls, periodic;
  int       n_free = 0;
  PetscBool spans[3];

  (void)SPHGetDomain(sph, low, high, &walls, &periodic);
  for (int k = 0; k < 3; k++) {
    const PetscReal length = max[k] - min[k];
    const PetscBool closed = (PetscBool)((periodic >> k & 1) || (walls >> (2 * k) & 3) == 3);

    spans[k] = (PetscBool)(closed && length > high[k] - low[k] - 0.5 * dx);
    n[k]     = PetscMax(1, (PetscInt)PetscFloorReal(length / dx + 0.5));
    step[k]  = length / n[k];
    if (spans[k]) stretch *= step[k] / dx;
    else n_free++;
  }
  for (int k = 0; k < 3; k++) {
    if (spans[k]) continue;
    step[k] = dx * PetscPowReal(stretch, -1.0 / n_free);
    n[k]    = PetscMax(1, (PetscInt)PetscFloorReal((max[k] - min[k]) / step[k] + 0.5));
  }
  return n_free ? 0.0 : step[0] * step[1] * step[2];
}

/* the lattice in a box; volume (may be NULL): that of a particle when it is not dx^3, else 0 */
static PetscErrorCode FillBox(Cloud *cloud, const PetscReal min[3], const PetscReal max[3], PetscInt block, PetscReal dx, SPH sph, PetscReal *volume)
{
  PetscReal       low[3], high[3], step[3], x[3];
  unsigned        walls, periodic;
  PetscInt        n[3];
  const PetscReal share = LatticeSteps(min, max, dx, sph, step, n);

  PetscFunctionBegin;
  PetscCall(SPHGetDomain(sph, low, high, &walls, &periodic));
  if (volume) *volume = share;
  for (PetscInt kz = 0; kz < n[2]; kz++) {
    for (PetscInt ky = 0; ky < n[1]; ky++) {
      for (PetscInt kx = 0; kx < n[0]; kx++) {
        const PetscInt cell[3] = {kx, ky, kz};
        PetscBool      inside  = PETSC_TRUE;

        for (int k = 0; k < 3; k++) {
          x[k]   = min[k] + (cell[k] + 0.5) * step[k];
          inside = (PetscBool)(inside && x[k] > low[k] && x[k] < high[k]);
        }
        if (inside) PetscCall(CloudAdd(cloud, x, block));
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int CompareReals(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;

  return x < y ? -1 : x > y;
}

/*
  A ball, or a disc of the cylinder's length: a lattice about its centre, cut at the shell where as many particles lie inside as come nearest
  to its volume. Whole shells keep the lattice's symmetry.
*/
static PetscErrorCode FillRound(Cloud *cloud, const FillParams *fill, PetscInt block, PetscReal dx, SPH sph)
{
  const PetscInt  first = cloud->n;
  const PetscBool disc  = (PetscBool)(fill->shape == FILL_CYLINDER);
  PetscReal       low[3], high[3], min[3], max[3], step[3], *r, *sorted, limit = 0.0, wanted, length = 2.0 * fill->radius;
  unsigned        walls, periodic;
  PetscBool      *keep;
  PetscInt        layers[3], n, m = 0;

  PetscFunctionBegin;
  PetscCall(SPHGetDomain(sph, low, high, &walls, &periodic));
  for (int k = 0; k < 3; k++) {
    min[k] = fill->center[k] - fill->radius - 2.0 * dx;
    max[k] = fill->center[k] + fill->radius + 2.0 * dx;
    if (!disc || k != fill->axis) continue;
    length = fill->length > 0 ? fill->length : high[k] - low[k];
    min[k] = fill->length > 0 ? fill->center[k] - 0.5 * length : low[k];
    max[k] = min[k] + length;
  }
  (void)LatticeSteps(min, max, dx, sph, step, layers);
  for (int k = 0; k < 3; k++) { // whole steps: the centre is the middle of a cell
    if (disc && k == fill->axis) continue;
    min[k] = fill->center[k] - step[k] * (PetscFloorReal(fill->radius / step[k]) + 1.0);
    max[k] = 2.0 * fill->center[k] - min[k];
  }
  PetscCall(FillBox(cloud, min, max, block, dx, sph, NULL));
  n      = cloud->n - first;
  wanted = disc ? PETSC_PI * PetscSqr(fill->radius) * length / PetscPowReal(dx, 3) : 4.0 / 3.0 * PETSC_PI * PetscPowReal(fill->radius / dx, 3);
  PetscCall(PetscMalloc3(n, &r, n, &sorted, n, &keep));
  for (PetscInt i = 0; i < n; i++) {
    r[i] = 0.0;
    for (int k = 0; k < 3; k++)
      if (!disc || k != fill->axis) r[i] += PetscSqr(cloud->x[3 * (first + i) + k] - fill->center[k]);
    sorted[i] = r[i];
  }
  qsort(sorted, (size_t)n, sizeof(PetscReal), CompareReals);
  while (m < n) { // shell by shell
    PetscInt next = m;

    while (next < n && sorted[next] <= sorted[m] + 1e-6 * dx * dx) next++;
    if (wanted - m < next - wanted) break;
    limit = sorted[m] + 1e-6 * dx * dx;
    m     = next;
  }
  for (PetscInt i = 0; i < n; i++) keep[i] = (PetscBool)(r[i] <= limit);
  CloudFilter(cloud, first, keep);
  PetscCall(PetscFree3(r, sorted, keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* lattice over the bounding box of a closed surface, kept where inside */
static PetscErrorCode FillSurface(Cloud *cloud, const Surface *surface, PetscInt block, PetscReal dx, SPH sph)
{
  const PetscInt first = cloud->n;
  PetscReal      min[3], max[3], *winding;
  PetscBool     *keep;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    min[k] = PETSC_MAX_REAL;
    max[k] = PETSC_MIN_REAL;
    for (PetscInt a = 0; a < surface->n_nodes; a++) {
      min[k] = PetscMin(min[k], surface->x[3 * a + k]);
      max[k] = PetscMax(max[k], surface->x[3 * a + k]);
    }
  }
  PetscCall(FillBox(cloud, min, max, block, dx, sph, NULL));
  PetscCall(PetscMalloc2(cloud->n - first, &winding, cloud->n - first, &keep));
  PetscCall(SurfaceWinding(cloud->n - first, cloud->x + 3 * first, surface->x, surface->n_triangles, surface->triangles, winding));
  for (PetscInt i = 0; i < cloud->n - first; i++) keep[i] = (PetscBool)(winding[i] > 0.5);
  CloudFilter(cloud, first, keep);
  PetscCall(PetscFree2(winding, keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFill(const char name[], FillParams *fill, PetscBool *has_box)
{
  PetscBool has_min, has_max, has_radius;
  char      prefix[2 * BY_NAME_MAX], key[2 * BY_NAME_MAX], option[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "sph_%s_", name));
  PetscCall(KeysSetDefaults(FillKeys, fill));
  PetscCall(KeysSetFromOptions(FillKeys, prefix, fill));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%smin", prefix));
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &has_min));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%smax", prefix));
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &has_max));
  PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s", name));
  *has_box   = (PetscBool)(has_min && has_max);
  has_radius = (PetscBool)(fill->radius > 0);
  if ((fill->surface[0] || fill->shape != FILL_BOX) && (has_min || has_max))
    PetscFunctionReturn(InputError(key, "has both a box (min, max) and a %s; give one of them", fill->surface[0] ? "surface" : "shape that is none"));
  if (fill->surface[0] && fill->shape != FILL_BOX) PetscFunctionReturn(InputError(key, "has both a shape and a surface; give one of them"));
  if (fill->shape != FILL_BOX && !has_radius) PetscFunctionReturn(InputError(key, "needs a radius > 0 [m], and a center: a sphere or cylinder has both"));
  if (!fill->surface[0] && fill->shape == FILL_BOX && !*has_box)
    PetscFunctionReturn(InputError(key, "needs a box (min and max), a closed surface (surface: FILE), or a shape (shape: sphere or cylinder, center, radius)"));
  if (fill->field == FIELD_TAYLOR_GREEN && !(fill->wavelength > 0))
    PetscFunctionReturn(InputError(key, "needs a wavelength > 0 [m] for the field taylor_green"));
  for (int k = 0; k < 3 && *has_box; k++) {
    if (!(fill->max[k] > fill->min[k])) {
      PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.max", name));
      PetscFunctionReturn(InputError(key, "is not above min in %c: the box is empty", "xyz"[k]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddBlock(Cloud *cloud, const char name[], PetscInt block, PetscReal dx, SPH sph, PetscReal *volume)
{
  FillParams fill;
  PetscBool  has_box;
  char       key[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  ByCall(ReadFill(name, &fill, &has_box));
  if (fill.surface[0]) {
    Surface surface;

    PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.surface", name));
    ByCall(SurfaceRead(key, fill.surface, fill.scale, fill.translate, &surface));
    PetscCall(FillSurface(cloud, &surface, block, dx, sph));
    PetscCall(SurfaceDestroy(&surface));
  } else if (fill.shape != FILL_BOX) {
    PetscCall(FillRound(cloud, &fill, block, dx, sph));
  } else {
    PetscCall(FillBox(cloud, fill.min, fill.max, block, dx, sph, volume));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* velocity [m/s] at x of the water of a block: what all of it has, and its field */
static void FieldVelocity(const FillParams *fill, const PetscReal x[3], PetscReal v[3])
{
  const int       ia = (fill->axis + 1) % 3, ib = (fill->axis + 2) % 3;
  const PetscReal a = x[ia] - fill->center[ia], b = x[ib] - fill->center[ib];
  PetscReal       uv[2] = {0, 0};

  if (fill->field == FIELD_TAYLOR_GREEN) SPHFieldTaylorGreen(fill->amplitude, fill->wavelength, a, b, uv);
  if (fill->field == FIELD_ROTATION) SPHFieldRotation(fill->rate, a, b, uv);
  if (fill->field == FIELD_SHEAR) SPHFieldShear(fill->rate, a, b, uv);
  if (fill->field == FIELD_STRAIN) SPHFieldStrain(fill->rate, a, b, uv);
  for (int k = 0; k < 3; k++) v[k] = fill->velocity[k];
  v[ia] += uv[0];
  v[ib] += uv[1];
}

/* velocities of the blocks' fields where packing has left the particles */
static PetscErrorCode SetVelocities(SPH sph, const Names *names, PetscInt n_filled, const PetscInt block[])
{
  FillParams       fill[BY_NAMES_MAX];
  const PetscReal *x, *v, *p;
  const PetscInt  *id;
  PetscReal       *new_x, *new_v, *new_p;
  PetscInt         n, *new_id;
  PetscBool        has_box;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < names->n; k++) ByCall(ReadFill(names->name[k], &fill[k], &has_box));
  PetscCall(SPHGetSize(sph, &n));
  PetscCall(SPHGetState(sph, &x, &v, &p, NULL, &id));
  PetscCall(PetscMalloc4(3 * n, &new_x, 3 * n, &new_v, n, &new_p, n, &new_id));
  PetscCall(PetscArraycpy(new_x, x, 3 * n));
  PetscCall(PetscArraycpy(new_p, p, n));
  PetscCall(PetscArraycpy(new_id, id, n));
  for (PetscInt i = 0; i < n; i++) {
    if (id[i] < n_filled) FieldVelocity(&fill[block[id[i]]], x + 3 * i, new_v + 3 * i);
    else PetscCall(PetscArraycpy(new_v + 3 * i, v + 3 * i, 3)); // of an inlet
  }
  ByCall(SPHSetState(sph, n, new_id, new_x, new_v, new_p));
  PetscCall(PetscFree4(new_x, new_v, new_p, new_id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* take out what lies in or too near to a surface */
static PetscErrorCode Carve(Cloud *cloud, const PetscReal x[], PetscInt n_triangles, const PetscInt triangles[], PetscReal gap)
{
  PetscReal *winding, *distance;
  PetscBool *keep;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(cloud->n, &winding, cloud->n, &distance, cloud->n, &keep));
  PetscCall(SurfaceWinding(cloud->n, cloud->x, x, n_triangles, triangles, winding));
  PetscCall(SurfaceDistance(cloud->n, cloud->x, x, n_triangles, triangles, gap, distance));
  for (PetscInt i = 0; i < cloud->n; i++) keep[i] = (PetscBool)(winding[i] <= 0.5 && distance[i] >= gap);
  CloudFilter(cloud, 0, keep);
  PetscCall(PetscFree3(winding, distance, keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* boxes that overlap would put two particles in one place: keep the first of any two nearer than half a spacing */
static PetscErrorCode RemoveDoubles(Cloud *cloud, PetscReal dx)
{
  PetscInt  *head, *next, cells[3], n_cells;
  PetscReal  low[3], high[3];
  PetscBool *keep;

  PetscFunctionBegin;
  if (!cloud->n) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 3; k++) {
    low[k]  = PETSC_MAX_REAL;
    high[k] = PETSC_MIN_REAL;
    for (PetscInt i = 0; i < cloud->n; i++) {
      low[k]  = PetscMin(low[k], cloud->x[3 * i + k]);
      high[k] = PetscMax(high[k], cloud->x[3 * i + k]);
    }
    cells[k] = (PetscInt)((high[k] - low[k]) / dx) + 1;
  }
  n_cells = cells[0] * cells[1] * cells[2];
  PetscCall(PetscMalloc3(n_cells, &head, cloud->n, &next, cloud->n, &keep));
  for (PetscInt j = 0; j < n_cells; j++) head[j] = -1;
  for (PetscInt i = 0; i < cloud->n; i++) {
    const PetscReal *xi = &cloud->x[3 * i];
    PetscInt         at[3];

    for (int k = 0; k < 3; k++) at[k] = (PetscInt)((xi[k] - low[k]) / dx);
    keep[i] = PETSC_TRUE;
    for (PetscInt c = 0; c < 27 && keep[i]; c++) {
      const PetscInt b[3] = {at[0] + c % 3 - 1, at[1] + c / 3 % 3 - 1, at[2] + c / 9 - 1};

      if (b[0] < 0 || b[1] < 0 || b[2] < 0 || b[0] >= cells[0] || b[1] >= cells[1] || b[2] >= cells[2]) continue;
      for (PetscInt j = head[(b[2] * cells[1] + b[1]) * cells[0] + b[0]]; j >= 0; j = next[j]) {
        PetscReal r2 = 0.0;

        for (int k = 0; k < 3; k++) r2 += PetscSqr(cloud->x[3 * j + k] - xi[k]);
        if (r2 < 0.25 * dx * dx) keep[i] = PETSC_FALSE;
      }
    }
    if (!keep[i]) continue;
    const PetscInt cell = (at[2] * cells[1] + at[1]) * cells[0] + at[0];
    next[i]             = head[cell];
    head[cell]          = i;
  }
  CloudFilter(cloud, 0, keep);
  PetscCall(PetscFree3(head, next, keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* contacts for a sweep of the packing; what the sweep before has pushed into a body is put outside again */
static PetscErrorCode PackContacts(void *ctx, SPH sph)
{
  PetscInt n_moved;

  PetscFunctionBegin;
  PetscCall(CouplerUpdateContacts((Coupler)ctx));
  PetscCall(CouplerPushOut((Coupler)ctx, &n_moved));
  if (!n_moved) PetscFunctionReturn(PETSC_SUCCESS);
  ByCall(SPHUpdateNeighbors(sph));
  PetscCall(CouplerUpdateContacts((Coupler)ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* particles of all fill blocks, carved and packed; SetUp of the fluid */
PetscErrorCode CouplerBuildFluid(Coupler c, const DomainParams *domain)
{
  SPHParams  *params;
  Cloud       cloud = {0};
  PetscBool  *keep;
  PetscReal   volume = 0.0;
  PetscBool   by_volume; // isph: the solver never asks for density, so that the number of particles must fit the volume
  const char *solver;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(c->sph, &params));
  PetscCall(SPHGetSolver(c->sph, &solver, NULL));
  PetscCall(PetscStrcmp(solver, "isph", &by_volume));
  for (PetscInt k = 0; k < params->fill.n; k++) ByCall(AddBlock(&cloud, params->fill.name[k], k, params->spacing, c->sph, &volume));
  if (volume > 0 && params->fill.n == 1) PetscCall(SPHSetParticleVolume(c->sph, volume));
  PetscCall(RemoveDoubles(&cloud, params->spacing));
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    CouplerSurface  *s = &c->surface[k];
    const PetscReal *x = s->x, *v;
    const PetscInt  *triangles = s->triangles;
    PetscInt         n         = s->n_triangles;

    if (s->tled) {
      PetscCall(TLEDGetSurface(s->tled, PETSC_FALSE, &n, &triangles));
      PetscCall(TLEDGetPositions(s->tled, &x, &v));
    }
    PetscCall(Carve(&cloud, x, n, triangles, by_volume ? 0.0 : START_GAP * params->spacing));
  }
  PetscCall(PetscMalloc1(cloud.n, &keep));
  for (PetscInt i = 0; i < cloud.n; i++) {
    keep[i] = PETSC_TRUE;
    for (int k = 0; k < 3; k++) {
      if (cloud.x[3 * i + k] < domain->min[k] || cloud.x[3 * i + k] > domain->max[k]) keep[i] = PETSC_FALSE;
    }
  }
  CloudFilter(&cloud, 0, keep);
  PetscCall(PetscFree(keep));
  if (!cloud.n && !params->inflow.n && !params->sources.n) {
    PetscFunctionReturn(InputError("sph.fill", "there is no fluid: no particle fits into the water blocks\n"
                                   "name at least one block that is wider than sph.spacing = %g m and lies in the domain, outside the bodies",
                                   (double)params->spacing));
  }
  PetscCall(SPHAddParticles(c->sph, cloud.n, cloud.x, NULL));
  PetscCall(PetscFree(cloud.x));
  ByCall(SPHSetUp(c->sph));
  ByCall(SPHPack(c->sph, 1e-3, 100, c->n_surfaces ? PackContacts : NULL, c));
  if (params->settle) ByCall(SPHSettle(c->sph, 1e-2, 600, c->n_surfaces ? PackContacts : NULL, c, NULL));
  if (c->n_surfaces) { // the last sweep too
    ByCall(SPHUpdateNeighbors(c->sph));
    ByCall(PackContacts(c, c->sph));
  }
  ByCall(SetVelocities(c->sph, &params->fill, cloud.n, cloud.block));
  PetscCall(PetscFree(cloud.block));
  PetscFunctionReturn(PETSC_SUCCESS);
}
