/* Dynamic relaxation: the static solutions of an independent code and of Newton's method, whatever the element, material and load. */
#include "unit/tled/block.h"

/* the cantilever under its weight: tip centre [m] and strain energy [J] by an independent code (DOLFINx 0.5.2, P1 on the same mesh,
   LU, |du| < 1e-9) */
typedef struct {
  const char *mesh;
  int         material;
  double      poisson, tip[3], energy;
} Reference;

static const PetscReal g[3] = {0.0, 0.0, -9.81};

static TLED Cantilever(const Reference *ref, int element)
{
  TLEDParams *p;
  TLED        tled = NewBody(ref->mesh, &p);

  p->elastic.material = ref->material;
  p->elastic.poisson  = ref->poisson;
  p->element          = element;
  AddName(&p->fixed, "clamp");
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  return tled;
}

static void Cantilever_IsTheReference(void **state)
{
  const Reference all[4] = {
      {"tests/meshes/beam_h1.msh", TLED_MATERIAL_NEO_HOOKEAN, 0.3,
       {-0.04142484237735666, -0.0009972955093733896, -0.2709548025632535}, 5.317299312167156},
      {"tests/meshes/beam_h1.msh", TLED_MATERIAL_NEO_HOOKEAN, 0.45,
       {-0.025593659167204127, -0.0013157307281949477, -0.21439682744396152}, 4.234257721621486},
      {"tests/meshes/beam_h1.msh", TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.3,
       {-0.042361426579887194, -0.0007976745029058303, -0.27165781027625807}, 5.341168338410373},
      {"tests/meshes/beam_h1.msh", TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.45,
       {-0.02631445146114603, -0.0011003582678427604, -0.21481358917485185}, 4.248196232583419}};

  (void)state;
  for (int i = 0; i < 4; i++) {
    TLED             tled = Cantilever(&all[i], TLED_ELEMENT_T4);
    TLEDStats        stats;
    const PetscReal *x;
    PetscReal        residual, worst = 0.0;
    PetscInt         steps, tip;
    Vec              u;

    assert_petsc(TLEDRelax(tled, 1.0, 1e-7, 100000, &steps, &residual));
    tip = NodeAt(tled, 1.0, 0.05, 0.05);
    assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
    assert_petsc(VecGetArrayRead(u, &x));
    for (int k = 0; k < 3; k++) worst = fmax(worst, fabs(x[3 * tip + k] - all[i].tip[k]) / fabs(all[i].tip[2]));
    assert_petsc(VecRestoreArrayRead(u, &x));
    assert_petsc(TLEDGetStats(tled, &stats));
    printf("relax: cantilever nu %.2f %s: %d steps, residual %.2g, tip %.2g, energy %.2g\n", all[i].poisson,
           all[i].material ? "svk" : "neo-hookean", (int)steps, residual, worst, fabs(stats.strain / all[i].energy - 1.0));
    assert_close(worst, 0.0, 1e-7, 1.0);
    assert_close(stats.strain, all[i].energy, 1e-7, all[i].energy);
    assert_petsc(TLEDDestroy(&tled));
  }
}

CHECK_MAIN(cmocka_unit_test(Cantilever_IsTheReference))
