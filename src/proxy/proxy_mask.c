/* proxy_mask.c - surfaces that no fluid is near need no proxies (method 4.5). The grid cells that fluid occupies around the surface decide: what
   is left out touches no particle, so that contacts are the same to the last bit, and who is left follows from the positions alone. */
#include "proxy/proxy_impl.h"

#define MAX_CELLS 2e6 /* of the grid; a larger one gets coarser cells, and a few proxies more stay in use */

/* The osculating paraboloid adds up to 1/2 kappa R^2 to the height. */
void ProxySupport(const Proxy p, const ProxyPoint *b, double *half, double *radius)
{
  const double h = p->fluid.h;

  if (p->params.kernel != PROXY_KERNEL_HALF_SPACE) {
    *half   = h;
    *radius = PetscMax(b->radius[0], b->radius[1]);
  } else {
    double extent = 0.0;
    for (int k = 0; k < 8; k++) extent = PetscMax(extent, b->extent[k]);
    // an octagon's corners are 8 % farther than its sides
    *radius = PetscMin(b->radius[0], 1.083*extent + h);
    *half   = h + fabs(b->offset) + 0.5*(*radius)*(*radius)*sqrt(b->S[0]*b->S[0] + b->S[1]*b->S[1] + b->S[2]*b->S[2] + 2.0*(b->S[3]*b->S[3] + b->S[4]*b->S[4] + b->S[5]*b->S[5]));
  }
}

/* ball around proxy i of the sampling that holds its support, whatever its shape operator may be */
static double SampledReach(const Proxy p, PetscInt i, double x[3])
{
  const ProxySampling *q = &p->sampling;
  const double         h = p->fluid.h, stretch = PetscMax(1.0, sqrt(p->geometry.area[q->triangle[i]]/q->area0[q->triangle[i]]));
  double               extent = 0.0;

  for (int k = 0; k < 3; k++) {
    x[k] = 0.0;
    for (int c = 0; c < 3; c++) x[k] += q->weights[3*i + c]*p->geometry.x[3*q->nodes[3*i + c] + k];
  }
  if (p->params.kernel != PROXY_KERNEL_HALF_SPACE) {
    const PetscInt e = p->surface.triangle_edges[3*q->triangle[i] + PetscMax(0, q->side[i])];
    double         r[3];
    Sub3(&p->geometry.x[3*p->surface.edge_nodes[2*e + 1]], &p->geometry.x[3*p->surface.edge_nodes[2*e]], r);
    return h + p->inset + h/q->kappa[i]*PetscMax(stretch, Norm3(r)/q->edge0[e]);
  }
  for (int k = 0; k < 8; k++) extent = PetscMax(extent, q->extent[8*i + k]);
  const double radius = PetscMin(h/q->kappa[i], 1.083*extent + h)*stretch;
  const double half   = h + fabs(q->offset[i] - p->inset) + 0.5*radius*radius*sqrt(2.0)*PROXY_CURVATURE/h;
  return sqrt(radius*radius + half*half);
}

