/* Loads: net force and moment, exactness, stiffness, courses, work. */
#include "unit/tled/body.h"
#include "tled/tled_impl.h"
#include "tled/tled_load.h"

#define ROUND 1e-12 /* sums of a few thousand terms in double precision */

static TLEDLoadParams Load(const char group[])
{
  TLEDLoadParams p;

  assert_petsc(KeysSetDefaults(TLEDLoadKeys, &p));
  if (group) AddName(&p.groups, group);
  return p;
}

/* numbers between -1/2 and 1/2, the same on every machine */
static double Noise(void)
{
  static unsigned seed = 1u;

  seed = 1664525u * seed + 1013904223u;
  return (double)(seed >> 8) / 16777216.0 - 0.5;
}

/* the external forces at a displacement, and their sum and moment about the origin at the places there */
static PetscReal *Forces(TLED tled, double t, const PetscReal u[], double sum[3], double moment[3])
{
  const PetscReal *X;
  PetscReal       *f;
  PetscInt         n;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(PetscMalloc1(3 * n, &f));
  assert_petsc(TLEDExternalForces_Private(tled, t, u, f));
  for (int k = 0; k < 3; k++) sum[k] = moment[k] = 0.0;
  for (PetscInt a = 0; a < n; a++) {
    double x[3], m[3];
    for (int k = 0; k < 3; k++) x[k] = X[3 * a + k] + u[3 * a + k], sum[k] += f[3 * a + k];
    Cross3(x, &f[3 * a], m);
    for (int k = 0; k < 3; k++) moment[k] += m[k];
  }
  return f;
}

static PetscReal *Displaced(TLED tled, double size)
{
  PetscReal *u;
  PetscInt   n;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(PetscMalloc1(3 * n, &u));
  for (PetscInt k = 0; k < 3 * n; k++) u[k] = size * Noise();
  return u;
}

/* a pressure on a closed surface of any shape gives no force and no moment; on the dome of half a ball it gives p times the area of
   its base, whatever the dome is bent to: to rounding, since the integrals are exact */
