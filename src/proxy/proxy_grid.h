/* proxy_grid.h - a bucket grid over points that grows as points are added; for thinning and nearest-proxy search. */
#ifndef BY_PROXY_GRID_H
#define BY_PROXY_GRID_H

#include "base.h"

typedef struct {
  double    lo[3], cell;
  PetscInt  dims[3];
  PetscInt *head, *next; /* first point of a cell, next point in the same cell; -1 = none */
} PointGrid;

/* cells of at least `cell` over the bounding box of n_box points x; room for point numbers below `capacity` */
PetscErrorCode PointGridCreate(PetscInt n_box, const PetscReal x[], double cell, PetscInt capacity, PointGrid *grid);
PetscErrorCode PointGridDestroy(PointGrid *grid);

static inline PetscInt PointGridIndex(const PointGrid *g, const double x[3], PetscInt c[3])
{
  for (int k = 0; k < 3; k++) {
    const PetscInt i = (PetscInt)floor((x[k] - g->lo[k])/g->cell);
    c[k] = i < 0 ? 0 : i >= g->dims[k] ? g->dims[k] - 1 : i;
  }
  return (c[2]*g->dims[1] + c[1])*g->dims[0] + c[0];
}

static inline void PointGridAdd(PointGrid *g, PetscInt i, const double x[3])
{
  PetscInt       c[3];
  const PetscInt cell = PointGridIndex(g, x, c);
  g->next[i]    = g->head[cell];
  g->head[cell] = i;
}

#endif
