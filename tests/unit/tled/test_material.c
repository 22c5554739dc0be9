/* Elastic laws and the tetrahedron, point by point: energy, stress and differential against an independent code and against each
   other. */
#include "check.h"
#include "tled/tled_element.h"
#include "unit/tled/patch_reference.h"

static void Gradient(const double F[9], double H[9])
{
  for (int k = 0; k < 9; k++) H[k] = F[k] - (k % 4 == 0);
}

static void Multiply(const double A[9], const double B[9], double C[9])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

static void Stress(int law, const double a[3], const double H[9], double P[9])
{
  const double jm1 = TLEDJacobianMinusOne(H);

  TLEDStress(ReferenceLaw(law), a, H, TLEDLogJacobian(jm1), 1.0 / (1.0 + jm1), P);
}

static double Energy(int law, const double a[3], const double H[9]) { return TLEDEnergy(ReferenceLaw(law), a, H); }

/* an elastic law at a place with the fibres of the reference */
static const TLEDLocalLaw *LocalLaw(const TLEDLaw *law)
{
  static TLEDLocalLaw m;

  m = (TLEDLocalLaw){law, {reference_fibre[0], reference_fibre[1], reference_fibre[2]}, 0.0, {0.0}};
  return &m;
}

static void EnergyAndStress_AreTheReference(void **state)
{
  static const char *const names[TLED_LAWS] = {"neo_hookean", "st_venant_kirchhoff", "neo_hookean_iso", "mooney_rivlin", "transversely_isotropic"};

  (void)state;
  for (int law = 0; law < TLED_LAWS; law++) {
    double worst[3] = {0.0, 0.0, 0.0}; /* of W, P, F S over 1 MPa: lines of the report */
    for (int i = 0; i < PATCH_STATES; i++) {
      const PatchReference *r = &patch_reference[law][i];
      double                H[9], P[9], FS[9];
      Gradient(r->F, H);
      Stress(law, reference_fibre, H, P);
      Multiply(r->F, r->S, FS);
      worst[0] = fmax(worst[0], 1e-6 * fabs(Energy(law, reference_fibre, H) - r->W));
      for (int k = 0; k < 9; k++) worst[1] = fmax(worst[1], 1e-6 * fabs(P[k] - r->P[k]));
      for (int k = 0; k < 9 && r->S[0] != 0.0; k++) worst[2] = fmax(worst[2], 1e-6 * fabs(P[k] - FS[k]));
    }
    printf("material: %s | W, P, F S | %.1e, %.1e, %.1e | 1e-13\n", names[law], worst[0], worst[1], worst[2]);
    for (int i = 0; i < PATCH_STATES; i++) {
      const PatchReference *r = &patch_reference[law][i];
      double                H[9], P[9], FS[9];
      Gradient(r->F, H);
      assert_close(Energy(law, reference_fibre, H), r->W, 1e-13, r->W + 1e5);
      Stress(law, reference_fibre, H, P);
      for (int k = 0; k < 9; k++) assert_close(P[k], r->P[k], 1e-13, 1e6);
      Multiply(r->F, r->S, FS);
      for (int k = 0; k < 9 && r->S[0] != 0.0; k++) assert_close(P[k], FS[k], 1e-13, 1e6);
    }
  }
}

/* the lateral stretch of the reference is a root, found to 1e-15: its error times the stiffness is left in the free faces' stress */
static void Stretches_AreTheReference(void **state)
{
  (void)state;
  for (int law = 0; law < TLED_LAW_TRANSVERSE; law++) {
    for (int i = 0; i < 7; i++) {
      const StretchReference *r    = &stretch_reference[law][i];
      const double            H[9] = {r->stretch - 1.0, 0, 0, 0, r->lateral - 1.0, 0, 0, 0, r->lateral - 1.0};
      double                  P[9];
      assert_close(Energy(law, reference_fibre, H), r->W, 1e-13, r->W + 1e5);
      Stress(law, reference_fibre, H, P);
      for (int k = 0; k < 9; k++)
        assert_close(P[k], k == 0 || (k % 4 == 0 && r->lateral == r->stretch) ? r->P11 : 0.0, 1e-12, 1e6);
    }
  }
}