static void Pressure_ObeysTheDivergenceTheorem(void **state)
{
  (void)state;
  for (int closed = 0; closed < 2; closed++) {
    TLEDParams    *p;
    TLED           tled = NewBody("tests/meshes/half_ball.msh", &p);
    TLEDLoadParams load = Load("dome");
    double         sum[3], moment[3], area[3] = {0.0, 0.0, 0.0};
    PetscReal     *u, *f;
    const TLEDGroup *base;

    if (closed) AddName(&load.groups, "base");
    load.pressure = 1e5;
    assert_petsc(TLEDAddLoad(tled, "push", &load));
    assert_petsc(TLEDSetUp(tled));
    u = Displaced(tled, 0.01);
    f = Forces(tled, 0.0, u, sum, moment);
    assert_petsc(TLEDMeshFindGroup_Private(&tled->mesh, "base", &base));
    for (PetscInt i = 0; i < base->n_triangles; i++) {
      const PetscInt *v = &tled->mesh.triangles[3 * base->triangles[i]];
      double          x[3][3], e1[3], e2[3], n[3];
      for (int k = 0; k < 9; k++) x[k / 3][k % 3] = tled->mesh.X[3 * v[k / 3] + k % 3] + u[3 * v[k / 3] + k % 3];
      Sub3(x[1], x[0], e1), Sub3(x[2], x[0], e2), Cross3(e1, e2, n);
      for (int k = 0; k < 3; k++) area[k] += 0.5 * n[k];
    }
    assert_close(area[2], -PETSC_PI * 0.0025, 0.3, 0.0025 * PETSC_PI); /* the base is where it should be: a coarse polygon, jittered */
    for (int k = 0; k < 3; k++) assert_close(sum[k], closed ? 0.0 : 1e5 * area[k], ROUND, 1e5 * 0.0025 * PETSC_PI);
    for (int k = 0; k < 3 && closed; k++) assert_close(moment[k], 0.0, ROUND, 1e5 * 0.0025 * PETSC_PI * 0.05);
    assert_petsc(PetscFree(u));
    assert_petsc(PetscFree(f));
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* the same for a body of quadratic tetrahedra whose faces are bent: no force and no moment on its closed surface, p times the base's area
   vector, by the circle that bounds it, on the dome; body forces give b V */
static void QuadraticFaces_ObeyItToo(void **state)
{
  TLEDParams    *p;
  TLED           tled[2];
  double         sum[2][3], moment[3];
  PetscReal     *u, *f;
  TLEDLoadParams load, weight;

  (void)state;
  for (int part = 0; part < 2; part++) {
    tled[part] = NewBody("tests/meshes/half_ball_2.msh", &p);
    p->element = TLED_ELEMENT_T10;
    load       = Load("dome");
    weight     = Load("solid");
    if (!part) AddName(&load.groups, "base");
    load.pressure = 1e5, weight.body_force[0] = 3e4;
    assert_petsc(TLEDAddLoad(tled[part], "push", &load));
    if (!part) assert_petsc(TLEDAddLoad(tled[part], "weight", &weight));
    assert_petsc(TLEDSetUp(tled[part]));
    u = Displaced(tled[part], part ? 0.0 : 0.002);
    f = Forces(tled[part], 0.0, u, sum[part], moment);
    assert_petsc(PetscFree(u));
    assert_petsc(PetscFree(f));
  }
  assert_close(sum[0][0], 3e4 * tled[0]->volume, 5e-6, 8.0); /* the body's volume is by the rule of four points, exact on straight edges */
  for (int k = 1; k < 3; k++) assert_close(sum[0][k], 0.0, ROUND, 1e5 * 0.0025 * PETSC_PI);
  assert_close(sum[1][2], -1e5 * 0.0025 * PETSC_PI, 5e-3, 1e5 * 0.0025 * PETSC_PI); /* arcs of the base's circle by parabolas */
  for (int part = 0; part < 2; part++) assert_petsc(TLEDDestroy(&tled[part]));
}

/* faces of six nodes: the four curved faces of a tetrahedron give no net force and moment either */
static void CurvedFaces_AreIntegratedExactly(void **state)
{
  static const int face[4][6] = {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}};
  static const int edge[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  double           X[30] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, sum[3] = {0, 0, 0}, moment[3] = {0, 0, 0}, area = 0.0, shares = 0.0;

  (void)state;
  for (int e = 0; e < 6; e++)
    for (int k = 0; k < 3; k++) X[12 + 3 * e + k] = 0.5 * (X[3 * edge[e][0] + k] + X[3 * edge[e][1] + k]);
  for (int s = 0; s < 4; s++) { /* straight edges: nothing for vertices, a third of the area for each edge's node */
    double x[18], share[6];
    for (int k = 0; k < 18; k++) x[k] = X[3 * face[s][k / 3] + k % 3];
    TLEDFaceShares(6, x, share);
    area = s == 2 ? 0.5 * sqrt(3.0) : 0.5;
    for (int a = 0; a < 6; a++) assert_close(share[a], a < 3 ? 0.0 : area / 3.0, ROUND, 1.0);
    for (int a = 0; a < 6; a++) shares += share[a];
  }
  assert_close(shares, 1.5 + 0.5 * sqrt(3.0), ROUND, 1.0);
  for (int k = 0; k < 30; k++) X[k] += 0.3 * Noise();
  for (int s = 0; s < 4; s++) {
    double x[18], f[18];
    for (int k = 0; k < 18; k++) x[k] = X[3 * face[s][k / 3] + k % 3];
    TLEDFacePressure(6, x, 2.0, f);
    for (int a = 0; a < 6; a++) {
      double m[3];
      Cross3(&x[3 * a], &f[3 * a], m);
      for (int k = 0; k < 3; k++) sum[k] += f[3 * a + k], moment[k] += m[k];
    }
  }
  for (int k = 0; k < 3; k++) {
    assert_close(sum[k], 0.0, ROUND, 1.0);
    assert_close(moment[k], 0.0, ROUND, 1.0);
  }
}

/* the force is of second degree in the places: a central difference is the derivative, to rounding over its step */
static void Stiffness_IsTheDerivative(void **state)
{
  (void)state;
  for (int n = 3; n <= 6; n += 3) {
    double x[18];
    for (int k = 0; k < 18; k++) x[k] = Noise() + (k / 3 == 1 || k / 3 == 4) * (k % 3 == 0) + (k / 3 == 2 || k / 3 == 5) * (k % 3 == 1);
    for (int b = 0; b < 3 * n; b++) {
      const double h = 1e-2, at = x[b];
      double       low[18], high[18];
      x[b] = at - h, TLEDFacePressure(n, x, 3.0, low);
      x[b] = at + h, TLEDFacePressure(n, x, 3.0, high);
      x[b] = at;
      for (int a = 0; a < 3 * n; a++) {
        double K[9] = {0};
        TLEDFaceStiffness(n, x, 3.0, a / 3, b / 3, K);
        assert_close(K[3 * (a % 3) + b % 3], -(high[a] - low[a]) / (2.0 * h), ROUND, 10.0);
      }
    }
  }
}

/* adds blocks to a dense matrix */
typedef struct {
  PetscInt   n;
  PetscReal *K;
} Dense;

static PetscErrorCode AddBlock(void *ctx, PetscInt a, PetscInt b, const PetscReal K[9])
{
  Dense *d = (Dense *)ctx;

  for (int i = 0; i < 9; i++) d->K[(3 * a + i / 3) * 3 * d->n + 3 * b + i % 3] += K[i];
  return PETSC_SUCCESS;
}

/* the blocks of a whole body's external tangent against differences of its external forces */
static void Tangent_IsThatOfTheForces(void **state)
{
  TLEDParams    *p;
  TLED           tled = NewBody("tests/meshes/half_ball.msh", &p);
  TLEDLoadParams load = Load("dome");
  Dense          d;
  PetscReal     *u, *low, *high;

  (void)state;
  load.pressure    = 1e3;
  load.traction[0] = 1e3;
  load.course.kind = COURSE_LINEAR, load.course.duration = 2.0;
  assert_petsc(TLEDAddLoad(tled, "push", &load));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetSize(tled, &d.n, NULL));
  assert_petsc(PetscCalloc1(9 * d.n * d.n, &d.K));
  assert_petsc(PetscMalloc2(3 * d.n, &low, 3 * d.n, &high));
  u = Displaced(tled, 0.01);
  assert_petsc(TLEDExternalTangent_Private(tled, 1.5, u, AddBlock, &d));
  for (PetscInt b = 0; b < 3 * d.n; b += 7) {
    const double h = 1e-3, at = u[b];
    u[b] = at - h;
    assert_petsc(TLEDExternalForces_Private(tled, 1.5, u, low));
    u[b] = at + h;
    assert_petsc(TLEDExternalForces_Private(tled, 1.5, u, high));
    u[b] = at;
    for (PetscInt a = 0; a < 3 * d.n; a++) assert_close(d.K[a * 3 * d.n + b], -(high[a] - low[a]) / (2.0 * h), 1e-10, 100.0);
  }
  assert_petsc(PetscFree2(low, high));
  assert_petsc(PetscFree(d.K));
  assert_petsc(PetscFree(u));
  assert_petsc(TLEDDestroy(&tled));
}

/* a cube squeezed to 0.9 of its edges is in equilibrium, at every node, under the pressure that the law asks for on its deformed
   faces: s^3 p = mu (1 - s^2) - 3 lambda ln s */
static void Pressure_PassesThePatchTest(void **state)
{
  static const char *const sides[6] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  const double             s = 0.9, mu = 3e6 / 2.6, lambda = 0.9e6 / (1.3 * 0.4);
  TLEDParams              *p;
  TLED                     tled = NewBody("tests/meshes/cube_h1.msh", &p);
  TLEDLoadParams           load = Load(NULL);
  const PetscReal         *X, *force;
  PetscReal               *at, *f;
  double                   sum[3], moment[3];
  PetscInt                 n;
  Vec                      u, internal;

  (void)state;
  for (int k = 0; k < 6; k++) AddName(&load.groups, sides[k]);
  load.pressure = (mu * (1.0 - s * s) - 3.0 * lambda * log(s)) / (s * s * s);
  assert_petsc(TLEDAddLoad(tled, "sea", &load));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
  assert_petsc(VecDuplicate(u, &internal));
  assert_petsc(VecGetArray(u, &at));
  for (PetscInt k = 0; k < 3 * n; k++) at[k] = (s - 1.0) * X[k];
  f = Forces(tled, 0.0, at, sum, moment);
  assert_petsc(VecRestoreArray(u, &at));
  assert_petsc(TLEDInternalForce(tled, u, internal));
  assert_petsc(VecGetArrayRead(internal, &force));
  for (PetscInt k = 0; k < 3 * n; k++) assert_close(force[k], f[k], ROUND, load.pressure);
  assert_petsc(VecRestoreArrayRead(internal, &force));
  assert_petsc(PetscFree(f));
  assert_petsc(VecDestroy(&internal));
  assert_petsc(TLEDDestroy(&tled));
}

/* tractions give t A, body forces b V, forces themselves, each times its course; weight and f come on top */
static void DeadLoads_GiveTheirTotals(void **state)
{
  const PetscReal g[3] = {0.0, 0.0, -10.0};
  TLEDParams     *p;
  TLED            tled = NewBody("tests/meshes/beam_h1.msh", &p);
  TLEDLoadParams  pull = Load("tip"), wind = Load("solid"), hand = Load("clamp"), finger = Load(NULL);
  PetscReal      *u, *f;
  double          sum[3], moment[3];
  PetscInt        corner;

  (void)state;
  pull.traction[0] = 5.0, pull.course.kind = COURSE_LINEAR, pull.course.duration = 4.0; /* a half at 2 s */
  wind.body_force[1] = 7.0;
  hand.force[1]      = 3.0;
  finger.force[2]    = 11.0;
  finger.at.n = 3, finger.at.value[0] = 0.999, finger.at.value[1] = 0.101, finger.at.value[2] = 0.099;
  assert_petsc(TLEDAddLoad(tled, "pull", &pull));
  assert_petsc(TLEDAddLoad(tled, "wind", &wind));
  assert_petsc(TLEDAddLoad(tled, "hand", &hand));
  assert_petsc(TLEDAddLoad(tled, "finger", &finger));
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  u = Displaced(tled, 0.0);
  f = Forces(tled, 2.0, u, sum, moment);
  assert_close(sum[0], 2.5 * 0.01, ROUND, 1.0);
  assert_close(sum[1], 7.0 * 0.01 + 3.0, ROUND, 1.0);
  assert_close(sum[2], 11.0 - 10.0 * 1000.0 * 0.01, ROUND, 100.0);
  corner = NodeAt(tled, 1.0, 0.1, 0.1);
  assert_close(f[3 * corner + 2], 11.0 - 10.0 * tled->mass[corner], ROUND, 10.0);
  assert_petsc(PetscFree(u));
  assert_petsc(PetscFree(f));
  assert_petsc(TLEDDestroy(&tled));
}

/* what pressure and traction give while the beam swings far is what kinetic and strain energy gain, to the order of the step */
static void Work_IsInTheLedger(void **state)
{
  double error[2];

  (void)state;
  for (int fine = 0; fine < 2; fine++) {
    TLEDParams    *p;
    TLED           tled = NewBody("tests/meshes/beam_h1.msh", &p);
    TLEDLoadParams push = Load("tip");
    TLEDStats      s;

    AddName(&p->fixed, "clamp");
    p->safety        = fine ? 0.2 : 0.4;
    push.pressure    = 2e4;
    push.traction[2] = 3e3;
    push.course.kind = COURSE_SINE, push.course.frequency = 5.0;
    assert_petsc(TLEDAddLoad(tled, "push", &push));
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDAdvance(tled, 0.08, NULL));
    assert_petsc(TLEDGetStats(tled, &s));
    assert_true(s.external_work > 1.0);
    assert_true(s.support_work == 0.0);
    error[fine] = fabs(s.kinetic + s.strain - s.external_work) / s.external_work;
    assert_petsc(TLEDDestroy(&tled));
  }
  assert_close(error[1], 0.0, 1e-3, 1.0);
  assert_true(error[1] < 0.5 * error[0] || error[0] < 1e-6);
}

CHECK_MAIN(cmocka_unit_test(Pressure_ObeysTheDivergenceTheorem), cmocka_unit_test(QuadraticFaces_ObeyItToo), cmocka_unit_test(CurvedFaces_AreIntegratedExactly),
           cmocka_unit_test(Stiffness_IsTheDerivative), cmocka_unit_test(Tangent_IsThatOfTheForces),
           cmocka_unit_test(Pressure_PassesThePatchTest), cmocka_unit_test(DeadLoads_GiveTheirTotals), cmocka_unit_test(Work_IsInTheLedger))
