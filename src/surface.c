/* surface.c - orientation, winding numbers and distances of triangle surfaces; surface_read.c reads them. */
#include "surface.h"
#include "mat3.h"

PetscErrorCode SurfaceDestroy(Surface *surface)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(surface->x));
  PetscCall(PetscFree(surface->triangles));
  surface->n_nodes = surface->n_triangles = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Triangles in a cubic bucket grid: a triangle is in every cell that its bounding box meets. */
typedef struct {
  double    lo[3], hi[3], cell;
  PetscInt  dims[3];
  PetscInt *start, *item;
} Buckets;

static void TriangleBox(const PetscReal x[], const PetscInt v[3], double lo[3], double hi[3])
{
  for (int k = 0; k < 3; k++) {
    lo[k] = PetscMin(x[3*v[0] + k], PetscMin(x[3*v[1] + k], x[3*v[2] + k]));
    hi[k] = PetscMax(x[3*v[0] + k], PetscMax(x[3*v[1] + k], x[3*v[2] + k]));
  }
}

static void BucketRange(const Buckets *b, const double lo[3], const double hi[3], PetscInt first[3], PetscInt last[3])
{
  for (int k = 0; k < 3; k++) {
    first[k] = (PetscInt)PetscMax(0.0, PetscMin(b->dims[k] - 1.0, floor((lo[k] - b->lo[k])/b->cell)));
    last[k]  = (PetscInt)PetscMax(0.0, PetscMin(b->dims[k] - 1.0, floor((hi[k] - b->lo[k])/b->cell)));
  }
}

/* cells of at least `cell`, larger when there would be more than eight per triangle */
static PetscErrorCode BucketsCreate(const PetscReal x[], PetscInt n, const PetscInt triangles[], double cell, Buckets *b)
{
  double   n_cells;
  PetscInt total;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) b->lo[k] = PETSC_MAX_REAL, b->hi[k] = -PETSC_MAX_REAL;
  for (PetscInt t = 0; t < n; t++) {
    double lo[3], hi[3];
    TriangleBox(x, &triangles[3*t], lo, hi);
    for (int k = 0; k < 3; k++) b->lo[k] = PetscMin(b->lo[k], lo[k]), b->hi[k] = PetscMax(b->hi[k], hi[k]);
  }
  b->cell = cell/1.26;
  do {
    b->cell *= 1.26;
    n_cells = 1.0;
    for (int k = 0; k < 3; k++) n_cells *= floor((b->hi[k] - b->lo[k])/b->cell) + 1.0;
  } while (n_cells > 8.0*n + 64.0);
  for (int k = 0; k < 3; k++) b->dims[k] = (PetscInt)floor((b->hi[k] - b->lo[k])/b->cell) + 1;
  total = b->dims[0]*b->dims[1]*b->dims[2];
  PetscCall(PetscCalloc1(total + 2, &b->start));
  b->item = NULL;
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt t = 0; t < n; t++) {
      double   lo[3], hi[3];
      PetscInt first[3], last[3];
      TriangleBox(x, &triangles[3*t], lo, hi);
      BucketRange(b, lo, hi, first, last);
      for (PetscInt k = first[2]; k <= last[2]; k++) {
        for (PetscInt j = first[1]; j <= last[1]; j++) {
          for (PetscInt i = first[0]; i <= last[0]; i++) {
            const PetscInt c = (k*b->dims[1] + j)*b->dims[0] + i;
            if (pass) b->item[b->start[c + 1]++] = t;
            else b->start[c + 2]++;
          }
        }
      }
    }
    if (pass) break;
    for (PetscInt c = 0; c < total; c++) b->start[c + 2] += b->start[c + 1];
    PetscCall(PetscMalloc1(PetscMax(1, b->start[total + 1]), &b->item));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BucketsDestroy(Buckets *b)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(b->start));
  PetscCall(PetscFree(b->item));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* squared distance of a point to a triangle: the plane where the foot is inside, else the nearest edge; the foot is a + v ab + w ac.
   C. Ericson, Real-Time Collision Detection, 2005, sec. 5.1.5 (Voronoi regions of the triangle). */