/* stress = dW/dF and differential = dP/dF, by central differences: truncation 1e-10, round-off 1e-10 of the largest term */
static void StressAndTangent_AreDerivatives(void **state)
{
  const double eps = 1e-5, *a = reference_fibre;

  (void)state;
  for (int law = 0; law < TLED_LAWS; law++) {
    for (int i = 0; i < PATCH_STATES; i++) {
      double H[9], P[9], A[81];
      Gradient(patch_reference[law][i].F, H);
      Stress(law, a, H, P);
      for (int k = 0; k < 9; k++) {
        double up[9], down[9], P_up[9], P_down[9], dF[9] = {0};
        for (int j = 0; j < 9; j++) up[j] = H[j] + (j == k) * eps, down[j] = H[j] - (j == k) * eps;
        dF[k] = 1.0;
        assert_close((Energy(law, a, up) - Energy(law, a, down)) / (2 * eps), P[k], 1e-9, 1e6);
        Stress(law, a, up, P_up);
        Stress(law, a, down, P_down);
        TLEDStressDifferential(ReferenceLaw(law), a, H, dF, &A[9 * k]);
        for (int j = 0; j < 9; j++) assert_close((P_up[j] - P_down[j]) / (2 * eps), A[9 * k + j], 1e-8, 1e7);
      }
      for (int k = 0; k < 81; k++) assert_close(A[k], A[9 * (k % 9) + k / 9], 1e-13, 1e7); /* it has an energy */
    }
  }
}

/* a rotation Q after, and (with the fibres turned) before: energy unchanged, P turns with the body, F P^T stays symmetric (no moment);
   a rotation alone gives no stress */
static void Laws_AreObjective(void **state)
{
  const double c = cos(0.7), s = sin(0.7), Q[9] = {c, -s * 0.6, s * 0.8, s, c * 0.6, -c * 0.8, 0, 0.8, 0.6};

  (void)state;
  for (int law = 0; law < TLED_LAWS; law++) {
    for (int i = 0; i < PATCH_STATES; i++) {
      const PatchReference *r   = &patch_reference[law][i];
      double                Qt[9], F[9], QP[9], H[9], P[9], M[9], a[3];
      for (int k = 0; k < 9; k++) Qt[k] = Q[3 * (k % 3) + k / 3];
      Multiply(Q, r->F, F);
      Multiply(Q, r->P, QP);
      Gradient(F, H);
      assert_close(Energy(law, reference_fibre, H), r->W, 1e-12, 1e5);
      Stress(law, reference_fibre, H, P);
      for (int k = 0; k < 9; k++) assert_close(P[k], QP[k], 1e-12, 1e6);
      for (int k = 0; k < 9; k++) M[k] = Dot3(&F[3 * (k / 3)], &P[3 * (k % 3)]);
      assert_close(M[1], M[3], 1e-12, 1e6);
      assert_close(M[2], M[6], 1e-12, 1e6);
      assert_close(M[5], M[7], 1e-12, 1e6);
      Multiply(r->F, Qt, F);
      Multiply(r->P, Qt, QP);
      Mul3(Q, reference_fibre, a);
      Gradient(F, H);
      assert_close(Energy(law, a, H), r->W, 1e-12, 1e5);
      Stress(law, a, H, P);
      for (int k = 0; k < 9; k++) assert_close(P[k], QP[k], 1e-12, 1e6);
      Gradient(Q, H);
      Stress(law, reference_fibre, H, P);
      for (int k = 0; k < 9; k++) assert_close(P[k], 0.0, 1e-14, 1e7);
    }
  }
}

/* At strains of 1e-9 energy and stress are those of linear elasticity, to the strain itself and the round-off that the law leaves: the laws
   in tau have all digits, the others those of stress over modulus, 1e-16/1e-9. */
static void SmallStrains_KeepTheirDigits(void **state)
{
  const double e[9] = {1, 0.3, -0.2, 0.5, -0.7, 0.4, 0.1, -0.6, 0.8}, lambda = reference_lambda, mu = reference_mu, small = 1e-9;

  (void)state;
  for (int law = 0; law < TLED_LAW_TRANSVERSE; law++) {
    double       H[9], P[9], W = 0.0;
    const double trace = e[0] + e[4] + e[8], loss = law == TLED_LAW_NEO_HOOKEAN ? 4e-7 : 1e-8;
    for (int k = 0; k < 9; k++) H[k] = small * e[k];
    Stress(law, reference_fibre, H, P);
    for (int k = 0; k < 9; k++) {
      const double sym = 0.5 * (e[k] + e[3 * (k % 3) + k / 3]), sigma = 2.0 * mu * sym + (k % 4 ? 0.0 : lambda * trace);
      assert_close(P[k], small * sigma, loss, small * 1e6);
      W += 0.5 * sigma * sym;
    }
    assert_close(Energy(law, reference_fibre, H), small * small * W, 1e-8, small * small * W);
  }
}

