/* tled_tangent.c - the tangent stiffness as a PETSc matrix: pattern once, values by blocks of the elements. */
#include "tled/tled_impl.h"
#include "tled/tled_element.h"

#define BULK 2.0 /* lambda' over mu at most in the tangent of the average nodal pressure element, that of Poisson's ratio 1/3 */

/* column numbers of a node's neighbours: the element corners around it, sorted, each once */
static PetscErrorCode BuildPattern(TLED tled)
{
  const PetscInt n = tled->mesh.n_nodes, n_tets = tled->mesh.n_tets, *tets = tled->mesh.tets;
  PetscInt      *offset, *around, *list, n_max = 0, n_list, n_blocks = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(n + 1, &offset));
  PetscCall(PetscMalloc1(4 * n_tets, &around));
  for (PetscInt k = 0; k < 4 * n_tets; k++) offset[tets[k] + 1]++;
  for (PetscInt a = 0; a < n; a++) n_max = PetscMax(n_max, offset[a + 1]), offset[a + 1] += offset[a];
  for (PetscInt e = 0; e < n_tets; e++)
    for (PetscInt a = 0; a < 4; a++) around[offset[tets[4 * e + a]]++] = e;
  for (PetscInt a = n; a > 0; a--) offset[a] = offset[a - 1];
  offset[0] = 0;
  PetscCall(PetscMalloc1(4 * n_max + 1, &list));
  PetscCall(PetscMalloc1(n + 1, &tled->tangent_row));
  PetscCall(PetscMalloc1(16 * n_tets, &tled->tangent_column)); /* more than enough; the pattern has about a third of it */
  PetscCall(PetscMalloc1(16 * n_tets, &tled->tangent_slot));
  tled->tangent_row[0] = 0;
  for (PetscInt a = 0; a < n; a++) {
    n_list = 0;
    for (PetscInt k = offset[a]; k < offset[a + 1]; k++)
      for (PetscInt c = 0; c < 4; c++) list[n_list++] = tets[4 * around[k] + c];
    PetscCall(PetscSortRemoveDupsInt(&n_list, list));
    for (PetscInt k = 0; k < n_list; k++) tled->tangent_column[n_blocks++] = list[k];
    tled->tangent_row[a + 1] = n_blocks;
  }
  for (PetscInt e = 0; e < n_tets; e++) {
    for (PetscInt a = 0; a < 4; a++) {
      const PetscInt row = tets[4 * e + a], first = tled->tangent_row[row];
      for (PetscInt c = 0; c < 4; c++) {
        PetscInt place;
        PetscCall(PetscFindInt(tets[4 * e + c], tled->tangent_row[row + 1] - first, &tled->tangent_column[first], &place));
        tled->tangent_slot[16 * e + 4 * a + c] = first + place;
      }
    }
  }
  PetscCall(PetscMalloc1(9 * n_blocks, &tled->tangent_value));
  PetscCall(PetscFree(offset));
  PetscCall(PetscFree(around));
  PetscCall(PetscFree(list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* an AIJ matrix of block size 3 with the pattern, all values zero */
static PetscErrorCode CreateMatrix(TLED tled, Mat *K)
{
  const PetscInt n = tled->mesh.n_nodes;
  PetscInt      *nnz;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * n, &nnz));
  for (PetscInt a = 0; a < n; a++)
    for (PetscInt i = 0; i < 3; i++) nnz[3 * a + i] = 3 * (tled->tangent_row[a + 1] - tled->tangent_row[a]);
  PetscCall(MatCreate(PETSC_COMM_SELF, K));
  PetscCall(MatSetSizes(*K, 3 * n, 3 * n, 3 * n, 3 * n));
  PetscCall(MatSetBlockSize(*K, 3));
  PetscCall(MatSetType(*K, MATSEQAIJ));
  PetscCall(MatSeqAIJSetPreallocation(*K, 0, nnz));
  PetscCall(PetscFree(nnz));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The modified gradient that the element's law sees: H itself, or Hbar of the average nodal pressure. */
static void SeenGradient(const TLEDLoops *w, const double H[9], const PetscInt corner[4], double seen[9])
{
  double jbar = 0.0;

  if (!w->anp) {
    for (int k = 0; k < 9; k++) seen[k] = H[k];
    return;
  }
  for (int a = 0; a < 4; a++) jbar += 0.25 * w->nodal[corner[a]];
  (void)TLEDAverageGradient(H, 1.0 / (1.0 + TLEDJacobianMinusOne(H)), 1.0 + jbar, seen);
}

/* block values, element after element in a fixed order */
static void FillValues(TLED tled, const PetscReal u[])
{
  const TLEDBlocks *b            = &tled->blocks;
  const TLEDLoops  *w            = &tled->loops;
  PetscReal        *value        = tled->tangent_value;
  const double      lambda_prime = w->anp && w->lambda > BULK * w->mu ? BULK * w->mu : w->lambda;

  for (PetscInt k = 0; k < 9 * tled->tangent_row[tled->mesh.n_nodes]; k++) value[k] = 0.0;
  for (int l = 0; l < TLED_LANES * b->n_packs; l++) {
    const int       pack = l / TLED_LANES, lane = l % TLED_LANES, e = b->element[l];
    const PetscInt *corner = &tled->mesh.tets[4 * e], *slot = &tled->tangent_slot[16 * e];
    double          d[9], G[9], H[9], seen[9], K[144];
    if (e < 0) continue;
    for (int k = 0; k < 9; k++) G[k] = b->G[(9 * pack + k) * TLED_LANES + lane];
    for (int a = 0; a < 3; a++) Sub3(&u[3 * corner[a + 1]], &u[3 * corner[0]], &d[3 * a]);
    TLEDDisplacementGradient(d, G, H);
    SeenGradient(w, H, corner, seen);
    TLEDStiffness(w->law, seen, G, b->V0[l], w->mu, w->lambda, lambda_prime, K);
    for (int a = 0; a < 4; a++)
      for (int c = 0; c < 4; c++)
        for (int i = 0; i < 3; i++)
          for (int k = 0; k < 3; k++) value[9 * slot[4 * a + c] + 3 * i + k] += K[12 * (3 * a + i) + 3 * c + k];
  }
}

/* put the blocks into the rows of the matrix */
static PetscErrorCode SetRows(TLED tled, Mat K)
{
  const PetscInt *row   = tled->tangent_row;
  PetscInt        n_max = 0, *column;
  PetscReal      *line;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) n_max = PetscMax(n_max, row[a + 1] - row[a]);
  PetscCall(PetscMalloc2(3 * n_max, &column, 9 * n_max, &line));
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) {
    const PetscInt n = row[a + 1] - row[a], rows[3] = {3 * a, 3 * a + 1, 3 * a + 2};
    for (PetscInt k = 0; k < n; k++)
      for (PetscInt i = 0; i < 3; i++) {
        column[3 * k + i] = 3 * tled->tangent_column[row[a] + k] + i;
        for (PetscInt j = 0; j < 3; j++) line[3 * n * i + 3 * k + j] = tled->tangent_value[9 * (row[a] + k) + 3 * i + j];
      }
    PetscCall(MatSetValues(K, 3, rows, 3 * n, column, line, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(K, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree2(column, line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDTangent - tangent stiffness K(u) = df_int/du

  Collective

  Input Parameters:
+ tled - the body, set up
. u    - displacement [m], n_nodes x 3
- K    - NULL matrix: created here and owned by the caller; else the matrix of an earlier call, whose values are replaced

  Output Parameter:
. K - AIJ, block size 3 [N/m]; rows of constrained nodes are kept like all others

  Exact for the element t4. For `anp` the exact tangent couples nodes two elements apart. Here each element's own part is assembled
at the averaged gradient Fbar, with lambda' = min(lambda, 2 mu) in place of lambda in its volumetric part, which would lock: a
response to loads (measured in bending: 0.87 to 1.19 of the true compliance for nu 0.41 to 0.49 on three meshes, against 0.45 to
0.87 with lambda), not the derivative that Newton's method needs.

  Cost: one pass over the elements, no new pattern after the first call.  Tests: tests/unit/tled/test_static.c, test_force.c,
  tests/convergence/test_tled_reference.c

.seealso: TLEDInternalForce()
@*/
PetscErrorCode TLEDTangent(TLED tled, Vec u, Mat *K)
{
  const PetscReal *array;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDTangent()");
  PetscCall(PetscLogEventBegin(TLED_EVENT_TANGENT, tled, 0, 0, 0));
  if (!tled->tangent_row) PetscCall(BuildPattern(tled));
  if (!*K) PetscCall(CreateMatrix(tled, K));
  PetscCall(VecGetArrayRead(u, &array));
  if (tled->loops.anp) {
#pragma omp parallel num_threads(TLEDThreads_OpenMP(&tled->loops))
    TLEDNodalVolumes_OpenMP(&tled->loops, array);
  }
  FillValues(tled, array);
  PetscCall(VecRestoreArrayRead(u, &array));
  PetscCall(SetRows(tled, *K));
  PetscCall(PetscLogEventEnd(TLED_EVENT_TANGENT, tled, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDInternalForce - internal force f(u) = dW/du

  Collective

  Input Parameters:
+ tled - the body, set up
- u    - displacement [m], n_nodes x 3

  Output Parameter:
. f - internal force [N], n_nodes x 3

  Errors: BY_ERR_BREAKDOWN when an element is inverted at u

.seealso: TLEDTangent()
@*/
PetscErrorCode TLEDInternalForce(TLED tled, Vec u, Vec f)
{
  const PetscReal *array;
  PetscReal       *force;
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDInternalForce()");
  PetscCall(VecGetArrayRead(u, &array));
  PetscCall(VecGetArray(f, &force));
  ierr = TLEDForces_Private(tled, array, force);
  if (ierr == BY_ERR_BREAKDOWN) ierr = TLEDReportBroken_Private(tled, array, tled->state.time);
  PetscCall(VecRestoreArray(f, &force));
  PetscCall(VecRestoreArrayRead(u, &array));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
