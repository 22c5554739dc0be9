/* tled_isochoric.h - elastic laws that split volume from shape: energy, first Piola-Kirchhoff stress and its differential, for host and
   device.

   W = W_iso(c F) + kappa/2 (J - 1)^2 with c = J^(-1/3), kappa the bulk modulus [Pa]. Notation as in tled_kinematics.h; B = b - I. The
   stress is worked out as Kirchhoff's, tau = P F^T: its isochoric part is a deviator of terms in B, so that nothing cancels at small
   strain. Textbook: Holzapfel, Nonlinear Solid Mechanics (2000), sections 6.4 and 6.5. */
#ifndef BY_TLED_ISOCHORIC_H
#define BY_TLED_ISOCHORIC_H

#include "tled/tled_kinematics.h"

/* c^2 - 1 for c = J^(-1/3), from J - 1 without cancellation: c^3 - 1 = -(J - 1)/J */
BY_HD double TLEDRootMinusOne(double c, double jm1, double inv_J) { return -jm1*inv_J*(c + 1.0) / (c*c + c + 1.0); }

/* D = deviator of a symmetric matrix A */
BY_HD void TLEDDeviator(const double A[6], double D[6])
{
  const double third = (A[0] + A[1] + A[2]) * (1.0/3);

  D[0] = A[0] - third; D[1] = A[1] - third; D[2] = A[2] - third;
  D[3] = A[3];         D[4] = A[4];         D[5] = A[5];
}

/* D = A^2 of a symmetric matrix */
BY_HD void TLEDSquare(const double A[6], double D[6])
{
  D[0] = A[0]*A[0] + A[3]*A[3] + A[5]*A[5];
  D[1] = A[3]*A[3] + A[1]*A[1] + A[4]*A[4];
  D[2] = A[5]*A[5] + A[4]*A[4] + A[2]*A[2];
  D[3] = A[0]*A[3] + A[3]*A[1] + A[5]*A[4];
  D[4] = A[3]*A[5] + A[1]*A[4] + A[4]*A[2];
  D[5] = A[0]*A[5] + A[3]*A[4] + A[5]*A[2];
}

/* P = tau F^-T, F^-T = cof F/J */
BY_HD void TLEDFirstStress(const double H[9], double inv_J, const double tau[6], double P[9])
{
  const double t0 = inv_J*tau[0], t1 = inv_J*tau[1], t2 = inv_J*tau[2], t3 = inv_J*tau[3], t4 = inv_J*tau[4], t5 = inv_J*tau[5];
  double       F[9], C[9];

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, C);
  P[0] = t0*C[0] + t3*C[3] + t5*C[6]; P[1] = t0*C[1] + t3*C[4] + t5*C[7]; P[2] = t0*C[2] + t3*C[5] + t5*C[8];
  P[3] = t3*C[0] + t1*C[3] + t4*C[6]; P[4] = t3*C[1] + t1*C[4] + t4*C[7]; P[5] = t3*C[2] + t1*C[5] + t4*C[8];
  P[6] = t5*C[0] + t4*C[3] + t2*C[6]; P[7] = t5*C[1] + t4*C[4] + t2*C[7]; P[8] = t5*C[2] + t4*C[5] + t2*C[8];
}

/* c^2 I1 - 3, of second order at small strain: with t = I1 - 3 and q = c^2 - 1 it is (3 q + t) + q t, where the linear terms of 3 q and t
   are taken out by hand: t = 2 tr H + |H|^2, J - 1 = tr H + minors, q = -(J - 1)/J (2/3 + d), d = (1 - c)(1 + 2c)/(3 (c^2 + c + 1)) */
