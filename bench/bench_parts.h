/* bench_parts.h - bodies whose part of a kernel is known: phi(x) = int_body W(|x - y|, 1) dy and its gradient, over rays from x. Lengths are
   those of the kernel's support, h = 1. */
#ifndef BY_BENCH_PARTS_H
#define BY_BENCH_PARTS_H

#include "mat3.h"
#include "sph/sph_kernel.h"
#include <math.h>

enum { PART_PLANE, PART_BALL, PART_CYLINDER, PART_BOX, PART_ELLIPSOID, PART_WAVES, N_PARTS };

#define PART_CROSSINGS 8  /* most crossings of a ray with a surface within h */
#define PART_TABLE     4000
#define PART_POLAR     80 /* directions: Gauss points in the cosine, twice as many around */

/* half axes of ball, ellipsoid, box; of the cylinder radius, radius, half length; of waves amplitude, amplitude, length */
typedef struct {
  int    kind;
  double size[3];
} PartBody;

typedef struct {
  double mass[PART_TABLE + 1], slope[PART_TABLE + 1]; /* int_0^r W s^2 ds, int_0^r W' s^2 ds */
  double direction[2*PART_POLAR*PART_POLAR][3], weight[2*PART_POLAR*PART_POLAR];
} PartRule;

static inline double PartWave(const PartBody *b, double x, double y)
{
  const double k = 2.0*BY_PI/b->size[2];
  return b->size[0]*sin(k*x)*sin(k*y);
}

static inline int PartInside(const PartBody *b, const double x[3])
{
  const double *s = b->size;

  if (b->kind == PART_PLANE) return x[2] < 0.0;
  if (b->kind == PART_WAVES) return x[2] < PartWave(b, x[0], x[1]);
  if (b->kind == PART_BOX) return fabs(x[0]) < s[0] && fabs(x[1]) < s[1] && fabs(x[2]) < s[2];
  const double round = x[0]*x[0]/(s[0]*s[0]) + x[1]*x[1]/(s[1]*s[1]);
  if (b->kind == PART_CYLINDER) return round < 1.0 && fabs(x[2]) < s[2];
  return round + x[2]*x[2]/(s[2]*s[2]) < 1.0;
}

/* [lo, hi] with |x_k + t w_k| < half */
static inline void PartSlab(double x, double w, double half, double *lo, double *hi)
{
  if (fabs(w) < 1e-14) {
    if (fabs(x) >= half) *hi = *lo - 1.0;
    return;
  }
  const double a = (-half - x)/w, b = (half - x)/w;
  *lo = fmax(*lo, fmin(a, b));
  *hi = fmin(*hi, fmax(a, b));
}

/* [lo, hi] with sum over the first `axes` coordinates of ((x + t w)/s)^2 < 1 */
static inline void PartRound(int axes, const double x[3], const double w[3], const double s[3], double *lo, double *hi)
{
  double a = 0.0, b = 0.0, c = -1.0;

  for (int k = 0; k < axes; k++) {
    a += w[k]*w[k]/(s[k]*s[k]);
    b += x[k]*w[k]/(s[k]*s[k]);
    c += x[k]*x[k]/(s[k]*s[k]);
  }
  const double d = b*b - a*c;
  if (a < 1e-14) {
    if (c >= 0.0) *hi = *lo - 1.0;
    return;
  }
  if (d <= 0.0) {
    *hi = *lo - 1.0;
    return;
  }
  *lo = fmax(*lo, (-b - sqrt(d))/a);
  *hi = fmin(*hi, (-b + sqrt(d))/a);
}

/* where the ray x + t w, 0 < t < 1, crosses the waves: steps of 1/12, then the secant between signs */
static inline int PartWaveCrossings(const PartBody *b, const double x[3], const double w[3], double t[])
{
  int    n = 0, inside = 0;
  double f0 = x[2] - PartWave(b, x[0], x[1]), t0 = 0.0;

  for (int i = 1; i <= 12 && n < PART_CROSSINGS - 1; i++) {
    double t1 = i/12.0, f1 = x[2] + t1*w[2] - PartWave(b, x[0] + t1*w[0], x[1] + t1*w[1]);
    if ((f0 > 0.0) != (f1 > 0.0)) {
      double lo = t0, hi = t1, flo = f0, fhi = f1;
      for (int pass = 0; pass < 4; pass++) {
        const double tm = lo - flo*(hi - lo)/(fhi - flo), fm = x[2] + tm*w[2] - PartWave(b, x[0] + tm*w[0], x[1] + tm*w[1]);
        if ((fm > 0.0) == (flo > 0.0)) lo = tm, flo = fm;
        else hi = tm, fhi = fm;
      }
      t[n++] = lo - flo*(hi - lo)/(fhi - flo);
      inside = !inside;
    }
    f0 = f1, t0 = t1;
  }
  if (inside) t[n++] = 1.0;
  return n;
}

