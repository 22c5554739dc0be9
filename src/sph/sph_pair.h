/* sph_pair.h - what one particle does to another, and a wall to a particle, for host and device (method 1, 1.1, 2).
   Units: m [kg], grad W [1/m^4], p~ = p/rho0^2 [m^5/(kg s^2)], G = rho0 grad phi [kg/m^4]. Everything that acts between i and j
   is a number symmetric in i and j times m grad_i W_ij, which is antisymmetric: momentum is conserved pair by pair. */
#ifndef BY_SPH_PAIR_H
#define BY_SPH_PAIR_H

#include <math.h>

#include "sph_kernel.h"

/* density: rho_i = sum_j m W_ij + rho0 phi_i, the particle itself included [kg/m^3] */
BY_HD SPH_REAL SPHPairDensity(int kernel, SPH_REAL mass, SPH_REAL r, SPH_REAL h) { return mass * SPHKernelW(kernel, r, h); }

/* gradient over displacement: m grad_i W_ij = SPHPairGradient (x_i - x_j) [kg/m^5] */
BY_HD SPH_REAL SPHPairGradient(int kernel, SPH_REAL mass, SPH_REAL r, SPH_REAL h) { return mass * SPHKernelF(kernel, r, h); }

/* pressure acceleration: a_i = - sum_j (p~_i + p~_j) m grad W_ij - p~_i G_i [IISPH eq. 3 with p~] */
BY_HD SPH_REAL SPHPairPressure(SPH_REAL p_i, SPH_REAL p_j) { return p_i + p_j; }

/* density rate: (D v)_i = sum_j (v_i - v_j) . m grad W_ij + v_i . G_i; the transpose of the line above up to its sign */
BY_HD SPH_REAL SPHPairRate(const SPH_REAL v_i[3], const SPH_REAL v_j[3], const SPH_REAL gradient[3])
{
  return (v_i[0] - v_j[0])*gradient[0] + (v_i[1] - v_j[1])*gradient[1] + (v_i[2] - v_j[2])*gradient[2];
}

/* compact Laplacian, (L p~)_i = 2 rho0 sum_j c_ij (p~_i - p~_j), c_ij = -m F_ij: - rho0^2 times the Laplacian in pairs of neighbours, symmetric,
   without the two-cell modes that D D^T does not see [Cummins & Rudman 1999 eq. 21; Brookshaw 1985] */
BY_HD SPH_REAL SPHPairLaplacian(SPH_REAL c, SPH_REAL p_i, SPH_REAL p_j) { return c * (p_i - p_j); }

/* factor on c_ij for neighbourhoods that are stretched: e.(N_i + N_j)/2 e, e the direction of the pair's gradient g, N (xx xy xz yy yz zz) chosen by
   SPHCompact_Internal() so that sum_j c_ij d d^T is nearer the identity: in a lattice stretched by 1.5 the Laplacian across is 0.48 of what the
   corrected gradient sees without it, and a projection with less than half is unstable (ours) */
BY_HD SPH_REAL SPHPairStretch(const double N_i[6], const double N_j[6], const SPH_REAL g[3])
{
  const double x = (double)g[0], y = (double)g[1], z = (double)g[2], g2 = x*x + y*y + z*z;
  const double e = x*x*(N_i[0] + N_j[0]) + y*y*(N_i[3] + N_j[3]) + z*z*(N_i[5] + N_j[5]) +
                   2.0*(x*y*(N_i[1] + N_j[1]) + x*z*(N_i[2] + N_j[2]) + y*z*(N_i[4] + N_j[4]));

  return g2 > 0.0 ? (SPH_REAL)(e > 0.4*g2 ? 0.5*e/g2 : 0.2) : (SPH_REAL)1;
}

/* squared distance from i, at d_i from a plane, to the image of j, at d_j: r'^2 = r^2 + 4 d_i d_j, symmetric in i and j; with images of equal
   pressure added to c_ij no flux crosses the plane and the operator stays symmetric (ours) */
BY_HD SPH_REAL SPHPairImage(SPH_REAL r2, SPH_REAL d_i, SPH_REAL d_j) { return r2 + (SPH_REAL)4*d_i*d_j; }

/* weight of a neighbour in the gradient of concentration that shifting follows, 1 + 0.2 (W/W(dx))^4, against pairing
   [Monaghan 2000; Lind, Xu, Stansby & Rogers 2012 eq. 27] */
BY_HD SPH_REAL SPHPairConcentration(SPH_REAL w_over_w0)
{
  const SPH_REAL w2 = w_over_w0 * w_over_w0;
  return (SPH_REAL)1 + (SPH_REAL)0.2*w2*w2;
}

/* viscous acceleration, two forms of the SPH Laplacian:
     Monaghan  a_i = sum_j 2(d+2) (mu/(rho_i rho_j)) (v_ij . x_ij)/(r^2 + 0.01 h^2) m grad W_ij, d = 3   [Monaghan 2005 eq. 8.8; method 1]
               keeps angular momentum; in layers along a wall it shows 0.9 of the viscosity that it shows in disorder
     Morris    a_i = sum_j 2 (mu/(rho_i rho_j)) (x_ij . m grad W_ij)/(r^2 + 0.01 h^2) v_ij               [Morris, Fox & Zhu 1997 eq. 22]
               the same viscosity for every arrangement within 4 %; keeps linear momentum */
