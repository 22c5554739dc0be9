/* peak.h - the peak of a record as the independent code found its own. */
#ifndef BY_TEST_PEAK_H
#define BY_TEST_PEAK_H

#include <math.h>

/* maximum of the cubic a + b t + c t^2 + d t^3 fitted to samples by least squares (normal equations, t centred and scaled) */
static inline void FitPeak(int n, const double t[], const double y[], double *t_peak, double *y_peak)
{
  double A[4][5] = {{0}}, c[4], middle = 0.5 * (t[0] + t[n - 1]), half = 0.5 * (t[n - 1] - t[0]), s;

  for (int k = 0; k < n; k++) {
    const double q[4] = {1, (t[k] - middle) / half, pow((t[k] - middle) / half, 2), pow((t[k] - middle) / half, 3)};
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 4; j++) A[i][j] += q[i] * q[j];
      A[i][4] += q[i] * y[k];
    }
  }
  for (int i = 0; i < 4; i++)
    for (int r = i + 1; r < 4; r++)
      for (int j = 4; j >= i; j--) A[r][j] -= A[i][j] * A[r][i] / A[i][i];
  for (int i = 3; i >= 0; i--) {
    c[i] = A[i][4];
    for (int j = i + 1; j < 4; j++) c[i] -= A[i][j] * c[j];
    c[i] /= A[i][i];
  }
  s = (-2 * c[2] - sqrt(4 * c[2] * c[2] - 12 * c[3] * c[1])) /
      (6 * c[3]); /* the root where the cubic is concave is found from both */
  if (!(2 * c[2] + 6 * c[3] * s < 0)) s = (-2 * c[2] + sqrt(4 * c[2] * c[2] - 12 * c[3] * c[1])) / (6 * c[3]);
  *t_peak = middle + half * s;
  *y_peak = c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

#endif
