/* Elastic laws and the tetrahedron, point by point: energy, stress and tangent against an independent code and against each
   other. */
#include "check.h"
#include "tled/tled_element.h"
#include "unit/tled/patch_reference.h"

static void Gradient(const double F[9], double H[9])
{
  for (int k = 0; k < 9; k++) H[k] = F[k] - (k % 4 == 0);
}

/* the law of a number with the constants of the reference */
static const TLEDLaw *Law(int law)
{
  static TLEDLaw m;

  m = (TLEDLaw){law, reference_mu, reference_lambda};
  return &m;
}

static const double no_fibre[3] = {0.0, 0.0, 0.0};

static void Stress(int law, const double H[9], double P[9])
{
  const double jm1 = TLEDJacobianMinusOne(H);

  TLEDStress(Law(law), no_fibre, H, TLEDLogJacobian(jm1), 1.0 / (1.0 + jm1), P);
}

static void EnergyAndStress_AreTheReference(void **state)
{
  (void)state;
  for (int law = 0; law < 2; law++) {
    for (int i = 0; i < 5; i++) {
      const PatchReference *r = &patch_reference[law][i];
      double                H[9], P[9];
      Gradient(r->F, H);
      assert_close(TLEDEnergy(Law(law), no_fibre, H), r->W, 1e-13, r->W + 1e5);
      Stress(law, H, P);
      for (int k = 0; k < 9; k++) assert_close(P[k], r->P[k], 1e-13, 1e6);
    }
  }
}

/* stress = dW/dF and tangent = dP/dF, by central differences: truncation 1e-10, round-off 1e-10 of the largest term */
static void StressAndTangent_AreDerivatives(void **state)
{
  const double eps = 1e-5;

  (void)state;
  for (int law = 0; law < 2; law++) {
    for (int i = 0; i < 5; i++) {
      double H[9], P[9];
      Gradient(patch_reference[law][i].F, H);
      Stress(law, H, P);
      for (int k = 0; k < 9; k++) {
        double up[9], down[9], P_up[9], P_down[9], dF[9] = {0}, dP[9];
        for (int j = 0; j < 9; j++) up[j] = H[j] + (j == k) * eps, down[j] = H[j] - (j == k) * eps;
        dF[k] = 1.0;
        assert_close((TLEDEnergy(Law(law), no_fibre, up) - TLEDEnergy(Law(law), no_fibre, down)) /
                         (2 * eps),
                     P[k], 1e-9, 1e6);
        Stress(law, up, P_up);
        Stress(law, down, P_down);
        TLEDStressDifferential(Law(law), no_fibre, H, dF, dP);
        for (int j = 0; j < 9; j++) assert_close((P_up[j] - P_down[j]) / (2 * eps), dP[j], 1e-8, 1e6);
      }
    }
  }
}

/* a rotation before or after: energy unchanged, P turns with the body, F P^T stays symmetric (no moment) */
static void Laws_AreObjective(void **state)
{
  const double c = cos(0.7), s = sin(0.7), Q[9] = {c, -s, 0, s, c, 0, 0, 0, 1};

  (void)state;
  for (int law = 0; law < 2; law++) {
    const PatchReference *r    = &patch_reference[law][0];
    double                F[9] = {0}, QP[9] = {0}, H[9], P[9], M[9] = {0};
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++) F[3 * i + j] += Q[3 * i + k] * r->F[3 * k + j], QP[3 * i + j] += Q[3 * i + k] * r->P[3 * k + j];
    Gradient(F, H);
    assert_close(TLEDEnergy(Law(law), no_fibre, H), r->W, 1e-12, r->W);
    Stress(law, H, P);
    for (int k = 0; k < 9; k++) assert_close(P[k], QP[k], 1e-12, 1e6);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++) M[3 * i + j] += F[3 * i + k] * P[3 * j + k];
    assert_close(M[1], M[3], 1e-12, 1e6);
    assert_close(M[2], M[6], 1e-12, 1e6);
    assert_close(M[5], M[7], 1e-12, 1e6);
    Gradient(Q, H);
    Stress(law, H, P);
    for (int k = 0; k < 9; k++) assert_close(P[k], 0.0, 1e-14, 1e6);
  }
}

/* J - 1, ln J and the cube root keep their digits near 1, where solids are */
static void SmallStrains_KeepTheirDigits(void **state)
{
  (void)state;
  for (double e = 1e-12; e < 0.3; e *= 3.7) {
    const double H[9] = {e, 0, 0, 0, e, 0, 0, 0, e};
    assert_close(TLEDJacobianMinusOne(H), 3 * e + 3 * e * e + e * e * e, 4e-16, 3 * e);
    assert_close(TLEDLogJacobian(e), log1p(e), 6e-16, e);
    assert_close(TLEDLogJacobian(-e), log1p(-e), 6e-16, e);
  }
  assert_close(TLEDLogJacobian(3.0), log(4.0), 1e-15, 1.0);
  assert_true(isnan(TLEDLogJacobian(-1.5)));
  for (double x = 0.01; x < 100.0; x *= 1.3) assert_close(TLEDCubeRoot(x), cbrt(x), 1e-15, cbrt(x));
}

/* the stiffness is the derivative of the nodal forces, symmetric, and blind to a rigid shift */
static void Stiffness_IsTheDerivativeOfForces(void **state)
{
  const double X[12] = {0.1, 0, 0, 1.2, 0.1, -0.1, 0.2, 0.9, 0.1, 0, 0.2, 1.1};

  (void)state;
  for (int law = 0; law < 2; law++) {
    double       G[9], G4[12], H[9], K[144] = {0.0};
    const double V0 = TLEDReferenceGradients(X, G);
    assert_true(V0 > 0.0);
    Gradient(patch_reference[law][1].F, H);
    for (int k = 0; k < 9; k++) G4[3 + k] = G[k];
    for (int k = 0; k < 3; k++) G4[k] = -(G[k] + G[3 + k] + G[6 + k]);
    TLEDElementStiffness(Law(law), no_fibre, H, G4, 4, V0, K);
    for (int b = 0; b < 12; b++) {
      double g[3], dF[9], dP[9], f[9], sum = 0.0;
      for (int j = 0; j < 3; j++) g[j] = b < 3 ? -(G[j] + G[3 + j] + G[6 + j]) : G[3 * (b / 3 - 1) + j];
      for (int k = 0; k < 9; k++) dF[k] = k / 3 == b % 3 ? g[k % 3] : 0.0;
      TLEDStressDifferential(Law(law), no_fibre, H, dF, dP);
      TLEDNodalForces(dP, G, V0, f);
      for (int r = 3; r < 12; r++) assert_close(K[12 * r + b], f[r - 3], 1e-13, 1e6);
      for (int r = 0; r < 12; r++) {
        assert_close(K[12 * r + b], K[12 * b + r], 1e-13, 1e6);
        sum += r % 3 == 0 ? K[12 * r + b] : 0.0;
      }
      assert_close(sum, 0.0, 1e-13, 1e6);
    }
  }
}

CHECK_MAIN(cmocka_unit_test(EnergyAndStress_AreTheReference), cmocka_unit_test(StressAndTangent_AreDerivatives),
           cmocka_unit_test(Laws_AreObjective), cmocka_unit_test(SmallStrains_KeepTheirDigits),
           cmocka_unit_test(Stiffness_IsTheDerivativeOfForces))
