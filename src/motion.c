/* motion.c - prescribed rigid motions from what a scene says. */
#include "motion.h"

#define KEY_MAX (4 * BY_NAME_MAX)

PetscErrorCode MotionCreate(const char section[], const MotionParams *p, Motion *motion)
{
  const PetscReal length = Norm3(p->axis);
  char            key[KEY_MAX];

  PetscFunctionBegin;
#define REFUSE(what, ...)                                                     \
  do {                                                                        \
    PetscCall(PetscSNPrintf(key, sizeof key, "%s." what, section));           \
    PetscFunctionReturn(InputError(key, __VA_ARGS__));                        \
  } while (0)
  if (!(Norm3(p->translation) > 0.0) && p->angle == 0.0) REFUSE("translation", "moves nothing\na motion needs a translation [m] or an angle [deg]");
  if (p->angle != 0.0 && !(length > 0.0)) REFUSE("axis", "has no direction\na rotation needs an axis, for example [0, 1, 0], and a point of it");
  if (p->course.kind == COURSE_CONSTANT) REFUSE("course", "would jump\na motion needs a course: linear, quadratic, ramp, sine or table");
#undef REFUSE
  *motion = (Motion){0};
  ByCall(CourseCreate(section, &p->course, &motion->course));
  motion->angle = PETSC_PI / 180.0 * p->angle;
  for (int k = 0; k < 3; k++) {
    motion->translation[k] = p->translation[k];
    motion->axis[k]        = length > 0.0 ? p->axis[k] / length : 0.0;
    motion->point[k]       = p->point[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MotionDestroy(Motion *motion)
{
  PetscFunctionBegin;
  PetscCall(CourseDestroy(&motion->course));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void MotionAt(const Motion *motion, PetscReal t, RigidMotion *at)
{
  PetscReal g[3];

  CourseAt(&motion->course, t, g);
  RigidMotionAt(g, motion->translation, motion->angle, motion->axis, motion->point, at);
}
