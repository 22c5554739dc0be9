/* tled_t10.h - the ten-node tetrahedron: quadrature, shape functions, slopes, nodal forces and lumped mass. For host and device; the
   loops are in tled_openmp_t10.c and tled_device_loops.h.

   Nodes in VTK's order: vertices 0 to 3, then the edges 01, 12, 02, 03, 13, 23. L_0 = 1 - xi_1 - xi_2 - xi_3, L_k = xi_k are the
   barycentric coordinates; with them N_v = L_v (2 L_v - 1) at vertices and N_vw = 4 L_v L_w on edges [Zienkiewicz, Taylor & Zhu, The
   Finite Element Method: Its Basis and Fundamentals, 6th ed., section 4.12]. */
#ifndef BY_TLED_T10_H
#define BY_TLED_T10_H

#include "mat3.h"

/* points of the two quadrature rules: exact to degree 2, and to degree 5 */
enum { TLED_T10_POINTS = 4, TLED_T10_POINTS_FINE = 14 };

/* smaller barycentric coordinate of the four points, (5 - sqrt 5)/20 */
#define TLED_T10_NEAR 0.1381966011250105152

/* The vertices of edge e = 0 ... 5, whose node is 4 + e. */
BY_HD void TLEDEdgeT10(int e, int *v, int *w)
{
  *v = e < 3 ? (e == 1 ? 1 : 0) : e - 3;
  *w = e == 0 ? 1 : e < 3 ? 2 : 3;
}

/* Point q of the rule of n_points: barycentric coordinates L, weight returned; the weights add to 1/6, the volume of the reference
   element. 4 points of equal weight, exact to degree 2: L = (a, b, b, b), a = (5 + 3 sqrt 5)/20 [Zienkiewicz, table 5.3]. 14 points,
   all weights positive, exact to degree 5: four each of two kinds (1 - 3c, c, c, c), six of the kind (c, c, 1/2 - c, 1/2 - c)
   [Walkington, Quadrature on simplices of arbitrary dimension, 2000; Keast, CMAME 55 (1986) 339]. */
BY_HD double TLEDQuadratureT10(int n_points, int q, double L[4])
{
  const double c14[3] = {0.3108859192633006098, 0.0927352503108912264, 0.0455037041256496495};
  const double w14[3] = {0.1126879257180158508, 0.0734930431163619495, 0.0425460207770814664};
  const int    kind = q < 4 ? 0 : q < 8 ? 1 : 2;
  const double c = n_points == TLED_T10_POINTS ? TLED_T10_NEAR : c14[kind];
  int          v, w;

  L[0] = L[1] = L[2] = L[3] = c;
  if (kind < 2) {
    L[q % 4] = 1.0 - 3.0*c;
  } else {
    TLEDEdgeT10(q - 8, &v, &w);
    L[v] = L[w] = 0.5 - c;
  }
  return (n_points == TLED_T10_POINTS ? 0.25 : w14[kind]) / 6.0;
}

/* N_a(L), a = 0 ... 9 */
BY_HD void TLEDShapeT10(const double L[4], double N[10])
{
  for (int a = 0; a < 4; a++) N[a] = L[a]*(2.0*L[a] - 1.0);
  for (int e = 0; e < 6; e++) {
    int v, w;
    TLEDEdgeT10(e, &v, &w);
    N[4 + e] = 4.0*L[v]*L[w];
  }
}

/* Slopes du/dxi_k = sum_a u_a dN_a/dxi_k of nodal values u: with D_v = dL-derivative (4 L_v - 1) u_v + 4 sum_w L_w u_vw they are
   D_k - D_0. */
BY_HD void TLEDSlopesT10(const double L[4], const double u[10], double slope[3])
{
  const double D0 = (4.0*L[0] - 1.0)*u[0] + 4.0*(L[1]*u[4] + L[2]*u[6] + L[3]*u[7]);
  const double D1 = (4.0*L[1] - 1.0)*u[1] + 4.0*(L[0]*u[4] + L[2]*u[5] + L[3]*u[8]);
  const double D2 = (4.0*L[2] - 1.0)*u[2] + 4.0*(L[1]*u[5] + L[0]*u[6] + L[3]*u[9]);
  const double D3 = (4.0*L[3] - 1.0)*u[3] + 4.0*(L[0]*u[7] + L[1]*u[8] + L[2]*u[9]);

  slope[0] = D1 - D0;
  slope[1] = D2 - D0;
  slope[2] = D3 - D0;
}

/* The same at the four points of the rule of degree 2 at once, slope[3 q + k]. With L_w(q) = c + (1 - 4c) [w = q] and u_vv = u_v the
   derivatives are D_v(q) = (4c - 1) u_v + 4c sum_{w != v} u_vw + 4 (1 - 4c) u_vq: the part of all points is worked out once. */
