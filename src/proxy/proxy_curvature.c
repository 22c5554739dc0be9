/* proxy_curvature.c - differential geometry of the triangle surface: Gaussian curvature, vertex normals, shape operators
   (method 4.1, 4.4). */
#include "proxy/proxy_impl.h"

PetscErrorCode ProxyGeometryCreate(const ProxySurface *s, ProxyGeometry *g)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc5(3*s->n_nodes, &g->x, s->n_triangles, &g->area, 3*s->n_triangles, &g->normal, 9*s->n_triangles, &g->fan_normal,
                         6*s->n_triangles, &g->shape));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxyGeometryDestroy(ProxyGeometry *g)
{
  PetscFunctionBegin;
  PetscCall(PetscFree5(g->x, g->area, g->normal, g->fan_normal, g->shape));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* edges of a triangle: e[i] from corner i to corner i + 1 */
static inline void TriangleEdges(const PetscInt v[3], const PetscReal x[], double e[3][3])
{
  for (int i = 0; i < 3; i++) Sub3(&x[3*v[(i + 1)%3]], &x[3*v[i]], e[i]);
}

/* Normal of a vertex fan with Max's weights: n ~ sum e1 x e2 / (|e1|^2 |e2|^2), exact when the vertices lie on a sphere.
   N. Max, Weights for computing vertex normals from facet normals, J. Graphics Tools 4 (1999), eq. 2. */
static void FanNormal(const ProxySurface *s, const ProxyGeometry *g, PetscInt fan, double n[3])
{
  double l;

  n[0] = n[1] = n[2] = 0.0;
  for (PetscInt k = s->fan_start[fan]; k < s->fan_start[fan + 1]; k++) {
    const PetscInt  c = s->fan_corner[k], i = c%3, t = c/3;
    const PetscInt *v = &s->triangles[3*t];
    double          e1[3], e2[3], a[3];
    Sub3(&g->x[3*v[(i + 1)%3]], &g->x[3*v[i]], e1);
    Sub3(&g->x[3*v[(i + 2)%3]], &g->x[3*v[i]], e2);
    Cross3(e1, e2, a);
    l = 1.0 / (Dot3(e1, e1) * Dot3(e2, e2));
    for (int d = 0; d < 3; d++) n[d] += l*a[d];
  }
  l = Norm3(n);
  for (int d = 0; d < 3; d++) n[d] = l > 0.0 ? n[d]/l : g->normal[3*(s->fan_corner[s->fan_start[fan]]/3) + d];
}

/* Bound the principal curvatures: S is scaled down so that none exceeds max_curvature [1/m]. Beyond about 1/h the osculating
   surface has no meaning at the kernel's scale (lambda_H would no longer fall with distance). */
void ProxyShapeBound(PetscReal max_curvature, double S[6])
{
  const double mean = 0.5*(S[0] + S[1] + S[2]);
  const double square = S[0]*S[0] + S[1]*S[1] + S[2]*S[2] + 2.0*(S[3]*S[3] + S[4]*S[4] + S[5]*S[5]);
  const double top = fabs(mean) + sqrt(PetscMax(0.0, 0.5*square - mean*mean));

  if (top <= max_curvature) return;
  for (int k = 0; k < 6; k++) S[k] *= max_curvature/top;
}

/* Shape operator of a triangle from its three vertex normals: least squares of S e = dn along the edges, in the triangle's plane.
   S. Rusinkiewicz, Estimating curvatures and their derivatives on triangle meshes, 3DPVT 2004, sec. 3, eq. 5. Flat: 0. */
static void TriangleShape(const ProxySurface *s, const ProxyGeometry *g, PetscInt t, double S[6])
{
  const double *n = &g->normal[3*t];
  double        e[3][3], u[3], v[3], A[9] = {0}, B[9], rhs[3] = {0}, abc[3], scale;

  TriangleEdges(&s->triangles[3*t], g->x, e);
  const double l = Norm3(e[0]);
  for (int d = 0; d < 3; d++) u[d] = e[0][d]/l;
  Cross3(n, u, v);
  scale = 1.0/l;
  for (int i = 0; i < 3; i++) {
    double       dn[3];
    Sub3(&g->fan_normal[3*s->fan[3*t + (i + 1)%3]], &g->fan_normal[3*s->fan[3*t + i]], dn);
    const double p = scale*Dot3(e[i], u), q = scale*Dot3(e[i], v), m = Dot3(dn, u), w = Dot3(dn, v);
    A[0] += p*p;
    A[1] += p*q;
    A[4] += p*p + q*q;
    A[8] += q*q;
    rhs[0] += p*m;
    rhs[1] += q*m + p*w;
    rhs[2] += q*w;
  }
  A[3] = A[5] = A[7] = A[1];
  for (int k = 0; k < 6; k++) S[k] = 0.0;
  if (Invert3(A, B) == 0.0) return;
  Mul3(B, rhs, abc);
  for (int k = 0; k < 3; k++) S[k] = scale*(abc[0]*u[k]*u[k] + 2.0*abc[1]*u[k]*v[k] + abc[2]*v[k]*v[k]);
  for (int k = 0; k < 3; k++) {
    const int i = k == 2 ? 1 : 0, j = k == 0 ? 1 : 2;
    S[3 + k] = scale*(abc[0]*u[i]*u[j] + abc[1]*(u[i]*v[j] + u[j]*v[i]) + abc[2]*v[i]*v[j]);
  }
}

void ProxyGeometryUpdate(const ProxySurface *s, PetscReal max_curvature, ProxyGeometry *g)
{
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (PetscInt t = 0; t < s->n_triangles; t++) {
      double e[3][3], c[3];
      TriangleEdges(&s->triangles[3*t], g->x, e);
      Cross3(e[0], e[1], c);
      const double l = Norm3(c);
      g->area[t] = 0.5*l;
      for (int d = 0; d < 3; d++) g->normal[3*t + d] = l > 0.0 ? c[d]/l : 0.0;
    }
#pragma omp for schedule(static)
    for (PetscInt f = 0; f < s->n_fans; f++) FanNormal(s, g, f, &g->fan_normal[3*f]);
#pragma omp for schedule(static)
    for (PetscInt t = 0; t < s->n_triangles; t++) {
      TriangleShape(s, g, t, &g->shape[6*t]);
      ProxyShapeBound(max_curvature, &g->shape[6*t]);
    }
  }
}

