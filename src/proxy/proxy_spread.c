/* proxy_spread.c - the nodes that a proxy's part of the surface belongs to: forces go there, velocities come from there (method 5.1).

   A proxy b stands for a part P_b of the surface. Its weights are the means of the nodes' linear shape functions over that part,
     w_ba = int_{P_b} N_a dA / |P_b|,   sum_a w_ba = 1,   w_ba >= 0,
   so that a pressure that is the same everywhere gives the consistent nodal forces p int N_a n dA whatever the sampling: a proxy that stands for a hundred small
   triangles does not press on the node where it happens to lie. On a mesh coarser than the sampling they are the barycentric coordinates of the part's middle. */
#include "proxy/proxy_impl.h"

/* Pattern of one sampling: nodes of each proxy without repetition, the place of each part's corners among them, and where in its triangle a part lies. */
PetscErrorCode ProxySpreadPattern(const ProxySurface *s, ProxySampling *q)
{
  const PetscInt n_parts = q->part_start[q->n];
  PetscInt      *cursor, *seen, *where, n = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(q->n, &cursor, s->n_nodes, &seen, s->n_nodes, &where));
  PetscCall(PetscMalloc4(q->n + 1, &q->spread_start, 3*(n_parts + q->n), &q->spread_node, 3*n_parts, &q->part_slot, 3*n_parts, &q->part_middle));
  PetscCall(PetscArrayzero(q->part_middle, 3*n_parts));
  for (PetscInt a = 0; a < s->n_nodes; a++) seen[a] = -1;
  for (PetscInt i = 0; i < q->n; i++) {
    cursor[i]          = q->part_start[i];
    q->spread_start[i] = n;
    for (PetscInt k = q->part_start[i]; k < q->part_start[i + 1]; k++) {
      for (int c = 0; c < 3; c++) {
        const PetscInt a = s->triangles[3*q->part_triangle[k] + c];
        if (seen[a] != i) seen[a] = i, where[a] = n, q->spread_node[n++] = a;
        q->part_slot[3*k + c] = where[a] - q->spread_start[i];
      }
    }
    for (int c = 0; c < 3 && q->part_start[i] == q->part_start[i + 1]; c++) q->spread_node[n++] = q->nodes[3*i + c];
  }
  q->spread_start[q->n] = n;

  // middles of the parts: the pieces of a triangle are visited in its order, as the parts of each proxy are
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt m = (PetscInt)floor(sqrt((double)(q->piece_start[t + 1] - q->piece_start[t])) + 0.5);
    PetscInt       k = q->piece_start[t];
    for (PetscInt i = 0; i < m; i++) {
      for (PetscInt j = 0; j < m - i; j++) {
        for (int down = 0; down < (i + j < m - 1 ? 2 : 1); down++) {
          const PetscInt b = q->piece_owner[k++];
          PetscReal      at[3];
          while (q->part_triangle[cursor[b]] != t) cursor[b]++;
          ProxyPieceCentre(m, i, j, down, at);
          for (int c = 0; c < 3; c++) q->part_middle[3*cursor[b] + c] += at[c];
        }
      }
    }
  }
  for (PetscInt k = 0; k < n_parts; k++) {
    const PetscReal sum = q->part_middle[3*k] + q->part_middle[3*k + 1] + q->part_middle[3*k + 2];
    for (int c = 0; c < 3; c++) q->part_middle[3*k + c] /= sum;
  }
  PetscCall(PetscFree3(cursor, seen, where));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* weights of proxy number i of the sampling on the surface as it is; a part whose triangles have no area left counts by its share of them */
static void Weights(const Proxy p, PetscInt i, PetscReal w[])
{
  const ProxySampling *q = &p->sampling;
  const PetscInt       n = q->spread_start[i + 1] - q->spread_start[i];
  PetscReal            area = 0.0;

  for (PetscInt k = 0; k < n; k++) w[k] = 0.0;
  if (q->part_start[i] == q->part_start[i + 1]) {
    for (int c = 0; c < 3; c++) w[c] = q->weights[3*i + c];
    return;
  }
  for (PetscInt k = q->part_start[i]; k < q->part_start[i + 1]; k++) area += q->part[k]*p->geometry.area[q->part_triangle[k]];
  for (PetscInt k = q->part_start[i]; k < q->part_start[i + 1]; k++) {
    const PetscReal a = q->part[k]*(area > 0.0 ? p->geometry.area[q->part_triangle[k]] : 1.0);
    for (int c = 0; c < 3; c++) w[q->part_slot[3*k + c]] += a*q->part_middle[3*k + c];
  }
  area = 0.0;
  for (PetscInt k = 0; k < n; k++) area += w[k];
  for (PetscInt k = 0; k < n; k++) w[k] /= area;
}

