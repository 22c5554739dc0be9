/* hard.h - the hard cases' lines: `hard: case | quantity | measured | allowed`, which a report collects, and the check that goes
   with each. */
#ifndef BY_TEST_HARD_H
#define BY_TEST_HARD_H

#include "tled/tled_implicit.h"
#include "mat3.h"
#include "unit/tled/block.h"

static const char *const element_name[] = {"auto", "t4", "anp", "t10"};

/* print, and hold measured <= allowed */
static inline void Hard(const char name[], const char quantity[], double measured, double allowed)
{
  printf("hard: %s | %s | %.3g | %.3g\n", name, quantity, measured, allowed);
  assert_true(measured <= allowed * ToleranceScale());
}

/* print, and hold from <= measured <= to */
static inline void HardBetween(const char name[], const char quantity[], double measured, double from, double to)
{
  printf("hard: %s | %s | %.4g | %.3g to %.3g\n", name, quantity, measured, from, to);
  assert_true(from <= measured && measured <= to);
}

/* held in one direction where the plane of symmetry `group` is, in the directions of `components` */
static inline void Hold(TLED tled, const char group[], const char component[])
{
  TLEDConstraintParams c;

  assert_petsc(KeysSetDefaults(TLEDConstraintKeys, &c));
  AddName(&c.groups, group);
  if (component) AddName(&c.components, component);
  assert_petsc(TLEDAddConstraint(tled, group, &c));
}

/* group moved by `way` along x, the other directions free, smoothly within a time */
static inline void Pull(TLED tled, const char group[], double way, double duration)
{
  TLEDConstraintParams c;

  assert_petsc(KeysSetDefaults(TLEDConstraintKeys, &c));
  c.kind = TLED_CONSTRAINT_MOTION;
  AddName(&c.groups, group);
  AddName(&c.components, "x");
  c.translation[0] = way;
  c.course.kind = COURSE_RAMP, c.course.duration = duration;
  assert_petsc(TLEDAddConstraint(tled, "pull", &c));
}

/* largest nodal difference of two bodies' displacements over the largest displacement */
static inline double Difference(TLED a, TLED b)
{
  Vec              u, w;
  const PetscReal *x, *y;
  PetscInt         n;
  double           worst = 0.0, top = 0.0;

  assert_petsc(TLEDGetSize(a, &n, NULL));
  assert_petsc(TLEDGetVectors(a, &u, NULL, NULL));
  assert_petsc(TLEDGetVectors(b, &w, NULL, NULL));
  assert_petsc(VecGetArrayRead(u, &x));
  assert_petsc(VecGetArrayRead(w, &y));
  for (PetscInt k = 0; k < n; k++) {
    double d[3];
    Sub3(&x[3 * k], &y[3 * k], d);
    worst = fmax(worst, Norm3(d));
    top   = fmax(top, Norm3(&y[3 * k]));
  }
  assert_petsc(VecRestoreArrayRead(u, &x));
  assert_petsc(VecRestoreArrayRead(w, &y));
  return worst / top;
}

/* relaxed at `time` to 1e-7, or the message of why not; steps taken */
static inline PetscInt Relax(TLED tled, double time)
{
  PetscInt             steps;
  const PetscErrorCode ierr = TLEDRelax(tled, time, 1e-7, 400000, &steps, NULL);
  const char          *message;

  assert_petsc(TLEDGetBreakdown(tled, &message));
  if (ierr) fail_msg("%s", message);
  return steps;
}

/* the implicit solution at `time` */
static inline void Solve(TLED tled, double time)
{
  TLEDImplicit         implicit;
  PetscErrorCode       ierr;
  const char          *message;

  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
  ierr = TLEDImplicitSolveStatic(implicit, time);
  assert_petsc(TLEDGetBreakdown(tled, &message));
  if (ierr) fail_msg("%s", message);
  assert_petsc(TLEDImplicitDestroy(&implicit));
}

/* mean displacement of a group in a direction */
static inline double MeanOf(TLED tled, const char group[], int direction)
{
  const PetscReal *u;
  const PetscInt  *nodes;
  PetscInt         n;
  Vec              vec;
  double           sum = 0.0;

  assert_petsc(TLEDGetGroup(tled, group, &n, &nodes));
  assert_true(n > 0);
  assert_petsc(TLEDGetVectors(tled, &vec, NULL, NULL));
  assert_petsc(VecGetArrayRead(vec, &u));
  for (PetscInt i = 0; i < n; i++) sum += u[3 * nodes[i] + direction];
  assert_petsc(VecRestoreArrayRead(vec, &u));
  return sum / n;
}

#endif
