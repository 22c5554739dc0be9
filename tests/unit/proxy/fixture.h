/* fixture.h - proxies on a shape without an SPH: h = 1, dx = 1/2 unless told; phi and gradient at a point; numeric volumes. */
#ifndef BY_PROXY_FIXTURE_H
#define BY_PROXY_FIXTURE_H

#include "check.h"
#include "unit/proxy/shapes.h"
#include "proxy/proxy_impl.h"
#include "proxy/proxy_combine.h"

static inline ProxyFluid FixtureFluid(void)
{
  ProxyFluid fluid = {1.0, 0.5, SPH_CUBIC, SPH_CUBIC, {-50, -50, -50}, {50, 50, 50}, 0, 0, {0}};
  return fluid;
}

/* proxies on a shape; eta = 1: uniform; eta < 1: adaptive down to eta with both ends equal, so kappa-bar = eta everywhere */
static inline Proxy FixtureProxy(const Shape *s, double eta, int kernel, double factor, const ProxyFluid *fluid)
{
  const ProxyFluid usual = FixtureFluid();
  ProxyParams     *params;
  Proxy            proxy;

  assert_petsc(ProxyCreate(PETSC_COMM_SELF, "body", &proxy));
  assert_petsc(ProxyGetParams(proxy, &params));
  params->adaptive = eta < 1.0 ? PETSC_TRUE : PETSC_FALSE;
  params->eta_min = params->eta_max = eta;
  params->kernel  = kernel;
  params->factor  = factor;
  params->inset   = kernel == PROXY_KERNEL_HALF_SPACE ? 0.0 : -1.0; // the profile itself, without its calibrated shift
  assert_petsc(ProxySetSurface(proxy, s->n_nodes, s->x, s->n_triangles, s->triangles));
  assert_petsc(ProxySetFluidScale(proxy, fluid ? fluid : &usual));
  assert_petsc(ProxySetUp(proxy));
  return proxy;
}

/* phi at x; gradient when grad is not NULL */
static inline double FixturePhi(Proxy proxy, const double x[3], double grad[3])
{
  SPHContacts c;

  assert_petsc(ProxyFindContacts(proxy, 1, x, &c));
  for (int k = 0; k < 3 && grad; k++) grad[k] = c.n_touched ? c.grad[k] : 0.0;
  return c.n_touched ? c.phi[0] : 0.0;
}

/* largest difference between the gradient and central differences of phi at x */
static inline double FixtureGradientError(Proxy proxy, const double x[3])
{
  const double d = 1e-5;
  double       grad[3], most = 0.0;

  FixturePhi(proxy, x, grad);
  for (int k = 0; k < 3; k++) {
    double a[3] = {x[0], x[1], x[2]}, b[3] = {x[0], x[1], x[2]};
    a[k] += d, b[k] -= d;
    most = fmax(most, fabs((FixturePhi(proxy, a, NULL) - FixturePhi(proxy, b, NULL))/(2.0*d) - grad[k]));
  }
  return most;
}

/* part of the kernel (h = 1) in a ball of radius R at distance D of the centres: shells of radius r, each with the part of its area in the
   ball; midpoint rule, error 1e-7 */
static inline double FixtureBallPart(int kernel, double D, double R)
{
  const int n   = 4000;
  double    sum = 0.0;

  for (int i = 0; i < n; i++) {
    const double r = (i + 0.5)/n, c = 0.5*(1.0 - (D*D + r*r - R*R)/(2.0*D*r));
    sum += 4.0*M_PI*r*r*SPHKernelW(kernel, r, 1.0)/n * (c < 0.0 ? 0.0 : c > 1.0 ? 1.0 : c);
  }
  return sum;
}

/* part of the kernel (cubic spline, h = 1) in the box |x_k| < half_k: midpoint rule with the overlap of each cell, error 3e-5 */
static inline double FixtureBoxPart(const double x[3], const double half[3])
{
  enum { N = 50 };
  double overlap[3][N], sum = 0.0, all = 0.0;

  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < N; i++) {
      const double lo = fmax(-half[k], x[k] - 1.0 + 2.0*i/N), hi = fmin(half[k], x[k] - 1.0 + 2.0*(i + 1)/N);
      overlap[k][i] = hi > lo ? (hi - lo)*N/2.0 : 0.0;
    }
  }
  for (int i = 0; i < N; i++) {
    for (int j = 0; j < N; j++) {
      for (int k = 0; k < N; k++) {
        const double a = -1.0 + (2*i + 1.0)/N, b = -1.0 + (2*j + 1.0)/N, c = -1.0 + (2*k + 1.0)/N, W = SPHKernelW(SPH_CUBIC, sqrt(a*a + b*b + c*c), 1.0);
        all += W;
        sum += W*overlap[0][i]*overlap[1][j]*overlap[2][k];
      }
    }
  }
  return sum/all;
}

/* reproducible numbers in [0, 1); one per statement: the order of arguments is the compiler's */
static inline double FixtureRandom(unsigned long *state)
{
  *state = *state*6364136223846793005UL + 1442695040888963407UL;
  return (double)(*state >> 11)/9007199254740992.0;
}

#endif
