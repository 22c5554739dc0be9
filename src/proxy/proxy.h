/* proxy.h - surface proxy particles: curvature, adaptive sampling, supports, contacts with the fluid, transfer to nodes. */
#ifndef BY_PROXY_H
#define BY_PROXY_H

#include "keys.h"
#include "surface.h"
#include "sph/sph.h"

typedef struct _p_Proxy *Proxy;

typedef enum { PROXY_KERNEL_HALF_SPACE, PROXY_KERNEL_ELLIPSOID, PROXY_KERNEL_SPHERE } ProxyKernel;
typedef enum { PROXY_MEASURE_GAUSSIAN, PROXY_MEASURE_PRINCIPAL } ProxyMeasure;
typedef enum { PROXY_RANGE_ROBUST, PROXY_RANGE_MINMAX } ProxyRange;

/* Parameters of `<body>.proxy:` and `<obstacle>.proxy:`; ProxyKeys[] (proxy_keys.c) declares each. */
typedef struct {
  PetscBool adaptive;            /* density follows curvature; false = uniform                               */
  PetscBool thin;                /* to the wanted spacing where the mesh is finer; false = a proxy at every vertex */
  PetscReal kappa;               /* normalised curvature everywhere, uniform; 0 = as `adaptive` says         */
  PetscReal eta_min, eta_max;    /* range of the normalised curvature                                        */
  PetscReal inset;               /* the kernel's surface beneath the mesh by this many dx; negative = calibrated */
  PetscReal factor;              /* on the boundary volume; 0 = calibrated value of kernel and h/dx          */
  PetscReal resample_tolerance;  /* edge or area ratio change that triggers resampling; 0 = every step       */
  PetscReal feature_angle;       /* [degree] dihedral beyond which an edge is sharp                          */
  int       kernel;              /* ProxyKernel                                                              */
  int       measure;             /* ProxyMeasure                                                             */
  int       range;               /* ProxyRange, of the Gaussian measure                                      */
  char      density[PETSC_MAX_PATH_LEN]; /* CSV file of x, y, z [m], kappa-bar; none = as `adaptive` says     */
} ProxyParams;

BY_EXTERN const Key ProxyKeys[];

/* life: Create -> SetSurface -> SetFluid -> SetFromOptions (prefix "<body>_proxy_") -> SetUp -> Update, Contacts, Transfer */
BY_EXTERN PetscErrorCode ProxyCreate(MPI_Comm comm, const char name[], Proxy *proxy);
BY_EXTERN PetscErrorCode ProxyGetParams(Proxy proxy, ProxyParams **params);
/* n_nodes nodes (also interior ones of a body: only those in triangles matter), triangles outward; copied */
BY_EXTERN PetscErrorCode ProxySetSurface(Proxy proxy, PetscInt n_nodes, const PetscReal X[], PetscInt n_triangles, const PetscInt triangles[]);
/* density of one's own: kappa-bar of every node, > 0 (spacing h/(2 kappa-bar)), in place of curvature; copied; before SetUp */
BY_EXTERN PetscErrorCode ProxySetDensity(Proxy proxy, const PetscReal kappa[]);
#define PROXY_NEIGHBOUR_REACH 1.5 /* [h] reach of the index of a neighbour */
/* obstacles on which the surface may come to lie: faces that do stop acting, as those on planar walls */
BY_EXTERN PetscErrorCode ProxyAddNeighbour(Proxy proxy, SurfaceIndex index, const PetscReal min[3], const PetscReal max[3]);
/* support radius h [m], spacing dx [m], kernel of the fluid; periodic box of the domain for minimal images */
BY_EXTERN PetscErrorCode ProxySetFluid(Proxy proxy, SPH sph);
BY_EXTERN PetscErrorCode ProxySetFromOptions(Proxy proxy);
BY_EXTERN PetscErrorCode ProxySetUp(Proxy proxy);
BY_EXTERN PetscErrorCode ProxyView(Proxy proxy, PetscViewer viewer);
BY_EXTERN PetscErrorCode ProxyDestroy(Proxy *proxy);

