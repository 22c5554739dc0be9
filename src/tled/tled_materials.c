/* tled_materials.c - the materials of a body: parameters made laws, and which element is made of which. */
#include "tled/tled_impl.h"
#include <string.h>

/*@
  TLEDAddMaterial - one more material, for the elements of the physical volumes that it names

  Input Parameters:
+ tled   - the body, not yet set up
. name   - name of the material, for messages: <body>.<name>
- params - the material; `volumes` names at least one physical volume of the mesh

  The body's own material, TLEDParams.elastic, has all elements that no other has.

.seealso: TLEDSetUp()
@*/
PetscErrorCode TLEDAddMaterial(TLED tled, const char name[], const TLEDMaterialParams *params)
{
  PetscFunctionBegin;
  PetscCheck(!tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDAddMaterial() comes before TLEDSetUp()");
  if (!tled->n_materials) tled->n_materials = 1; /* the body's own */
  PetscCheck(tled->n_materials < TLED_MATERIALS, PetscObjectComm((PetscObject)tled), PETSC_ERR_ARG_OUTOFRANGE,
             "a body has at most %d materials", TLED_MATERIALS);
  tled->materials[tled->n_materials] = *params;
  PetscCall(PetscStrncpy(tled->material_name[tled->n_materials++], name, BY_NAME_MAX));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* scene key of material k: "flap.young", "flap.core.young" */
static PetscErrorCode MaterialKey(TLED tled, PetscInt k, const char word[], char key[], size_t n)
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(key, n, "%s%s%s.%s", ((PetscObject)tled)->name, k ? "." : "", k ? tled->material_name[k] : "", word));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* law of a material; what its law needs must be given */
static PetscErrorCode MakeLaw(TLED tled, PetscInt k)
{
  const TLEDMaterialParams *p   = &tled->materials[k];
  TLEDLaw                  *law = &tled->laws[k];
  char                      key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(law, sizeof *law));
  PetscCall(MaterialKey(tled, k, "young", key, sizeof key));
  if (!(p->young > 0.0)) PetscFunctionReturn(InputError(key, "is missing\n  expected a finite number > 0 [Pa]: Young's modulus at small strain"));
  law->law    = p->material == TLED_MATERIAL_NEO_HOOKEAN ? TLED_LAW_NEO_HOOKEAN : TLED_LAW_ST_VENANT_KIRCHHOFF;
  law->mu     = p->young / (2.0 * (1.0 + p->poisson));
  law->lambda = p->young * p->poisson / ((1.0 + p->poisson) * (1.0 - 2.0 * p->poisson));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the elements of the volumes that material k names */
static PetscErrorCode AssignVolumes(TLED tled, PetscInt k)
{
  const Names     *names = &tled->materials[k].volumes;
  const TLEDGroup *group;
  char             key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(MaterialKey(tled, k, "volumes", key, sizeof key));
  if (!names->n) PetscFunctionReturn(InputError(key, "is missing\n  expected the names of physical volumes of the mesh"));
  for (PetscInt i = 0; i < names->n; i++) {
    ByCall(TLEDMeshNeedGroup_Private(&tled->mesh, tled->params.mesh, key, names->name[i], 3, &group));
    for (PetscInt j = 0; j < group->n_tets; j++) {
      PetscInt *material = &tled->mesh.material[group->tets[j]];
      if (*material && *material != k)
        PetscFunctionReturn(InputError(key,
                                       "names the volume %s, whose element %" PetscInt_FMT
                                       " of the file is also in a volume of %s.%s\n  an element is made of one material",
                                       names->name[i], tled->mesh.tag[group->tets[j]], ((PetscObject)tled)->name,
                                       tled->material_name[*material]));
      *material = k;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDMaterialsSetUp_Private - laws of all materials, and mesh->material of the mesh as read

  Errors: BY_ERR_INPUT, reported: a parameter that a law needs is missing, a volume that the mesh does not have, an element in two
  materials
*/
PetscErrorCode TLEDMaterialsSetUp_Private(TLED tled)
{
  PetscFunctionBegin;
  if (!tled->n_materials) tled->n_materials = 1;
  tled->materials[0] = tled->params.elastic;
  PetscCall(PetscCalloc1(tled->mesh.n_tets, &tled->mesh.material));
  for (PetscInt k = 0; k < tled->n_materials; k++) {
    ByCall(MakeLaw(tled, k));
    if (k) ByCall(AssignVolumes(tled, k));
  }
  tled->loops.laws   = tled->laws;
  tled->loops.n_laws = (int)tled->n_materials;
  PetscFunctionReturn(PETSC_SUCCESS);
}
