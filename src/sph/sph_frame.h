/* sph_frame.h - the fluid in a tank that moves as a rigid body, seen from the tank, for host and device.

   A place x of the tank is at X = p + R (x - p) + t of the laboratory. Let a particle without forces go straight there, at the mean velocity
   V_n = (X_(n+1) - X_n)/dt of every step, and write X_(n-1), X_n and X_(n+1) by x_n and u_n = (x_n - x_(n-1))/dt':

     V_n = V_(n-1)  gives  u_(n+1) = R_(n+1)^T { R_(n-1) u_n + [(R_n - R_(n-1))/dt' - (R_(n+1) - R_n)/dt] r_n - (T_n - T_(n-1)) }

   with r = x - p and T_n the mean of dt/dt over the step. It is Coriolis', the centrifugal, Euler's and the linear acceleration at once, exact for
   every motion whose places are known, and stable because it is the straight path. */
#ifndef BY_SPH_FRAME_H
#define BY_SPH_FRAME_H

#include "mat3.h"

/* the tank around one step */
typedef struct {
  double point[3];           /* p [m]                                                                     */
  double keep[9];            /* R_(n+1)^T R_(n-1) - I                                                     */
  double place[9];           /* R_(n+1)^T [...] [1/s]                                                     */
  double shift[3];           /* - R_(n+1)^T (T_n - T_(n-1)) [m/s]                                         */
  double scale;              /* 2 dt/(dt + dt'): steps that differ get accelerations, not differences     */
  double gravity[3];         /* at the end of the step, R_(n+1)^T g [m/s^2]                               */
} SPHFrame;

/* y = A^T x */
BY_HD void SPHTurnBack(const double A[9], const double x[3], double y[3])
{
  for (int i = 0; i < 3; i++) y[i] = A[i]*x[0] + A[3 + i]*x[1] + A[6 + i]*x[2];
}

/* R^T of the three instants R_(n-1), R_n, R_(n+1) and shifts t [m] of the tank; steps dt' and dt */
BY_HD void SPHFrameAt(const double before[9], const double now[9], const double after[9], const double shift[3][3], const double point[3],
                      const double gravity[3], double dt_before, double dt, SPHFrame *f)
{
  double change[9], jump[3];

  for (int k = 0; k < 9; k++) change[k] = (now[k] - before[k])/dt_before - (after[k] - now[k])/dt;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      f->keep[3*i + j] = f->place[3*i + j] = 0.0;
      for (int k = 0; k < 3; k++) {
        f->keep[3*i + j] += after[3*k + i]*(before[3*k + j] - after[3*k + j]);
        f->place[3*i + j] += after[3*k + i]*change[3*k + j];
      }
    }
    jump[i]     = (shift[1][i] - shift[0][i])/dt_before - (shift[2][i] - shift[1][i])/dt;
    f->point[i] = point[i];
  }
  f->scale = 2.0*dt/(dt + dt_before);
  SPHTurnBack(after, jump, f->shift);
  SPHTurnBack(after, gravity, f->gravity);
}

/* change of the velocity u [m/s] of a particle at x [m] in the step, without gravity */
BY_HD void SPHFrameKick(const SPHFrame *f, const double x[3], const double u[3], double change[3])
{
  double r[3], kept[3], placed[3];

  Sub3(x, f->point, r);
  Mul3(f->keep, u, kept);
  Mul3(f->place, r, placed);
  for (int k = 0; k < 3; k++) change[k] = f->scale*(kept[k] + placed[k] + f->shift[k]);
}

#endif
