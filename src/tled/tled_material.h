/* tled_material.h - elastic laws: energy, first Piola-Kirchhoff stress and tangent of one material point, for host and device.

   H = F - I is the displacement gradient, row-major, F the deformation gradient, J = det F, E = (F^T F - I)/2,
   mu and lambda are Lame's constants [Pa]. Everything is written in H, so that small strains keep their digits. */
#ifndef BY_TLED_MATERIAL_H
#define BY_TLED_MATERIAL_H

#include "mat3.h"

/* the laws, in the order of TLEDMaterial in tled.h */
enum { TLED_LAW_NEO_HOOKEAN = 0, TLED_LAW_ST_VENANT_KIRCHHOFF = 1 };

/* A law with its constants, as the loops take it. */
typedef struct {
  int    law;
  double mu, lambda; /* Lame's constants [Pa] */
} TLEDLaw;

/* J - 1 = tr H + (sum of principal minors of H) + det H: exact, no cancellation at small strain. */
BY_HD double TLEDJacobianMinusOne(const double H[9])
{
  const double m0 = H[4]*H[8] - H[5]*H[7], m1 = H[0]*H[8] - H[2]*H[6], m2 = H[0]*H[4] - H[1]*H[3];
  const double det = H[0]*m0 - H[1]*(H[3]*H[8] - H[5]*H[6]) + H[2]*(H[3]*H[7] - H[4]*H[6]);

  return ((H[0] + H[4]) + H[8]) + ((m0 + m1) + m2) + det;
}

/* |J - 1| up to which TLEDLogSeries() is exact to round-off */
#define TLED_LOG_REACH 0.3

/* ln(1 + x), |x| <= TLED_LOG_REACH:  2 artanh(s) = 2 s (1 + s^2/3 + s^4/5 + ...), s = x/(2 + x); |s| < 0.177, so the first term left
   out, s^24/25, is below 4e-20. Branch-free, so that a loop over elements vectorises. */
BY_HD double TLEDLogSeries(double x)
{
  const double s = x / (2.0 + x), q = s*s;
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
  return 2.0*s + 2.0*s*q*even;
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

/* W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2 [J/m^3], method 3; I1 - 3 = 2 tr E */
BY_HD double TLEDEnergyNeoHookean(const double H[9], double mu, double lambda)
{
  const double ln_J = TLEDLogJacobian(TLEDJacobianMinusOne(H));
  double       E[6];

  TLEDGreenStrain(H, E);
  return mu*(E[0] + E[1] + E[2]) - mu*ln_J + 0.5*lambda*ln_J*ln_J;
}

/* P = mu (F - F^-T) + lambda ln J F^-T [Pa]; ln_J and inv_J = 1/J are handed in (the loops compute them a vector at a time) */
BY_HD void TLEDStressNeoHookean(const double H[9], double ln_J, double inv_J, double mu, double lambda, double P[9])
{
  const double c = (lambda*ln_J - mu)*inv_J;
  double       F[9], C[9];

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, C);
  P[0] = mu*F[0] + c*C[0]; P[1] = mu*F[1] + c*C[1]; P[2] = mu*F[2] + c*C[2];
  P[3] = mu*F[3] + c*C[3]; P[4] = mu*F[4] + c*C[4]; P[5] = mu*F[5] + c*C[5];
  P[6] = mu*F[6] + c*C[6]; P[7] = mu*F[7] + c*C[7]; P[8] = mu*F[8] + c*C[8];
}

/* W = lambda/2 (tr E)^2 + mu E:E [J/m^3], method 3 */
BY_HD double TLEDEnergyStVenantKirchhoff(const double H[9], double mu, double lambda)
{
  double E[6];

  TLEDGreenStrain(H, E);
  const double trace = E[0] + E[1] + E[2];
  return 0.5*lambda*trace*trace + mu*(E[0]*E[0] + E[1]*E[1] + E[2]*E[2] + 2.0*(E[3]*E[3] + E[4]*E[4] + E[5]*E[5]));
}

/* S = lambda tr E I + 2 mu E [Pa], as xx, yy, zz, xy, yz, xz */
BY_HD void TLEDSecondStressStVenantKirchhoff(const double H[9], double mu, double lambda, double S[6])
{
  double E[6];

  TLEDGreenStrain(H, E);
  const double p = lambda*(E[0] + E[1] + E[2]);
  S[0] = p + 2.0*mu*E[0]; S[1] = p + 2.0*mu*E[1]; S[2] = p + 2.0*mu*E[2];
  S[3] = 2.0*mu*E[3];     S[4] = 2.0*mu*E[4];     S[5] = 2.0*mu*E[5];
}

