/* tled_state.c - what a body lends and tells: mesh, vectors, positions, statistics; snapshots and checkpoints. */
#include "tled/tled_impl.h"
#include "mat3.h"

/*@ TLEDGetSize - numbers of nodes and tetrahedra @*/
PetscErrorCode TLEDGetSize(TLED tled, PetscInt *n_nodes, PetscInt *n_tets)
{
  PetscFunctionBegin;
  if (n_nodes) *n_nodes = tled->mesh.n_nodes;
  if (n_tets) *n_tets = tled->mesh.n_tets;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetMesh - tetrahedra, n_tets x n_corners (4 or 10) node numbers in VTK's order, and reference coordinates [m], n_nodes x 3;
   borrowed, each may be NULL @*/
PetscErrorCode TLEDGetMesh(TLED tled, PetscInt *n_corners, const PetscInt *tets[], const PetscReal *X[])
{
  PetscFunctionBegin;
  if (n_corners) *n_corners = tled->mesh.n_corners;
  if (tets) *tets = tled->mesh.tets;
  if (X) *X = tled->mesh.X;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetSurface - boundary triangles, n x 3 node numbers, outward; with wetted_only those of the groups in `wetted`; borrowed @*/
PetscErrorCode TLEDGetSurface(TLED tled, PetscBool wetted_only, PetscInt *n_triangles, const PetscInt *triangles[])
{
  PetscFunctionBegin;
  if (n_triangles) *n_triangles = wetted_only ? tled->n_wetted : tled->mesh.n_triangles;
  if (triangles) *triangles = wetted_only ? tled->wetted : tled->mesh.triangles;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetGroup - nodes of a physical group, ascending, borrowed; n = 0 when the mesh does not have it @*/
PetscErrorCode TLEDGetGroup(TLED tled, const char name[], PetscInt *n, const PetscInt *nodes[])
{
  const TLEDGroup *group;

  PetscFunctionBegin;
  PetscCall(TLEDMeshFindGroup_Private(&tled->mesh, name, &group));
  *n = group ? group->n_nodes : 0;
  if (nodes) *nodes = group ? group->nodes : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetElementName - t4, anp or t10: what the body's elements are, also where the parameters say auto; borrowed @*/
PetscErrorCode TLEDGetElementName(TLED tled, const char *name[])
{
  PetscFunctionBegin;
  *name = tled->loops.ops->name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetMass - lumped nodal masses [kg], n_nodes, borrowed @*/
PetscErrorCode TLEDGetMass(TLED tled, const PetscReal *mass[])
{
  PetscFunctionBegin;
  *mass = tled->mass;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDIsFree - whether nothing but f and gravity acts on the body: no support, no load, no contact @*/
PetscErrorCode TLEDIsFree(TLED tled, PetscBool *is_free)
{
  PetscFunctionBegin;
  *is_free = tled->is_free;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDIsConstrained - which nodes are not entirely free: held in some direction, or moved; n_nodes, borrowed @*/
PetscErrorCode TLEDIsConstrained(TLED tled, const PetscBool *constrained[])
{
  PetscFunctionBegin;
  *constrained = tled->constrained;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetProjector - projector of a node onto its free directions, 3 x 3 row-major, borrowed; NULL when it is entirely free @*/
PetscErrorCode TLEDGetProjector(TLED tled, PetscInt node, const PetscReal **P)
{
  PetscFunctionBegin;
  *P = TLEDConstraintProjector_Private(tled, node);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetVectors - displacement [m], velocity [m/s] and external force [N], block size 3, owned by the body; any may be NULL @*/
PetscErrorCode TLEDGetVectors(TLED tled, Vec *u, Vec *v, Vec *f)
{
  PetscFunctionBegin;
  if (u) *u = tled->u;
  if (v) *v = tled->v;
  if (f) *f = tled->f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetPositions - current coordinates X + u [m] and velocities [m/s], n_nodes x 3, borrowed until u or v change; either may be
 * NULL @*/
PetscErrorCode TLEDGetPositions(TLED tled, const PetscReal *x[], const PetscReal *v[])
{
  const PetscReal *u;

  PetscFunctionBegin;
  if (x) {
    PetscCall(VecGetArrayRead(tled->u, &u));
    for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++) tled->x[k] = tled->mesh.X[k] + u[k];
    PetscCall(VecRestoreArrayRead(tled->u, &u));
    *x = tled->x;
  }
  if (v) {
    PetscCall(VecGetArrayRead(tled->v, &u)); /* the array of a host vector stays in place: it may be lent without being held */
    *v = u;
    PetscCall(VecRestoreArrayRead(tled->v, &u));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetAngularImpulse - moment of the held force f in the last TLEDAdvance(), about the origin [N m s], three numbers, borrowed;
    zero for a body that is held @*/
PetscErrorCode TLEDGetAngularImpulse(TLED tled, const PetscReal *impulse[])
{
  PetscFunctionBegin;
  *impulse = tled->state.moment;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetBreakdown - why the last call returned BY_ERR_BREAKDOWN; empty when none did @*/
PetscErrorCode TLEDGetBreakdown(TLED tled, const char **message)
{
  PetscFunctionBegin;
  *message = tled->breakdown;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetTime - time of the state [s] @*/
PetscErrorCode TLEDGetTime(TLED tled, PetscReal *time)
{
  PetscFunctionBegin;
  *time = tled->state.time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDSetTime - set the time of the state [s] @*/
PetscErrorCode TLEDSetTime(TLED tled, PetscReal time)
{
  PetscFunctionBegin;
  tled->state.time = time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDSave - keep u, v and everything else that TLEDAdvance() changes; one level

.seealso: TLEDRestore()
@*/
PetscErrorCode TLEDSave(TLED tled)
{
  const PetscInt   n = 3 * tled->mesh.n_nodes;
  const PetscReal *from;
  PetscObjectState state;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDSave()");
  PetscCall(VecGetArrayRead(tled->u, &from));
  PetscCall(PetscArraycpy(tled->saved, from, n));
  PetscCall(VecRestoreArrayRead(tled->u, &from));
  PetscCall(VecGetArrayRead(tled->v, &from));
  PetscCall(PetscArraycpy(tled->saved + n, from, n));
  PetscCall(VecRestoreArrayRead(tled->v, &from));
  PetscCall(PetscArraycpy(tled->saved + 2 * n, tled->force, n));
  PetscCall(PetscArraycpy(tled->saved + 3 * n, tled->mode, n));
  if (tled->n_history) PetscCall(PetscArraycpy(tled->saved_history, tled->loops.history, tled->n_history));
  PetscCall(PetscObjectStateGet((PetscObject)tled->v, &state));
  if (state != tled->speed_state) tled->state.put_in = 0.0; /* v was changed from outside: its energy is another, after TLEDRestore() too */
  PetscCall(PetscObjectStateGet((PetscObject)tled->u, &state));
  tled->saved_state       = tled->state;
  tled->saved_substeps    = tled->substeps;
  tled->saved_force_valid = tled->force_valid && state == tled->force_state ? PETSC_TRUE : PETSC_FALSE;
  tled->saved_valid       = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDRestore - back to the state of the last TLEDSave(), exactly; f is left as it is

.seealso: TLEDSave()
@*/
PetscErrorCode TLEDRestore(TLED tled)
{
  const PetscInt n = 3 * tled->mesh.n_nodes;
  PetscReal     *to;

  PetscFunctionBegin;
  PetscCheck(tled->saved_valid, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSave() comes before TLEDRestore()");
  PetscCall(VecGetArrayWrite(tled->u, &to));
  PetscCall(PetscArraycpy(to, tled->saved, n));
  PetscCall(VecRestoreArrayWrite(tled->u, &to));
  PetscCall(VecGetArrayWrite(tled->v, &to));
  PetscCall(PetscArraycpy(to, tled->saved + n, n));
  PetscCall(VecRestoreArrayWrite(tled->v, &to));
  PetscCall(PetscArraycpy(tled->force, tled->saved + 2 * n, n));
  PetscCall(PetscArraycpy(tled->mode, tled->saved + 3 * n, n));
  if (tled->n_history) PetscCall(PetscArraycpy(tled->loops.history, tled->saved_history, tled->n_history));
  tled->state       = tled->saved_state;
  tled->substeps    = tled->saved_substeps;
  tled->force_valid = tled->saved_force_valid;
  PetscCall(PetscObjectStateGet((PetscObject)tled->u, &tled->force_state));
  PetscCall(PetscObjectStateGet((PetscObject)tled->v, &tled->speed_state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define N_STATE ((PetscInt)(sizeof(TLEDState) / sizeof(PetscReal)))

/*@
  TLEDGetState - what TLEDAdvance() carries on besides u, v and f, as plain numbers for a checkpoint

  Output Parameters:
+ n     - how many
- state - the numbers, or NULL to ask for n

.seealso: TLEDSetState()
@*/
PetscErrorCode TLEDGetState(TLED tled, PetscInt *n, PetscReal state[])
{
  const PetscInt   m = 3 * tled->mesh.n_nodes;
  PetscObjectState now;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDGetState()");
  *n = N_STATE + 2 + 2 * m + tled->n_history;
  if (!state) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscObjectStateGet((PetscObject)tled->u, &now));
  PetscCall(PetscMemcpy(state, &tled->state, sizeof tled->state));
  state[N_STATE]     = (PetscReal)tled->substeps;
  state[N_STATE + 1] = tled->force_valid && now == tled->force_state ? 1.0 : 0.0;
  PetscCall(PetscArraycpy(&state[N_STATE + 2], tled->mode, m));
  PetscCall(PetscArraycpy(&state[N_STATE + 2 + m], tled->force, m));
  if (tled->n_history) PetscCall(PetscArraycpy(&state[N_STATE + 2 + 2 * m], tled->loops.history, tled->n_history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDSetState - put back what TLEDGetState() gave; after u and v have been put back

  Errors: PETSC_ERR_ARG_SIZ when n does not fit this body

.seealso: TLEDGetState()
@*/
PetscErrorCode TLEDSetState(TLED tled, PetscInt n, const PetscReal state[])
{
  const PetscInt m = 3 * tled->mesh.n_nodes;

  PetscFunctionBegin;
  PetscCheck(n == N_STATE + 2 + 2 * m + tled->n_history, PetscObjectComm((PetscObject)tled), PETSC_ERR_ARG_SIZ,
             "a state of %" PetscInt_FMT " numbers, expected %" PetscInt_FMT, n, N_STATE + 2 + 2 * m + tled->n_history);
  PetscCall(PetscMemcpy(&tled->state, state, sizeof tled->state));
  tled->substeps    = (PetscInt)state[N_STATE];
  tled->force_valid = state[N_STATE + 1] > 0.0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscArraycpy(tled->mode, &state[N_STATE + 2], m));
  PetscCall(PetscArraycpy(tled->force, &state[N_STATE + 2 + m], m));
  if (tled->n_history) PetscCall(PetscArraycpy(tled->loops.history, &state[N_STATE + 2 + 2 * m], tled->n_history));
  PetscCall(PetscObjectStateGet((PetscObject)tled->u, &tled->force_state));
  PetscCall(PetscObjectStateGet((PetscObject)tled->v, &tled->speed_state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDGetStats - energies, momenta and volume of the current state

  Output Parameter:
. stats - see tled.h; with stiffness damping, what its stresses lost is in damping_loss: the work of the internal forces that is not
in the strain energy

  Cost: one scalar pass over the elements
@*/
PetscErrorCode TLEDGetStats(TLED tled, TLEDStats *s)
{
  const PetscReal *u, *v, *X = tled->mesh.X;
  PetscReal        speed2 = 0.0;

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDGetStats()");
  PetscCall(PetscMemzero(s, sizeof *s));
  PetscCall(VecGetArrayRead(tled->u, &u));
  PetscCall(VecGetArrayRead(tled->v, &v));
  PetscCall(TLEDStrain_Private(tled, u, &s->strain, &s->volume, NULL));
  s->contact_energy = TLEDContactEnergy_Private(tled, u);
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) {
    const PetscReal m = tled->mass[a], v2 = Dot3(&v[3 * a], &v[3 * a]);
    PetscReal       x[3], r[3];
    for (PetscInt k = 0; k < 3; k++) x[k] = X[3 * a + k] + u[3 * a + k];
    Cross3(x, &v[3 * a], r);
    for (PetscInt k = 0; k < 3; k++) s->momentum[k] += m * v[3 * a + k], s->angular[k] += m * r[k];
    s->kinetic += 0.5 * m * v2;
    s->gravity_potential -= m * Dot3(tled->gravity, &u[3 * a]);
    speed2 = PetscMax(speed2, v2);
  }
  PetscCall(VecRestoreArrayRead(tled->v, &v));
  PetscCall(VecRestoreArrayRead(tled->u, &u));
  s->speed_max        = PetscSqrtReal(speed2);
  s->volume_reference = tled->volume;
  s->support_work     = tled->state.support_work;
  s->external_work    = tled->state.external_work + tled->state.support_work;
  s->damping_loss     = tled->state.damping_loss;
  if (tled->params.stiffness_damping > 0.0 || tled->loops.viscous) s->damping_loss += tled->state.internal_work - s->strain - s->contact_energy;
  PetscFunctionReturn(PETSC_SUCCESS);
}