/* move proxies with the surface: current nodal positions and (mean) velocities, n_nodes x 3; v NULL = at rest.
   Resamples when the surface has changed by more than the tolerance. */
BY_EXTERN PetscErrorCode ProxyUpdate(Proxy proxy, const PetscReal x[], const PetscReal v[]);
/* set only the velocities that the fluid sees */
BY_EXTERN PetscErrorCode ProxySetVelocity(Proxy proxy, const PetscReal v[]);
/* contacts with the fluid at its current sorted positions; arrays owned by the proxy, valid until the next call */
BY_EXTERN PetscErrorCode ProxyGetContacts(Proxy proxy, SPHContacts *contacts);

/* Forces on proxies, n_proxies x 3 [N], to the nodes of the part of the surface that each stands for, added to node_force; mean velocities of these parts, n_proxies x 3
   [m/s], from those of the nodes: transposes of each other */
BY_EXTERN PetscErrorCode ProxyForcesToNodes(Proxy proxy, const PetscReal force[], PetscReal node_force[]);
BY_EXTERN PetscErrorCode ProxyVelocitiesFromNodes(Proxy proxy, const PetscReal v[], PetscReal velocity[]);
/* adds to nodal forces (n_nodes x 3 [N]) the forces on proxies; total force and total moment (about any point) equal those
   that the fluid exerted, whose moment about the origin is `moment` [N m] (NULL: that of the forces in the middle of what each proxy stands for) */
BY_EXTERN PetscErrorCode ProxyTransfer(Proxy proxy, const PetscReal force[], const PetscReal moment[3], PetscReal node_force[]);
/* the part of it that takes a moment [N m] to the nodes, added to node_force, and its transpose: rotation [rad/s] of the surface as a whole by nodal
   velocities, so that node_force . v = moment . rotation */
BY_EXTERN PetscErrorCode ProxyAddCouple(Proxy proxy, const PetscReal moment[3], PetscReal node_force[]);
BY_EXTERN PetscErrorCode ProxyGetRotation(Proxy proxy, const PetscReal v[], PetscReal rotation[3]);

/* fields at the nodes of the surface, n_nodes x n, from n values (at most PROXY_FIELDS) at each proxy that count by weight >= 0 (NULL: by area, and as 0
   where no fluid is near); 0 where no proxy is near */
#define PROXY_FIELDS 8
BY_EXTERN PetscErrorCode ProxyToNodes(Proxy proxy, PetscInt n, const PetscReal value[], const PetscReal weight[], PetscReal node_value[]);

/* force into the surface [N] on the part that the box cuts out of it in its reference position, and its area [m^2]; force: n x 3 [N], may be NULL */
BY_EXTERN PetscErrorCode ProxyGetPatch(Proxy proxy, const PetscReal min[3], const PetscReal max[3], const PetscReal force[], PetscReal *push, PetscReal *area);

/* restart: positions [m], n_nodes x 3, at which the surface was last sampled; setting them samples it there again, to the same bits.
   After ProxySetSampling call ProxyUpdate with the current positions. */
BY_EXTERN PetscErrorCode ProxyGetSampling(Proxy proxy, const PetscReal *x[]);
BY_EXTERN PetscErrorCode ProxySetSampling(Proxy proxy, const PetscReal x[]);

/* proxies for output: positions, normals [n x 3], curvature kappa-bar, area; borrowed */
BY_EXTERN PetscErrorCode ProxyGetPoints(Proxy proxy, PetscInt *n, const PetscReal *x[], const PetscReal *normal[], const PetscReal *kappa[], const PetscReal *area[]);
/* proxies in use, proxies of the sampling, how often the surface was sampled by this process; each may be NULL */
BY_EXTERN PetscErrorCode ProxyGetCounts(Proxy proxy, PetscInt *in_use, PetscInt *sampled, PetscInt *samplings);
/* sum over vertices of Gaussian curvature times area (2 pi chi on a closed surface) */
BY_EXTERN PetscErrorCode ProxyGetTotalCurvature(Proxy proxy, PetscReal *total);

#endif
