/* proxy_density.c - a density of the user's own: kappa-bar by node, from an array or from a file of points. */
#include <errno.h>
#include <math.h>
#include <stdio.h>

#include "course.h"
#include "proxy/proxy_impl.h"

#define KAPPA_MAX 4.0 /* as of the keys eta_max and kappa */

typedef struct {
  PetscInt   n, capacity;
  PetscReal *row; /* n x 4: x, y, z [m], kappa-bar */
} Rows;

/*@
  ProxySetDensity - sample by a density of one's own in place of the curvature

  Input Parameters:
+ proxy - after ProxySetSurface(), before ProxySetUp()
- kappa - kappa-bar of every node of the surface, > 0: the spacing there is h/(2 kappa-bar); copied

  Notes:
  Edges and triangles have the mean of their nodes. A mesh much coarser than the wanted change of density cannot show it.
@*/
PetscErrorCode ProxySetDensity(Proxy p, const PetscReal kappa[])
{
  PetscFunctionBegin;
  PetscCheck(!p->setup && p->surface.X, PETSC_COMM_SELF, PETSC_ERR_ORDER, "set the density after the surface, before ProxySetUp()");
  for (PetscInt v = 0; v < p->surface.n_nodes; v++) {
    PetscCheck(kappa[v] > 0.0 && kappa[v] <= KAPPA_MAX, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "kappa-bar %g of node %" PetscInt_FMT " is not in (0, %g]", (double)kappa[v], v, KAPPA_MAX);
  }
  PetscCall(PetscFree(p->density));
  PetscCall(PetscMalloc1(p->surface.n_nodes, &p->density));
  PetscCall(PetscArraycpy(p->density, kappa, p->surface.n_nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rows of an open file; a first line of words is its heading */
static PetscErrorCode ReadRows(const char key[], FILE *file, Rows *rows)
{
  char     line[1024];
  double   row[4];
  PetscInt number = 0;

  PetscFunctionBegin;
  while (fgets(line, sizeof(line), file)) {
    const int n = CourseParseLine(line, 4, row);
    number++;
    if (!n || (n < 0 && number == 1)) continue;
    if (n != 4 || !isfinite(row[0] + row[1] + row[2]) || !(row[3] > 0.0 && row[3] <= KAPPA_MAX)) {
      PetscFunctionReturn(InputError(key, "holds in line %" PetscInt_FMT " what is not a place and its density\nexpected rows of x, y, z [m], kappa with 0 < kappa <= %g", number, KAPPA_MAX));
    }
    if (rows->n == rows->capacity) {
      rows->capacity = 2*rows->capacity + 64;
      PetscCall(PetscRealloc(4*sizeof(PetscReal)*(size_t)rows->capacity, &rows->row));
    }
    for (int k = 0; k < 4; k++) rows->row[4*rows->n + k] = row[k];
    rows->n++;
  }
  if (!rows->n) PetscFunctionReturn(InputError(key, "holds no rows\nexpected rows of x, y, z [m], kappa"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* every node takes the value of the nearest row; of equally near ones the first */
static void TakeNearest(const Rows *rows, PetscInt n, const PetscReal X[], PetscReal kappa[])
{
#pragma omp parallel for schedule(static)
  for (PetscInt v = 0; v < n; v++) {
    PetscReal least = PETSC_MAX_REAL;
    for (PetscInt i = 0; i < rows->n; i++) {
      double r[3];
      Sub3(&rows->row[4*i], &X[3*v], r);
      if (Dot3(r, r) >= least) continue;
      least    = Dot3(r, r);
      kappa[v] = rows->row[4*i + 3];
    }
  }
}

PetscErrorCode ProxyReadDensity(Proxy p, const ProxySurface *given)
{
  char           key[BY_NAME_MAX + 16];
  PetscErrorCode ierr;
  FILE          *file;
  Rows           rows = {0, 0, NULL};

  PetscFunctionBegin;
  if (!p->params.density[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.proxy.density", p->name));
  if (p->params.kappa > 0.0) PetscFunctionReturn(InputError(key, "does not go with %s.proxy.kappa = %g\ngive one of them", p->name, (double)p->params.kappa));
  file = fopen(p->params.density, "r");
  if (!file) PetscFunctionReturn(InputError(key, "cannot be read: %s", strerror(errno)));
  ierr = ReadRows(key, file, &rows);
  fclose(file);
  if (!ierr && !p->density) PetscCall(PetscMalloc1(given->n_nodes, &p->density));
  if (!ierr) TakeNearest(&rows, given->n_nodes, given->X, p->density);
  PetscCall(PetscFree(rows.row));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
