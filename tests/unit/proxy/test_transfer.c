/* test_transfer.c - force and moment from proxies to nodes (method 5.1). */
#include "unit/proxy/fixture.h"

static void Sums(const double x[], const double f[], int n, double force[3], double moment[3])
{
  for (int k = 0; k < 3; k++) force[k] = moment[k] = 0.0;
  for (int a = 0; a < n; a++) {
    double m[3];
    Cross3(&x[3*a], &f[3*a], m);
    for (int k = 0; k < 3; k++) force[k] += f[3*a + k], moment[k] += m[k];
  }
}

/* total force and moment on nodes are the fluid's, to round-off, far from the origin too */
static void Check(Shape s, double tol)
{
  unsigned long seed = 9;
  for (int v = 0; v < s.n_nodes; v++) s.x[3*v] += 20.0, s.x[3*v + 2] -= 7.0;
  Proxy   p = FixtureProxy(&s, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double *f = (double *)calloc(3*(size_t)p->sampling.n, sizeof(double)), *nodal = (double *)calloc(3*(size_t)s.n_nodes, sizeof(double));
  double  force[3] = {0}, moment[3] = {0}, got[3], turn[3], size = 0.0;
  for (PetscInt b = 0; b < p->sampling.n; b++) {
    double at[3], m[3];
    for (int k = 0; k < 3; k++) {
      f[3*b + k] = FixtureRandom(&seed) - 0.3;
      at[k]      = p->x[3*b + k] + 0.8*(FixtureRandom(&seed) - 0.5); // where the particle is
      force[k] += f[3*b + k];
      size += fabs(f[3*b + k]);
    }
    Cross3(at, &f[3*b], m);
    for (int k = 0; k < 3; k++) moment[k] += m[k];
  }
  assert_petsc(ProxyTransfer(p, f, moment, nodal));
  Sums(s.x, nodal, s.n_nodes, got, turn);
  for (int k = 0; k < 3; k++) {
    assert_close(got[k], force[k], tol, size);
    assert_close(turn[k], moment[k], tol, 25.0*size);
  }
  free(f);
  free(nodal);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

static void force_and_moment_are_kept_to_round_off(void **state)
{
  (void)state;
  Check(ShapeSphere(2.0, 6), 1e-14);
  Check(ShapeSphere(2.0, 18), 1e-14);
  Check(ShapeBox(3, 0.02, 0.01, 4, 1, 1), 1e-12); // needle triangles, nearly a line
  Check(ShapeCylinder(0.5, 6, 12, 60), 1e-14);
}

/* without extra moment every node is pushed the way the proxies are: weights are not negative */
static void a_push_is_a_push_at_every_node(void **state)
{
  Shape   s = ShapeBox(2, 1, 0.3, 20, 3, 1);
  Proxy   p = FixtureProxy(&s, 0.4, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double *f = (double *)calloc(3*(size_t)p->sampling.n, sizeof(double)), *nodal = (double *)calloc(3*(size_t)s.n_nodes, sizeof(double));
  (void)state;
  for (PetscInt b = 0; b < p->sampling.n; b++) f[3*b + 2] = 1.0 + 0.5*sin(1.0*b);
  assert_petsc(ProxyTransfer(p, f, NULL, nodal));
  for (int a = 0; a < s.n_nodes; a++) {
    assert_true(nodal[3*a + 2] >= -1e-12);
    assert_close(nodal[3*a], 0.0, 1e-12, 1.0);
  }
  free(f);
  free(nodal);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* nodal forces are added to, nodes outside the surface get nothing */
static void forces_are_added_and_only_to_the_surface(void **state)
{
  Shape   s = ShapeSphere(2.0, 4), more = ShapeAllocate(s.n_nodes + 5, s.n_triangles);
  double *nodal, force[3] = {0};
  Proxy   p;
  (void)state;
  memcpy(more.x, s.x, 3*sizeof(double)*(size_t)s.n_nodes);
  memcpy(more.triangles, s.triangles, 3*sizeof(int)*(size_t)s.n_triangles);
  more.n_nodes = s.n_nodes + 5, more.n_triangles = s.n_triangles;
  p     = FixtureProxy(&more, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  nodal = (double *)calloc(3*(size_t)more.n_nodes, sizeof(double));
  for (int i = 0; i < 3*more.n_nodes; i++) nodal[i] = 1.0;
  double *f = (double *)calloc(3*(size_t)p->sampling.n, sizeof(double));
  f[0] = 2.0;
  assert_petsc(ProxyTransfer(p, f, NULL, nodal));
  for (int a = 0; a < more.n_nodes; a++) force[0] += nodal[3*a] - 1.0;
  assert_close(force[0], 2.0, 1e-13, 1.0);
  for (int i = 3*s.n_nodes; i < 3*more.n_nodes; i++) assert_close(nodal[i], 1.0, 0.0, 1.0);
  free(f);
  free(nodal);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
  ShapeFree(&more);
}

/* a pressure of 1 inwards, as forces on proxies */
static double *Pressure(Proxy p)
{
  double *f = (double *)calloc(3*(size_t)p->n, sizeof(double));
  for (PetscInt b = 0; b < p->n; b++) {
    for (int k = 0; k < 3; k++) f[3*b + k] = -p->area[b]*p->normal[3*b + k];
  }
  return f;
}

/* Forces of a pressure of 1 on flat faces are the consistent ones, a third of every triangle around a node along its normal, however the sampling
   and the mesh are to each other: no node is loaded for its neighbours. */
static void CheckConsistent(Shape s, double eta)
{
  Proxy   p = FixtureProxy(&s, eta, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double *f = Pressure(p), *nodal = (double *)calloc(3*(size_t)s.n_nodes, sizeof(double)), *wanted = (double *)calloc(3*(size_t)s.n_nodes, sizeof(double));

  for (PetscInt t = 0; t < s.n_triangles; t++) {
    for (int i = 0; i < 9; i++) wanted[3*s.triangles[3*t + i/3] + i%3] -= p->geometry.area[t]/3.0*p->geometry.normal[3*t + i%3];
  }
  assert_petsc(ProxyTransfer(p, f, NULL, nodal));
  for (int i = 0; i < 3*s.n_nodes; i++) assert_close(nodal[i], wanted[i], 1e-12, 1.0);
  free(f);
  free(nodal);
  free(wanted);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* a cube of 2 h with one triangle of a thousandth in the middle of one of 2 h, and slivers between them */
static Shape HugeAndTiny(void)
{
  Shape  box = ShapeBox(1, 1, 1, 1, 1, 1), s = ShapeAllocate(box.n_nodes + 3, box.n_triangles + 6);
  int    v[3], p[3];
  double middle[3] = {0, 0, 0};

  memcpy(s.x, box.x, 3*sizeof(double)*(size_t)box.n_nodes);
  s.n_nodes = box.n_nodes;
  for (int t = 1; t < box.n_triangles; t++) ShapeTriangle(&s, box.triangles[3*t], box.triangles[3*t + 1], box.triangles[3*t + 2]);
  for (int i = 0; i < 9; i++) middle[i%3] += box.x[3*box.triangles[i/3] + i%3]/3.0;
  for (int i = 0; i < 3; i++) {
    double x[3];
    v[i] = box.triangles[i];
    for (int k = 0; k < 3; k++) x[k] = middle[k] + 1e-3*(box.x[3*v[i] + k] - middle[k]);
    p[i] = ShapeNode(&s, x[0], x[1], x[2]);
  }
  ShapeTriangle(&s, p[0], p[1], p[2]);
  for (int i = 0; i < 3; i++) {
    ShapeTriangle(&s, v[i], v[(i + 1)%3], p[i]);
    ShapeTriangle(&s, p[i], v[(i + 1)%3], p[(i + 1)%3]);
  }
  ShapeFree(&box);
  return s;
}

static void a_pressure_loads_each_node_by_its_area(void **state)
{
  (void)state;
  CheckConsistent(ShapeBox(2, 1.5, 1, 32, 24, 16), 0.4); // mesh of h/8, spacing 1.25 h: some 100 triangles a proxy
  CheckConsistent(ShapeBox(2, 1.5, 1, 2, 1, 1), 1.0);    // triangles of 2 h, spacing h/2
  CheckConsistent(ShapeBox(2, 0.1, 0.1, 100, 1, 1), 0.6); // needles
  CheckConsistent(HugeAndTiny(), 1.0);
  CheckConsistent(HugeAndTiny(), 0.4);
}

/* one huge and one tiny triangle: exact, and with the couple of forces that act up to 0.8 h off the surface no node gets more than half again what its
   area gets of the pressure */
static void huge_and_tiny_triangles_are_loaded_by_their_area(void **state)
{
  Shape         s = HugeAndTiny();
  Proxy         p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double       *f = Pressure(p), *nodal = (double *)calloc(3*(size_t)s.n_nodes, sizeof(double)), moment[3] = {0}, got[3], turn[3];
  unsigned long seed = 5;
  (void)state;
  Check(HugeAndTiny(), 1e-14);
  for (PetscInt b = 0; b < p->n; b++) {
    double at[3], m[3];
    for (int k = 0; k < 3; k++) at[k] = p->x[3*b + k] + 0.8*(FixtureRandom(&seed) - 0.5);
    Cross3(at, &f[3*b], m);
    for (int k = 0; k < 3; k++) moment[k] += m[k];
  }
  assert_petsc(ProxyTransfer(p, f, moment, nodal));
  Sums(s.x, nodal, s.n_nodes, got, turn);
  for (int k = 0; k < 3; k++) assert_close(turn[k], moment[k], 1e-13, 1.0);
  for (int a = 0; a < s.n_nodes; a++) assert_true(Norm3(&nodal[3*a]) <= 1.5*p->node_weight[a]);
  free(f);
  free(nodal);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* velocities come from the nodes as forces go to them: F . v is the same on both sides */
static void velocities_are_the_transpose_of_forces(void **state)
{
  Shape         s = ShapeSphere(2.0, 14);
  Proxy         p = FixtureProxy(&s, 0.4, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double       *f = (double *)calloc(3*(size_t)p->n, sizeof(double)), *w = (double *)calloc(3*(size_t)p->n, sizeof(double));
  double       *nodal = (double *)calloc(3*(size_t)s.n_nodes, sizeof(double)), *v = (double *)calloc(3*(size_t)s.n_nodes, sizeof(double)), here = 0.0, there = 0.0;
  unsigned long seed = 17;
  (void)state;
  for (PetscInt i = 0; i < 3*p->n; i++) f[i] = FixtureRandom(&seed) - 0.5;
  for (int i = 0; i < 3*s.n_nodes; i++) v[i] = FixtureRandom(&seed) - 0.5;
  assert_petsc(ProxyForcesToNodes(p, f, nodal));
  assert_petsc(ProxyVelocitiesFromNodes(p, v, w));
  for (PetscInt i = 0; i < 3*p->n; i++) here += f[i]*w[i];
  for (int i = 0; i < 3*s.n_nodes; i++) there += nodal[i]*v[i];
  assert_close(here, there, 1e-13, 1.0);
  free(f);
  free(w);
  free(nodal);
  free(v);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* fields at nodes: a linear field of proxies on a ball as small as their supports within 2 % of its range (the fit is linear, the ball is round); on a
   sheet thinner than h each side has its own; where no proxies are in use it is 0 */
static void fields_at_nodes_follow_those_of_proxies(void **state)
{
  Shape  ball = ShapeSphere(2.5, 10), sheet = ShapeBox(3, 3, 0.1, 12, 12, 1);
  Proxy  p = FixtureProxy(&ball, 0.4, PROXY_KERNEL_HALF_SPACE, 1.0, NULL), q = FixtureProxy(&sheet, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double value[4000], node[4000];
  int    zero = 0;
  const double drop[3] = {0, 0, 2.6}, point[3] = {0, 0, 1};
  (void)state;
  for (PetscInt b = 0; b < p->n; b++) value[2*b] = 5.0 - p->x[3*b + 2], value[2*b + 1] = 1.0;
  assert_petsc(ProxyToNodes(p, 2, value, p->area, node));
  for (int a = 0; a < ball.n_nodes; a++) {
    assert_close(node[2*a], 5.0 - ball.x[3*a + 2], 0.04, 5.0);
    assert_close(node[2*a + 1], 1.0, 1e-13, 1.0);
  }
  for (PetscInt b = 0; b < q->n; b++) value[b] = q->normal[3*b + 2];
  assert_petsc(ProxyToNodes(q, 1, value, NULL, node));
  for (int a = 0; a < sheet.n_nodes; a++) {
    if (fabs(sheet.x[3*a]) < 2.9 && fabs(sheet.x[3*a + 1]) < 2.9) assert_close(node[a], sheet.x[3*a + 2] > 0 ? 1.0 : -1.0, 1e-13, 1.0);
  }
  assert_petsc(ProxyPlaceNear(p, PETSC_TRUE, 1, drop));
  for (PetscInt b = 0; b < p->n; b++) value[b] = 1.0;
  assert_petsc(ProxyToNodes(p, 1, value, NULL, node));
  for (int a = 0; a < ball.n_nodes; a++) {
    zero += node[a] == 0.0;
    if (Dot3(&ball.x[3*a], point) < -2.0) assert_close(node[a], 0.0, 0.0, 1.0);
  }
  assert_true(zero < ball.n_nodes && p->n > 0);
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  ShapeFree(&ball);
  ShapeFree(&sheet);
}

CHECK_MAIN(cmocka_unit_test(force_and_moment_are_kept_to_round_off), cmocka_unit_test(a_push_is_a_push_at_every_node),
           cmocka_unit_test(forces_are_added_and_only_to_the_surface), cmocka_unit_test(a_pressure_loads_each_node_by_its_area),
           cmocka_unit_test(huge_and_tiny_triangles_are_loaded_by_their_area), cmocka_unit_test(velocities_are_the_transpose_of_forces),
           cmocka_unit_test(fields_at_nodes_follow_those_of_proxies))
