/* Materials of a body: several by physical volume, fibres from the mesh file, and what the user is told when parameters do not fit. */
#include "unit/tled/cube.h"

#define N_CELLS 12 /* of the bar, of which the first N_LEFT belong to the volume "left" */
#define N_LEFT  5

/* A bar of N_CELLS unit cubes along x, each cut into six tetrahedra that fit those of its neighbours, in two volumes; `twice` lists the
   first cell's elements in both. Format 2.2. */
static void WriteBar(const char path[], int twice)
{
  static const int tets[6][4] = {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}};
  FILE            *f          = fopen(path, "w");
  const int        n_tets     = 6 * N_CELLS;

  assert_non_null(f);
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"left\"\n3 2 \"right\"\n$EndPhysicalNames\n$Nodes\n%d\n", 4 * (N_CELLS + 1));
  for (int i = 0; i <= N_CELLS; i++)
    for (int k = 0; k < 4; k++) fprintf(f, "%d %d %d %d\n", 4 * i + k + 1, i, k % 2, k / 2);
  fprintf(f, "$EndNodes\n$Elements\n%d\n", n_tets + (twice ? 6 : 0));
  for (int e = 0; e < n_tets + (twice ? 6 : 0); e++) {
    const int i = e % n_tets / 6;
    fprintf(f, "%d 4 2 %d %d", e + 1, e < n_tets && i < N_LEFT ? 1 : 2, e < n_tets && i < N_LEFT ? 1 : 2);
    for (int a = 0; a < 4; a++) {
      const int c = tets[e % 6][a]; /* bits: x, y, z */
      fprintf(f, " %d", 4 * (i + c % 2) + c / 2 + 1);
    }
    fprintf(f, "\n");
  }
  fprintf(f, "$EndElements\n");
  assert_int_equal(fclose(f), 0);
}

static PetscReal left_stretch, right_stretch;

static void Stretched(const PetscReal X[3], PetscReal u[3])
{
  u[0] = X[0] < N_LEFT ? (left_stretch - 1) * X[0] : (left_stretch - 1) * N_LEFT + (right_stretch - 1) * (X[0] - N_LEFT);
  u[1] = u[2] = 0.0;
}

/* Two layers in series without lateral contraction (nu 0): both carry the same force A mu (s - 1/s) at their stretches s. The exact deformation is
   linear in each layer, so the elements have it: inner nodes are in balance, the ends feel that force. A contrast of 1e6 as well. */
static void Layers_CarryTheSameForce(void **state)
{
  (void)state;
  for (int i = 0; i < 3; i++) {
    static const PetscReal contrast[3] = {1.0, 7.0, 1e6};
    TLEDParams        *p;
    char              *path = Path("bar.msh");
    TLED               tled = Body(path, &p);
    TLEDMaterialParams right;
    const PetscReal   *X, *f, *mass;
    const PetscInt    *nodes;
    PetscInt           n, n_right;
    PetscReal          end[2] = {0.0, 0.0}, total = 0.0;
    const PetscReal    mu     = 1e6;
    TLEDStats          stats;
    Vec                u, force;

    WriteBar(path, 0);
    p->elastic.young   = 2.0 * mu;
    p->elastic.poisson = 0.0;
    right              = p->elastic;
    right.young *= contrast[i];
    right.density = 3000.0;
    AddName(&right.volumes, "right");
    assert_petsc(TLEDAddMaterial(tled, "stiff", &right));
    assert_petsc(TLEDSetUp(tled));
    left_stretch           = 1.4;
    const PetscReal pull   = mu * (1.4 - 1.0 / 1.4), r = pull / (2.0 * mu * contrast[i]);
    right_stretch          = r + sqrt(r * r + 1.0); /* root of s - 1/s = 2 r */
    assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
    assert_petsc(VecDuplicate(u, &force));
    SetVec(tled, u, Stretched);
    assert_petsc(TLEDInternalForce(tled, u, force));
    assert_petsc(TLEDGetSize(tled, &n, NULL));
    assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
    assert_petsc(TLEDGetMass(tled, &mass));
    assert_petsc(VecGetArrayRead(force, &f));
    for (PetscInt a = 0; a < n; a++) {
      total += mass[a];
      for (int k = 0; k < 3; k++) {
        if (X[3 * a] > 0.0 && X[3 * a] < N_CELLS) assert_close(f[3 * a + k], 0.0, 1e-14, mu * contrast[i]); /* round-off of the stiff layer */
        else if (k == 0) end[X[3 * a] > 0.0] += f[3 * a];
      }
    }
    assert_petsc(VecRestoreArrayRead(force, &f));
    assert_close(end[0], -pull, 1e-14, mu);
    assert_close(end[1], pull, 1e-14, mu * contrast[i]);
    assert_close(total, 1000.0 * N_LEFT + 3000.0 * (N_CELLS - N_LEFT), 1e-14, 1e4);
    assert_petsc(TLEDGetStats(tled, &stats));
    const PetscReal W[2] = {0.5 * mu * (1.4 * 1.4 - 1.0) - mu * log(1.4),
                            contrast[i] * mu * (0.5 * (right_stretch * right_stretch - 1.0) - log(right_stretch))};
    assert_close(stats.strain, N_LEFT * W[0] + (N_CELLS - N_LEFT) * W[1], 1e-9, stats.strain); /* W[1] here loses digits, as s^2 - 1 */
    assert_petsc(TLEDGetGroup(tled, "right", &n_right, &nodes));
    assert_int_equal(n_right, 4 * (N_CELLS - N_LEFT + 1));
    assert_petsc(VecDestroy(&force));
    assert_petsc(TLEDDestroy(&tled));
    unlink(path);
  }
}

