/* tled_element.h - the four-node tetrahedron: displacement gradient, nodal forces, stiffness, and the modified gradient of the
   average nodal pressure element. For host and device; the loops are in tled_openmp.c and tled_device_loops.h.

   An element carries G, the reference gradients dN_a/dX [1/m] of its nodes a = 1, 2, 3 (3 x 3, row a - 1); that of node 0 is minus
   their sum. V0 is its reference volume [m^3]. */
#ifndef BY_TLED_ELEMENT_H
#define BY_TLED_ELEMENT_H

#include "tled/tled_prony.h"

/* Gradients and volume of a tetrahedron with corners X (4 x 3): rows of the inverse of D = [X1-X0 X2-X0 X3-X0], V0 = det D/6 (returned,
   negative when the corners are ordered the wrong way; G is not written when it is 0). */
BY_HD double TLEDReferenceGradients(const double X[12], double G[9])
{
  double D[9];

  for (int i = 0; i < 3; i++)
    for (int a = 0; a < 3; a++) D[3*i + a] = X[3*(a + 1) + i] - X[i];
  return Invert3(D, G) / 6.0;
}

/* H_ij = sum_a (u_a - u_0)_i G_a,j [Miller07, eq. 5 written for displacements]; d holds u_a - u_0 for a = 1, 2, 3 (3 x 3, row a - 1) */
BY_HD void TLEDDisplacementGradient(const double d[9], const double G[9], double H[9])
{
  H[0] = d[0]*G[0] + d[3]*G[3] + d[6]*G[6]; H[1] = d[0]*G[1] + d[3]*G[4] + d[6]*G[7]; H[2] = d[0]*G[2] + d[3]*G[5] + d[6]*G[8];
  H[3] = d[1]*G[0] + d[4]*G[3] + d[7]*G[6]; H[4] = d[1]*G[1] + d[4]*G[4] + d[7]*G[7]; H[5] = d[1]*G[2] + d[4]*G[5] + d[7]*G[8];
  H[6] = d[2]*G[0] + d[5]*G[3] + d[8]*G[6]; H[7] = d[2]*G[1] + d[5]*G[4] + d[8]*G[7]; H[8] = d[2]*G[2] + d[5]*G[5] + d[8]*G[8];
}

/* f_a = V0 P G_a [N], a = 1, 2, 3 (3 x 3, row a - 1) [Miller07, eq. 8]; node 0 takes minus their sum */
BY_HD void TLEDNodalForces(const double P[9], const double G[9], double V0, double f[9])
{
  f[0] = V0*(P[0]*G[0] + P[1]*G[1] + P[2]*G[2]);
  f[1] = V0*(P[3]*G[0] + P[4]*G[1] + P[5]*G[2]);
  f[2] = V0*(P[6]*G[0] + P[7]*G[1] + P[8]*G[2]);
  f[3] = V0*(P[0]*G[3] + P[1]*G[4] + P[2]*G[5]);
  f[4] = V0*(P[3]*G[3] + P[4]*G[4] + P[5]*G[5]);
  f[5] = V0*(P[6]*G[3] + P[7]*G[4] + P[8]*G[5]);
  f[6] = V0*(P[0]*G[6] + P[1]*G[7] + P[2]*G[8]);
  f[7] = V0*(P[3]*G[6] + P[4]*G[7] + P[5]*G[8]);
  f[8] = V0*(P[6]*G[6] + P[7]*G[7] + P[8]*G[8]);
}

/* Average nodal pressure [Joldes09, variational form of method 3]: the element sees Fbar = r F, r = (Jbar/J)^(1/3), Jbar the mean of
   its nodes' volume ratios J_a = sum_e V0_e J_e / sum_e V0_e over the elements of its own material. Energy sum_e V0_e W(Fbar_e); for a law W_iso(F) + U(J) this is
   W_iso(F) + U(Jbar). Hbar = Fbar - I; r is returned. */