/* P = F S [Pa] */
BY_HD void TLEDStressStVenantKirchhoff(const double H[9], double mu, double lambda, double P[9])
{
  double F[9], S[6];

  TLEDDeformationGradient(H, F);
  TLEDSecondStressStVenantKirchhoff(H, mu, lambda, S);
  P[0] = F[0]*S[0] + F[1]*S[3] + F[2]*S[5]; P[1] = F[0]*S[3] + F[1]*S[1] + F[2]*S[4]; P[2] = F[0]*S[5] + F[1]*S[4] + F[2]*S[2];
  P[3] = F[3]*S[0] + F[4]*S[3] + F[5]*S[5]; P[4] = F[3]*S[3] + F[4]*S[1] + F[5]*S[4]; P[5] = F[3]*S[5] + F[4]*S[4] + F[5]*S[2];
  P[6] = F[6]*S[0] + F[7]*S[3] + F[8]*S[5]; P[7] = F[6]*S[3] + F[7]*S[1] + F[8]*S[4]; P[8] = F[6]*S[5] + F[7]*S[4] + F[8]*S[2];
}

/* energy of a law [J/m^3]; a is the unit vector along the fibres, of no effect without them */
BY_HD double TLEDEnergy(const TLEDLaw *m, const double a[3], const double H[9])
{
  (void)a;
  return m->law == TLED_LAW_NEO_HOOKEAN ? TLEDEnergyNeoHookean(H, m->mu, m->lambda) : TLEDEnergyStVenantKirchhoff(H, m->mu, m->lambda);
}

/* stress of a law [Pa]; ln_J and inv_J are used by the laws that need them */
BY_HD void TLEDStress(const TLEDLaw *m, const double a[3], const double H[9], double ln_J, double inv_J, double P[9])
{
  (void)a;
  if (m->law == TLED_LAW_NEO_HOOKEAN) TLEDStressNeoHookean(H, ln_J, inv_J, m->mu, m->lambda, P);
  else TLEDStressStVenantKirchhoff(H, m->mu, m->lambda, P);
}

/* Differential of P in the direction dF: dP = mu dF + (mu - lambda ln J) F^-T dF^T F^-T + lambda (F^-T : dF) F^-T */
BY_HD void TLEDStressDifferentialNeoHookean(const double H[9], const double dF[9], double mu, double lambda, double dP[9])
{
  const double jm1 = TLEDJacobianMinusOne(H), inv_J = 1.0 / (1.0 + jm1), c = mu - lambda*TLEDLogJacobian(jm1);
  double       F[9], B[9], trace = 0.0;

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, B);
  for (int k = 0; k < 9; k++) B[k] *= inv_J; /* B = F^-T */
  for (int k = 0; k < 9; k++) trace += B[k]*dF[k];
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      double s = 0.0;
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) s += B[3*i + l]*dF[3*k + l]*B[3*k + j];
      dP[3*i + j] = mu*dF[3*i + j] + c*s + lambda*trace*B[3*i + j];
    }
  }
}

/* Differential of P in the direction dF: dP = dF S + F dS, dS = lambda tr dE I + 2 mu dE, dE = sym(F^T dF) */
BY_HD void TLEDStressDifferentialStVenantKirchhoff(const double H[9], const double dF[9], double mu, double lambda, double dP[9])
{
  double F[9], s[6], dS[9], trace = 0.0;

  TLEDDeformationGradient(H, F);
  TLEDSecondStressStVenantKirchhoff(H, mu, lambda, s);
  const double S[9] = {s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]};
  for (int k = 0; k < 9; k++) trace += F[k]*dF[k];
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      double e = 0.0;
      for (int k = 0; k < 3; k++) e += F[3*k + i]*dF[3*k + j] + F[3*k + j]*dF[3*k + i];
      dS[3*i + j] = mu*e + (i == j ? lambda*trace : 0.0);
    }
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      double p = 0.0;
      for (int k = 0; k < 3; k++) p += dF[3*i + k]*S[3*k + j] + F[3*i + k]*dS[3*k + j];
      dP[3*i + j] = p;
    }
  }
}

/* differential of the stress of a law in the direction dF */
BY_HD void TLEDStressDifferential(const TLEDLaw *m, const double a[3], const double H[9], const double dF[9], double dP[9])
{
  (void)a;
  if (m->law == TLED_LAW_NEO_HOOKEAN) TLEDStressDifferentialNeoHookean(H, dF, m->mu, m->lambda, dP);
  else TLEDStressDifferentialStVenantKirchhoff(H, dF, m->mu, m->lambda, dP);
}

/* Poisson's ratio at small strain */
BY_HD double TLEDPoisson(const TLEDLaw *m) { return 0.5*m->lambda / (m->lambda + m->mu); }

/* The law with the volumetric stiffness of Poisson's ratio 1/3 at most, lambda' = min(lambda, 2 mu), in place of lambda: what is
   taken out, lambda - lambda' [Pa], see TLEDElementSoften(). */
BY_HD double TLEDExcessBulk(const TLEDLaw *m)
{
  const double most = 2.0*m->mu;

  return m->lambda > most ? m->lambda - most : 0.0;
}

/* B with dP = ... + lambda (B : dF) B, the volumetric part of the differential: F^-T, or F in the law of St Venant and Kirchhoff */
BY_HD void TLEDBulkDirection(const TLEDLaw *m, const double H[9], double B[9])
{
  const double inv_J = 1.0 / (1.0 + TLEDJacobianMinusOne(H));
  double       F[9];

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, B);
  for (int k = 0; k < 9; k++) B[k] = m->law == TLED_LAW_ST_VENANT_KIRCHHOFF ? F[k] : inv_J*B[k];
}

#endif
