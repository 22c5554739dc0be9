/* surface.h - closed triangle surfaces: reading from a file, inside test, distance. Geometry only, no physics. */
#ifndef BY_SURFACE_H
#define BY_SURFACE_H

#include "base.h"

typedef struct {
  PetscInt   n_nodes, n_triangles;
  PetscReal *x;         /* n_nodes x 3 [m]      */
  PetscInt  *triangles; /* n_triangles x 3, outward */
} Surface;

/* Read a triangle surface (STL, OFF, OBJ, PLY, gmsh .msh) and orient it outward. User errors (cannot read, no triangles, not closed: the
   first open edge is named) are printed, BY_ERR_INPUT is returned. */
/* key: the scene key that named the file ("cylinder.surface"), for InputError */
BY_EXTERN PetscErrorCode SurfaceRead(const char key[], const char path[], PetscReal scale, const PetscReal translate[3], Surface *surface);
BY_EXTERN PetscErrorCode SurfaceDestroy(Surface *surface);

/* Generalised winding number (van Oosterom & Strackee 1983 solid angles) of points against triangles with current node positions:
   inside where > 0.5. Points outside the bounding box are skipped (0). OpenMP over points. */
BY_EXTERN PetscErrorCode SurfaceWinding(PetscInt n_points, const PetscReal points[], const PetscReal x[], PetscInt n_triangles,
                                        const PetscInt triangles[], PetscReal winding[]);
/* Unsigned distance [m] to the surface, exact up to `reach`, anything larger beyond. */
BY_EXTERN PetscErrorCode SurfaceDistance(PetscInt n_points, const PetscReal points[], const PetscReal x[], PetscInt n_triangles,
                                         const PetscInt triangles[], PetscReal reach, PetscReal distance[]);

/* The same, and where: the closest triangle (-1 beyond reach) and its foot's barycentric weights, n_points x 3; both may be NULL. Of
   equally near triangles the last is taken. */
BY_EXTERN PetscErrorCode SurfaceClosest(PetscInt n_points, const PetscReal points[], const PetscReal x[], PetscInt n_triangles, const PetscInt triangles[],
                                        PetscReal reach, PetscReal distance[], PetscInt triangle[], PetscReal weights[]);

/* A closed surface at rest for many questions: from inside a parallel region, and with a sign. */
typedef struct _SurfaceIndex *SurfaceIndex;

typedef struct {
  PetscReal distance;  /* [m], negative inside                                                      */
  PetscReal normal[3]; /* unit vector: the gradient of the distance                                 */
  int       kind;      /* of the place next to the point: 2 in a face, 1 on an edge, 0 at a vertex  */
  PetscReal along[3];  /* unit vector along that edge                                               */
} SurfaceFoot;

/* reach: the largest distance [m] that will be asked for; arrays are copied */
BY_EXTERN PetscErrorCode SurfaceIndexCreate(PetscInt n_nodes, const PetscReal x[], PetscInt n_triangles, const PetscInt triangles[],
                                            PetscReal reach, SurfaceIndex *index);
BY_EXTERN PetscErrorCode SurfaceIndexDestroy(SurfaceIndex *index);
/* where a point is, when it is not farther than reach; PETSC_FALSE when it is */
BY_EXTERN PetscBool SurfaceIndexNearest(SurfaceIndex index, const PetscReal point[3], PetscReal reach, SurfaceFoot *foot);

#endif
