/* tled_constraint.h - how supports move and what they ask of a node, for host and device.

   A support moves as x = p + R(g theta) (X - p) + g t: by the translation t and the angle theta about an axis through p, both times the
   course g(t). A node has up to three conditions n_j . u = n_j . u_j(X, t), one for each direction n_j in which it is held. With the dual
   vectors w_j of the n_j (w_i . n_j = 1 for i = j, else 0, within their span) the held part of its displacement is

     Q u = sum_j w_j (n_j . u_j),   Q = sum_j w_j n_j^T,   P = I - Q the projector onto its free directions. */
#ifndef BY_TLED_CONSTRAINT_H
#define BY_TLED_CONSTRAINT_H

#include "mat3.h"

/* A moving support at one instant. */
typedef struct {
  double point[3], axis[3];            /* [m]; unit vector                                      */
  double turn[9];                      /* R - I                                                 */
  double spin, spin_rate;              /* rate of the angle [rad/s], and of that [rad/s^2]      */
  double shift[3], speed[3], kick[3];  /* g t and its derivatives [m], [m/s], [m/s^2]           */
} TLEDMotion;

/* The conditions on one node. */
typedef struct {
  int    n;          /* 1, 2 or 3                                                    */
  int    motion[3];  /* whose motion each condition follows; -1: at rest             */
  double normal[9];  /* n_j in rows, unit vectors                                    */
  double dual[9];    /* w_j in rows                                                  */
  double P[9];       /* projector onto the free directions                           */
} TLEDHeld;

enum { TLED_MOTION_DISPLACEMENT = 0, TLED_MOTION_VELOCITY = 1, TLED_MOTION_ACCELERATION = 2 };

/* the motion at an instant with g[] = g, dg/dt, d2g/dt2: R - I = sin(a) K + 2 sin^2(a/2) K^2, K x = axis x x, a = g angle [Rodrigues 1840] */
BY_HD void TLEDMotionAt(const double g[3], const double translation[3], double angle, const double axis[3], const double point[3], TLEDMotion *m)
{
  const double a = g[0]*angle, s = sin(a), h = sin(0.5*a), c = 2.0*h*h;
  const double x = axis[0], y = axis[1], z = axis[2];

  m->turn[0] = -c*(y*y + z*z); m->turn[1] = c*x*y - s*z;    m->turn[2] = c*x*z + s*y;
  m->turn[3] = c*x*y + s*z;    m->turn[4] = -c*(x*x + z*z); m->turn[5] = c*y*z - s*x;
  m->turn[6] = c*x*z - s*y;    m->turn[7] = c*y*z + s*x;    m->turn[8] = -c*(x*x + y*y);
  m->spin      = g[1]*angle;
  m->spin_rate = g[2]*angle;
  for (int k = 0; k < 3; k++) {
    m->point[k] = point[k];
    m->axis[k]  = axis[k];
    m->shift[k] = g[0]*translation[k];
    m->speed[k] = g[1]*translation[k];
    m->kick[k]  = g[2]*translation[k];
  }
}

/* displacement (R - I) r + g t, velocity w x Rr + g't or acceleration w' x Rr + w x (w x Rr) + g''t of the material point X, r = X - p */
BY_HD void TLEDMotionOf(const TLEDMotion *m, const double X[3], int what, double value[3])
{
  double r[3], turned[3], across[3], inward[3];

  Sub3(X, m->point, r);
  Mul3(m->turn, r, turned);
  if (what == TLED_MOTION_DISPLACEMENT) {
    for (int k = 0; k < 3; k++) value[k] = turned[k] + m->shift[k];
    return;
  }
  for (int k = 0; k < 3; k++) r[k] += turned[k];
  Cross3(m->axis, r, across);
  Cross3(m->axis, across, inward);
  for (int k = 0; k < 3; k++)
    value[k] = what == TLED_MOTION_VELOCITY ? m->spin*across[k] + m->speed[k]
                                            : m->spin_rate*across[k] + m->spin*m->spin*inward[k] + m->kick[k];
}

/* held part of a node's displacement, velocity or acceleration: sum_j w_j (n_j . u_j) */
BY_HD void TLEDHeldPart(const TLEDHeld *h, const TLEDMotion motions[], const double X[3], int what, double value[3])
{
  double u[3] = {0.0, 0.0, 0.0};

  value[0] = value[1] = value[2] = 0.0;
  for (int j = 0; j < h->n; j++) {
    if (h->motion[j] < 0) continue;
    if (j == 0 || h->motion[j] != h->motion[j - 1]) TLEDMotionOf(&motions[h->motion[j]], X, what, u);
    const double s = Dot3(&h->normal[3*j], u);
    for (int k = 0; k < 3; k++) value[k] += s*h->dual[3*j + k];
  }
}

/* Make the dual vectors and the projector from the unit vectors n_j: the rows of (N N^T)^-1 N. */
BY_HD void TLEDHeldClose(TLEDHeld *h)
{
  double gram[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, inverse[9];

  for (int i = 0; i < h->n; i++)
    for (int j = 0; j < h->n; j++) gram[3*i + j] = Dot3(&h->normal[3*i], &h->normal[3*j]);
  (void)Invert3(gram, inverse);
  for (int i = 0; i < h->n; i++)
    for (int k = 0; k < 3; k++) {
      h->dual[3*i + k] = 0.0;
      for (int j = 0; j < h->n; j++) h->dual[3*i + k] += inverse[3*i + j]*h->normal[3*j + k];
    }
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      h->P[3*i + k] = h->n < 3 && i == k ? 1.0 : 0.0;
      for (int j = 0; j < h->n && h->n < 3; j++) h->P[3*i + k] -= h->dual[3*j + i]*h->normal[3*j + k];
    }
}

#endif
