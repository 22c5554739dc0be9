/* Reading gmsh files: what is read is what is in the file, and every way a mesh can be wrong is told with file, group and
   element. */
#include "unit/tled/cube.h"

static void Cube_IsReadAsWritten(void **state)
{
  static const int versions[2] = {22, 41};

  (void)state;
  for (int i = 0; i < 2; i++) {
    TLEDParams      *p;
    char            *path = Path("cube.msh");
    TLED             tled = Body(path, &p);
    const PetscInt  *tets, *tri, *nodes;
    const PetscReal *X, *mass;
    PetscInt         n_nodes, n_tets, n, all;
    PetscReal        total = 0.0, out[3] = {0.0, 0.0, 0.0}, flux = 0.0;

    WriteCube(path, versions[i], 0, 0, NULL);
    p->scale        = 2.0;
    p->translate[0] = 10.0;
    AddName(&p->wetted, "floor");
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetSize(tled, &n_nodes, &n_tets));
    assert_int_equal(n_nodes, 8);
    assert_int_equal(n_tets, 6);
    assert_petsc(TLEDGetMesh(tled, NULL, &tets, &X));
    assert_petsc(TLEDGetMass(tled, &mass));
    for (PetscInt a = 0; a < 8; a++) {
      total += mass[a];
      assert_true(X[3 * a] == 10.0 || X[3 * a] == 12.0);
    }
    assert_close(total, 8000.0, 1e-14, 8000.0);
    assert_petsc(TLEDGetSurface(tled, PETSC_FALSE, &all, &tri));
    assert_int_equal(all, 12);
    for (PetscInt t = 0; t < 12; t++) { /* outward: the area vectors add to zero, and sum x . A is three volumes */
      double a[3], b[3], area[3];
      for (int k = 0; k < 3; k++)
        a[k] = X[3 * tri[3 * t + 1] + k] - X[3 * tri[3 * t] + k], b[k] = X[3 * tri[3 * t + 2] + k] - X[3 * tri[3 * t] + k];
      area[0] = 0.5 * (a[1] * b[2] - a[2] * b[1]), area[1] = 0.5 * (a[2] * b[0] - a[0] * b[2]),
      area[2] = 0.5 * (a[0] * b[1] - a[1] * b[0]);
      for (int k = 0; k < 3; k++) out[k] += area[k], flux += X[3 * tri[3 * t] + k] * area[k];
    }
    for (int k = 0; k < 3; k++) assert_close(out[k], 0.0, 1e-14, 4.0);
    assert_close(flux, 24.0, 1e-13, 24.0);
    assert_petsc(TLEDGetSurface(tled, PETSC_TRUE, &n, &tri));
    assert_int_equal(n, 2);
    for (PetscInt k = 0; k < 6; k++) assert_true(X[3 * tri[k] + 2] == 0.0);
    assert_petsc(TLEDGetGroup(tled, "floor", &n, &nodes));
    assert_int_equal(n, 4);
    for (PetscInt k = 0; k < 4; k++) assert_true(X[3 * nodes[k] + 2] == 0.0);
    assert_petsc(TLEDGetGroup(tled, "solid", &n, NULL));
    assert_int_equal(n, 8);
    unlink(path);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* a cube of quadratic tetrahedra, in both formats, text and binary of both orders of bytes */
static void QuadraticCube_IsReadAsWritten(void **state)
{
  static const int edge[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}; /* VTK's order */

  (void)state;
  for (int i = 0; i < 6; i++) {
    const CubeFile   file = {i % 2 ? 22 : 41, i / 2, 0.0, 1};
    char            *path = Path("cube2.msh");
    TLEDParams      *p;
    TLED             tled = Body(path, &p);
    const PetscInt  *tets, *tri, *nodes;
    const PetscReal *X, *mass;
    PetscInt         n_nodes, n_tets, n_corners, n, all;
    PetscReal        total = 0.0, flux = 0.0;

    WriteCube2(path, &file);
    p->element = TLED_ELEMENT_AUTO;
    AddName(&p->wetted, "floor");
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetSize(tled, &n_nodes, &n_tets));
    assert_int_equal(n_nodes, 27);
    assert_int_equal(n_tets, 6);
    assert_petsc(TLEDGetMesh(tled, &n_corners, &tets, &X));
    assert_int_equal(n_corners, 10);
    for (PetscInt e = 0; e < 6; e++)
      for (int a = 0; a < 6; a++)
        for (int k = 0; k < 3; k++)
          assert_true(X[3 * tets[10 * e + 4 + a] + k] ==
                      0.5 * (X[3 * tets[10 * e + edge[a][0]] + k] + X[3 * tets[10 * e + edge[a][1]] + k]));
    assert_petsc(TLEDGetMass(tled, &mass));
    for (PetscInt a = 0; a < n_nodes; a++) total += mass[a];
    assert_close(total, 1000.0, 1e-14, 1000.0);
    assert_petsc(TLEDGetSurface(tled, PETSC_FALSE, &all, &tri));
    assert_int_equal(all, 48);
    for (PetscInt t = 0; t < all; t++) { /* three volumes, when every triangle looks outward */
      double a[3], b[3];
      for (int k = 0; k < 3; k++)
        a[k] = X[3 * tri[3 * t + 1] + k] - X[3 * tri[3 * t] + k], b[k] = X[3 * tri[3 * t + 2] + k] - X[3 * tri[3 * t] + k];
      flux += 0.5 * (X[3 * tri[3 * t]] * (a[1] * b[2] - a[2] * b[1]) + X[3 * tri[3 * t] + 1] * (a[2] * b[0] - a[0] * b[2]) +
                     X[3 * tri[3 * t] + 2] * (a[0] * b[1] - a[1] * b[0]));
    }
    assert_close(flux, 3.0, 1e-13, 3.0);
    assert_petsc(TLEDGetSurface(tled, PETSC_TRUE, &n, &tri));
    assert_int_equal(n, 8);
    for (PetscInt k = 0; k < 24; k++) assert_true(X[3 * tri[k] + 2] == 0.0);
    assert_petsc(TLEDGetGroup(tled, "floor", &n, &nodes)); /* with the edges' nodes */
    assert_int_equal(n, 9);
    for (PetscInt k = 0; k < 9; k++) assert_true(X[3 * nodes[k] + 2] == 0.0);
    unlink(path);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* an element is refused when a node of an edge turns it inside out at an integration point, and told with its number */
static void InvertedQuadraticElement_IsNamed(void **state)
{
  const CubeFile file = {22, 0, 0.9, 1};
  TLEDParams    *p;
  char          *path = Path("curved.msh");

  (void)state;
  WriteCube2(path, &file);
  REFUSED(Body(path, &p), "body.mesh", "an inverted element: number ", "a smallest Jacobian at its integration points of -",
          "of 6 elements are bad", "-optimize_ho");
  unlink(path);
}

static void ElementAndOrder_MustAgree(void **state)
{
  static const int elements[2] = {TLED_ELEMENT_T4, TLED_ELEMENT_ANP};
  const CubeFile   file = {41, 0, 0.0, 1};
  char            *path = Path("order.msh");
  TLEDParams      *p;
  TLED             tled;

  (void)state;
  WriteCube2(path, &file);
  for (int i = 0; i < 2; i++) {
    tled       = Body(path, &p);
    p->element = elements[i];
    REFUSED(tled, "body.element", "which is of second order", "expected t10 or auto");
  }
  WriteCube(path, 41, 0, 0, NULL);
  tled       = Body(path, &p);
  p->element = TLED_ELEMENT_T10;
  REFUSED(tled, "body.element", "which is of first order", "gmsh body.msh -3 -order 2");
  unlink(path);
}

static void MissingAndForeignFiles_AreRefused(void **state)
{
  TLEDParams *p;
  char       *path = Path("foreign.msh");
  FILE       *f;

  (void)state;
  REFUSED(Body("/nowhere/body.msh", &p), "body.mesh", "cannot be opened", "/nowhere/body.msh");
  f = fopen(path, "w");
  fprintf(f, "a letter, not a mesh\n");
  fclose(f);
  REFUSED(Body(path, &p), "body.mesh", "is not a gmsh mesh", "expected");
  f = fopen(path, "w");
  fprintf(f, "$MeshFormat\n1.0 0 8\n$EndMeshFormat\n");
  fclose(f);
  REFUSED(Body(path, &p), "body.mesh", "gmsh format 1", "expected format 4.1 or 2.2");
  f = fopen(path, "w");
  fclose(f);
  REFUSED(Body(path, &p), "is not a gmsh mesh");
  unlink(path);
}

/* a file cut anywhere is refused without a crash; cut within a section, with a reason */
static void TruncatedFile_IsRefused(void **state)
{
  static const int versions[2] = {22, 41};

  (void)state;
  for (int i = 0; i < 2; i++) {
    char *path = Path("cut.msh"), text[4096];
    FILE *f;
    long  size;

    WriteCube(path, versions[i], 0, 0, NULL);
    f    = fopen(path, "r");
    size = (long)fread(text, 1, sizeof text, f);
    fclose(f);
    for (long keep = size - 16; keep > 0; keep -= 23) {
      TLEDParams *p;
      f = fopen(path, "w");
      fwrite(text, 1, (size_t)keep, f);
      fclose(f);
      REFUSED(Body(path, &p), "body.mesh");
    }
    unlink(path);
  }
}

static void WrongKinds_AreRefused(void **state)
{
  TLEDParams *p;
  char       *path = Path("kind.msh");
  FILE       *f    = fopen(path, "w");

  (void)state;
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 1 1 1 2 "
             "3\n$EndElements\n");
  fclose(f);
  REFUSED(Body(path, &p), "is a mesh of the wrong kind", "no tetrahedra, 1 triangles", "solid_from_surface.py");
  f = fopen(path, "w");
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n");
  for (int k = 1; k <= 10; k++) fprintf(f, "%d %d %d %d\n", k, k, k * k, k * k * k);
  fprintf(f, "$EndNodes\n$Elements\n1\n1 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n");
  fclose(f);
  REFUSED(Body(path, &p), "holds an element of another kind: 8-node hexahedron", "expected a mesh of tetrahedra of first or second order");
  f = fopen(path, "w");
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n");
  for (int k = 1; k <= 10; k++) fprintf(f, "%d %d %d %d\n", k, k, k * k, k * k * k);
  fprintf(f, "$EndNodes\n$Elements\n2\n1 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n2 4 2 1 1 1 2 3 4\n$EndElements\n");
  fclose(f);
  REFUSED(Body(path, &p), "holds 1 tetrahedra of first order and 1 of second", "expected one order");
  unlink(path);
}

/* what would make a reader run out of its arrays: an element of a node that is not there, and more elements at a face than a body
 * has */
static void ImpossibleMesh_IsRefused(void **state)
{
  static const int versions[2] = {22, 41};
  TLEDParams      *p;
  char            *path = Path("impossible.msh"), text[4096], *at;
  FILE            *f;

  (void)state;
  for (int i = 0; i < 2; i++) {
    WriteCube(path, versions[i], 0, 0, NULL);
    f                                        = fopen(path, "r");
    text[fread(text, 1, sizeof text - 1, f)] = 0;
    fclose(f);
    at    = strstr(text, "1 4 8 7\n"); /* element 12 */
    at[2] = '9';
    f     = fopen(path, "w");
    fputs(text, f);
    fclose(f);
    REFUSED(Body(path, &p), "element 12 has node 9, which is not in the file");
    at[2] = '3', at[4] = '6'; /* a third tetrahedron on the face 1 3 7 */
    f = fopen(path, "w");
    fputs(text, f);
    fclose(f);
    REFUSED(Body(path, &p), "body.mesh", "elements");
  }
  unlink(path);
}

static void InvertedElement_IsNamed(void **state)
{
  static const int versions[2] = {22, 41};
  TLEDParams      *p;
  char            *path = Path("inverted.msh");

  (void)state;
  for (int i = 0; i < 2; i++) {
    WriteCube(path, versions[i], 1, 0, NULL);
    REFUSED(Body(path, &p), "body.mesh", "an inverted element: number 12", "volume -0.166667 m^3", "1 of 6 elements");
    WriteCube(path, versions[i], 2, 0, NULL);
    REFUSED(Body(path, &p), "an inverted element: number 10", "6 of 6 elements");
    WriteCube(path, versions[i], 0, 1, NULL);
    REFUSED(Body(path, &p), "element: number 1", "elements are bad");
  }
  unlink(path);
}

static void MissingGroup_IsNamedWithTheNearest(void **state)
{
  TLEDParams *p;
  TLED        tled;
  char       *path = Path("groups.msh");

  (void)state;
  WriteCube(path, 41, 0, 0, NULL);
  tled = Body(path, &p);
  AddName(&p->fixed, "flor");
  REFUSED(tled, "body.fixed", "names the group flor", "did you mean floor?", "floor (surface), solid (volume)");
  tled = Body(path, &p);
  AddName(&p->prescribed, "handle");
  REFUSED(tled, "body.prescribed", "names the group handle", "groups in the mesh");
  tled = Body(path, &p);
  AddName(&p->wetted, "solid");
  REFUSED(tled, "body.wetted", "names the group solid", "not a surface");
  tled = Body(path, &p);
  AddName(&p->fixed, "floor");
  AddName(&p->prescribed, "floor");
  p->prescribed_velocity[2] = 1.0;
  REFUSED(tled, "body.prescribed", "the group floor, of which node", "another motion by body.fixed");
  unlink(path);
}

/* the shipped meshes: size, groups, volume, and no sliver that would shorten the time step */
static void ShippedMeshes_AreGood(void **state)
{
  static const struct {
    const char *mesh, *held;
    int         n_min, n_max;
    double      volume;
  } meshes[] = {{"meshes/flap.msh", "root", 2700, 3400, 0.024 * 0.2 * 0.2},
                {"meshes/plate.msh", "root", 2000, 2700, 0.03 * 0.12 * 0.16},
                {"meshes/beam.msh", "clamp", 1500, 2200, 0.01},
                {"meshes/ball.msh", NULL, 2250, 2750, 4.0 / 3 * 3.14159265 * 0.08 * 0.08 * 0.08}};

  (void)state;
  for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
    TLEDParams *p;
    TLED        tled = NewBody(meshes[i].mesh, &p);
    TLEDStats   s;
    PetscInt    n_tets, n, all;
    PetscReal   dt;

    AddName(&p->wetted, "skin");
    if (meshes[i].held) AddName(&p->fixed, meshes[i].held);
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetSize(tled, NULL, &n_tets));
    assert_true(n_tets >= meshes[i].n_min && n_tets <= meshes[i].n_max);
    assert_petsc(TLEDGetStats(tled, &s));
    assert_close(s.volume, meshes[i].volume, meshes[i].held ? 1e-12 : 0.02, meshes[i].volume); /* facets cut off a ball */
    assert_petsc(TLEDGetSurface(tled, PETSC_TRUE, &n, NULL));
    assert_petsc(TLEDGetSurface(tled, PETSC_FALSE, &all, NULL));
    assert_true(meshes[i].held ? n < all && n > 0.8 * all : n == all);
    assert_petsc(TLEDGetCriticalStep(tled, &dt));
    /* against the time a pressure wave takes through an element of the mean volume: slivers would push it down */
    assert_true(dt > 0.4 * pow(12.0 * s.volume / n_tets, 1.0 / 3.0) / sqrt(3e6 * 0.7 / (1.3 * 0.4) / 1000.0));
    assert_petsc(TLEDDestroy(&tled));
  }
}

CHECK_MAIN(cmocka_unit_test(Cube_IsReadAsWritten), cmocka_unit_test(QuadraticCube_IsReadAsWritten),
           cmocka_unit_test(InvertedQuadraticElement_IsNamed), cmocka_unit_test(ElementAndOrder_MustAgree),
           cmocka_unit_test(MissingAndForeignFiles_AreRefused),
           cmocka_unit_test(TruncatedFile_IsRefused), cmocka_unit_test(WrongKinds_AreRefused),
           cmocka_unit_test(ImpossibleMesh_IsRefused), cmocka_unit_test(InvertedElement_IsNamed),
           cmocka_unit_test(MissingGroup_IsNamedWithTheNearest), cmocka_unit_test(ShippedMeshes_AreGood))
