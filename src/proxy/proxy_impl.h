/* proxy_impl.h - the inside of a Proxy; only for src/proxy and its tests. */
#ifndef BY_PROXY_IMPL_H
#define BY_PROXY_IMPL_H

#include "proxy/proxy.h"
#include "proxy/proxy_kernel.h"
#include <petsc/private/petscimpl.h>

/* bound on principal curvatures, times h: the profile's 1 + c z stays positive for |z| < h */
#define PROXY_CURVATURE 0.9

/* [degree] by which an edge passes the feature angle before the surface is sampled afresh, so that it does not go to and fro */
#define PROXY_FOLD_MARGIN 5.0

/* what the proxies must know of the fluid */
typedef struct {
  double   h, dx;          /* support radius, spacing [m]                                                  */
  int      kernel, gradient_kernel; /* SPHKernelType of density, of gradients                              */
  double   min[3], max[3]; /* domain [m]: period along the periodic axes                                   */
  unsigned periodic;       /* bit k = axis k                                                               */
  unsigned walls;          /* bit k = plane k is a wall, order xmin xmax ymin ymax zmin zmax               */
  double   plane[6];       /* where they are now, along their axes [m]                                     */
} ProxyFluid;

/* connectivity of the surface, fixed */
typedef struct {
  PetscInt   n_nodes, n_triangles, n_edges, n_patches, n_fans;
  PetscInt  *triangles;      /* n_triangles x 3, outward                                                   */
  PetscReal *X;              /* n_nodes x 3 [m], reference positions                                       */
  PetscInt  *edge_nodes;     /* n_edges x 2                                                                */
  PetscInt  *edge_triangles; /* n_edges x 2; second is -1 on an open border                                */
  PetscInt  *edge_side;      /* n_edges x 2: which side (0..2, from corner i to i + 1) of those triangles   */
  PetscInt  *triangle_edges; /* n_triangles x 3                                                            */
  PetscBool *edge_sharp;     /* n_edges: ends a smooth patch: open, or of a dihedral angle beyond feature_angle ... */
  PetscBool *edge_feature, *edge_fold; /* ... in the reference position; where the surface was last sampled */
  PetscInt  *patch;          /* n_triangles: smooth part of the surface                                    */
  PetscBool *patch_open;     /* n_patches: has an open border                                              */
  PetscBool *patch_sharp;    /* n_patches: has a sharp edge                                                */
  PetscInt  *fan;            /* n_triangles x 3: vertex fan of each corner (a vertex, once per smooth side) */
  PetscBool *fan_sharp;      /* n_fans: the fan ends at sharp edges                                         */
  PetscInt  *fan_start, *fan_corner; /* corners 3 t + i of each fan                                        */
} ProxySurface;

/* geometry of the surface where it is now */
typedef struct {
  PetscReal *x;              /* n_nodes x 3 [m]                                                            */
  PetscReal *area, *normal;  /* n_triangles [m^2], x 3                                                     */
  PetscReal *fan_normal;     /* n_fans x 3                                                                 */
  PetscReal *shape;          /* n_triangles x 6: shape operator [1/m]                                      */
} ProxyGeometry;

typedef enum { PROXY_VERTEX, PROXY_EDGE, PROXY_FACE } ProxyKind;

/* one sampling of the surface */
typedef struct {
  PetscInt   n;
  PetscInt  *triangle, *nodes;           /* n, n x 3                                                       */
  PetscReal *weights;                    /* n x 3 barycentric, >= 0, sum 1                                 */
  PetscReal *kappa;                      /* n, kappa-bar                                                   */
  int       *kind, *side;                /* ProxyKind; for edges the side of the triangle                  */
  PetscInt  *part_start, *part_triangle; /* which triangles' area each proxy stands for ...                */
  PetscReal *part;                       /* ... and which fraction of it                                   */
  PetscInt  *spread_start, *spread_node; /* n + 1: nodes of those triangles, each once (proxy_spread.c)    */
  PetscInt  *part_slot;                  /* by part x 3: its corners among these nodes                     */
  PetscReal *part_middle;                /* by part x 3: barycentric coordinates of its middle             */
  PetscInt  *piece_start, *piece_owner;  /* triangles cut into m^2 pieces (row by row), the proxy of each  */
  PetscReal *offset, *extent;            /* n, n x 8 [m], see ProxyPoint                                   */
  PetscReal *area0, *edge0;              /* triangle areas [m^2], edge lengths [m] when sampled            */
  PetscReal *x;                          /* n_nodes x 3 [m], where the surface was when sampled            */
} ProxySampling;

/* what rejects most proxies of a cell: position, normal, squared tangential radius, bound of |n.r| */
typedef struct {
  double x[3], n[3], radius2, half;
} ProxyReach;

/* cells over the supports: the proxies that may touch a particle in a cell */
typedef struct {
  double    lo[3], cell;
  PetscInt  dims[3];
  PetscInt *start, *entry; /* entry = proxy*27 + image code                                               */
  PetscInt  longest;           /* most entries of a cell                                                  */
  size_t    n_start, n_entry; /* allocated                                                                */
} ProxyCells;

