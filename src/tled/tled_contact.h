/* tled_contact.h - penalty contact of a node with a surface at rest, for host and device.

   A node that stands for the area A of the body's undeformed surface and lies d beyond the obstacle's surface is pressed back with
   A p(d), along the gradient n of the distance to it:

     p = 0 (d < 0),   k d^2/(2 delta) (d < delta),   k (d - delta/2) (d >= delta)   [Pa]

   Force and stiffness are continuous where the node touches; the stored energy A W(d), W' = p, is counted with the body's. */
#ifndef BY_TLED_CONTACT_H
#define BY_TLED_CONTACT_H

#include "mat3.h"

/* pressure [Pa] at depth d [m]; slope dp/dd [Pa/m] and energy W [J/m^2] with it. stiffness k [Pa/m], soft delta [m] */
BY_HD double TLEDContactPressure(double d, double stiffness, double soft, double *slope, double *energy)
{
  *slope = *energy = 0.0;
  if (!(d > 0.0)) return 0.0;
  if (d < soft) {
    *slope  = stiffness*d / soft;
    *energy = stiffness*d*d*d / (6.0*soft);
    return 0.5*stiffness*d*d / soft;
  }
  *slope  = stiffness;
  *energy = stiffness*(0.5*d*d - 0.5*soft*d + soft*soft / 6.0);
  return stiffness*(d - 0.5*soft);
}

/* Stiffness -df/dx of f = A p n added to K: A (p' n n^T + p (I - n n^T - e e^T)/d); the second part where the nearest place is an edge
   (along e, a unit vector) or a vertex (e = 0), round which n turns as the node moves; kind 2, a face: none. */
BY_HD void TLEDContactStiffness(double area, double p, double slope, double d, const double n[3], int kind, const double e[3], double K[9])
{
  const double turn = kind == 2 || !(d > 0.0) ? 0.0 : area*p / d;

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      K[3*i + j] += area*slope*n[i]*n[j] + turn*((i == j ? 1.0 : 0.0) - n[i]*n[j] - e[i]*e[j]);
}

/* critical step [s] with contact: omega^2 <= omega_K^2 + rate, rate the largest stiffness over mass of a node's contact [1/s^2] */
BY_HD double TLEDContactStep(double critical, double rate)
{
  return critical / sqrt(1.0 + 0.25*rate*critical*critical);
}

#endif