/* grid over [lo, hi] in cells of h, all empty */
static PetscErrorCode SizeGrid(double h, const double lo[3], const double hi[3], ProxyOccupied *o)
{
  double n = PETSC_MAX_REAL;

  PetscFunctionBegin;
  for (o->cell = h/1.26; n > MAX_CELLS;) {
    o->cell *= 1.26;
    n = 1.0;
    for (int k = 0; k < 3; k++) n *= floor((hi[k] - lo[k])/o->cell) + 2.0;
  }
  for (int k = 0; k < 3; k++) {
    o->lo[k]   = lo[k];
    o->dims[k] = (PetscInt)floor((hi[k] - lo[k])/o->cell) + 1;
  }
  if ((size_t)n > o->n_below) {
    PetscCall(PetscFree(o->below));
    o->n_below = (size_t)(1.5*n);
    PetscCall(PetscMalloc1(o->n_below, &o->below));
  }
  PetscCall(PetscArrayzero(o->below, (size_t)n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mark the cells of n particles, every periodic image of each */
static void MarkCells(const ProxyFluid *fluid, PetscInt n, const PetscReal x[], ProxyOccupied *o)
{
  const PetscInt row = o->dims[0] + 1, layer = row*(o->dims[1] + 1);
  const double   inverse = 1.0/o->cell;
  double         period[3], size[3];

  for (int k = 0; k < 3; k++) {
    period[k] = ProxyPeriod(fluid, k);
    size[k]   = o->dims[k]*o->cell;
  }
  for (PetscInt i = 0; i < n; i++) {
    double r[3]; // from the grid's corner, the first image that is not below it
    int    out = 0;
    for (int k = 0; k < 3; k++) {
      r[k] = x[3*i + k] - o->lo[k];
      if (period[k] > 0.0) r[k] -= period[k]*floor(r[k]/period[k]);
      out |= !(r[k] >= 0.0 && r[k] < size[k]);
    }
    if (out) continue;
    for (double z = r[2]; z < size[2]; z += period[2]) {
      for (double y = r[1]; y < size[1]; y += period[1]) {
        for (double w = r[0]; w < size[0]; w += period[0]) {
          const PetscInt c[3] = {(PetscInt)(w*inverse), (PetscInt)(y*inverse), (PetscInt)(z*inverse)};
          o->below[(PetscMin(c[2], o->dims[2] - 1) + 1)*layer + (PetscMin(c[1], o->dims[1] - 1) + 1)*row + PetscMin(c[0], o->dims[0] - 1) + 1] = 1;
          if (period[0] == 0.0) break;
        }
        if (period[1] == 0.0) break;
      }
      if (period[2] == 0.0) break;
    }
  }
}

/* marks to counts of all cells below a corner */
static void SumCells(ProxyOccupied *o)
{
  const PetscInt step[3] = {1, o->dims[0] + 1, (o->dims[0] + 1)*(o->dims[1] + 1)};

  for (int axis = 0; axis < 3; axis++) {
    for (PetscInt z = axis == 2; z <= o->dims[2]; z++) {
      for (PetscInt y = axis == 1; y <= o->dims[1]; y++) {
        PetscInt *a = &o->below[z*step[2] + y*step[1]];
        for (PetscInt x = axis == 0; x <= o->dims[0]; x++) a[x] += a[x - step[axis]];
      }
    }
  }
}

/* is a cell occupied that the box lo .. hi overlaps? */
static PetscBool HasFluid(const ProxyOccupied *o, const double lo[3], const double hi[3])
{
  const PetscInt row = o->dims[0] + 1, layer = row*(o->dims[1] + 1);
  PetscInt       a[3], b[3], n = 0;

  for (int k = 0; k < 3; k++) {
    const double from = floor((lo[k] - o->lo[k])/o->cell), to = floor((hi[k] - o->lo[k])/o->cell) + 1.0;
    if (to <= 0.0 || from >= o->dims[k]) return PETSC_FALSE;
    a[k] = (PetscInt)PetscMax(0.0, from);
    b[k] = (PetscInt)PetscMin((double)o->dims[k], to);
  }
  for (int corner = 0; corner < 8; corner++) {
    const PetscInt at = (corner & 4 ? a[2] : b[2])*layer + (corner & 2 ? a[1] : b[1])*row + (corner & 1 ? a[0] : b[0]);
    const int      minus = (corner & 1) ^ (corner >> 1 & 1) ^ (corner >> 2 & 1);
    n += minus ? -o->below[at] : o->below[at];
  }
  return (PetscBool)(n > 0);
}

/* the surface has moved: balls around all proxies, and the box of their supports */
static PetscErrorCode MakeBalls(Proxy p)
{
  ProxyMask     *mask = &p->mask;
  const PetscInt m    = p->sampling.n;

  PetscFunctionBegin;
  if (m > mask->capacity) {
    PetscCall(PetscFree2(mask->ball, mask->box));
    mask->capacity = m + m/4;
    PetscCall(PetscMalloc2(4*mask->capacity, &mask->ball, 6*mask->capacity, &mask->box));
  }
#pragma omp parallel for schedule(static)
  for (PetscInt i = 0; i < m; i++) mask->ball[4*i + 3] = SampledReach(p, i, &mask->ball[4*i]);
  for (int k = 0; k < 3; k++) {
    mask->lo[k] = PETSC_MAX_REAL, mask->hi[k] = -PETSC_MAX_REAL;
    for (PetscInt i = 0; i < m; i++) {
      mask->lo[k] = PetscMin(mask->lo[k], mask->ball[4*i + k] - mask->ball[4*i + 3]);
      mask->hi[k] = PetscMax(mask->hi[k], mask->ball[4*i + k] + mask->ball[4*i + 3]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* box around the support of a proxy that is placed */
static void SupportBox(const Proxy p, const ProxyPoint *b, double box[6])
{
  double half, radius;

  ProxySupport(p, b, &half, &radius);
  for (int k = 0; k < 3; k++) {
    const double e = fabs(b->n[k])*half + sqrt(PetscMax(0.0, 1.0 - b->n[k]*b->n[k]))*radius;
    box[k] = b->x[k] - e, box[3 + k] = b->x[k] + e;
  }
}

/* those whose ball, or box when `boxes`, reaches fluid */
static PetscInt Sieve(const Proxy p, PetscBool boxes, PetscInt active[])
{
  PetscInt n_active = 0;

  for (PetscInt i = 0; i < p->sampling.n; i++) {
    const double *c = &p->mask.ball[4*i], *box = &p->mask.box[6*i], from[3] = {c[0] - c[3], c[1] - c[3], c[2] - c[3]}, to[3] = {c[0] + c[3], c[1] + c[3], c[2] + c[3]};
    if (boxes ? HasFluid(&p->mask.occupied, box, box + 3) : HasFluid(&p->mask.occupied, from, to)) active[n_active++] = i;
  }
  return n_active;
}

PetscErrorCode ProxyMaskBefore(Proxy p, PetscBool moved, PetscInt n, const PetscReal x[], PetscInt active[], PetscInt *n_active)
{
  ProxyMask *mask = &p->mask;

  PetscFunctionBegin;
  *n_active = 0;
  if (moved || !mask->ball) {
    PetscCall(MakeBalls(p));
    mask->has_boxes = PETSC_FALSE;
  }
  if (!n || !p->sampling.n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SizeGrid(p->fluid.h, mask->lo, mask->hi, &mask->occupied));
  MarkCells(&p->fluid, n, x, &mask->occupied);
  SumCells(&mask->occupied);
  *n_active = Sieve(p, mask->has_boxes, active);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ProxyMaskBoxes(Proxy p)
{
#pragma omp parallel for schedule(static)
  for (PetscInt j = 0; j < p->n; j++) SupportBox(p, &p->points[j], &p->mask.box[6*p->active[j]]);
  p->mask.has_boxes = PETSC_TRUE;
}

void ProxyMaskAfter(const Proxy p, PetscBool keep[])
{
#pragma omp parallel for schedule(static)
  for (PetscInt j = 0; j < p->n; j++) {
    double box[6];
    SupportBox(p, &p->points[j], box);
    keep[j] = HasFluid(&p->mask.occupied, box, box + 3);
  }
}

PetscErrorCode ProxyMaskDestroy(Proxy p)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(p->mask.ball, p->mask.box));
  PetscCall(PetscFree(p->mask.occupied.below));
  PetscFunctionReturn(PETSC_SUCCESS);
}
