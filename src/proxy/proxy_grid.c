/* proxy_grid.c - the bucket grid of proxy_grid.h. */
#include "proxy/proxy_grid.h"

PetscErrorCode PointGridCreate(PetscInt n_box, const PetscReal x[], double cell, PetscInt capacity, PointGrid *g)
{
  double hi[3], n_cells;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    g->lo[k] = PETSC_MAX_REAL;
    hi[k]    = -PETSC_MAX_REAL;
    for (PetscInt i = 0; i < n_box; i++) {
      g->lo[k] = PetscMin(g->lo[k], x[3*i + k]);
      hi[k]    = PetscMax(hi[k], x[3*i + k]);
    }
  }

  // a surface much larger than its spacing gets coarser cells: memory stays proportional to the points
  for (n_cells = PETSC_MAX_REAL, cell /= 1.26; n_cells > 8.0*capacity + 1000.0;) {
    cell *= 1.26;
    n_cells = 1.0;
    for (int k = 0; k < 3; k++) n_cells *= floor((hi[k] - g->lo[k])/cell) + 1.0;
  }
  g->cell = cell;
  for (int k = 0; k < 3; k++) g->dims[k] = (PetscInt)floor((hi[k] - g->lo[k])/cell) + 1;
  PetscCall(PetscMalloc2((PetscInt)n_cells, &g->head, PetscMax(1, capacity), &g->next));
  for (PetscInt c = 0; c < (PetscInt)n_cells; c++) g->head[c] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PointGridDestroy(PointGrid *g)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(g->head, g->next));
  PetscFunctionReturn(PETSC_SUCCESS);
}
