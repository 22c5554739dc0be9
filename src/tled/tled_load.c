/* tled_load.c - forces on the body from outside. */
#include "tled/tled_impl.h"

/*
  TLEDExternalForces_Private - all forces on the nodes but the internal ones and the supports'

  Input Parameters:
+ tled - set up
. t    - time [s], of the courses
- u    - displacement [m], n_nodes x 3

  Output Parameter:
. f - m g and the Vec f [N], n_nodes x 3, not projected
*/
PetscErrorCode TLEDExternalForces_Private(TLED tled, PetscReal t, const PetscReal u[], PetscReal f[])
{
  const PetscReal *held;

  PetscFunctionBegin;
  (void)t, (void)u;
  PetscCall(VecGetArrayRead(tled->f, &held));
  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++) f[k] = held[k] + tled->mass[k / 3] * tled->gravity[k % 3];
  PetscCall(VecRestoreArrayRead(tled->f, &held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* stiffness blocks of what follows the surface: nothing does */
PetscErrorCode TLEDExternalTangent_Private(TLED tled, PetscReal t, const PetscReal u[], TLEDAddBlock add, void *ctx)
{
  PetscFunctionBegin;
  (void)tled, (void)t, (void)u, (void)add, (void)ctx;
  PetscFunctionReturn(PETSC_SUCCESS);
}
