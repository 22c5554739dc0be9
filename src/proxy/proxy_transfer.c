/* proxy_transfer.c - forces on proxies to the nodes of the surface (method 5.1), and what proxies know as fields at the nodes. */
#include "proxy/proxy_impl.h"
#include "proxy/proxy_grid.h"

/* Pseudo-inverse times M of a symmetric positive 3x3 matrix: theta = A^+ M. Eigenvalues below 1e-10 of the largest count as zero (all
   nodes on a line: no moment about it can be made). Jacobi rotations. */
static void SolveSymmetric(const double A[9], const double M[3], double theta[3])
{
  double a[9], V[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

  for (int i = 0; i < 9; i++) a[i] = A[i];
  for (int sweep = 0; sweep < 30; sweep++) {
    for (int p = 0; p < 2; p++) {
      for (int q = p + 1; q < 3; q++) {
        if (a[3*p + q] == 0.0) continue;
        const double tau = (a[4*q] - a[4*p])/(2.0*a[3*p + q]), t = (tau >= 0.0 ? 1.0 : -1.0)/(fabs(tau) + sqrt(1.0 + tau*tau));
        const double c = 1.0/sqrt(1.0 + t*t), s = t*c;
        for (int k = 0; k < 3; k++) {
          const double kp = a[3*k + p], kq = a[3*k + q], vp = V[3*k + p], vq = V[3*k + q];
          a[3*k + p] = c*kp - s*kq, a[3*k + q] = s*kp + c*kq;
          V[3*k + p] = c*vp - s*vq, V[3*k + q] = s*vp + c*vq;
        }
        for (int k = 0; k < 3; k++) {
          const double pk = a[3*p + k], qk = a[3*q + k];
          a[3*p + k] = c*pk - s*qk, a[3*q + k] = s*pk + c*qk;
        }
      }
    }
  }
  const double top = PetscMax(fabs(a[0]), PetscMax(fabs(a[4]), fabs(a[8])));
  for (int i = 0; i < 3; i++) theta[i] = 0.0;
  for (int k = 0; k < 3; k++) {
    const double v[3] = {V[k], V[3 + k], V[6 + k]};
    if (!(a[4*k] > 1e-10*top)) continue;
    for (int i = 0; i < 3; i++) theta[i] += v[i]*Dot3(v, M)/a[4*k];
  }
}

/* moment about c that is still missing: `wanted` about c less that of the nodal forces; f = forces of this call alone */
static void MissingMoment(const Proxy p, const double f[], const double c[3], const double wanted[3], double M[3])
{
  for (int k = 0; k < 3; k++) M[k] = wanted[k];
  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    double r[3], m[3];
    Sub3(&p->geometry.x[3*a], c, r);
    Cross3(r, &f[3*a], m);
    for (int k = 0; k < 3; k++) M[k] -= m[k];
  }
}

/* centre of the nodal weights */
static void Center(const Proxy p, double c[3])
{
  PetscReal weight = 0.0;

  for (int k = 0; k < 3; k++) c[k] = 0.0;
  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    weight += p->node_weight[a];
    for (int k = 0; k < 3; k++) c[k] += p->node_weight[a]*p->geometry.x[3*a + k];
  }
  for (int k = 0; k < 3; k++) c[k] /= weight;
}

/* theta of the couple M: (sum_a w_a (|r|^2 - r r)) theta = M, r from c */
static void CoupleAxis(const Proxy p, const double c[3], const double M[3], double theta[3])
{
  const PetscReal *w = p->node_weight;
  double           A[9] = {0};

  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    double r[3];
    if (w[a] == 0.0) continue;
    Sub3(&p->geometry.x[3*a], c, r);
    const double r2 = Dot3(r, r);
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) A[3*i + j] += w[a]*((i == j ? r2 : 0.0) - r[i]*r[j]);
    }
  }
  SolveSymmetric(A, M, theta);
}

/* add the self-balanced field f_a += w_a theta x (x_a - c), sum w (x_a - c) = 0: no force, and the moment M about any point */
static void AddCouple(const Proxy p, const double c[3], const double M[3], double f[])
{
  const PetscReal *w = p->node_weight;
  double           theta[3];

  CoupleAxis(p, c, M, theta);
  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    double r[3], d[3];
    if (w[a] == 0.0) continue;
    Sub3(&p->geometry.x[3*a], c, r);
    Cross3(theta, r, d);
    for (int k = 0; k < 3; k++) f[3*a + k] += w[a]*d[k];
  }
}

