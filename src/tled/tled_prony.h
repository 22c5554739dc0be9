/* tled_prony.h - viscoelasticity over any elastic law by a Prony series, for host and device.

   The isochoric second Piola-Kirchhoff stress relaxes [Holzapfel, Nonlinear Solid Mechanics (2000), section 6.10]:
     S = S_el + sum_i alpha_i (h_i - S_iso),   h_i(t) = int exp(-(t - s)/tau_i) dS_iso/ds ds
   so that S_vol + S_iso is felt at once, S_vol + (1 - sum alpha_i) S_iso after a long time. A step dt in which S_iso goes along a straight
   line is exact:
     h_i <- keep_i h_i + gain_i (S_iso(new) - S_iso(old)),   keep_i = exp(-dt/tau_i),  gain_i = (1 - keep_i) tau_i/dt
   S_iso is the stress of W_iso(F) = W(J^(-1/3) F), the energy of the shape alone, for every law: S_iso = J^(-2/3) DEV S(J^(-1/3) F). For
   laws that split volume from shape it is their isochoric part. */
#ifndef BY_TLED_PRONY_H
#define BY_TLED_PRONY_H

#include "tled/tled_material.h"

/* keep_i and gain_i of a step */
typedef struct {
  double keep[TLED_PRONY_MAX], gain[TLED_PRONY_MAX];
} TLEDPronyStep;

/* dt = 0: a jump, nothing has relaxed; dt infinite: all has */
BY_HD void TLEDPronyFactors(const TLEDLaw *m, double dt, TLEDPronyStep *s)
{
  for (int i = 0; i < m->n_prony; i++) {
    const double x = dt / m->tau[i];
    s->keep[i] = exp(-x);
    s->gain[i] = x > 0.0 ? -expm1(-x) / x : 1.0;
  }
}

/* Fbar - I of Fbar = J^(-1/3) F, the deformation without its change of volume; J^(-1/3) is returned */
BY_HD double TLEDShapeGradient(const double H[9], double inv_J, double Hbar[9])
{
  const double c = TLEDCubeRoot(inv_J), d = -TLEDJacobianMinusOne(H)*inv_J / (c*c + c + 1.0); /* c - 1 */

  Hbar[0] = d + c*H[0]; Hbar[1] = c*H[1];     Hbar[2] = c*H[2];
  Hbar[3] = c*H[3];     Hbar[4] = d + c*H[4]; Hbar[5] = c*H[5];
  Hbar[6] = c*H[6];     Hbar[7] = c*H[7];     Hbar[8] = d + c*H[8];
  return c;
}

/* Kirchhoff stress of W_iso: the deviator of P(Fbar) Fbar^T [Pa] */
BY_HD void TLEDIsochoricKirchhoff(const TLEDLaw *m, const double a[3], const double H[9], double inv_J, double D[6])
{
  double Hbar[9], F[9], P[9], tau[6];

  (void)TLEDShapeGradient(H, inv_J, Hbar);
  TLEDDeformationGradient(Hbar, F);
  TLEDStress(m, a, Hbar, 0.0, 1.0, P);
  tau[0] = Dot3(&P[0], &F[0]); tau[1] = Dot3(&P[3], &F[3]); tau[2] = Dot3(&P[6], &F[6]);
  tau[3] = Dot3(&P[0], &F[3]); tau[4] = Dot3(&P[3], &F[6]); tau[5] = Dot3(&P[0], &F[6]);
  TLEDDeviator(tau, D);
}