static double TriangleDistance2(const double p[3], const double a[3], const double b[3], const double c[3], double foot[2])
{
  double ab[3], ac[3], ap[3], bp[3], cp[3], r[3], v, w;

  Sub3(b, a, ab), Sub3(c, a, ac), Sub3(p, a, ap);
  const double d1 = Dot3(ab, ap), d2 = Dot3(ac, ap);
  foot[0] = foot[1] = 0.0;
  if (d1 <= 0.0 && d2 <= 0.0) return Dot3(ap, ap);
  Sub3(p, b, bp);
  const double d3 = Dot3(ab, bp), d4 = Dot3(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) {
    foot[0] = 1.0;
    return Dot3(bp, bp);
  }
  Sub3(p, c, cp);
  const double d5 = Dot3(ab, cp), d6 = Dot3(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) {
    foot[1] = 1.0;
    return Dot3(cp, cp);
  }
  const double va = d3*d6 - d5*d4, vb = d5*d2 - d1*d6, vc = d1*d4 - d3*d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) v = d1/(d1 - d3), w = 0.0;
  else if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) v = 0.0, w = d2/(d2 - d6);
  else if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) w = (d4 - d3)/((d4 - d3) + (d5 - d6)), v = 1.0 - w;
  else v = vb/(va + vb + vc), w = vc/(va + vb + vc);
  for (int k = 0; k < 3; k++) r[k] = ap[k] - v*ab[k] - w*ac[k];
  foot[0] = v, foot[1] = w;
  return Dot3(r, r);
}

