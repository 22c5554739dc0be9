/* sph_field.h - velocity fields at the start, each free of divergence. Coordinates a, b [m] are those across the field's axis, counted from
   its centre; the axes (axis, a, b) are a cyclic turn of (x, y, z): for z, a is x and b is y. */
#ifndef BY_SPH_FIELD_H
#define BY_SPH_FIELD_H

#include "body.h"

/* rows of vortices that turn against each other: u = U sin(ka) cos(kb), v = -U cos(ka) sin(kb), k = 2 pi/wavelength. With viscosity nu and
   no wall in the way it keeps its shape and decays as exp(-2 nu k^2 t)  [Taylor & Green 1937] */
BY_HD void SPHFieldTaylorGreen(double U, double wavelength, double a, double b, double uv[2])
{
  const double k = 2.0 * BY_PI / wavelength;

  uv[0] = U * sin(k * a) * cos(k * b);
  uv[1] = -U * cos(k * a) * sin(k * b);
}

/* rigid rotation about the axis: u = -rate b, v = rate a; vorticity 2 rate */
BY_HD void SPHFieldRotation(double rate, double a, double b, double uv[2])
{
  uv[0] = -rate * b;
  uv[1] = rate * a;
}

/* simple shear: u = rate b; vorticity -rate */
BY_HD void SPHFieldShear(double rate, double a, double b, double uv[2])
{
  (void)a;
  uv[0] = rate * b;
  uv[1] = 0.0;
}

/* plane strain: u = rate a, v = -rate b: stretches along a as much as it shrinks along b; no vorticity */
BY_HD void SPHFieldStrain(double rate, double a, double b, double uv[2])
{
  uv[0] = rate * a;
  uv[1] = -rate * b;
}

#endif
