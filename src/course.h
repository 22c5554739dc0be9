/* course.h - a number that follows time: g(t) of a motion or a load, with its first two derivatives. */
#ifndef BY_COURSE_H
#define BY_COURSE_H

#include "keys.h"

typedef enum { COURSE_CONSTANT, COURSE_LINEAR, COURSE_QUADRATIC, COURSE_RAMP, COURSE_SINE, COURSE_TABLE } CourseKind;

/* As a scene says it; a section that has a course takes COURSE_KEYS into its table. */
typedef struct {
  int       kind;                      /* CourseKind                                                                 */
  PetscReal start;                     /* [s]                                                                        */
  PetscReal duration;                  /* [s] of linear, quadratic (to reach 1), ramp; of sine: fades in over it     */
  PetscReal frequency, phase;          /* [Hz], [deg] of sine                                                        */
  char      table[PETSC_MAX_PATH_LEN]; /* of table: CSV file of time [s], value                                      */
} CourseParams;

typedef struct {
  int        kind;
  PetscReal  start, duration;
  PetscReal  omega, phase; /* [rad/s], [rad]                         */
  PetscInt   n;            /* rows of the table                      */
  PetscReal *time, *value; /* n, ascending; n                        */
} Course;

BY_EXTERN const char *const CourseNames[]; /* words of CourseKind */

/* rows of a Key table for the CourseParams `member` of the struct S */
#define COURSE_KEYS(S, member)                                                                                                     \
  {"course", KEY_CHOICE, offsetof(S, member.kind), "", "constant", 0, 0, 0, CourseNames,                                           \
   "how it goes with time: constant 1, linear or quadratic to 1 in duration and on, ramp smoothly to 1 in duration, sine, table"},              \
    {"start", KEY_REAL, offsetof(S, member.start), "s", "0", -1e9, 1e9, 0, NULL, "when the course begins"},                        \
    {"duration", KEY_REAL, offsetof(S, member.duration), "s", "0", 0, 1e9, 0, NULL,                                                \
     "of linear, quadratic and ramp; of sine: it fades in over this time"},                                                                   \
    {"frequency", KEY_REAL, offsetof(S, member.frequency), "Hz", "0", 0, 1e9, 0, NULL, "of sine"},                                 \
    {"phase", KEY_REAL, offsetof(S, member.phase), "deg", "0", -1e6, 1e6, 0, NULL, "of sine"},                                     \
  {                                                                                                                                \
    "table", KEY_FILE, offsetof(S, member.table), "", "", 0, 0, 0, NULL,                                                           \
      "of table: CSV file of time [s] and value, straight between its rows, held beyond them"                                      \
  }

/* the numbers of a line of a table, separated by blanks, commas or semicolons, # begins a comment: how many there are (the first `most` go into
   value), -1 when something else stands there */
BY_EXTERN int CourseParseLine(const char line[], int most, double value[]);
/* section: the scene's section for messages ("block.plate"). User errors (a duration that is missing, a table that cannot be read or
   does not ascend) are reported with the key, BY_ERR_INPUT is returned. */
BY_EXTERN PetscErrorCode CourseCreate(const char section[], const CourseParams *params, Course *course);
BY_EXTERN PetscErrorCode CourseDestroy(Course *course);
/* g[0] = g(t), g[1] = dg/dt [1/s], g[2] = d2g/dt2 [1/s^2]. No PETSc inside: may be called in a parallel region. Where the course has a
   corner the derivatives are those of the time after. */
BY_EXTERN void CourseAt(const Course *course, PetscReal t, PetscReal g[3]);

#endif
