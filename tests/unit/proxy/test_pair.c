/* test_pair.c - two bodies near each other: the union 1 - (1 - phi_1)(1 - phi_2) that the fluid takes of them, down to a slot without width, against the
   part of the kernel that two boxes fill. */
#include "unit/proxy/fixture.h"

typedef struct {
  double above, mouth, slot; /* largest errors: above the slot and beside it; at its mouth; within it */
} Errors;

/* cubes of side 4 to both sides of a slot of width w around x = 0, their roofs at z = 2; lies: the right one is told of the left one */
static Errors SlotErrors(double w, int lies, int kernel)
{
  Shape        left = ShapeBox(2, 2, 2, 4, 4, 4), right = ShapeBox(2, 2, 2, 4, 4, 4);
  const double half[3] = {2, 2, 2}, lo[3] = {-5, -3, -3}, hi[3] = {0, 3, 3};
  Errors       most = {0, 0, 0};
  PetscInt    *triangles = (PetscInt *)malloc(3*sizeof(PetscInt)*(size_t)left.n_triangles);
  SurfaceIndex index;
  Proxy        p, q;

  for (int v = 0; v < left.n_nodes; v++) left.x[3*v] -= 2.0 + 0.5*w, right.x[3*v] += 2.0 + 0.5*w;
  for (int i = 0; i < 3*left.n_triangles; i++) triangles[i] = left.triangles[i];
  p = FixtureProxy(&left, 1.0, kernel, 1.0, NULL), q = FixtureProxy(&right, 1.0, kernel, 1.0, NULL);
  assert_petsc(SurfaceIndexCreate(left.n_nodes, left.x, left.n_triangles, triangles, PROXY_NEIGHBOUR_REACH, &index));
  if (lies) {
    assert_petsc(ProxyAddNeighbour(q, index, lo, hi));
    ProxyExpose(q);
    assert_true(q->hides == (w < 0.25 ? PETSC_TRUE : PETSC_FALSE));
  }
  for (int i = 0; i < 50; i++) {
    const double x[3] = {i < 45 ? 0.23*(i%9 - 4) : 0.0, 0.1, i < 45 ? 2.05 + 0.18*(i/9) : 1.9 - 0.36*(i - 45)};
    const double a[3] = {x[0] + 2.0 + 0.5*w, x[1], x[2]}, b[3] = {x[0] - 2.0 - 0.5*w, x[1], x[2]};
    if (i >= 45 && w == 0.0) continue;
    if (i%7 == 0) assert_true(FixtureGradientError(q, x) < (kernel == PROXY_KERNEL_HALF_SPACE ? 1e-6 : 1e-4)); // differences of 1e-5, across knots
    const double exact = FixtureBoxPart(a, half) + FixtureBoxPart(b, half), phi = 1.0 - (1.0 - FixturePhi(p, x, NULL))*(1.0 - FixturePhi(q, x, NULL));
    double      *to = i >= 45 ? &most.slot : fabs(x[0]) < 0.3 && x[2] < 2.3 ? &most.mouth : &most.above;
    *to = fmax(*to, fabs(phi - exact));
  }
  free(triangles);
  assert_petsc(SurfaceIndexDestroy(&index));
  assert_petsc(ProxyDestroy(&p));
  assert_petsc(ProxyDestroy(&q));
  ShapeFree(&left);
  ShapeFree(&right);
  return most;
}

/* lambda^2/4 at a joint, which is 0.06 at most: a dent of 0.03 h. Within slots narrower than a spacing it is low, more so
   where one face lies on the other: no particle fits there */
static void the_union_of_two_bodies_is_near_the_truth(void **state)
{
  static const double width[] = {0.0, 0.1, 0.25, 0.5, 1.0}, within[] = {0.0, 0.19, 0.12, 0.04, 0.005};
  (void)state;
  for (int lies = 0; lies < 2; lies++) {
    for (int k = 0; k < 5; k++) {
      const Errors e = SlotErrors(width[k], lies, PROXY_KERNEL_HALF_SPACE);
      print_message("slot of %.2f h, %s: above %.4f, mouth %.4f, within %.4f\n", width[k], lies ? "told" : "not told", e.above, e.mouth, e.slot);
      assert_true(e.above < (lies ? 0.03 : 0.01) && e.mouth < (lies ? 0.12 : 0.06) && e.slot <= (lies ? 2.5 : 1.0)*within[k]);
    }
  }
  (void)SlotErrors(0.1, 1, PROXY_KERNEL_ELLIPSOID); // gradients
}

CHECK_MAIN(cmocka_unit_test(the_union_of_two_bodies_is_near_the_truth))