PetscErrorCode ProxyAddCouple(Proxy p, const PetscReal moment[3], PetscReal node_force[])
{
  double c[3];

  PetscFunctionBegin;
  if (!p->n) PetscFunctionReturn(PETSC_SUCCESS);
  Center(p, c);
  AddCouple(p, c, moment, node_force);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxyGetRotation - how nodal velocities turn the surface as a whole: the transpose of what ProxyTransfer() does with a couple

  Input Parameters:
+ proxy - the proxies
- v     - nodal velocities [m/s], n_nodes x 3

  Output Parameter:
. rotation - omega = A^+ sum_a w_a (x_a - c) x v_a [rad/s]; of a rigid motion its angular velocity

  Notes:
  A particle at x_i feels proxy b as v_b + omega x (x_i - x_b). Then the work that the fluid does, sum F_ib . (that velocity), is that of the nodal
  forces of ProxyTransfer() on the nodal velocities, to round-off.

  Tests: tests/unit/proxy/test_transfer.c
@*/
PetscErrorCode ProxyGetRotation(Proxy p, const PetscReal v[], PetscReal rotation[3])
{
  double c[3], L[3] = {0, 0, 0};

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) rotation[k] = 0.0;
  if (!p->n) PetscFunctionReturn(PETSC_SUCCESS);
  Center(p, c);
  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    double r[3], l[3];
    if (p->node_weight[a] == 0.0) continue;
    Sub3(&p->geometry.x[3*a], c, r);
    Cross3(r, &v[3*a], l);
    for (int k = 0; k < 3; k++) L[k] += p->node_weight[a]*l[k];
  }
  CoupleAxis(p, c, L, rotation);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxyTransfer - take the forces on proxies to the nodes, keeping total force and moment

  Input Parameters:
+ proxy  - the proxies
. force  - force on each proxy [N], n_proxies x 3
- moment - their moment about the origin as the fluid made it [N m]; NULL: that of the forces in the middle of what each proxy stands for

  Output Parameter:
. node_force - n_nodes x 3 [N], added to

  Notes:
  Each force goes to the nodes of the part of the surface that its proxy stands for (ProxyForcesToNodes()), by weights >= 0, so a push stays
  a push at every node. The fluid exerts its forces where the particles are, up to h off the surface, so a couple remains. Letting each force
  act where its line meets the proxy's plane (method 5.1) removes it too, but with affine weights of size (distance off)/(edge
  length): on meshes finer than h they are large, of both signs, and load needle triangles with opposed forces that are pure noise.
  Here the couple of the whole body is added as the rotation field theta x (x_a - x_c) w_a over all surface nodes, w_a the area
  that node a stands for: the smallest such forces in the norm sum |f_a|^2/w_a, exact in force and moment for any mesh. A surface whose
  nodes lie on one line takes no moment about it.

  Cost: O(nodes + proxies).  Tests: tests/unit/proxy/test_transfer.c

.seealso: ProxyGetContacts(), ProxyForcesToNodes()
@*/
PetscErrorCode ProxyTransfer(Proxy p, const PetscReal force[], const PetscReal moment[3], PetscReal node_force[])
{
  PetscReal *f, c[3], total[3] = {0, 0, 0}, wanted[3] = {0, 0, 0}, M[3], shift[3];

  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  if (!p->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(3*p->surface.n_nodes, &f));
  PetscCall(ProxyForcesToNodes(p, force, f));
  for (PetscInt b = 0; b < p->n; b++) {
    double m[3];
    Cross3(&p->place[3*b], &force[3*b], m);
    for (int k = 0; k < 3; k++) total[k] += force[3*b + k], wanted[k] += m[k];
  }

  // moments about the centre, where the numbers are small
  Center(p, c);
  if (moment) {
    for (int k = 0; k < 3; k++) wanted[k] = moment[k];
  }
  Cross3(c, total, shift);
  for (int k = 0; k < 3; k++) wanted[k] -= shift[k];

  // the second round removes what the first left by round-off
  for (int round = 0; round < 2; round++) {
    MissingMoment(p, f, c, wanted, M);
    AddCouple(p, c, M, f);
  }
  for (PetscInt i = 0; i < 3*p->surface.n_nodes; i++) node_force[i] += f[i];
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* unit normals of the surface's nodes where they are now, means of the triangles by area; 0 for nodes that are not on it */
static void NodeNormals(const Proxy p, PetscReal normal[])
{
  for (PetscInt i = 0; i < 3*p->surface.n_nodes; i++) normal[i] = 0.0;
  for (PetscInt t = 0; t < p->surface.n_triangles; t++) {
    for (int c = 0; c < 3; c++) {
      for (int k = 0; k < 3; k++) normal[3*p->surface.triangles[3*t + c] + k] += p->geometry.area[t]*p->geometry.normal[3*t + k];
    }
  }
  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    const double length = Norm3(&normal[3*a]);
    for (int k = 0; k < 3 && length > 0.0; k++) normal[3*a + k] /= length;
  }
}

