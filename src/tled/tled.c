/* tled.c - the life of a body: Create, SetFromOptions, SetUp, View, Destroy, and what it lends. */
#include "tled/tled_impl.h"
#include "tled/tled_t10.h"
#include <string.h>

PetscClassId  TLED_CLASSID;
PetscLogEvent TLED_EVENT_ADVANCE, TLED_EVENT_TANGENT, TLED_EVENT_CRITICAL;

static PetscErrorCode RegisterClass(void)
{
  static PetscBool registered = PETSC_FALSE;

  PetscFunctionBegin;
  if (registered) PetscFunctionReturn(PETSC_SUCCESS);
  registered = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("TLED", &TLED_CLASSID));
  PetscCall(PetscLogEventRegister("TLEDAdvance", TLED_CLASSID, &TLED_EVENT_ADVANCE));
  PetscCall(PetscLogEventRegister("TLEDTangent", TLED_CLASSID, &TLED_EVENT_TANGENT));
  PetscCall(PetscLogEventRegister("TLEDCritical", TLED_CLASSID, &TLED_EVENT_CRITICAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDCreate - an elastic body with the default parameters

  Collective

  Input Parameters:
+ comm - one process (the body is not distributed)
- name - name of the body; its options begin with -<name>_

  Output Parameter:
. tled - the body; TLEDDestroy() frees it

.seealso: TLEDSetFromOptions(), TLEDSetUp()
@*/
PetscErrorCode TLEDCreate(MPI_Comm comm, const char name[], TLED *tled)
{
  TLED        t;
  char        prefix[BY_NAME_MAX + 1];
  PetscMPIInt size;

  PetscFunctionBegin;
  *tled = NULL;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCheck(size == 1, comm, PETSC_ERR_SUP, "a TLED lives on one process, not on %d", size);
  PetscCall(RegisterClass());
  PetscCall(PetscHeaderCreate(t, TLED_CLASSID, "TLED", "elastic body", "TLED", comm, TLEDDestroy, TLEDView));
  PetscCall(PetscSNPrintf(prefix, sizeof prefix, "%s_", name));
  PetscCall(PetscObjectSetName((PetscObject)t, name));
  PetscCall(PetscObjectSetOptionsPrefix((PetscObject)t, prefix));
  PetscCall(KeysSetDefaults(TLEDKeys, &t->params));
  *tled = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDGetParams - the parameters, to be read or, before TLEDSetUp(), changed @*/
PetscErrorCode TLEDGetParams(TLED tled, TLEDParams **params)
{
  PetscFunctionBegin;
  *params = &tled->params;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDSetFromOptions - parameters from the options database, -<name>_<key> (TLEDKeys), and of the materials, supports and loads that they
  name, -<name>_<material>_<key> (TLEDMaterialKeys), -<name>_<constraint>_<key> (TLEDConstraintKeys), -<name>_<load>_<key> (TLEDLoadKeys)
@*/
PetscErrorCode TLEDSetFromOptions(TLED tled)
{
  const Names       *names  = &tled->params.materials;
  const char        *prefix = ((PetscObject)tled)->prefix;
  TLEDMaterialParams material;
  char               full[2 * BY_NAME_MAX + 2];

  PetscFunctionBegin;
  ByCall(KeysSetFromOptions(TLEDKeys, prefix, &tled->params));
  for (PetscInt i = 0; i < names->n; i++) {
    PetscCall(PetscSNPrintf(full, sizeof full, "%s%s_", prefix, names->name[i]));
    PetscCall(KeysSetDefaults(TLEDMaterialKeys, &material));
    ByCall(KeysSetFromOptions(TLEDMaterialKeys, full, &material));
    PetscCall(TLEDAddMaterial(tled, names->name[i], &material));
  }
  PetscCall(TLEDConstraintsFromOptions_Private(tled));
  PetscCall(TLEDLoadsFromOptions_Private(tled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDSetGravity - acceleration of gravity [m/s^2]; may be changed between TLEDAdvance() calls @*/
PetscErrorCode TLEDSetGravity(TLED tled, const PetscReal g[3])
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(tled->gravity, g, 3));
  tled->state.put_in = 0.0; /* another potential: the watch on the energy begins anew */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the wetted triangles: of the groups named, each once, in the order of the boundary; all when none is named */
static PetscErrorCode PickWetted(TLED tled)
{
  const Names     *names = &tled->params.wetted;
  const TLEDMesh  *mesh  = &tled->mesh;
  const TLEDGroup *group;
  char             full[2 * BY_NAME_MAX];
  PetscBool       *wet;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(full, sizeof full, "%s.wetted", ((PetscObject)tled)->name));
  PetscCall(PetscCalloc1(mesh->n_triangles, &wet));
  for (PetscInt i = 0; i < names->n; i++) {
    PetscErrorCode ierr = TLEDMeshNeedGroup_Private(mesh, tled->params.mesh, full, names->name[i], 2, &group);
    if (ierr) PetscCall(PetscFree(wet));
    ByCall(ierr);
    for (PetscInt k = 0; k < group->n_triangles; k++) wet[group->triangles[k]] = PETSC_TRUE;
  }
  PetscCall(PetscMalloc1(3 * mesh->n_triangles, &tled->wetted));
  for (PetscInt t = 0; t < mesh->n_triangles; t++) {
    if (names->n && !wet[t]) continue;
    PetscCall(PetscArraycpy(&tled->wetted[3 * tled->n_wetted++], &mesh->triangles[3 * t], 3));
  }
  PetscCall(PetscFree(wet));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUpLoops(TLED tled)
{
  const TLEDBlocks *b = &tled->blocks;
  TLEDLoops        *w = &tled->loops;

  PetscFunctionBegin;
  w->blocks = b;
  PetscCall(PetscMalloc2(3 * tled->blocks.n_slots, &w->partial, tled->blocks.n_blocks, &w->status));
  if (w->anp) {
    const PetscInt n = tled->mesh.n_nodes * w->n_laws;
    PetscCall(PetscMalloc3(n, &w->nodal, n, &w->pressure, n, &w->weight));
    PetscCall(PetscArrayzero(w->weight, n));
    for (int l = 0; l < TLED_LANES * b->n_packs; l++)
      for (int a = 0; a < 4 && b->element[l] >= 0; a++) w->weight[TLEDAverageOf(w, tled->mesh.tets[4 * b->element[l] + a], b->material[l / TLED_LANES])] += b->V0[l];
    for (PetscInt k = 0; k < n; k++)
      if (w->weight[k] > 0.0) w->weight[k] = 1.0 / w->weight[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateVectors(TLED tled)
{
  const PetscInt n = 3 * tled->mesh.n_nodes, n_chunks = (tled->mesh.n_nodes + TLED_CHUNK - 1) / TLED_CHUNK;
  PetscReal     *u, *v;

  PetscFunctionBegin;
  PetscCall(VecCreate(PetscObjectComm((PetscObject)tled), &tled->u));
  PetscCall(VecSetSizes(tled->u, n, n));
  PetscCall(VecSetBlockSize(tled->u, 3));
  PetscCall(VecSetType(tled->u, VECSTANDARD));
  PetscCall(VecSet(tled->u, 0.0));
  PetscCall(VecDuplicate(tled->u, &tled->v));
  PetscCall(VecDuplicate(tled->u, &tled->f));
  PetscCall(VecSet(tled->f, 0.0));
  PetscCall(PetscMalloc5(n, &tled->x, n, &tled->force, n, &tled->probe, n, &tled->mode, n, &tled->trial));
  PetscCall(PetscMalloc3(5 * n, &tled->krylov, 4 * n, &tled->saved, n_chunks * TLED_SUMS, &tled->sums));
  PetscCall(PetscArrayzero(tled->mode, n));
  PetscCall(PetscArrayzero(tled->sums, n_chunks * TLED_SUMS));
  PetscCall(VecGetArrayWrite(tled->u, &u));
  PetscCall(VecGetArrayWrite(tled->v, &v));
  PetscCall(TLEDPrescribed_Private(tled, 0.0, u, tled->trial, NULL));
  for (PetscInt k = 0; k < n; k++) v[k] = tled->params.velocity[k % 3];
  PetscCall(TLEDProject_Private(tled, v));
  for (PetscInt k = 0; k < n; k++) v[k] += tled->trial[k];
  PetscCall(VecRestoreArrayWrite(tled->v, &v));
  PetscCall(VecRestoreArrayWrite(tled->u, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDSetUp - read the mesh and make everything ready to advance

  Collective

  Errors: BY_ERR_INPUT, reported with mesh, group and element, when the mesh or its groups cannot be used

.seealso: TLEDCreate(), TLEDAdvance()
@*/
PetscErrorCode TLEDSetUp(TLED tled)
{
  static const int n_points[] = {TLED_T10_POINTS, TLED_T10_POINTS_FINE}; /* in the order of TLEDQuadrature */
  char             key[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCheck(!tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() was called before");
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.mesh", ((PetscObject)tled)->name));
  ByCall(TLEDMeshRead_Private(key, &tled->params, &tled->mesh));
  ByCall(TLEDMaterialsSetUp_Private(tled));
  ByCall(TLEDElementPick_Private(tled));
  PetscCall(TLEDBlocksCreate_Private(&tled->mesh, tled->mesh.n_corners == 4 ? 1 : n_points[tled->params.quadrature], &tled->blocks));
  ByCall(TLEDFibresSetUp_Private(tled));
  PetscCall(TLEDViscousSetUp_Private(tled));
  PetscCall(PetscCalloc2(tled->mesh.n_nodes, &tled->motion, tled->mesh.n_nodes, &tled->constrained));
  ByCall(TLEDConstraintsSetUp_Private(tled));
  ByCall(PickWetted(tled));
  ByCall(TLEDLoadsSetUp_Private(tled));
  tled->is_free = (PetscBool)(tled->constraints.n_held == 0 && tled->loads.n == 0 && tled->contact.n == 0);
  PetscCall(TLEDLumpMass_Private(tled));
  PetscCall(SetUpLoops(tled));
  ByCall(TLEDContactSetUp_Private(tled));
  PetscCall(CreateVectors(tled));
  PetscCall(TLEDScaleMass_Private(tled));
  tled->set_up = PETSC_TRUE;
  PetscCall(PetscObjectViewFromOptions((PetscObject)tled, NULL, "-view"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDView - print every parameter with its unit, and the size of the mesh once it is read @*/
PetscErrorCode TLEDView(TLED tled, PetscViewer viewer)
{
  PetscFunctionBegin;
  if (!viewer) PetscCall(PetscViewerASCIIGetStdout(PetscObjectComm((PetscObject)tled), &viewer));
  PetscCall(PetscObjectPrintClassNamePrefixType((PetscObject)tled, viewer));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  if (tled->set_up) {
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "%" PetscInt_FMT " nodes, %" PetscInt_FMT " tetrahedra in %d blocks, %" PetscInt_FMT
                                     " boundary triangles (%" PetscInt_FMT " wetted), volume %g m^3, element %s\n",
                                     tled->mesh.n_nodes, tled->mesh.n_tets, tled->blocks.n_blocks, tled->mesh.n_triangles,
                                     tled->n_wetted, (double)tled->volume, tled->loops.ops->name));
    if (tled->params.mass_scaling > 0.0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "mass scaling: %g kg (%.4g %%) added to %" PetscInt_FMT " elements\n",
                                       (double)tled->mass_added, (double)(100.0 * tled->mass_added / tled->mass_total), tled->n_scaled));
    if (tled->state.critical > 0.0) PetscCall(PetscViewerASCIIPrintf(viewer, "critical step %g s\n", (double)tled->state.critical));
  }
  PetscCall(KeysView(TLEDKeys, &tled->params, viewer));
  for (PetscInt k = 1; k < tled->n_materials; k++) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "material %s\n", tled->material_name[k]));
    PetscCall(PetscViewerASCIIPushTab(viewer));
    PetscCall(KeysView(TLEDMaterialKeys, &tled->materials[k], viewer));
    PetscCall(PetscViewerASCIIPopTab(viewer));
  }
  for (PetscInt i = 0; i < tled->constraints.n; i++) {
    if (tled->constraints.item[i].shorthand) continue;
    PetscCall(PetscViewerASCIIPrintf(viewer, "constraint %s:\n", tled->constraints.item[i].key));
    PetscCall(PetscViewerASCIIPushTab(viewer));
    PetscCall(KeysView(TLEDConstraintKeys, &tled->constraints.item[i].params, viewer));
    PetscCall(PetscViewerASCIIPopTab(viewer));
  }
  for (PetscInt i = 0; i < tled->loads.n; i++) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "load %s:\n", tled->loads.item[i].key));
    PetscCall(PetscViewerASCIIPushTab(viewer));
    PetscCall(KeysView(TLEDLoadKeys, &tled->loads.item[i].params, viewer));
    PetscCall(PetscViewerASCIIPopTab(viewer));
  }
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ TLEDDestroy - free a body; NULL and half-built ones are fine @*/
PetscErrorCode TLEDDestroy(TLED *tled)
{
  TLED t;

  PetscFunctionBegin;
  if (!tled || !*tled) PetscFunctionReturn(PETSC_SUCCESS);
  t     = *tled;
  *tled = NULL;
  if (--((PetscObject)t)->refct > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TLEDMeshDestroy_Private(&t->mesh));
  PetscCall(TLEDBlocksDestroy_Private(&t->blocks));
  PetscCall(TLEDViscousDestroy_Private(t));
  PetscCall(PetscFree2(t->loops.partial, t->loops.status));
  PetscCall(PetscFree3(t->loops.nodal, t->loops.pressure, t->loops.weight));
  PetscCall(PetscFree(t->wetted));
  PetscCall(PetscFree(t->mass));
  PetscCall(PetscFree2(t->motion, t->constrained));
  PetscCall(TLEDConstraintsDestroy_Private(&t->constraints));
  PetscCall(TLEDLoadsDestroy_Private(&t->loads));
  PetscCall(TLEDContactDestroy_Private(&t->contact));
  PetscCall(VecDestroy(&t->u));
  PetscCall(VecDestroy(&t->v));
  PetscCall(VecDestroy(&t->f));
  PetscCall(PetscFree5(t->x, t->force, t->probe, t->mode, t->trial));
  PetscCall(PetscFree3(t->krylov, t->saved, t->sums));
  PetscCall(TLEDAssemblyDestroy_Private(&t->assembly));
  PetscCall(PetscHeaderDestroy(&t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
