/* Dynamic relaxation: the static solutions of an independent code and of Newton's method, whatever the element, material and load. */
#include "unit/tled/block.h"
#include "tled/tled_implicit.h"
#include "mat3.h"

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
  const Reference all[6] = {
      {"tests/meshes/beam_h1.msh", TLED_MATERIAL_NEO_HOOKEAN, 0.3,
       {-0.04142484237735666, -0.0009972955093733896, -0.2709548025632535}, 5.317299312167156},
      {"tests/meshes/beam_h1.msh", TLED_MATERIAL_NEO_HOOKEAN, 0.45,
       {-0.025593659167204127, -0.0013157307281949477, -0.21439682744396152}, 4.234257721621486},
      {"tests/meshes/beam_h1.msh", TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.3,
       {-0.042361426579887194, -0.0007976745029058303, -0.27165781027625807}, 5.341168338410373},
      {"tests/meshes/beam_h1.msh", TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.45,
       {-0.02631445146114603, -0.0011003582678427604, -0.21481358917485185}, 4.248196232583419},
      {"tests/meshes/beam_h2.msh", TLED_MATERIAL_NEO_HOOKEAN, 0.3,
       {-0.0699426402226059, -0.0012685459146781549, -0.345839747271417}, 6.569205761610543},
      {"tests/meshes/beam_h3.msh", TLED_MATERIAL_NEO_HOOKEAN, 0.3,
       {-0.08521933372527414, -6.998312134308357e-05, -0.3799918048993587}, 7.165240450128981}};

  (void)state;
  for (int i = 0; i < 6; i++) {
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
    printf("relax: %s nu %.2f %s: %d steps, residual %.2g, tip %.2g, energy %.2g\n", all[i].mesh, all[i].poisson,
           all[i].material ? "svk" : "neo-hookean", (int)steps, residual, worst, fabs(stats.strain / all[i].energy - 1.0));
    assert_close(worst, 0.0, 1e-7, 1.0);
    assert_close(stats.strain, all[i].energy, 1e-7, all[i].energy);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* what holds and loads the bar of the next tests */
typedef enum { WEIGHT, PRESSURE, TWIST, SQUEEZE } Case;
static const char *const case_name[] = {"bends under 30 g", "pressed by a follower", "twisted by 90 degrees", "squeezed and sheared"};

static TLED Bar(Case kind, int element, int material)
{
  const Block          block   = {.n = {8, 2, 2}, .size = {0.4, 0.1, 0.1}, .order = element == TLED_ELEMENT_T10 ? 2 : 1};
  const PetscReal      down[3] = {0.0, 0.0, -300.0};
  TLEDParams          *p;
  TLED                 tled = NewBlock(&block, &p);
  TLEDConstraintParams c;
  TLEDLoadParams       load;

  p->element          = element;
  p->elastic.material = material;
  if (element == TLED_ELEMENT_ANP) p->elastic.poisson = 0.49;
  if (material == TLED_MATERIAL_MOONEY_RIVLIN) p->elastic.young = 0.0, p->elastic.c10 = 3e5, p->elastic.c01 = 1e5;
  if (material == TLED_MATERIAL_TRANSVERSELY_ISOTROPIC) {
    p->elastic.fibre_stiffness = 2e6;
    p->elastic.fibre[0] = 1.0, p->elastic.fibre[1] = 0.5;
  }
  AddName(&p->fixed, "xmin");
  assert_petsc(KeysSetDefaults(TLEDConstraintKeys, &c));
  assert_petsc(KeysSetDefaults(TLEDLoadKeys, &load));
  c.kind = TLED_CONSTRAINT_MOTION;
  AddName(&c.groups, "xmax");
  c.course.kind = COURSE_LINEAR, c.course.duration = 1.0;
  c.point[1] = c.point[2] = 0.05, c.axis[0] = 1.0;
  if (kind == WEIGHT) assert_petsc(TLEDSetGravity(tled, down));
  if (kind == PRESSURE) {
    AddName(&load.groups, "zmax");
    load.pressure = 4e4;
    assert_petsc(TLEDAddLoad(tled, "water", &load));
  }
  if (kind == TWIST) c.angle = 90.0;
  if (kind == SQUEEZE) c.translation[0] = -0.04, c.translation[1] = 0.12;
  if (kind == TWIST || kind == SQUEEZE) assert_petsc(TLEDAddConstraint(tled, "crank", &c));
  assert_petsc(TLEDSetUp(tled));
  RemoveBlock(p);
  return tled;
}

/* largest nodal difference over the largest displacement */
static double Difference(TLED a, TLED b)
{
  Vec              u, w;
  const PetscReal *x, *y;
  PetscInt         n;
  double           worst = 0.0, top = 0.0;

  assert_petsc(TLEDGetSize(a, &n, NULL));
  assert_petsc(TLEDGetVectors(a, &u, NULL, NULL));
  assert_petsc(TLEDGetVectors(b, &w, NULL, NULL));
  assert_petsc(VecGetArrayRead(u, &x));
  assert_petsc(VecGetArrayRead(w, &y));
  for (PetscInt k = 0; k < n; k++) {
    worst = fmax(worst, hypot(hypot(x[3 * k] - y[3 * k], x[3 * k + 1] - y[3 * k + 1]), x[3 * k + 2] - y[3 * k + 2]));
    top   = fmax(top, hypot(hypot(y[3 * k], y[3 * k + 1]), y[3 * k + 2]));
  }
  assert_petsc(VecRestoreArrayRead(u, &x));
  assert_petsc(VecRestoreArrayRead(w, &y));
  return worst / top;
}

static void Compare(Case kind, int element, int material)
{
  static const char *const elements[]  = {"auto", "t4", "anp", "t10"};
  static const char *const materials[] = {"neo-Hookean", "St Venant-Kirchhoff", "neo-Hookean iso", "Mooney-Rivlin", "fibres"};
  TLED                     relaxed = Bar(kind, element, material), solved = Bar(kind, element, material);
  TLEDImplicit             implicit;
  PetscReal                residual, force[2][3] = {{0.0}}, moment[3];
  PetscInt                 steps;
  double                   difference;
  PetscErrorCode           ierr;

  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, solved, &implicit));
  assert_petsc(TLEDImplicitSolveStatic(implicit, 1.0));
  ierr = TLEDRelax(relaxed, 1.0, 1e-7, 100000, &steps, &residual);
  if (ierr) {
    const char *message;
    assert_petsc(TLEDGetBreakdown(relaxed, &message));
    printf("%s\n", message);
  }
  difference = Difference(relaxed, solved);
  printf("relax: %s %s %s: %d steps, residual %.2g, largest difference to the implicit one %.2g\n", case_name[kind],
         elements[element], materials[material], (int)steps, residual, difference);
  assert_petsc(ierr);
  assert_close(difference, 0.0, 1e-6, 1.0);
  assert_petsc(TLEDGetReaction(relaxed, "xmin", force[0], moment));
  assert_petsc(TLEDGetReaction(solved, "xmin", force[1], moment));
  for (int k = 0; k < 3; k++) assert_close(force[0][k], force[1][k], 1e-5, fmax(1.0, Norm3(force[1])));
  assert_petsc(TLEDImplicitDestroy(&implicit));
  assert_petsc(TLEDDestroy(&relaxed));
  assert_petsc(TLEDDestroy(&solved));
}

