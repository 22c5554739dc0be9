/* sph_kernel.h - smoothing kernels in three dimensions and their half-space volumes (method 2), for host and device.
   One precision per translation unit: define SPH_REAL before the include (default double). r = distance [m], h = support
   radius [m], q = r/h, u = 1 - q. Everything is zero at r >= h. */
#ifndef BY_SPH_KERNEL_H
#define BY_SPH_KERNEL_H

#include "body.h"

#ifndef SPH_REAL
  #define SPH_REAL double
#endif

/* the kernels of SPHKernelType, in its order */
enum { SPH_CUBIC = 0, SPH_WENDLAND = 1, SPH_POLY6 = 2, SPH_SPIKY = 3, SPH_N_KERNELS = 4 };

/* W(r, h) [1/m^3]
     cubic spline  8/(pi h^3) { 1 - 6 q^2 + 6 q^3 (q < 1/2);  2 u^3 }      Monaghan & Lattanzio 1985, support h
     Wendland C2   21/(2 pi h^3) u^4 (4 q + 1)                              Wendland 1995
     poly6         315/(64 pi h^3) (1 - q^2)^3                               Mueller et al. 2003
     spiky         15/(pi h^3) u^3                                           Mueller et al. 2003, after Desbrun & Gascuel */
BY_HD SPH_REAL SPHKernelW(int kernel, SPH_REAL r, SPH_REAL h)
{
  const SPH_REAL q = r / h, u = (SPH_REAL)1 - q, h3 = h*h*h;

  if (q >= (SPH_REAL)1) return (SPH_REAL)0;
  if (kernel == SPH_WENDLAND) return (SPH_REAL)(10.5 / BY_PI) / h3 * u*u*u*u * ((SPH_REAL)4*q + (SPH_REAL)1);
  if (kernel == SPH_POLY6) return (SPH_REAL)(315.0 / (64.0 * BY_PI)) / h3 * (u*((SPH_REAL)1 + q)) * (u*((SPH_REAL)1 + q)) * (u*((SPH_REAL)1 + q));
  if (kernel == SPH_SPIKY) return (SPH_REAL)(15.0 / BY_PI) / h3 * u*u*u;
  return (SPH_REAL)(8.0 / BY_PI) / h3 * (q < (SPH_REAL)0.5 ? (SPH_REAL)1 - (SPH_REAL)6*q*q*u : (SPH_REAL)2*u*u*u);
}

/* (1/r) dW/dr [1/m^5], so that grad_i W_ij = F (x_i - x_j); finite at r = 0
     cubic spline  8/(pi h^5) { -12 + 18 q (q < 1/2);  -6 u^2/q }
     Wendland C2   -210/(pi h^5) u^3
     poly6         -945/(32 pi h^5) (1 - q^2)^2
     spiky         -45/(pi h^5) u^2/q, q at least 1e-3: W is a cone there, and a pair at one point has no direction */
BY_HD SPH_REAL SPHKernelF(int kernel, SPH_REAL r, SPH_REAL h)
{
  const SPH_REAL q = r / h, u = (SPH_REAL)1 - q, h2 = h*h, h5 = h2*h2*h;

  if (q >= (SPH_REAL)1) return (SPH_REAL)0;
  if (kernel == SPH_WENDLAND) return (SPH_REAL)(-210.0 / BY_PI) / h5 * u*u*u;
  if (kernel == SPH_POLY6) return (SPH_REAL)(-945.0 / (32.0 * BY_PI)) / h5 * (u*((SPH_REAL)1 + q)) * (u*((SPH_REAL)1 + q));
  if (kernel == SPH_SPIKY) return (SPH_REAL)(-45.0 / BY_PI) / h5 * u*u / (q > (SPH_REAL)1e-3 ? q : (SPH_REAL)1e-3);
  return (SPH_REAL)(8.0 / BY_PI) / h5 * (q < (SPH_REAL)0.5 ? (SPH_REAL)18*q - (SPH_REAL)12 : (SPH_REAL)-6*u*u/q);
}

/* A(d) = 2 pi int_d^h r W dr = -lambda'(d) [1/m]: the part of the kernel's volume in the plane at distance d >= 0 */
BY_HD SPH_REAL SPHPlaneDensity(int kernel, SPH_REAL d, SPH_REAL h)
{
  const SPH_REAL q = d / h, u = (SPH_REAL)1 - q, q2 = q*q;

  if (q >= (SPH_REAL)1) return (SPH_REAL)0;
  if (kernel == SPH_WENDLAND) return u*u*u*u*u * ((SPH_REAL)21 - (SPH_REAL)31.5*u + (SPH_REAL)12*u*u) / h;
  if (kernel == SPH_POLY6) return (SPH_REAL)(315.0/256.0) * ((SPH_REAL)1 - q2)*((SPH_REAL)1 - q2)*((SPH_REAL)1 - q2)*((SPH_REAL)1 - q2) / h;
  if (kernel == SPH_SPIKY) return u*u*u*u * ((SPH_REAL)7.5 - (SPH_REAL)6*u) / h;
  if (q >= (SPH_REAL)0.5) return (SPH_REAL)32*u*u*u*u * ((SPH_REAL)0.25 - (SPH_REAL)0.2*u) / h;
  return ((SPH_REAL)1.4 - q2 * ((SPH_REAL)8 - q2 * ((SPH_REAL)24 - (SPH_REAL)19.2*q))) / h;
}