static void WrongMaterials_AreToldWithTheirKey(void **state)
{
  TLEDParams        *p;
  TLEDMaterialParams m;
  TLED               tled;
  char              *path = Path("wrong.msh");

  (void)state;
  WriteBar(path, 0);
#define BODY() (tled = Body(path, &p), m = p->elastic)
  BODY(), p->elastic.young = 0.0;
  REFUSED(tled, "body.young", "is missing", "Young's modulus");
  BODY(), p->elastic.material = TLED_MATERIAL_MOONEY_RIVLIN;
  REFUSED(tled, "body.young", "is given", "c10 and c01");
  BODY(), p->elastic.material = TLED_MATERIAL_MOONEY_RIVLIN, p->elastic.young = 0.0;
  REFUSED(tled, "body.c10", "is missing");
  BODY(), p->elastic.material = TLED_MATERIAL_MOONEY_RIVLIN, p->elastic.young = 0.0, p->elastic.c10 = 1e5, p->elastic.c01 = -2e5;
  REFUSED(tled, "body.c10", "-100000 Pa", "sum > 0");
  BODY(), p->elastic.c01 = 1e5;
  REFUSED(tled, "body.c01", "mooney_rivlin");
  BODY(), p->elastic.bulk = 1e5;
  REFUSED(tled, "body.bulk", "neo_hookean_iso");
  BODY(), p->elastic.fibre[1] = 1.0;
  REFUSED(tled, "body.fibre", "transversely_isotropic");
  BODY(), p->elastic.material = TLED_MATERIAL_TRANSVERSELY_ISOTROPIC;
  REFUSED(tled, "body.fibre_stiffness", "is missing");
  BODY(), p->elastic.material = TLED_MATERIAL_TRANSVERSELY_ISOTROPIC, p->elastic.fibre_stiffness = 1e6;
  REFUSED(tled, "body.fibre", "is missing", "not zero");
  BODY(), p->elastic.prony_alpha.n = 2, p->elastic.prony_tau.n = 1;
  REFUSED(tled, "body.prony_tau", "1 numbers", "prony_alpha has 2");
  BODY(), p->elastic.prony_alpha.n = p->elastic.prony_tau.n = 2;
  for (int i = 0; i < 2; i++) p->elastic.prony_alpha.value[i] = 0.5, p->elastic.prony_tau.value[i] = 1.0;
  REFUSED(tled, "body.prony_alpha", "adds up to 1", "sum < 1");
  BODY(), p->elastic.prony_alpha.n = p->elastic.prony_tau.n = 9;
  for (int i = 0; i < 9; i++) p->elastic.prony_alpha.value[i] = 0.1, p->elastic.prony_tau.value[i] = 1.0;
  REFUSED(tled, "body.prony_tau", "at most 8");
  BODY(), AddName(&m.volumes, "rigth");
  assert_petsc(TLEDAddMaterial(tled, "core", &m));
  REFUSED(tled, "body.core.volumes", "rigth", "did you mean right?");
  BODY();
  assert_petsc(TLEDAddMaterial(tled, "core", &m));
  REFUSED(tled, "body.core.volumes", "is missing");
  BODY(), AddName(&m.volumes, "right");
  assert_petsc(TLEDAddMaterial(tled, "core", &m));
  m.young = 1.0;
  assert_petsc(TLEDAddMaterial(tled, "skin", &m));
  REFUSED(tled, "body.skin.volumes", "also in a volume of body.core", "one material");
  BODY(), AddName(&m.volumes, "right"), m.young = 0.0;
  assert_petsc(TLEDAddMaterial(tled, "core", &m));
  REFUSED(tled, "body.core.young", "is missing");
  unlink(path);
}

/* options of a scene: the body's own material and one more section */
static void Materials_ComeFromOptions(void **state)
{
  TLEDParams *p;
  char       *path = Path("options.msh"), option[600];
  TLED        tled = Body(path, &p);
  PetscReal   total = 0.0;
  PetscInt    n;
  const PetscReal *mass;

  (void)state;
  WriteBar(path, 0);
  snprintf(option, sizeof option, "-body_mesh %s -body_young 1e6 -body_density 500 -body_materials core -body_core_volumes right "
                                  "-body_core_material mooney_rivlin -body_core_c10 3e5 -body_core_c01 1e5 -body_core_density 2000", path);
  assert_petsc(PetscOptionsInsertString(NULL, option));
  assert_petsc(TLEDSetFromOptions(tled));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMass(tled, &mass));
  for (PetscInt a = 0; a < n; a++) total += mass[a];
  assert_close(total, 500.0 * N_LEFT + 2000.0 * (N_CELLS - N_LEFT), 1e-14, 1e4);
  assert_petsc(TLEDDestroy(&tled));
  assert_petsc(PetscOptionsClear(NULL));
  unlink(path);
}

