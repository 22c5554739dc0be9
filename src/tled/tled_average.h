/* tled_average.h - second derivatives of the average nodal pressure element [Joldes09, variational form of method 3]: what its exact
   tangent is made of. First derivatives are in tled_element.h. */
#ifndef BY_TLED_AVERAGE_H
#define BY_TLED_AVERAGE_H

#include "tled/tled_element.h"

/* dC of C = cof F in the direction dF */
BY_HD void TLEDCofactorDifferential(const double F[9], const double dF[9], double dC[9])
{
  dC[0] = dF[4]*F[8] + F[4]*dF[8] - dF[5]*F[7] - F[5]*dF[7];
  dC[1] = dF[5]*F[6] + F[5]*dF[6] - dF[3]*F[8] - F[3]*dF[8];
  dC[2] = dF[3]*F[7] + F[3]*dF[7] - dF[4]*F[6] - F[4]*dF[6];
  dC[3] = dF[2]*F[7] + F[2]*dF[7] - dF[1]*F[8] - F[1]*dF[8];
  dC[4] = dF[0]*F[8] + F[0]*dF[8] - dF[2]*F[6] - F[2]*dF[6];
  dC[5] = dF[1]*F[6] + F[1]*dF[6] - dF[0]*F[7] - F[0]*dF[7];
  dC[6] = dF[1]*F[5] + F[1]*dF[5] - dF[2]*F[4] - F[2]*dF[4];
  dC[7] = dF[2]*F[3] + F[2]*dF[3] - dF[0]*F[5] - F[0]*dF[5];
  dC[8] = dF[0]*F[4] + F[0]*dF[4] - dF[1]*F[3] - F[1]*dF[3];
}

/* The element's energy density is a function w(F, Jbar) = W((Jbar/J)^(1/3) F). Differentials in the direction (dF, dJbar) of its
   derivatives: of dw/dF = r Pbar - (Jbar/J) pbar cof F (written over dP) and of dw/dJbar = pbar (returned). */
BY_HD double TLEDAverageDifferential(const TLEDLocalLaw *law, const double H[9], double Jbar, const double dF[9],
                                     double dJbar, double dP[9])
{
  const double inv_J = 1.0 / (1.0 + TLEDJacobianMinusOne(H));
  double       F[9], C[9], dC[9], Hbar[9], dFbar[9], Pbar[9], dPbar[9], dJ = 0.0, work = 0.0;

  const double r = TLEDAverageGradient(H, inv_J, Jbar, Hbar);
  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, C);
  TLEDCofactorDifferential(F, dF, dC);
  for (int k = 0; k < 9; k++) dJ += C[k]*dF[k];
  const double dr = r/3.0*(dJbar/Jbar - dJ*inv_J);
  for (int k = 0; k < 9; k++) dFbar[k] = r*dF[k] + dr*F[k];
  TLEDLocalStress(law, Hbar, Pbar);
  TLEDLocalDifferential(law, Hbar, dFbar, dPbar);
  const double pbar = TLEDAveragePressure(Hbar, Pbar, Jbar);
  for (int k = 0; k < 9; k++) work += dPbar[k]*r*F[k] + Pbar[k]*dFbar[k];
  const double dpbar = (work/3.0 - pbar*dJbar)/Jbar;
  const double c = Jbar*inv_J*pbar, dc = inv_J*(dJbar*pbar + Jbar*dpbar) - c*inv_J*dJ;
  for (int k = 0; k < 9; k++) dP[k] = dr*Pbar[k] + r*dPbar[k] - dc*C[k] - c*dC[k];
  return dpbar;
}

#endif