BY_HD double TLEDFirstInvariant(const double H[9])
{
  const double minors = TLEDMinors(H), jm1 = TLEDJacobianMinusOne(H), inv_J = 1.0 / (1.0 + jm1), c = TLEDCubeRoot(inv_J);
  const double n = c*c + c + 1.0, d = jm1*inv_J*(1.0 + 2.0*c) / (3.0*n*n), q = TLEDRootMinusOne(c, jm1, inv_J);
  double       size2 = 0.0;

  for (int k = 0; k < 9; k++) size2 += H[k]*H[k];
  const double t = 2.0*((H[0] + H[4]) + H[8]) + size2;
  return size2 - 2.0*minors + 2.0*jm1*jm1*inv_J - 3.0*d*jm1*inv_J + q*t;
}

/* c^4 I2 - 3, of second order: with T = C - I, i2 = ((tr T)^2 - T:T)/2, I2 = 3 + 2 tr T + i2 and c^4 - 1 = q (2 + q) it is
   2 (3 q + t) + 3 q^2 + i2 + q (2 + q)(2 t + i2), t = tr T */
BY_HD double TLEDSecondInvariant(const double H[9])
{
  const double jm1 = TLEDJacobianMinusOne(H), inv_J = 1.0 / (1.0 + jm1), q = TLEDRootMinusOne(TLEDCubeRoot(inv_J), jm1, inv_J);
  double       E[6];

  TLEDGreenStrain(H, E);
  const double t = 2.0*(E[0] + E[1] + E[2]);
  const double i2 = 4.0*(E[0]*E[1] + E[1]*E[2] + E[2]*E[0] - E[3]*E[3] - E[4]*E[4] - E[5]*E[5]);
  return 2.0*(TLEDFirstInvariant(H) - q*t) + 3.0*q*q + i2 + q*(2.0 + q)*(2.0*t + i2);
}

/* c^2 I4 - 1 with I4 = |F a|^2 the squared stretch along the unit vector a; m = F a */
BY_HD double TLEDFourthInvariant(const double H[9], const double a[3], double inv_J, double m[3])
{
  const double c = TLEDCubeRoot(inv_J);
  double       h[3];

  Mul3(H, a, h);
  for (int k = 0; k < 3; k++) m[k] = a[k] + h[k];
  return TLEDRootMinusOne(c, TLEDJacobianMinusOne(H), inv_J) + c*c*(2.0*Dot3(a, h) + Dot3(h, h));
}

/* W = mu/2 (c^2 I1 - 3) + kappa/2 (J - 1)^2 [J/m^3] */
BY_HD double TLEDEnergyNeoHookeanIso(const double H[9], double mu, double kappa)
{
  const double jm1 = TLEDJacobianMinusOne(H);

  return 0.5*mu*TLEDFirstInvariant(H) + 0.5*kappa*jm1*jm1;
}

/* tau = mu c^2 dev B + kappa J (J - 1) I [Pa] */
BY_HD void TLEDKirchhoffNeoHookeanIso(const double H[9], double inv_J, double mu, double kappa, double tau[6])
{
  const double jm1 = TLEDJacobianMinusOne(H), c = TLEDCubeRoot(inv_J), s = mu*c*c, p = kappa*(1.0 + jm1)*jm1;
  double       B[6], D[6];

  TLEDLeftStrain(H, B);
  TLEDDeviator(B, D);
  tau[0] = s*D[0] + p; tau[1] = s*D[1] + p; tau[2] = s*D[2] + p;
  tau[3] = s*D[3];     tau[4] = s*D[4];     tau[5] = s*D[5];
}

/* P = tau F^-T [Pa]; inv_J = 1/J is handed in */
BY_HD void TLEDStressNeoHookeanIso(const double H[9], double inv_J, double mu, double kappa, double P[9])
{
  double tau[6];

  TLEDKirchhoffNeoHookeanIso(H, inv_J, mu, kappa, tau);
  TLEDFirstStress(H, inv_J, tau, P);
}

/* W = c10 (c^2 I1 - 3) + c01 (c^4 I2 - 3) + kappa/2 (J - 1)^2 [J/m^3] */
BY_HD double TLEDEnergyMooneyRivlin(const double H[9], double c10, double c01, double kappa)
{
  const double jm1 = TLEDJacobianMinusOne(H);

  return c10*TLEDFirstInvariant(H) + c01*TLEDSecondInvariant(H) + 0.5*kappa*jm1*jm1;
}

