/* test_curvature.c - Gaussian curvature, normals and shape operators on shapes that have exact ones (method 4.1). */
#include "unit/proxy/fixture.h"

static void CheckTotal(Shape s, double chi)
{
  Proxy     p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  PetscReal total;
  assert_petsc(ProxyGetTotalCurvature(p, &total));
  assert_close(total, 2.0*M_PI*chi, 1e-12, s.n_nodes); // round-off of the angles
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

static void total_curvature_is_2_pi_chi(void **state)
{
  (void)state;
  CheckTotal(ShapeSphere(2.5, 6), 2);
  CheckTotal(ShapeBox(1, 2, 3, 3, 5, 7), 2);
  CheckTotal(ShapeCylinder(2, 5, 24, 9), 2);
  CheckTotal(ShapeTorus(5, 2, 24, 12), 0);
}

static void curvature_of_a_sphere_is_one_over_r_squared(void **state)
{
  Shape      s = ShapeSphere(2.5, 16);
  Proxy      p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  PetscReal *kappa = (PetscReal *)malloc(sizeof(PetscReal)*(size_t)s.n_nodes), *area = (PetscReal *)malloc(sizeof(PetscReal)*(size_t)s.n_nodes), sum = 0.0;
  (void)state;
  assert_petsc(ProxyGaussianCurvature(&p->surface, p->geometry.x, kappa, area));
  for (int v = 0; v < s.n_nodes; v++) {
    assert_close(kappa[v], 1.0/6.25, 0.02, 1.0/6.25); // edge^2/R^2
    sum += area[v];
  }
  for (int t = 0; t < s.n_triangles; t++) sum -= p->geometry.area[t];
  assert_close(sum, 0.0, 1e-12, 100.0); // mixed areas tile the surface
  free(kappa);
  free(area);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

static void vertex_normals_and_shapes_of_a_sphere_are_exact(void **state)
{
  Shape s = ShapeSphere(2.5, 7);
  Proxy p;
  (void)state;
  // crooked: the sphere's parametrisation twisted about z, still on the sphere
  for (int v = 0; v < s.n_nodes; v++) {
    const double a = 0.3*s.x[3*v + 2], x = s.x[3*v], y = s.x[3*v + 1];
    s.x[3*v] = cos(a)*x - sin(a)*y, s.x[3*v + 1] = sin(a)*x + cos(a)*y;
  }
  p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  for (int i = 0; i < 3*s.n_triangles; i++) {
    for (int k = 0; k < 3; k++) assert_close(p->geometry.fan_normal[3*p->surface.fan[i] + k], s.x[3*s.triangles[i] + k]/2.5, 1e-12, 1.0); // Max 1999
  }
  for (int t = 0; t < s.n_triangles; t++) {
    const double *S = &p->geometry.shape[6*t];
    assert_close(S[0] + S[1] + S[2], 2.0/2.5, 1e-11, 1.0);
  }
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

static void boxes_have_flat_patches_with_exact_normals(void **state)
{
  Shape s = ShapeBox(2, 1, 1.5, 7, 4, 5);
  Proxy p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  (void)state;
  assert_int_equal(p->surface.n_patches, 6);
  for (PetscInt i = 0; i < p->sampling.n; i++) {
    const double *n = p->points[i].n, most = fmax(fabs(n[0]), fmax(fabs(n[1]), fabs(n[2])));
    assert_close(most, 1.0, 1e-15, 1.0);
    for (int k = 0; k < 6; k++) assert_close(p->points[i].S[k], 0.0, 1e-12, 1.0);
  }
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

static void cylinders_have_one_principal_curvature_and_sharp_rims(void **state)
{
  Shape s = ShapeCylinder(2.5, 6, 80, 30);
  Proxy p = FixtureProxy(&s, 1.0, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  int   sides = 0;
  (void)state;
  assert_int_equal(p->surface.n_patches, 3);
  for (PetscInt i = 0; i < p->sampling.n; i++) {
    if (fabs(p->points[i].n[2]) > 0.5) continue;
    sides++;
    assert_close(p->points[i].bend, 0.4, 0.01, 0.4); // facets: (2 pi/80)^2
    assert_close(0.5*(p->points[i].S[0] + p->points[i].S[1] + p->points[i].S[2]), 0.2, 0.01, 0.2);
    assert_close(p->points[i].S[2], 0.0, 1e-12, 1.0); // along the axis
  }
  assert_true(sides > 100);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* one spike on a torus: the paper's range gives nearly everything else eta_min, the robust one keeps the rest apart */
static void one_spike_does_not_flatten_the_rest(void **state)
{
  Shape     s = ShapeTorus(4, 1.6, 60, 30);
  PetscReal mean[2];
  (void)state;
  for (int k = 0; k < 3; k++) s.x[3*100 + k] *= 1.25;
  for (int range = 0; range < 2; range++) {
    const ProxyFluid fluid = FixtureFluid();
    ProxyParams     *params;
    Proxy            p;
    const PetscReal *kappa;
    PetscInt         n;
    assert_petsc(ProxyCreate(PETSC_COMM_SELF, "body", &p));
    assert_petsc(ProxyGetParams(p, &params));
    params->range = range;
    assert_petsc(ProxySetSurface(p, s.n_nodes, s.x, s.n_triangles, s.triangles));
    assert_petsc(ProxySetFluidScale(p, &fluid));
    assert_petsc(ProxySetUp(p));
    assert_petsc(ProxyGetPoints(p, &n, NULL, NULL, &kappa, NULL));
    mean[range] = 0.0;
    for (PetscInt i = 0; i < n; i++) {
      assert_true(kappa[i] >= 0.4 - 1e-12 && kappa[i] <= 1.0 + 1e-12);
      mean[range] += kappa[i]/n;
    }
    assert_petsc(ProxyDestroy(&p));
  }
  assert_true(mean[PROXY_RANGE_MINMAX] < 0.5);
  assert_true(mean[PROXY_RANGE_ROBUST] > 0.6);
  ShapeFree(&s);
}

CHECK_MAIN(cmocka_unit_test(total_curvature_is_2_pi_chi), cmocka_unit_test(curvature_of_a_sphere_is_one_over_r_squared),
           cmocka_unit_test(vertex_normals_and_shapes_of_a_sphere_are_exact), cmocka_unit_test(boxes_have_flat_patches_with_exact_normals),
           cmocka_unit_test(cylinders_have_one_principal_curvature_and_sharp_rims), cmocka_unit_test(one_spike_does_not_flatten_the_rest))
