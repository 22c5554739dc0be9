/* tled_assembly.c - the tangent stiffness over the ranks of a communicator: block pattern once, values element by element, matrices. */
#include "tled/tled_assembly.h"
#include "tled/tled_average.h"

/* elements around each node of the mesh: around[offset[a]..offset[a + 1]-1] */
static PetscErrorCode ElementsAround(TLED tled, PetscInt **offset, PetscInt **around, PetscInt *n_max)
{
  const PetscInt n = tled->mesh.n_nodes, n_tets = tled->mesh.n_tets, *tets = tled->mesh.tets, nc = tled->mesh.n_corners;
  PetscInt      *o, *e;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(n + 1, &o));
  PetscCall(PetscMalloc1(nc * n_tets, &e));
  for (PetscInt k = 0; k < nc * n_tets; k++) o[tets[k] + 1]++;
  *n_max = 0;
  for (PetscInt a = 0; a < n; a++) *n_max = PetscMax(*n_max, o[a + 1]), o[a + 1] += o[a];
  for (PetscInt k = 0; k < nc * n_tets; k++) e[o[tets[k]]++] = k / nc;
  for (PetscInt a = n; a > 0; a--) o[a] = o[a - 1];
  o[0]    = 0;
  *offset = o, *around = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the rows' columns: nodes of the elements around, sorted, each once */
