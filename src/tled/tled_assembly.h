/* tled_assembly.h - the tangent stiffness as a PETSc matrix, row by row over the ranks of a communicator; only src/tled includes it.

   Each rank holds the whole body and a range of nodes; it works out the elements that touch them and fills the rows of these nodes. Values
   are kept as 3 x 3 blocks in the rows' block pattern until they are put into the matrix, so that constraints and loads act on blocks.

   The average nodal pressure element couples nodes three elements apart. Its tangent is assembled from matrices with the pattern of
   direct neighbours by sparse products:
     K = K_e + C^T B + B^T C + B^T M B = K_e + B^T D + D^T B,   D = C + 1/2 M B,
     B = dJ_a/du (n_nodes n_laws x 3 n_nodes: a node has an average for each material),  C_a = sum_e V0_e/4 d2w/dJbar dF : dF/du,  M_ab = sum_e V0_e/16 d2w/dJbar^2. */
#ifndef BY_TLED_ASSEMBLY_H
#define BY_TLED_ASSEMBLY_H

#include "tled/tled_impl.h"

typedef enum {
  TLED_TANGENT_EXACT,   /* df/du                                                                                      */
  TLED_TANGENT_RESPONSE /* for anp: each element's own part with a volumetric stiffness that does not lock, positive */
} TLEDTangentKind;

/* the 1 x 1 to 3 x 3 blocks of the rows of this rank's nodes */
typedef struct TLEDAssembly {
  MPI_Comm   comm;
  PetscInt   first, last; /* nodes of this rank: first <= a < last                                     */
  PetscInt  *row;         /* last - first + 1, into column                                             */
  PetscInt  *column;      /* nodes                                                                     */
  PetscInt  *slot;        /* n_tets x corners^2: place of each block, -1 when its row is another rank's */
  PetscReal *stiffness;   /* 9 a block [N/m]                                                           */
  PetscInt   n_laws;      /* materials                                                                  */
  PetscReal *ratio;       /* n_laws x 3 a block: dJ_a/du_b [1/m]     (anp, exact)                       */
  PetscReal *coupling;    /* n_laws x 3 a block: C [N/m^0]           (anp, exact)                       */
  PetscReal *pressure;    /* n_laws x n_laws a block: M [N m]        (anp, exact)                       */
  PetscBool  average;     /* the last values have the parts of the average nodal pressure element      */
  Mat        own, B, C, M, MB, S; /* K_e, B, C, M, D and B^T D of the last matrix or operator          */
  Vec        nodal;       /* a number a node: work of the operator                                     */
} TLEDAssembly;

PetscErrorCode TLEDAssemblyCreate_Private(MPI_Comm comm, TLED tled, TLEDAssembly **assembly);

/* stiffness at u, all other values zero */
PetscErrorCode TLEDAssemblyFill_Private(TLED tled, const PetscReal u[], TLEDTangentKind kind, TLEDAssembly *assembly);
/* all values times factor */
void TLEDAssemblyScale_Private(TLEDAssembly *assembly, PetscReal factor);
/* K_ab += factor block (3 x 3); nothing when row a is another rank's or b is no neighbour of a */
void TLEDAssemblyAdd_Private(TLEDAssembly *assembly, PetscInt a, PetscInt b, PetscReal factor, const PetscReal block[9]);
/* K_aa += factor m_a I */
void TLEDAssemblyAddMass_Private(TLED tled, PetscReal factor, TLEDAssembly *assembly);
/* sum of the diagonal numbers of this rank's rows (without the parts of the sparse products) */
PetscReal TLEDAssemblyTrace_Private(const TLEDAssembly *assembly);
/* P_a K_ab P_b + held (I - P_a): the constrained directions apart */
void TLEDAssemblyProject_Private(TLED tled, PetscReal held, TLEDAssembly *assembly);
/* the values as a matrix, created when *K is NULL, else the one of an earlier call of the same kind */
PetscErrorCode TLEDAssemblyMatrix_Private(TLEDAssembly *assembly, Mat *K);
/* the same, exact for anp, as an operator */
PetscErrorCode TLEDAssemblyOperator_Private(TLEDAssembly *assembly, Mat *A);

#endif
