/* tled_step.h - one node in one time step: central differences with mass-proportional damping in velocity form, for host and device.

   With a = (f_ext - f_int)/m + g at time n, D = alpha M:
     open   v_{n+1/2} = (1 - alpha dt/2) v_n + dt/2 a_n,   u_{n+1} = u_n + dt v_{n+1/2}
     close  v_{n+1}   = (v_{n+1/2} + dt/2 a_{n+1}) / (1 + alpha dt/2)
   Eliminating v gives method 3's (M/dt^2 + D/2dt) u+ = R - f + (2M/dt^2) u - (M/dt^2 - D/2dt) u-  [Miller07, eq. 10]; v and u are at the
   same time, a constant force moves a free body exactly, and its impulse is dt f exactly. */
#ifndef BY_TLED_STEP_H
#define BY_TLED_STEP_H

#include "mat3.h"

enum { TLED_FREE = 0, TLED_FIXED = 1, TLED_HELD = 2 }; /* free; at rest; held in some direction, or moved */
/* what a step adds up: works [J] and the moment of the external forces about the origin [N m s]; and what the nodes have at the end of it:
   kinetic energy and the work of gravity since u = 0 [J], and the part of the sums that belongs to the first half of the next; and how
   many nodes are deep in an obstacle */
enum { TLED_SUM_EXTERNAL = 0, TLED_SUM_DAMPING = 1, TLED_SUM_INTERNAL = 2, TLED_SUM_MOMENT = 3, TLED_SUM_SUPPORT = 6,
       TLED_SUM_KINETIC = 7, TLED_SUM_GRAVITY = 8, TLED_SUM_OPENED = 9, TLED_SUM_DEEP = 11, TLED_SUMS = 12 };

typedef struct {
  double dt;           /* [s]                                                   */
  double alpha;        /* mass-proportional damping [1/s]                       */
  double gravity[3];   /* [m/s^2]                                               */
} TLEDStep;

/* half kick and drift of a free node; the works of the step's first half are added to sum */
BY_HD void TLEDStepOpen(const TLEDStep *s, double m, const double f_int[3], const double f_ext[3], double u[3], double v[3], double sum[])
{
  const double h = 0.5*s->dt, keep = 1.0 - s->alpha*h;

  for (int k = 0; k < 3; k++) {
    const double a = (f_ext[k] - f_int[k]) / m + s->gravity[k];
    double       du;
    sum[TLED_SUM_DAMPING] += s->alpha*m*v[k]*v[k]*h;
    v[k] = keep*v[k] + h*a;
    du   = s->dt*v[k];
    u[k] += du;
    sum[TLED_SUM_EXTERNAL] += 0.5*f_ext[k]*du;
    sum[TLED_SUM_INTERNAL] += 0.5*f_int[k]*du;
  }
}

/* half kick with the force at the new place; the works of the step's second half are added to sum */
BY_HD void TLEDStepClose(const TLEDStep *s, double m, const double f_int[3], const double f_ext[3], double v[3], double sum[])
{
  const double h = 0.5*s->dt, keep = 1.0 / (1.0 + s->alpha*h);

  for (int k = 0; k < 3; k++) {
    const double a = (f_ext[k] - f_int[k]) / m + s->gravity[k], du = s->dt*v[k];
    sum[TLED_SUM_EXTERNAL] += 0.5*f_ext[k]*du;
    sum[TLED_SUM_INTERNAL] += 0.5*f_int[k]*du;
    v[k] = keep*(v[k] + h*a);
    sum[TLED_SUM_DAMPING] += s->alpha*m*v[k]*v[k]*h;
  }
}

/* TLEDStepOpen of a node that is held in the directions Q = I - P: its held part lands on `target` = Q u(t + dt) exactly, with the mean
   velocity that takes it there; the rest moves as a free node does. The support gives the work of its force,
   Q (m a + f_int - f_ext - m g), that is (f_int - f_ext - m g) . Q du and what the held part's kinetic energy gains; no damping there. */