/* tau = 2 c10 c^2 dev B + 2 c01 c^4 dev((1 + tr B) B - B^2) + kappa J (J - 1) I [Pa]; the second term is I1 b - b^2 written in B */
BY_HD void TLEDKirchhoffMooneyRivlin(const double H[9], double inv_J, double c10, double c01, double kappa, double tau[6])
{
  const double jm1 = TLEDJacobianMinusOne(H), c = TLEDCubeRoot(inv_J), p = kappa*(1.0 + jm1)*jm1, s2 = 2.0*c01*(c*c)*(c*c);
  double       B[6], Q[6], D[6];

  TLEDLeftStrain(H, B);
  TLEDSquare(B, Q);
  const double s1 = 2.0*c10*c*c + s2*(1.0 + (B[0] + B[1] + B[2]));
  for (int k = 0; k < 6; k++) Q[k] = s1*B[k] - s2*Q[k];
  TLEDDeviator(Q, D);
  tau[0] = D[0] + p; tau[1] = D[1] + p; tau[2] = D[2] + p;
  tau[3] = D[3];     tau[4] = D[4];     tau[5] = D[5];
}

/* P = tau F^-T [Pa] */
BY_HD void TLEDStressMooneyRivlin(const double H[9], double inv_J, double c10, double c01, double kappa, double P[9])
{
  double tau[6];

  TLEDKirchhoffMooneyRivlin(H, inv_J, c10, c01, kappa, tau);
  TLEDFirstStress(H, inv_J, tau, P);
}

/* W = mu/2 (c^2 I1 - 3) + eta/2 (c^2 I4 - 1)^2 + kappa/2 (J - 1)^2 [J/m^3], a the unit vector along the fibres */
BY_HD double TLEDEnergyTransverse(const double H[9], const double a[3], double mu, double eta, double kappa)
{
  double       m[3];
  const double e = TLEDFourthInvariant(H, a, 1.0 / (1.0 + TLEDJacobianMinusOne(H)), m);

  return TLEDEnergyNeoHookeanIso(H, mu, kappa) + 0.5*eta*e*e;
}

/* tau = (that of the matrix) + 2 eta (c^2 I4 - 1) c^2 dev(m m^T) [Pa], m = F a */
BY_HD void TLEDKirchhoffTransverse(const double H[9], const double a[3], double inv_J, double mu, double eta, double kappa,
                                   double tau[6])
{
  double       m[3];
  const double c = TLEDCubeRoot(inv_J), s = 2.0*eta*TLEDFourthInvariant(H, a, inv_J, m)*c*c, third = (1.0/3)*Dot3(m, m);

  TLEDKirchhoffNeoHookeanIso(H, inv_J, mu, kappa, tau);
  tau[0] += s*(m[0]*m[0] - third); tau[1] += s*(m[1]*m[1] - third); tau[2] += s*(m[2]*m[2] - third);
  tau[3] += s*m[0]*m[1];           tau[4] += s*m[1]*m[2];           tau[5] += s*m[0]*m[2];
}

/* P = tau F^-T [Pa] */
BY_HD void TLEDStressTransverse(const double H[9], const double a[3], double inv_J, double mu, double eta, double kappa, double P[9])
{
  double tau[6];

  TLEDKirchhoffTransverse(H, a, inv_J, mu, eta, kappa, tau);
  TLEDFirstStress(H, inv_J, tau, P);
}

/* The differentials below are for a direction dF = L F. First what they share: L = dF F^-1, and of B, of J and of b:
     dB = L + L^T + L B + B L^T,  dJ = J tr L */
BY_HD double TLEDVelocityGradient(const double H[9], const double dF[9], double inv_J, double L[9])
{
  double F[9], C[9];

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, C);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) L[3*i + j] = inv_J*Dot3(&dF[3*i], &C[3*j]);
  return L[0] + L[4] + L[8];
}

