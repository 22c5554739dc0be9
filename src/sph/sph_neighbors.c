/* sph_neighbors.c - particles sorted by cell, lists of neighbours within h. */
#include <math.h>
#include <stdlib.h>

#include "sph_impl.h"

/*
  A particle that is not a number, or that is deeper than its support in a wall, ends the run. The first one in the current
  order is named; `when` says where in the step.
*/
PetscErrorCode SPHCheckState_Internal(SPH sph, const char when[])
{
  const int n   = (int)sph->n;
  int       bad = n;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static) reduction(min : bad)
  for (int i = 0; i < n; i++) {
    const PetscReal *x = sph->x + 3 * i, *v = sph->v + 3 * i;
    PetscReal        sign;
    int              wrong = !(isfinite(x[0] + x[1] + x[2]) && isfinite(v[0] + v[1] + v[2]));

    for (int k = 0; k < 6; k++) wrong |= (sph->walls >> k & 1) && SPHPlaneDistance(sph, k, x, &sign) < -sph->h && !(sph->n_openings && SPHOpenSolid_Internal(sph, k, x) < 0.9);
    if (wrong && i < bad) bad = i;
  }
  if (bad < n) {
    const PetscReal *x = sph->x + 3 * bad, *v = sph->v + 3 * bad;
    const PetscBool  nan = (PetscBool)!(isfinite(x[0] + x[1] + x[2]) && isfinite(v[0] + v[1] + v[2]));

    PetscCall(PetscSNPrintf(sph->breakdown, sizeof(sph->breakdown), "step %d, %s: fluid particle %d %s: position (%g, %g, %g) m, velocity (%g, %g, %g) m/s", (int)sph->step,
                            when, (int)sph->id[bad], nan ? "has a position or velocity that is not a number" : "left the domain through a wall", (double)x[0], (double)x[1], (double)x[2],
                            (double)v[0], (double)v[1], (double)v[2]));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* cells of edge h or a little more over the box of the particles; far strays share the border cells */
static PetscErrorCode MakeGrid(SPH sph)
{
  SPHGrid       *g = &sph->loops.grid;
  const int      n = (int)sph->n;
  PetscReal      lo[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[3] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL};
  PetscInt       total = 1;

  PetscFunctionBegin;
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++) {
      lo[k] = PetscMin(lo[k], sph->x[3 * i + k]);
      hi[k] = PetscMax(hi[k], sph->x[3 * i + k]);
    }
  }
  for (int k = 0; k < 3; k++) {
    g->periodic[k] = (int)(sph->periodic >> k & 1);
    g->period[k]   = g->periodic[k] ? sph->max[k] - sph->min[k] : 0.0;
    if (g->periodic[k]) {
      g->lo[k] = sph->min[k];
      g->n[k]  = (int)floor(g->period[k] / sph->h);
      g->cell[k] = g->period[k] / g->n[k];
    } else {
      // one extent of the domain beyond the domain is enough for splashes
      if (sph->has_domain) {
        const PetscReal extent = sph->max[k] - sph->min[k] + sph->h;
        lo[k] = PetscMin(PetscMax(lo[k], sph->min[k] - extent), sph->max[k]);
        hi[k] = PetscMax(PetscMin(hi[k], sph->max[k] + extent), sph->min[k]);
      }
      g->lo[k]   = lo[k];
      g->n[k]    = (int)PetscMax(1.0, PetscMin(1023.0, floor((hi[k] - lo[k]) / sph->h) + 1.0));
      g->cell[k] = sph->h;
    }
    total *= g->n[k];
  }
  if (total + 1 > sph->grid_allocated) {
    sph->grid_allocated = total + 1 + total / 2;
    PetscCall(PetscFree(g->start));
    PetscCall(PetscMalloc1(sph->grid_allocated, &g->start));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int CellOf(const SPHGrid *g, const PetscReal x[3])
{
  int c[3];

  for (int k = 0; k < 3; k++) {
    const PetscReal q = floor((x[k] - g->lo[k]) / g->cell[k]);
    c[k]              = q < 0 ? 0 : q > g->n[k] - 1 ? g->n[k] - 1 : (int)q;
  }
  return c[0] + g->n[0] * (c[1] + g->n[1] * c[2]);
}

/* order[] = particles by cell, then by id: the order depends on the state alone, not on its history */
static void SortByCell(SPH sph)
{
  SPHGrid  *g     = &sph->loops.grid;
  const int n     = (int)sph->n, total = g->n[0] * g->n[1] * g->n[2];
  int      *cell  = sph->loops.cell;
  PetscInt *order = sph->order;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) cell[i] = CellOf(g, sph->x + 3 * i);

  // counting sort
  for (int c = 0; c <= total; c++) g->start[c] = 0;
  for (int i = 0; i < n; i++) g->start[cell[i] + 1]++;
  for (int c = 0; c < total; c++) g->start[c + 1] += g->start[c];
  for (int i = 0; i < n; i++) order[g->start[cell[i]]++] = i;
  for (int c = total; c > 0; c--) g->start[c] = g->start[c - 1];
  g->start[0] = 0;

  // by id within a cell: a handful of particles, nearly sorted
#pragma omp parallel for schedule(static)
  for (int c = 0; c < total; c++) {
    for (int a = g->start[c] + 1; a < g->start[c + 1]; a++) {
      const PetscInt o = order[a];
      int            b = a;
      for (; b > g->start[c] && sph->id[order[b - 1]] > sph->id[o]; b--) order[b] = order[b - 1];
      order[b] = o;
    }
  }
}

