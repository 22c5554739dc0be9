/* test_density.c - densities and kernels that a scene may ask for: uniform, of one's own, unthinned, spheres (method 4.2, 4.3). */
#include <unistd.h>
#include "unit/proxy/fixture.h"

typedef struct {
  const char *density;
  double      kappa;
  int         kernel, unthinned;
} Wish;

static Proxy Make(const Shape *s, Wish wish)
{
  const ProxyFluid fluid = FixtureFluid();
  ProxyParams     *params;
  Proxy            p;

  assert_petsc(ProxyCreate(PETSC_COMM_SELF, "body", &p));
  assert_petsc(ProxyGetParams(p, &params));
  params->kappa  = wish.kappa;
  params->kernel = wish.kernel;
  params->thin   = wish.unthinned ? PETSC_FALSE : PETSC_TRUE;
  if (wish.density) assert_petsc(PetscStrncpy(params->density, wish.density, sizeof(params->density)));
  assert_petsc(ProxySetSurface(p, s->n_nodes, s->x, s->n_triangles, s->triangles));
  assert_petsc(ProxySetFluidScale(p, &fluid));
  return p;
}

/* proxies left and right of x = 0 */
static void CountSides(Proxy p, int *left, int *right)
{
  *left = *right = 0;
  for (PetscInt i = 0; i < p->sampling.n; i++) *(p->x[3*i] < 0.0 ? left : right) += 1;
}