BY_HD void TLEDSlopesFourT10(const double u[10], double slope[12])
{
  const double c = 4.0*TLED_T10_NEAR, e = 4.0*(1.0 - c);
  const double B0 = (c - 1.0)*u[0] + c*(u[4] + u[6] + u[7]), B1 = (c - 1.0)*u[1] + c*(u[4] + u[5] + u[8]);
  const double B2 = (c - 1.0)*u[2] + c*(u[6] + u[5] + u[9]), B3 = (c - 1.0)*u[3] + c*(u[7] + u[8] + u[9]);

  slope[0] = (B1 - B0) + e*(u[4] - u[0]); slope[1]  = (B2 - B0) + e*(u[6] - u[0]); slope[2]  = (B3 - B0) + e*(u[7] - u[0]);
  slope[3] = (B1 - B0) + e*(u[1] - u[4]); slope[4]  = (B2 - B0) + e*(u[5] - u[4]); slope[5]  = (B3 - B0) + e*(u[8] - u[4]);
  slope[6] = (B1 - B0) + e*(u[5] - u[6]); slope[7]  = (B2 - B0) + e*(u[2] - u[6]); slope[8]  = (B3 - B0) + e*(u[9] - u[6]);
  slope[9] = (B1 - B0) + e*(u[8] - u[7]); slope[10] = (B2 - B0) + e*(u[9] - u[7]); slope[11] = (B3 - B0) + e*(u[3] - u[7]);
}

/* The transpose: f_a += sum_k T_k dN_a/dxi_k, a row T of w P Jinv^T (see TLEDPullBackT10()) to one component of the nodal forces. */
BY_HD void TLEDAddForcesT10(const double L[4], const double T[3], double f[10])
{
  const double T0 = -(T[0] + T[1] + T[2]);

  f[0] += (4.0*L[0] - 1.0)*T0;
  f[1] += (4.0*L[1] - 1.0)*T[0];
  f[2] += (4.0*L[2] - 1.0)*T[1];
  f[3] += (4.0*L[3] - 1.0)*T[2];
  f[4] += 4.0*(L[1]*T0 + L[0]*T[0]);
  f[5] += 4.0*(L[2]*T[0] + L[1]*T[1]);
  f[6] += 4.0*(L[2]*T0 + L[0]*T[1]);
  f[7] += 4.0*(L[3]*T0 + L[0]*T[2]);
  f[8] += 4.0*(L[3]*T[0] + L[1]*T[2]);
  f[9] += 4.0*(L[3]*T[1] + L[2]*T[2]);
}

/* The same for the four points at once, the transpose of TLEDSlopesFourT10(): T[3 q + k] of one component, f is written. */
BY_HD void TLEDForcesFourT10(const double T[12], double f[10])
{
  const double c = 4.0*TLED_T10_NEAR, e = 4.0*(1.0 - c);
  const double T00 = T[0] + T[1] + T[2], T10 = T[3] + T[4] + T[5], T20 = T[6] + T[7] + T[8], T30 = T[9] + T[10] + T[11];
  const double S0 = -((T00 + T10) + (T20 + T30)), S1 = (T[0] + T[3]) + (T[6] + T[9]), S2 = (T[1] + T[4]) + (T[7] + T[10]);
  const double S3 = (T[2] + T[5]) + (T[8] + T[11]);

  f[0] = (c - 1.0)*S0 - e*T00;
  f[1] = (c - 1.0)*S1 + e*T[3];
  f[2] = (c - 1.0)*S2 + e*T[7];
  f[3] = (c - 1.0)*S3 + e*T[11];
  f[4] = c*(S0 + S1) + e*(T[0] - T10);
  f[5] = c*(S1 + S2) + e*(T[6] + T[4]);
  f[6] = c*(S0 + S2) + e*(T[1] - T20);
  f[7] = c*(S0 + S3) + e*(T[2] - T30);
  f[8] = c*(S1 + S3) + e*(T[9] + T[5]);
  f[9] = c*(S2 + S3) + e*(T[10] + T[8]);
}

/* dN_a/dX_j [1/m] of all nodes from Jinv = dxi/dX (3 x 3, row k): g is 10 x 3 */
BY_HD void TLEDGradientsT10(const double L[4], const double Jinv[9], double g[30])
{
  for (int j = 0; j < 3; j++) {
    const double T[3] = {Jinv[j], Jinv[3 + j], Jinv[6 + j]};
    double       f[10] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

    TLEDAddForcesT10(L, T, f);
    for (int a = 0; a < 10; a++) g[3*a + j] = f[a];
  }
}