/* Radius of a node's view of the proxies over that of their supports: 1.4 spacings, so that it sees some wherever thinning has left the largest
   gap, and little beyond its neighbours */
#define NODE_REACH 0.7

/* what a node has gathered from the proxies around it: sums of weights, of weights times distances d = x_b - x_a, of these times values */
typedef struct {
  double weight, first[3], second[9], value[PROXY_FIELDS], slope[3*PROXY_FIELDS], low[PROXY_FIELDS], high[PROXY_FIELDS];
} NodeSums;

static void Gather(PetscInt n, double w, const double d[3], const PetscReal value[], NodeSums *s)
{
  s->weight += w;
  for (int i = 0; i < 3; i++) {
    s->first[i] += w*d[i];
    for (int j = 0; j < 3; j++) s->second[3*i + j] += w*d[i]*d[j];
  }
  for (PetscInt m = 0; m < n; m++) {
    s->value[m] += w*value[m];
    for (int i = 0; i < 3; i++) s->slope[3*m + i] += w*value[m]*d[i];
    s->low[m]  = PetscMin(s->low[m], value[m]);
    s->high[m] = PetscMax(s->high[m], value[m]);
  }
}

/* The constant c of the fit min sum w (v_b - c - g.d)^2 + eps R^2 |g|^2 sum w, kept within the range of the values. The small term keeps the
   slope along the normal of a flat surface at zero. */
static void Fit(PetscInt n, double R, const NodeSums *s, PetscReal value[])
{
  const double eps = 0.01;
  double       A[9], inverse[9] = {0}, mean[3];

  for (int i = 0; i < 3; i++) mean[i] = s->first[i]/s->weight;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) A[3*i + j] = s->second[3*i + j]/s->weight - mean[i]*mean[j] + (i == j ? eps*R*R : 0.0);
  }
  (void)Invert3(A, inverse);
  for (PetscInt m = 0; m < n; m++) {
    double       rhs[3], g[3];
    const double v = s->value[m]/s->weight;
    for (int i = 0; i < 3; i++) rhs[i] = s->slope[3*m + i]/s->weight - v*mean[i];
    Mul3(inverse, rhs, g);
    value[m] = PetscMin(s->high[m], PetscMax(s->low[m], v - Dot3(mean, g)));
  }
}

/* what nodes see of the sampling: those in use, and with weight also the others, which have no water near and values of zero */
typedef struct {
  PetscInt   n, *use; /* number in use, -1 = not */
  PetscReal *x, *normal, *radius, *weight, reach;
  PointGrid  grid;
} NodeView;

