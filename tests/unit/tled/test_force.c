/* Forces of a whole mesh: patch test, rigid motion, gradient of the energy, tangent; for both elements and all laws. */
#include "unit/tled/block.h"
#include "unit/tled/forces.h"

static TLED Cube(int law, int element, TLEDParams **p)
{
  TLED tled = NewBody("tests/meshes/cube_h1.msh", p);

  ReferenceMaterial(law, &(*p)->elastic);
  (*p)->element  = element;
  assert_petsc(TLEDSetUp(tled));
  return tled;
}

static void PatchTest_GivesTheUniformStress(void **state)
{
  (void)state;
  for (int law = 0; law < TLED_LAWS; law++) {
    for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
      TLEDParams *p;
      TLED        tled = Cube(law, element, &p);
      CheckPatch(tled, law);
      assert_petsc(TLEDDestroy(&tled));
    }
  }
}

static void RigidMotion_GivesNoForce(void **state)
{
  (void)state;
  for (int law = 0; law < TLED_LAWS; law++) {
    for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
      TLEDParams *p;
      TLED        tled = Cube(law, element, &p);
      CheckRigidMotion(tled);
      assert_petsc(TLEDDestroy(&tled));
    }
  }
}

static void ForceAndTangent_AreDerivatives(void **state)
{
  (void)state;
  for (int law = 0; law < TLED_LAWS; law++) {
    for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
      TLEDParams *p;
      TLED        tled = Cube(law, element, &p);
      CheckDerivatives(tled);
      assert_petsc(TLEDDestroy(&tled));
    }
  }
}

/* two materials that share nodes, whose averages they do not share */
static void ForceAndTangentOfTwoMaterials_AreDerivatives(void **state)
{
  const Block block = {.n = {4, 2, 2}, .size = {1.0, 1.0, 1.0}, .order = 1, .n_lower = 2};

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    TLEDParams        *p;
    TLEDMaterialParams stiff;
    TLED               tled = NewBlock(&block, &p);

    p->element         = element;
    stiff              = p->elastic;
    stiff.material     = TLED_MATERIAL_NEO_HOOKEAN_ISO;
    stiff.poisson      = 0.49;
    stiff.young        = 7.0 * p->elastic.young;
    AddName(&stiff.volumes, "lower");
    assert_petsc(TLEDAddMaterial(tled, "stiff", &stiff));
    assert_petsc(TLEDSetUp(tled));
    RemoveBlock(p);
    CheckDerivatives(tled);
    assert_petsc(TLEDDestroy(&tled));
  }
}

CHECK_MAIN(cmocka_unit_test(PatchTest_GivesTheUniformStress), cmocka_unit_test(RigidMotion_GivesNoForce),
           cmocka_unit_test(ForceAndTangent_AreDerivatives),
           cmocka_unit_test(ForceAndTangentOfTwoMaterials_AreDerivatives))
