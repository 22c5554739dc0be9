/* coupler_fill.c - water at the start: lattices in boxes and closed surfaces, carved out where bodies, obstacles and walls are, packed to
   rest density. */
#include "coupler_impl.h"

/* A particle starts no nearer than this many spacings to a wetted surface: where the first layer settles (method 2). */
#define START_GAP 0.2

typedef struct {
  PetscInt   n, capacity;
  PetscReal *x, *v;
} Cloud;

static PetscErrorCode CloudAdd(Cloud *cloud, const PetscReal x[3], const PetscReal v[3])
{
  PetscFunctionBegin;
  if (cloud->n == cloud->capacity) {
    cloud->capacity = 2 * cloud->capacity + 1024;
    PetscCall(PetscRealloc(sizeof(PetscReal) * 3 * (size_t)cloud->capacity, &cloud->x));
    PetscCall(PetscRealloc(sizeof(PetscReal) * 3 * (size_t)cloud->capacity, &cloud->v));
  }
  for (int k = 0; k < 3; k++) {
    cloud->x[3 * cloud->n + k] = x[k];
    cloud->v[3 * cloud->n + k] = v[k];
  }
  cloud->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* keep the particles for which keep[i] is set */
static void CloudFilter(Cloud *cloud, PetscInt first, const PetscBool keep[])
{
  PetscInt n = first;

  for (PetscInt i = first; i < cloud->n; i++) {
    if (!keep[i - first]) continue;
    for (int k = 0; k < 3; k++) {
      cloud->x[3 * n + k] = cloud->x[3 * i + k];
      cloud->v[3 * n + k] = cloud->v[3 * i + k];
    }
    n++;
  }
  cloud->n = n;
}

/* Cubic lattice of spacing dx in a box; along a periodic direction that the box spans, the spacing is adjusted to repeat. */
static PetscErrorCode FillBox(Cloud *cloud, const PetscReal min[3], const PetscReal max[3], const PetscReal v[3], PetscReal dx, SPH sph)
{
  PetscReal low[3], high[3], step[3], x[3];
  unsigned  walls, periodic;
  PetscInt  n[3];

  PetscFunctionBegin;
  PetscCall(SPHGetDomain(sph, low, high, &walls, &periodic));
  for (int k = 0; k < 3; k++) {
    const PetscReal length = max[k] - min[k];
    const PetscBool spans  = (PetscBool)((periodic >> k & 1) && length > high[k] - low[k] - 0.5 * dx);

    n[k]    = PetscMax(1, (PetscInt)PetscFloorReal(length / dx + 0.5));
    step[k] = spans ? length / n[k] : dx;
  }
  for (PetscInt kz = 0; kz < n[2]; kz++) {
    for (PetscInt ky = 0; ky < n[1]; ky++) {
      for (PetscInt kx = 0; kx < n[0]; kx++) {
        const PetscInt cell[3] = {kx, ky, kz};
        PetscBool      inside  = PETSC_TRUE;

        for (int k = 0; k < 3; k++) {
          x[k]   = min[k] + (cell[k] + 0.5) * step[k];
          inside = (PetscBool)(inside && x[k] > low[k] && x[k] < high[k]);
        }
        if (inside) PetscCall(CloudAdd(cloud, x, v));
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* lattice over the bounding box of a closed surface, kept where inside */
static PetscErrorCode FillSurface(Cloud *cloud, const Surface *surface, const PetscReal v[3], PetscReal dx, SPH sph)
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
  PetscCall(FillBox(cloud, min, max, v, dx, sph));
  PetscCall(PetscMalloc2(cloud->n - first, &winding, cloud->n - first, &keep));
  PetscCall(SurfaceWinding(cloud->n - first, cloud->x + 3 * first, surface->x, surface->n_triangles, surface->triangles, winding));
  for (PetscInt i = 0; i < cloud->n - first; i++) keep[i] = (PetscBool)(winding[i] > 0.5);
  CloudFilter(cloud, first, keep);
  PetscCall(PetscFree2(winding, keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddBlock(Cloud *cloud, const char name[], PetscReal dx, SPH sph)
{
  FillParams fill;
  PetscBool  has_min, has_max;
  char       prefix[2 * BY_NAME_MAX], key[2 * BY_NAME_MAX], option[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "sph_%s_", name));
  PetscCall(KeysSetDefaults(FillKeys, &fill));
  PetscCall(KeysSetFromOptions(FillKeys, prefix, &fill));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%smin", prefix));
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &has_min));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%smax", prefix));
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &has_max));
  PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s", name));
  if (fill.surface[0]) {
    Surface surface;

    if (has_min || has_max) PetscFunctionReturn(InputError(key, "has both a box (min, max) and a surface; give one of them"));
    PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.surface", name));
    ByCall(SurfaceRead(key, fill.surface, fill.scale, fill.translate, &surface));
    PetscCall(FillSurface(cloud, &surface, fill.velocity, dx, sph));
    PetscCall(SurfaceDestroy(&surface));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!has_min || !has_max) PetscFunctionReturn(InputError(key, "needs a box (min and max) or a closed surface (surface: FILE)"));
  for (int k = 0; k < 3; k++) {
    if (!(fill.max[k] > fill.min[k])) {
      PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.max", name));
      PetscFunctionReturn(InputError(key, "is not above min in %c: the box is empty", "xyz"[k]));
    }
  }
  PetscCall(FillBox(cloud, fill.min, fill.max, fill.velocity, dx, sph));
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
  SPHParams *params;
  Cloud      cloud = {0};
  PetscBool *keep;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(c->sph, &params));
  for (PetscInt k = 0; k < params->fill.n; k++) ByCall(AddBlock(&cloud, params->fill.name[k], params->spacing, c->sph));
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
    PetscCall(Carve(&cloud, x, n, triangles, START_GAP * params->spacing));
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
  if (!cloud.n) {
    PetscFunctionReturn(InputError("sph.fill", "there is no fluid: no particle fits into the water blocks\n"
                                   "name at least one block that is wider than sph.spacing = %g m and lies in the domain, outside the bodies",
                                   (double)params->spacing));
  }
  PetscCall(SPHAddParticles(c->sph, cloud.n, cloud.x, cloud.v));
  PetscCall(PetscFree(cloud.x));
  PetscCall(PetscFree(cloud.v));
  ByCall(SPHSetUp(c->sph));
  ByCall(SPHPack(c->sph, 1e-3, 100, c->n_surfaces ? PackContacts : NULL, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}
