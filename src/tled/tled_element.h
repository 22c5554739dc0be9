/* tled_element.h - the four-node tetrahedron: displacement gradient, nodal forces, stiffness, and the modified gradient of the
   average nodal pressure element. For host and device; the loops are in tled_openmp.c and tled_cuda.cu.

   An element carries G, the reference gradients dN_a/dX [1/m] of its nodes a = 1, 2, 3 (3 x 3, row a - 1); that of node 0 is minus
   their sum. V0 is its reference volume [m^3]. */
#ifndef BY_TLED_ELEMENT_H
#define BY_TLED_ELEMENT_H

#include "tled/tled_material.h"

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

/* Average nodal pressure [Joldes09, variational form of method 3]: the element sees Fbar = r F, r = (Jbar/J)^(1/3), Jbar the mean of
   its nodes' volume ratios J_a = sum_e V0_e J_e / sum_e V0_e. Energy sum_e V0_e W(Fbar_e); for a law W_iso(F) + U(J) this is
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

/* Stiffness blocks of the neo-Hookean tetrahedron, K_ab = df_a/du_b [N/m], closed form with the current gradients g = F^-T G:
     K_ab = V0 [ mu (G_a . G_b) I + (mu - lambda ln J) g_b g_a^T + lambda' g_a g_b^T ]
   with lambda' = lambda. (A smaller lambda' takes volumetric stiffness out, see TLEDTangent().) K is 12 x 12, row-major, rows 3 a + i. */
BY_HD void TLEDStiffnessNeoHookean(const double H[9], const double G[9], double V0, double mu, double lambda, double lambda_prime,
                                   double K[144])
{
  const double jm1 = TLEDJacobianMinusOne(H), inv_J = 1.0 / (1.0 + jm1), c = mu - lambda*TLEDLogJacobian(jm1);
  double       F[9], B[9], G4[12], g[12];

  TLEDDeformationGradient(H, F);
  TLEDCofactor(F, B);
  for (int i = 0; i < 3; i++) {
    G4[i] = -(G[i] + G[3 + i] + G[6 + i]);
    for (int a = 1; a < 4; a++) G4[3*a + i] = G[3*(a - 1) + i];
  }
  for (int a = 0; a < 4; a++)
    for (int i = 0; i < 3; i++) g[3*a + i] = inv_J*(B[3*i]*G4[3*a] + B[3*i + 1]*G4[3*a + 1] + B[3*i + 2]*G4[3*a + 2]);
  for (int a = 0; a < 4; a++) {
    for (int b = 0; b < 4; b++) {
      const double d = V0*mu*Dot3(&G4[3*a], &G4[3*b]);
      for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
          K[12*(3*a + i) + 3*b + k] = V0*(c*g[3*b + i]*g[3*a + k] + lambda_prime*g[3*a + i]*g[3*b + k]) + (i == k ? d : 0.0);
      }
    }
  }
}

/* Stiffness blocks of the St Venant-Kirchhoff tetrahedron with y = F G:
     K_ab = V0 [ (G_a . S G_b) I + lambda' y_a y_b^T + mu (y_b y_a^T + (G_a . G_b) F F^T) ],  lambda' = lambda as above */
BY_HD void TLEDStiffnessStVenantKirchhoff(const double H[9], const double G[9], double V0, double mu, double lambda,
                                          double lambda_prime, double K[144])
{
  double F[9], B[9], S[6], G4[12], y[12];

  TLEDDeformationGradient(H, F);
  TLEDSecondStressStVenantKirchhoff(H, mu, lambda, S);
  for (int i = 0; i < 3; i++) {
    G4[i] = -(G[i] + G[3 + i] + G[6 + i]);
    for (int a = 1; a < 4; a++) G4[3*a + i] = G[3*(a - 1) + i];
    for (int k = 0; k < 3; k++) B[3*i + k] = Dot3(&F[3*i], &F[3*k]);
  }
  for (int a = 0; a < 4; a++) Mul3(F, &G4[3*a], &y[3*a]);
  for (int a = 0; a < 4; a++) {
    for (int b = 0; b < 4; b++) {
      const double *A = &G4[3*a], *C = &G4[3*b];
      const double  GG = Dot3(A, C);
      const double  GSG = A[0]*(S[0]*C[0] + S[3]*C[1] + S[5]*C[2]) + A[1]*(S[3]*C[0] + S[1]*C[1] + S[4]*C[2])
                         + A[2]*(S[5]*C[0] + S[4]*C[1] + S[2]*C[2]);
      for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
          K[12*(3*a + i) + 3*b + k] = V0*(lambda_prime*y[3*a + i]*y[3*b + k] + mu*(y[3*b + i]*y[3*a + k] + GG*B[3*i + k]) + (i == k ? GSG : 0.0));
      }
    }
  }
}

/* stiffness of the law `law` */
BY_HD void TLEDStiffness(int law, const double H[9], const double G[9], double V0, double mu, double lambda, double lambda_prime,
                         double K[144])
{
  if (law == TLED_LAW_NEO_HOOKEAN) TLEDStiffnessNeoHookean(H, G, V0, mu, lambda, lambda_prime, K);
  else TLEDStiffnessStVenantKirchhoff(H, G, V0, mu, lambda, lambda_prime, K);
}

#endif
