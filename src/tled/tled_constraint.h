/* tled_constraint.h - how supports move and what they ask of a node, for host and device.

   A support moves as x = p + R(g theta) (X - p) + g t: by the translation t and the angle theta about an axis through p, both times the
   course g(t). A node has up to three conditions n_j . u = n_j . u_j(X, t), one for each direction n_j in which it is held. With the dual
   vectors w_j of the n_j (w_i . n_j = 1 for i = j, else 0, within their span) the held part of its displacement is

     Q u = sum_j w_j (n_j . u_j),   Q = sum_j w_j n_j^T,   P = I - Q the projector onto its free directions. */
#ifndef BY_TLED_CONSTRAINT_H
#define BY_TLED_CONSTRAINT_H

#include "motion.h"

/* The conditions on one node. */
typedef struct {
  int    n;          /* 1, 2 or 3                                                    */
  int    motion[3];  /* whose motion each condition follows; -1: at rest             */
  double normal[9];  /* n_j in rows, unit vectors                                    */
  double dual[9];    /* w_j in rows                                                  */
  double P[9];       /* projector onto the free directions                           */
} TLEDHeld;

/* held part of a node's displacement, velocity or acceleration: sum_j w_j (n_j . u_j) */
BY_HD void TLEDHeldPart(const TLEDHeld *h, const RigidMotion motions[], const double X[3], int what, double value[3])
{
  double u[3] = {0.0, 0.0, 0.0};

  value[0] = value[1] = value[2] = 0.0;
  for (int j = 0; j < h->n; j++) {
    if (h->motion[j] < 0) continue;
    if (j == 0 || h->motion[j] != h->motion[j - 1]) RigidMotionOf(&motions[h->motion[j]], X, what, u);
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