/* where fluid is, around a surface: `below` counts the occupied cells below each corner of the grid, so that any box is asked in eight look-ups */
typedef struct {
  double    lo[3], cell;
  PetscInt  dims[3];
  PetscInt *below;      /* (dims[0] + 1) x (dims[1] + 1) x (dims[2] + 1), first index fastest */
  size_t    n_below;    /* allocated                                                          */
} ProxyOccupied;

/* which proxies fluid may touch */
typedef struct {
  ProxyOccupied occupied;
  double        lo[3], hi[3];   /* box of the balls                                                        */
  double       *ball, *box;     /* sampling.n x 4, x 6: around supports of any shape; around the supports  */
  PetscBool     has_boxes;      /* all of box[] is that of the surface where it is                         */
  PetscInt      capacity;
} ProxyMask;

/* an obstacle on which the surface may lie */
typedef struct {
  SurfaceIndex index;
  double       lo[3], hi[3]; /* its box and a spacing around it [m] */
} ProxyNeighbour;

/* foot of a particle on the neighbour that was asked last; -1 = none yet */
typedef struct {
  PetscInt    neighbour;
  PetscBool   found;
  SurfaceFoot foot;
} ProxyFoot;

typedef struct {
  int dummy;
} ProxyOps;

struct _p_Proxy {
  PETSCHEADER(ProxyOps);
  char          name[BY_NAME_MAX];
  ProxyParams   params;
  ProxyFluid    fluid;
  SPH           sph;
  PetscBool     setup, has_fluid;
  PetscReal     factor, inset;  /* calibrated or given: [1], [m]                                           */
  PetscReal    *density;        /* n_nodes: kappa-bar that was given; NULL = none                          */
  ProxySurface  surface;
  ProxyGeometry geometry;
  ProxySampling sampling;
  ProxyCells    cells;
  PetscBool     cells_valid;
  PetscInt      n_samplings;    /* how often the surface was sampled                                       */
  ProxyMask     mask;
  PetscInt      n;              /* proxies in use: those of the sampling that fluid may touch; arrays below are theirs */
  PetscInt      capacity;       /* of the arrays by proxy                                                  */
  PetscInt     *active, *near; /* n: number in the sampling, ascending; scratch                             */
  PetscInt     *nodes, *patch;  /* n x 3, n                                                                */
  PetscReal    *weights, *kappa; /* n x 3, n                                                               */
  ProxyPoint   *points;         /* n                                                                       */
  ProxyReach   *reach;          /* n                                                                       */
  PetscReal    *x, *normal, *area, *velocity, *force; /* n x 3, x 3, n, x 3, x 3                           */
  PetscBool     spread_valid;
  PetscInt      spread_capacity, place_capacity;
  PetscInt     *spread_start, *spread_node; /* n + 1: nodes that take a proxy's force ...                  */
  PetscReal    *spread_weight;  /* ... with these weights, and give it its velocity                        */
  PetscReal    *place;          /* n x 3 [m], where that force acts: sum of weights times positions        */
  PetscReal    *centre;         /* n x 3 [m], middle of the triangles that each stands for: always inside its patch */
  PetscReal    *exposed, *laid; /* n: 1 in the open, 0 on a planar wall; 0 in the open, 1 on an obstacle (proxy_wall.c) */
  PetscInt     *lies_on;        /* n: on which neighbour                                                   */
  PetscBool     hides;          /* one of them lies on something                                           */
  PetscInt      n_neighbours;
  ProxyNeighbour *neighbour;
  PetscReal    *node_velocity;  /* n_nodes x 3; NULL = at rest                                             */
  PetscReal     rotation[3];    /* [rad/s] of the surface as a whole, by node_velocity                      */
  PetscReal    *node_weight;    /* n_nodes: a third of the triangles around each [m^2]                     */
  SPHContacts   contacts;
  void         *chunks;         /* result buffers of proxy_contacts.c                                      */
  PetscInt      n_chunks, pair_capacity, touched_capacity;
};

/* proxy_surface.c */
PetscErrorCode ProxySurfaceBuild(const char key[], PetscReal feature_angle, const ProxyFluid *fluid, PetscInt n_nodes, const PetscReal X[],
                                 PetscInt n_triangles, const PetscInt triangles[], ProxySurface *surface);
PetscErrorCode ProxySurfaceDestroy(ProxySurface *surface);
/* creases that deformation has made or smoothed at the places x: sharp edges, patches and fans anew when there are others than before */
PetscErrorCode ProxySurfaceFold(PetscReal feature_angle, const ProxyFluid *fluid, const PetscReal x[], ProxySurface *surface, PetscBool *changed);
/* has an edge passed feature_angle since the last ProxySurfaceFold(), by PROXY_FOLD_MARGIN and more? normal: of the triangles now */
PetscBool      ProxySurfaceCreased(PetscReal feature_angle, const ProxySurface *surface, const PetscReal normal[]);