/* J - 1, ln J, their remainders and the cube root keep their digits near 1, where solids are */
static void Measures_KeepTheirDigits(void **state)
{
  (void)state;
  for (double e = 1e-12; e < 0.3; e *= 3.7) {
    const double H[9] = {e, 0, 0, 0, e, 0, 0, 0, e};
    assert_close(TLEDJacobianMinusOne(H), 3 * e + 3 * e * e + e * e * e, 4e-16, 3 * e);
    assert_close(TLEDMinors(H), 3 * e * e + e * e * e, 4e-16, 3 * e * e);
    assert_close(TLEDLogJacobian(e), log1p(e), 6e-16, e);
    assert_close(TLEDLogJacobian(-e), log1p(-e), 6e-16, e);
    assert_close(TLEDFirstInvariant(H), 0.0, 1e-15, 10 * e * e); /* no change of shape */
    assert_close(TLEDSecondInvariant(H), 0.0, 2e-15, 10 * e * e);
  }
  for (double x = -0.9; x < 3.0; x += 0.037) assert_close(TLEDLogRemainder(x), x - log1p(x), 4e-16, fabs(x));
  assert_close(TLEDLogRemainder(1e-6), 0.5e-12 - 1e-18 / 3.0, 1e-12, 0.5e-12);
  assert_close(TLEDLogJacobian(3.0), log(4.0), 1e-15, 1.0);
  assert_true(isnan(TLEDLogJacobian(-1.5)));
  for (double x = 0.01; x < 100.0; x *= 1.3) assert_close(TLEDCubeRoot(x), cbrt(x), 1e-15, cbrt(x));
}

/* the stiffness is the derivative of the nodal forces, symmetric, and blind to a rigid shift */
static void Stiffness_IsTheDerivativeOfForces(void **state)
{
  const double X[12] = {0.1, 0, 0, 1.2, 0.1, -0.1, 0.2, 0.9, 0.1, 0, 0.2, 1.1};

  (void)state;
  for (int law = 0; law < TLED_LAWS; law++) {
    double       G[9], G4[12], H[9], K[144] = {0.0};
    const double V0 = TLEDReferenceGradients(X, G);
    assert_true(V0 > 0.0);
    Gradient(patch_reference[law][1].F, H);
    for (int k = 0; k < 9; k++) G4[3 + k] = G[k];
    for (int k = 0; k < 3; k++) G4[k] = -(G[k] + G[3 + k] + G[6 + k]);
    TLEDElementStiffness(LocalLaw(ReferenceLaw(law)), H, G4, 4, V0, K);
    for (int b = 0; b < 12; b++) {
      double dF[9], dP[9], f[9], sum = 0.0;
      for (int k = 0; k < 9; k++) dF[k] = k / 3 == b % 3 ? G4[3 * (b / 3) + k % 3] : 0.0;
      TLEDStressDifferential(ReferenceLaw(law), reference_fibre, H, dF, dP);
      TLEDNodalForces(dP, G, V0, f);
      for (int r = 3; r < 12; r++) assert_close(K[12 * r + b], f[r - 3], 1e-13, 1e7);
      for (int r = 0; r < 12; r++) {
        assert_close(K[12 * r + b], K[12 * b + r], 1e-13, 1e7);
        sum += r % 3 == 0 ? K[12 * r + b] : 0.0;
      }
      assert_close(sum, 0.0, 1e-13, 1e7);
    }
  }
}

/* A nearly incompressible law without its excess bulk stiffness has that of Poisson's ratio 1/3: at F = I the softened stiffness is the
   stiffness of a law with lambda = 2 mu. */
static void Softened_IsPoissonOfAThird(void **state)
{
  const double H[9] = {0.0}, G[12] = {-1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1};

  (void)state;
  for (int law = 0; law < TLED_LAW_TRANSVERSE; law++) {
    TLEDLaw m = *ReferenceLaw(law), third = m;
    double  K[144] = {0.0}, expected[144] = {0.0};
    if (law < TLED_LAW_NEO_HOOKEAN_ISO) m.lambda = 400.0 * m.mu, third.lambda = 2.0 * m.mu;
    else m.kappa = 400.0 * m.mu + (2.0 / 3) * m.mu, third.kappa = (8.0 / 3) * m.mu;
    assert_close(TLEDPoisson(&m), 200.0 / 401.0, 1e-15, 1.0);
    assert_close(TLEDPoisson(&third), 1.0 / 3.0, 1e-15, 1.0);
    TLEDElementStiffness(LocalLaw(&m), H, G, 4, 1.0, K);
    TLEDElementSoften(&m, H, G, 4, 1.0, K);
    TLEDElementStiffness(LocalLaw(&third), H, G, 4, 1.0, expected);
    for (int k = 0; k < 144; k++) assert_close(K[k], expected[k], 1e-15, 1e3 * m.mu);
  }
}

CHECK_MAIN(cmocka_unit_test(EnergyAndStress_AreTheReference), cmocka_unit_test(Stretches_AreTheReference),
           cmocka_unit_test(StressAndTangent_AreDerivatives), cmocka_unit_test(Laws_AreObjective),
           cmocka_unit_test(SmallStrains_KeepTheirDigits), cmocka_unit_test(Measures_KeepTheirDigits),
           cmocka_unit_test(Stiffness_IsTheDerivativeOfForces), cmocka_unit_test(Softened_IsPoissonOfAThird))