static void EveryElement_IsTheImplicitOne(void **state)
{
  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_T10; element++)
    for (int kind = WEIGHT; kind <= SQUEEZE; kind++) Compare((Case)kind, element, TLED_MATERIAL_NEO_HOOKEAN);
}

static void EveryMaterial_IsTheImplicitOne(void **state)
{
  (void)state;
  for (int material = TLED_MATERIAL_ST_VENANT_KIRCHHOFF; material <= TLED_MATERIAL_TRANSVERSELY_ISOTROPIC; material++) {
    Compare(WEIGHT, TLED_ELEMENT_ANP, material);
    Compare(TWIST, TLED_ELEMENT_T4, material);
  }
}

/* A block pressed on a plane by its weight, its sides on planes of symmetry: the plane carries it, and the state is the implicit one. */
static void Contact_CarriesTheWeight(void **state)
{
  const Block     block = {.n = {3, 3, 3}, .size = {0.3, 0.3, 0.3}, .order = 1};
  const PetscReal down[3] = {0.0, 0.0, -50.0}, point[3] = {0.0, 0.0, -0.01}, up[3] = {0.0, 0.0, 1.0};
  TLED            body[2];
  TLEDImplicit    implicit;
  PetscReal       residual;
  PetscInt        steps;
  double          difference;

  (void)state;
  for (int i = 0; i < 2; i++) {
    TLEDParams          *p;
    TLEDConstraintParams c;
    body[i] = NewBlock(&block, &p);
    for (int k = 0; k < 2; k++) {
      assert_petsc(KeysSetDefaults(TLEDConstraintKeys, &c));
      c.kind = TLED_CONSTRAINT_SYMMETRY;
      AddName(&c.groups, k ? "ymin" : "xmin");
      assert_petsc(TLEDAddConstraint(body[i], k ? "left" : "back", &c));
    }
    assert_petsc(TLEDSetGravity(body[i], down));
    assert_petsc(TLEDAddContactPlane(body[i], "floor", point, up));
    assert_petsc(TLEDSetUp(body[i]));
    RemoveBlock(p);
  }
  assert_petsc(TLEDRelax(body[0], 0.0, 1e-7, 100000, &steps, &residual));
  {
    const PetscReal *u;
    PetscReal       *w;
    Vec              from, to;
    /* a block that hangs in the air has no stiffness for Newton's method: it begins near the answer */
    assert_petsc(TLEDGetVectors(body[0], &from, NULL, NULL));
    assert_petsc(TLEDGetVectors(body[1], &to, NULL, NULL));
    assert_petsc(VecGetArrayRead(from, &u));
    assert_petsc(VecGetArray(to, &w));
    for (PetscInt k = 0; k < 3 * 64; k++) w[k] = k % 3 == 2 ? 1.001 * u[k] : 0.999 * u[k];
    assert_petsc(VecRestoreArrayRead(from, &u));
    assert_petsc(VecRestoreArray(to, &w));
  }
  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, body[1], &implicit));
  assert_petsc(TLEDImplicitSolveStatic(implicit, 0.0));
  difference = Difference(body[0], body[1]);
  printf("relax: block on a plane: %d steps, residual %.2g, largest difference to the implicit one %.2g\n", (int)steps, residual,
         difference);
  assert_close(difference, 0.0, 1e-6, 1.0);
  assert_petsc(TLEDImplicitDestroy(&implicit));
  for (int i = 0; i < 2; i++) assert_petsc(TLEDDestroy(&body[i]));
}

/* what is asked of too few steps is told */
static void TooFewSteps_AreReported(void **state)
{
  TLED        tled = Bar(WEIGHT, TLED_ELEMENT_T4, TLED_MATERIAL_NEO_HOOKEAN);
  const char *message;
  PetscInt    steps;

  (void)state;
  assert_int_equal((int)TLEDRelax(tled, 1.0, 1e-7, 100, &steps, NULL), (int)BY_ERR_BREAKDOWN);
  assert_int_equal(steps, 100);
  assert_petsc(TLEDGetBreakdown(tled, &message));
  assert_non_null(strstr(message, "body body: not at rest at time 1"));
  assert_non_null(strstr(message, " s after 100 steps of dynamic relaxation: residual "));
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(Cantilever_IsTheReference), cmocka_unit_test(EveryElement_IsTheImplicitOne),
           cmocka_unit_test(EveryMaterial_IsTheImplicitOne), cmocka_unit_test(Contact_CarriesTheWeight),
           cmocka_unit_test(TooFewSteps_AreReported))
