/* tled_step.h - one node in one time step: central differences with mass-proportional damping in velocity form, for host and device.

   With a = (f_ext - f_int)/m + g at time n, D = alpha M:
     open   v_{n+1/2} = (1 - alpha dt/2) v_n + dt/2 a_n,   u_{n+1} = u_n + dt v_{n+1/2}
     close  v_{n+1}   = (v_{n+1/2} + dt/2 a_{n+1}) / (1 + alpha dt/2)
   Eliminating v gives method 3's (M/dt^2 + D/2dt) u+ = R - f + (2M/dt^2) u - (M/dt^2 - D/2dt) u-  [Miller07, eq. 10]; v and u are at the
   same time, a constant force moves a free body exactly, and its impulse is dt f exactly. */
#ifndef BY_TLED_STEP_H
#define BY_TLED_STEP_H

#include "mat3.h"

enum { TLED_FREE = 0, TLED_FIXED = 1, TLED_PRESCRIBED = 2 };
/* what a step adds up: works [J] and the moment of the external forces about the origin [N m s] */
enum { TLED_SUM_EXTERNAL = 0, TLED_SUM_DAMPING = 1, TLED_SUM_INTERNAL = 2, TLED_SUM_MOMENT = 3, TLED_SUMS = 8 };

typedef struct {
  double dt;           /* [s]                                                   */
  double alpha;        /* mass-proportional damping [1/s]                       */
  double gravity[3];   /* [m/s^2]                                               */
  double velocity[3];  /* of prescribed nodes [m/s]                             */
} TLEDStep;

/* half kick and drift of one node; the works of the step's first half are added to sum */
BY_HD void TLEDStepOpen(const TLEDStep *s, int motion, double m, const double f_int[3], const double f_ext[3], double u[3],
                        double v[3], double sum[])
{
  const double h = 0.5*s->dt, keep = 1.0 - s->alpha*h;

  if (motion == TLED_FIXED) {
    v[0] = v[1] = v[2] = 0.0;
    return;
  }
  for (int k = 0; k < 3; k++) {
    const double a = (f_ext[k] - f_int[k]) / m + s->gravity[k];
    double       du;
    if (motion == TLED_FREE) sum[TLED_SUM_DAMPING] += s->alpha*m*v[k]*v[k]*h;
    v[k] = motion == TLED_FREE ? keep*v[k] + h*a : s->velocity[k];
    du   = s->dt*v[k];
    u[k] += du;
    sum[TLED_SUM_EXTERNAL] += motion == TLED_FREE ? f_ext[k]*du : 0.5*(f_int[k] - m*s->gravity[k])*du;
    sum[TLED_SUM_INTERNAL] += 0.5*f_int[k]*du;
  }
}

/* half kick with the force at the new place; the works of the step's second half are added to sum */
BY_HD void TLEDStepClose(const TLEDStep *s, int motion, double m, const double f_int[3], const double f_ext[3], double v[3],
                         double sum[])
{
  const double h = 0.5*s->dt, keep = 1.0 / (1.0 + s->alpha*h);

  if (motion == TLED_FIXED) return;
  for (int k = 0; k < 3; k++) {
    const double a = (f_ext[k] - f_int[k]) / m + s->gravity[k], du = s->dt*v[k];
    sum[TLED_SUM_INTERNAL] += 0.5*f_int[k]*du;
    if (motion == TLED_FREE) {
      v[k] = keep*(v[k] + h*a);
      sum[TLED_SUM_DAMPING] += s->alpha*m*v[k]*v[k]*h;
    } else sum[TLED_SUM_EXTERNAL] += 0.5*(f_int[k] - m*s->gravity[k])*du;
  }
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
