/* The ten-node tetrahedron: its shape functions and quadrature against what they must integrate, differentiate and reproduce. */
#include "check.h"
#include "tled/tled_t10.h"

#define N_TRIALS 50

static const int rules[2] = {TLED_T10_POINTS, TLED_T10_POINTS_FINE};

/* reference places of the ten nodes: vertices, then the middles of the edges 01, 12, 02, 03, 13, 23 */
static const double node_xi[10][3] = {{0, 0, 0},     {1, 0, 0},   {0, 1, 0},   {0, 0, 1},     {0.5, 0, 0},
                                      {0.5, 0.5, 0}, {0, 0.5, 0}, {0, 0, 0.5}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};

static double Uniform(unsigned *seed, double low, double high)
{
  *seed = 1664525u * *seed + 1013904223u;
  return low + (high - low) * (double)(*seed >> 8) / 16777216.0;
}

/* a point inside, as barycentric coordinates */
static void RandomPoint(unsigned *seed, double L[4])
{
  double sum = 0.0;

  for (int k = 0; k < 4; k++) sum += L[k] = Uniform(seed, 0.01, 1.0);
  for (int k = 0; k < 4; k++) L[k] /= sum;
}

/* an element of about unit size, turned and sheared; `curved` moves the nodes of its edges by that much */
static void RandomElement(unsigned *seed, double curved, double X[30])
{
  double A[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

  for (int k = 0; k < 9; k++) A[k] += Uniform(seed, -0.3, 0.3);
  for (int a = 0; a < 10; a++) {
    Mul3(A, node_xi[a], &X[3 * a]);
    for (int k = 0; k < 3; k++) X[3 * a + k] += 5.0 + (a > 3 ? Uniform(seed, -curved, curved) : 0.0);
  }
}

static double Factorial(int n) { return n < 2 ? 1.0 : n * Factorial(n - 1); }

/* int xi^i eta^j zeta^k = i! j! k!/(i + j + k + 3)! */
static void Rules_IntegrateTheirDegreeExactly(void **state)
{
  static const int degree[2] = {2, 5};

  (void)state;
  for (int r = 0; r < 2; r++) {
    for (int d = 0; d <= degree[r] + 1; d++) {
      double worst = 0.0;
      for (int i = 0; i <= d; i++) {
        for (int j = 0; i + j <= d; j++) {
          const int    k = d - i - j;
          const double exact = Factorial(i) * Factorial(j) * Factorial(k) / Factorial(d + 3);
          double       sum = 0.0, L[4];
          for (int q = 0; q < rules[r]; q++) {
            const double w = TLEDQuadratureT10(rules[r], q, L);
            assert_true(w > 0.0 && L[0] > 0.0 && L[1] > 0.0 && L[2] > 0.0 && L[3] > 0.0);
            assert_close(L[0] + L[1] + L[2] + L[3], 1.0, 1e-15, 1.0);
            sum += w * pow(L[1], i) * pow(L[2], j) * pow(L[3], k);
          }
          worst = fmax(worst, fabs(sum / exact - 1.0));
        }
      }
      if (d <= degree[r]) assert_close(worst, 0.0, 1e-14, 1.0); /* round-off of 14 terms */
      else assert_true(worst > 1e-4);                            /* and no more than it claims */
    }
  }
}

static void ShapeFunctions_AreOneAtTheirNodeAndAddToOne(void **state)
{
  unsigned seed = 1;
  double   N[10], L[4];

  (void)state;
  for (int b = 0; b < 10; b++) {
    for (int k = 0; k < 3; k++) L[k + 1] = node_xi[b][k];
    L[0] = 1.0 - L[1] - L[2] - L[3];
    TLEDShapeT10(L, N);
    for (int a = 0; a < 10; a++) assert_close(N[a], a == b ? 1.0 : 0.0, 1e-15, 1.0);
  }
  for (int t = 0; t < N_TRIALS; t++) {
    double sum = 0.0;
    RandomPoint(&seed, L);
    TLEDShapeT10(L, N);
    for (int a = 0; a < 10; a++) sum += N[a];
    assert_close(sum, 1.0, 1e-14, 1.0);
  }
}

/* central difference of N, step 1e-5: a quadratic is differentiated exactly, round-off 1e-16/1e-5 */
static void Slopes_AreTheDerivativesOfTheShapeFunctions(void **state)
{
  const double eps  = 1e-5;
  unsigned     seed = 2;

  (void)state;
  for (int t = 0; t < N_TRIALS; t++) {
    double L[4], plus[4], minus[4], Np[10], Nm[10], slope[3], u[10], f[10], T[3], work = 0.0;
    RandomPoint(&seed, L);
    for (int a = 0; a < 10; a++) u[a] = Uniform(&seed, -1.0, 1.0), f[a] = 0.0;
    TLEDSlopesT10(L, u, slope);
    for (int k = 0; k < 3; k++) {
      double difference = 0.0;
      for (int i = 0; i < 4; i++) plus[i] = L[i] + (i == k + 1) * eps - (i == 0) * eps, minus[i] = 2.0 * L[i] - plus[i];
      TLEDShapeT10(plus, Np);
      TLEDShapeT10(minus, Nm);
      for (int a = 0; a < 10; a++) difference += u[a] * (Np[a] - Nm[a]) / (2.0 * eps);
      assert_close(slope[k], difference, 1e-10, 4.0);
      T[k] = Uniform(&seed, -1.0, 1.0);
    }
    TLEDAddForcesT10(L, T, f); /* the transpose: f . u = T . slope */
    for (int a = 0; a < 10; a++) work += f[a] * u[a];
    assert_close(work, Dot3(T, slope), 1e-14, 10.0);
  }
}

/* the four points at once are the four one by one, and their transposes too */
static void FourPointsAtOnce_AreTheSame(void **state)
{
  unsigned seed = 6;

  (void)state;
  for (int t = 0; t < N_TRIALS; t++) {
    double u[10], T[12], slope[12], f[10], one[3], sum[10] = {0.0}, L[4];
    for (int a = 0; a < 10; a++) u[a] = Uniform(&seed, -1.0, 1.0);
    for (int k = 0; k < 12; k++) T[k] = Uniform(&seed, -1.0, 1.0);
    TLEDSlopesFourT10(u, slope);
    TLEDForcesFourT10(T, f);
    for (int q = 0; q < TLED_T10_POINTS; q++) {
      (void)TLEDQuadratureT10(TLED_T10_POINTS, q, L);
      TLEDSlopesT10(L, u, one);
      for (int k = 0; k < 3; k++) assert_close(slope[3 * q + k], one[k], 1e-14, 10.0);
      TLEDAddForcesT10(L, &T[3 * q], sum);
    }
    for (int a = 0; a < 10; a++) assert_close(f[a], sum[a], 1e-14, 10.0);
  }
}

/* u = c + A X + X . B X: H of a straight element is its gradient, at every point */
static void QuadraticField_IsReproduced(void **state)
{
  unsigned seed = 3;

  (void)state;
  for (int t = 0; t < N_TRIALS; t++) {
    double X[30], L[4], N[10], Jinv[9] = {0}, H[9], slope[9], A[9], B[27], x[3] = {0, 0, 0};
    RandomElement(&seed, 0.0, X);
    for (int k = 0; k < 9; k++) A[k] = Uniform(&seed, -1.0, 1.0);
    for (int k = 0; k < 27; k++) B[k] = Uniform(&seed, -1.0, 1.0);
    RandomPoint(&seed, L);
    TLEDShapeT10(L, N);
    for (int a = 0; a < 10; a++)
      for (int k = 0; k < 3; k++) x[k] += N[a] * X[3 * a + k];
    for (int i = 0; i < 3; i++) {
      double u[10];
      for (int a = 0; a < 10; a++) {
        u[a] = Dot3(&A[3 * i], &X[3 * a]);
        for (int j = 0; j < 3; j++) u[a] += X[3 * a + j] * Dot3(&B[9 * i + 3 * j], &X[3 * a]);
      }
      TLEDSlopesT10(L, u, &slope[3 * i]);
    }
    (void)TLEDJacobianT10(L, X, Jinv);
    TLEDPushForwardT10(slope, Jinv, H);
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) {
        double exact = A[3 * i + j];
        for (int k = 0; k < 3; k++) exact += (B[9 * i + 3 * j + k] + B[9 * i + 3 * k + j]) * x[k];
        assert_close(H[3 * i + j], exact, 1e-11, 200.0); /* values of about 200, differences over a node distance of 1/2 */
      }
    }
  }
}