/* lambda(d) = int_d^h A [1]: the part of the kernel's volume beyond a plane at signed distance d [m] (method 2)
     cubic spline  q >= 1/2: 16 (u^5/10 - u^6/15);  0 <= q < 1/2: 1/2 - 16 (0.0875 q - q^3/6 + 0.3 q^5 - q^6/5)
     Wendland C2   3.5 u^6 - 4.5 u^7 + 1.5 u^8 (integrated from A)
     poly6         1/2 - 315/256 (q - 4 q^3/3 + 6 q^5/5 - 4 q^7/7 + q^9/9)
     spiky         1.5 u^5 - u^6
     lambda(-d) = 1 - lambda(d) */
BY_HD SPH_REAL SPHHalfSpace(int kernel, SPH_REAL d, SPH_REAL h)
{
  const SPH_REAL q = (d < (SPH_REAL)0 ? -d : d) / h, u = (SPH_REAL)1 - q, q2 = q*q;
  SPH_REAL       lambda = (SPH_REAL)0;

  if (q < (SPH_REAL)1) {
    if (kernel == SPH_WENDLAND) {
      lambda = u*u*u*u*u*u * ((SPH_REAL)3.5 - u * ((SPH_REAL)4.5 - (SPH_REAL)1.5*u));
    } else if (kernel == SPH_POLY6) {
      lambda = (SPH_REAL)0.5 - (SPH_REAL)(315.0/256.0)*q * ((SPH_REAL)1 - q2 * ((SPH_REAL)(4.0/3.0) - q2 * ((SPH_REAL)1.2 - q2 * ((SPH_REAL)(4.0/7.0) - q2*(SPH_REAL)(1.0/9.0)))));
    } else if (kernel == SPH_SPIKY) {
      lambda = u*u*u*u*u * ((SPH_REAL)1.5 - u);
    } else if (q >= (SPH_REAL)0.5) {
      lambda = u*u*u*u*u * ((SPH_REAL)1.6 - (SPH_REAL)(16.0/15.0)*u);
    } else {
      lambda = (SPH_REAL)0.5 - q * ((SPH_REAL)1.4 - q2 * ((SPH_REAL)(8.0/3.0) - q2 * ((SPH_REAL)4.8 - (SPH_REAL)3.2*q)));
    }
  }
  return d < (SPH_REAL)0 ? (SPH_REAL)1 - lambda : lambda;
}

/* lambda'(d) = -A(|d|) [1/m] */
BY_HD SPH_REAL SPHHalfSpaceSlope(int kernel, SPH_REAL d, SPH_REAL h)
{
  return -SPHPlaneDensity(kernel, d < (SPH_REAL)0 ? -d : d, h);
}

/* distance d/h >= 0 at which lambda is `part` in (0, 1/2]; 0 for more, 1 for nothing: Newton inside a bracket, 1e-6 h */
BY_HD SPH_REAL SPHHalfSpaceDistance(int kernel, SPH_REAL part)
{
  SPH_REAL lo = (SPH_REAL)0, hi = (SPH_REAL)1, q = (SPH_REAL)0.25;

  if (part >= (SPH_REAL)0.5) return lo;
  if (part <= (SPH_REAL)0) return hi;
  for (int k = 0; k < 40 && hi - lo > (SPH_REAL)1e-6; k++) {
    const SPH_REAL f = SPHHalfSpace(kernel, q, (SPH_REAL)1) - part, slope = SPHHalfSpaceSlope(kernel, q, (SPH_REAL)1);
    SPH_REAL       next = slope < (SPH_REAL)0 ? q - f/slope : lo;

    if (f > (SPH_REAL)0) lo = q;
    else hi = q;
    if (!(next > lo && next < hi)) next = (SPH_REAL)0.5 * (lo + hi);
    if (next - q < (SPH_REAL)1e-7 && q - next < (SPH_REAL)1e-7) return next;
    q = next;
  }
  return q;
}

/* Factor s on the volume of walls, planar or proxied, that puts the wetted surface where the geometry is (method 2), by support h/dx = 1.5, 1.75
   .. 3, linear between: still water stands within 0.03 dx for the cubic spline from 2 dx on, 0.08 dx for Wendland C2 from 2.5 dx on; below,
   volume is lost or gained in the bulk and no factor helps. poly6 with gradients of spiky: within 0.05 dx from 2 dx on. poly6 or spiky alone
   lose or gain volume at every support (docs/verification/fluid-slice.md) */
BY_HD SPH_REAL SPHWallFactor(int kernel, SPH_REAL h_over_dx)
{
  const SPH_REAL cubic[7] = {(SPH_REAL)1.00, (SPH_REAL)1.00, (SPH_REAL)1.06, (SPH_REAL)1.14, (SPH_REAL)1.12, (SPH_REAL)1.12, (SPH_REAL)1.12};
  const SPH_REAL at       = h_over_dx < (SPH_REAL)1.5 ? (SPH_REAL)0 : h_over_dx > (SPH_REAL)3 ? (SPH_REAL)6 : (SPH_REAL)4 * (h_over_dx - (SPH_REAL)1.5);
  const int      i        = at >= (SPH_REAL)5 ? 5 : (int)at;

  if (kernel == SPH_POLY6) return (SPH_REAL)1.05;
  if (kernel == SPH_SPIKY) return (SPH_REAL)1;
  return kernel == SPH_WENDLAND ? (SPH_REAL)1.06 : cubic[i] + (at - (SPH_REAL)i) * (cubic[i + 1] - cubic[i]);
}

#endif
