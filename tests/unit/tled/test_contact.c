/* Contact with planes and obstacles: force against energy, bounce, rest, the stable step, what ends a run. */
#include "unit/tled/body.h"
#include "tled/tled_contact.h"
#include "tled/tled_impl.h"
#include <omp.h>

static const PetscReal floor_point[3] = {0.0, 0.0, 0.0}, up[3] = {0.0, 0.0, 1.0};

static double Noise(void)
{
  static unsigned seed = 1u;

  seed = 1664525u * seed + 1013904223u;
  return (double)(seed >> 8) / 16777216.0 - 0.5;
}

/* an L-shaped prism, 0 <= y <= depth: the square 0 <= x, z <= size without its upper right quarter, moved; it has a concave edge */
static Surface Step(double size, double depth, const double move[3])
{
  static const double   xz[6][2]  = {{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}};
  static const PetscInt cap[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}};
  Surface               s         = {12, 20, NULL, NULL};

  assert_petsc(PetscMalloc1(36, &s.x));
  assert_petsc(PetscMalloc1(60, &s.triangles));
  for (int i = 0; i < 12; i++) {
    s.x[3 * i] = move[0] + size * xz[i % 6][0], s.x[3 * i + 1] = move[1] + (i < 6 ? 0.0 : depth), s.x[3 * i + 2] = move[2] + size * xz[i % 6][1];
  }
  for (int t = 0; t < 4; t++) /* at y = 0 outward is -y: as listed; turned on the far side */
    for (int c = 0; c < 3; c++) s.triangles[3 * t + c] = cap[t][c], s.triangles[3 * (4 + t) + c] = 6 + cap[t][2 - c];
  for (int i = 0; i < 6; i++) {
    const PetscInt j = (i + 1) % 6, side[6] = {i, 6 + i, j, j, 6 + i, 6 + j};
    for (int c = 0; c < 6; c++) s.triangles[24 + 6 * i + c] = side[c];
  }
  return s;
}

static void SignedDistance_IsThatOfTheShape(void **state)
{
  const double  zero[3] = {0.0, 0.0, 0.0};
  Surface       s       = Step(1.0, 1.0, zero);
  SurfaceIndex  index;
  SurfaceFoot   at;

  (void)state;
  assert_petsc(SurfaceIndexCreate(s.n_nodes, s.x, s.n_triangles, s.triangles, 0.6, &index));
  for (int i = 0; i < 2000; i++) {
    const double p[3] = {0.5 + 2.0 * Noise(), 0.5 + 0.4 * Noise(), 0.5 + 2.0 * Noise()}; /* its ends are far: a plane problem */
    const int    in   = p[0] > 0.0 && p[2] > 0.0 && p[0] < 1.0 && p[2] < 1.0 && (p[0] < 0.5 || p[2] < 0.5);
    double       best = 1e9, h = 1e-6, slope[3];
    static const double xz[6][2] = {{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}};
    for (int e = 0; e < 6; e++) { /* distance to the six edges of the outline, and to the ends */
      const double *a = xz[e], *b = xz[(e + 1) % 6], d[2] = {b[0] - a[0], b[1] - a[1]};
      const double  t = fmin(1.0, fmax(0.0, ((p[0] - a[0]) * d[0] + (p[2] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1])));
      best            = fmin(best, hypot(p[0] - a[0] - t * d[0], p[2] - a[1] - t * d[1]));
    }
    if (in) best = fmin(best, fmin(p[1], 1.0 - p[1]));
    if (best > 0.6) {
      assert_false(SurfaceIndexNearest(index, p, 0.6, &at));
      continue;
    }
    assert_true(SurfaceIndexNearest(index, p, 0.6, &at));
    assert_close(at.distance, in ? -best : best, 1e-14, 1.0);
    for (int k = 0; k < 3; k++) { /* the normal is the gradient, but where the nearest place changes */
      double      q[3] = {p[0], p[1], p[2]};
      SurfaceFoot low, high;
      q[k] -= h, assert_true(SurfaceIndexNearest(index, q, 0.7, &low));
      q[k] += 2.0 * h, assert_true(SurfaceIndexNearest(index, q, 0.7, &high));
      slope[k] = (high.distance - low.distance) / (2.0 * h);
    }
    if (fabs(Norm3(slope) - 1.0) < 1e-6)
      for (int k = 0; k < 3; k++) assert_close(at.normal[k], slope[k], 1e-5, 1.0);
  }
  assert_petsc(SurfaceIndexDestroy(&index));
  assert_petsc(SurfaceDestroy(&s));
}

