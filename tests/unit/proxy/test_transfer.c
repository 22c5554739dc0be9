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

CHECK_MAIN(cmocka_unit_test(force_and_moment_are_kept_to_round_off), cmocka_unit_test(a_push_is_a_push_at_every_node),
           cmocka_unit_test(forces_are_added_and_only_to_the_surface))
