/* proxy_wall.c - faces that lie on a wall, or on an obstacle, do not act on the water around their edge: where two surfaces meet there is no edge for
   the water (docs/design.md, "What stands on a wall has no face there"). Each proxy has an exposure, 1 in the open, falling to 0 where it looks at a
   wall or an obstacle that is nearer than the fluid could ever enter. */
#include "proxy/proxy_impl.h"

/* Part of a proxy that acts, at a gap [dx] from what it looks at, cosine = - n_proxy . n_wall: nothing below 0.15 dx, all beyond 0.5 dx (a
   particle between would be pressed by both sides to some 1.5 times the rest density); all of it when it looks 25 degrees and more aside, nothing
   within 10 degrees: the wedge around a ball's foot stays open to the water. */
static double Exposure(double gap, double cosine)
{
  double       slope;
  const double near = 1.0 - ProxySmoothStep((gap - 0.15)/0.35, &slope), looks = ProxySmoothStep((cosine - 0.906)/0.079, &slope);

  return 1.0 - near*looks;
}

/*@
  ProxyAddNeighbour - an obstacle at rest on which the surface may come to lie

  Input Parameters:
+ proxy - the proxies that give way there
. index - the obstacle, made for questions up to PROXY_NEIGHBOUR_REACH h; borrowed, must outlive the proxies
. min   - lower corner of the obstacle's box [m]
- max   - upper corner
@*/
PetscErrorCode ProxyAddNeighbour(Proxy p, SurfaceIndex index, const PetscReal min[3], const PetscReal max[3])
{
  ProxyNeighbour *o;

  PetscFunctionBegin;
  PetscCall(PetscRealloc(sizeof(ProxyNeighbour)*(size_t)(p->n_neighbours + 1), &p->neighbour));
  o        = &p->neighbour[p->n_neighbours++];
  o->index = index;
  for (int k = 0; k < 3; k++) {
    o->lo[k] = min[k] - p->fluid.dx;
    o->hi[k] = max[k] + p->fluid.dx;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double ExposedToPlanes(const ProxyFluid *fluid, const double x[3], const double n[3])
{
  double exposed = 1.0;

  for (int k = 0; k < 6; k++) {
    const double sign = k % 2 ? -1.0 : 1.0; // of the plane's inward normal
    if (!(fluid->walls >> k & 1)) continue;
    exposed *= Exposure(sign*(x[k/2] - fluid->plane[k])/fluid->dx, -sign*n[k/2]);
  }
  return exposed;
}

/* The least exposure that obstacles leave, and which does. Asked from a little within the surface: on the obstacle its edges have no direction. */
static double ExposedToNeighbours(const Proxy p, const double x[3], const double n[3], PetscInt *which)
{
  const double within = 0.1*p->fluid.dx, at[3] = {x[0] - within*n[0], x[1] - within*n[1], x[2] - within*n[2]};
  double       least = 1.0;

  *which = 0;
  for (PetscInt i = 0; i < p->n_neighbours; i++) {
    const ProxyNeighbour *o  = &p->neighbour[i];
    int                   in = 1;
    SurfaceFoot           foot;
    for (int k = 0; k < 3; k++) in &= x[k] > o->lo[k] && x[k] < o->hi[k];
    if (!in || !SurfaceIndexNearest(o->index, at, p->fluid.dx, &foot) || fabs(foot.distance) < 1e-6*p->fluid.dx) continue;
    const double cosine = -Dot3(foot.normal, n), exposed = Exposure((foot.distance - within*cosine)/p->fluid.dx, cosine);
    if (exposed < least) least = exposed, *which = i;
  }
  return least;
}

/* exposures of the proxies in use where they are */
void ProxyExpose(Proxy p)
{
  int hidden = 0;

#pragma omp parallel for schedule(static) reduction(| : hidden)
  for (PetscInt j = 0; j < p->n; j++) {
    const double *x = &p->x[3*j], *n = &p->normal[3*j];
    p->exposed[j]  = ExposedToPlanes(&p->fluid, x, n);
    p->laid[j]     = 0.0;
    if (p->n_neighbours) p->laid[j] = 1.0 - ExposedToNeighbours(p, x, n, &p->lies_on[j]);
    hidden |= p->exposed[j] < 1.0 || p->laid[j] > 0.0;
  }
  p->hides = (PetscBool)hidden;
}

/* Exposure of proxy j to a particle at x, in the frame of the proxies, and its gradient. A planar wall goes on for ever. An obstacle does not: where its
   surface ends with that of the body, as at a gate under a wall of its own thickness, the body's edge is there for the water, and the union of both
   is nearly right with all faces. So an obstacle hides a face from those particles that are in front of it, whose feet on it have a normal
   against that of the face. The gradient of a normal is that of the direction to an edge or a vertex, 0 on a face. */
double ProxyExposureAt(const Proxy p, PetscInt j, const double x[3], ProxyFoot *last, double grad[3])
{
  double slope;

  for (int k = 0; k < 3; k++) grad[k] = 0.0;
  if (p->laid[j] == 0.0) return p->exposed[j];
  if (last->neighbour != p->lies_on[j]) {
    last->neighbour = p->lies_on[j];
    last->found     = SurfaceIndexNearest(p->neighbour[last->neighbour].index, x, PROXY_NEIGHBOUR_REACH*p->fluid.h, &last->foot);
  }
  if (!last->found) return p->exposed[j];
  const SurfaceFoot *f = &last->foot;
  const double      *n = &p->normal[3*j], cosine = -Dot3(n, f->normal), front = ProxySmoothStep((cosine - 0.3)/0.6, &slope);
  if (f->kind < 2 && slope != 0.0 && f->distance != 0.0) {
    const double along = f->kind == 1 ? Dot3(n, f->along) : 0.0;
    for (int k = 0; k < 3; k++) {
      const double turn = -(n[k] - (f->kind == 1 ? along*f->along[k] : 0.0) + cosine*f->normal[k])/f->distance; // gradient of the cosine
      grad[k] = -p->exposed[j]*p->laid[j]*slope/0.6*turn;
    }
  }
  return p->exposed[j]*(1.0 - p->laid[j]*front);
}
