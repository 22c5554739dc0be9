/* course.c - courses in time, and the reader of their tables. */
#include "course.h"
#include "body.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const CourseNames[] = {"constant", "linear", "quadratic", "ramp", "sine", "table", NULL};

int CourseParseLine(const char line[], int most, double value[])
{
  const char *blanks = " \t\r\n,;";
  int         n      = 0;

  for (const char *c = line + strspn(line, blanks); *c && *c != '#'; c += strspn(c, blanks)) {
    char        *end;
    const double x = strtod(c, &end);
    if (end == c || (*end && !strchr(blanks, *end) && *end != '#')) return -1;
    if (n < most) value[n] = x;
    n++;
    c = end;
  }
  return n;
}

static PetscErrorCode AddRow(Course *course, PetscInt *capacity, const double row[2])
{
  PetscFunctionBegin;
  if (course->n == *capacity) {
    *capacity = 2 * *capacity + 64;
    PetscCall(PetscRealloc((size_t)*capacity * sizeof(PetscReal), &course->time));
    PetscCall(PetscRealloc((size_t)*capacity * sizeof(PetscReal), &course->value));
  }
  course->time[course->n]    = row[0];
  course->value[course->n++] = row[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rows of an open table; a first line of words is its heading */
static PetscErrorCode ReadRows(const char key[], FILE *file, Course *course)
{
  char     line[1024];
  double   row[2];
  PetscInt capacity = 0, number = 0;

  PetscFunctionBegin;
  while (fgets(line, sizeof line, file)) {
    const int n = CourseParseLine(line, 2, row);
    number++;
    if (!n || (n < 0 && !course->n && number == 1)) continue;
    if (n != 2 || !isfinite(row[0]) || !isfinite(row[1]))
      PetscFunctionReturn(InputError(key, "holds in line %" PetscInt_FMT " what are not two numbers\nexpected rows of time [s], value", number));
    if (course->n && !(row[0] > course->time[course->n - 1]))
      PetscFunctionReturn(InputError(key,
                                     "does not ascend: line %" PetscInt_FMT " has time %g s after %g s\n"
                                     "expected rows of time [s], value with every time later than the one before",
                                     number, row[0], (double)course->time[course->n - 1]));
    PetscCall(AddRow(course, &capacity, row));
  }
  if (!course->n) PetscFunctionReturn(InputError(key, "holds no rows\nexpected rows of time [s], value"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadTable(const char key[], const char path[], Course *course)
{
  PetscErrorCode ierr;
  FILE          *file;

  PetscFunctionBegin;
  if (!path[0]) PetscFunctionReturn(InputError(key, "is not given, and the course is a table\nname a CSV file of time [s], value"));
  file = fopen(path, "r");
  if (!file) PetscFunctionReturn(InputError(key, "cannot be read: %s", strerror(errno)));
  ierr = ReadRows(key, file, course);
  fclose(file);
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CourseCreate - a course from its parameters

  Input Parameters:
+ section - section of the scene that has it, for messages
- params  - what it says

  Output Parameter:
. course - CourseDestroy() frees it, also after an error

  Courses, with s = (t - start)/duration:
    constant  1
    linear    0 before start, then s, beyond 1 as well
    quadratic 0 before start, then s^2, beyond 1 as well
    ramp      0, then 10 s^3 - 15 s^4 + 6 s^5, then 1: speed and acceleration are zero at both ends
    sine      sin(2 pi frequency (t - start) + phase), times the ramp when there is a duration; before start as at start
    table     the rows' values at t - start, straight between them, the first and last held beyond

  Errors: BY_ERR_INPUT, reported, when the course is not complete or its table cannot be used
  Tests: tests/unit/scene/test_course.c

.seealso: CourseAt()
@*/
PetscErrorCode CourseCreate(const char section[], const CourseParams *p, Course *course)
{
  char key[4 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(course, sizeof *course));
  course->kind     = p->kind;
  course->start    = p->start;
  course->duration = p->duration;
  course->omega    = 2.0 * PETSC_PI * p->frequency;
  course->phase    = PETSC_PI / 180.0 * p->phase;
  if ((p->kind == COURSE_LINEAR || p->kind == COURSE_QUADRATIC || p->kind == COURSE_RAMP) && !(p->duration > 0.0)) {
    PetscCall(PetscSNPrintf(key, sizeof key, "%s.duration", section));
    PetscFunctionReturn(InputError(key, "does not fit the course %s\nexpected a duration > 0 [s]", CourseNames[p->kind]));
  }
  if (p->kind == COURSE_SINE && !(p->frequency > 0.0)) {
    PetscCall(PetscSNPrintf(key, sizeof key, "%s.frequency", section));
    PetscFunctionReturn(InputError(key, "does not fit the course sine\nexpected a frequency > 0 [Hz]"));
  }
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.table", section));
  if (p->kind == COURSE_TABLE) ByCall(ReadTable(key, p->table, course));
  else if (p->table[0]) PetscFunctionReturn(InputError(key, "is not used by the course %s\nwrite course: table", CourseNames[p->kind]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CourseDestroy(Course *course)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(course->time));
  PetscCall(PetscFree(course->value));
  course->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 0 to 1 over 0 <= s <= 1 with two zero derivatives at both ends: the polynomial of fifth degree; derivatives to s */
static void Ramp(PetscReal s, PetscReal g[3])
{
  g[0] = s < 0.0 ? 0.0 : 1.0, g[1] = g[2] = 0.0;
  if (s < 0.0 || s >= 1.0) return;
  g[0] = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
  g[1] = 30.0 * s * s * (1.0 - s) * (1.0 - s);
  g[2] = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
}

static void Sine(const Course *c, PetscReal t, PetscReal g[3])
{
  const PetscReal x = c->omega * PetscMax(t, 0.0) + c->phase, w = t < 0.0 ? 0.0 : c->omega;
  const PetscReal s[3] = {sin(x), w * cos(x), -w * w * sin(x)};
  PetscReal       r[3] = {1.0, 0.0, 0.0};

  if (c->duration > 0.0) {
    Ramp(t / c->duration, r);
    r[1] /= c->duration, r[2] /= c->duration * c->duration;
  }
  g[0] = r[0] * s[0];
  g[1] = r[1] * s[0] + r[0] * s[1];
  g[2] = r[2] * s[0] + 2.0 * r[1] * s[1] + r[0] * s[2];
}

static void Table(const Course *c, PetscReal t, PetscReal g[3])
{
  PetscInt lo = 0, hi = c->n - 1;

  g[1] = g[2] = 0.0;
  if (t < c->time[0] || t >= c->time[hi]) {
    g[0] = t < c->time[0] ? c->value[0] : c->value[hi];
    return;
  }
  while (hi - lo > 1) {
    const PetscInt middle = (lo + hi) / 2;
    if (t < c->time[middle]) hi = middle;
    else lo = middle;
  }
  g[1] = (c->value[hi] - c->value[lo]) / (c->time[hi] - c->time[lo]);
  g[0] = c->value[lo] + g[1] * (t - c->time[lo]);
}

void CourseAt(const Course *c, PetscReal time, PetscReal g[3])
{
  const PetscReal t = time - c->start;

  g[0] = 1.0, g[1] = g[2] = 0.0;
  switch (c->kind) {
  case COURSE_LINEAR:
    g[1] = t < 0.0 ? 0.0 : 1.0 / c->duration;
    g[0] = g[1] * t;
    break;
  case COURSE_QUADRATIC:
    g[2] = t < 0.0 ? 0.0 : 2.0 / (c->duration * c->duration);
    g[1] = g[2] * t;
    g[0] = 0.5 * g[1] * t;
    break;
  case COURSE_RAMP:
    Ramp(t / c->duration, g);
    g[1] /= c->duration, g[2] /= c->duration * c->duration;
    break;
  case COURSE_SINE: Sine(c, t, g); break;
  case COURSE_TABLE: Table(c, t, g); break;
  default: break;
  }
}
