/* proxy_place.c - proxies on the surface as it is: positions, normals, shape operators, supports, velocities of those in use. */
#include "proxy/proxy_impl.h"

/* room for n proxies */
static PetscErrorCode Reserve(Proxy p, PetscInt n)
{
  PetscFunctionBegin;
  if (n <= p->capacity) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProxyPlaceDestroy(p));
  p->capacity = n + n/4;
  PetscCall(PetscMalloc2(p->capacity, &p->reach, p->capacity, &p->points));
  PetscCall(PetscMalloc6(p->capacity, &p->active, p->capacity, &p->near, 3*p->capacity, &p->nodes, p->capacity, &p->patch, 3*p->capacity, &p->weights, p->capacity, &p->kappa));
  PetscCall(PetscMalloc7(3*p->capacity, &p->x, 3*p->capacity, &p->normal, p->capacity, &p->area, 3*p->capacity, &p->velocity, 3*p->capacity, &p->force, 3*p->capacity,
                         &p->centre, p->capacity, &p->exposed));
  PetscCall(PetscMalloc2(p->capacity, &p->laid, p->capacity, &p->lies_on));
  PetscCall(PetscArrayzero(p->force, 3*p->capacity));
  PetscCall(PetscArrayzero(p->points, p->capacity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyPlaceDestroy(Proxy p)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(p->reach, p->points));
  PetscCall(PetscFree6(p->active, p->near, p->nodes, p->patch, p->weights, p->kappa));
  PetscCall(PetscFree7(p->x, p->normal, p->area, p->velocity, p->force, p->centre, p->exposed));
  PetscCall(PetscFree2(p->laid, p->lies_on));
  PetscCall(PetscFree4(p->spread_start, p->spread_node, p->spread_weight, p->place));
  p->capacity = p->n = p->spread_capacity = p->place_capacity = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* position, normal, area and shape operator of the proxy that is number j in use, i of the sampling, on the surface as it is */
static void PlacePoint(Proxy p, PetscInt j, PetscInt i, ProxyPoint *b)
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
    p->centre[3*j + k]  = area > 0.0 ? centre[k]/area : x[k];
    p->x[3*j + k]       = b->x[k] = x[k];
    p->normal[3*j + k]  = b->n[k] = n[k];
    p->nodes[3*j + k]   = q->nodes[3*i + k];
    p->weights[3*j + k] = q->weights[3*i + k];
  }
  p->patch[j] = s->patch[t];
  p->kappa[j] = q->kappa[i];
  for (int m = 0; m < 6; m++) b->S[m] = S[m];
  b->bend    = ProxyShapeBend(S);
  b->offset  = q->offset[i] - (p->params.kernel == PROXY_KERNEL_HALF_SPACE ? p->inset : 0.0);
  p->area[j] = b->weight = area;
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

/* the proxies that active[] has, supports and volumes */
static PetscErrorCode PlaceActive(Proxy p)
{
  PetscFunctionBegin;
#pragma omp parallel for schedule(static)
  for (PetscInt j = 0; j < p->n; j++) {
    PlacePoint(p, j, p->active[j], &p->points[j]);
    PlaceSupport(p, p->active[j], &p->points[j]);
  }
  if (p->params.kernel != PROXY_KERNEL_HALF_SPACE) PetscCall(ProxyEllipsoidVolumes(p->fluid.kernel, p->fluid.h, p->factor, p->n, p->points));
  p->cells_valid = p->spread_valid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TakeAll(Proxy p)
{
  PetscFunctionBegin;
  PetscCall(Reserve(p, p->sampling.n));
  p->n = p->sampling.n;
  p->spread_valid = PETSC_FALSE;
  for (PetscInt i = 0; i < p->n; i++) p->active[i] = i;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyPlaceSampled(Proxy p)
{
  PetscFunctionBegin;
  PetscCall(TakeAll(p));
  for (PetscInt i = 0; i < p->n; i++) {
    PlacePoint(p, i, i, &p->points[i]);
    (void)PlaceTangent(p, i, &p->points[i]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyPlaceAll(Proxy p)
{
  PetscFunctionBegin;
  PetscCall(TakeAll(p));
  PetscCall(PlaceActive(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* move what proxy `from` has to `to`, before it */
static void MoveDown(Proxy p, PetscInt from, PetscInt to)
{
  p->points[to] = p->points[from];
  p->active[to] = p->active[from];
  p->patch[to]  = p->patch[from];
  p->kappa[to]  = p->kappa[from];
  p->area[to]   = p->area[from];
  for (int k = 0; k < 3; k++) {
    p->nodes[3*to + k]   = p->nodes[3*from + k];
    p->weights[3*to + k] = p->weights[3*from + k];
    p->x[3*to + k]       = p->x[3*from + k];
    p->normal[3*to + k]  = p->normal[3*from + k];
    p->centre[3*to + k]  = p->centre[3*from + k];
  }
}

/* drop what the second sieve drops */
static PetscErrorCode KeepTouching(Proxy p)
{
  PetscBool *keep;
  PetscInt   kept = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(p->n, &keep));
  ProxyMaskAfter(p, keep);
  for (PetscInt j = 0; j < p->n; j++) {
    if (!keep[j]) continue;
    if (kept < j) MoveDown(p, j, kept);
    kept++;
  }
  p->n = kept;
  p->spread_valid = PETSC_FALSE;
  PetscCall(PetscFree(keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A surface that moves: balls around supports of any shape before placing, the supports themselves after it. One at rest: its supports are
   known once all have been placed, and it is placed again only when others are near. Both leave the same proxies. An ellipsoid's volume
   depends on its neighbours, so that those are always placed all. */
PetscErrorCode ProxyPlaceNear(Proxy p, PetscBool moved, PetscInt n, const PetscReal x[])
{
  const PetscBool all = (PetscBool)(p->params.kernel != PROXY_KERNEL_HALF_SPACE);
  PetscInt        n_near;
  PetscBool       same = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(Reserve(p, p->sampling.n));
  if (!moved && !p->mask.has_boxes) {
    PetscCall(ProxyMaskBefore(p, PETSC_TRUE, 0, x, p->near, &n_near));
    PetscCall(ProxyPlaceAll(p));
    ProxyMaskBoxes(p);
  }
  PetscCall(ProxyMaskBefore(p, moved, n, x, p->near, &n_near));
  if (!moved && n_near == p->n) PetscCall(PetscArraycmp(p->near, p->active, p->n, &same));
  if (same) PetscFunctionReturn(PETSC_SUCCESS);
  if (all) PetscCall(ProxyPlaceAll(p));
  else {
    p->n = n_near;
    PetscCall(PetscArraycpy(p->active, p->near, n_near));
    PetscCall(PlaceActive(p));
  }
  if (moved || all) PetscCall(KeepTouching(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyPlaceVelocities(Proxy p)
{
  PetscFunctionBegin;
  if (!p->node_velocity) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProxyVelocitiesFromNodes(p, p->node_velocity, p->velocity));
  PetscFunctionReturn(PETSC_SUCCESS);
}