PetscErrorCode SurfaceDistance(PetscInt n_points, const PetscReal points[], const PetscReal x[], PetscInt n_triangles,
                               const PetscInt triangles[], PetscReal reach, PetscReal distance[])
{
  PetscFunctionBegin;
  PetscCall(SurfaceClosest(n_points, points, x, n_triangles, triangles, reach, distance, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceClosest(PetscInt n_points, const PetscReal points[], const PetscReal x[], PetscInt n_triangles, const PetscInt triangles[],
                              PetscReal reach, PetscReal distance[], PetscInt triangle[], PetscReal weights[])
{
  Buckets b;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n_points; i++) distance[i] = PETSC_MAX_REAL;
  for (PetscInt i = 0; triangle && i < n_points; i++) triangle[i] = -1;
  if (!n_triangles || !(reach > 0.0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BucketsCreate(x, n_triangles, triangles, reach, &b));
#pragma omp parallel for schedule(dynamic, 256)
  for (PetscInt i = 0; i < n_points; i++) {
    const PetscReal *p = &points[3*i];
    double           best = reach*reach, lo[3], hi[3];
    PetscInt         first[3], last[3];
    int              outside = 0;
    for (int k = 0; k < 3; k++) {
      lo[k] = p[k] - reach, hi[k] = p[k] + reach;
      outside |= !(hi[k] >= b.lo[k] && lo[k] <= b.hi[k]);
    }
    if (outside) continue;
    BucketRange(&b, lo, hi, first, last);
    for (PetscInt z = first[2]; z <= last[2]; z++) {
      for (PetscInt y = first[1]; y <= last[1]; y++) {
        for (PetscInt w = first[0]; w <= last[0]; w++) {
          const PetscInt c = (z*b.dims[1] + y)*b.dims[0] + w;
          for (PetscInt k = b.start[c]; k < b.start[c + 1]; k++) {
            const PetscInt *v  = &triangles[3*b.item[k]];
            double          foot[2];
            const double    d2 = TriangleDistance2(p, &x[3*v[0]], &x[3*v[1]], &x[3*v[2]], foot);
            if (d2 > best) continue;
            best = d2, distance[i] = sqrt(d2);
            if (!triangle) continue;
            triangle[i]      = b.item[k];
            weights[3*i]     = 1.0 - foot[0] - foot[1];
            weights[3*i + 1] = foot[0];
            weights[3*i + 2] = foot[1];
          }
        }
      }
    }
  }
  PetscCall(BucketsDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A tree of triangle clusters. A cluster seen from far acts like a dipole at its centre: sum of area vectors N, first term of the
   expansion in G. Barill, Dickson, Schmidt, Levin & Jacobson, Fast winding numbers for soups and clouds, ACM TOG 37 (2018), eq. 9. */
typedef struct {
  double   centre[3], radius, N[3];
  PetscInt first, n, left, right; /* triangles order[first .. first + n); children, -1 in a leaf */
} Cluster;

typedef struct {
  const PetscReal *x;
  const PetscInt  *triangles;
  PetscInt        *order, n_clusters;
  double          *middle; /* n_triangles x 3, sum of the corners */
  Cluster         *cluster;
} ClusterTree;

#define LEAF 8          /* triangles in a leaf                                                                       */
#define FAR  4.0        /* seen from this many radii a cluster is a dipole: error of the whole number below 2e-3     */

static void Swap(PetscInt *a, PetscInt *b)
{
  const PetscInt c = *a;
  *a = *b, *b = c;
}

/* partial sort: the n/2 smallest middles along the axis come first (Hoare's selection) */
static void SplitMiddle(const ClusterTree *tree, PetscInt order[], PetscInt n, int axis)
{
  PetscInt lo = 0, hi = n - 1;
  const PetscInt k = n/2;

  while (lo < hi) {
    const double pivot = tree->middle[3*order[(lo + hi)/2] + axis];
    PetscInt     i = lo, j = hi;
    while (i <= j) {
      while (tree->middle[3*order[i] + axis] < pivot) i++;
      while (tree->middle[3*order[j] + axis] > pivot) j--;
      if (i <= j) Swap(&order[i++], &order[j--]);
    }
    if (k <= j) hi = j;
    else if (k >= i) lo = i;
    else return;
  }
}

static void FillCluster(const ClusterTree *tree, Cluster *c)
{
  double area = 0.0, r2 = 0.0;

  for (int k = 0; k < 3; k++) c->centre[k] = c->N[k] = 0.0;
  for (PetscInt i = c->first; i < c->first + c->n; i++) {
    const PetscInt  t = tree->order[i];
    const PetscInt *v = &tree->triangles[3*t];
    double          e1[3], e2[3], a[3], l;
    Sub3(&tree->x[3*v[1]], &tree->x[3*v[0]], e1);
    Sub3(&tree->x[3*v[2]], &tree->x[3*v[0]], e2);
    Cross3(e1, e2, a);
    l = Norm3(a);
    area += l;
    for (int k = 0; k < 3; k++) c->N[k] += 0.5*a[k], c->centre[k] += l*tree->middle[3*t + k]/3.0;
  }
  for (int k = 0; k < 3; k++) c->centre[k] = area > 0.0 ? c->centre[k]/area : tree->middle[3*tree->order[c->first] + k]/3.0;
  for (PetscInt i = c->first; i < c->first + c->n; i++) {
    for (int j = 0; j < 3; j++) {
      double r[3];
      Sub3(&tree->x[3*tree->triangles[3*tree->order[i] + j]], c->centre, r);
      r2 = PetscMax(r2, Dot3(r, r));
    }
  }
  c->radius = sqrt(r2);
}

/* clusters are split at the median of the longest axis of their middles until LEAF triangles are left; children after parents */
static PetscErrorCode TreeCreate(const PetscReal x[], PetscInt n, const PetscInt triangles[], ClusterTree *tree)
{
  PetscFunctionBegin;
  tree->x         = x;
  tree->triangles = triangles;
  PetscCall(PetscMalloc3(n, &tree->order, 3*n, &tree->middle, 2*n, &tree->cluster));
  for (PetscInt t = 0; t < n; t++) {
    tree->order[t] = t;
    for (int k = 0; k < 3; k++) tree->middle[3*t + k] = x[3*triangles[3*t] + k] + x[3*triangles[3*t + 1] + k] + x[3*triangles[3*t + 2] + k];
  }
  tree->n_clusters       = 1;
  tree->cluster[0].first = 0;
  tree->cluster[0].n     = n;
  for (PetscInt i = 0; i < tree->n_clusters; i++) {
    Cluster *c = &tree->cluster[i];
    int      axis = 0;
    double   lo[3], hi[3];
    FillCluster(tree, c);
    c->left = c->right = -1;
    if (c->n <= LEAF) continue;
    for (int k = 0; k < 3; k++) {
      lo[k] = PETSC_MAX_REAL, hi[k] = -PETSC_MAX_REAL;
      for (PetscInt j = c->first; j < c->first + c->n; j++) {
        lo[k] = PetscMin(lo[k], tree->middle[3*tree->order[j] + k]);
        hi[k] = PetscMax(hi[k], tree->middle[3*tree->order[j] + k]);
      }
      if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
    }
    SplitMiddle(tree, &tree->order[c->first], c->n, axis);
    for (int half = 0; half < 2; half++) {
      Cluster *child = &tree->cluster[tree->n_clusters];
      child->first   = half ? c->first + c->n/2 : c->first;
      child->n       = half ? c->n - c->n/2 : c->n/2;
      if (half) c->right = tree->n_clusters++;
      else c->left = tree->n_clusters++;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TreeDestroy(ClusterTree *tree)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(tree->order, tree->middle, tree->cluster));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* solid angle of a triangle seen from p, counter-clockwise from outside positive: van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30
   (1983) 125, eq. 8 */
static double SolidAngle(const double p[3], const double A[3], const double B[3], const double C[3])
{
  double a[3], b[3], c[3], n[3];

  Sub3(A, p, a), Sub3(B, p, b), Sub3(C, p, c);
  const double la = Norm3(a), lb = Norm3(b), lc = Norm3(c);
  Cross3(b, c, n);
  return 2.0*atan2(Dot3(a, n), la*lb*lc + Dot3(a, b)*lc + Dot3(b, c)*la + Dot3(c, a)*lb);
}

static double WindingAt(const ClusterTree *tree, const double p[3])
{
  PetscInt stack[128];
  int      n_stack = 0;
  double   sum = 0.0;

  stack[n_stack++] = 0;
  while (n_stack) {
    const Cluster *c = &tree->cluster[stack[--n_stack]];
    double         r[3];
    Sub3(c->centre, p, r);
    const double r2 = Dot3(r, r);
    if (r2 > FAR*FAR*c->radius*c->radius) {
      sum += Dot3(c->N, r)/(r2*sqrt(r2));
    } else if (c->left >= 0) {
      stack[n_stack++] = c->right;
      stack[n_stack++] = c->left;
    } else {
      for (PetscInt i = c->first; i < c->first + c->n; i++) {
        const PetscInt *v = &tree->triangles[3*tree->order[i]];
        sum += SolidAngle(p, &tree->x[3*v[0]], &tree->x[3*v[1]], &tree->x[3*v[2]]);
      }
    }
  }
  return sum/(4.0*PETSC_PI);
}

PetscErrorCode SurfaceWinding(PetscInt n_points, const PetscReal points[], const PetscReal x[], PetscInt n_triangles,
                              const PetscInt triangles[], PetscReal winding[])
{
  ClusterTree tree;
  double      lo[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[3] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL};

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n_points; i++) winding[i] = 0.0;
  if (!n_triangles) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < 3*n_triangles; i++) {
    for (int k = 0; k < 3; k++) {
      lo[k] = PetscMin(lo[k], x[3*triangles[i] + k]);
      hi[k] = PetscMax(hi[k], x[3*triangles[i] + k]);
    }
  }
  PetscCall(TreeCreate(x, n_triangles, triangles, &tree));
#pragma omp parallel for schedule(dynamic, 256)
  for (PetscInt i = 0; i < n_points; i++) {
    const PetscReal *p = &points[3*i];
    if (p[0] >= lo[0] && p[0] <= hi[0] && p[1] >= lo[1] && p[1] <= hi[1] && p[2] >= lo[2] && p[2] <= hi[2]) winding[i] = WindingAt(&tree, p);
  }
  PetscCall(TreeDestroy(&tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A surface at rest, ready for many questions: buckets, and the pseudonormals of its vertices and edges, whose sign tells inside from outside
   [J. A. Baerentzen & H. Aanaes, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243]: the sum of the normals of the faces around an edge, the sum
   weighted with their angles around a vertex. */
struct _SurfaceIndex {
  Buckets    buckets;
  PetscInt   n_triangles;
  PetscReal *x;
  PetscInt  *triangles;
  PetscReal *vertex; /* n_nodes x 3                          */
  PetscReal *edge;   /* n_triangles x 3 x 3, of the edges 01, 12, 20 */
};

static void UnitNormal(const PetscReal x[], const PetscInt v[3], double n[3])
{
  double a[3], b[3], l;

  Sub3(&x[3*v[1]], &x[3*v[0]], a), Sub3(&x[3*v[2]], &x[3*v[0]], b);
  Cross3(a, b, n);
  l = Norm3(n);
  for (int k = 0; k < 3; k++) n[k] = l > 0.0 ? n[k]/l : 0.0;
}

/* angle of a triangle at its corner c */
static double CornerAngle(const PetscReal x[], const PetscInt v[3], int c)
{
  double a[3], b[3], n[3];

  Sub3(&x[3*v[(c + 1)%3]], &x[3*v[c]], a), Sub3(&x[3*v[(c + 2)%3]], &x[3*v[c]], b);
  Cross3(a, b, n);
  return atan2(Norm3(n), Dot3(a, b));
}

/* normals of vertices and edges; an edge's other triangle is among those around its first vertex */
static PetscErrorCode FillNormals(SurfaceIndex s, PetscInt n_nodes)
{
  PetscInt *start, *around;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(n_nodes + 2, &start, 3*s->n_triangles, &around));
  for (PetscInt i = 0; i < 3*s->n_triangles; i++) start[s->triangles[i] + 2]++;
  for (PetscInt a = 0; a < n_nodes; a++) start[a + 2] += start[a + 1];
  for (PetscInt i = 0; i < 3*s->n_triangles; i++) around[start[s->triangles[i] + 1]++] = i/3;
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt *v = &s->triangles[3*t];
    double          n[3];
    UnitNormal(s->x, v, n);
    for (int c = 0; c < 3; c++) {
      const PetscInt a = v[c], b = v[(c + 1)%3];
      const double   angle = CornerAngle(s->x, v, c);
      for (int k = 0; k < 3; k++) s->vertex[3*a + k] += angle*n[k], s->edge[9*t + 3*c + k] += n[k];
      for (PetscInt i = start[a]; i < start[a + 1]; i++) {
        const PetscInt *w = &s->triangles[3*around[i]];
        double          m[3];
        if (around[i] == t || (w[0] != b && w[1] != b && w[2] != b)) continue;
        UnitNormal(s->x, w, m);
        for (int k = 0; k < 3; k++) s->edge[9*t + 3*c + k] += m[k];
      }
    }
  }
  PetscCall(PetscFree2(start, around));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SurfaceIndexCreate - make a closed surface at rest ready for SurfaceIndexNearest()

  Input Parameters:
+ n_nodes, x             - node positions [m], n_nodes x 3, copied
. n_triangles, triangles - n_triangles x 3 node numbers, outward, copied
- reach                  - largest distance [m] that will be asked for

  Output Parameter:
. index - SurfaceIndexDestroy() frees it
@*/
PetscErrorCode SurfaceIndexCreate(PetscInt n_nodes, const PetscReal x[], PetscInt n_triangles, const PetscInt triangles[], PetscReal reach, SurfaceIndex *index)
{
  SurfaceIndex s;

  PetscFunctionBegin;
  PetscCall(PetscNew(&s));
  s->n_triangles = n_triangles;
  PetscCall(PetscMalloc2(3*n_nodes, &s->x, 3*n_triangles, &s->triangles));
  PetscCall(PetscArraycpy(s->x, x, 3*n_nodes));
  PetscCall(PetscArraycpy(s->triangles, triangles, 3*n_triangles));
  PetscCall(PetscCalloc2(3*n_nodes, &s->vertex, 9*n_triangles, &s->edge));
  PetscCall(FillNormals(s, n_nodes));
  PetscCall(BucketsCreate(s->x, n_triangles, s->triangles, reach, &s->buckets));
  *index = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceIndexDestroy(SurfaceIndex *index)
{
  PetscFunctionBegin;
  if (!*index) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BucketsDestroy(&(*index)->buckets));
  PetscCall(PetscFree2((*index)->x, (*index)->triangles));
  PetscCall(PetscFree2((*index)->vertex, (*index)->edge));
  PetscCall(PetscFree(*index));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sign and kind of the foot a + v ab + w ac on triangle t: 2 in the face, 1 on an edge (whose direction goes to `along`), 0 at a vertex */
static int FootNormal(SurfaceIndex s, PetscInt t, const double foot[2], double normal[3], double along[3])
{
  const PetscInt *v      = &s->triangles[3*t];
  const double    L[3]   = {1.0 - foot[0] - foot[1], foot[0], foot[1]}, none = 1e-12;
  const int       zero[3] = {L[0] < none, L[1] < none, L[2] < none};

  for (int k = 0; k < 3; k++) along[k] = 0.0;
  if (zero[0] + zero[1] + zero[2] == 2) {
    const int c = !zero[0] ? 0 : !zero[1] ? 1 : 2;
    for (int k = 0; k < 3; k++) normal[k] = s->vertex[3*v[c] + k];
    return 0;
  }
  if (zero[0] + zero[1] + zero[2] == 1) {
    const int c = zero[0] ? 1 : zero[1] ? 2 : 0; /* the edge after the corner that is not on it begins at c */
    double    l;
    Sub3(&s->x[3*v[(c + 1)%3]], &s->x[3*v[c]], along);
    l = Norm3(along);
    for (int k = 0; k < 3; k++) normal[k] = s->edge[9*t + 3*c + k], along[k] /= l;
    return 1;
  }
  UnitNormal(s->x, v, normal);
  return 2;
}

/* nearest triangle not farther than `reach`, of equally near ones the one of lowest number; -1 when there is none. The answer does not
   depend on reach as long as that is no less than the distance. */
static PetscInt NearestTriangle(SurfaceIndex s, const double p[3], double reach, double foot[2], double *d2)
{
  const Buckets *b = &s->buckets;
  double         lo[3], hi[3], f[2];
  PetscInt       first[3], last[3], found = -1;

  *d2 = reach*reach;
  for (int k = 0; k < 3; k++) {
    lo[k] = p[k] - reach, hi[k] = p[k] + reach;
    if (!(hi[k] >= b->lo[k] && lo[k] <= b->hi[k])) return -1;
  }
  BucketRange(b, lo, hi, first, last);
  for (PetscInt z = first[2]; z <= last[2]; z++) {
    for (PetscInt y = first[1]; y <= last[1]; y++) {
      for (PetscInt w = first[0]; w <= last[0]; w++) {
        const PetscInt c = (z*b->dims[1] + y)*b->dims[0] + w;
        for (PetscInt k = b->start[c]; k < b->start[c + 1]; k++) {
          const PetscInt  t  = b->item[k], *v = &s->triangles[3*t];
          const double    d  = TriangleDistance2(p, &s->x[3*v[0]], &s->x[3*v[1]], &s->x[3*v[2]], f);
          if (d > *d2 || (d == *d2 && found >= 0 && t >= found)) continue;
          *d2 = d, found = t, foot[0] = f[0], foot[1] = f[1];
        }
      }
    }
  }
  return found;
}

/* The signed distance of a point, negative inside, when its size is not more than `reach`. No PETSc inside: may be called in a parallel
   region. */
PetscBool SurfaceIndexNearest(SurfaceIndex s, const PetscReal p[3], PetscReal reach, SurfaceFoot *at)
{
  double         foot[2] = {0.0, 0.0}, d2, pseudo[3], r[3];
  const PetscInt t = NearestTriangle(s, p, reach, foot, &d2);

  if (t < 0) return PETSC_FALSE;
  const PetscInt *v = &s->triangles[3*t];
  at->kind = FootNormal(s, t, foot, pseudo, at->along);
  for (int k = 0; k < 3; k++) {
    r[k] = p[k] - (1.0 - foot[0] - foot[1])*s->x[3*v[0] + k] - foot[0]*s->x[3*v[1] + k] - foot[1]*s->x[3*v[2] + k];
  }
  const double sign = Dot3(r, pseudo) < 0.0 ? -1.0 : 1.0, d = sqrt(d2);
  at->distance = sign*d;
  if (at->kind == 2 || !(d > 0.0)) UnitNormal(s->x, v, at->normal);
  else
    for (int k = 0; k < 3; k++) at->normal[k] = sign*r[k]/d;
  return PETSC_TRUE;
}
