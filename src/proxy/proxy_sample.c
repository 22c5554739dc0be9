/* proxy_sample.c - where the proxies are: candidates on vertices, edges and triangles, thinned to the wanted spacing, and the part
   of the surface that each stands for (method 4.2). */
#include "proxy/proxy_impl.h"
#include "proxy/proxy_grid.h"

/* Kept proxies are this many wanted spacings apart: random sequential packing at distance r reaches 0.70 points per r^2
   (Torquato, Random Heterogeneous Materials, 2002, table 3.6: coverage 0.547), so r = 0.83 d gives one per d^2, the wanted density. */
#define THINNING 0.83

typedef struct {
  PetscInt  triangle, patch;
  PetscReal b[3], kappa;
  int       kind, side;
} Candidate;

typedef struct {
  PetscInt   n, capacity;
  Candidate *c;
} Candidates;

static PetscErrorCode Add(Candidates *list, PetscInt triangle, PetscInt patch, const PetscReal b[3], PetscReal kappa, ProxyKind kind, int side)
{
  Candidate *c;

  PetscFunctionBegin;
  if (list->n == list->capacity) {
    list->capacity = PetscMax(1024, 2*list->capacity);
    PetscCall(PetscRealloc(sizeof(Candidate)*(size_t)list->capacity, &list->c));
  }
  c           = &list->c[list->n++];
  c->triangle = triangle;
  c->patch    = patch;
  c->kappa    = kappa;
  c->kind     = kind;
  c->side     = side;
  for (int k = 0; k < 3; k++) c->b[k] = b[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PointOf(const ProxySurface *s, const PetscReal x[], PetscInt t, const PetscReal b[3], PetscReal p[3])
{
  const PetscInt *v = &s->triangles[3*t];
  for (int k = 0; k < 3; k++) p[k] = b[0]*x[3*v[0] + k] + b[1]*x[3*v[1] + k] + b[2]*x[3*v[2] + k];
}

/* one per vertex and smooth side of it, then edges at spacing h/(2 kappa(E)), on sharp edges once per side */
static PetscErrorCode AddVerticesAndEdges(const ProxySurface *s, const PetscReal x[], PetscReal h, const PetscReal node[], const PetscReal edge[],
                                          Candidates *list)
{
  PetscFunctionBegin;
  for (PetscInt f = 0; f < s->n_fans; f++) {
    const PetscInt c = s->fan_corner[s->fan_start[f]];
    PetscReal      b[3] = {0.0, 0.0, 0.0};
    b[c%3] = 1.0;
    PetscCall(Add(list, c/3, s->patch[c/3], b, node[s->triangles[c]], PROXY_VERTEX, -1));
  }
  for (PetscInt e = 0; e < s->n_edges; e++) {
    double         r[3];
    Sub3(&x[3*s->edge_nodes[2*e + 1]], &x[3*s->edge_nodes[2*e]], r);
    const PetscInt n = (PetscInt)floor(Norm3(r)/(h/(2.0*edge[e])) + 0.5);
    for (int half = 0; half < (s->edge_sharp[e] && s->edge_triangles[2*e + 1] >= 0 ? 2 : 1); half++) {
      const PetscInt t = s->edge_triangles[2*e + half], i = s->edge_side[2*e + half];
      for (PetscInt k = 1; k < n; k++) {
        PetscReal b[3] = {0.0, 0.0, 0.0};
        b[i] = (PetscReal)(n - k)/n;
        b[(i + 1)%3] = (PetscReal)k/n;
        PetscCall(Add(list, t, s->patch[t], b, edge[e], PROXY_EDGE, (int)i));
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* interiors: lines parallel to the shortest side, marching along its normal at spacing h/(2 kappa(T)) */
static PetscErrorCode AddInteriors(const ProxySurface *s, const ProxyGeometry *g, PetscReal h, const PetscReal triangle[], Candidates *list)
{
  PetscFunctionBegin;
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt *v = &s->triangles[3*t];
    const PetscReal d = h/(2.0*triangle[t]);
    PetscReal       l[3];
    int             base = 0;
    for (int i = 0; i < 3; i++) {
      double r[3];
      Sub3(&g->x[3*v[(i + 1)%3]], &g->x[3*v[i]], r);
      l[i] = Norm3(r);
      if (l[i] < l[base]) base = i;
    }
    const PetscInt n = (PetscInt)floor(2.0*g->area[t]/l[base]/d + 0.5);
    for (PetscInt k = 1; k < n; k++) {
      const PetscReal up = (PetscReal)k/n;
      const PetscInt  m  = (PetscInt)floor(l[base]*(1.0 - up)/d + 0.5);
      for (PetscInt j = 1; j < m; j++) {
        PetscReal b[3];
        b[base]         = (1.0 - up)*(PetscReal)(m - j)/m;
        b[(base + 1)%3] = (1.0 - up)*(PetscReal)j/m;
        b[(base + 2)%3] = 1.0 - b[base] - b[(base + 1)%3];
        PetscCall(Add(list, t, s->patch[t], b, triangle[t], PROXY_FACE, -1));
      }
      if (m < 2 && k < n) { // the line is shorter than the spacing: its middle
        PetscReal b[3];
        b[base] = b[(base + 1)%3] = 0.5*(1.0 - up);
        b[(base + 2)%3] = up;
        PetscCall(Add(list, t, s->patch[t], b, triangle[t], PROXY_FACE, -1));
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Greedy thinning in the order vertices, edges, triangles: a candidate stays when no kept one of its patch, on the same side of the
   body, is nearer than THINNING times the smaller wanted spacing. The kept are moved to the front, in order. */
static PetscErrorCode Thin(const ProxySurface *s, const ProxyGeometry *g, PetscReal h, Candidates *list)
{
  PointGrid  grid;
  PetscReal *x, d_max = 0.0;
  PetscInt   kept = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3*list->n, &x));
  for (PetscInt i = 0; i < list->n; i++) {
    PointOf(s, g->x, list->c[i].triangle, list->c[i].b, &x[3*i]);
    d_max = PetscMax(d_max, THINNING*h/(2.0*list->c[i].kappa));
  }
  PetscCall(PointGridCreate(s->n_nodes, g->x, d_max, list->n, &grid));
  for (PetscInt i = 0; i < list->n; i++) {
    const Candidate *c = &list->c[i];
    const double    *n = &g->normal[3*c->triangle];
    PetscBool        keep = PETSC_TRUE;
    PetscInt         at[3];
    PointGridIndex(&grid, &x[3*i], at);
    for (PetscInt z = PetscMax(0, at[2] - 1); keep && z <= PetscMin(grid.dims[2] - 1, at[2] + 1); z++) {
      for (PetscInt y = PetscMax(0, at[1] - 1); keep && y <= PetscMin(grid.dims[1] - 1, at[1] + 1); y++) {
        for (PetscInt w = PetscMax(0, at[0] - 1); keep && w <= PetscMin(grid.dims[0] - 1, at[0] + 1); w++) {
          for (PetscInt j = grid.head[(z*grid.dims[1] + y)*grid.dims[0] + w]; keep && j >= 0; j = grid.next[j]) {
            const Candidate *o = &list->c[j];
            const double     d = THINNING*h/(2.0*PetscMax(c->kappa, o->kappa));
            double           r[3];
            if (o->patch != c->patch) continue;
            Sub3(&x[3*i], &x[3*j], r);
            if (Dot3(r, r) < d*d*(1.0 - 1e-9) && Dot3(n, &g->normal[3*o->triangle]) > 0.0) keep = PETSC_FALSE;
          }
        }
      }
    }
    if (!keep) continue;
    list->c[kept] = *c;
    for (int k = 0; k < 3; k++) x[3*kept + k] = x[3*i + k];
    PointGridAdd(&grid, kept, &x[3*kept]);
    kept++;
  }
  list->n = kept;
  PetscCall(PointGridDestroy(&grid));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the nearest proxy of `patch` to p on the side of normal n (any side when there is none): rings of cells outwards until no nearer one
   is possible; ties go to the lower number */
static PetscInt Nearest(const PointGrid *grid, const Candidates *list, const PetscReal x[], const ProxyGeometry *g, PetscInt patch,
                        const double p[3], const double n[3])
{
  PetscInt at[3], best = -1, any = -1, rings = PetscMax(grid->dims[0], PetscMax(grid->dims[1], grid->dims[2]));
  double   best2 = PETSC_MAX_REAL, any2 = PETSC_MAX_REAL;

  PointGridIndex(grid, p, at);
  for (PetscInt ring = 0; ring <= rings; ring++) {
    const double reach = (ring - 1)*grid->cell;
    if (best >= 0 && ring > 0 && best2 <= reach*reach) break;
    for (PetscInt z = PetscMax(0, at[2] - ring); z <= PetscMin(grid->dims[2] - 1, at[2] + ring); z++) {
      for (PetscInt y = PetscMax(0, at[1] - ring); y <= PetscMin(grid->dims[1] - 1, at[1] + ring); y++) {
        const PetscBool face = (PetscBool)(PetscAbsInt(z - at[2]) == ring || PetscAbsInt(y - at[1]) == ring);
        for (PetscInt w = at[0] - ring; w <= at[0] + ring; w += face || !ring ? 1 : 2*ring) {
          if (w < 0 || w >= grid->dims[0]) continue;
          for (PetscInt j = grid->head[(z*grid->dims[1] + y)*grid->dims[0] + w]; j >= 0; j = grid->next[j]) {
            double r[3];
            if (list->c[j].patch != patch) continue;
            Sub3(p, &x[3*j], r);
            const double d2 = Dot3(r, r);
            if (d2 < any2 || (d2 == any2 && j < any)) any2 = d2, any = j;
            if (Dot3(n, &g->normal[3*list->c[j].triangle]) <= 0.0) continue;
            if (d2 < best2 || (d2 == best2 && j < best)) best2 = d2, best = j;
          }
        }
      }
    }
  }
  return best >= 0 ? best : any;
}

typedef struct {
  PetscInt  proxy, triangle;
  PetscReal part;
} Part;

/* barycentric centre of the piece (i, j) of m^2: upward ones at (i + 1/3, j + 1/3)/m, downward ones at (i + 2/3, j + 2/3)/m */
void ProxyPieceCentre(PetscInt m, PetscInt i, PetscInt j, int down, PetscReal b[3])
{
  const PetscReal o = down ? 2.0/3.0 : 1.0/3.0;
  b[0] = 1.0 - (i + j + 2.0*o)/m;
  b[1] = (i + o)/m;
  b[2] = (j + o)/m;
}

/* Split every triangle into m^2 congruent ones (side at most a third of the spacing) and give each to the nearest proxy of its patch:
   parts[] gets (proxy, triangle, fraction), fractions of a triangle summing to 1. */
static PetscErrorCode SplitAreas(const ProxySurface *s, const ProxyGeometry *g, PetscReal h, const PetscReal kappa[], const Candidates *list,
                                 ProxySampling *sampling, PetscInt *n_parts, Part **parts)
{
  PointGrid  grid;
  PetscReal *x, spacing = 0.0;
  PetscInt  *first, *owner;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3*list->n, &x));
  PetscCall(PetscMalloc1(s->n_triangles + 1, &first));
  for (PetscInt i = 0; i < list->n; i++) {
    PointOf(s, g->x, list->c[i].triangle, list->c[i].b, &x[3*i]);
    spacing = PetscMax(spacing, h/(2.0*list->c[i].kappa));
  }
  PetscCall(PointGridCreate(s->n_nodes, g->x, spacing, list->n, &grid));
  for (PetscInt i = 0; i < list->n; i++) PointGridAdd(&grid, i, &x[3*i]);
  first[0] = 0;
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    double longest = 0.0, r[3];
    for (int i = 0; i < 3; i++) {
      Sub3(&g->x[3*s->triangles[3*t + (i + 1)%3]], &g->x[3*s->triangles[3*t + i]], r);
      longest = PetscMax(longest, Norm3(r));
    }
    const PetscInt m = PetscMax(1, (PetscInt)ceil(3.0*longest/(h/(2.0*kappa[t]))));
    first[t + 1] = first[t] + m*m;
  }
  PetscCall(PetscMalloc1(first[s->n_triangles], &owner));
#pragma omp parallel for schedule(dynamic, 64)
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt m = (PetscInt)floor(sqrt((double)(first[t + 1] - first[t])) + 0.5);
    PetscInt       k = first[t];
    for (PetscInt i = 0; i < m; i++) {
      for (PetscInt j = 0; j < m - i; j++) {
        for (int down = 0; down < (i + j < m - 1 ? 2 : 1); down++) {
          PetscReal b[3], p[3];
          ProxyPieceCentre(m, i, j, down, b);
          PointOf(s, g->x, t, b, p);
          owner[k++] = Nearest(&grid, list, x, g, s->patch[t], p, &g->normal[3*t]);
        }
      }
    }
  }

  // equal owners of a triangle's pieces together
  PetscCall(PetscMalloc1(first[s->n_triangles], parts));
  *n_parts = 0;
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt m2 = first[t + 1] - first[t], begin = *n_parts;
    for (PetscInt k = first[t]; k < first[t + 1]; k++) {
      PetscInt q = begin;
      while (q < *n_parts && (*parts)[q].proxy != owner[k]) q++;
      if (q == *n_parts) {
        (*parts)[q].proxy    = owner[k];
        (*parts)[q].triangle = t;
        (*parts)[q].part     = 0.0;
        (*n_parts)++;
      }
      (*parts)[q].part += 1.0;
    }
    for (PetscInt q = begin; q < *n_parts; q++) (*parts)[q].part /= (PetscReal)m2;
  }
  sampling->piece_start = first;
  sampling->piece_owner = owner;
  PetscCall(PointGridDestroy(&grid));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mean height above proxy b's osculating surface of a piece of triangle t: its corners are PieceCentre's + d/m, edge midpoints integrate
   quadratics exactly */
static double PieceHeight(const ProxySurface *s, const PetscReal x[], PetscInt t, const PetscReal centre[3], PetscInt m, const ProxyPoint *b)
{
  double sum = 0.0;

  for (int k = 0; k < 3; k++) { // midpoints lie a sixth of the piece's size towards the corners
    PetscReal w[3] = {centre[0] + 1.0/(6.0*m), centre[1] + 1.0/(6.0*m), centre[2] + 1.0/(6.0*m)};
    double    p[3], r[3], tangent[3], grad[3];
    w[k] -= 0.5/m;
    PointOf(s, x, t, w, p);
    Sub3(p, b->x, r);
    const double z0 = Dot3(b->n, r);
    for (int d = 0; d < 3; d++) tangent[d] = r[d] - z0*b->n[d];
    sum += ProxyHeight(b, z0, tangent, grad)/3.0;
  }
  return sum;
}

/* how far the corners of a piece reach from proxy b in its eight directions */
static void PieceExtent(const ProxySurface *s, const PetscReal x[], PetscInt t, const PetscReal centre[3], PetscInt m, const ProxyPoint *b,
                        PetscReal extent[8])
{
  double side[3];

  Cross3(b->n, b->e, side);
  for (int k = 0; k < 3; k++) {
    PetscReal w[3] = {centre[0] - 1.0/(3.0*m), centre[1] - 1.0/(3.0*m), centre[2] - 1.0/(3.0*m)};
    double    p[3], r[3];
    w[k] += 1.0/m;
    PointOf(s, x, t, w, p);
    Sub3(p, b->x, r);
    const double u = Dot3(b->e, r), v = Dot3(side, r), c[4] = {u, v, PetscSqrtReal(0.5)*(u + v), PetscSqrtReal(0.5)*(u - v)};
    for (int d = 0; d < 4; d++) {
      extent[d]     = PetscMax(extent[d], c[d]);
      extent[4 + d] = PetscMax(extent[4 + d], -c[d]);
    }
  }
}

/* The part of the surface that each proxy stands for. Its mean height above the osculating surface: a facetted ball lies inside the ball of
   its vertices, and it is the facets that displace the fluid. And how far it reaches from the proxy. points[] need position (on the
   surface), normal, tangent and shape. */
PetscErrorCode ProxyMeasureParts(const ProxySurface *s, const ProxyGeometry *g, const ProxyPoint points[], ProxySampling *q)
{
  PetscReal *area;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(q->n, &area));
  PetscCall(PetscArrayzero(q->offset, q->n));
  PetscCall(PetscArrayzero(q->extent, 8*q->n));
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt  m = (PetscInt)floor(sqrt((double)(q->piece_start[t + 1] - q->piece_start[t])) + 0.5);
    const PetscReal a = g->area[t]/((PetscReal)m*m);
    PetscInt        k = q->piece_start[t];
    for (PetscInt i = 0; i < m; i++) {
      for (PetscInt j = 0; j < m - i; j++) {
        for (int down = 0; down < (i + j < m - 1 ? 2 : 1); down++) {
          const PetscInt owner = q->piece_owner[k++];
          PetscReal      b[3];
          ProxyPieceCentre(m, i, j, down, b);
          q->offset[owner] += a*PieceHeight(s, g->x, t, b, down ? -m : m, &points[owner]);
          PieceExtent(s, g->x, t, b, down ? -m : m, &points[owner], &q->extent[8*owner]);
          area[owner] += a;
        }
      }
    }
  }
  for (PetscInt i = 0; i < q->n; i++) q->offset[i] = area[i] > 0.0 ? q->offset[i]/area[i] : 0.0;
  PetscCall(PetscFree(area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Store(const ProxySurface *s, const ProxyGeometry *g, const Candidates *list, PetscInt n_parts, const Part parts[],
                            ProxySampling *sampling)
{
  PetscInt n = list->n;

  PetscFunctionBegin;
  sampling->n = n;
  PetscCall(PetscMalloc6(n, &sampling->triangle, 3*n, &sampling->nodes, 3*n, &sampling->weights, n, &sampling->kappa, n, &sampling->kind, n,
                         &sampling->side));
  PetscCall(PetscMalloc3(n + 2, &sampling->part_start, n_parts, &sampling->part_triangle, n_parts, &sampling->part));
  PetscCall(PetscMalloc5(s->n_triangles, &sampling->area0, s->n_edges, &sampling->edge0, 3*s->n_nodes, &sampling->x, n, &sampling->offset, 8*n,
                         &sampling->extent));
  PetscCall(PetscArrayzero(sampling->offset, n));
  PetscCall(PetscArrayzero(sampling->extent, 8*n));
  for (PetscInt i = 0; i < n; i++) {
    const Candidate *c = &list->c[i];
    sampling->triangle[i] = c->triangle;
    sampling->kappa[i]    = c->kappa;
    sampling->kind[i]     = c->kind;
    sampling->side[i]     = c->side;
    for (int k = 0; k < 3; k++) {
      sampling->nodes[3*i + k]   = s->triangles[3*c->triangle + k];
      sampling->weights[3*i + k] = c->b[k];
    }
  }

  // parts by proxy
  PetscCall(PetscArrayzero(sampling->part_start, n + 2));
  for (PetscInt q = 0; q < n_parts; q++) sampling->part_start[parts[q].proxy + 2]++;
  for (PetscInt i = 0; i < n; i++) sampling->part_start[i + 2] += sampling->part_start[i + 1];
  for (PetscInt q = 0; q < n_parts; q++) {
    const PetscInt at = sampling->part_start[parts[q].proxy + 1]++;
    sampling->part_triangle[at] = parts[q].triangle;
    sampling->part[at]          = parts[q].part;
  }

  PetscCall(PetscArraycpy(sampling->area0, g->area, s->n_triangles));
  PetscCall(PetscArraycpy(sampling->x, g->x, 3*s->n_nodes));
  for (PetscInt e = 0; e < s->n_edges; e++) {
    double r[3];
    Sub3(&g->x[3*s->edge_nodes[2*e + 1]], &g->x[3*s->edge_nodes[2*e]], r);
    sampling->edge0[e] = Norm3(r);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sample the surface where it is now (method 4.2). The sampling is complete: the proxies' areas sum to the surface's. */
PetscErrorCode ProxySample(const ProxySurface *s, const ProxyGeometry *g, const ProxyParams *params, const ProxyFluid *fluid,
                           const PetscReal density[], ProxySampling *sampling)
{
  Candidates list = {0, 0, NULL};
  PetscReal *node, *edge, *triangle;
  Part      *parts;
  PetscInt   n_parts;

  PetscFunctionBegin;
  PetscCall(ProxySamplingDestroy(sampling));
  PetscCall(PetscMalloc3(s->n_nodes, &node, s->n_edges, &edge, s->n_triangles, &triangle));
  PetscCall(ProxyNormalizedCurvature(s, g, params, fluid->h, density, node, edge, triangle));
  PetscCall(AddVerticesAndEdges(s, g->x, fluid->h, node, edge, &list));
  PetscCall(AddInteriors(s, g, fluid->h, triangle, &list));
  if (params->thin) PetscCall(Thin(s, g, fluid->h, &list));
  PetscCall(SplitAreas(s, g, fluid->h, triangle, &list, sampling, &n_parts, &parts));
  PetscCall(Store(s, g, &list, n_parts, parts, sampling));
  PetscCall(ProxySpreadPattern(s, sampling));
  PetscCall(PetscFree(parts));
  PetscCall(PetscFree(list.c));
  PetscCall(PetscFree3(node, edge, triangle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxySamplingDestroy(ProxySampling *p)
{
  PetscFunctionBegin;
  PetscCall(PetscFree6(p->triangle, p->nodes, p->weights, p->kappa, p->kind, p->side));
  PetscCall(PetscFree3(p->part_start, p->part_triangle, p->part));
  PetscCall(PetscFree4(p->spread_start, p->spread_node, p->part_slot, p->part_middle));
  PetscCall(PetscFree5(p->area0, p->edge0, p->x, p->offset, p->extent));
  PetscCall(PetscFree(p->piece_start));
  PetscCall(PetscFree(p->piece_owner));
  PetscCall(PetscMemzero(p, sizeof(*p)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
