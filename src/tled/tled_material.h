/* tled_material.h - elastic laws: energy, first Piola-Kirchhoff stress and tangent of one material point, for host and device.

   Notation as in tled_kinematics.h. mu and lambda are Lame's constants [Pa]. */
#ifndef BY_TLED_MATERIAL_H
#define BY_TLED_MATERIAL_H

#include "tled/tled_isochoric.h"

/* the laws, in the order of TLEDMaterial in tled.h */
enum {
  TLED_LAW_NEO_HOOKEAN = 0,
  TLED_LAW_ST_VENANT_KIRCHHOFF = 1,
  TLED_LAW_NEO_HOOKEAN_ISO = 2,
  TLED_LAW_MOONEY_RIVLIN = 3,
  TLED_LAW_TRANSVERSE = 4,
  TLED_LAWS = 5
};

#define TLED_PRONY_MAX 8 /* terms of a Prony series at most */

/* A law with its constants, as the loops take it. */
typedef struct {
  int    law;
  int    n_prony;                /* terms of its Prony series, 0 = elastic                             */
  double mu, lambda;             /* Lame's constants [Pa]; lambda of the first two laws only           */
  double kappa;                  /* bulk modulus [Pa], of the others                                   */
  double c10, c01;               /* of Mooney and Rivlin [Pa]                                          */
  double eta;                    /* stiffness along the fibres [Pa]                                    */
  double alpha[TLED_PRONY_MAX];  /* part of the isochoric stress that relaxes, each term's [1]         */
  double tau[TLED_PRONY_MAX];    /* in this time [s]                                                   */
} TLEDLaw;

/* W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2 [J/m^3], method 3; I1 - 3 = 2 tr H + |H|^2, and
   tr H - ln J = (J - 1 - ln J) - minors, so that only terms of second order are added */
BY_HD double TLEDEnergyNeoHookean(const double H[9], double mu, double lambda)
{
  const double jm1 = TLEDJacobianMinusOne(H), ln_J = TLEDLogJacobian(jm1);
  double       size2 = 0.0;

  for (int k = 0; k < 9; k++) size2 += H[k]*H[k];
  return mu*(0.5*size2 - TLEDMinors(H) + TLEDLogRemainder(jm1)) + 0.5*lambda*ln_J*ln_J;
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
  switch (m->law) {
  case TLED_LAW_NEO_HOOKEAN: return TLEDEnergyNeoHookean(H, m->mu, m->lambda);
  case TLED_LAW_ST_VENANT_KIRCHHOFF: return TLEDEnergyStVenantKirchhoff(H, m->mu, m->lambda);
  case TLED_LAW_NEO_HOOKEAN_ISO: return TLEDEnergyNeoHookeanIso(H, m->mu, m->kappa);
  case TLED_LAW_MOONEY_RIVLIN: return TLEDEnergyMooneyRivlin(H, m->c10, m->c01, m->kappa);
  default: return TLEDEnergyTransverse(H, a, m->mu, m->eta, m->kappa);
  }
}

/* stress of a law [Pa]; ln_J is used by the first law, inv_J = 1/J by all but the second */
BY_HD void TLEDStress(const TLEDLaw *m, const double a[3], const double H[9], double ln_J, double inv_J, double P[9])
{
  switch (m->law) {
  case TLED_LAW_NEO_HOOKEAN: TLEDStressNeoHookean(H, ln_J, inv_J, m->mu, m->lambda, P); break;
  case TLED_LAW_ST_VENANT_KIRCHHOFF: TLEDStressStVenantKirchhoff(H, m->mu, m->lambda, P); break;
  case TLED_LAW_NEO_HOOKEAN_ISO: TLEDStressNeoHookeanIso(H, inv_J, m->mu, m->kappa, P); break;
  case TLED_LAW_MOONEY_RIVLIN: TLEDStressMooneyRivlin(H, inv_J, m->c10, m->c01, m->kappa, P); break;
  default: TLEDStressTransverse(H, a, inv_J, m->mu, m->eta, m->kappa, P); break;
  }
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
  switch (m->law) {
  case TLED_LAW_NEO_HOOKEAN: TLEDStressDifferentialNeoHookean(H, dF, m->mu, m->lambda, dP); break;
  case TLED_LAW_ST_VENANT_KIRCHHOFF: TLEDStressDifferentialStVenantKirchhoff(H, dF, m->mu, m->lambda, dP); break;
  case TLED_LAW_NEO_HOOKEAN_ISO: TLEDStressDifferentialNeoHookeanIso(H, dF, m->mu, m->kappa, dP); break;
  case TLED_LAW_MOONEY_RIVLIN: TLEDStressDifferentialMooneyRivlin(H, dF, m->c10, m->c01, m->kappa, dP); break;
  default: TLEDStressDifferentialTransverse(H, a, dF, m->mu, m->eta, m->kappa, dP); break;
  }
}

/* Lame's first constant at small strain [Pa], without fibres */
BY_HD double TLEDLambda(const TLEDLaw *m)
{
  return m->law == TLED_LAW_NEO_HOOKEAN || m->law == TLED_LAW_ST_VENANT_KIRCHHOFF ? m->lambda : m->kappa - (2.0/3)*m->mu;
}

/* Poisson's ratio at small strain, without fibres */
BY_HD double TLEDPoisson(const TLEDLaw *m)
{
  const double lambda = TLEDLambda(m);

  return 0.5*lambda / (lambda + m->mu);
}

/* The law with the volumetric stiffness of Poisson's ratio 1/3 at most, lambda' = min(lambda, 2 mu), in place of lambda: what is
   taken out, lambda - lambda' [Pa], see TLEDElementSoften(). */
BY_HD double TLEDExcessBulk(const TLEDLaw *m)
{
  const double excess = TLEDLambda(m) - 2.0*m->mu;

  return excess > 0.0 ? excess : 0.0;
}

/* B with dP = ... + lambda (B : dF) B, the volumetric part of the differential: F^-T; F in the law of St Venant and Kirchhoff; and
   sqrt(J (2J - 1)) F^-T in the laws with kappa/2 (J - 1)^2 */
BY_HD void TLEDBulkDirection(const TLEDLaw *m, const double H[9], double B[9])
{
  const double J = 1.0 + TLEDJacobianMinusOne(H), part = J*(2.0*J - 1.0);
  double       F[9], factor = 1.0 / J;

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, B);
  if (m->law >= TLED_LAW_NEO_HOOKEAN_ISO) factor *= part > 0.0 ? sqrt(part) : 0.0;
  for (int k = 0; k < 9; k++) B[k] = m->law == TLED_LAW_ST_VENANT_KIRCHHOFF ? F[k] : factor*B[k];
}

#endif