BY_HD void TLEDStepOpenHeld(const TLEDStep *s, const double P[9], const double target[3], double m, const double f_int[3],
                            const double f_ext[3], double u[3], double v[3], double sum[])
{
  const double h = 0.5*s->dt, keep = 1.0 - s->alpha*h;
  double       a[3], free_v[3], free_a[3], free_u[3];

  for (int k = 0; k < 3; k++) a[k] = (f_ext[k] - f_int[k]) / m + s->gravity[k];
  Mul3(P, a, free_a);
  Mul3(P, v, free_v);
  Mul3(P, u, free_u);
  for (int k = 0; k < 3; k++) {
    const double held_v = v[k] - free_v[k], held_du = target[k] - (u[k] - free_u[k]);
    double       du;
    sum[TLED_SUM_DAMPING] += s->alpha*m*free_v[k]*free_v[k]*h;
    free_v[k] = keep*free_v[k] + h*free_a[k];
    du        = s->dt*free_v[k] + held_du;
    u[k]      = free_u[k] + s->dt*free_v[k] + target[k];
    v[k]      = du / s->dt;
    sum[TLED_SUM_EXTERNAL] += 0.5*f_ext[k]*du;
    sum[TLED_SUM_INTERNAL] += 0.5*f_int[k]*du;
    sum[TLED_SUM_SUPPORT] += 0.5*((f_int[k] - f_ext[k] - m*s->gravity[k])*held_du - m*held_v*held_v);
  }
}

/* TLEDStepClose of such a node; `velocity` is the held part's own at the new time */
BY_HD void TLEDStepCloseHeld(const TLEDStep *s, const double P[9], const double velocity[3], double m, const double f_int[3],
                             const double f_ext[3], double v[3], double sum[])
{
  const double h = 0.5*s->dt, keep = 1.0 / (1.0 + s->alpha*h);
  double       a[3], free_v[3], free_a[3];

  for (int k = 0; k < 3; k++) a[k] = (f_ext[k] - f_int[k]) / m + s->gravity[k];
  Mul3(P, a, free_a);
  Mul3(P, v, free_v);
  for (int k = 0; k < 3; k++) {
    const double du = s->dt*v[k], held_du = du - s->dt*free_v[k];
    sum[TLED_SUM_EXTERNAL] += 0.5*f_ext[k]*du;
    sum[TLED_SUM_INTERNAL] += 0.5*f_int[k]*du;
    sum[TLED_SUM_SUPPORT] += 0.5*((f_int[k] - f_ext[k] - m*s->gravity[k])*held_du + m*velocity[k]*velocity[k]);
    free_v[k] = keep*(free_v[k] + h*free_a[k]);
    sum[TLED_SUM_DAMPING] += s->alpha*m*free_v[k]*free_v[k]*h;
    v[k] = free_v[k] + velocity[k];
  }
}

/* internal and damping work over that of loads and supports, as summed up so far [J] */
BY_HD double TLEDStepBalance(const double sum[])
{
  return sum[TLED_SUM_INTERNAL] + sum[TLED_SUM_DAMPING] - sum[TLED_SUM_EXTERNAL] - sum[TLED_SUM_SUPPORT];
}

/* kinetic energy of a node and gravity's work on it, of this time: added to sum */
BY_HD void TLEDStepEnergy(const TLEDStep *s, double m, const double u[3], const double v[3], double sum[])
{
  sum[TLED_SUM_KINETIC] += 0.5*m*Dot3(v, v);
  sum[TLED_SUM_GRAVITY] += m*Dot3(s->gravity, u);
}

/* moment impulse of the external force in one half kick at position X + u: sum += dt/2 (X + u) x f_ext; the drift gives none */
BY_HD void TLEDStepMoment(const TLEDStep *s, const double X[3], const double u[3], const double f_ext[3], double sum[])
{
  const double x[3] = {X[0] + u[0], X[1] + u[1], X[2] + u[2]};
  double       moment[3];

  Cross3(x, f_ext, moment);
  for (int k = 0; k < 3; k++) sum[TLED_SUM_MOMENT + k] += 0.5*s->dt*moment[k];
}

/* largest stable step [s] from 2/omega_max when internal forces are taken at u + beta v with v half a step late:
   (2/omega)(sqrt(1 + xi^2) - xi), xi = beta omega/2  [Belytschko, Liu & Moran, Nonlinear Finite Elements, central differences] */
BY_HD double TLEDStableStep(double critical, double beta)
{
  const double xi = beta / critical;

  return critical*(sqrt(1.0 + xi*xi) - xi);
}

#endif
