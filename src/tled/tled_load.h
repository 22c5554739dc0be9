/* tled_load.h - loads on a face of three or six nodes, for host and device.

   A face is the image x(xi, eta) = sum_a N_a x_a of the triangle 0 <= xi, eta, xi + eta <= 1; nodes are the vertices, then those after each
   along the edges 01, 12, 20. Its area vector is n dA = x_xi x x_eta dxi deta. A pressure p that follows it and a traction t per
   reference area give

     f_a = -p int N_a x_xi x x_eta dxi deta,   f_a = t int N_a |X_xi x X_eta| dxi deta.

   The first is a polynomial of degree 0 + 1 (three nodes: one point is exact) or 4 (six nodes: the rule of six points is exact, on curved
   faces too); the second is exact on faces that are plane with straight edges. */
#ifndef BY_TLED_LOAD_H
#define BY_TLED_LOAD_H

#include "mat3.h"

/* Point q of the rule for a face of n nodes, 1 or 6 points: shape functions N and their slopes D[2a], D[2a+1]; returns the weight, of which the
   sum is 1/2. [Dunavant, IJNME 21 (1985) 1129: degree 4, all weights positive] */
BY_HD double TLEDFacePoint(int n, int q, double N[6], double D[12])
{
  const double c6[2] = {0.44594849091596488632, 0.09157621350977074346}, w6[2] = {0.22338158967801146570, 0.10995174365532186764};
  const double c = n == 3 ? 1.0 / 3.0 : c6[q / 3], w = n == 3 ? 1.0 : w6[q / 3];
  double       L[3] = {c, c, c};
  const double slope[3][2] = {{-1.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}};

  L[q % 3] = 1.0 - 2.0*c;
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3;
    N[a] = n == 3 ? L[a] : L[a]*(2.0*L[a] - 1.0);
    for (int k = 0; k < 2; k++) D[2*a + k] = n == 3 ? slope[a][k] : (4.0*L[a] - 1.0)*slope[a][k];
    if (n == 3) continue;
    N[3 + a] = 4.0*L[a]*L[b];
    for (int k = 0; k < 2; k++) D[2*(3 + a) + k] = 4.0*(L[b]*slope[a][k] + L[a]*slope[b][k]);
  }
  return 0.5*w;
}

/* edges x_xi and x_eta of the face at a point with slopes D */
BY_HD void TLEDFaceEdges(int n, const double x[], const double D[], double along[2][3])
{
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 3; i++) {
      along[k][i] = 0.0;
      for (int a = 0; a < n; a++) along[k][i] += D[2*a + k]*x[3*a + i];
    }
}

/* forces f[3a + i] of the pressure p [Pa] on the current face x[3a + i] */
BY_HD void TLEDFacePressure(int n, const double x[], double p, double f[])
{
  double N[6], D[12], along[2][3], area[3];

  for (int k = 0; k < 3*n; k++) f[k] = 0.0;
  for (int q = 0; q < (n == 3 ? 1 : 6); q++) {
    const double w = TLEDFacePoint(n, q, N, D);
    TLEDFaceEdges(n, x, D, along);
    Cross3(along[0], along[1], area);
    for (int a = 0; a < n; a++)
      for (int i = 0; i < 3; i++) f[3*a + i] -= w*p*N[a]*area[i];
  }
}

/* shares s_a = int N_a dA [m^2] of the face's area: a traction t gives f_a = t s_a */
BY_HD void TLEDFaceShares(int n, const double x[], double s[])
{
  double N[6], D[12], along[2][3], area[3];

  for (int a = 0; a < n; a++) s[a] = 0.0;
  for (int q = 0; q < (n == 3 ? 1 : 6); q++) {
    const double w = TLEDFacePoint(n, q, N, D);
    TLEDFaceEdges(n, x, D, along);
    Cross3(along[0], along[1], area);
    for (int a = 0; a < n; a++) s[a] += w*N[a]*Norm3(area);
  }
}

/* Stiffness -df_a/dx_b of the pressure, 3 x 3, added to K: d(x_xi x x_eta) = D_b0 (d x x_eta) + D_b1 (x_xi x d), so that
   K_ab = p int N_a (D_b1 [x_xi]x - D_b0 [x_eta]x), [v]x the matrix of v x */
BY_HD void TLEDFaceStiffness(int n, const double x[], double p, int a, int b, double K[9])
{
  double N[6], D[12], along[2][3];

  for (int q = 0; q < (n == 3 ? 1 : 6); q++) {
    const double w = TLEDFacePoint(n, q, N, D);
    double       v[3];
    TLEDFaceEdges(n, x, D, along);
    for (int i = 0; i < 3; i++) v[i] = w*p*N[a]*(D[2*b + 1]*along[0][i] - D[2*b]*along[1][i]);
    K[1] -= v[2]; K[2] += v[1];
    K[3] += v[2]; K[5] -= v[0];
    K[6] -= v[1]; K[7] += v[0];
  }
}

#endif