/* dA = L A + A L^T of a symmetric matrix A that moves with the body */
BY_HD void TLEDPushDifferential(const double L[9], const double A[6], double dA[6])
{
  const double M[9] = {A[0], A[3], A[5], A[3], A[1], A[4], A[5], A[4], A[2]};

  dA[0] = 2.0*Dot3(&L[0], &M[0]); dA[1] = 2.0*Dot3(&L[3], &M[3]); dA[2] = 2.0*Dot3(&L[6], &M[6]);
  dA[3] = Dot3(&L[0], &M[3]) + Dot3(&L[3], &M[0]);
  dA[4] = Dot3(&L[3], &M[6]) + Dot3(&L[6], &M[3]);
  dA[5] = Dot3(&L[0], &M[6]) + Dot3(&L[6], &M[0]);
}

/* dB = L + L^T + L B + B L^T */
BY_HD void TLEDLeftStrainDifferential(const double L[9], const double B[6], double dB[6])
{
  TLEDPushDifferential(L, B, dB);
  dB[0] += 2.0*L[0];     dB[1] += 2.0*L[4];     dB[2] += 2.0*L[8];
  dB[3] += L[1] + L[3];  dB[4] += L[5] + L[7];  dB[5] += L[2] + L[6];
}

/* dP = (dtau - tau L^T) F^-T of P = tau F^-T */
BY_HD void TLEDFirstStressDifferential(const double H[9], double inv_J, const double L[9], const double tau[6], const double dtau[6],
                                       double dP[9])
{
  const double T[9] = {tau[0], tau[3], tau[5], tau[3], tau[1], tau[4], tau[5], tau[4], tau[2]};
  const double d[9] = {dtau[0], dtau[3], dtau[5], dtau[3], dtau[1], dtau[4], dtau[5], dtau[4], dtau[2]};
  double       F[9], C[9], A[9];

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, C);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) A[3*i + j] = inv_J*(d[3*i + j] - Dot3(&T[3*i], &L[3*j]));
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) dP[3*i + j] = A[3*i]*C[j] + A[3*i + 1]*C[3 + j] + A[3*i + 2]*C[6 + j];
}

/* dtau of the neo-Hookean law above: mu c^2 (dev dB - 2/3 tr L dev B) + kappa J (2J - 1) tr L I */
BY_HD void TLEDKirchhoffDifferentialNeoHookeanIso(const double H[9], const double L[9], double inv_J, double mu, double kappa,
                                                  double dtau[6])
{
  const double J = 1.0 + TLEDJacobianMinusOne(H), c = TLEDCubeRoot(inv_J), s = mu*c*c, trace = L[0] + L[4] + L[8];
  const double p = kappa*J*(2.0*J - 1.0)*trace;
  double       B[6], dB[6];

  TLEDLeftStrain(H, B);
  TLEDLeftStrainDifferential(L, B, dB);
  for (int k = 0; k < 6; k++) dB[k] = s*(dB[k] - (2.0/3)*trace*B[k]);
  TLEDDeviator(dB, dtau);
  dtau[0] += p; dtau[1] += p; dtau[2] += p;
}

/* Differential of P in the direction dF */
BY_HD void TLEDStressDifferentialNeoHookeanIso(const double H[9], const double dF[9], double mu, double kappa, double dP[9])
{
  const double inv_J = 1.0 / (1.0 + TLEDJacobianMinusOne(H));
  double       L[9], tau[6], dtau[6];

  (void)TLEDVelocityGradient(H, dF, inv_J, L);
  TLEDKirchhoffNeoHookeanIso(H, inv_J, mu, kappa, tau);
  TLEDKirchhoffDifferentialNeoHookeanIso(H, L, inv_J, mu, kappa, dtau);
  TLEDFirstStressDifferential(H, inv_J, L, tau, dtau, dP);
}

