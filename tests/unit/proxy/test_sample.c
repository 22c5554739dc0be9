/* test_sample.c - the sampling is complete, spaced as asked, and sees only what it should (method 4.2, 4.5). */
#include "unit/proxy/fixture.h"

static double TotalArea(Proxy p)
{
  const PetscReal *area;
  PetscInt         n;
  double           sum = 0.0;
  assert_petsc(ProxyGetPoints(p, &n, NULL, NULL, NULL, &area));
  for (PetscInt i = 0; i < n; i++) {
    assert_true(area[i] >= 0.0);
    sum += area[i];
  }
  return sum;
}

static void CheckComplete(Shape s)
{
  for (double eta = 1.0; eta > 0.3; eta -= 0.3) {
    Proxy  p    = FixtureProxy(&s, eta, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
    double area = 0.0;
    for (int t = 0; t < s.n_triangles; t++) area += p->geometry.area[t];
    assert_close(TotalArea(p), area, 1e-13, area); // round-off
    for (PetscInt i = 0; i < p->sampling.n; i++) {
      const double *w = &p->sampling.weights[3*i];
      assert_true(w[0] >= 0.0 && w[1] >= 0.0 && w[2] >= 0.0);
      assert_close(w[0] + w[1] + w[2], 1.0, 1e-15, 1.0);
    }
    assert_petsc(ProxyDestroy(&p));
  }
  ShapeFree(&s);
}

static void areas_of_proxies_sum_to_the_surface(void **state)
{
  (void)state;
  CheckComplete(ShapeSphere(2.5, 14));                 // mesh finer than the spacing
  CheckComplete(ShapeSphere(2.5, 2));                  // coarser
  CheckComplete(ShapeBox(2, 1, 0.0625, 9, 4, 1));      // thin, needles at the rim
  CheckComplete(ShapePlate(3, 3, 1, 1, 0));            // two triangles
  CheckComplete(ShapeTorus(4, 1.5, 40, 20));
}

/* wanted number density 4 kappa^2/h^2, whatever the mesh: within 15 % on a sphere */
static void density_is_as_wanted_on_any_mesh(void **state)
{
  (void)state;
  for (int n = 4; n <= 24; n *= 2) {
    Shape s = ShapeSphere(4.0, n);
    for (double eta = 1.0; eta > 0.3; eta -= 0.3) {
      Proxy        p = FixtureProxy(&s, eta, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
      const double wanted = TotalArea(p)*4.0*eta*eta;
      assert_true(p->sampling.n > 0.6*wanted && p->sampling.n < 1.4*wanted);
      assert_petsc(ProxyDestroy(&p));
    }
    ShapeFree(&s);
  }
}

static void no_two_proxies_of_a_patch_are_too_close_and_none_too_far(void **state)
{
  Shape s = ShapeSphere(3.0, 20);
  Proxy p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  (void)state;
  for (PetscInt i = 0; i < p->sampling.n; i++) {
    double nearest = 1e9;
    for (PetscInt j = 0; j < p->sampling.n; j++) {
      double r[3];
      if (i == j) continue;
      Sub3(&p->x[3*i], &p->x[3*j], r);
      nearest = fmin(nearest, Norm3(r));
    }
    assert_true(nearest >= 0.83*0.5*(1.0 - 1e-6)); // thinning
    assert_true(nearest <= 2.0*0.83*0.5);          // greedy: maximal
  }
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* every proxy on a box's edge is there once per face, with that face's normal and part of the area */
static void sharp_edges_have_one_proxy_per_side(void **state)
{
  Shape s = ShapeBox(2, 2, 2, 2, 2, 2);
  Proxy p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  int   corners = 0;
  (void)state;
  for (PetscInt i = 0; i < p->sampling.n; i++) {
    const double *x = &p->x[3*i];
    if (fabs(x[0]) > 1.999 && fabs(x[1]) > 1.999 && fabs(x[2]) > 1.999) corners++;
  }
  assert_int_equal(corners, 24);
  for (int patch = 0; patch < 6; patch++) {
    double area = 0.0;
    for (PetscInt i = 0; i < p->sampling.n; i++) area += p->surface.patch[p->sampling.triangle[i]] == patch ? p->area[i] : 0.0;
    assert_close(area, 16.0, 1e-13, 16.0);
  }
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* a fold of less than 0.03 h^2 does not become a half space of its own */
static void tiny_patches_join_their_neighbours(void **state)
{
  Shape s = ShapePlate(3, 3, 100, 100, 0);
  Proxy p;
  (void)state;
  s.x[3*(50*101 + 50) + 2] = 0.08; // a spike of one vertex, 0.06 wide
  p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  assert_int_equal(p->surface.n_patches, 1);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

CHECK_MAIN(cmocka_unit_test(areas_of_proxies_sum_to_the_surface), cmocka_unit_test(density_is_as_wanted_on_any_mesh),
           cmocka_unit_test(no_two_proxies_of_a_patch_are_too_close_and_none_too_far), cmocka_unit_test(sharp_edges_have_one_proxy_per_side),
           cmocka_unit_test(tiny_patches_join_their_neighbours))
