/* Bodies of ten-node tetrahedra: patch test, rigid motion, gradient of the energy, tangent and its rank, time; with both quadrature
   rules, straight and curved elements. */
#include "unit/tled/cube.h"
#include "unit/tled/forces.h"
#include <omp.h>
#include <petscblaslapack.h>

/* a unit cube of six quadratic tetrahedra */
static TLED Cube(int law, int quadrature, double curved)
{
  const CubeFile file = {41, 0, curved, 1};
  char           path[64];
  TLEDParams    *p;
  TLED           tled = NewBody("", &p);

  snprintf(path, sizeof path, "/tmp/byssus_test_t10_%d.msh", (int)getpid());
  WriteCube2(path, &file);
  snprintf(p->mesh, sizeof p->mesh, "%s", path);
  p->element    = TLED_ELEMENT_AUTO;
  p->quadrature = quadrature;
  ReferenceMaterial(law, &p->elastic);
  assert_petsc(TLEDSetUp(tled));
  unlink(path);
  return tled;
}

static void PatchTest_GivesTheUniformStress(void **state)
{
  (void)state;
  for (int k = 0; k < 2 * TLED_LAWS; k++) {
    TLED tled = Cube(k / 2, k & 1, 0.0);
    CheckPatch(tled, k / 2);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* The same on curved elements: the only node within the cube is in balance with 14 points, which integrate cof J dN exactly (degree
   3), and nearly so with 4. */
static void CurvedPatch_IsInBalance(void **state)
{
  static const double allowed[2] = {2e-4, ROUND};
  static const double F[9] = {1.2, 0.1, 0.0, 0.05, 0.9, -0.1, 0.0, 0.2, 1.1};

  (void)state;
  map = F;
  for (int rule = 0; rule < 2; rule++) {
    TLED             tled = Cube(TLED_MATERIAL_NEO_HOOKEAN, rule, 0.05);
    const PetscReal *X, *f;
    PetscInt         n, n_inside = 0;
    Vec              u, force;

    assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
    assert_petsc(VecDuplicate(u, &force));
    assert_petsc(TLEDGetSize(tled, &n, NULL));
    assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
    SetVec(tled, u, Affine);
    assert_petsc(TLEDInternalForce(tled, u, force));
    assert_petsc(VecGetArrayRead(force, &f));
    for (PetscInt a = 0; a < n; a++) {
      if (fabs(X[3 * a] - 0.5) > 0.1 || fabs(X[3 * a + 1] - 0.5) > 0.1 || fabs(X[3 * a + 2] - 0.5) > 0.1) continue;
      n_inside++;
      for (int k = 0; k < 3; k++) assert_close(f[3 * a + k], 0.0, allowed[rule], 1e6);
      if (rule == 0) assert_true(fabs(f[3 * a]) + fabs(f[3 * a + 1]) + fabs(f[3 * a + 2]) > ROUND * 1e6); /* why 14 is offered */
    }
    assert_int_equal(n_inside, 1);
    assert_petsc(VecRestoreArrayRead(force, &f));
    assert_petsc(VecDestroy(&force));
    assert_petsc(TLEDDestroy(&tled));
  }
}

static void RigidMotion_GivesNoForce(void **state)
{
  (void)state;
  for (int k = 0; k < 4 * TLED_LAWS; k++) {
    TLED tled = Cube(k / 4, k & 1, k & 2 ? 0.05 : 0.0);
    CheckRigidMotion(tled);
    assert_petsc(TLEDDestroy(&tled));
  }
}

static void ForceAndTangent_AreDerivatives(void **state)
{
  (void)state;
  for (int k = 0; k < 4 * TLED_LAWS; k++) {
    TLED tled = Cube(k / 4, k & 1, k & 2 ? 0.05 : 0.0);
    CheckDerivatives(tled);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* one element: 30 freedoms, six rigid motions, no mechanism: 24 eigenvalues are positive, with four points too */
static void Stiffness_HasRank24(void **state)
{
  (void)state;
  for (int rule = 0; rule < 2; rule++) {
    TLEDParams  *p;
    TLED         tled = NewBody("", &p);
    char         path[64];
    FILE        *f;
    Vec          u;
    Mat          K = NULL;
    PetscScalar  A[900], values[30], work[256];
    PetscInt     all[30];
    PetscBLASInt n = 30, n_work = 256, info;

    snprintf(path, sizeof path, "/tmp/byssus_test_t10_one_%d.msh", (int)getpid());
    f = fopen(path, "w");
    fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 .5 0 0\n6 .5 .5 0\n7 0 .5 0\n"
               "8 0 0 .5\n9 0 .5 .5\n10 .5 0 .5\n$EndNodes\n$Elements\n1\n1 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n");
    fclose(f);
    snprintf(p->mesh, sizeof p->mesh, "%s", path);
    p->element    = TLED_ELEMENT_T10;
    p->quadrature = rule;
    assert_petsc(TLEDSetUp(tled));
    unlink(path);
    assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
    assert_petsc(TLEDTangent(tled, u, &K));
    for (PetscInt k = 0; k < 30; k++) all[k] = k;
    assert_petsc(MatGetValues(K, 30, all, 30, all, A));
    LAPACKsyev_("N", "U", &n, A, &n, values, work, &n_work, &info);
    assert_int_equal(info, 0);
    for (int k = 0; k < 6; k++) assert_close(values[k], 0.0, 1e-13, values[29]);
    assert_true(values[6] > 1e-3 * values[29]); /* measured: 0.004 and 0.005 of the largest */
    assert_petsc(MatDestroy(&K));
    assert_petsc(TLEDDestroy(&tled));
  }
}

static TLED Beam(TLEDParams **p)
{
  const PetscReal g[3] = {0.0, 0.0, -9.81};
  TLED            tled = NewBody("tests/meshes/beam_h1_order2.msh", p);

  (*p)->element = TLED_ELEMENT_AUTO;
  AddName(&(*p)->fixed, "clamp");
  assert_petsc(TLEDSetGravity(tled, g));
  return tled;
}

/* released under gravity the energy stays what it was: the step from the power iteration is stable */
static void Release_KeepsItsEnergy(void **state)
{
  TLEDParams *p;
  TLED        tled = Beam(&p);
  TLEDStats   s;
  PetscReal   critical;

  (void)state;
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetCriticalStep(tled, &critical));
  assert_true(critical > 1e-5 && critical < 1e-3);
  assert_petsc(TLEDAdvance(tled, 0.05, NULL));
  assert_petsc(TLEDGetStats(tled, &s));
  assert_true(s.kinetic > 0.1);
  assert_close(s.kinetic + s.strain + s.gravity_potential, 0.0, 1e-3, s.kinetic); /* dt^2 of the highest modes that gravity excites */
  assert_petsc(TLEDDestroy(&tled));
}

/* enough elements that three threads share them */
static void Results_DoNotDependOnThreads(void **state)
{
  const CubeFile file  = {22, 1, 0.0, 8};
  const int      most  = omp_get_max_threads();
  PetscReal     *first = NULL;
  PetscInt       n;
  char           path[64];

  (void)state;
  snprintf(path, sizeof path, "/tmp/byssus_test_t10_threads_%d.msh", (int)getpid());
  WriteCube2(path, &file);
  for (int threads = 1; threads <= 3; threads++) {
    TLEDParams *p;
    TLED        tled = NewBody("", &p);
    PetscReal  *f;
    Vec         u, force;

    omp_set_num_threads(threads);
    snprintf(p->mesh, sizeof p->mesh, "%s", path);
    p->element = TLED_ELEMENT_T10;
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetSize(tled, &n, NULL));
    assert_petsc(TLEDGetVectors(tled, &u, NULL, &force));
    SetVec(tled, u, Wavy);
    assert_petsc(TLEDInternalForce(tled, u, force));
    assert_petsc(VecGetArray(force, &f));
    if (!first) {
      first = malloc(3 * (size_t)n * sizeof *first);
      memcpy(first, f, 3 * (size_t)n * sizeof *first);
    } else assert_memory_equal(first, f, 3 * (size_t)n * sizeof *first);
    assert_petsc(VecRestoreArray(force, &f));
    assert_petsc(TLEDDestroy(&tled));
  }
  omp_set_num_threads(most);
  unlink(path);
  free(first);
}

/* an edge's node pulled through the element: det F < 0 at an integration point, though the vertices have not moved */
static void InvertedElement_IsReported(void **state)
{
  TLED             tled = Cube(TLED_MATERIAL_NEO_HOOKEAN, TLED_QUADRATURE_4, 0.0);
  const PetscReal *X;
  PetscReal       *u;
  PetscInt         n;
  Vec              U, f;
  const char      *message;

  (void)state;
  assert_petsc(TLEDGetVectors(tled, &U, NULL, NULL));
  assert_petsc(VecDuplicate(U, &f));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(VecGetArray(U, &u));
  u[3 * NodeAt(tled, 0.5, 0.5, 0.5)] = 0.9;
  assert_petsc(VecRestoreArray(U, &u));
  assert_int_equal((int)TLEDInternalForce(tled, U, f), (int)BY_ERR_BREAKDOWN);
  assert_petsc(TLEDGetBreakdown(tled, &message));
  assert_non_null(strstr(message, "element "));
  assert_non_null(strstr(message, "turned inside out"));
  assert_petsc(VecDestroy(&f));
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(PatchTest_GivesTheUniformStress), cmocka_unit_test(CurvedPatch_IsInBalance),
           cmocka_unit_test(RigidMotion_GivesNoForce), cmocka_unit_test(ForceAndTangent_AreDerivatives),
           cmocka_unit_test(Stiffness_HasRank24), cmocka_unit_test(Release_KeepsItsEnergy),
           cmocka_unit_test(Results_DoNotDependOnThreads), cmocka_unit_test(InvertedElement_IsReported))
