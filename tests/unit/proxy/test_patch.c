/* test_patch.c - force on a part of a surface: exact areas, every newton counted once, whatever the density of the proxies. */
#include "unit/proxy/fixture.h"

/* forces of a uniform pressure on every proxy's area */
static PetscReal *Pressed(Proxy p, double pressure)
{
  PetscReal *f = (PetscReal *)malloc(3*sizeof(PetscReal)*(size_t)p->n);
  for (PetscInt i = 0; i < 3*p->n; i++) f[i] = -pressure*p->area[i/3]*p->normal[i];
  return f;
}

static void a_uniform_pressure_is_read_on_any_patch(void **state)
{
  Shape s = ShapeBox(3, 2, 2, 3, 2, 2);
  (void)state;
  for (double eta = 1.0; eta > 0.3; eta -= 0.3) {
    Proxy      p = FixtureProxy(&s, eta, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
    PetscReal *f = Pressed(p, 700.0), push, area;
    // flat, of 0.37 by 0.5 h on one face: far smaller than the spacing of the sparsest; then a box that cuts three faces at a corner
    const double lo[2][3] = {{0.13, -0.4, 2.0}, {2.2, 1.3, 0.9}}, hi[2][3] = {{0.5, 0.1, 2.0}, {9, 9, 9}}, exact[2] = {0.37*0.5, 0.8*0.7 + 0.8*1.1 + 0.7*1.1};
    for (int k = 0; k < 2; k++) {
      assert_petsc(ProxyGetPatch(p, lo[k], hi[k], f, &push, &area));
      assert_close(area, exact[k], 2e-5, 1.0); // the box reaches 1e-6 dx beyond itself
      assert_close(push/area, 700.0, 1e-12, 700.0);
    }
    free(f);
    assert_petsc(ProxyDestroy(&p));
  }
  ShapeFree(&s);
}

/* patches that cover a curved surface share its force without rest; one that misses it has no area */
static void patches_add_up(void **state)
{
  Shape         s = ShapeSphere(2.0, 8);
  Proxy         p = FixtureProxy(&s, 0.4, PROXY_KERNEL_HALF_SPACE, 1.0, NULL);
  PetscReal    *f = Pressed(p, 1.0), push, area, total = 0.0, pushes = 0.0, all = 0.0;
  unsigned long seed = 3;
  (void)state;
  for (PetscInt i = 0; i < p->n; i++) {
    const double weight = FixtureRandom(&seed);
    for (int k = 0; k < 3; k++) f[3*i + k] *= weight;
    all -= Dot3(&f[3*i], &p->normal[3*i]);
  }
  for (int i = 0; i < 27; i++) {
    const double lo[3] = {-3.0 + 2.0*(i%3), -3.0 + 2.0*(i/3%3), -3.0 + 2.0*(i/9)}, hi[3] = {lo[0] + 2.0, lo[1] + 2.0, lo[2] + 2.0};
    assert_petsc(ProxyGetPatch(p, lo, hi, f, &push, &area));
    pushes += push;
    total += area;
  }
  for (int t = 0; t < s.n_triangles; t++) total -= p->geometry.area[t];
  assert_close(total, 0.0, 1e-4, 1.0); // overlap of 1e-6 dx along the cuts
  assert_close(pushes, all, 1e-4, 1.0);
  const double lo[3] = {-0.5, -0.5, -0.5}, hi[3] = {0.5, 0.5, 0.5};
  assert_petsc(ProxyGetPatch(p, lo, hi, f, &push, &area));
  assert_true(area == 0.0);
  free(f);
  assert_petsc(ProxyDestroy(&p));
  ShapeFree(&s);
}

CHECK_MAIN(cmocka_unit_test(a_uniform_pressure_is_read_on_any_patch), cmocka_unit_test(patches_add_up))
