/* test_kernel.c - the pair formulas against integrals and differences (method 4.3, 4.4). */
#include "unit/proxy/fixture.h"

/* h K = int 2 s (h A)(s) ds by the midpoint rule */
static void plane_moment_is_the_integral_of_its_definition(void **state)
{
  (void)state;
  for (int kernel = 0; kernel < SPH_N_KERNELS; kernel++) {
    for (double q = 0.0; q < 1.0; q += 0.09) {
      const int n   = 20000;
      double    sum = 0.0;
      for (int i = 0; i < n; i++) {
        const double t = sqrt(1.0 - q*q)*(i + 0.5)/n, r = sqrt(q*q + t*t);
        sum += 2.0*M_PI*t*t*t*SPHKernelW(kernel, 2.0*r, 2.0)*8.0*sqrt(1.0 - q*q)/n; // h = 2: W has 1/h^3, h K has h^3/h^3
      }
      assert_close(ProxyPlaneMoment(kernel, 2.0*q, 2.0)*2.0, sum, 1e-8, 0.2); // midpoint rule
    }
  }
}

/* a proxy whose osculating surface has principal curvatures k1 (along x) and k2 (along y) */
static ProxyPoint Point(double k1, double k2)
{
  ProxyPoint b;
  memset(&b, 0, sizeof(b));
  b.n[2]      = 1.0;
  b.e[0]      = 1.0;
  b.S[0]      = k1;
  b.S[1]      = k2;
  b.bend      = ProxyShapeBend(b.S);
  b.radius[0] = b.radius[1] = 1.0;
  b.weight    = 0.3;
  for (int k = 0; k < 8; k++) b.extent[k] = 0.3 + 0.02*k;
  return b;
}

static double Height(const ProxyPoint *b, const double r[3], double grad[3])
{
  const double z0 = Dot3(b->n, r), t[3] = {r[0] - z0*b->n[0], r[1] - z0*b->n[1], r[2] - z0*b->n[2]};
  return ProxyHeight(b, z0, t, grad);
}

static void height_is_the_distance_from_planes_balls_and_cylinders(void **state)
{
  unsigned long seed = 3;
  (void)state;
  for (int i = 0; i < 200; i++) {
    const double     k = 1.6*FixtureRandom(&seed) - 0.8;
    double           r[3];
    for (int d = 0; d < 3; d++) r[d] = d < 2 ? FixtureRandom(&seed) - 0.5 : 0.8*FixtureRandom(&seed);
    const ProxyPoint plane = Point(0, 0), ball = Point(k, k), cylinder = Point(k, 0);
    const double     c = r[2] + 1.0/k, sign = k > 0.0 ? 1.0 : -1.0;
    double           grad[3];
    // round-off of 1/k - sqrt(...)
    assert_close(Height(&plane, r, grad), r[2], 1e-14, 1.0);
    assert_close(Height(&ball, r, grad), sign*sqrt(r[0]*r[0] + r[1]*r[1] + c*c) - 1.0/k, 1e-13, 1.0 + 1.0/fabs(k));
    assert_close(Height(&cylinder, r, grad), sign*sqrt(r[0]*r[0] + c*c) - 1.0/k, 1e-13, 1.0 + 1.0/fabs(k));
  }
}

static void profile_over_a_ball_is_the_kernels_part_in_the_ball(void **state)
{
  (void)state;
  for (int kernel = 0; kernel < SPH_N_KERNELS; kernel++) {
    for (double R = 1.25; R < 6.0; R *= 2.0) {
      const ProxyPoint b = Point(1.0/R, 1.0/R);
      for (double d = 0.05; d < 1.0; d += 0.1) {
        const double r[3] = {0, 0, d};
        ProxyPair    pair = {0};
        assert_true(ProxyPairHalfSpace(kernel, kernel, 1.0, &b, r, &pair));
        assert_close(pair.lambda, FixtureBallPart(kernel, R + d, R), 2e-7, 1.0); // midpoint rule
      }
    }
  }
}

