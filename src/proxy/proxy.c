/* proxy.c - the life of a Proxy: create, set up, update, view, destroy. */
#include <petscviewer.h>
#include "proxy/proxy_impl.h"

static PetscClassId  PROXY_CLASSID = 0;
static PetscLogEvent EventUpdate, EventSample;

static PetscErrorCode Register(void)
{
  PetscFunctionBegin;
  if (PROXY_CLASSID) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscClassIdRegister("Proxy", &PROXY_CLASSID));
  PetscCall(PetscLogEventRegister("ProxyUpdate", PROXY_CLASSID, &EventUpdate));
  PetscCall(PetscLogEventRegister("ProxySample", PROXY_CLASSID, &EventSample));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxyCreate - surface proxies of one body or obstacle

  Input Parameters:
+ comm - communicator; every rank samples the surface that it is given
- name - the body's name in the scene; options are -<name>_proxy_*

  Output Parameter:
. proxy - with default parameters, to be given a surface and a fluid
@*/
PetscErrorCode ProxyCreate(MPI_Comm comm, const char name[], Proxy *proxy)
{
  Proxy p;

  PetscFunctionBegin;
  PetscCall(Register());
  PetscCall(PetscHeaderCreate(p, PROXY_CLASSID, "Proxy", "surface proxy particles", "Proxy", comm, ProxyDestroy, ProxyView));
  PetscCall(PetscStrncpy(p->name, name, sizeof(p->name)));
  PetscCall(PetscObjectSetName((PetscObject)p, name));
  PetscCall(KeysSetDefaults(ProxyKeys, &p->params));
  *proxy = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyGetParams(Proxy proxy, ProxyParams **params)
{
  PetscFunctionBegin;
  *params = &proxy->params;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxySetSurface - the triangles that fluid may touch

  Input Parameters:
+ proxy       - before ProxySetUp()
. n_nodes     - nodes of the body, also interior ones
. X           - reference positions [m], n_nodes x 3
. n_triangles - wetted triangles
- triangles   - n_triangles x 3, counter-clockwise seen from outside

  Note: Copied. What is wrong with a surface is told by ProxySetUp().
@*/
PetscErrorCode ProxySetSurface(Proxy proxy, PetscInt n_nodes, const PetscReal X[], PetscInt n_triangles, const PetscInt triangles[])
{
  PetscFunctionBegin;
  PetscCheck(!proxy->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "set the surface before ProxySetUp()");
  PetscCall(PetscFree2(proxy->surface.X, proxy->surface.triangles));
  PetscCall(PetscMalloc2(3*n_nodes, &proxy->surface.X, 3*n_triangles, &proxy->surface.triangles));
  PetscCall(PetscArraycpy(proxy->surface.X, X, 3*n_nodes));
  PetscCall(PetscArraycpy(proxy->surface.triangles, triangles, 3*n_triangles));
  proxy->surface.n_nodes     = n_nodes;
  proxy->surface.n_triangles = n_triangles;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxySetFromOptions(Proxy proxy)
{
  char prefix[BY_NAME_MAX + 8];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_proxy_", proxy->name));
  ByCall(KeysSetFromOptions(ProxyKeys, prefix, &proxy->params));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the scene key that gave the surface, for messages: obstacles have `surface`, bodies have `mesh` */
static PetscErrorCode SurfaceKey(Proxy proxy, char key[], size_t n)
{
  char      option[BY_NAME_MAX + 10];
  PetscBool obstacle;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_surface", proxy->name));
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &obstacle));
  PetscCall(PetscSNPrintf(key, n, "%s.%s", proxy->name, obstacle ? "surface" : "mesh"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* normals, areas and shapes of the surface at geometry.x; nodal shares of the area */
static void UpdateGeometry(Proxy p)
{
  const ProxySurface *s = &p->surface;

  ProxyGeometryUpdate(s, PROXY_CURVATURE/p->fluid.h, &p->geometry);
  for (PetscInt v = 0; v < s->n_nodes; v++) p->node_weight[v] = 0.0;
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    for (int i = 0; i < 3; i++) p->node_weight[s->triangles[3*t + i]] += p->geometry.area[t]/3.0;
  }
}

static PetscErrorCode Sample(Proxy p)
{
  PetscBool folded;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(EventSample, 0, 0, 0, 0));
  PetscCall(ProxySurfaceFold(p->params.feature_angle, &p->fluid, p->geometry.x, &p->surface, &folded));
  if (folded) UpdateGeometry(p);
  PetscCall(ProxySample(&p->surface, &p->geometry, &p->params, &p->fluid, p->density, &p->sampling));
  PetscCall(ProxyPlaceSampled(p));
  PetscCall(ProxyMeasureParts(&p->surface, &p->geometry, p->points, &p->sampling));
  p->mask.has_boxes = PETSC_FALSE;
  p->n_samplings++;
  PetscCall(PetscLogEventEnd(EventSample, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxySetUp - check the surface, find its sharp edges and sample it in its reference position

  Errors:
  BY_ERR_INPUT, told under <name>.mesh or <name>.surface: an edge of three triangles, neighbours of opposite orientation, a triangle
  without area
@*/
PetscErrorCode ProxySetUp(Proxy p)
{
  ProxySurface given = p->surface;
  char         key[BY_NAME_MAX + 10];
  PetscErrorCode ierr;

  PetscFunctionBegin;
  if (p->setup) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(given.X && p->has_fluid, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetSurface() and ProxySetFluid() first");
  if (p->params.eta_max < p->params.eta_min) {
    PetscCall(PetscSNPrintf(key, sizeof(key), "%s.proxy.eta_max", p->name));
    PetscFunctionReturn(InputError(key, "is below eta_min = %g\n  eta_min..eta_max is the range of the normalised curvature", (double)p->params.eta_min));
  }
  ByCall(ProxyReadDensity(p, &given));
  PetscCall(SurfaceKey(p, key, sizeof(key)));
  PetscCall(PetscMemzero(&p->surface, sizeof(p->surface)));
  ierr = ProxySurfaceBuild(key, p->params.feature_angle, &p->fluid, given.n_nodes, given.X, given.n_triangles, given.triangles, &p->surface);
  PetscCall(PetscFree2(given.X, given.triangles));
  ByCall(ierr);

  p->factor = p->params.factor;
  p->inset  = (p->params.inset >= 0.0 ? p->params.inset : p->params.kernel == PROXY_KERNEL_HALF_SPACE ? PROXY_INSET_HALF_SPACE : PROXY_INSET_ELLIPSOID)*p->fluid.dx;
  if (p->factor == 0.0) {
    const double ratio = p->fluid.h/p->fluid.dx;
    p->factor = p->params.kernel == PROXY_KERNEL_HALF_SPACE ? SPHWallFactor(p->fluid.kernel, ratio) : ProxyFactorEllipsoid(ratio);
  }
  PetscCall(ProxyGeometryCreate(&p->surface, &p->geometry));
  PetscCall(PetscMalloc1(p->surface.n_nodes, &p->node_weight));
  PetscCall(PetscArraycpy(p->geometry.x, p->surface.X, 3*p->surface.n_nodes));
  UpdateGeometry(p);
  PetscCall(Sample(p));
  PetscCall(ProxyPlaceAll(p));
  ProxyExpose(p);
  p->setup = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* largest change of an edge or area ratio since the last sampling */
static PetscReal Change(const Proxy p)
{
  const ProxySurface *s = &p->surface;
  PetscReal           most = 0.0;

#pragma omp parallel for schedule(static) reduction(max : most)
  for (PetscInt t = 0; t < s->n_triangles; t++) most = PetscMax(most, PetscAbsReal(p->geometry.area[t]/p->sampling.area0[t] - 1.0));
#pragma omp parallel for schedule(static) reduction(max : most)
  for (PetscInt e = 0; e < s->n_edges; e++) {
    double r[3];
    Sub3(&p->geometry.x[3*s->edge_nodes[2*e + 1]], &p->geometry.x[3*s->edge_nodes[2*e]], r);
    most = PetscMax(most, PetscAbsReal(Norm3(r)/p->sampling.edge0[e] - 1.0));
  }
  return most;
}

/*@
  ProxyUpdate - move the proxies with the surface (method 4.5)

  Input Parameters:
+ proxy - set up
. x     - current nodal positions [m], n_nodes x 3
- v     - nodal velocities that the fluid shall see [m/s], n_nodes x 3, mean over the coming step; NULL = at rest

  Notes:
  Positions follow by barycentric weights; normals, shape operators and areas are those of the deformed surface. The surface is sampled
  afresh when an edge or area has changed by more than resample_tolerance since the last sampling, or a crease has come or gone. Only proxies that a particle of the
  fluid may touch where it is now are placed and in use: their number changes from step to step. A surface that has not moved, and where no
  water came or went, costs a comparison.
@*/
PetscErrorCode ProxyUpdate(Proxy p, const PetscReal x[], const PetscReal v[])
{
  PetscBool same;

  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  PetscCall(PetscLogEventBegin(EventUpdate, p, 0, 0, 0));
  PetscCall(PetscArraycmp(p->geometry.x, x, 3*p->surface.n_nodes, &same));
  if (!same) {
    PetscCall(PetscArraycpy(p->geometry.x, x, 3*p->surface.n_nodes));
    UpdateGeometry(p);
    if (p->params.resample_tolerance == 0.0 || Change(p) > p->params.resample_tolerance || ProxySurfaceCreased(p->params.feature_angle, &p->surface, p->geometry.normal)) PetscCall(Sample(p));
  }
  if (p->sph) {
    const PetscReal *at;
    PetscInt         n;
    PetscCall(SPHGetPlanes(p->sph, p->fluid.plane));
    PetscCall(SPHGetSize(p->sph, &n));
    PetscCall(SPHGetState(p->sph, &at, NULL, NULL, NULL, NULL));
    PetscCall(ProxyPlaceNear(p, (PetscBool)!same, n, at));
  } else if (!same) PetscCall(ProxyPlaceAll(p));
  ProxyExpose(p);
  PetscCall(ProxySetVelocity(p, v));
  PetscCall(PetscLogEventEnd(EventUpdate, p, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxySetVelocity - set only the nodal velocities [m/s] that the fluid sees, n_nodes x 3; NULL = at rest
@*/
PetscErrorCode ProxySetVelocity(Proxy p, const PetscReal v[])
{
  PetscFunctionBegin;
  if (!v) {
    PetscCall(PetscFree(p->node_velocity));
  } else {
    if (!p->node_velocity) PetscCall(PetscMalloc1(3*p->surface.n_nodes, &p->node_velocity));
    PetscCall(PetscArraycpy(p->node_velocity, v, 3*p->surface.n_nodes));
  }
  PetscCall(ProxyPlaceVelocities(p));
  if (v) PetscCall(ProxyGetRotation(p, v, p->rotation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxyGetSampling - where the surface was when it was last sampled [m], n_nodes x 3, borrowed; ProxySetSampling() with it and then
  ProxyUpdate() restore the same proxies after a restart
@*/
PetscErrorCode ProxyGetSampling(Proxy p, const PetscReal *x[])
{
  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  *x = p->sampling.x;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxySetSampling - sample the surface as it is at x [m], n_nodes x 3; the result depends on x alone
@*/
PetscErrorCode ProxySetSampling(Proxy p, const PetscReal x[])
{
  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  PetscCall(PetscArraycpy(p->geometry.x, x, 3*p->surface.n_nodes));
  UpdateGeometry(p);
  PetscCall(Sample(p));
  PetscCall(ProxyPlaceAll(p));
  PetscCall(ProxyPlaceVelocities(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyGetPoints(Proxy p, PetscInt *n, const PetscReal *x[], const PetscReal *normal[], const PetscReal *kappa[], const PetscReal *area[])
{
  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  if (n) *n = p->n;
  if (x) *x = p->x;
  if (normal) *normal = p->normal;
  if (kappa) *kappa = p->kappa;
  if (area) *area = p->area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyGetCounts(Proxy p, PetscInt *in_use, PetscInt *sampled, PetscInt *samplings)
{
  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  if (in_use) *in_use = p->n;
  if (sampled) *sampled = p->sampling.n;
  if (samplings) *samplings = p->n_samplings;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyGetTotalCurvature(Proxy p, PetscReal *total)
{
  PetscReal *kappa, *area;

  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  PetscCall(PetscMalloc2(p->surface.n_nodes, &kappa, p->surface.n_nodes, &area));
  PetscCall(ProxyGaussianCurvature(&p->surface, p->geometry.x, kappa, area));
  *total = 0.0;
  for (PetscInt v = 0; v < p->surface.n_nodes; v++) *total += kappa[v]*area[v];
  PetscCall(PetscFree2(kappa, area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyView(Proxy p, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "Proxy %s\n", p->name));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscCall(KeysView(ProxyKeys, &p->params, viewer));
  if (p->setup) {
    PetscReal area = 0.0;
    for (PetscInt t = 0; t < p->surface.n_triangles; t++) area += p->geometry.area[t];
    PetscCall(PetscViewerASCIIPrintf(viewer, "proxies %" PetscInt_FMT " of %" PetscInt_FMT " in use, triangles %" PetscInt_FMT ", smooth patches %" PetscInt_FMT ", area %g m^2, factor %g, sampled %" PetscInt_FMT " times\n", p->n, p->sampling.n, p->surface.n_triangles, p->surface.n_patches, (double)area, (double)p->factor, p->n_samplings));
  }
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyDestroy(Proxy *proxy)
{
  Proxy p = *proxy;

  PetscFunctionBegin;
  *proxy = NULL;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  if (--((PetscObject)p)->refct > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProxySurfaceDestroy(&p->surface));
  PetscCall(ProxyGeometryDestroy(&p->geometry));
  PetscCall(ProxySamplingDestroy(&p->sampling));
  PetscCall(ProxyContactsDestroy(p));
  PetscCall(ProxyPlaceDestroy(p));
  PetscCall(ProxyMaskDestroy(p));
  PetscCall(PetscFree(p->neighbour));
  PetscCall(PetscFree(p->node_velocity));
  PetscCall(PetscFree(p->node_weight));
  PetscCall(PetscFree(p->density));
  PetscCall(PetscHeaderDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
