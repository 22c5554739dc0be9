/* sph_eos.h - pressure from density, for weakly compressible SPH, for host and device. */
#ifndef BY_SPH_EOS_H
#define BY_SPH_EOS_H

#include <math.h>

#include "body.h"

/* Tait's equation p = rho0 c^2/gamma ((rho/rho0)^gamma - 1) [Pa] [Monaghan 1994 eq. 4.2; Becker & Teschner 2007 eq. 7]: c [m/s] is the speed of
   sound at rest density. gamma = 1 is the plain equation of Mueller et al. 2003 eq. 12, p = k (rho - rho0) with k = c^2. */
BY_HD double SPHTait(double rho, double rho0, double c, double gamma)
{
  const double e = rho / rho0;

  return rho0 * c*c / gamma * ((gamma == 1.0 ? e : pow(e, gamma)) - 1.0);
}

/* speed of sound c = factor v [m/s] that keeps density within 1/factor^2 of rest density, since dp = c^2 drho and p is about rho v^2
   [Monaghan 1994 sec. 4]; v from what is known beforehand: v^2 = v0^2 + 2 g H, the largest initial speed and a fall of height H */
BY_HD double SPHSoundSpeed(double factor, double v0, double g, double H) { return factor * sqrt(v0*v0 + 2.0*g*H); }

/* Monaghan's artificial viscosity as mu/rho0^2 [m^5/(kg s)] of SPHPairViscosityMonaghan(), acting on pairs that approach: Pi_ij = -alpha c hs
   (v_ij . x_ij)/(rho0 (r^2 + 0.01 h^2)), hs = h/2 [Monaghan 1992 sec. 4.1, beta = 0] */
BY_HD double SPHArtificialViscosity(double alpha, double c, double h, double rho0) { return 0.05 * alpha * c * h / rho0; }

/* largest step of sound [s]: dt = 2 cfl hs/(c (1 + 0.6 alpha)), hs = h/2: twice that of Monaghan 1992 sec. 10.3. The hardest wave of a lattice has
   2/omega = 1.7 to 2.4 hs/c for the four kernels at h = 2 to 3 dx, so that cfl 0.4 leaves a factor of two for disorder and for compression, where
   sound is faster; results at half the step are the same (docs/verification/fluid-slice.md). */
BY_HD double SPHAcousticStep(double cfl, double alpha, double c, double h) { return cfl * h / (c * (1.0 + 0.6*alpha)); }

#endif