/* Jacobian of the element at L: Jinv = dxi/dX [1/m], returns det dX/dxi [m^3]; X is 10 x 3. Jinv is not written when it is 0. */
BY_HD double TLEDJacobianT10(const double L[4], const double X[30], double Jinv[9])
{
  double J[9];

  for (int i = 0; i < 3; i++) {
    double x[10];

    for (int a = 0; a < 10; a++) x[a] = X[3*a + i];
    TLEDSlopesT10(L, x, &J[3*i]);
  }
  return Invert3(J, Jinv);
}

/* Number of the Jacobian of a point of a pack among those stored; first[pack] are stored before it, one for a straight pack. */
BY_HD int TLEDJacobianNumber(const int first[], int pack, int point)
{
  return first[pack] + (first[pack + 1] - first[pack] == 1 ? 0 : point);
}

/* H = (du/dxi) (dxi/dX), row-major, from the slopes of the three displacement components (3 x 3, row i) */
BY_HD void TLEDPushForwardT10(const double slope[9], const double Jinv[9], double H[9])
{
  H[0] = slope[0]*Jinv[0] + slope[1]*Jinv[3] + slope[2]*Jinv[6];
  H[1] = slope[0]*Jinv[1] + slope[1]*Jinv[4] + slope[2]*Jinv[7];
  H[2] = slope[0]*Jinv[2] + slope[1]*Jinv[5] + slope[2]*Jinv[8];
  H[3] = slope[3]*Jinv[0] + slope[4]*Jinv[3] + slope[5]*Jinv[6];
  H[4] = slope[3]*Jinv[1] + slope[4]*Jinv[4] + slope[5]*Jinv[7];
  H[5] = slope[3]*Jinv[2] + slope[4]*Jinv[5] + slope[5]*Jinv[8];
  H[6] = slope[6]*Jinv[0] + slope[7]*Jinv[3] + slope[8]*Jinv[6];
  H[7] = slope[6]*Jinv[1] + slope[7]*Jinv[4] + slope[8]*Jinv[7];
  H[8] = slope[6]*Jinv[2] + slope[7]*Jinv[5] + slope[8]*Jinv[8];
}

/* T = w P Jinv^T [N], w the point's weight times det dX/dxi [m^3]: the force on node a is f_a = T dN_a/dxi, the integral of P dN_a/dX */
BY_HD void TLEDPullBackT10(const double P[9], const double Jinv[9], double w, double T[9])
{
  T[0] = w*(P[0]*Jinv[0] + P[1]*Jinv[1] + P[2]*Jinv[2]);
  T[1] = w*(P[0]*Jinv[3] + P[1]*Jinv[4] + P[2]*Jinv[5]);
  T[2] = w*(P[0]*Jinv[6] + P[1]*Jinv[7] + P[2]*Jinv[8]);
  T[3] = w*(P[3]*Jinv[0] + P[4]*Jinv[1] + P[5]*Jinv[2]);
  T[4] = w*(P[3]*Jinv[3] + P[4]*Jinv[4] + P[5]*Jinv[5]);
  T[5] = w*(P[3]*Jinv[6] + P[4]*Jinv[7] + P[5]*Jinv[8]);
  T[6] = w*(P[6]*Jinv[0] + P[7]*Jinv[1] + P[8]*Jinv[2]);
  T[7] = w*(P[6]*Jinv[3] + P[7]*Jinv[4] + P[8]*Jinv[5]);
  T[8] = w*(P[6]*Jinv[6] + P[7]*Jinv[7] + P[8]*Jinv[8]);
}

/* Lumped mass by diagonal scaling: m_a = M int N_a^2 dV / sum_b int N_b^2 dV, positive for every node and exact in the total M = rho V,
   V (returned) by the rule of degree 5, which is exact for curved elements too. A straight element's vertices get M/36, its edges'
   nodes 4M/27. m is the share m_a/rho [m^3]. [Hinton, Rock & Zienkiewicz, Earthquake Eng. Struct. Dyn. 4 (1976) 245] */
BY_HD double TLEDLumpT10(const double X[30], double m[10])
{
  double V = 0.0, sum = 0.0;

  for (int a = 0; a < 10; a++) m[a] = 0.0;
  for (int q = 0; q < TLED_T10_POINTS_FINE; q++) {
    double       L[4], N[10], Jinv[9];
    const double weight = TLEDQuadratureT10(TLED_T10_POINTS_FINE, q, L), w = weight*TLEDJacobianT10(L, X, Jinv);

    TLEDShapeT10(L, N);
    V += w;
    for (int a = 0; a < 10; a++) m[a] += w*N[a]*N[a];
  }
  for (int a = 0; a < 10; a++) sum += m[a];
  for (int a = 0; a < 10; a++) m[a] *= V/sum;
  return V;
}

#endif