/* Gaussian curvature of every surface node by the angle deficit over the mixed Voronoi area (method 4.1, [Meyer03] sec. 3.3
   and 4, eq. 9): kappa_G = (2 pi - sum theta)/A_mixed, pi instead of 2 pi on open borders. */
PetscErrorCode ProxyGaussianCurvature(const ProxySurface *s, const PetscReal x[], PetscReal kappa[], PetscReal area[])
{
  PetscFunctionBegin;
  for (PetscInt v = 0; v < s->n_nodes; v++) area[v] = kappa[v] = 0.0;
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    for (int i = 0; i < 3; i++) kappa[s->triangles[3*t + i]] = 2.0*BY_PI;
  }
  for (PetscInt e = 0; e < s->n_edges; e++) {
    if (s->edge_triangles[2*e + 1] < 0) kappa[s->edge_nodes[2*e]] = kappa[s->edge_nodes[2*e + 1]] = BY_PI;
  }
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt *v = &s->triangles[3*t];
    double          e[3][3], c[3], cot[3], dot[3];
    int             obtuse = -1;
    TriangleEdges(v, x, e);
    Cross3(e[0], e[1], c);
    const double twice = Norm3(c);
    for (int i = 0; i < 3; i++) {
      dot[i] = -Dot3(e[i], e[(i + 2)%3]); // of the two edges that leave corner i
      cot[i] = dot[i]/twice;
      kappa[v[i]] -= atan2(twice, dot[i]);
      if (dot[i] < 0.0) obtuse = i;
    }
    for (int i = 0; i < 3; i++) {
      const int j = (i + 1)%3, k = (i + 2)%3;
      if (obtuse < 0) area[v[i]] += (Dot3(e[i], e[i])*cot[k] + Dot3(e[k], e[k])*cot[j])/8.0;
      else area[v[i]] += 0.5*twice * (obtuse == i ? 0.5 : 0.25);
    }
  }
  for (PetscInt v = 0; v < s->n_nodes; v++) kappa[v] = area[v] > 0.0 ? kappa[v]/area[v] : 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* range [lo, hi] of |kappa| that maps onto [eta_min, eta_max] */
