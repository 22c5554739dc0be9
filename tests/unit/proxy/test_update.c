/* test_update.c - proxies move with their surface, are sampled afresh when it has changed, and come back after a restart (method 4.5). */
#include "unit/proxy/fixture.h"

/* x -> R x + t */
static void Move(const double x[3], double y[3])
{
  const double c = cos(0.7), s = sin(0.7);
  y[0] = c*x[0] - s*x[1] + 1.3;
  y[1] = s*x[0] + c*x[1] - 0.4;
  y[2] = x[2] + 2.0;
}

static void rigid_motion_moves_phi_along_and_samples_nothing(void **state)
{
  Shape         s = ShapeCylinder(2, 4, 30, 12);
  Proxy         p = FixtureProxy(&s, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double        before[50], x[50][3], *moved = (double *)malloc(3*sizeof(double)*(size_t)s.n_nodes);
  unsigned long seed = 12;
  (void)state;
  for (int i = 0; i < 50; i++) {
    for (int k = 0; k < 3; k++) x[i][k] = 5.5*(FixtureRandom(&seed) - 0.5);
    before[i] = FixturePhi(p, x[i], NULL);
  }
  for (int v = 0; v < s.n_nodes; v++) Move(&s.x[3*v], &moved[3*v]);
  assert_petsc(ProxyUpdate(p, moved, NULL));
  assert_int_equal(p->n_samplings, 1);
  for (int i = 0; i < 50; i++) {
    double y[3];
    Move(x[i], y);
    assert_close(FixturePhi(p, y, NULL), before[i], 1e-11, 1.0); // round-off through normals and curvatures
  }
  free(moved);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

static void areas_follow_and_sampling_waits_for_the_tolerance(void **state)
{
  Shape   s = ShapeSphere(2.0, 8);
  Proxy   p = FixtureProxy(&s, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double *x = (double *)malloc(3*sizeof(double)*(size_t)s.n_nodes), area = 0.0;
  (void)state;
  for (int i = 0; i < 3*s.n_nodes; i++) x[i] = 1.04*s.x[i]; // areas by 8 %
  assert_petsc(ProxyUpdate(p, x, NULL));
  assert_int_equal(p->n_samplings, 1);
  for (PetscInt i = 0; i < p->sampling.n; i++) area += p->area[i];
  for (int t = 0; t < s.n_triangles; t++) area -= p->geometry.area[t];
  assert_close(area, 0.0, 1e-12, 50.0);
  for (int i = 0; i < 3*s.n_nodes; i++) x[i] = 1.06*s.x[i]; // 12 %
  assert_petsc(ProxyUpdate(p, x, NULL));
  assert_int_equal(p->n_samplings, 2);
  assert_petsc(ProxyUpdate(p, x, NULL)); // not moved
  assert_int_equal(p->n_samplings, 2);
  p->params.resample_tolerance = 0.0;
  x[0] += 1e-9;
  assert_petsc(ProxyUpdate(p, x, NULL));
  assert_int_equal(p->n_samplings, 3);
  free(x);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* a ball of another size is that ball */
static void an_inflated_ball_acts_as_the_larger_ball(void **state)
{
  Shape   s = ShapeSphere(2.0, 14);
  Proxy   p = FixtureProxy(&s, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double *x = (double *)malloc(3*sizeof(double)*(size_t)s.n_nodes);
  (void)state;
  const double same = 1.5*cbrt(ShapeVolume(&s)*3.0/(4.0*M_PI));
  for (int i = 0; i < 3*s.n_nodes; i++) x[i] = 1.5*s.x[i];
  assert_petsc(ProxyUpdate(p, x, NULL));
  for (int i = 0; i < 20; i++) {
    const double at[3] = {3.2*cos(1.0*i), 3.2*sin(1.0*i), 0.0};
    assert_close(FixturePhi(p, at, NULL), FixtureBallPart(SPH_CUBIC, 3.2, same), 0.001, 1.0); // facets
  }
  free(x);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* a proxy has the mean velocity of what it stands for: of a linear field that in its middle */
static void velocities_are_those_of_the_parts_middles(void **state)
{
  Shape       s = ShapeBox(2, 1, 1, 6, 3, 3);
  Proxy       p = FixtureProxy(&s, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double     *v = (double *)malloc(3*sizeof(double)*(size_t)s.n_nodes);
  const double x[3] = {0, 0, 1.2};
  SPHContacts c;
  (void)state;
  assert_petsc(ProxyFindContacts(p, 1, x, &c));
  assert_null(c.velocity);
  for (int a = 0; a < s.n_nodes; a++) { // linear field: exact
    v[3*a] = 1.0 + 2.0*s.x[3*a + 1], v[3*a + 1] = -s.x[3*a + 2], v[3*a + 2] = 0.5;
  }
  assert_petsc(ProxySetVelocity(p, v));
  assert_petsc(ProxyFindContacts(p, 1, x, &c));
  for (PetscInt b = 0; b < c.n_proxies; b++) {
    assert_close(c.velocity[3*b], 1.0 + 2.0*c.place[3*b + 1], 1e-14, 1.0);
    assert_close(c.velocity[3*b + 1], -c.place[3*b + 2], 1e-14, 1.0);
  }
  assert_petsc(ProxySetVelocity(p, NULL));
  assert_petsc(ProxyFindContacts(p, 1, x, &c));
  assert_null(c.velocity);
  free(v);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* a restart samples at the stored positions and moves on to the current ones: same bits */
static void a_restart_gives_the_same_proxies(void **state)
{
  Shape            s = ShapeSphere(2.0, 8);
  Proxy            p = FixtureProxy(&s, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL), q = FixtureProxy(&s, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  double          *x = (double *)malloc(3*sizeof(double)*(size_t)s.n_nodes);
  const PetscReal *sampled;
  (void)state;
  for (int step = 1; step <= 7; step++) {
    for (int v = 0; v < s.n_nodes; v++) {
      x[3*v] = s.x[3*v]*(1.0 + 0.05*step), x[3*v + 1] = s.x[3*v + 1], x[3*v + 2] = s.x[3*v + 2]*(1.0 - 0.02*step);
    }
    assert_petsc(ProxyUpdate(p, x, NULL));
  }
  assert_true(p->n_samplings > 1);
  assert_petsc(ProxyGetSampling(p, &sampled));
  assert_petsc(ProxySetSampling(q, sampled));
  assert_petsc(ProxyUpdate(q, x, NULL));
  assert_int_equal(q->sampling.n, p->sampling.n);
  assert_memory_equal(q->points, p->points, sizeof(ProxyPoint)*(size_t)p->sampling.n);
  free(x);
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  ShapeFree(&s);
}

/* radii of ellipsoids grow with their edge and the root of their triangle's area (method 4.3) */
static void ellipsoids_stretch_with_the_surface(void **state)
{
  Shape   s = ShapePlate(3, 3, 3, 3, 0);
  Proxy   p = FixtureProxy(&s, 0.6, PROXY_KERNEL_ELLIPSOID, 0.0, NULL);
  double *x = (double *)malloc(3*sizeof(double)*(size_t)s.n_nodes);
  (void)state;
  p->params.resample_tolerance = 10.0;
  for (int v = 0; v < s.n_nodes; v++) x[3*v] = 1.44*s.x[3*v], x[3*v + 1] = s.x[3*v + 1], x[3*v + 2] = 0.0;
  assert_petsc(ProxyUpdate(p, x, NULL));
  for (PetscInt i = 0; i < p->sampling.n; i++) {
    const ProxyPoint *b = &p->points[i];
    const double      y = fmax(fabs(p->x[3*i]/1.44), fabs(p->x[3*i + 1]));
    if (p->sampling.kind[i] == PROXY_FACE) assert_close(b->radius[0], 1.2/0.6, 1e-12, 1.0);
    if (y < 2.999) { // inside the plate
      assert_close(b->radius[0], 1.2/0.6, 1e-12, 1.0);
      assert_close(b->radius[1], 1.2/0.6, 1e-12, 1.0);
      continue;
    }
    assert_close(b->radius[1], 1.0, 1e-12, 1.0); // its border is sharp
    if (p->sampling.kind[i] == PROXY_EDGE && fabs(b->e[0]) > 0.999) assert_close(b->radius[0], 1.44/0.6, 1e-12, 1.0);
    if (p->sampling.kind[i] == PROXY_EDGE && fabs(b->e[1]) > 0.999) assert_close(b->radius[0], 1.0/0.6, 1e-12, 1.0);
    if (p->sampling.kind[i] == PROXY_VERTEX) assert_close(b->radius[0], 1.0, 1e-12, 1.0);
  }
  free(x);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

/* the half x > 0 of a plate turned up about the y axis by an angle [degree] */
static void Fold(const Shape *s, double angle, double x[])
{
  const double c = cos(angle*M_PI/180.0), d = sin(angle*M_PI/180.0);
  for (int v = 0; v < s->n_nodes; v++) {
    const double r = s->x[3*v];
    x[3*v] = r > 0.0 ? c*r : r, x[3*v + 1] = s->x[3*v + 1], x[3*v + 2] = r > 0.0 ? d*r : 0.0;
  }
}

/* a flat plate that is folded acts as the plate that was folded from the start, on the crease's inside and outside, and flat again as the flat one */
static void a_crease_made_by_deformation_is_an_edge(void **state)
{
  Shape         flat = ShapePlate(4, 3, 16, 12, 0), folded = ShapePlate(4, 3, 16, 12, 0);
  Proxy         p = FixtureProxy(&flat, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL), restarted = FixtureProxy(&flat, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL), q;
  double       *x = (double *)malloc(3*sizeof(double)*(size_t)flat.n_nodes);
  const double  at[3] = {-0.3, 0.1, 0.3}, before = FixturePhi(p, at, NULL);
  unsigned long seed = 5;
  (void)state;
  for (int step = 1; step <= 9; step++) {
    Fold(&flat, 10.0*step, x);
    assert_petsc(ProxyUpdate(p, x, NULL));
    assert_int_equal(p->n_samplings, step < 5 ? 1 : 2); // 45 degrees and more: once
  }
  assert_petsc(ProxyUpdate(p, x, NULL));
  assert_int_equal(p->surface.n_patches, 2);
  memcpy(folded.x, x, 3*sizeof(double)*(size_t)flat.n_nodes);
  q = FixtureProxy(&folded, 0.6, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  for (int i = 0; i < 60; i++) {
    double y[3];
    for (int k = 0; k < 3; k++) y[k] = 1.6*(FixtureRandom(&seed) - 0.5);
    const double phi = FixturePhi(p, y, NULL), one = SPHHalfSpace(SPH_CUBIC, y[2], 1.0), other = SPHHalfSpace(SPH_CUBIC, -y[0], 1.0);
    assert_close(phi, FixturePhi(q, y, NULL), 0.04, 1.0); // behind the edge proxies have other places: sampled at 50 degrees
    if (y[0] < 0.0 && y[2] > 0.0) assert_close(phi, one + other - one*other, 1e-12, 1.0); // in the corner: two planar walls
  }

  // a restart knows the crease from where the surface was sampled
  const PetscReal *sampled;
  assert_petsc(ProxyGetSampling(p, &sampled));
  assert_petsc(ProxySetSampling(restarted, sampled));
  assert_petsc(ProxyUpdate(restarted, x, NULL));
  assert_int_equal(restarted->n, p->n);
  assert_memory_equal(restarted->points, p->points, sizeof(ProxyPoint)*(size_t)p->n);
  assert_petsc(ProxyUpdate(p, flat.x, NULL));
  assert_int_equal(p->surface.n_patches, 1);
  assert_close(FixturePhi(p, at, NULL), before, 1e-12, 1.0);
  free(x);
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  assert_petsc(ProxyDestroy(&restarted));
  ShapeFree(&flat);
  ShapeFree(&folded);
}

CHECK_MAIN(cmocka_unit_test(rigid_motion_moves_phi_along_and_samples_nothing), cmocka_unit_test(areas_follow_and_sampling_waits_for_the_tolerance),
           cmocka_unit_test(an_inflated_ball_acts_as_the_larger_ball), cmocka_unit_test(velocities_are_those_of_the_parts_middles),
           cmocka_unit_test(a_restart_gives_the_same_proxies), cmocka_unit_test(ellipsoids_stretch_with_the_surface),
           cmocka_unit_test(a_crease_made_by_deformation_is_an_edge))
