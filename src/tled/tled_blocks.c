/* tled_blocks.c - tetrahedra cut into cache-sized blocks by METIS, nodes and elements renumbered along them, packed for vector
 * loops. */
#include "tled/tled_impl.h"
#include "tled/tled_t10.h"
#include <metis.h>

/* part[e]: the METIS part of each tetrahedron, from the graph of elements that share a face. Recursive bisection gives neighbours
   near numbers; a fixed seed gives the same cut every time. */
static PetscErrorCode CutElements(const TLEDMesh *mesh, PetscInt part[])
{
  idx_t  n_tets = mesh->n_tets, n_nodes = mesh->n_nodes, n_common = 3, n_parts, cut, options[METIS_NOPTIONS];
  idx_t *offset, *corner, *element_part, *node_part;
  idx_t  n_part = (mesh->n_corners == 4 ? TLED_BLOCK_TETS : TLED_BLOCK_TETS_T10) * 7 / 8; /* an eighth of room for METIS's imbalance */
  int    status;

  PetscFunctionBegin;
  n_parts = (n_tets + n_part - 1) / n_part;
  PetscCall(PetscMalloc4(n_tets + 1, &offset, 4 * n_tets, &corner, n_tets, &element_part, n_nodes, &node_part));
  for (PetscInt e = 0; e <= n_tets; e++) offset[e] = 4 * e;
  for (PetscInt k = 0; k < 4 * n_tets; k++) corner[k] = mesh->tets[mesh->n_corners * (k / 4) + k % 4]; /* vertices are enough */
  for (PetscInt e = 0; e < n_tets; e++) element_part[e] = 0;
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_PTYPE] = METIS_PTYPE_RB;
  options[METIS_OPTION_SEED]  = 1;
  status = n_parts > 1 ? METIS_PartMeshDual(&n_tets, &n_nodes, offset, corner, NULL, NULL, &n_common, &n_parts, NULL, options, &cut,
                                            element_part, node_part)
                       : METIS_OK;
  PetscCheck(status == METIS_OK, PETSC_COMM_SELF, PETSC_ERR_LIB, "METIS_PartMeshDual failed with status %d", status);
  for (PetscInt e = 0; e < n_tets; e++) part[e] = element_part[e];
  PetscCall(PetscFree4(offset, corner, element_part, node_part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* new numbers: elements by part and material, nodes in the order in which these meet them; nodes of no element are dropped */
static PetscErrorCode Renumber(TLEDMesh *mesh, const PetscInt part[])
{
  const PetscInt n_corners = mesh->n_corners;
  PetscInt      *order, *key, *number, n = 0, m, *tets, *tag, *material, *place;
  PetscReal     *X;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(mesh->n_tets, &order, mesh->n_tets, &key, mesh->n_nodes, &number));
  for (PetscInt e = 0; e < mesh->n_tets; e++) order[e] = e, key[e] = part[e] * TLED_MATERIALS + mesh->material[e];
  PetscCall(PetscSortIntWithArray(mesh->n_tets, key, order));
  for (PetscInt e = 0, first = 0; e < mesh->n_tets; e++) { /* within a part and a material, the file's order */
    if (e + 1 < mesh->n_tets && key[e + 1] == key[first]) continue;
    PetscCall(PetscSortInt(e + 1 - first, &order[first]));
    first = e + 1;
  }
  for (PetscInt a = 0; a < mesh->n_nodes; a++) number[a] = -1;
  PetscCall(PetscMalloc3(3 * mesh->n_nodes, &X, n_corners * mesh->n_tets, &tets, mesh->n_tets, &tag));
  PetscCall(PetscMalloc1(mesh->n_tets, &material));
  PetscCall(PetscMalloc1(mesh->n_tets, &place));
  for (PetscInt e = 0; e < mesh->n_tets; e++) {
    tag[e] = mesh->tag[order[e]], material[e] = mesh->material[order[e]], place[order[e]] = e;
    for (PetscInt a = 0; a < n_corners; a++) {
      const PetscInt old = mesh->tets[n_corners * order[e] + a];
      if (number[old] < 0) {
        for (PetscInt k = 0; k < 3; k++) X[3 * n + k] = mesh->X[3 * old + k];
        number[old] = n++;
      }
      tets[n_corners * e + a] = number[old];
    }
  }
  for (PetscInt k = 0; k < 3 * mesh->n_triangles; k++) mesh->triangles[k] = number[mesh->triangles[k]];
  for (PetscInt k = 0; k < mesh->n_face_nodes * mesh->n_faces; k++) mesh->faces[k] = number[mesh->faces[k]];
  for (PetscInt g = 0; g < mesh->n_groups; g++) {
    TLEDGroup *group = &mesh->groups[g];
    m                = 0;
    for (PetscInt i = 0; i < group->n_nodes; i++)
      if (number[group->nodes[i]] >= 0) group->nodes[m++] = number[group->nodes[i]];
    group->n_nodes = m;
    PetscCall(PetscSortInt(m, group->nodes));
    for (PetscInt i = 0; i < group->n_tets; i++) group->tets[i] = place[group->tets[i]];
    PetscCall(PetscSortInt(group->n_tets, group->tets));
  }
  PetscCall(PetscFree3(mesh->X, mesh->tets, mesh->tag));
  PetscCall(PetscFree(mesh->material));
  PetscCall(PetscFree(place));
  mesh->X = X, mesh->tets = tets, mesh->tag = tag, mesh->material = material, mesh->n_nodes = n;
  PetscCall(PetscFree3(order, key, number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Walk the elements in order and close a block when its part or its material ends or it is full. With `blocks` NULL's arrays (n_* only) it counts;
   the second walk fills. local_of[a] and block_of[a] are work of n_nodes. */
static void FillBlocks(const TLEDMesh *mesh, const PetscInt part[], int block_of[], int local_of[], TLEDBlocks *b, PetscBool fill)
{
  const int n_corners = (int)mesh->n_corners, n_max = n_corners == 4 ? TLED_BLOCK_TETS : TLED_BLOCK_TETS_T10;
  int       n_in_block = 0, n_nodes = 0, lane = 0;

  b->n_blocks = b->n_packs = b->n_slots = 0;
  for (PetscInt a = 0; a < mesh->n_nodes; a++) block_of[a] = -1;
  for (PetscInt e = 0; e < mesh->n_tets; e++) {
    if (e == 0 || part[e] != part[e - 1] || mesh->material[e] != mesh->material[e - 1] || n_in_block == n_max || n_nodes + n_corners > TLED_BLOCK_NODES) {
      if (fill) b->pack_offset[b->n_blocks] = b->n_packs, b->node_offset[b->n_blocks] = b->n_slots;
      b->n_blocks++;
      n_in_block = n_nodes = lane = 0;
    }
    if (lane == 0) {
      if (fill) b->material[b->n_packs] = (int)mesh->material[e];
      b->n_packs++;
    }
    n_in_block++;
    for (PetscInt k = 0; k < n_corners; k++) {
      const PetscInt a = mesh->tets[n_corners * e + k];
      if (block_of[a] != b->n_blocks) {
        block_of[a] = b->n_blocks, local_of[a] = n_nodes++;
        if (fill) b->node[b->n_slots] = (int)a, b->slot_material[b->n_slots] = (int)mesh->material[e];
        b->n_slots++;
      }
      if (fill) b->local[(n_corners * (b->n_packs - 1) + k) * TLED_LANES + lane] = local_of[a];
    }
    if (fill) b->element[(b->n_packs - 1) * TLED_LANES + lane] = (int)e;
    lane = (lane + 1) % TLED_LANES;
  }
  if (fill) b->pack_offset[b->n_blocks] = b->n_packs, b->node_offset[b->n_blocks] = b->n_slots;
}

/* coordinates of the nodes of element e */
static void ElementNodes(const TLEDMesh *mesh, int e, double x[])
{
  for (PetscInt a = 0; a < mesh->n_corners; a++)
    for (int k = 0; k < 3; k++) x[3 * a + k] = mesh->X[3 * mesh->tets[mesh->n_corners * e + a] + k];
}

/* whether the nodes of the edges lie in their middle, to round-off: the Jacobian is the same at all points */
static PetscBool IsStraight(const double x[30])
{
  for (int e = 0; e < 6; e++) {
    double off = 0.0, size = 0.0;
    int    v, w;
    TLEDEdgeT10(e, &v, &w);
    for (int k = 0; k < 3; k++) {
      off += fabs(2.0 * x[3 * (4 + e) + k] - x[3 * v + k] - x[3 * w + k]);
      size += fabs(x[3 * v + k] - x[3 * w + k]);
    }
    if (off > 1e-13 * size) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* how many Jacobians each pack stores: they are most of what the loops read */
static PetscErrorCode CountJacobians(const TLEDMesh *mesh, TLEDBlocks *b)
{
  double x[3 * TLED_CORNERS_MAX];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(b->n_packs + 1, &b->first_point));
  b->first_point[0] = 0;
  for (int pack = 0; pack < b->n_packs; pack++) {
    PetscBool straight = PETSC_TRUE;
    for (int l = TLED_LANES * pack; l < TLED_LANES * (pack + 1); l++) {
      if (b->element[l] < 0) continue;
      ElementNodes(mesh, b->element[l], x);
      if (b->n_corners == 10 && !IsStraight(x)) straight = PETSC_FALSE;
    }
    b->first_point[pack + 1] = b->first_point[pack] + (straight ? 1 : b->n_points);
  }
  PetscCall(PetscCalloc1(9 * TLED_LANES * b->first_point[b->n_packs], &b->G));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of each lane and integration point what the element needs: gradients of nodes 1 to 3 and volume, or Jinv and weight times Jacobian */
static void FillGeometry(const TLEDMesh *mesh, TLEDBlocks *b)
{
  for (int l = 0; l < b->n_packs * TLED_LANES; l++) {
    const int pack = l / TLED_LANES, lane = l % TLED_LANES, e = b->element[l];
    double    x[3 * TLED_CORNERS_MAX], G[9] = {0.0}, L[4];
    if (e < 0) continue;
    ElementNodes(mesh, e, x);
    for (int q = 0; q < b->n_points; q++) {
      const int    place = TLEDJacobianPlace(b, pack, q), n = b->n_corners;
      const double w     = n == 4 ? 1.0 : TLEDQuadratureT10(b->n_points, q, L);
      b->V0[(b->n_points * pack + q) * TLED_LANES + lane] = n == 4 ? TLEDReferenceGradients(x, G) : w * TLEDJacobianT10(L, x, G);
      for (int k = 0; k < 9; k++) b->G[(9 * place + k) * TLED_LANES + lane] = G[k];
    }
  }
}

/* slots of each node, ascending */
static PetscErrorCode FillSlots(TLEDBlocks *b)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(b->n_nodes + 1, &b->slot_offset));
  PetscCall(PetscMalloc1(b->n_slots, &b->slot));
  for (int s = 0; s < b->n_slots; s++) b->slot_offset[b->node[s] + 1]++;
  for (int a = 0; a < b->n_nodes; a++) b->slot_offset[a + 1] += b->slot_offset[a];
  for (int s = 0; s < b->n_slots; s++) b->slot[b->slot_offset[b->node[s]]++] = s;
  for (int a = b->n_nodes; a > 0; a--) b->slot_offset[a] = b->slot_offset[a - 1];
  b->slot_offset[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDBlocksCreate_Private - renumber the mesh for locality and cut it into blocks

  Input Parameter:
. n_points - integration points of an element

  Input/Output Parameter:
. mesh - nodes, elements, triangles and groups get new numbers; nodes of no element disappear

  Output Parameter:
. blocks - the elements in blocks and packs; the cut depends on the mesh alone, not on threads
*/
PetscErrorCode TLEDBlocksCreate_Private(TLEDMesh *mesh, int n_points, TLEDBlocks *b)
{
  PetscInt *part;
  int      *block_of, *local_of;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(b, sizeof *b));
  PetscCall(PetscMalloc1(mesh->n_tets, &part));
  PetscCall(CutElements(mesh, part));
  PetscCall(Renumber(mesh, part));
  PetscCall(PetscSortInt(mesh->n_tets, part)); /* elements now lie in the order of their parts */
  PetscCall(PetscMalloc2(mesh->n_nodes, &block_of, mesh->n_nodes, &local_of));
  b->n_nodes   = (int)mesh->n_nodes;
  b->n_corners = (int)mesh->n_corners;
  b->n_points  = n_points;
  FillBlocks(mesh, part, block_of, local_of, b, PETSC_FALSE);
  PetscCall(PetscMalloc4(b->n_blocks + 1, &b->pack_offset, b->n_blocks + 1, &b->node_offset, b->n_slots, &b->node, b->n_slots,
                         &b->slot_material));
  PetscCall(PetscCalloc3(b->n_corners * b->n_packs * TLED_LANES, &b->local, b->n_packs * TLED_LANES, &b->element,
                         n_points * b->n_packs * TLED_LANES, &b->V0));
  PetscCall(PetscMalloc1(b->n_packs, &b->material));
  for (int l = 0; l < b->n_packs * TLED_LANES; l++) b->element[l] = -1;
  FillBlocks(mesh, part, block_of, local_of, b, PETSC_TRUE);
  PetscCall(CountJacobians(mesh, b));
  FillGeometry(mesh, b);
  PetscCall(FillSlots(b));
  PetscCall(PetscFree2(block_of, local_of));
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDBlocksDestroy_Private(TLEDBlocks *b)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(b->pack_offset, b->node_offset, b->node, b->slot_material));
  PetscCall(PetscFree(b->material));
  PetscCall(PetscFree(b->fibre));
  PetscCall(PetscFree3(b->local, b->element, b->V0));
  PetscCall(PetscFree(b->G));
  PetscCall(PetscFree(b->first_point));
  PetscCall(PetscFree(b->slot_offset));
  PetscCall(PetscFree(b->slot));
  PetscCall(PetscMemzero(b, sizeof *b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