BY_HD double TLEDAverageGradient(const double H[9], double inv_J, double Jbar, double Hbar[9])
{
  const double r = TLEDCubeRoot(Jbar*inv_J), d = r - 1.0;

  Hbar[0] = d + r*H[0]; Hbar[1] = r*H[1];     Hbar[2] = r*H[2];
  Hbar[3] = r*H[3];     Hbar[4] = d + r*H[4]; Hbar[5] = r*H[5];
  Hbar[6] = r*H[6];     Hbar[7] = r*H[7];     Hbar[8] = d + r*H[8];
  return r;
}

/* dW/dJbar = (Pbar : Fbar)/(3 Jbar) [Pa], the pressure an element passes to its nodes (sign: tension positive) */
BY_HD double TLEDAveragePressure(const double Hbar[9], const double Pbar[9], double Jbar)
{
  const double PF = Pbar[0]*Hbar[0] + Pbar[1]*Hbar[1] + Pbar[2]*Hbar[2] + Pbar[3]*Hbar[3] + Pbar[4]*Hbar[4] + Pbar[5]*Hbar[5]
                  + Pbar[6]*Hbar[6] + Pbar[7]*Hbar[7] + Pbar[8]*Hbar[8] + (Pbar[0] + Pbar[4] + Pbar[8]);

  return PF / (3.0*Jbar);
}

/* Exact gradient of that energy as a stress: P = r Pbar + (p - (Jbar/J) pbar) cof F with pbar = TLEDAveragePressure() of this element
   and p = sum over its nodes a of q_a, q_a = (1/4) sum_{e of a} V0_e pbar_e / sum_{e of a} V0_e. P is written over Pbar. */
BY_HD void TLEDAverageStress(const double H[9], double r, double inv_J, double Jbar, double pbar, double p, double P[9])
{
  const double c = p - Jbar*inv_J*pbar;
  double       F[9], C[9];

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, C);
  P[0] = r*P[0] + c*C[0]; P[1] = r*P[1] + c*C[1]; P[2] = r*P[2] + c*C[2];
  P[3] = r*P[3] + c*C[3]; P[4] = r*P[4] + c*C[4]; P[5] = r*P[5] + c*C[5];
  P[6] = r*P[6] + c*C[6]; P[7] = r*P[7] + c*C[7]; P[8] = r*P[8] + c*C[8];
}

/* Stiffness of one integration point of an element with n nodes, added to K (3n x 3n, row-major, rows 3 a + i) [N/m]:
     K_ai,bk += V0 sum_jl G_a,j A_ijkl G_b,l,  A = dP/dF at the gradient H that the law sees, G the nodes' reference gradients (n x 3) */
BY_HD void TLEDElementStiffness(const TLEDLocalLaw *law, const double H[9], const double G[], int n, double V0, double K[])
{
  double A[81]; /* A_ij of direction kl */

  for (int kl = 0; kl < 9; kl++) {
    double dF[9] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    dF[kl] = V0;
    TLEDLocalDifferential(law, H, dF, &A[9*kl]);
  }
  for (int a = 0; a < n; a++) {
    for (int i = 0; i < 3; i++) {
      double t[9], *row = &K[3*n*(3*a + i)];
      for (int kl = 0; kl < 9; kl++) t[kl] = Dot3(&A[9*kl + 3*i], &G[3*a]);
      for (int b = 0; b < n; b++)
        for (int k = 0; k < 3; k++) row[3*b + k] += Dot3(&t[3*k], &G[3*b]);
    }
  }
}

/* Take the excess bulk stiffness of TLEDExcessBulk() out of K: K_ab -= V0 excess y_a y_b^T with y_a = B G_a, B of TLEDBulkDirection() */
BY_HD void TLEDElementSoften(const TLEDLaw *law, const double H[9], const double G[], int n, double V0, double K[])
{
  const double excess = V0*TLEDExcessBulk(law);
  double       B[9], y[30];

  TLEDBulkDirection(law, H, B);
  for (int a = 0; a < n; a++) Mul3(B, &G[3*a], &y[3*a]);
  for (int r = 0; r < 3*n; r++)
    for (int c = 0; c < 3*n; c++) K[3*n*r + c] -= excess*y[r]*y[c];
}

#endif
