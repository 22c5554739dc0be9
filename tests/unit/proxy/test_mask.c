/* test_mask.c - proxies that no fluid can touch are not placed, and nobody notices (method 4.5). */
#include "unit/proxy/fixture.h"

enum { N = 400 };

/* a cloud of particles in a box */
static void Cloud(const double lo[3], const double hi[3], double x[3*N])
{
  unsigned long seed = 7;
  for (int i = 0; i < N; i++) {
    for (int k = 0; k < 3; k++) {
      const double part = FixtureRandom(&seed);
      x[3*i + k] = lo[k] + (hi[k] - lo[k])*part;
    }
  }
}

/* contacts of p, masked, are those of q, all of whose proxies are placed: same bits, same proxies by their number in the sampling */
static void CheckSame(Proxy p, Proxy q, const double x[3*N])
{
  SPHContacts a, b;

  assert_petsc(ProxyFindContacts(p, N, x, &a));
  assert_petsc(ProxyFindContacts(q, N, x, &b));
  assert_int_equal(a.n_touched, b.n_touched);
  assert_memory_equal(a.particle, b.particle, sizeof(PetscInt)*(size_t)a.n_touched);
  assert_memory_equal(a.phi, b.phi, sizeof(double)*(size_t)a.n_touched);
  assert_memory_equal(a.grad, b.grad, 3*sizeof(double)*(size_t)a.n_touched);
  assert_memory_equal(a.position, b.position, 3*sizeof(double)*(size_t)a.n_touched);
  assert_memory_equal(a.share, b.share, 3*sizeof(double)*(size_t)b.start[b.n_touched]);
  for (PetscInt i = 0; i < b.start[b.n_touched]; i++) assert_int_equal(p->active[a.proxy[i]], q->active[b.proxy[i]]);
}

static void CheckShape(Shape s, int kernel, const ProxyFluid *fluid, const double lo[3], const double hi[3], double most)
{
  Proxy p = FixtureProxy(&s, 0.5, kernel, 0.0, fluid), q = FixtureProxy(&s, 0.5, kernel, 0.0, fluid), r = FixtureProxy(&s, 0.5, kernel, 0.0, fluid);
  double x[3*N], far[3*N];

  Cloud(lo, hi, x);
  for (int i = 0; i < 3*N; i++) far[i] = x[i] + (fluid ? 0.0 : 30.0);
  // as of a surface that has just moved; and as of one at rest, which water comes to
  assert_petsc(ProxyPlaceNear(p, PETSC_TRUE, N, x));
  assert_petsc(ProxyPlaceNear(r, PETSC_FALSE, N, far));
  if (!fluid) assert_int_equal(r->n, 0);
  assert_petsc(ProxyPlaceNear(r, PETSC_FALSE, N, x));
  assert_true(p->n > 0 && p->n < most*q->n);
  assert_int_equal(p->n, r->n);
  assert_memory_equal(p->active, r->active, sizeof(PetscInt)*(size_t)p->n);
  assert_memory_equal(p->points, r->points, sizeof(ProxyPoint)*(size_t)p->n);
  CheckSame(p, q, x);
  CheckSame(r, q, x);
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  assert_petsc(ProxyDestroy(&r));
  ShapeFree(&s);
}

static void what_is_left_out_touches_nothing(void **state)
{
  const double lo[3] = {5, -2, -2}, hi[3] = {8, 2, 2}, low[3] = {-9, -9, -9}, up[3] = {9, 9, -6.1};
  (void)state;
  CheckShape(ShapeSphere(6.0, 12), PROXY_KERNEL_HALF_SPACE, NULL, lo, hi, 0.35);
  CheckShape(ShapeSphere(6.0, 12), PROXY_KERNEL_ELLIPSOID, NULL, lo, hi, 0.35);
  CheckShape(ShapeSphere(6.0, 12), PROXY_KERNEL_SPHERE, NULL, lo, hi, 0.35);
  CheckShape(ShapeBox(6, 6, 6, 6, 6, 6), PROXY_KERNEL_HALF_SPACE, NULL, low, up, 0.5); // one face, and the feet of four others
}

/* a body across the periodic border: the water is on the other side of the box */
static void periodic_images_are_near(void **state)
{
  const ProxyFluid fluid = {1.0, 0.5, SPH_CUBIC, SPH_CUBIC, {-4, -50, -50}, {16, 50, 50}, 1u, 0, {0}};
  const double     lo[3] = {14.5, -2, -2}, hi[3] = {15.9, 2, 2};
  (void)state;
  CheckShape(ShapeSphere(4.5, 12), PROXY_KERNEL_HALF_SPACE, &fluid, lo, hi, 0.5);
}

static void dry_surfaces_cost_no_proxies(void **state)
{
  Shape       s = ShapeSphere(2.0, 8);
  Proxy       p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  const double x[3] = {30, 30, 30};
  double       force = 1.0, node[3] = {0, 0, 0};
  SPHContacts c;
  (void)state;
  assert_petsc(ProxyPlaceNear(p, PETSC_TRUE, 1, x));
  assert_int_equal(p->n, 0);
  assert_petsc(ProxyFindContacts(p, 1, x, &c));
  assert_int_equal(c.n_touched, 0);
  assert_int_equal(c.n_proxies, 0);
  assert_petsc(ProxyTransfer(p, &force, NULL, node));
  assert_true(node[0] == 0.0);
  assert_petsc(ProxyPlaceNear(p, PETSC_TRUE, 0, x)); // no fluid at all
  assert_int_equal(p->n, 0);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

CHECK_MAIN(cmocka_unit_test(what_is_left_out_touches_nothing), cmocka_unit_test(periodic_images_are_near), cmocka_unit_test(dry_surfaces_cost_no_proxies))
