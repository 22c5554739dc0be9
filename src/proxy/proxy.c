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

/* room for n proxies */
static PetscErrorCode Reserve(Proxy p, PetscInt n)
{
  PetscFunctionBegin;
  if (n <= p->capacity) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(p->reach));
  PetscCall(PetscFree7(p->points, p->x, p->normal, p->area, p->velocity, p->force, p->centre));
  p->capacity = n + n/4;
  PetscCall(PetscMalloc1(p->capacity, &p->reach));
  PetscCall(PetscMalloc7(p->capacity, &p->points, 3*p->capacity, &p->x, 3*p->capacity, &p->normal, p->capacity, &p->area, 3*p->capacity, &p->velocity, 3*p->capacity,
                         &p->force, 3*p->capacity, &p->centre));
  PetscCall(PetscArrayzero(p->force, 3*p->capacity));
  PetscCall(PetscArrayzero(p->points, p->capacity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* position, normal, area and shape operator of proxy i on the surface as it is */
static void PlacePoint(Proxy p, PetscInt i, ProxyPoint *b)
{
  const ProxySurface  *s = &p->surface;
  const ProxyGeometry *g = &p->geometry;
  const ProxySampling *q = &p->sampling;
  const PetscInt       t = q->triangle[i];
  double               area = 0.0, S[6] = {0}, n[3] = {0}, x[3] = {0}, l;

  for (int c = 0; c < 3; c++) {
    for (int k = 0; k < 3; k++) {
      x[k] += q->weights[3*i + c]*g->x[3*q->nodes[3*i + c] + k];
      n[k] += q->weights[3*i + c]*g->fan_normal[3*s->fan[3*t + c] + k];
    }
  }
  l = Norm3(n);
  for (int k = 0; k < 3; k++) n[k] = l > 0.0 ? n[k]/l : g->normal[3*t + k];

  // shape operator and centre: means over the part of the surface that the proxy stands for
  double centre[3] = {0};
  for (PetscInt k = q->part_start[i]; k < q->part_start[i + 1]; k++) {
    const double a = q->part[k]*g->area[q->part_triangle[k]];
    area += a;
    for (int c = 0; c < 3; c++) {
      for (int d = 0; d < 3; d++) centre[d] += a/3.0*g->x[3*s->triangles[3*q->part_triangle[k] + c] + d];
    }
    ProxyShapeAddTurned(&g->shape[6*q->part_triangle[k]], &g->normal[3*q->part_triangle[k]], n, a, S);
  }
  if (area > 0.0) {
    for (int m = 0; m < 6; m++) S[m] /= area;
  } else {
    ProxyShapeAddTurned(&g->shape[6*t], &g->normal[3*t], n, 1.0, S);
  }
  ProxyShapeBound(PROXY_CURVATURE/p->fluid.h, S);

  for (int k = 0; k < 3; k++) {
    p->centre[3*i + k] = area > 0.0 ? centre[k]/area : x[k];
    p->x[3*i + k]      = b->x[k] = x[k];
    p->normal[3*i + k] = b->n[k] = n[k];
  }
  for (int m = 0; m < 6; m++) b->S[m] = S[m];
  b->bend    = ProxyShapeBend(S);
  b->offset  = q->offset[i] - (p->params.kernel == PROXY_KERNEL_HALF_SPACE ? p->inset : 0.0);
  p->area[i] = b->weight = area;
}

/* unit tangent along a side of the triangle, its edge for proxies on edges; returns the side's length */
static double PlaceTangent(const Proxy p, PetscInt i, ProxyPoint *b)
{
  const ProxySampling *q = &p->sampling;
  const int            side = q->side[i] >= 0 ? q->side[i] : 0;
  double               e[3], along, tangent;

  Sub3(&p->geometry.x[3*q->nodes[3*i + (side + 1)%3]], &p->geometry.x[3*q->nodes[3*i + side]], e);
  const double length = Norm3(e);
  along = Dot3(e, b->n);
  for (int k = 0; k < 3; k++) b->e[k] = e[k] - along*b->n[k];
  tangent = Norm3(b->e);
  for (int k = 0; k < 3; k++) b->e[k] /= tangent;
  return length;
}

/* is the proxy on a sharp edge or corner, or on the border? */
static PetscBool OnSharpEdge(const Proxy p, PetscInt i)
{
  const ProxySampling *q = &p->sampling;
  const PetscInt       t = q->triangle[i];

  if (q->kind[i] == PROXY_EDGE) return p->surface.edge_sharp[p->surface.triangle_edges[3*t + q->side[i]]];
  for (int k = 0; k < 3; k++) {
    if (q->weights[3*i + k] == 1.0) return p->surface.fan_sharp[p->surface.fan[3*t + k]];
  }
  return PETSC_FALSE;
}

/* Supports. Half-space: radius h/kappa-bar in the tangent plane, larger where the triangle has grown. Sphere: h. Ellipsoid (method 4.3): on
   edges a = 2 d_E along the edge, b = c = h; at vertices a sphere; on triangles a = b = h/kappa-bar; stretched with edge and area. Where
   proxies are thinned only sharp edges and corners count as such, the rest as triangles, whatever it was sampled on: the paper's spheres at
   all vertices would leave holes where thinning has taken the proxies between them. */
static void PlaceSupport(Proxy p, PetscInt i, ProxyPoint *b)
{
  const ProxySurface  *s = &p->surface;
  const ProxySampling *q = &p->sampling;
  const double         h = p->fluid.h, R = h/q->kappa[i], length = PlaceTangent(p, i, b);
  const PetscInt       t = q->triangle[i];
  const double         stretch = sqrt(p->geometry.area[t]/q->area0[t]);

  if (p->params.kernel == PROXY_KERNEL_HALF_SPACE) {
    b->radius[0] = b->radius[1] = R*PetscMax(1.0, stretch);
    for (int k = 0; k < 8; k++) b->extent[k] = q->extent[8*i + k]*PetscMax(1.0, stretch);
    return;
  }
  b->radius[0] = b->radius[1] = p->params.kernel == PROXY_KERNEL_SPHERE ? h : R*stretch;
  if (p->params.kernel == PROXY_KERNEL_ELLIPSOID && (p->params.thin ? OnSharpEdge(p, i) : q->kind[i] != PROXY_FACE)) {
    b->radius[0] = q->kind[i] == PROXY_EDGE ? R*length/q->edge0[s->triangle_edges[3*t + q->side[i]]] : h;
    b->radius[1] = h;
  }
  b->inset = p->inset;
  for (int k = 0; k < 3; k++) b->x[k] -= p->inset*b->n[k];
}

static PetscErrorCode PlaceProxies(Proxy p)
{
  const ProxySampling *q = &p->sampling;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static)
  for (PetscInt i = 0; i < q->n; i++) PlacePoint(p, i, &p->points[i]);
#pragma omp parallel for schedule(static)
  for (PetscInt i = 0; i < q->n; i++) PlaceSupport(p, i, &p->points[i]);
  if (p->params.kernel != PROXY_KERNEL_HALF_SPACE) PetscCall(ProxyEllipsoidVolumes(p->fluid.kernel, p->fluid.h, p->factor, q->n, p->points));

  // nodal shares of the area
  PetscCall(PetscArrayzero(p->node_weight, p->surface.n_nodes));
  for (PetscInt i = 0; i < q->n; i++) {
    for (int c = 0; c < 3; c++) p->node_weight[q->nodes[3*i + c]] += p->area[i]*q->weights[3*i + c];
  }
  p->cells_valid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PlaceVelocities(Proxy p)
{
  const ProxySampling *q = &p->sampling;

  PetscFunctionBegin;
  if (!p->node_velocity) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < q->n; i++) {
    for (int k = 0; k < 3; k++) {
      p->velocity[3*i + k] = 0.0;
      for (int c = 0; c < 3; c++) p->velocity[3*i + k] += q->weights[3*i + c]*p->node_velocity[3*q->nodes[3*i + c] + k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Sample(Proxy p)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(EventSample, 0, 0, 0, 0));
  PetscCall(ProxySample(&p->surface, &p->geometry, &p->params, &p->fluid, p->density, &p->sampling));
  PetscCall(Reserve(p, p->sampling.n));
  for (PetscInt i = 0; i < p->sampling.n; i++) {
    PlacePoint(p, i, &p->points[i]);
    (void)PlaceTangent(p, i, &p->points[i]);
  }
  PetscCall(ProxyMeasureParts(&p->surface, &p->geometry, p->points, &p->sampling));
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
  ProxyGeometryUpdate(&p->surface, PROXY_CURVATURE/p->fluid.h, &p->geometry);
  PetscCall(Sample(p));
  PetscCall(PlaceProxies(p));
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
  afresh when an edge or area has changed by more than resample_tolerance since the last sampling; then the number of proxies may
  change. A surface that has not moved costs a comparison.
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
    ProxyGeometryUpdate(&p->surface, PROXY_CURVATURE/p->fluid.h, &p->geometry);
    if (p->params.resample_tolerance == 0.0 || Change(p) > p->params.resample_tolerance) PetscCall(Sample(p));
    PetscCall(PlaceProxies(p));
  }
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
  PetscCall(PlaceVelocities(p));
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
  ProxyGeometryUpdate(&p->surface, PROXY_CURVATURE/p->fluid.h, &p->geometry);
  PetscCall(Sample(p));
  PetscCall(PlaceProxies(p));
  PetscCall(PlaceVelocities(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyGetInterpolation(Proxy p, PetscInt *n_proxies, const PetscInt *nodes[], const PetscReal *weights[])
{
  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  if (n_proxies) *n_proxies = p->sampling.n;
  if (nodes) *nodes = p->sampling.nodes;
  if (weights) *weights = p->sampling.weights;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyGetPoints(Proxy p, PetscInt *n, const PetscReal *x[], const PetscReal *normal[], const PetscReal *kappa[], const PetscReal *area[])
{
  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  if (n) *n = p->sampling.n;
  if (x) *x = p->x;
  if (normal) *normal = p->normal;
  if (kappa) *kappa = p->sampling.kappa;
  if (area) *area = p->area;
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
    for (PetscInt i = 0; i < p->sampling.n; i++) area += p->area[i];
    PetscCall(PetscViewerASCIIPrintf(viewer, "proxies %" PetscInt_FMT ", triangles %" PetscInt_FMT ", smooth patches %" PetscInt_FMT ", area %g m^2, factor %g, sampled %" PetscInt_FMT " times\n", p->sampling.n, p->surface.n_triangles, p->surface.n_patches, (double)area, (double)p->factor, p->n_samplings));
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
  PetscCall(PetscFree(p->reach));
  PetscCall(PetscFree7(p->points, p->x, p->normal, p->area, p->velocity, p->force, p->centre));
  PetscCall(PetscFree(p->node_velocity));
  PetscCall(PetscFree(p->node_weight));
  PetscCall(PetscFree(p->density));
  PetscCall(PetscHeaderDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