/* f_a = int P dN_a/dX: T through the slopes gives what the gradients give, on a curved element too */
static void ForcesFromSlopes_AreForcesFromGradients(void **state)
{
  unsigned seed = 4;

  (void)state;
  for (int t = 0; t < N_TRIALS; t++) {
    double X[30], L[4], Jinv[9] = {0}, P[9], T[9], g[30], f[10] = {0};
    RandomElement(&seed, 0.05, X);
    RandomPoint(&seed, L);
    for (int k = 0; k < 9; k++) P[k] = Uniform(&seed, -1.0, 1.0);
    assert_true(TLEDJacobianT10(L, X, Jinv) > 0.0);
    TLEDPullBackT10(P, Jinv, 0.7, T);
    TLEDGradientsT10(L, Jinv, g);
    for (int i = 0; i < 3; i++) {
      for (int a = 0; a < 10; a++) f[a] = 0.0;
      TLEDAddForcesT10(L, &T[3 * i], f);
      for (int a = 0; a < 10; a++) assert_close(f[a], 0.7 * Dot3(&P[3 * i], &g[3 * a]), 1e-13, 10.0);
    }
  }
}

/* the total is the volume, every share is positive, vertices get 1/36 and edges 4/27 of a straight element */
static void LumpedMass_IsPositiveAndWhole(void **state)
{
  unsigned seed = 5;

  (void)state;
  for (int t = 0; t < N_TRIALS; t++) {
    double       X[30], m[10], Jinv[9], L[4], V = 0.0, sum = 0.0;
    const double curved = t % 2 ? 0.05 : 0.0;
    RandomElement(&seed, curved, X);
    for (int q = 0; q < TLED_T10_POINTS_FINE; q++) {
      const double w = TLEDQuadratureT10(TLED_T10_POINTS_FINE, q, L);
      V += w * TLEDJacobianT10(L, X, Jinv);
    }
    assert_close(TLEDLumpT10(X, m), V, 1e-14, V);
    for (int a = 0; a < 10; a++) {
      assert_true(m[a] > 0.0);
      sum += m[a];
      if (curved == 0.0) assert_close(m[a], a < 4 ? V / 36.0 : 4.0 * V / 27.0, 1e-13, V);
    }
    assert_close(sum, V, 1e-14, V);
  }
}

CHECK_MAIN(cmocka_unit_test(Rules_IntegrateTheirDegreeExactly), cmocka_unit_test(ShapeFunctions_AreOneAtTheirNodeAndAddToOne),
           cmocka_unit_test(Slopes_AreTheDerivativesOfTheShapeFunctions), cmocka_unit_test(QuadraticField_IsReproduced), cmocka_unit_test(FourPointsAtOnce_AreTheSame),
          
           cmocka_unit_test(ForcesFromSlopes_AreForcesFromGradients), cmocka_unit_test(LumpedMass_IsPositiveAndWhole))