/* gradients of weight, profile, height and coverage against central differences */
static void half_space_gradients_are_exact(void **state)
{
  const double curvature[][2] = {{0, 0}, {0.4, 0.4}, {0.4, 0.0}, {0.7, -0.5}, {-0.6, -0.6}};
  const double d = 1e-6;
  unsigned long seed = 5;
  (void)state;
  for (int c = 0; c < 5; c++) {
    const ProxyPoint b = Point(curvature[c][0], curvature[c][1]);
    for (int i = 0; i < 200; i++) {
      double    r[3];
      ProxyPair p, lo, hi;
      for (int k = 0; k < 3; k++) r[k] = 1.6*FixtureRandom(&seed) - (k < 2 ? 0.8 : 0.4);
      if (!ProxyPairHalfSpace(SPH_CUBIC, SPH_CUBIC, 1.0, &b, r, &p)) continue;
      for (int k = 0; k < 3; k++) {
        double a[3] = {r[0], r[1], r[2]}, e[3] = {r[0], r[1], r[2]};
        a[k] += d, e[k] -= d;
        if (!ProxyPairHalfSpace(SPH_CUBIC, SPH_CUBIC, 1.0, &b, a, &hi) || !ProxyPairHalfSpace(SPH_CUBIC, SPH_CUBIC, 1.0, &b, e, &lo)) continue;
        // differences: d^2 third derivatives, some hundred in the fades
        assert_close((hi.w - lo.w)/(2.0*d), p.grad_w[k], 1e-8, 1.0);
        assert_close((hi.lambda - lo.lambda)/(2.0*d), p.grad_lambda[k], 1e-8, 1.0);
        assert_close((hi.z - lo.z)/(2.0*d), p.grad_z[k], 1e-8, 1.0);
        assert_close((hi.cover - lo.cover)/(2.0*d), p.grad_cover[k], 1e-8, 1.0);
      }
    }
  }
}

static void ellipsoid_gradient_is_exact(void **state)
{
  const double d = 1e-6;
  unsigned long seed = 7;
  ProxyPoint    b = Point(0.3, 0.1);
  (void)state;
  b.radius[0] = 2.2, b.radius[1] = 1.4, b.inset = 0.25;
  for (int i = 0; i < 300; i++) {
    double r[3], grad[3], unused[3];
    for (int k = 0; k < 3; k++) r[k] = (k == 0 ? 3.0 : k == 1 ? 2.0 : 1.6)*FixtureRandom(&seed) - (k == 0 ? 1.5 : k == 1 ? 1.0 : 0.4);
    ProxyPairEllipsoid(SPH_CUBIC, SPH_CUBIC, 1.0, &b, r, grad);
    if (ProxyPairEllipsoid(SPH_CUBIC, SPH_CUBIC, 1.0, &b, r, grad) == 0.0) continue;
    for (int k = 0; k < 3; k++) {
      double a[3] = {r[0], r[1], r[2]}, e[3] = {r[0], r[1], r[2]};
      a[k] += d, e[k] -= d;
      assert_close((ProxyPairEllipsoid(SPH_CUBIC, SPH_CUBIC, 1.0, &b, a, unused) - ProxyPairEllipsoid(SPH_CUBIC, SPH_CUBIC, 1.0, &b, e, unused))/(2.0*d), grad[k], 1e-8, 1.0);
    }
  }
}

static void copula_is_exact_on_the_edge_at_right_angles_and_in_its_limits(void **state)
{
  double cu, cv, ct, slope;
  (void)state;
  for (double degree = 15; degree < 170; degree += 10) {
    const double alpha = degree*M_PI/180.0, theta = ProxyCopulaTheta(cos(alpha), &slope);
    assert_close(ProxyCopula(0.5, 0.5, theta, &cu, &cv, &ct), (M_PI - alpha)/(2.0*M_PI), 1e-12, 1.0);
    for (double u = 0.1; u < 1.0; u += 0.2) {
      // a neutral partner, an absent one, and symmetry under complement
      assert_close(ProxyCopula(u, 1.0, theta, &cu, &cv, &ct), u, 1e-12, 1.0);
      assert_close(ProxyCopula(u, 0.0, theta, &cu, &cv, &ct), 0.0, 1e-12, 1.0);
      assert_close(ProxyCopula(u, 0.3, theta, &cu, &cv, &ct), u + 0.3 - 1.0 + ProxyCopula(1.0 - u, 0.7, theta, &cu, &cv, &ct), 1e-12, 1.0);
    }
  }
  const double right = ProxyCopulaTheta(0.0, &slope);
  assert_close(ProxyCopula(0.37, 0.81, right, &cu, &cv, &ct), 0.37*0.81, 1e-14, 1.0);
}