static void Sheared(const PetscReal X[3], PetscReal u[3])
{
  u[0] = 0.1 * X[1] + 0.05 * X[2] * X[0];
  u[1] = -0.08 * X[0];
  u[2] = 0.12 * X[0] * X[1];
}

/* internal force of the cube with fibres along [1, 2, -2] of any length, as constant or as field */
static void FibreForce(int version, const char view[], const char field[], PetscReal f[24])
{
  TLEDParams      *p;
  char            *path = Path("fibres.msh");
  TLED             tled = Body(path, &p);
  Vec              u, force;
  const PetscReal *array;

  WriteCube(path, version, 0, 0, view);
  p->elastic.material        = TLED_MATERIAL_TRANSVERSELY_ISOTROPIC;
  p->elastic.fibre_stiffness = 5e6;
  if (field) snprintf(p->elastic.fibre_field, sizeof p->elastic.fibre_field, "%s", field);
  else p->elastic.fibre[0] = 1.0, p->elastic.fibre[1] = 2.0, p->elastic.fibre[2] = -2.0;
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
  assert_petsc(VecDuplicate(u, &force));
  SetVec(tled, u, Sheared);
  assert_petsc(TLEDInternalForce(tled, u, force));
  assert_petsc(VecGetArrayRead(force, &array));
  for (int k = 0; k < 24; k++) f[k] = array[k];
  assert_petsc(VecRestoreArrayRead(force, &array));
  assert_petsc(VecDestroy(&force));
  assert_petsc(TLEDDestroy(&tled));
  unlink(path);
}

#define VIEW(name, components, values) "$ElementData\n1\n\"" name "\"\n1\n0.0\n3\n0\n" components "\n6\n" values "$EndElementData\n"

/* element numbers are 10 to 15 */
static void Fibres_ComeFromTheMesh(void **state)
{
  static const char other[] = VIEW("strength", "1", "10 1\n11 1\n12 1\n13 1\n14 1\n15 1\n");
  static const char views[] = VIEW("strength", "1", "10 1\n11 1\n12 1\n13 1\n14 1\n15 1\n")
      VIEW("muscle", "3", "15 1 2 -2\n10 1 2 -2\n11 0.5 1 -1\n12 2 4 -4\n13 -1 -2 2\n14 1e-3 2e-3 -2e-3\n");
  static const char turned[] = VIEW("muscle", "3", "15 1 2 -2\n10 1 2 -2\n11 0.5 1 -1\n12 2 4 4\n13 1 2 -2\n14 1e-3 2e-3 -2e-3\n");
  static const char gap[]   = VIEW("muscle", "3", "10 1 2 -2\n11 1 2 -2\n12 0 0 0\n13 1 0 0\n14 1 0 0\n15 1 0 0\n");
  static const char broken[] = VIEW("muscle", "3", "10 1 2 -2\n11 1 2\n12 0 0 1\n13 1 0 0\n14 1 0 0\n15 1 0 0\n");
  static const struct {
    const char *view, *words[3];
  } wrong[4] = {{other, {"does not have", "\"strength\"", "muscle"}},
                {gap, {"no direction for element 12", "muscle", "not zero"}},
                {broken, {"is broken", "three finite numbers", ""}},
                {VIEW("muscle", "1", "10 1\n"), {"1 numbers an element", "vectors", ""}}};
  PetscReal constant[24], field[24], other_way[24];

  (void)state;
  for (int version = 22; version <= 41; version += 19) {
    PetscReal change = 0.0;
    FibreForce(version, NULL, NULL, constant);
    FibreForce(version, views, "muscle", field);
    FibreForce(version, turned, "muscle", other_way);
    for (int k = 0; k < 24; k++) assert_close(field[k], constant[k], 1e-14, 1e6);
    for (int k = 0; k < 24; k++) change = fmax(change, fabs(other_way[k] - constant[k]));
    assert_true(change > 1e4);
    for (int i = 0; i < 4; i++) {
      TLEDParams *p;
      char       *path = Path("fibres.msh");
      TLED        tled = Body(path, &p);
      WriteCube(path, version, 0, 0, wrong[i].view);
      p->elastic.material        = TLED_MATERIAL_TRANSVERSELY_ISOTROPIC;
      p->elastic.fibre_stiffness = 5e6;
      snprintf(p->elastic.fibre_field, sizeof p->elastic.fibre_field, "muscle");
      REFUSED(tled, "body.fibre_field", wrong[i].words[0], wrong[i].words[1], wrong[i].words[2]);
      unlink(path);
    }
  }
}

CHECK_MAIN(cmocka_unit_test(Layers_CarryTheSameForce), cmocka_unit_test(WrongMaterials_AreToldWithTheirKey),
           cmocka_unit_test(Materials_ComeFromOptions), cmocka_unit_test(Fibres_ComeFromTheMesh))