/* force and stiffness grow from zero without a jump, and the force is the slope of the energy */
static void Pressure_IsSmooth(void **state)
{
  double slope, energy, low, high, s;

  (void)state;
  for (double d = -0.5; d < 3.0; d += 0.09) {
    const double h = 1e-5, p = TLEDContactPressure(d, 7.0, 1.0, &slope, &energy);
    const double p0 = TLEDContactPressure(d - h, 7.0, 1.0, &s, &low), p1 = TLEDContactPressure(d + h, 7.0, 1.0, &s, &high);
    assert_close((high - low) / (2.0 * h), p, 1e-9, 7.0);
    assert_close((p1 - p0) / (2.0 * h), slope, 1e-4, 7.0);
  }
}

/* forces of a ball pressed into faces, the concave and the convex edges of the step, and a plane, against differences of the stored energy, and
   their stiffness against differences of them; nodes at which the nearest place changes within the difference are few, and left out */
static void Force_IsTheGradientOfTheEnergy(void **state)
{
  const double move[3] = {-0.05, -0.1, -0.05};
  Surface      s       = Step(0.1, 0.2, move);
  TLEDParams  *p;
  TLED         tled = NewBody("meshes/ball.msh", &p);
  PetscInt     n, tested = 0, turned = 0;
  PetscReal   *u;
  const PetscReal *X;

  (void)state;
  assert_petsc(TLEDAddContactPlane(tled, "wall", (PetscReal[3]){0.0, 0.0, -1.0}, up));
  assert_petsc(TLEDAddContactSurface(tled, "step", &s));
  p->translate[0] = p->translate[2] = 10.0; /* far away at the start */
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(PetscMalloc1(3 * n, &u));
  for (PetscInt a = 0; a < n; a++) { /* every node somewhere near the step's inner edge */
    for (int k = 0; k < 3; k++) u[3 * a + k] = (k == 1 ? 0.01 : 0.03) * Noise() - X[3 * a + k];
    if (a % 5 == 0) u[3 * a + 2] = -1.0 + 0.01 * Noise() - X[3 * a + 2]; /* or at the plane */
  }
  for (PetscInt a = 0; a < n; a++) {
    const double h = 1e-8;
    double       f[3] = {0}, K[9] = {0}, g[3], D[9];
    if (!(tled->contact.area[a] > 0.0) || !(TLEDContactAt_Private(tled, a, &u[3 * a], f, K, NULL) > 0.0)) continue;
    for (int j = 0; j < 3; j++) {
      double low[3] = {0}, high[3] = {0}, q[3] = {u[3 * a], u[3 * a + 1], u[3 * a + 2]};
      q[j] -= h;
      g[j] = TLEDContactAt_Private(tled, a, q, low, NULL, NULL);
      q[j] += 2.0 * h;
      g[j] = -(TLEDContactAt_Private(tled, a, q, high, NULL, NULL) - g[j]) / (2.0 * h);
      for (int i = 0; i < 3; i++) D[3 * i + j] = -(high[i] - low[i]) / (2.0 * h);
    }
    tested++;
    turned += fabs(K[0]) > 0.0 && fabs(K[8]) > 0.0;
    for (int i = 0; i < 3; i++) assert_close(g[i], f[i], 1e-5, Norm3(f));
    for (int i = 0; i < 9; i++) assert_close(D[i], K[i], 1e-4, tled->contact.stiffness * tled->contact.area[a]);
  }
  assert_true(tested > n / 10 && turned > 5); /* the concave edge is among them */
  assert_petsc(PetscFree(u));
  assert_petsc(SurfaceDestroy(&s));
  assert_petsc(TLEDDestroy(&tled));
}