BY_HD SPH_REAL SPHPairViscosityMonaghan(SPH_REAL mu_over_rho2, SPH_REAL v_dot_x, SPH_REAL r2, SPH_REAL h)
{
  return (SPH_REAL)10 * mu_over_rho2 * v_dot_x / (r2 + (SPH_REAL)0.01*h*h);
}
BY_HD SPH_REAL SPHPairViscosityMorris(SPH_REAL mu_over_rho2, SPH_REAL x_dot_gradient, SPH_REAL r2, SPH_REAL h)
{
  return (SPH_REAL)2 * mu_over_rho2 * x_dot_gradient / (r2 + (SPH_REAL)0.01*h*h);
}

/* part of a relative density error e that one step corrects: dt/tau keeps still water quiet, but leaves a compression of some per cent, as an
   impact makes it within a few steps, standing for tau. So compression beyond a per cent is corrected faster, (1 + (e/0.01)^2) dt/tau, up to
   half of it in a step, and never more than 2 % of rest density beyond dt/tau's part: a particle caught in a crevice, where no place is left
   for its kernel, is pressed out and not shot out. Measured on a dam break against a flap: largest compression 12 % without, 2.9 % with it,
   energy the same. */
BY_HD SPH_REAL SPHSourceShare(SPH_REAL e, SPH_REAL relax)
{
  const SPH_REAL half = (SPH_REAL)0.5, most = (SPH_REAL)0.02;
  SPH_REAL       share = relax * ((SPH_REAL)1 + (SPH_REAL)1e4*e*e);

  if (e <= (SPH_REAL)0) return relax;
  share = share < half ? share : half;
  share = share*e < most ? share : most/e;
  return share > relax ? share : relax;
}

/* noise filter: (L v)_i = - sum_j [ (v_i - v_j) . g ] g / N, g = m grad W_ij, damps the relative motion of neighbours along their line;
   applied twice, -rate L L v, it acts on a wave of length l as (1/l)^4: on particle noise and hardly on the flow. L is symmetric, negative
   and central, so that momentum and angular momentum stay and energy falls. SPHPairRate() gives the bracket.
   N = 2/3 sum |g|^2 of a full cubic lattice, there the largest eigenvalue. */
BY_HD SPH_REAL SPHFilterNorm(SPH_REAL sum_of_squares) { return (SPH_REAL)(2.0/3.0) * sum_of_squares; }

/* position-based fluids: q_i = -lambda_i/rho0 = (rho_i - rho0)/(D D^T)_ii [m^5/kg] with the denominator relaxed, x_i += -sum_j (q_i + q_j) m grad W_ij
   [Macklin & Mueller 2013, eq. 11: lambda_i = -C_i/(sum_k |grad_k C_i|^2 + epsilon), where (D D^T)_ii = rho0^2 sum_k |grad_k C_i|^2] */
BY_HD SPH_REAL SPHConstraintStep(SPH_REAL excess, SPH_REAL diagonal, SPH_REAL epsilon) { return excess / (diagonal + epsilon); }

/* artificial pressure of a pair, added to q_i + q_j: k (W(r)/W(delta q))^n [m^5/kg] [Macklin & Mueller 2013, eq. 13] */
BY_HD SPH_REAL SPHPairRepulsion(SPH_REAL k, SPH_REAL W_over_reference, SPH_REAL n) { return W_over_reference > (SPH_REAL)0 ? k * (SPH_REAL)pow((double)W_over_reference, (double)n) : (SPH_REAL)0; }

/* XSPH: v_i += c sum_j V (v_j - v_i) W_ij, V = m/rho0 [Schechter & Bridson 2012, eq. 17 of Macklin & Mueller]; the same V for all keeps momentum */
BY_HD SPH_REAL SPHPairSmooth(int kernel, SPH_REAL volume, SPH_REAL r, SPH_REAL h) { return volume * SPHKernelW(kernel, r, h); }

/* vorticity confinement: acceleration epsilon N x omega, N = eta/|eta|, eta = grad |omega| [Fedkiw et al. 2001, eq. 16 of Macklin & Mueller] */
BY_HD void SPHConfinement(SPH_REAL epsilon, const SPH_REAL eta[3], const SPH_REAL omega[3], SPH_REAL a[3])
{
  const SPH_REAL length = (SPH_REAL)sqrt((double)(eta[0]*eta[0] + eta[1]*eta[1] + eta[2]*eta[2])), f = length > (SPH_REAL)0 ? epsilon/length : (SPH_REAL)0;

  a[0] = f * (eta[1]*omega[2] - eta[2]*omega[1]);
  a[1] = f * (eta[2]*omega[0] - eta[0]*omega[2]);
  a[2] = f * (eta[0]*omega[1] - eta[1]*omega[0]);
}

/* friction of a no-slip wall, a_i = k (v_wall - v_i), k = 2 nu |grad phi| / d [1/s]: the integral over the wall's half-space of
   2 nu (v_i - v) (dW/dr)/r with v continued linearly through its value on the wall, v_i - v(z) = (v_i - v_wall) z/d, because
   int z (dW/dr)/r dV = -A(d) = lambda'(d). d [m] is kept off zero by the caller. */
BY_HD SPH_REAL SPHWallFriction(SPH_REAL nu, SPH_REAL slope, SPH_REAL d) { return (SPH_REAL)2 * nu * slope / d; }

#endif
