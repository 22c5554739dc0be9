/* Supports: what they hold, how they move it, how they combine on a node, what they give. */
#include "unit/tled/body.h"

#define ROUND 1e-12 /* sums of a few thousand terms in double precision */

static TLEDConstraintParams Constraint(int kind, const char group[])
{
  TLEDConstraintParams p;

  assert_petsc(KeysSetDefaults(TLEDConstraintKeys, &p));
  p.kind = kind;
  AddName(&p.groups, group);
  return p;
}

/* a turn of the beam's tip by 30 degrees about its axis with a pull, landing on the exact places at all times */
static void Motion_LandsExactly(void **state)
{
  (void)state;
  for (int kind = COURSE_LINEAR; kind <= COURSE_SINE; kind++) {
    TLEDParams          *p;
    TLED                 tled = NewBody("tests/meshes/beam_h1.msh", &p);
    TLEDConstraintParams turn = Constraint(TLED_CONSTRAINT_MOTION, "tip");
    const PetscReal     *x, *v, *X;
    const PetscInt      *tip;
    PetscInt             n_tip;

    AddName(&p->fixed, "clamp");
    turn.angle   = 30.0;
    turn.axis[0] = 2.0, turn.point[1] = turn.point[2] = 0.05;
    turn.translation[0] = 0.02;
    turn.course.kind = kind, turn.course.start = 0.001, turn.course.duration = 0.02, turn.course.frequency = 30.0;
    assert_petsc(TLEDAddConstraint(tled, "turn", &turn));
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetGroup(tled, "tip", &n_tip, &tip));
    assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
    for (int step = 1; step <= 3; step++) {
      Course c;
      double g[3];

      assert_petsc(TLEDAdvance(tled, 0.007, NULL));
      assert_petsc(TLEDGetPositions(tled, &x, &v));
      assert_petsc(CourseCreate("x", &turn.course, &c));
      CourseAt(&c, 0.007 * step, g);
      for (PetscInt i = 0; i < n_tip; i++) {
        const PetscInt a = tip[i];
        const double   angle = g[0] * PETSC_PI / 6.0, rate = g[1] * PETSC_PI / 6.0, y = X[3 * a + 1] - 0.05, z = X[3 * a + 2] - 0.05;
        const double   to[2] = {cos(angle) * y - sin(angle) * z, sin(angle) * y + cos(angle) * z};
        assert_close(x[3 * a], X[3 * a] + 0.02 * g[0], ROUND, 1.0);
        assert_close(x[3 * a + 1], 0.05 + to[0], ROUND, 0.1);
        assert_close(x[3 * a + 2], 0.05 + to[1], ROUND, 0.1);
        assert_close(v[3 * a], 0.02 * g[1], ROUND, 1.0);
        assert_close(v[3 * a + 1], -rate * to[1], ROUND, 1.0);
        assert_close(v[3 * a + 2], rate * to[0], ROUND, 1.0);
      }
      assert_petsc(CourseDestroy(&c));
    }
    assert_petsc(TLEDDestroy(&tled));
  }
}

CHECK_MAIN(cmocka_unit_test(Motion_LandsExactly))