static void kappa_makes_the_density_uniform(void **state)
{
  Shape s = ShapeCylinder(2, 4, 30, 12);
  Wish  wish = {NULL, 0.5, PROXY_KERNEL_HALF_SPACE, 0};
  Proxy p = Make(&s, wish), q = FixtureProxy(&s, 0.5, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  (void)state;
  assert_petsc(ProxySetUp(p));
  assert_int_equal(p->sampling.n, q->sampling.n); // the fixture's way: both ends of the adaptive range are 0.5
  for (PetscInt i = 0; i < p->sampling.n; i++) assert_true(p->sampling.kappa[i] == 0.5);
  assert_memory_equal(p->x, q->x, 3*sizeof(double)*(size_t)p->sampling.n);
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  ShapeFree(&s);
}

/* half the density on the right: a quarter of the proxies, within what thinning and borders make of it */
static void density_of_ones_own_is_followed(void **state)
{
  Shape   s = ShapePlate(8, 8, 32, 32, 0);
  Wish    wish = {NULL, 0.0, PROXY_KERNEL_HALF_SPACE, 0};
  Proxy   p = Make(&s, wish);
  double *kappa = (double *)malloc(sizeof(double)*(size_t)s.n_nodes);
  int     left, right;
  (void)state;
  for (int v = 0; v < s.n_nodes; v++) kappa[v] = s.x[3*v] < 0.0 ? 1.0 : 0.5;
  assert_petsc(ProxySetDensity(p, kappa));
  assert_petsc(ProxySetUp(p));
  CountSides(p, &left, &right);
  assert_true(left > 3.2*right && left < 4.8*right);
  free(kappa);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

static void a_file_of_points_gives_the_nearest_value(void **state)
{
  Shape       s = ShapePlate(8, 8, 32, 32, 0);
  const char *path = "density_of_a_plate.csv";
  Wish        wish = {path, 0.0, PROXY_KERNEL_HALF_SPACE, 0}, none = {NULL, 0.0, PROXY_KERNEL_HALF_SPACE, 0};
  Proxy       p = Make(&s, wish), q = Make(&s, none);
  double     *kappa = (double *)malloc(sizeof(double)*(size_t)s.n_nodes);
  FILE       *file = fopen(path, "w");
  (void)state;
  assert_non_null(file);
  fprintf(file, "x, y, z, kappa\n-1, 0, 0, 1\n# the right half\n1.1; 0; 0; 0.5\n");
  fclose(file);
  for (int v = 0; v < s.n_nodes; v++) kappa[v] = s.x[3*v] < 0.05 ? 1.0 : 0.5; // halfway
  assert_petsc(ProxySetDensity(q, kappa));
  assert_petsc(ProxySetUp(p));
  assert_petsc(ProxySetUp(q));
  assert_int_equal(p->sampling.n, q->sampling.n);
  assert_memory_equal(p->x, q->x, 3*sizeof(double)*(size_t)p->sampling.n);
  free(kappa);
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  unlink(path);
  ShapeFree(&s);
}

/* what ProxySetUp says to stderr, and its code */
static int Refusal(Proxy p, char text[], size_t n_text)
{
  FILE     *file  = tmpfile();
  const int saved = dup(2);
  int       code;

  fflush(stderr);
  dup2(fileno(file), 2);
  code = (int)ProxySetUp(p);
  fflush(stderr);
  dup2(saved, 2);
  close(saved);
  rewind(file);
  text[fread(text, 1, n_text - 1, file)] = 0;
  fclose(file);
  return code;
}

static void bad_rows_of_a_density_are_refused(void **state)
{
  static const char *const rows[] = {"1, 2, 3\n", "0, 0, 0, 0\n", "0, 0, 0, 4.5\n", "0, 0, 0, 1\n0, 0, x, 1\n", "x, y, z, kappa\n"};
  static const char *const said[] = {"line 1", "line 1", "line 1", "line 2", "no rows"};
  Shape                    s = ShapePlate(1, 1, 2, 2, 0);
  (void)state;
  for (int k = 0; k < 5; k++) {
    const char *path = "density_refused.csv";
    Wish        wish = {path, 0.0, PROXY_KERNEL_HALF_SPACE, 0};
    Proxy       p = Make(&s, wish);
    FILE       *file = fopen(path, "w");
    char        text[1000];
    assert_non_null(file);
    fputs(rows[k], file);
    fclose(file);
    assert_int_equal(Refusal(p, text, sizeof(text)), (int)BY_ERR_INPUT);
    assert_non_null(strstr(text, "body.proxy.density"));
    assert_non_null(strstr(text, said[k]));
    assert_petsc(ProxyDestroy(&p));
    unlink(path);
  }
  ShapeFree(&s);
}

/* the paper's sampling: every vertex of a mesh finer than the spacing has its proxy; thinned, about one in six has */
static void unthinned_sampling_has_every_vertex(void **state)
{
  Shape s = ShapeSphere(2.5, 14);
  Wish  wish = {NULL, 1.0, PROXY_KERNEL_ELLIPSOID, 1}, thinned = {NULL, 1.0, PROXY_KERNEL_ELLIPSOID, 0};
  Proxy p = Make(&s, wish), q = Make(&s, thinned);
  (void)state;
  assert_petsc(ProxySetUp(p));
  assert_petsc(ProxySetUp(q));
  assert_int_equal(p->sampling.n, s.n_nodes);
  assert_true(q->sampling.n < s.n_nodes/3);
  for (PetscInt i = 0; i < p->sampling.n; i++) assert_true(p->points[i].radius[0] == 1.0 && p->points[i].radius[1] == 1.0); // at vertices: spheres
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  ShapeFree(&s);
}

/* a sphere has radius h at any density; at kappa-bar 1 far from borders it is what the ellipsoid is there: same phi to round-off */
static void spheres_stay_spheres(void **state)
{
  Shape        s = ShapePlate(4, 4, 4, 4, 0);
  Wish         sphere = {NULL, 1.0, PROXY_KERNEL_SPHERE, 0}, ellipsoid = {NULL, 1.0, PROXY_KERNEL_ELLIPSOID, 0}, sparse = {NULL, 0.5, PROXY_KERNEL_SPHERE, 0};
  Proxy        p = Make(&s, sphere), q = Make(&s, ellipsoid), r = Make(&s, sparse);
  const double x[3] = {0.1, -0.2, 0.3};
  (void)state;
  assert_petsc(ProxySetUp(p));
  assert_petsc(ProxySetUp(q));
  assert_petsc(ProxySetUp(r));
  for (PetscInt i = 0; i < r->sampling.n; i++) assert_true(r->points[i].radius[0] == 1.0 && r->points[i].radius[1] == 1.0);
  assert_true(FixturePhi(p, x, NULL) > 0.05);
  assert_close(FixturePhi(p, x, NULL), FixturePhi(q, x, NULL), 1e-14, 1.0);
  assert_true(FixtureGradientError(r, x) < 1e-7); // differences of step 1e-5
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  assert_petsc(ProxyDestroy(&r));
  ShapeFree(&s);
}

CHECK_MAIN(cmocka_unit_test(kappa_makes_the_density_uniform), cmocka_unit_test(density_of_ones_own_is_followed),
           cmocka_unit_test(a_file_of_points_gives_the_nearest_value), cmocka_unit_test(bad_rows_of_a_density_are_refused),
           cmocka_unit_test(unthinned_sampling_has_every_vertex), cmocka_unit_test(spheres_stay_spheres))