/* height of the centre of mass, and all energy but damping's */
static double Height(TLED tled)
{
  const PetscReal *x;
  double           sum = 0.0, mass = 0.0;
  PetscInt         n;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetPositions(tled, &x, NULL));
  for (PetscInt a = 0; a < n; a++) sum += tled->mass[a] * x[3 * a + 2], mass += tled->mass[a];
  return sum / mass;
}

static double Energy(TLED tled)
{
  TLEDStats s;

  assert_petsc(TLEDGetStats(tled, &s));
  return s.kinetic + s.strain + s.gravity_potential + s.contact_energy;
}

/* A stiff ball dropped on a plane, and on an obstacle whose upper side is that plane: energy is kept through the bounce, and what does not
   go into its vibration brings it back. The impact takes 2.9 (m^2/(R E*^2 v))^(1/5) = 4 ms [Hertz], some 15 periods of its lowest
   mode: hardly any does. */
static void Ball_BouncesBack(void **state)
{
  const PetscReal g[3] = {0.0, 0.0, -9.81};

  (void)state;
  for (int obstacle = 0; obstacle < 2; obstacle++) {
    TLEDParams *p;
    TLED        tled = NewBody("meshes/ball.msh", &p);
    Surface     s    = Step(1.0, 1.0, (double[3]){-0.25, -0.5, -1.0});
    double      e0, h0, top = -1.0, worst = 0.0, deepest = 0.0, drop, weight;

    p->elastic.young = 2e7;
    p->translate[2]  = 0.08 + 0.02;
    if (obstacle) assert_petsc(TLEDAddContactSurface(tled, "block", &s));
    else assert_petsc(TLEDAddContactPlane(tled, "floor", floor_point, up));
    assert_petsc(TLEDSetGravity(tled, g));
    assert_petsc(TLEDSetUp(tled));
    e0 = Energy(tled), h0 = Height(tled);
    drop   = h0 - 0.08;
    weight = 1000.0 * tled->volume * 9.81;
    for (int i = 0; i < 140; i++) {
      const PetscReal *x;
      assert_petsc(TLEDAdvance(tled, 0.001, NULL));
      if (i > 80) top = fmax(top, Height(tled));
      worst = fmax(worst, fabs(Energy(tled) - e0));
      assert_petsc(TLEDGetPositions(tled, &x, NULL));
      for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) deepest = fmax(deepest, -x[3 * a + 2]);
    }
    assert_close(worst, 0.0, 1e-3, weight * drop); /* (omega dt)^2/12 of the modes that are struck; measured 3e-5, 5e-5 */
    assert_close(top - 0.08, drop, 0.01, drop);    /* measured 0.9915 */
    assert_true(deepest > 1e-4 && deepest < 1.5e-3); /* a node's depth; measured 1.0e-3 m, a fiftieth of the radius of what touches */
    if (getenv("PRINT")) print_message("deepest %g of %g, top %g, energy %g\n", deepest, tled->contact.reach, (top - 0.08) / drop, worst / (weight * drop));
    assert_petsc(SurfaceDestroy(&s));
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* a block comes to rest on a plane and on an obstacle: contact carries its weight, at the depth where the pressure is weight over
   the area that the touching nodes stand for */
static void Block_RestsOnWhatIsBelow(void **state)
{
  const PetscReal g[3] = {0.0, 0.0, -9.81};

  (void)state;
  for (int obstacle = 0; obstacle < 2; obstacle++) {
    TLEDParams      *p;
    TLED             tled = NewBody("tests/meshes/cube_h1.msh", &p);
    Surface          s    = Step(4.0, 4.0, (double[3]){-0.5, -1.5, -4.0});
    TLEDConstraintParams side;
    const TLEDGroup *sole;
    const PetscReal *u;
    double           force = 0.0, area = 0.0, mean, depth = 0.0;
    PetscInt         steps;
    Vec              U;

    p->damping         = 100.0; /* about critical for the lowest mode, the block on the spring of its contact */
    p->elastic.poisson = 0.0; /* the state is uniform in each plane, and the sides' symmetries do not disturb it */
    assert_petsc(KeysSetDefaults(TLEDConstraintKeys, &side));
    side.kind = TLED_CONSTRAINT_SYMMETRY;
    AddName(&side.groups, "xmin"), AddName(&side.groups, "ymin");
    assert_petsc(TLEDAddConstraint(tled, "sides", &side));
    if (obstacle) assert_petsc(TLEDAddContactSurface(tled, "block", &s));
    else assert_petsc(TLEDAddContactPlane(tled, "floor", floor_point, up));
    assert_petsc(TLEDSetGravity(tled, g));
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDAdvance(tled, 1.0, &steps));
    assert_petsc(TLEDGetVectors(tled, &U, NULL, NULL));
    assert_petsc(VecGetArrayRead(U, &u));
    assert_petsc(TLEDMeshFindGroup_Private(&tled->mesh, "zmin", &sole));
    for (PetscInt i = 0; i < sole->n_nodes; i++) {
      const PetscInt a    = sole->nodes[i];
      double         f[3] = {0};
      (void)TLEDContactAt_Private(tled, a, &u[3 * a], f, NULL, NULL);
      force += f[2], area += tled->contact.area[a], depth -= tled->contact.area[a] * u[3 * a + 2];
    }
    assert_petsc(VecRestoreArrayRead(U, &u));
    mean = sqrt(2.0 * tled->contact.soft * force / area / tled->contact.stiffness);
    if (getenv("PRINT")) print_message("force %g, depth %g, expected %g, steps %d\n", force, depth / area, mean, (int)steps);
    assert_close(force, 1000.0 * 9.81 * tled->volume, 1e-7, 9810.0);
    assert_close(depth / area, mean, 0.01, mean); /* nearly uniform: the rim's nodes stand for parts of the sides as well */
    assert_petsc(SurfaceDestroy(&s));
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* with contact a thousand times as stiff the stable step is shorter, and at 0.95 of it a bounce still keeps the energy */
static void StiffContact_ShortensTheStep(void **state)
{
  PetscReal dt[2];

  (void)state;
  for (int stiff = 0; stiff < 2; stiff++) {
    TLEDParams *p;
    TLED        tled = NewBody("tests/meshes/half_ball.msh", &p);
    double      e0;

    p->safety        = 0.95;
    p->translate[2]  = 1e-3;
    p->velocity[2]   = -1.0;
    if (stiff) p->contact_stiffness = 1000.0 * 2.0 * 3e6 / 0.028;
    assert_petsc(TLEDAddContactPlane(tled, "floor", floor_point, up));
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetCriticalStep(tled, &dt[stiff]));
    e0 = Energy(tled);
    for (int i = 0; i < 20; i++) {
      assert_petsc(TLEDAdvance(tled, 5e-4, NULL));
      assert_close(Energy(tled), e0, 0.05, e0); /* steps near the critical one, hard impact of a coarse mesh; unstable: grows without bound */
    }
    assert_true(Height(tled) > 0.02);
    assert_petsc(TLEDDestroy(&tled));
  }
  assert_true(dt[1] < 0.2 * dt[0]);
}

/* the same bits with any number of threads, and going on from a checkpoint in the middle of an impact */
static void ImpactOnObstacle_IsReproducible(void **state)
{
  const int  threads = omp_get_max_threads();
  PetscReal *first   = NULL;

  (void)state;
  for (int way = 0; way < 4; way++) { /* 1, 2, 3 threads, then a restart */
    TLEDParams      *p;
    TLED             tled = NewBody("meshes/ball.msh", &p), other = NULL;
    Surface          s    = Step(0.4, 0.4, (double[3]){-0.285, -0.2, -0.285});
    const PetscReal *x;
    PetscInt         n;

    omp_set_num_threads(way < 3 ? way + 1 : 2);
    p->translate[2] = 0.002, p->velocity[2] = -4.0, p->velocity[0] = -4.0;
    assert_petsc(TLEDAddContactSurface(tled, "step", &s));
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDAdvance(tled, 0.005, NULL));
    if (way == 3) {
      TLEDParams *q;
      Vec         u[3], v[3];
      PetscInt    n_state;
      PetscReal  *carried;
      other = NewBody("meshes/ball.msh", &q);
      *q    = *p;
      assert_petsc(TLEDAddContactSurface(other, "step", &s));
      assert_petsc(TLEDSetUp(other));
      assert_petsc(TLEDGetVectors(tled, &u[0], &u[1], &u[2]));
      assert_petsc(TLEDGetVectors(other, &v[0], &v[1], &v[2]));
      for (int k = 0; k < 3; k++) assert_petsc(VecCopy(u[k], v[k]));
      assert_petsc(TLEDGetState(tled, &n_state, NULL));
      assert_petsc(PetscMalloc1(n_state, &carried));
      assert_petsc(TLEDGetState(tled, &n_state, carried));
      assert_petsc(TLEDSetState(other, n_state, carried));
      assert_petsc(PetscFree(carried));
      assert_petsc(TLEDDestroy(&tled));
      tled = other;
    }
    assert_petsc(TLEDAdvance(tled, 0.004, NULL));
    assert_petsc(TLEDGetSize(tled, &n, NULL));
    assert_petsc(TLEDGetPositions(tled, &x, NULL));
    if (!first) {
      TLEDStats stats;
      assert_petsc(TLEDGetStats(tled, &stats));
      assert_true(stats.contact_energy > 0.0); /* it is in the corner of the step */
      assert_petsc(PetscMalloc1(3 * n, &first));
      assert_petsc(PetscArraycpy(first, x, 3 * n));
    }
    assert_memory_equal(x, first, 3 * n * sizeof *x);
    assert_petsc(SurfaceDestroy(&s));
    assert_petsc(TLEDDestroy(&tled));
  }
  assert_petsc(PetscFree(first));
  omp_set_num_threads(threads);
}