/* S = F^-1 D F^-T of a symmetric D, F^-1 = (cof F)^T/J */
BY_HD void TLEDPullBack(const double H[9], double inv_J, const double D[6], double S[6])
{
  const double r = inv_J*inv_J;
  double       F[9], C[9], T[9];

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, C);
  T[0] = D[0]*C[0] + D[3]*C[3] + D[5]*C[6]; T[1] = D[0]*C[1] + D[3]*C[4] + D[5]*C[7]; T[2] = D[0]*C[2] + D[3]*C[5] + D[5]*C[8];
  T[3] = D[3]*C[0] + D[1]*C[3] + D[4]*C[6]; T[4] = D[3]*C[1] + D[1]*C[4] + D[4]*C[7]; T[5] = D[3]*C[2] + D[1]*C[5] + D[4]*C[8];
  T[6] = D[5]*C[0] + D[4]*C[3] + D[2]*C[6]; T[7] = D[5]*C[1] + D[4]*C[4] + D[2]*C[7]; T[8] = D[5]*C[2] + D[4]*C[5] + D[2]*C[8];
  S[0] = r*(C[0]*T[0] + C[3]*T[3] + C[6]*T[6]);
  S[1] = r*(C[1]*T[1] + C[4]*T[4] + C[7]*T[7]);
  S[2] = r*(C[2]*T[2] + C[5]*T[5] + C[8]*T[8]);
  S[3] = r*(C[0]*T[1] + C[3]*T[4] + C[6]*T[7]);
  S[4] = r*(C[1]*T[2] + C[4]*T[5] + C[7]*T[8]);
  S[5] = r*(C[0]*T[2] + C[3]*T[5] + C[6]*T[8]);
}

/* S_iso of a law [Pa] */
BY_HD void TLEDIsochoricStress(const TLEDLaw *m, const double a[3], const double H[9], double inv_J, double S[6])
{
  double D[6];

  TLEDIsochoricKirchhoff(m, a, H, inv_J, D);
  TLEDPullBack(H, inv_J, D, S);
}

/* P += F R of a symmetric R */
BY_HD void TLEDAddSecondStress(const double F[9], const double R[6], double P[9])
{
  P[0] += F[0]*R[0] + F[1]*R[3] + F[2]*R[5]; P[1] += F[0]*R[3] + F[1]*R[1] + F[2]*R[4]; P[2] += F[0]*R[5] + F[1]*R[4] + F[2]*R[2];
  P[3] += F[3]*R[0] + F[4]*R[3] + F[5]*R[5]; P[4] += F[3]*R[3] + F[4]*R[1] + F[5]*R[4]; P[5] += F[3]*R[5] + F[4]*R[4] + F[5]*R[2];
  P[6] += F[6]*R[0] + F[7]*R[3] + F[8]*R[5]; P[7] += F[6]*R[3] + F[7]*R[1] + F[8]*R[4]; P[8] += F[6]*R[5] + F[7]*R[4] + F[8]*R[2];
}

/* A law at one place and time: S = S_el + past + relax S_iso. Elastic: relax and past are zero. */
typedef struct {
  const TLEDLaw *law;
  double         fibre[3]; /* unit vector along the fibres                          */
  double         relax;    /* sum_i alpha_i (gain_i - 1)                            */
  double         past[6];  /* sum_i alpha_i (keep_i h_i - gain_i S_iso(old)) [Pa]   */
} TLEDLocalLaw;

/* P at H [Pa] */
BY_HD void TLEDLocalStress(const TLEDLocalLaw *m, const double H[9], double P[9])
{
  const double jm1 = TLEDJacobianMinusOne(H), inv_J = 1.0 / (1.0 + jm1);
  double       F[9], S[6];

  TLEDStress(m->law, m->fibre, H, TLEDLogJacobian(jm1), inv_J, P);
  if (!m->law->n_prony) return;
  TLEDDeformationGradient(H, F);
  TLEDIsochoricStress(m->law, m->fibre, H, inv_J, S);
  for (int k = 0; k < 6; k++) S[k] = m->past[k] + m->relax*S[k];
  TLEDAddSecondStress(F, S, P);
}

/* dS_iso in the direction dF = L F: F^-1 (dtau - L tau - tau L^T) F^-T of S_iso = F^-1 tau F^-T, tau = dev(P(Fbar) Fbar^T),
   dFbar = (L - 1/3 tr L) Fbar */
