/* mat3.h - 3-vectors and row-major 3x3 matrices, for host and device. */
#ifndef BY_MAT3_H
#define BY_MAT3_H

#include "body.h"

BY_HD double Dot3(const double a[3], const double b[3]) { return a[0]*b[0] + a[1]*b[1] + a[2]*b[2]; }
BY_HD double Norm3(const double a[3]) { return sqrt(Dot3(a, a)); }

/* c = a x b */
BY_HD void Cross3(const double a[3], const double b[3], double c[3])
{
  c[0] = a[1]*b[2] - a[2]*b[1];
  c[1] = a[2]*b[0] - a[0]*b[2];
  c[2] = a[0]*b[1] - a[1]*b[0];
}

/* c = a - b */
BY_HD void Sub3(const double a[3], const double b[3], double c[3])
{
  for (int k = 0; k < 3; k++) c[k] = a[k] - b[k];
}

/* determinant of a row-major 3x3 matrix */
BY_HD double Det3(const double A[9])
{
  return A[0]*(A[4]*A[8] - A[5]*A[7]) - A[1]*(A[3]*A[8] - A[5]*A[6]) + A[2]*(A[3]*A[7] - A[4]*A[6]);
}

/* B = A^-1, returns det A; B is not written when det A is 0 */
BY_HD double Invert3(const double A[9], double B[9])
{
  const double det = Det3(A), r = 1.0 / det;

  if (det == 0.0) return 0.0;
  B[0] = r*(A[4]*A[8] - A[5]*A[7]); B[1] = r*(A[2]*A[7] - A[1]*A[8]); B[2] = r*(A[1]*A[5] - A[2]*A[4]);
  B[3] = r*(A[5]*A[6] - A[3]*A[8]); B[4] = r*(A[0]*A[8] - A[2]*A[6]); B[5] = r*(A[2]*A[3] - A[0]*A[5]);
  B[6] = r*(A[3]*A[7] - A[4]*A[6]); B[7] = r*(A[1]*A[6] - A[0]*A[7]); B[8] = r*(A[0]*A[4] - A[1]*A[3]);
  return det;
}

/* smallest eigenvalue of the symmetric matrix A = xx xy xz yy yz zz, by the cosine formula of the cubic [Smith 1961] */
BY_HD double LeastEigenvalue3(const double A[6])
{
  const double mean = (A[0] + A[3] + A[5]) / 3.0, a = A[0] - mean, b = A[3] - mean, c = A[5] - mean;
  const double off = A[1]*A[1] + A[2]*A[2] + A[4]*A[4], size = sqrt((a*a + b*b + c*c + 2.0*off) / 6.0);
  const double det = a*(b*c - A[4]*A[4]) - A[1]*(A[1]*c - A[4]*A[2]) + A[2]*(A[1]*A[4] - b*A[2]);
  double       r;

  if (size <= 0.0) return mean;
  r = det / (2.0*size*size*size);
  r = r < -1.0 ? -1.0 : r > 1.0 ? 1.0 : r;
  return mean + 2.0*size*cos(acos(r)/3.0 + 2.0943951023931953); // 2 pi/3 further: the least of the three
}

/* y = A x */
BY_HD void Mul3(const double A[9], const double x[3], double y[3])
{
  for (int i = 0; i < 3; i++) y[i] = A[3*i]*x[0] + A[3*i + 1]*x[1] + A[3*i + 2]*x[2];
}

#endif