static void Permute(SPH sph)
{
  const int n = (int)sph->n;
  SPHGrid  *g = &sph->loops.grid;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    const PetscInt o = sph->order[i];
    for (int k = 0; k < 3; k++) {
      sph->x_alt[3 * i + k] = sph->x[3 * o + k];
      sph->v_alt[3 * i + k] = sph->v[3 * o + k];
    }
    sph->p_alt[i]  = sph->p[o];
    sph->id_alt[i] = sph->id[o];
  }
#define SWAP(type, a, b) \
  do { \
    type *t_ = a; \
    a        = b; \
    b        = t_; \
  } while (0)
  SWAP(PetscReal, sph->x, sph->x_alt);
  SWAP(PetscReal, sph->v, sph->v_alt);
  SWAP(PetscReal, sph->p, sph->p_alt);
  SWAP(PetscInt, sph->id, sph->id_alt);
#undef SWAP
#pragma omp parallel for schedule(static)
  for (int c = 0; c < g->n[0] * g->n[1] * g->n[2]; c++)
    for (int i = g->start[c]; i < g->start[c + 1]; i++) sph->loops.cell[i] = c;
}

/* room for `capacity` neighbours a particle */
static PetscErrorCode AllocateList(SPH sph, int capacity)
{
  SPHLoops    *l     = &sph->loops;
  const int    chunks = (int)((sph->capacity + SPH_PAIR_CHUNK - 1) / SPH_PAIR_CHUNK);
  const size_t slots  = (size_t)chunks * SPH_PAIR_CHUNK * (size_t)capacity;

  PetscFunctionBegin;
  PetscCheck(slots < 2147483647, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%zu neighbours do not fit 32-bit indices", slots);
  free(l->neighbour);
  free(l->gradient);
  free(l->viscous);
  l->viscous       = NULL;
  l->capacity      = capacity;
  sph->list_chunks = chunks;
  l->neighbour = malloc(sizeof(int) * slots);
  l->gradient  = malloc((size_t)sph->table->real_size * (3 * slots + 4));
  if (sph->params.viscosity > 0) l->viscous = malloc((size_t)sph->table->real_size * slots);
  PetscCheck(l->neighbour && l->gradient && (l->viscous || !(sph->params.viscosity > 0)), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for %zu neighbours", slots);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHUpdateNeighbors - sort the particles by cell, list the neighbours within h, sum the density of pairs, find the planar walls

  Collective; the order of the particles changes, arrays of SPHGetState() are to be fetched again

  Errors:
  BY_ERR_BREAKDOWN when a particle is not a number or left the domain through a wall

  Cost: O(n), allocates only when a neighbourhood has outgrown the list
@*/
PetscErrorCode SPHUpdateNeighbors(SPH sph)
{
  SPHLoops *l = &sph->loops;
  int       status;

  PetscFunctionBegin;
  PetscCheck(sph->setup, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "SPHSetUp() comes first");
  PetscCall(PetscLogEventBegin(SPH_Neighbors, sph, 0, 0, 0));
  if (sph->n_openings && !sph->packing) PetscCall(SPHExchange_Internal(sph));
  ByCall(SPHCheckState_Internal(sph, "before the neighbour search"));
  PetscCall(MakeGrid(sph));
  SortByCell(sph);
  Permute(sph);
  if (sph->n_openings) SPHOpenMark_Internal(sph);
  sph->grid_drift = 0.0;
  l->x            = sph->x;
  if (l->capacity == 0) {
    // a full neighbourhood and a half, and the slack of the search
    const PetscReal q = sph->params.support;
    PetscCall(AllocateList(sph, (int)(1.4 * 4.0 / 3.0 * PETSC_PI * q * q * q) + 4));
  } else if (l->n > sph->list_chunks * SPH_PAIR_CHUNK) PetscCall(AllocateList(sph, l->capacity));
  while ((status = sph->table->Pairs(l, sph->rho_pairs))) {
    PetscCheck(status == 1, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the candidates of a neighbour search");
    PetscCall(AllocateList(sph, l->capacity + l->capacity / 2));
  }
  PetscCall(SPHFindPlanes_Internal(sph));
  sph->n_surfaces = 0;
  sph->contacts   = NULL;
  PetscCall(PetscLogEventEnd(SPH_Neighbors, sph, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
