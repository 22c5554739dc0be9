/* tled_tangent.c - internal force and tangent stiffness for others: the public face of tled_assembly.c on one process. */
#include "tled/tled_assembly.h"

/* matrix of one kind at u; the pattern is built once a kind */
static PetscErrorCode Tangent(TLED tled, Vec u, TLEDTangentKind kind, Mat *K)
{
  const PetscReal *array;
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before the tangent");
  PetscCall(PetscLogEventBegin(TLED_EVENT_TANGENT, tled, 0, 0, 0));
  if (!tled->assembly) PetscCall(TLEDAssemblyCreate_Private(PETSC_COMM_SELF, tled, &tled->assembly));
  PetscCall(VecGetArrayRead(u, &array));
  ierr = TLEDAssemblyFill_Private(tled, array, kind, tled->assembly);
  if (ierr == BY_ERR_BREAKDOWN) ierr = TLEDReportBroken_Private(tled, array, tled->state.time);
  PetscCall(VecRestoreArrayRead(u, &array));
  ByCall(ierr);
  PetscCall(TLEDAssemblyMatrix_Private(tled->assembly, K));
  PetscCall(PetscLogEventEnd(TLED_EVENT_TANGENT, tled, 0, 0, 0));
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
. K - AIJ, block size 3 [N/m], symmetric; rows of constrained nodes are kept like all others

  Exact for every element. That of the average nodal pressure element couples nodes three elements apart: on a mesh of tetrahedra some
900 numbers a row against 45 (tled_assembly.h).

  Errors: BY_ERR_BREAKDOWN when an element is inverted at u

  Cost: one pass over the elements, for anp two sparse products; no new pattern after the first call.
  Tests: tests/unit/tled/test_force.c, test_static.c

.seealso: TLEDInternalForce(), TLEDResponse()
@*/
PetscErrorCode TLEDTangent(TLED tled, Vec u, Mat *K)
{
  PetscFunctionBegin;
  ByCall(Tangent(tled, u, TLED_TANGENT_EXACT, K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDResponse - a stiffness by which the body answers loads, with the pattern of direct neighbours

  Collective

  Parameters: as TLEDTangent()

  The exact tangent for every element but `anp`. For it each element's own part is assembled at the averaged gradient Fbar, with lambda' =
min(lambda, 2 mu) in place of lambda in its volumetric part, which would lock (measured in bending: 0.87 to 1.19 of the true
compliance for nu 0.41 to 0.49 on three meshes, against 0.45 to 0.87 with lambda): cheap to factor, but not the derivative that
Newton's method needs.

  Tests: tests/unit/tled/test_force.c, tests/convergence/test_tled_reference.c

.seealso: TLEDTangent()
@*/
PetscErrorCode TLEDResponse(TLED tled, Vec u, Mat *K)
{
  PetscFunctionBegin;
  ByCall(Tangent(tled, u, TLED_TANGENT_RESPONSE, K));
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