static void copula_derivatives_are_exact(void **state)
{
  const double d = 1e-6;
  (void)state;
  for (double theta = 0.05; theta < 200.0; theta *= 1.7) {
    for (double u = 0.05; u < 1.0; u += 0.3) {
      for (double v = 0.1; v < 1.0; v += 0.25) {
        double cu, cv, ct, x, y, z;
        ProxyCopula(u, v, theta, &cu, &cv, &ct);
        assert_close((ProxyCopula(u + d, v, theta, &x, &y, &z) - ProxyCopula(u - d, v, theta, &x, &y, &z))/(2.0*d), cu, 1e-7, 1.0);
        assert_close((ProxyCopula(u, v + d, theta, &x, &y, &z) - ProxyCopula(u, v - d, theta, &x, &y, &z))/(2.0*d), cv, 1e-7, 1.0);
        assert_close((ProxyCopula(u, v, theta*(1 + d), &x, &y, &z) - ProxyCopula(u, v, theta*(1 - d), &x, &y, &z))/(2.0*d*theta), ct, 1e-7, 1.0);
      }
    }
  }
}

/* Affine property (method 4.3): face proxies on a plane at any kappa-bar are the uniform ones stretched by 1/kappa-bar, and so are their
   kernels: a particle at the stretched place has the same density and normal force. */
static void stretched_sampling_gives_the_same_density_and_normal_force(void **state)
{
  enum { N = 15 };
  double phi[3], normal[3];
  const double kappa[3] = {1.0, 0.6, 0.4};
  (void)state;
  for (int c = 0; c < 3; c++) {
    ProxyPoint points[N*N];
    for (int i = 0; i < N*N; i++) {
      points[i] = Point(0, 0);
      points[i].x[0] = (i%N - N/2)*0.5/kappa[c] + 0.03*((i*7)%5)/kappa[c];
      points[i].x[1] = (i/N - N/2)*0.5/kappa[c] - 0.02*((i*3)%7)/kappa[c];
      points[i].x[2] = -0.25;
      points[i].inset = 0.25;
      points[i].radius[0] = points[i].radius[1] = 1.0/kappa[c];
    }
    assert_petsc(ProxyEllipsoidVolumes(SPH_CUBIC, 1.0, 0.85, N*N, points));
    phi[c] = normal[c] = 0.0;
    for (int i = 0; i < N*N; i++) {
      const double r[3] = {0.21/kappa[c] - points[i].x[0], -0.13/kappa[c] - points[i].x[1], 0.4 - points[i].x[2]};
      double       grad[3];
      const double part = ProxyPairEllipsoid(SPH_CUBIC, SPH_CUBIC, 1.0, &points[i], r, grad);
      phi[c] += part;
      if (part > 0.0) normal[c] += grad[2];
    }
    assert_close(phi[c], phi[0], 1e-13, 1.0); // round-off
    assert_close(normal[c], normal[0], 1e-13, 1.0);
  }
  assert_true(phi[0] > 0.05);
}

static void shapes_keep_their_trace_when_turned(void **state)
{
  unsigned long seed = 11;
  (void)state;
  for (int i = 0; i < 100; i++) {
    double from[3], to[3], S[6], T[6] = {0}, Tn[3];
    for (int k = 0; k < 3; k++) from[k] = FixtureRandom(&seed) - 0.3, to[k] = FixtureRandom(&seed) - 0.3;
    const double a = Norm3(from), b = Norm3(to);
    for (int k = 0; k < 3; k++) from[k] /= a, to[k] /= b;
    // S = I - n n^T: both curvatures 1
    for (int k = 0; k < 3; k++) {
      S[k]     = 1.0 - from[k]*from[k];
      S[3 + k] = -from[k == 2 ? 1 : 0]*from[k == 0 ? 1 : 2];
    }
    if (Dot3(from, to) < -0.4) continue;
    ProxyShapeAddTurned(S, from, to, 2.0, T);
    assert_close(T[0] + T[1] + T[2], 4.0, 1e-13, 1.0);
    ProxyShapeTimes(T, to, Tn);
    assert_close(Norm3(Tn), 0.0, 1e-13, 1.0);
  }
}

CHECK_MAIN(cmocka_unit_test(plane_moment_is_the_integral_of_its_definition), cmocka_unit_test(height_is_the_distance_from_planes_balls_and_cylinders),
           cmocka_unit_test(profile_over_a_ball_is_the_kernels_part_in_the_ball), cmocka_unit_test(half_space_gradients_are_exact),
           cmocka_unit_test(ellipsoid_gradient_is_exact), cmocka_unit_test(copula_is_exact_on_the_edge_at_right_angles_and_in_its_limits),
           cmocka_unit_test(copula_derivatives_are_exact), cmocka_unit_test(stretched_sampling_gives_the_same_density_and_normal_force),
           cmocka_unit_test(shapes_keep_their_trace_when_turned))
