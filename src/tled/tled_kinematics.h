/* tled_kinematics.h - measures of a deformation at one point, for host and device.

   H = F - I is the displacement gradient, row-major, F the deformation gradient, J = det F, C = F^T F, E = (C - I)/2, b = F F^T.
   Symmetric matrices are stored as xx, yy, zz, xy, yz, xz. Everything is written in H, so that small strains keep their digits. */
#ifndef BY_TLED_KINEMATICS_H
#define BY_TLED_KINEMATICS_H

#include "mat3.h"

/* sum of the principal minors of H and det H: J - 1 - tr H, of second order */
BY_HD double TLEDMinors(const double H[9])
{
  const double m0 = H[4]*H[8] - H[5]*H[7], m1 = H[0]*H[8] - H[2]*H[6], m2 = H[0]*H[4] - H[1]*H[3];
  const double det = H[0]*m0 - H[1]*(H[3]*H[8] - H[5]*H[6]) + H[2]*(H[3]*H[7] - H[4]*H[6]);

  return ((m0 + m1) + m2) + det;
}

/* J - 1 = tr H + (sum of principal minors of H) + det H: exact, no cancellation at small strain. */
BY_HD double TLEDJacobianMinusOne(const double H[9])
{
  const double m0 = H[4]*H[8] - H[5]*H[7], m1 = H[0]*H[8] - H[2]*H[6], m2 = H[0]*H[4] - H[1]*H[3];
  const double det = H[0]*m0 - H[1]*(H[3]*H[8] - H[5]*H[6]) + H[2]*(H[3]*H[7] - H[4]*H[6]);

  return ((H[0] + H[4]) + H[8]) + ((m0 + m1) + m2) + det;
}

/* |J - 1| up to which TLEDLogSeries() is exact to round-off */
#define TLED_LOG_REACH 0.3

/* ln(1 + x) - 2s = 2 s^3 (1/3 + s^2/5 + ...), s = x/(2 + x), |x| <= TLED_LOG_REACH: |s| < 0.177, so the first term left out, s^24/25, is
   below 4e-20 */
BY_HD double TLEDLogTail(double s)
{
  const double q = s*s;
  double       even = 1.0/23;

  even = 1.0/21 + q*even;
  even = 1.0/19 + q*even;
  even = 1.0/17 + q*even;
  even = 1.0/15 + q*even;
  even = 1.0/13 + q*even;
  even = 1.0/11 + q*even;
  even = 1.0/9 + q*even;
  even = 1.0/7 + q*even;
  even = 1.0/5 + q*even;
  even = 1.0/3 + q*even;
  return 2.0*s*q*even;
}

/* ln(1 + x) = 2 artanh(s), |x| <= TLED_LOG_REACH. Branch-free, so that a loop over elements vectorises. */
BY_HD double TLEDLogSeries(double x)
{
  const double s = x / (2.0 + x);

  return 2.0*s + TLEDLogTail(s);
}

/* x - ln(1 + x), of second order: x - 2s = x^2/(2 + x) less the rest of the series */
BY_HD double TLEDLogRemainder(double x)
{
  const double s = x / (2.0 + x);

  return fabs(x) <= TLED_LOG_REACH ? x*s - TLEDLogTail(s) : x - log1p(x);
}

/* ln J from J - 1 */
BY_HD double TLEDLogJacobian(double jm1) { return fabs(jm1) <= TLED_LOG_REACH ? TLEDLogSeries(jm1) : log1p(jm1); }

/* F = I + H */
BY_HD void TLEDDeformationGradient(const double H[9], double F[9])
{
  F[0] = 1.0 + H[0]; F[1] = H[1];       F[2] = H[2];
  F[3] = H[3];       F[4] = 1.0 + H[4]; F[5] = H[5];
  F[6] = H[6];       F[7] = H[7];       F[8] = 1.0 + H[8];
}

/* C = cof F = J F^-T */
BY_HD void TLEDCofactor(const double F[9], double C[9])
{
  C[0] = F[4]*F[8] - F[5]*F[7]; C[1] = F[5]*F[6] - F[3]*F[8]; C[2] = F[3]*F[7] - F[4]*F[6];
  C[3] = F[2]*F[7] - F[1]*F[8]; C[4] = F[0]*F[8] - F[2]*F[6]; C[5] = F[1]*F[6] - F[0]*F[7];
  C[6] = F[1]*F[5] - F[2]*F[4]; C[7] = F[2]*F[3] - F[0]*F[5]; C[8] = F[0]*F[4] - F[1]*F[3];
}

/* Green-Lagrange strain E = (H + H^T + H^T H)/2 as xx, yy, zz, xy, yz, xz */
BY_HD void TLEDGreenStrain(const double H[9], double E[6])
{
  E[0] = H[0] + 0.5*(H[0]*H[0] + H[3]*H[3] + H[6]*H[6]);
  E[1] = H[4] + 0.5*(H[1]*H[1] + H[4]*H[4] + H[7]*H[7]);
  E[2] = H[8] + 0.5*(H[2]*H[2] + H[5]*H[5] + H[8]*H[8]);
  E[3] = 0.5*(H[1] + H[3] + H[0]*H[1] + H[3]*H[4] + H[6]*H[7]);
  E[4] = 0.5*(H[5] + H[7] + H[1]*H[2] + H[4]*H[5] + H[7]*H[8]);
  E[5] = 0.5*(H[2] + H[6] + H[0]*H[2] + H[3]*H[5] + H[6]*H[8]);
}

/* B = b - I = H + H^T + H H^T */
BY_HD void TLEDLeftStrain(const double H[9], double B[6])
{
  B[0] = 2.0*H[0] + (H[0]*H[0] + H[1]*H[1] + H[2]*H[2]);
  B[1] = 2.0*H[4] + (H[3]*H[3] + H[4]*H[4] + H[5]*H[5]);
  B[2] = 2.0*H[8] + (H[6]*H[6] + H[7]*H[7] + H[8]*H[8]);
  B[3] = H[1] + H[3] + (H[0]*H[3] + H[1]*H[4] + H[2]*H[5]);
  B[4] = H[5] + H[7] + (H[3]*H[6] + H[4]*H[7] + H[5]*H[8]);
  B[5] = H[2] + H[6] + (H[0]*H[6] + H[1]*H[7] + H[2]*H[8]);
}

/* cube root of x > 0 by Halley's iteration y <- y (y^3 + 2x)/(2y^3 + x) from y = 1: to round-off for 1e-2 < x < 1e2 (and to 1e-9 for a
   thousand), branch-free, so that a loop over elements vectorises */
BY_HD double TLEDCubeRoot(double x)
{
  double y = (1.0 + 2.0*x) / (2.0 + x);

  y *= (y*y*y + 2.0*x) / (2.0*y*y*y + x);
  y *= (y*y*y + 2.0*x) / (2.0*y*y*y + x);
  y *= (y*y*y + 2.0*x) / (2.0*y*y*y + x);
  y *= (y*y*y + 2.0*x) / (2.0*y*y*y + x);
  return y;
}

#endif
