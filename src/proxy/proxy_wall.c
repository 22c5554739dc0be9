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
. index - the obstacle, asked up to one spacing; borrowed, must outlive the proxies
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

/* asked from a little within the surface: on the obstacle its edges have no direction */
static double ExposedToNeighbours(const Proxy p, const double x[3], const double n[3])
{
  const double within = 0.1*p->fluid.dx, at[3] = {x[0] - within*n[0], x[1] - within*n[1], x[2] - within*n[2]};
  double       exposed = 1.0;

  for (PetscInt i = 0; i < p->n_neighbours; i++) {
    const ProxyNeighbour *o  = &p->neighbour[i];
    int                   in = 1;
    SurfaceFoot           foot;
    for (int k = 0; k < 3; k++) in &= x[k] > o->lo[k] && x[k] < o->hi[k];
    if (!in || !SurfaceIndexNearest(o->index, at, p->fluid.dx, &foot) || fabs(foot.distance) < 1e-6*p->fluid.dx) continue;
    const double cosine = -Dot3(foot.normal, n);
    exposed *= Exposure((foot.distance - within*cosine)/p->fluid.dx, cosine);
  }
  return exposed;
}

/* exposed[] of the proxies in use where they are */
void ProxyExpose(Proxy p)
{
  int hidden = 0;

#pragma omp parallel for schedule(static) reduction(| : hidden)
  for (PetscInt j = 0; j < p->n; j++) {
    const double *x = &p->x[3*j], *n = &p->normal[3*j];
    p->exposed[j]   = ExposedToPlanes(&p->fluid, x, n);
    if (p->n_neighbours && p->exposed[j] > 0.0) p->exposed[j] *= ExposedToNeighbours(p, x, n);
    hidden |= p->exposed[j] < 1.0;
  }
  p->hides = (PetscBool)hidden;
}
