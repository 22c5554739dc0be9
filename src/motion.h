/* motion.h - rigid motions that a scene prescribes: a translation and a rotation about an axis, both times a course in time. The formulas
   are for host and device.

     x = p + R(g theta) (X - p) + g t

   with the translation t, the angle theta about an axis through p, and the course g(t). */
#ifndef BY_MOTION_H
#define BY_MOTION_H

#include "course.h"
#include "mat3.h"

/* A rigid motion at one instant. */
typedef struct {
  double point[3], axis[3];            /* [m]; unit vector                                      */
  double turn[9];                      /* R - I                                                 */
  double spin, spin_rate;              /* rate of the angle [rad/s], and of that [rad/s^2]      */
  double shift[3], speed[3], kick[3];  /* g t and its derivatives [m], [m/s], [m/s^2]           */
} RigidMotion;

enum { MOTION_DISPLACEMENT = 0, MOTION_VELOCITY = 1, MOTION_ACCELERATION = 2 };

/* the motion at an instant with g[] = g, dg/dt, d2g/dt2: R - I = sin(a) K + 2 sin^2(a/2) K^2, K x = axis x x, a = g angle [Rodrigues 1840] */
BY_HD void RigidMotionAt(const double g[3], const double translation[3], double angle, const double axis[3], const double point[3], RigidMotion *m)
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
BY_HD void RigidMotionOf(const RigidMotion *m, const double X[3], int what, double value[3])
{
  double r[3], turned[3], across[3], inward[3];

  Sub3(X, m->point, r);
  Mul3(m->turn, r, turned);
  if (what == MOTION_DISPLACEMENT) {
    for (int k = 0; k < 3; k++) value[k] = turned[k] + m->shift[k];
    return;
  }
  for (int k = 0; k < 3; k++) r[k] += turned[k];
  Cross3(m->axis, r, across);
  Cross3(m->axis, across, inward);
  for (int k = 0; k < 3; k++)
    value[k] = what == MOTION_VELOCITY ? m->spin*across[k] + m->speed[k]
                                       : m->spin_rate*across[k] + m->spin*m->spin*inward[k] + m->kick[k];
}

/* As a scene says it; a section that moves takes MOTION_KEYS into its table. */
typedef struct {
  PetscReal    translation[3]; /* [m] where the course is 1           */
  PetscReal    angle;          /* [deg] where the course is 1         */
  PetscReal    axis[3], point[3];
  CourseParams course;
} MotionParams;

typedef struct {
  PetscReal translation[3], angle; /* [m], [rad]             */
  PetscReal axis[3], point[3];     /* unit vector or 0; [m]  */
  Course    course;
} Motion;

/* rows of a Key table for the MotionParams `member` of the struct S */
#define MOTION_KEYS(S, member)                                                                                                        \
  {"translation", KEY_VEC3, offsetof(S, member.translation), "m", "0,0,0", -1e6, 1e6, 0, NULL, "displacement where the course is 1"}, \
    {"angle", KEY_REAL, offsetof(S, member.angle), "deg", "0", -1e9, 1e9, 0, NULL,                                                    \
     "rotation where the course is 1, right-handed about axis through point"},                                                       \
    {"axis", KEY_VEC3, offsetof(S, member.axis), "1", "0,0,0", -1e9, 1e9, 0, NULL, "direction of the axis of rotation"},              \
    {"point", KEY_VEC3, offsetof(S, member.point), "m", "0,0,0", -1e9, 1e9, 0, NULL, "a point of the axis"},                          \
    COURSE_KEYS(S, member.course)

/* section: the scene's section for messages. User errors (nothing that moves, no axis, no course) are reported, BY_ERR_INPUT is returned. */
BY_EXTERN PetscErrorCode MotionCreate(const char section[], const MotionParams *params, Motion *motion);
BY_EXTERN PetscErrorCode MotionDestroy(Motion *motion);
/* the motion at time t [s]. No PETSc inside: may be called in a parallel region. */
BY_EXTERN void MotionAt(const Motion *motion, PetscReal t, RigidMotion *at);

#endif