static PetscErrorCode NodeViewCreate(const Proxy p, const PetscReal weight[], NodeView *view)
{
  const ProxySampling *s = &p->sampling;

  PetscFunctionBegin;
  view->n     = s->n;
  view->reach = 0.0;
  PetscCall(PetscMalloc5(s->n, &view->use, 3*s->n, &view->x, 3*s->n, &view->normal, s->n, &view->radius, s->n, &view->weight));
  for (PetscInt i = 0; i < s->n; i++) {
    view->use[i]    = -1;
    view->weight[i] = 0.0;
    view->radius[i] = NODE_REACH*p->fluid.h/s->kappa[i];
    view->reach     = PetscMax(view->reach, view->radius[i]);
    for (PetscInt k = s->part_start[i]; k < s->part_start[i + 1] && !weight; k++) view->weight[i] += s->part[k]*p->geometry.area[s->part_triangle[k]];
    for (int k = 0; k < 3; k++) {
      view->normal[3*i + k] = p->geometry.normal[3*s->triangle[i] + k];
      view->x[3*i + k]      = 0.0;
      for (int c = 0; c < 3; c++) view->x[3*i + k] += s->weights[3*i + c]*p->geometry.x[3*s->nodes[3*i + c] + k];
    }
  }
  for (PetscInt b = 0; b < p->n; b++) {
    view->use[p->active[b]]    = b;
    view->weight[p->active[b]] = weight ? weight[b] : p->area[b];
  }
  PetscCall(PointGridCreate(s->n, view->x, view->reach, s->n, &view->grid));
  for (PetscInt i = s->n - 1; i >= 0; i--) PointGridAdd(&view->grid, i, &view->x[3*i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NodeViewDestroy(NodeView *view)
{
  PetscFunctionBegin;
  PetscCall(PointGridDestroy(&view->grid));
  PetscCall(PetscFree5(view->use, view->x, view->normal, view->radius, view->weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a node's sums over the proxies in the cells within the largest radius */
static void GatherNode(const NodeView *view, const double x[3], const double normal[3], PetscInt n, const PetscReal value[], NodeSums *sums)
{
  static const PetscReal none[PROXY_FIELDS] = {0};
  const double           r = view->reach, low[3] = {x[0] - r, x[1] - r, x[2] - r}, high[3] = {x[0] + r, x[1] + r, x[2] + r};
  PetscInt               lo[3], hi[3];

  (void)PointGridIndex(&view->grid, low, lo);
  (void)PointGridIndex(&view->grid, high, hi);
  *sums = (NodeSums){0};
  for (PetscInt m = 0; m < n; m++) sums->low[m] = PETSC_MAX_REAL, sums->high[m] = -PETSC_MAX_REAL;
  for (PetscInt k = lo[2]; k <= hi[2]; k++) {
    for (PetscInt j = lo[1]; j <= hi[1]; j++) {
      for (PetscInt i = lo[0]; i <= hi[0]; i++) {
        for (PetscInt b = view->grid.head[(k*view->grid.dims[1] + j)*view->grid.dims[0] + i]; b >= 0; b = view->grid.next[b]) {
          const double facing = Dot3(normal, &view->normal[3*b]);
          double       d[3], unused;
          Sub3(&view->x[3*b], x, d);
          const double w = facing > 0.0 ? facing*view->weight[b]*ProxyKernel2D(Norm3(d), view->radius[b], &unused) : 0.0;
          if (w > 0.0) Gather(n, w, d, view->use[b] < 0 ? none : &value[n*view->use[b]], sums);
        }
      }
    }
  }
}

/*@
  ProxyToNodes - fields at the nodes of the surface from values at its proxies

  Input Parameters:
+ proxy  - the proxies where they are now
. n      - values a proxy, at most PROXY_FIELDS
. value  - n_proxies x n
- weight - n_proxies, >= 0: how much each counts; NULL: its area, and where no fluid is near and no proxies are in use values are 0

  Output Parameter:
. node_value - n_nodes x n; 0 at nodes that no proxy of positive weight is near, and at inner ones

  Equation:
  The value at x_a of the linear function that fits those of the proxies b best, with weights weight_b W2(|x_a - x_b|, 0.7 R_b) max(0, n_a . n_b): W2
  a cubic spline in two dimensions (ProxyKernel2D()), R_b = h/kappa-bar, n outward normals, so that the two sides of a sheet keep apart. A plain
  mean would flatten the field of a ball whose radius is that of the supports. It is kept within the range of the values.

  Cost: O(nodes + proxies).  Tests: tests/unit/proxy/test_transfer.c

.seealso: ProxyTransfer(), ProxyGetPoints()
@*/
PetscErrorCode ProxyToNodes(Proxy p, PetscInt n, const PetscReal value[], const PetscReal weight[], PetscReal node_value[])
{
  const PetscInt n_nodes = p->surface.n_nodes;
  PetscReal     *normal;
  NodeView       view;

  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  PetscCheck(n > 0 && n <= PROXY_FIELDS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%" PetscInt_FMT " values a proxy, at most %d", n, PROXY_FIELDS);
  PetscCall(PetscArrayzero(node_value, n*n_nodes));
  if (!p->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(3*n_nodes, &normal));
  NodeNormals(p, normal);
  PetscCall(NodeViewCreate(p, weight, &view));
#pragma omp parallel for schedule(dynamic, 64)
  for (PetscInt a = 0; a < n_nodes; a++) {
    NodeSums sums;
    if (Dot3(&normal[3*a], &normal[3*a]) == 0.0) continue;
    GatherNode(&view, &p->geometry.x[3*a], &normal[3*a], n, value, &sums);
    if (sums.weight > 0.0) Fit(n, view.reach, &sums, &node_value[n*a]);
  }
  PetscCall(NodeViewDestroy(&view));
  PetscCall(PetscFree(normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}
