/* test_wall.c - faces that lie on a wall or an obstacle stop acting, smoothly, and as faces that are not there (method 2 at edges; docs/design.md). */
#include "unit/proxy/fixture.h"

static ProxyFluid Floor(double z)
{
  ProxyFluid fluid = FixtureFluid();
  fluid.walls    = 1u << 4;
  fluid.plane[4] = z;
  return fluid;
}

/* a cube of side 4 without its bottom */
static Shape OpenCube(void)
{
  Shape s = ShapeBox(2, 2, 2, 4, 4, 4);
  int   m = 0;
  for (int t = 0; t < s.n_triangles; t++) {
    const int *v = &s.triangles[3*t];
    if (s.x[3*v[0] + 2] < -1.999 && s.x[3*v[1] + 2] < -1.999 && s.x[3*v[2] + 2] < -1.999) continue;
    memmove(&s.triangles[3*m++], v, 3*sizeof(int));
  }
  s.n_triangles = m;
  return s;
}

/* points at the foot of the cube, 0.05 to 0.85 h off its side and off the floor */
static void FootPoint(int i, double x[3])
{
  x[0] = 2.05 + 0.2*(i%5), x[1] = 0.3*(i%3) - 0.2, x[2] = -1.94 + 0.2*(i/5);
}

static void a_cube_on_the_floor_has_no_bottom(void **state)
{
  Shape            s = ShapeBox(2, 2, 2, 4, 4, 4), open = OpenCube();
  const ProxyFluid on = Floor(-2.0), above = Floor(-2.5);
  Proxy            p = FixtureProxy(&s, 0.5, PROXY_KERNEL_HALF_SPACE, 1.0, &on), q = FixtureProxy(&s, 0.5, PROXY_KERNEL_HALF_SPACE, 1.0, &above);
  Proxy            r = FixtureProxy(&open, 0.5, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double           down = 0.0;
  (void)state;
  for (int i = 0; i < 25; i++) {
    double x[3], with[3], without[3], full[3];
    FootPoint(i, x);
    assert_close(FixturePhi(p, x, with), FixturePhi(r, x, without), 1e-12, 1.0); // as faces that are dropped
    for (int k = 0; k < 3; k++) assert_close(with[k], without[k], 1e-12, 1.0);
    assert_close(with[2], 0.0, 1e-12, 1.0); // no lift
    FixturePhi(q, x, full);
    down = fmax(down, fabs(full[2]));
  }
  assert_true(down > 0.3); // which it would have a spacing above the floor
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  assert_petsc(ProxyDestroy(&r));
  ShapeFree(&s);
  ShapeFree(&open);
}

/* phi at the foot from the floor to a spacing above it: no jump, and the gradient is that of phi on the way */
static void faces_leave_smoothly(void **state)
{
  Shape  s = ShapeBox(2, 2, 2, 4, 4, 4);
  double before[25], most = 0.0;
  (void)state;
  for (int kernel = PROXY_KERNEL_HALF_SPACE; kernel <= PROXY_KERNEL_ELLIPSOID; kernel++) {
    for (int step = 0; step <= 100; step++) {
      const ProxyFluid fluid = Floor(-2.0 - 0.005*step); // by 0.01 dx
      Proxy            p = FixtureProxy(&s, 0.5, kernel, 0.0, &fluid);
      for (int i = 0; i < 25; i++) {
        double       x[3];
        FootPoint(i, x);
        const double phi = FixturePhi(p, x, NULL);
        if (step) most = fmax(most, fabs(phi - before[i]));
        before[i] = phi;
        if (step%20 == 0) assert_true(FixtureGradientError(p, x) < 1e-6); // differences of step 1e-5
      }
      assert_petsc(ProxyDestroy(&p));
    }
  }
  assert_true(most < 0.02); // 0.35 dx of fading, at most 0.4 of change: slope 1.5/35
  ShapeFree(&s);
}

/* an obstacle's roof is a wall like the floor, a face that looks elsewhere is none's concern */
static void obstacles_are_lain_on(void **state)
{
  Shape            s = ShapeBox(2, 2, 2, 4, 4, 4), roof = ShapeBox(6, 6, 1, 1, 1, 1);
  const ProxyFluid on = Floor(-2.0);
  Proxy            p = FixtureProxy(&s, 0.5, PROXY_KERNEL_HALF_SPACE, 1.0, NULL), q = FixtureProxy(&s, 0.5, PROXY_KERNEL_HALF_SPACE, 1.0, &on);
  const double     lo[3] = {-6, -6, -4}, hi[3] = {6, 6, -2};
  SurfaceIndex     index;
  PetscInt         triangles[36];
  (void)state;
  assert_int_equal(roof.n_triangles, 12);
  for (int i = 0; i < 36; i++) triangles[i] = roof.triangles[i];
  for (int v = 0; v < roof.n_nodes; v++) roof.x[3*v + 2] -= 3.0;
  assert_petsc(SurfaceIndexCreate(roof.n_nodes, roof.x, roof.n_triangles, triangles, 1.5, &index));
  assert_petsc(ProxyAddNeighbour(p, index, lo, hi));
  ProxyExpose(p);
  assert_true(p->hides && q->hides);
  assert_int_equal(p->n, q->n);
  for (int i = 0; i < 25; i++) {
    double x[3], g[3], f[3];
    FootPoint(i, x);
    assert_close(FixturePhi(p, x, g), FixturePhi(q, x, f), 1e-12, 1.0);
    for (int k = 0; k < 3; k++) assert_close(g[k], f[k], 1e-12, 1.0);
  }
  for (PetscInt i = 0; i < p->n; i++) {
    assert_close(1.0 - p->laid[i], q->exposed[i], 1e-12, 1.0);
    assert_true(q->exposed[i] == (p->normal[3*i + 2] < -0.9 ? 0.0 : 1.0));
  }
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  assert_petsc(SurfaceIndexDestroy(&index));
  ShapeFree(&s);
  ShapeFree(&roof);
}

/* a ball that touches the floor in a point keeps its faces but those right above it */
static void a_ball_keeps_its_faces(void **state)
{
  Shape            s = ShapeSphere(2.5, 14); // 5 dx
  const ProxyFluid on = Floor(-2.5);
  Proxy            p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, &on);
  double           hidden = 0.0;
  (void)state;
  for (PetscInt i = 0; i < p->n; i++) hidden += (1.0 - p->exposed[i])*p->area[i];
  assert_true(hidden > 0.0 && hidden < M_PI*0.9*0.9); // 17 degrees of R are 1.5 dx; proxies are a spacing apart
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

CHECK_MAIN(cmocka_unit_test(a_cube_on_the_floor_has_no_bottom), cmocka_unit_test(faces_leave_smoothly), cmocka_unit_test(obstacles_are_lain_on),
           cmocka_unit_test(a_ball_keeps_its_faces))