/* Differential of P in the direction dF; with G = (1 + tr B) B - B^2, whose deviator is that of I1 b - b^2,
     dtau = (that of the first term) + 2 c01 c^4 dev(dG - 4/3 tr L G),  dG = tr dB B + (1 + tr B) dB - dB B - B dB */
BY_HD void TLEDStressDifferentialMooneyRivlin(const double H[9], const double dF[9], double c10, double c01, double kappa, double dP[9])
{
  const double inv_J = 1.0 / (1.0 + TLEDJacobianMinusOne(H)), c = TLEDCubeRoot(inv_J), s = 2.0*c01*(c*c)*(c*c);
  double       L[9], B[6], dB[6], BB[6], dBB[6], G[6], D[6], tau[6], dtau[6];
  const double trace = TLEDVelocityGradient(H, dF, inv_J, L);

  TLEDLeftStrain(H, B);
  TLEDLeftStrainDifferential(L, B, dB);
  TLEDSquare(B, BB);
  const double dM[9] = {dB[0], dB[3], dB[5], dB[3], dB[1], dB[4], dB[5], dB[4], dB[2]};
  TLEDPushDifferential(dM, B, dBB); /* dB B + B dB */
  const double t = B[0] + B[1] + B[2], dt = dB[0] + dB[1] + dB[2];
  for (int k = 0; k < 6; k++) G[k] = s*(dt*B[k] + (1.0 + t)*dB[k] - dBB[k] - (4.0/3)*trace*((1.0 + t)*B[k] - BB[k]));
  TLEDDeviator(G, D);
  TLEDKirchhoffMooneyRivlin(H, inv_J, c10, c01, kappa, tau);
  TLEDKirchhoffDifferentialNeoHookeanIso(H, L, inv_J, 2.0*c10, kappa, dtau);
  for (int k = 0; k < 6; k++) dtau[k] += D[k];
  TLEDFirstStressDifferential(H, inv_J, L, tau, dtau, dP);
}

/* Differential of P in the direction dF; with e = c^2 I4 - 1, m = F a, dm = L m, de = c^2 (2 m.dm - 2/3 tr L I4),
     dtau = (that of the matrix) + 2 eta c^2 dev[(de - 2/3 tr L e) m m^T + e (dm m^T + m dm^T)] */
BY_HD void TLEDStressDifferentialTransverse(const double H[9], const double a[3], const double dF[9], double mu, double eta,
                                            double kappa, double dP[9])
{
  const double inv_J = 1.0 / (1.0 + TLEDJacobianMinusOne(H)), c = TLEDCubeRoot(inv_J), s = 2.0*eta*c*c;
  double       L[9], m[3], dm[3], tau[6], dtau[6], A[6], D[6];
  const double trace = TLEDVelocityGradient(H, dF, inv_J, L), e = TLEDFourthInvariant(H, a, inv_J, m);

  Mul3(L, m, dm);
  const double w = c*c*(2.0*Dot3(m, dm) - (2.0/3)*trace*Dot3(m, m)) - (2.0/3)*trace*e;
  A[0] = w*m[0]*m[0] + 2.0*e*dm[0]*m[0];
  A[1] = w*m[1]*m[1] + 2.0*e*dm[1]*m[1];
  A[2] = w*m[2]*m[2] + 2.0*e*dm[2]*m[2];
  A[3] = w*m[0]*m[1] + e*(dm[0]*m[1] + m[0]*dm[1]);
  A[4] = w*m[1]*m[2] + e*(dm[1]*m[2] + m[1]*dm[2]);
  A[5] = w*m[0]*m[2] + e*(dm[0]*m[2] + m[0]*dm[2]);
  TLEDDeviator(A, D);
  TLEDKirchhoffTransverse(H, a, inv_J, mu, eta, kappa, tau);
  TLEDKirchhoffDifferentialNeoHookeanIso(H, L, inv_J, mu, kappa, dtau);
  for (int k = 0; k < 6; k++) dtau[k] += s*D[k];
  TLEDFirstStressDifferential(H, inv_J, L, tau, dtau, dP);
}

#endif