/* a body that starts in an obstacle is refused; one that is pressed through its surface ends the run with the reason */
static void WhatCannotBe_IsTold(void **state)
{
  TLEDParams *p;
  TLED        tled;
  Surface     s = Step(0.4, 0.4, (double[3]){-0.1, -0.2, -0.4});
  const char *message;

  (void)state;
  tled = NewBody("meshes/ball.msh", &p);
  assert_petsc(TLEDAddContactSurface(tled, "step", &s));
  assert_int_equal((int)TLEDSetUp(tled), (int)BY_ERR_INPUT);
  assert_petsc(TLEDDestroy(&tled));
  tled = NewBody("meshes/ball.msh", &p);
  assert_petsc(TLEDAddContactPlane(tled, "floor", floor_point, up));
  assert_int_equal((int)TLEDSetUp(tled), (int)BY_ERR_INPUT);
  assert_petsc(TLEDDestroy(&tled));
  tled = NewBody("meshes/ball.msh", &p);
  p->translate[2] = 0.09, p->velocity[2] = -3.0, p->contact_stiffness = 1e3;
  assert_petsc(TLEDAddContactSurface(tled, "step", &s));
  assert_petsc(TLEDSetUp(tled));
  assert_int_equal((int)TLEDAdvance(tled, 0.1, NULL), (int)BY_ERR_BREAKDOWN);
  assert_petsc(TLEDGetBreakdown(tled, &message));
  assert_non_null(strstr(message, "pressed through the surface of an obstacle"));
  assert_petsc(TLEDDestroy(&tled));
  assert_petsc(SurfaceDestroy(&s));
}

CHECK_MAIN(cmocka_unit_test(SignedDistance_IsThatOfTheShape), cmocka_unit_test(Pressure_IsSmooth), cmocka_unit_test(Force_IsTheGradientOfTheEnergy),
           cmocka_unit_test(Ball_BouncesBack), cmocka_unit_test(Block_RestsOnWhatIsBelow),
           cmocka_unit_test(StiffContact_ShortensTheStep), cmocka_unit_test(ImpactOnObstacle_IsReproducible), cmocka_unit_test(WhatCannotBe_IsTold))
