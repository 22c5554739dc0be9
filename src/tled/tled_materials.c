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

/* refuse a value of a key that the material's law does not know */
static PetscErrorCode Refuse(TLED tled, PetscInt k, const char word[], PetscBool given, const char law[])
{
  char key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  if (!given) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MaterialKey(tled, k, word, key, sizeof key));
  PetscFunctionReturn(InputError(key, "is given, but the material is not %s\n  leave it out or choose that material", law));
}

/* a value that a law needs must be given */
static PetscErrorCode Need(TLED tled, PetscInt k, const char word[], PetscBool given, const char what[])
{
  char key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  if (given) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MaterialKey(tled, k, word, key, sizeof key));
  PetscFunctionReturn(InputError(key, "is missing\n  expected %s", what));
}

/* the Prony series: as many times as parts, and something left when all of them have relaxed */
static PetscErrorCode CheckProny(TLED tled, PetscInt k)
{
  const Reals *alpha = &tled->materials[k].prony_alpha, *tau = &tled->materials[k].prony_tau;
  PetscReal    sum = 0.0;
  char         key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(MaterialKey(tled, k, "prony_tau", key, sizeof key));
  if (alpha->n != tau->n)
    PetscFunctionReturn(InputError(key,
                                   "has %" PetscInt_FMT " numbers, prony_alpha has %" PetscInt_FMT
                                   "\n  expected a relaxation time for each part that relaxes",
                                   tau->n, alpha->n));
  if (alpha->n > TLED_PRONY_MAX)
    PetscFunctionReturn(InputError(key, "has %" PetscInt_FMT " numbers\n  expected at most %d", tau->n, TLED_PRONY_MAX));
  PetscCall(MaterialKey(tled, k, "prony_alpha", key, sizeof key));
  for (PetscInt i = 0; i < alpha->n; i++) {
    sum += alpha->value[i];
    if (!(alpha->value[i] > 0.0 && tau->value[i] > 0.0))
      PetscFunctionReturn(InputError(key, "and prony_tau have %g and %g s\n  expected finite numbers > 0", (double)alpha->value[i],
                                     (double)tau->value[i]));
  }
  if (!(sum < 1.0))
    PetscFunctionReturn(InputError(key, "adds up to %g\n  expected a sum < 1: the part that is left is the stiffness after a long time",
                                   (double)sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what the law of material k needs is given, and nothing else */
static PetscErrorCode CheckParams(TLED tled, PetscInt k)
{
  const TLEDMaterialParams *p       = &tled->materials[k];
  const PetscBool           mooney  = (PetscBool)(p->material == TLED_MATERIAL_MOONEY_RIVLIN);
  const PetscBool           fibrous = (PetscBool)(p->material == TLED_MATERIAL_TRANSVERSELY_ISOTROPIC);
  const PetscBool           split   = (PetscBool)(p->material >= TLED_MATERIAL_NEO_HOOKEAN_ISO);
  const PetscBool           along   = (PetscBool)(Norm3(p->fibre) > 0.0), field = (PetscBool)(p->fibre_field[0] != 0);
  char                      key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  if (!mooney) ByCall(Need(tled, k, "young", (PetscBool)(p->young > 0.0), "a finite number > 0 [Pa]: Young's modulus at small strain"));
  if (mooney) {
    ByCall(Refuse(tled, k, "young", (PetscBool)(p->young > 0.0), "one with Young's modulus: mooney_rivlin has c10 and c01"));
    ByCall(Need(tled, k, "c10", (PetscBool)(p->c10 != 0.0 || p->c01 != 0.0), "the constants c10 and c01 of mooney_rivlin [Pa]"));
    PetscCall(MaterialKey(tled, k, "c10", key, sizeof key));
    if (!(p->c10 + p->c01 > 0.0))
      PetscFunctionReturn(InputError(key, "and c01 add up to %g Pa\n  expected a sum > 0: twice the sum is the shear modulus",
                                     (double)(p->c10 + p->c01)));
  } else ByCall(Refuse(tled, k, p->c10 != 0.0 ? "c10" : "c01", (PetscBool)(p->c10 != 0.0 || p->c01 != 0.0), "mooney_rivlin"));
  if (!split) ByCall(Refuse(tled, k, "bulk", (PetscBool)(p->bulk > 0.0), "neo_hookean_iso, mooney_rivlin or transversely_isotropic"));
  if (fibrous) {
    ByCall(Need(tled, k, "fibre_stiffness", (PetscBool)(p->fibre_stiffness > 0.0), "a finite number > 0 [Pa]: the fibres' stiffness"));
    ByCall(Need(tled, k, "fibre", (PetscBool)(along || field), "a direction [x, y, z] that is not zero, or fibre_field"));
    PetscCall(MaterialKey(tled, k, "fibre_field", key, sizeof key));
    if (along && field) PetscFunctionReturn(InputError(key, "is given, and fibre too\n  the fibres have one direction or a field"));
  } else {
    ByCall(Refuse(tled, k, "fibre_field", field, "transversely_isotropic"));
    ByCall(Refuse(tled, k, "fibre_stiffness", (PetscBool)(p->fibre_stiffness > 0.0), "transversely_isotropic"));
    ByCall(Refuse(tled, k, "fibre", along, "transversely_isotropic"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* law of a material whose parameters are checked */
static void MakeLaw(const TLEDMaterialParams *p, TLEDLaw *law)
{
  law->law = p->material;
  law->mu  = p->young / (2.0 * (1.0 + p->poisson));
  if (law->law == TLED_LAW_MOONEY_RIVLIN) law->c10 = p->c10, law->c01 = p->c01, law->mu = 2.0 * (p->c10 + p->c01);
  if (law->law < TLED_LAW_NEO_HOOKEAN_ISO) law->lambda = 2.0 * law->mu * p->poisson / (1.0 - 2.0 * p->poisson);
  else law->kappa = p->bulk > 0.0 ? p->bulk : 2.0 * law->mu * (1.0 + p->poisson) / (3.0 * (1.0 - 2.0 * p->poisson));
  law->eta     = p->fibre_stiffness;
  law->n_prony = (int)p->prony_alpha.n;
  for (int i = 0; i < law->n_prony; i++) law->alpha[i] = p->prony_alpha.value[i], law->tau[i] = p->prony_tau.value[i];
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

  Errors: BY_ERR_INPUT, reported: a parameter that a law needs is missing or one that it does not know is given, a volume that the mesh does not have, an element in two
  materials
*/
PetscErrorCode TLEDMaterialsSetUp_Private(TLED tled)
{
  PetscFunctionBegin;
  if (!tled->n_materials) tled->n_materials = 1;
  tled->materials[0] = tled->params.elastic;
  PetscCall(PetscCalloc1(tled->mesh.n_tets, &tled->mesh.material));
  for (PetscInt k = 0; k < tled->n_materials; k++) {
    ByCall(CheckParams(tled, k));
    ByCall(CheckProny(tled, k));
    MakeLaw(&tled->materials[k], &tled->laws[k]);
    if (k) ByCall(AssignVolumes(tled, k));
  }
  tled->loops.laws   = tled->laws;
  tled->loops.n_laws = (int)tled->n_materials;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* fibres of material k: its constant direction, or the field of its elements in the mesh file (n_tets x 3) */
static PetscErrorCode ReadFibres(TLED tled, PetscInt k, PetscReal field[])
{
  const TLEDMaterialParams *p = &tled->materials[k];
  char                      key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(MaterialKey(tled, k, "fibre_field", key, sizeof key));
  if (p->fibre_field[0]) ByCall(TLEDFieldRead_Private(key, tled->params.mesh, p->fibre_field, &tled->mesh, field));
  for (PetscInt e = 0; e < tled->mesh.n_tets; e++) {
    if (!p->fibre_field[0]) PetscCall(PetscArraycpy(&field[3 * e], p->fibre, 3));
    if (tled->mesh.material[e] == k && !(Norm3(&field[3 * e]) > 0.0))
      PetscFunctionReturn(InputError(key, "names the view %s, which has no direction for element %" PetscInt_FMT
                                          " of the file\n  expected a vector that is not zero for each element of the material",
                                     p->fibre_field, tled->mesh.tag[e]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDFibresSetUp_Private - blocks.fibre, unit vectors along the fibres of each lane, for a body in which a law has them

  Errors: BY_ERR_INPUT, reported: a field that the mesh file does not have, or that has no direction for an element
*/
PetscErrorCode TLEDFibresSetUp_Private(TLED tled)
{
  TLEDBlocks    *b = &tled->blocks;
  PetscReal     *field;
  PetscErrorCode ierr = PETSC_SUCCESS;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < tled->n_materials && !ierr; k++) {
    if (tled->laws[k].law != TLED_LAW_TRANSVERSE) continue;
    if (!b->fibre) PetscCall(PetscCalloc1(3 * b->n_packs * TLED_LANES, &b->fibre));
    PetscCall(PetscMalloc1(3 * tled->mesh.n_tets, &field));
    ierr = ReadFibres(tled, k, field);
    for (int l = 0; l < b->n_packs * TLED_LANES && !ierr; l++) {
      const int       pack = l / TLED_LANES;
      const PetscReal *a   = &field[3 * b->element[l]];
      if (b->element[l] < 0 || b->material[pack] != k) continue;
      for (int i = 0; i < 3; i++) b->fibre[(3 * pack + i) * TLED_LANES + l % TLED_LANES] = a[i] / Norm3(a);
    }
    PetscCall(PetscFree(field));
  }
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