/* the weights of the proxies in use, and p->place, the middles of their parts; nothing when the proxies are as they were */
PetscErrorCode ProxySpread(Proxy p)
{
  const ProxySampling *q = &p->sampling;
  PetscInt             n = 0;

  PetscFunctionBegin;
  if (p->spread_valid) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < p->n; j++) n += q->spread_start[p->active[j] + 1] - q->spread_start[p->active[j]];
  if (n > p->spread_capacity || p->n >= p->place_capacity) {
    PetscCall(PetscFree4(p->spread_start, p->spread_node, p->spread_weight, p->place));
    p->spread_capacity = PetscMax(n + n/4, p->spread_capacity);
    p->place_capacity  = PetscMax(p->n + p->n/4 + 1, p->place_capacity);
    PetscCall(PetscMalloc4(p->place_capacity + 1, &p->spread_start, p->spread_capacity, &p->spread_node, p->spread_capacity, &p->spread_weight, 3*p->place_capacity, &p->place));
  }
  p->spread_start[0] = 0;
  for (PetscInt j = 0; j < p->n; j++) p->spread_start[j + 1] = p->spread_start[j] + q->spread_start[p->active[j] + 1] - q->spread_start[p->active[j]];
#pragma omp parallel for schedule(static)
  for (PetscInt j = 0; j < p->n; j++) {
    const PetscInt begin = p->spread_start[j], *from = &q->spread_node[q->spread_start[p->active[j]]];
    Weights(p, p->active[j], &p->spread_weight[begin]);
    for (int d = 0; d < 3; d++) p->place[3*j + d] = 0.0;
    for (PetscInt k = begin; k < p->spread_start[j + 1]; k++) {
      p->spread_node[k] = from[k - begin];
      for (int d = 0; d < 3; d++) p->place[3*j + d] += p->spread_weight[k]*p->geometry.x[3*p->spread_node[k] + d];
    }
  }
  p->spread_valid = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxyForcesToNodes - add the forces on proxies to those on nodes, by weights; their couple is not kept, ProxyTransfer() does that

  Input Parameters:
+ proxy - the proxies
- force - n_proxies x 3 [N]

  Output Parameter:
. node_force - n_nodes x 3 [N], added to

  Tests: tests/unit/proxy/test_transfer.c

.seealso: ProxyVelocitiesFromNodes(), ProxyTransfer()
@*/
PetscErrorCode ProxyForcesToNodes(Proxy p, const PetscReal force[], PetscReal node_force[])
{
  PetscFunctionBegin;
  PetscCall(ProxySpread(p));
  for (PetscInt b = 0; b < p->n; b++) {
    for (PetscInt k = p->spread_start[b]; k < p->spread_start[b + 1]; k++) {
      for (int d = 0; d < 3; d++) node_force[3*p->spread_node[k] + d] += p->spread_weight[k]*force[3*b + d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxyVelocitiesFromNodes - mean velocities of what the proxies stand for: the transpose of ProxyForcesToNodes()

  Input Parameters:
+ proxy - the proxies
- v     - n_nodes x 3 [m/s]

  Output Parameter:
. velocity - n_proxies x 3 [m/s]
@*/
PetscErrorCode ProxyVelocitiesFromNodes(Proxy p, const PetscReal v[], PetscReal velocity[])
{
  PetscFunctionBegin;
  PetscCall(ProxySpread(p));
  for (PetscInt b = 0; b < p->n; b++) {
    for (int d = 0; d < 3; d++) velocity[3*b + d] = 0.0;
    for (PetscInt k = p->spread_start[b]; k < p->spread_start[b + 1]; k++) {
      for (int d = 0; d < 3; d++) velocity[3*b + d] += p->spread_weight[k]*v[3*p->spread_node[k] + d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