static PetscErrorCode BuildRows(TLED tled, TLEDAssembly *s)
{
  const PetscInt *tets = tled->mesh.tets, nc = tled->mesh.n_corners;
  PetscInt       *offset, *around, *list, n_max = 0, n_list, n_blocks = 0, room;

  PetscFunctionBegin;
  PetscCall(ElementsAround(tled, &offset, &around, &n_max));
  PetscCall(PetscMalloc1(nc * n_max + 1, &list));
  PetscCall(PetscMalloc1(s->last - s->first + 1, &s->row));
  room = nc * (offset[s->last] - offset[s->first]); /* more than enough */
  PetscCall(PetscMalloc1(room, &s->column));
  s->row[0] = 0;
  for (PetscInt a = s->first; a < s->last; a++) {
    n_list = 0;
    for (PetscInt k = offset[a]; k < offset[a + 1]; k++)
      for (PetscInt c = 0; c < nc; c++) list[n_list++] = tets[nc * around[k] + c];
    PetscCall(PetscSortRemoveDupsInt(&n_list, list));
    for (PetscInt k = 0; k < n_list; k++) s->column[n_blocks++] = list[k];
    s->row[a + 1 - s->first] = n_blocks;
  }
  PetscCall(PetscFree(offset));
  PetscCall(PetscFree(around));
  PetscCall(PetscFree(list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* place of block (a, b), -1 when it is not in this rank's rows */
static PetscInt Place(const TLEDAssembly *s, PetscInt a, PetscInt b)
{
  PetscInt lo, hi;

  if (a < s->first || a >= s->last) return -1;
  lo = s->row[a - s->first], hi = s->row[a - s->first + 1];
  while (hi - lo > 1) {
    const PetscInt middle = (lo + hi) / 2;
    if (s->column[middle] <= b) lo = middle;
    else hi = middle;
  }
  return s->column[lo] == b ? lo : -1;
}

/*
  TLEDAssemblyCreate_Private - the pattern of a body's tangent over the ranks of a communicator

  Collective

  Input Parameters:
+ comm - ranks that share the rows; each has the same body
- tled - set up

  Output Parameter:
. assembly - the nodes are dealt out in runs of equal length (they are numbered for locality)
*/
PetscErrorCode TLEDAssemblyCreate_Private(MPI_Comm comm, TLED tled, TLEDAssembly **assembly)
{
  const PetscInt *tets = tled->mesh.tets, nc = tled->mesh.n_corners;
  TLEDAssembly   *s;
  PetscInt        n_own = PETSC_DECIDE, n = tled->mesh.n_nodes, last, n_blocks;

  PetscFunctionBegin;
  PetscCall(PetscNew(&s));
  s->comm = comm;
  PetscCall(PetscSplitOwnership(comm, &n_own, &n));
  PetscCallMPI(MPI_Scan(&n_own, &last, 1, MPIU_INT, MPI_SUM, comm));
  s->first = last - n_own, s->last = last;
  PetscCall(BuildRows(tled, s));
  PetscCall(PetscMalloc1(nc * nc * tled->mesh.n_tets, &s->slot));
  for (PetscInt e = 0; e < tled->mesh.n_tets; e++)
    for (PetscInt k = 0; k < nc * nc; k++) s->slot[nc * nc * e + k] = Place(s, tets[nc * e + k / nc], tets[nc * e + k % nc]);
  n_blocks = s->row[n_own];
  PetscCall(PetscMalloc1(9 * n_blocks, &s->stiffness));
  s->n_laws = tled->loops.n_laws;
  if (tled->loops.anp)
    PetscCall(PetscMalloc3(3 * s->n_laws * n_blocks, &s->ratio, 3 * s->n_laws * n_blocks, &s->coupling, s->n_laws * s->n_laws * n_blocks,
                           &s->pressure));
  *assembly = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDAssemblyDestroy_Private(TLEDAssembly **assembly)
{
  TLEDAssembly *s = *assembly;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(s->row));
  PetscCall(PetscFree(s->column));
  PetscCall(PetscFree(s->slot));
  PetscCall(PetscFree(s->stiffness));
  PetscCall(PetscFree3(s->ratio, s->coupling, s->pressure));
  PetscCall(MatDestroy(&s->own));
  PetscCall(MatDestroy(&s->B));
  PetscCall(MatDestroy(&s->C));
  PetscCall(MatDestroy(&s->M));
  PetscCall(MatDestroy(&s->MB));
  PetscCall(MatDestroy(&s->S));
  PetscCall(VecDestroy(&s->nodal));
  PetscCall(PetscFree(*assembly));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* does an element have a row of this rank? */
static PetscBool Touches(const TLEDAssembly *s, PetscInt n_corners, const PetscInt corner[])
{
  for (PetscInt a = 0; a < n_corners; a++)
    if (corner[a] >= s->first && corner[a] < s->last) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* add a matrix of 3 n_corners x 3 n_corners numbers to the element's blocks */
static void AddElement(TLEDAssembly *s, PetscInt nc, const PetscInt slot[], const double K[])
{
  for (PetscInt a = 0; a < nc; a++)
    for (PetscInt b = 0; b < nc; b++) {
      PetscReal *value = &s->stiffness[9 * slot[nc * a + b]];
      if (slot[nc * a + b] < 0) continue;
      for (PetscInt i = 0; i < 3; i++)
        for (PetscInt k = 0; k < 3; k++) value[3 * i + k] += K[3 * nc * (3 * a + i) + 3 * b + k];
    }
}

/* K_ab = V0 G_a . A . G_b of a material tangent A = dP/dF (9 x 9, row-major) */
static void ContractTangent(const double A[81], const double G4[12], double V0, double K[144])
{
  double AG[9][12]; /* dP/du_b,k = sum_l A_ij,kl G_b,l */

  for (int ij = 0; ij < 9; ij++)
    for (int b = 0; b < 4; b++)
      for (int k = 0; k < 3; k++) AG[ij][3 * b + k] = V0 * Dot3(&A[9 * ij + 3 * k], &G4[3 * b]);
  for (int a = 0; a < 4; a++)
    for (int i = 0; i < 3; i++)
      for (int c = 0; c < 12; c++)
        K[12 * (3 * a + i) + c] = AG[3 * i][c] * G4[3 * a] + AG[3 * i + 1][c] * G4[3 * a + 1] + AG[3 * i + 2][c] * G4[3 * a + 2];
}

/* one average nodal pressure element: its own part with the pressure that its nodes give it, and its parts of B, C and M */
static void AddAverage(TLED tled, int l, const PetscReal u[], TLEDAssembly *s)
{
  const TLEDLoops *w      = &tled->loops;
  const int        m      = w->blocks->material[l / TLED_LANES];
  const PetscInt   e      = w->blocks->element[l];
  const PetscInt  *corner = &tled->mesh.tets[4 * e], *slot = &s->slot[16 * e];
  double           F[9], cof[9], A[81], K[144], dpbar[9], dP[9], dC[9], jbar = 0.0, p = 0.0;
  TLEDPoint        at_u;

  TLEDPointAt_Private(w, tled->mesh.tets, l, 0, u, &at_u);
  const double V0 = at_u.V0, *G4 = at_u.G, *H = at_u.H;
  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, cof);
  for (int a = 0; a < 4; a++) jbar += 0.25 * w->nodal[TLEDAverageOf(w, corner[a], m)], p += w->pressure[TLEDAverageOf(w, corner[a], m)];
  for (int k = 0; k < 9; k++) {
    double dF[9] = {0.0};
    dF[k]    = 1.0;
    dpbar[k] = TLEDAverageDifferential(&at_u.law, H, 1.0 + jbar, dF, 0.0, dP);
    TLEDCofactorDifferential(F, dF, dC);
    for (int i = 0; i < 9; i++) A[9 * i + k] = dP[i] + p * dC[i];
  }
  ContractTangent(A, G4, V0, K);
  AddElement(s, 4, slot, K);
  const double zero[9] = {0.0}, d2 = TLEDAverageDifferential(&at_u.law, H, 1.0 + jbar, zero, 1.0, dP);
  for (int a = 0; a < 4; a++) {
    for (int b = 0; b < 4; b++) {
      const PetscInt at = slot[4 * a + b];
      if (at < 0) continue;
      s->pressure[s->n_laws * (s->n_laws * at + m) + m] += V0 * d2 / 16.0;
      for (int k = 0; k < 3; k++) {
        s->ratio[3 * (s->n_laws * at + m) + k] += w->weight[TLEDAverageOf(w, corner[a], m)] * V0 * Dot3(&cof[3 * k], &G4[3 * b]);
        s->coupling[3 * (s->n_laws * at + m) + k] += 0.25 * V0 * Dot3(&dpbar[3 * k], &G4[3 * b]);
      }
    }
  }
}

/* one plain element, or the response of an average nodal pressure element */
static void AddPlain(TLED tled, int l, const PetscReal u[], TLEDAssembly *s)
{
  const TLEDBlocks *b  = &tled->blocks;
  const int         nc = b->n_corners;
  double            K[900] = {0.0};
  TLEDPoint         p;

  for (int point = 0; point < b->n_points; point++) {
    TLEDPointAt_Private(&tled->loops, tled->mesh.tets, l, point, u, &p);
    TLEDElementStiffness(&p.law, p.seen, p.G, nc, p.V0, K);
    if (tled->loops.anp) TLEDElementSoften(p.law.law, p.seen, p.G, nc, p.V0, K);
  }
  AddElement(s, nc, &s->slot[nc * nc * b->element[l]], K);
}

/*
  TLEDAssemblyFill_Private - the tangent at displacement u into this rank's blocks

  Errors: BY_ERR_BREAKDOWN, not reported, when an element of u is inverted
*/
PetscErrorCode TLEDAssemblyFill_Private(TLED tled, const PetscReal u[], TLEDTangentKind kind, TLEDAssembly *s)
{
  const TLEDBlocks *b        = &tled->blocks;
  const PetscInt    n_blocks = s->row[s->last - s->first], nc = tled->mesh.n_corners;

  PetscFunctionBegin;
  s->average = tled->loops.anp && kind == TLED_TANGENT_EXACT;
  if (s->average) ByCall(TLEDForces_Private(tled, u, tled->trial)); /* leaves J_a - 1 and q_a in the loops' nodal values */
  else TLEDKnowVolumes_Private(&tled->loops, u);
  PetscCall(PetscArrayzero(s->stiffness, 9 * n_blocks));
  if (s->average) {
    PetscCall(PetscArrayzero(s->ratio, 3 * s->n_laws * n_blocks));
    PetscCall(PetscArrayzero(s->coupling, 3 * s->n_laws * n_blocks));
    PetscCall(PetscArrayzero(s->pressure, s->n_laws * s->n_laws * n_blocks));
  }
  for (int l = 0; l < TLED_LANES * b->n_packs; l++) {
    if (b->element[l] < 0 || !Touches(s, nc, &tled->mesh.tets[nc * b->element[l]])) continue;
    if (s->average) AddAverage(tled, l, u, s);
    else AddPlain(tled, l, u, s);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TLEDAssemblyScale_Private(TLEDAssembly *s, PetscReal factor)
{
  const PetscInt n_blocks = s->row[s->last - s->first];

  for (PetscInt k = 0; k < 9 * n_blocks; k++) s->stiffness[k] *= factor;
  for (PetscInt k = 0; k < 3 * s->n_laws * n_blocks && s->average; k++) s->coupling[k] *= factor;
  for (PetscInt k = 0; k < s->n_laws * s->n_laws * n_blocks && s->average; k++) s->pressure[k] *= factor;
}

void TLEDAssemblyAdd_Private(TLEDAssembly *s, PetscInt a, PetscInt b, PetscReal factor, const PetscReal block[9])
{
  const PetscInt at = Place(s, a, b);

  for (PetscInt k = 0; k < 9 && at >= 0; k++) s->stiffness[9 * at + k] += factor * block[k];
}

void TLEDAssemblyAddMass_Private(TLED tled, PetscReal factor, TLEDAssembly *s)
{
  for (PetscInt a = s->first; a < s->last; a++) {
    PetscReal *value = &s->stiffness[9 * Place(s, a, a)];
    for (PetscInt i = 0; i < 3; i++) value[4 * i] += factor * tled->mass[a];
  }
}

PetscReal TLEDAssemblyTrace_Private(const TLEDAssembly *s)
{
  PetscReal sum = 0.0;

  for (PetscInt a = s->first; a < s->last; a++)
    for (PetscInt i = 0; i < 3; i++) sum += s->stiffness[9 * Place(s, a, a) + 4 * i];
  return sum;
}

/* value <- P value, or value P with `right`; value has `rows` rows of three */
static void TimesProjector(const PetscReal P[9], PetscInt rows, PetscBool right, PetscReal value[])
{
  PetscReal old[9];

  for (PetscInt k = 0; k < 3 * rows; k++) old[k] = value[k];
  for (PetscInt i = 0; i < rows; i++)
    for (PetscInt k = 0; k < 3; k++) {
      PetscReal sum = 0.0;
      for (PetscInt j = 0; j < 3; j++) sum += right ? old[3 * i + j] * P[3 * j + k] : P[3 * i + j] * old[3 * j + k];
      value[3 * i + k] = sum;
    }
}

void TLEDAssemblyProject_Private(TLED tled, PetscReal held, TLEDAssembly *s)
{
  for (PetscInt a = s->first; a < s->last; a++) {
    const PetscReal *P_a = TLEDConstraintProjector_Private(tled, a);
    for (PetscInt k = s->row[a - s->first]; k < s->row[a - s->first + 1]; k++) {
      const PetscReal *P_b = TLEDConstraintProjector_Private(tled, s->column[k]);
      if (P_b) TimesProjector(P_b, 3, PETSC_TRUE, &s->stiffness[9 * k]);
      for (PetscInt m = s->n_laws * k; m < s->n_laws * (k + 1) && P_b && s->average; m++) {
        TimesProjector(P_b, 1, PETSC_TRUE, &s->ratio[3 * m]);
        TimesProjector(P_b, 1, PETSC_TRUE, &s->coupling[3 * m]);
      }
      if (P_a) TimesProjector(P_a, 3, PETSC_FALSE, &s->stiffness[9 * k]);
      for (PetscInt i = 0; i < 9 && P_a && s->column[k] == a; i++) s->stiffness[9 * k + i] += held * ((i % 4 ? 0.0 : 1.0) - P_a[i]);
    }
  }
}

/* an empty AIJ matrix of the pattern with blocks of n_i x n_k numbers */
static PetscErrorCode CreateMatrix(const TLEDAssembly *s, PetscInt n_i, PetscInt n_k, Mat *A)
{
  const PetscInt n_own = s->last - s->first;
  PetscInt      *inner, *outer;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(n_i * n_own, &inner, n_i * n_own, &outer));
  for (PetscInt a = 0; a < n_own; a++) {
    PetscInt n_inner = 0;
    for (PetscInt k = s->row[a]; k < s->row[a + 1]; k++) n_inner += s->column[k] >= s->first && s->column[k] < s->last;
    for (PetscInt i = 0; i < n_i; i++) inner[n_i * a + i] = n_k * n_inner, outer[n_i * a + i] = n_k * (s->row[a + 1] - s->row[a] - n_inner);
  }
  PetscCall(MatCreate(s->comm, A));
  PetscCall(MatSetSizes(*A, n_i * n_own, n_k * n_own, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSizes(*A, n_i, n_k));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(MatSeqAIJSetPreallocation(*A, 0, inner));
  PetscCall(MatMPIAIJSetPreallocation(*A, 0, inner, 0, outer));
  PetscCall(PetscFree2(inner, outer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* put blocks of n_i x n_k numbers into the rows of *A, created when it is NULL */
static PetscErrorCode SetRows(const TLEDAssembly *s, PetscInt n_i, PetscInt n_k, const PetscReal value[], Mat *A)
{
  PetscInt   n_max = 0, *column, *rows;
  PetscReal *line;

  PetscFunctionBegin;
  if (!*A) PetscCall(CreateMatrix(s, n_i, n_k, A));
  for (PetscInt a = 0; a < s->last - s->first; a++) n_max = PetscMax(n_max, s->row[a + 1] - s->row[a]);
  PetscCall(PetscMalloc3(n_k * n_max, &column, n_i * n_k * n_max, &line, n_i, &rows));
  for (PetscInt a = 0; a < s->last - s->first; a++) {
    const PetscInt first = s->row[a], n = s->row[a + 1] - first;
    for (PetscInt i = 0; i < n_i; i++) {
      rows[i] = n_i * (s->first + a) + i;
      for (PetscInt k = 0; k < n; k++)
        for (PetscInt j = 0; j < n_k; j++) {
          column[n_k * k + j]         = n_k * s->column[first + k] + j;
          line[n_k * (n * i + k) + j] = value[n_k * (n_i * (first + k) + i) + j];
        }
    }
    PetscCall(MatSetValues(*A, n_i, rows, n_k * n, column, line, INSERT_VALUES));
  }
  PetscCall(PetscFree3(column, line, rows));
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the matrices K_e, B and D of the average nodal pressure element: in own, B and MB */
static PetscErrorCode FormFactors(TLEDAssembly *s)
{
  const MatReuse again = s->MB ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX;

  PetscFunctionBegin;
  PetscCall(SetRows(s, 3, 3, s->stiffness, &s->own));
  PetscCall(SetRows(s, s->n_laws, 3, s->ratio, &s->B));
  PetscCall(SetRows(s, s->n_laws, 3, s->coupling, &s->C));
  PetscCall(SetRows(s, s->n_laws, s->n_laws, s->pressure, &s->M));
  PetscCall(MatMatMult(s->M, s->B, again, PETSC_DEFAULT, &s->MB));
  PetscCall(MatScale(s->MB, 0.5));
  PetscCall(MatAXPY(s->MB, 1.0, s->C, SUBSET_NONZERO_PATTERN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDAssemblyMatrix_Private - the blocks as a matrix

  Input/Output Parameter:
. K - NULL: created, owned by the caller; else the matrix of an earlier call, whose values are replaced

  Cost: for the exact tangent of the average nodal pressure element two sparse products, whose patterns are worked out once
*/
PetscErrorCode TLEDAssemblyMatrix_Private(TLEDAssembly *s, Mat *K)
{
  PetscFunctionBegin;
  if (!s->average) {
    PetscCall(SetRows(s, 3, 3, s->stiffness, K));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(FormFactors(s));
  PetscCall(MatTransposeMatMult(s->B, s->MB, s->S ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, PETSC_DEFAULT, &s->S));
  PetscCall(MatTranspose(s->S, *K ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, K));
  PetscCall(MatAXPY(*K, 1.0, s->S, SAME_NONZERO_PATTERN));
  PetscCall(MatAXPY(*K, 1.0, s->own, SUBSET_NONZERO_PATTERN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = K_e x + B^T D x + D^T B x */
static PetscErrorCode MultOperator(Mat A, Vec x, Vec y)
{
  TLEDAssembly *s;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(MatMult(s->own, x, y));
  PetscCall(MatMult(s->MB, x, s->nodal));
  PetscCall(MatMultTransposeAdd(s->B, s->nodal, y, y));
  PetscCall(MatMult(s->B, x, s->nodal));
  PetscCall(MatMultTransposeAdd(s->MB, s->nodal, y, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDAssemblyOperator_Private - the blocks of the average nodal pressure element as an operator that is applied factor by factor:
  a tenth of the matrix's numbers, for iterative solvers

  Input/Output Parameter:
. A - as K of TLEDAssemblyMatrix_Private(); not longer than the assembly lives
*/
PetscErrorCode TLEDAssemblyOperator_Private(TLEDAssembly *s, Mat *A)
{
  const PetscInt n = 3 * (s->last - s->first);

  PetscFunctionBegin;
  PetscCall(FormFactors(s));
  if (!s->nodal) PetscCall(MatCreateVecs(s->M, &s->nodal, NULL));
  if (!*A) {
    PetscCall(MatCreateShell(s->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, s, A));
    PetscCall(MatSetBlockSize(*A, 3));
    PetscCall(MatShellSetOperation(*A, MATOP_MULT, (void (*)(void))MultOperator));
  }
  PetscCall(PetscObjectStateIncrease((PetscObject)*A));
  PetscFunctionReturn(PETSC_SUCCESS);
}