/* proxy_curvature.c */
PetscErrorCode ProxyGeometryCreate(const ProxySurface *surface, ProxyGeometry *geometry);
PetscErrorCode ProxyGeometryDestroy(ProxyGeometry *geometry);
/* everything of `geometry` from its x; shape operators bounded by max_curvature [1/m] */
void           ProxyGeometryUpdate(const ProxySurface *surface, PetscReal max_curvature, ProxyGeometry *geometry);
/* Gaussian curvature and mixed area by node; nodes outside the surface get 0 */
PetscErrorCode ProxyGaussianCurvature(const ProxySurface *surface, const PetscReal x[], PetscReal kappa[], PetscReal area[]);
/* kappa-bar by node, edge, triangle of the surface as it is in `geometry`; density: that of the nodes, NULL = as params say */
PetscErrorCode ProxyNormalizedCurvature(const ProxySurface *surface, const ProxyGeometry *geometry, const ProxyParams *params, PetscReal h,
                                        const PetscReal density[], PetscReal node[], PetscReal edge[], PetscReal triangle[]);
void           ProxyShapeBound(PetscReal max_curvature, double S[6]);

/* proxy_sample.c */
PetscErrorCode ProxySample(const ProxySurface *surface, const ProxyGeometry *geometry, const ProxyParams *params, const ProxyFluid *fluid,
                           const PetscReal density[], ProxySampling *sampling);
/* offsets and extents of `points` from the surface that they stand for, into the sampling */
PetscErrorCode ProxyMeasureParts(const ProxySurface *surface, const ProxyGeometry *geometry, const ProxyPoint points[], ProxySampling *sampling);
PetscErrorCode ProxySamplingDestroy(ProxySampling *sampling);
/* barycentric centre of the piece (i, j) of m^2, upward or downward, of a triangle */
void           ProxyPieceCentre(PetscInt m, PetscInt i, PetscInt j, int down, PetscReal b[3]);

/* proxy_spread.c */
PetscErrorCode ProxySpreadPattern(const ProxySurface *surface, ProxySampling *sampling);
PetscErrorCode ProxySpread(Proxy proxy);

/* proxy_density.c: what the scene says of the density, into proxy->density; `given` is the surface of the scene */
PetscErrorCode ProxyReadDensity(Proxy proxy, const ProxySurface *given);

/* proxy_place.c: proxies on the surface as `geometry` has it */
PetscErrorCode ProxyPlaceSampled(Proxy proxy); /* of a new sampling: positions, normals, shapes of all, which ProxyMeasureParts() needs */
PetscErrorCode ProxyPlaceAll(Proxy proxy);
/* those that one of n particles at x may touch; `moved`: the surface has, since they were last placed */
PetscErrorCode ProxyPlaceNear(Proxy proxy, PetscBool moved, PetscInt n, const PetscReal x[]);
PetscErrorCode ProxyPlaceVelocities(Proxy proxy);
PetscErrorCode ProxyPlaceDestroy(Proxy proxy);

/* proxy_wall.c */
void           ProxyExpose(Proxy proxy);
double         ProxyExposureAt(const Proxy proxy, PetscInt j, const double x[3], ProxyFoot *last, double grad[3]);

/* proxy_mask.c */
/* support of a proxy as a cylinder around its normal: half height and radius [m] */
void           ProxySupport(const Proxy proxy, const ProxyPoint *point, double *half, double *radius);
/* Numbers in the sampling of those that may touch one of n particles at x, into active[]: exact when boxes are known and the surface has not
   moved since, else a superset, and ProxyMaskAfter() tells of the proxies that were placed whose supports reach an occupied cell. */
PetscErrorCode ProxyMaskBefore(Proxy proxy, PetscBool moved, PetscInt n, const PetscReal x[], PetscInt active[], PetscInt *n_active);
void           ProxyMaskAfter(const Proxy proxy, PetscBool keep[]);
void           ProxyMaskBoxes(Proxy proxy); /* of all, which are placed: exact from now on, until the surface moves */
PetscErrorCode ProxyMaskDestroy(Proxy proxy);

/* period along an axis, 0 when there is none */
static inline double ProxyPeriod(const ProxyFluid *fluid, int k)
{
  return fluid->periodic & (1u << k) ? fluid->max[k] - fluid->min[k] : 0.0;
}

/* proxy_contacts.c */
PetscErrorCode ProxyFindContacts(Proxy proxy, PetscInt n, const PetscReal x[], SPHContacts *contacts);
PetscErrorCode ProxyContactsDestroy(Proxy proxy);

/* proxy_ellipsoid.c */
/* volumes V_b = factor / sum_k W_b(x_k - x_b) over the proxies of one body (method 4.3, Psi_b = rho0 V_b), into points[].weight */
PetscErrorCode ProxyEllipsoidVolumes(int kernel, double h, double factor, PetscInt n, ProxyPoint points[]);

/* proxy_fluid.c: the fluid's numbers, for tests without an SPH */
PetscErrorCode ProxySetFluidScale(Proxy proxy, const ProxyFluid *fluid);

#endif