static PetscErrorCode CurvatureRange(const ProxyParams *params, PetscReal h, PetscInt n, PetscReal sorted[], PetscReal *lo, PetscReal *hi)
{
  PetscFunctionBegin;
  PetscCall(PetscSortReal(n, sorted));
  *lo = sorted[0];
  *hi = sorted[n - 1];
  // robust: 5th to 95th percentile; kappa h^2 >= 1 counts as full, and a spread of kappa h^2 below 0.1 as no difference at all
  if (params->range == PROXY_RANGE_ROBUST) {
    *lo = PetscMin(sorted[n/20], 0.9/(h*h));
    *hi = PetscMin(sorted[n - 1 - n/20], 1.0/(h*h));
    *hi = PetscMax(*hi, *lo + 0.1/(h*h));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Normalized(const ProxyParams *params, PetscReal lo, PetscReal hi, PetscReal kappa)
{
  const PetscReal part = hi > lo ? PetscMax(0.0, PetscMin(1.0, (kappa - lo)/(hi - lo))) : 0.0;
  return params->eta_min + (params->eta_max - params->eta_min)*part;
}

/* Gaussian measure (method 4.1): edges 0.6 A + 0.4 B, triangles 0.5 A + 0.3 B + 0.2 C with |kappa| sorted */
static PetscErrorCode GaussianMeasure(const ProxySurface *s, const PetscReal x[], const ProxyParams *params, PetscReal h, PetscReal node[],
                                      PetscReal edge[], PetscReal triangle[])
{
  PetscReal *kappa, *area, *sorted, lo = 0.0, hi = 0.0;
  PetscInt   n = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(s->n_nodes, &kappa, s->n_nodes, &area, s->n_nodes, &sorted));
  PetscCall(ProxyGaussianCurvature(s, x, kappa, area));
  for (PetscInt v = 0; v < s->n_nodes; v++) {
    kappa[v] = PetscAbsReal(kappa[v]);
    if (area[v] > 0.0) sorted[n++] = kappa[v];
  }
  if (n) PetscCall(CurvatureRange(params, h, n, sorted, &lo, &hi));
  for (PetscInt v = 0; v < s->n_nodes; v++) node[v] = Normalized(params, lo, hi, kappa[v]);
  for (PetscInt e = 0; e < s->n_edges; e++) {
    const PetscReal a = kappa[s->edge_nodes[2*e]], b = kappa[s->edge_nodes[2*e + 1]];
    edge[e] = Normalized(params, lo, hi, 0.6*PetscMax(a, b) + 0.4*PetscMin(a, b));
  }
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt *v = &s->triangles[3*t];
    const PetscReal a = kappa[v[0]], b = kappa[v[1]], c = kappa[v[2]];
    const PetscReal top = PetscMax(a, PetscMax(b, c)), low = PetscMin(a, PetscMin(b, c));
    triangle[t] = Normalized(params, lo, hi, 0.5*top + 0.3*(a + b + c - top - low) + 0.2*low);
  }
  PetscCall(PetscFree3(kappa, area, sorted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Principal measure: kappa-bar = |kappa|_max h, so that a support's radius h/kappa-bar stays within the radius of curvature, also on the
   ridges and cylinders that Gaussian curvature does not see. Shape operators are noise below the kernel's scale: |S| is averaged over
   neighbours as often as a random walk of that many edges takes to go h/2. */
static PetscErrorCode PrincipalMeasure(const ProxySurface *s, const ProxyGeometry *g, const ProxyParams *params, PetscReal h, PetscReal node[],
                                       PetscReal edge[], PetscReal triangle[])
{
  PetscReal *next, *weight, length = 0.0;
  PetscInt   passes;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(s->n_triangles, &next, s->n_nodes, &weight));
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const double *S = &g->shape[6*t];
    const double  mean = 0.5*(S[0] + S[1] + S[2]), square = S[0]*S[0] + S[1]*S[1] + S[2]*S[2] + 2.0*(S[3]*S[3] + S[4]*S[4] + S[5]*S[5]);
    triangle[t] = fabs(mean) + sqrt(PetscMax(0.0, 0.5*square - mean*mean));
    length += sqrt(2.0*g->area[t])/s->n_triangles;
  }
  passes = (PetscInt)PetscMin(20.0, 0.25*h*h/(length*length));
  for (PetscInt pass = 0; pass < passes; pass++) {
    for (PetscInt t = 0; t < s->n_triangles; t++) {
      PetscReal sum = g->area[t]*triangle[t], area = g->area[t];
      for (int i = 0; i < 3; i++) {
        const PetscInt e = s->triangle_edges[3*t + i], o = s->edge_triangles[2*e] == t ? s->edge_triangles[2*e + 1] : s->edge_triangles[2*e];
        if (s->edge_sharp[e]) continue;
        sum += g->area[o]*triangle[o];
        area += g->area[o];
      }
      next[t] = sum/area;
    }
    PetscCall(PetscArraycpy(triangle, next, s->n_triangles));
  }
  PetscCall(PetscArrayzero(weight, s->n_nodes));
  PetscCall(PetscArrayzero(node, s->n_nodes));
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    triangle[t] = PetscMin(params->eta_max, PetscMax(params->eta_min, triangle[t]*h));
    for (int i = 0; i < 3; i++) {
      node[s->triangles[3*t + i]] += g->area[t]*triangle[t];
      weight[s->triangles[3*t + i]] += g->area[t];
    }
  }
  for (PetscInt v = 0; v < s->n_nodes; v++) node[v] = weight[v] > 0.0 ? node[v]/weight[v] : params->eta_min;
  for (PetscInt e = 0; e < s->n_edges; e++) edge[e] = 0.5*(node[s->edge_nodes[2*e]] + node[s->edge_nodes[2*e + 1]]);
  PetscCall(PetscFree2(next, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* kappa-bar of nodes, edges and triangles: means of `density` where it is given, one value when the sampling is uniform, else
   in [eta_min, eta_max] */
PetscErrorCode ProxyNormalizedCurvature(const ProxySurface *s, const ProxyGeometry *g, const ProxyParams *params, PetscReal h,
                                        const PetscReal density[], PetscReal node[], PetscReal edge[], PetscReal triangle[])
{
  PetscFunctionBegin;
  if (density || !params->adaptive || params->kappa > 0.0) {
    for (PetscInt v = 0; v < s->n_nodes; v++) node[v] = density ? density[v] : params->kappa > 0.0 ? params->kappa : 1.0;
    for (PetscInt e = 0; e < s->n_edges; e++) edge[e] = 0.5*(node[s->edge_nodes[2*e]] + node[s->edge_nodes[2*e + 1]]);
    for (PetscInt t = 0; t < s->n_triangles; t++) triangle[t] = (node[s->triangles[3*t]] + node[s->triangles[3*t + 1]] + node[s->triangles[3*t + 2]])/3.0;
  } else if (params->measure == PROXY_MEASURE_PRINCIPAL) {
    PetscCall(PrincipalMeasure(s, g, params, h, node, edge, triangle));
  } else {
    PetscCall(GaussianMeasure(s, g->x, params, h, node, edge, triangle));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