/* pairs of entry and exit along a ray from outside, within t < 1; their number of ends */
static inline int PartCrossings(const PartBody *b, const double x[3], const double w[3], double t[])
{
  double lo = 0.0, hi = 1.0;

  if (b->kind == PART_WAVES) return PartWaveCrossings(b, x, w, t);
  if (b->kind == PART_PLANE) {
    if (w[2] >= 0.0) return 0;
    lo = -x[2]/w[2];
  } else if (b->kind == PART_BOX) {
    for (int k = 0; k < 3; k++) PartSlab(x[k], w[k], b->size[k], &lo, &hi);
  } else {
    PartRound(b->kind == PART_CYLINDER ? 2 : 3, x, w, b->size, &lo, &hi);
    if (b->kind == PART_CYLINDER) PartSlab(x[2], w[2], b->size[2], &lo, &hi);
  }
  if (!(hi > lo)) return 0;
  t[0] = lo, t[1] = hi;
  return 2;
}

/* Gauss-Legendre points and weights on [-1, 1] by Newton's method */
static inline void PartGauss(int n, double x[], double w[])
{
  for (int i = 0; i < n; i++) {
    double z = cos(BY_PI*(i + 0.75)/(n + 0.5)), slope = 1.0;
    for (int pass = 0; pass < 20; pass++) {
      double p = 1.0, q = 0.0;
      for (int k = 0; k < n; k++) {
        const double r = q;
        q = p;
        p = ((2.0*k + 1.0)*z*q - k*r)/(k + 1.0);
      }
      slope = n*(z*p - q)/(z*z - 1.0);
      z -= p/slope;
    }
    x[i] = z;
    w[i] = 2.0/((1.0 - z*z)*slope*slope);
  }
}

static inline void PartRuleCreate(int kernel, PartRule *rule)
{
  double z[PART_POLAR], w[PART_POLAR];

  rule->mass[0] = rule->slope[0] = 0.0;
  for (int i = 0; i < PART_TABLE; i++) {
    // Simpson's rule on each interval
    double mass = 0.0, slope = 0.0;
    for (int k = 0; k < 3; k++) {
      const double r = (i + 0.5*k)/PART_TABLE, part = (k == 1 ? 4.0 : 1.0)/(6.0*PART_TABLE);
      mass += part*SPHKernelW(kernel, r, 1.0)*r*r;
      slope += part*SPHKernelF(kernel, r, 1.0)*r*r*r;
    }
    rule->mass[i + 1]  = rule->mass[i] + mass;
    rule->slope[i + 1] = rule->slope[i] + slope;
  }
  PartGauss(PART_POLAR, z, w);
  for (int i = 0; i < PART_POLAR; i++) {
    for (int j = 0; j < 2*PART_POLAR; j++) {
      const double s = sqrt(1.0 - z[i]*z[i]), angle = BY_PI*(j + 0.5)/PART_POLAR;
      double      *d = rule->direction[2*PART_POLAR*i + j];
      d[0] = s*cos(angle), d[1] = s*sin(angle), d[2] = z[i];
      rule->weight[2*PART_POLAR*i + j] = w[i]*BY_PI/PART_POLAR;
    }
  }
}

static inline double PartLook(const double table[], double r)
{
  const double at = r*PART_TABLE;
  const int    i = at >= PART_TABLE ? PART_TABLE - 1 : (int)at;
  return table[i] + (at - i)*(table[i + 1] - table[i]);
}

/* phi and its gradient at a point outside the body; W_x = -W' w along a ray */
static inline double PartPhi(const PartRule *rule, const PartBody *b, const double x[3], double grad[3])
{
  double phi = 0.0;

  for (int k = 0; k < 3; k++) grad[k] = 0.0;
  for (int i = 0; i < 2*PART_POLAR*PART_POLAR; i++) {
    double       t[PART_CROSSINGS], mass = 0.0, slope = 0.0;
    const double *w = rule->direction[i];
    const int    n = PartCrossings(b, x, w, t);
    for (int k = 0; k < n; k += 2) {
      mass += PartLook(rule->mass, t[k + 1]) - PartLook(rule->mass, t[k]);
      slope += PartLook(rule->slope, t[k + 1]) - PartLook(rule->slope, t[k]);
    }
    phi += rule->weight[i]*mass;
    for (int k = 0; k < 3; k++) grad[k] -= rule->weight[i]*slope*w[k];
  }
  return phi;
}

#endif