BY_HD void TLEDIsochoricDifferential(const TLEDLaw *m, const double a[3], const double H[9], double inv_J, const double dF[9], double dS[6])
{
  double       L[9], Hbar[9], F[9], dFbar[9], P[9], dP[9], tau[6], dtau[6], D[6];
  const double trace = TLEDVelocityGradient(H, dF, inv_J, L), c = TLEDShapeGradient(H, inv_J, Hbar);

  TLEDDeformationGradient(Hbar, F);
  for (int k = 0; k < 9; k++) dFbar[k] = c*dF[k] - (1.0/3)*trace*F[k];
  TLEDStress(m, a, Hbar, 0.0, 1.0, P);
  TLEDStressDifferential(m, a, Hbar, dFbar, dP);
  TLEDIsochoricKirchhoff(m, a, H, inv_J, tau);
  dtau[0] = Dot3(&dP[0], &F[0]) + Dot3(&P[0], &dFbar[0]);
  dtau[1] = Dot3(&dP[3], &F[3]) + Dot3(&P[3], &dFbar[3]);
  dtau[2] = Dot3(&dP[6], &F[6]) + Dot3(&P[6], &dFbar[6]);
  dtau[3] = Dot3(&dP[0], &F[3]) + Dot3(&P[0], &dFbar[3]);
  dtau[4] = Dot3(&dP[3], &F[6]) + Dot3(&P[3], &dFbar[6]);
  dtau[5] = Dot3(&dP[0], &F[6]) + Dot3(&P[0], &dFbar[6]);
  TLEDDeviator(dtau, D);
  TLEDPushDifferential(L, tau, dtau); /* L tau + tau L^T */
  for (int k = 0; k < 6; k++) D[k] -= dtau[k];
  TLEDPullBack(H, inv_J, D, dS);
}

/* differential of P in the direction dF: that of the elastic law, and dF R + relax F dS_iso with R = past + relax S_iso */
BY_HD void TLEDLocalDifferential(const TLEDLocalLaw *m, const double H[9], const double dF[9], double dP[9])
{
  const double inv_J = 1.0 / (1.0 + TLEDJacobianMinusOne(H));
  double       F[9], S[6], dS[6];

  TLEDStressDifferential(m->law, m->fibre, H, dF, dP);
  if (!m->law->n_prony) return;
  TLEDIsochoricStress(m->law, m->fibre, H, inv_J, S);
  TLEDIsochoricDifferential(m->law, m->fibre, H, inv_J, dF, dS);
  for (int k = 0; k < 6; k++) S[k] = m->past[k] + m->relax*S[k], dS[k] *= m->relax;
  TLEDDeformationGradient(H, F);
  TLEDAddSecondStress(F, dS, dP);
  TLEDAddSecondStress(dF, S, dP);
}

/* A : B of second Piola-Kirchhoff stresses moved into space: tr(C A C B) */
BY_HD double TLEDSpatialDot(const double H[9], const double A[6], const double B[6])
{
  const double a[9] = {A[0], A[3], A[5], A[3], A[1], A[4], A[5], A[4], A[2]}, b[9] = {B[0], B[3], B[5], B[3], B[1], B[4], B[5], B[4], B[2]};
  double       E[6], X[9], Y[9], sum = 0.0;

  TLEDGreenStrain(H, E);
  const double C[9] = {1.0 + 2.0*E[0], 2.0*E[3], 2.0*E[5], 2.0*E[3], 1.0 + 2.0*E[1], 2.0*E[4], 2.0*E[5], 2.0*E[4], 1.0 + 2.0*E[2]};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      X[3*i + j] = C[3*i]*a[j] + C[3*i + 1]*a[3 + j] + C[3*i + 2]*a[6 + j];
      Y[3*i + j] = C[3*i]*b[j] + C[3*i + 1]*b[3 + j] + C[3*i + 2]*b[6 + j];
    }
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) sum += X[3*i + j]*Y[3*j + i];
  return sum;
}

/* Energy of one term's spring over alpha [J/m^3] when its stress is h and S_iso is what it would be unrelaxed: with p = (h : S_iso)/|S_iso|^2
     p^2 W_iso + (|h|^2 - p^2 |S_iso|^2)/(4 mu)
   Exact while h is a multiple of S_iso, as after a step that is held (0 when all has relaxed, W_iso when nothing has), and at small strain
   for the isotropic laws; the model has no energy beyond that. */
BY_HD double TLEDPronySpring(const TLEDLaw *m, const double H[9], const double S_iso[6], double W_iso, const double h[6])
{
  const double SS = TLEDSpatialDot(H, S_iso, S_iso), hS = TLEDSpatialDot(H, h, S_iso), hh = TLEDSpatialDot(H, h, h);
  const double p = SS > 0.0 ? hS / SS : 0.0;

  return p*p*W_iso + (hh - p*p*SS) / (4.0*m->mu);
}

#endif
