/* Supports: what they hold, how they move it, how they combine on a node, what they give. */
#include "unit/tled/body.h"
#include "tled/tled_impl.h"

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

/* projectors and dual vectors of one, two, three directions that are not at right angles */
static void Projectors_SplitDirections(void **state)
{
  static const double direction[3][3] = {{1.0, 0.0, 0.0}, {0.6, 0.8, 0.0}, {0.0, 0.28, 0.96}};

  (void)state;
  for (int n = 0; n <= 3; n++) {
    TLEDHeld h = {0};
    double   PP[3], Pn[3];
    h.n = n;
    for (int j = 0; j < n; j++)
      for (int k = 0; k < 3; k++) h.normal[3 * j + k] = direction[j][k];
    TLEDHeldClose(&h);
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) assert_close(Dot3(&h.dual[3 * i], &h.normal[3 * j]), i == j, 1e-14, 1.0);
    for (int j = 0; j < n; j++) {
      Mul3(h.P, &h.normal[3 * j], Pn);
      assert_close(Norm3(Pn), 0.0, 1e-14, 1.0);
    }
    for (int j = 0; j < 3; j++) {
      const double e[3] = {h.P[j], h.P[3 + j], h.P[6 + j]};
      Mul3(h.P, e, PP);
      for (int k = 0; k < 3; k++) {
        assert_close(PP[k], e[k], 1e-14, 1.0);
        assert_close(h.P[3 * k + j], h.P[3 * j + k], 1e-14, 1.0);
      }
    }
    assert_close(h.P[0] + h.P[4] + h.P[8], 3 - n, 1e-14, 1.0);
  }
}

/* a cube between three symmetry planes, its upper side moved along z: uniaxial stretch by 1.2, which T4 meets exactly; the reactions are
   those of the law, mu (b - 1/b) + lambda ln(a^2 b)/b with mu (a^2 - 1) + lambda ln(a^2 b) = 0 */
static void Symmetries_GiveUniaxialStretch(void **state)
{
  static const char *const planes[3] = {"xmin", "ymin", "zmin"};
  const double             mu = 3e6 / 2.6, lambda = 0.9e6 / (1.3 * 0.4), b = 1.2;
  double                   a = 1.0, stress, low = 0.5, high = 1.0;
  TLEDParams              *p;
  TLED                     tled = NewBody("tests/meshes/cube_h1.msh", &p);
  TLEDConstraintParams     mirror = Constraint(TLED_CONSTRAINT_SYMMETRY, planes[0]), pull = Constraint(TLED_CONSTRAINT_MOTION, "zmax");
  const PetscReal         *x, *X;
  PetscReal                force[3], moment[3];
  PetscInt                 n;

  (void)state;
  AddName(&mirror.groups, planes[1]), AddName(&mirror.groups, planes[2]);
  AddName(&pull.components, "z");
  pull.translation[2] = b - 1.0;
  pull.course.kind = COURSE_RAMP, pull.course.duration = 1.0;
  assert_petsc(TLEDAddConstraint(tled, "mirror", &mirror));
  assert_petsc(TLEDAddConstraint(tled, "pull", &pull));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDRelax(tled, 1.0, 1e-11, 100000, NULL, NULL));
  for (int i = 0; i < 100; i++) {
    a = 0.5 * (low + high);
    if (mu * (a * a - 1.0) + lambda * log(a * a * b) > 0.0) high = a;
    else low = a;
  }
  stress = mu * (b - 1.0 / b) + lambda * log(a * a * b) / b;
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(TLEDGetPositions(tled, &x, NULL));
  for (PetscInt k = 0; k < 3 * n; k++) assert_close(x[k], X[k] * (k % 3 == 2 ? b : a), 1e-8, 1.0);
  assert_petsc(TLEDGetReaction(tled, "zmax", force, moment));
  assert_close(force[2], stress, 1e-7, stress);
  assert_close(moment[0], stress * 0.5 * a, 1e-7, stress); /* at the middle of the side, about the origin */
  assert_close(moment[1], -stress * 0.5 * a, 1e-7, stress);
  assert_petsc(TLEDGetReaction(tled, "zmin", force, NULL));
  assert_close(force[2], -stress, 1e-7, stress);
  assert_petsc(TLEDGetReaction(tled, "xmin", force, NULL));
  assert_close(force[0], 0.0, 1e-7, stress);
  assert_petsc(TLEDDestroy(&tled));
}

/* a body on a symmetry plane falls along it as if it were free, and the plane carries what pulls across */
static void SymmetryPlane_LetsTheBodySlide(void **state)
{
  const PetscReal      g[3] = {0.0, -3.0, -9.81};
  TLEDParams          *p;
  TLED                 tled   = NewBody("tests/meshes/cube_h1.msh", &p);
  TLEDConstraintParams mirror = Constraint(TLED_CONSTRAINT_SYMMETRY, "xmin");
  const PetscBool     *held;
  const PetscReal     *P;
  const PetscInt      *nodes;
  PetscInt             n;
  PetscBool            is_free;
  TLEDStats            s;

  (void)state;
  assert_petsc(TLEDAddConstraint(tled, "mirror", &mirror));
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDIsFree(tled, &is_free));
  assert_petsc(TLEDIsConstrained(tled, &held));
  assert_petsc(TLEDGetGroup(tled, "xmin", &n, &nodes));
  assert_false(is_free);
  for (PetscInt i = 0; i < n; i++) {
    assert_true(held[nodes[i]]);
    assert_petsc(TLEDGetProjector(tled, nodes[i], &P));
    assert_true(P[0] == 0.0 && P[4] == 1.0 && P[8] == 1.0);
  }
  assert_petsc(TLEDAdvance(tled, 0.1, NULL));
  assert_petsc(TLEDGetStats(tled, &s));
  assert_close(s.momentum[1], -3.0 * 0.1 * 1000.0, ROUND, 1000.0);
  assert_close(s.momentum[2], -9.81 * 0.1 * 1000.0, ROUND, 1000.0);
  assert_close(s.strain, 0.0, ROUND, s.kinetic);
  assert_petsc(TLEDDestroy(&tled));
}

/* a support that carries every node carries the body: m (a - g) and, about the axis, the moment of inertia times the angular acceleration */
static void Reaction_IsMassTimesAcceleration(void **state)
{
  const PetscReal      g[3] = {0.0, 0.0, -9.81};
  TLEDParams          *p;
  TLED                 tled = NewBody("tests/meshes/beam_h1.msh", &p);
  TLEDConstraintParams swing = Constraint(TLED_CONSTRAINT_MOTION, "solid");
  const PetscReal     *X;
  PetscReal            force[3], moment[3], inertia = 0.0, mass = 0.0, along = 0.0;
  double               q[3];
  Course               c;
  TLEDStats            s;

  (void)state;
  swing.angle = 40.0, swing.axis[2] = 1.0;
  swing.translation[2] = 0.3;
  swing.course.kind = COURSE_RAMP, swing.course.duration = 0.4;
  assert_petsc(TLEDAddConstraint(tled, "swing", &swing));
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDAdvance(tled, 0.1, NULL));
  assert_petsc(CourseCreate("x", &swing.course, &c));
  CourseAt(&c, 0.1, q);
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) {
    const double r2 = X[3 * a] * X[3 * a] + X[3 * a + 1] * X[3 * a + 1];
    mass += tled->mass[a], inertia += tled->mass[a] * r2, along += tled->mass[a] * X[3 * a];
  }
  assert_petsc(TLEDGetReaction(tled, "solid", force, moment));
  assert_close(force[2], mass * (0.3 * q[2] + 9.81), 1e-9, mass * 10.0);
  assert_close(moment[2], inertia * q[2] * PETSC_PI * 40.0 / 180.0, 1e-9, inertia * q[2]);
  assert_petsc(TLEDAdvance(tled, 0.1, NULL)); /* half way: the work of the support is the kinetic energy and the lift */
  assert_petsc(TLEDGetStats(tled, &s));
  CourseAt(&c, 0.2, q);
  assert_close(s.kinetic, 0.5 * mass * PetscSqr(0.3 * q[1]) + 0.5 * inertia * PetscSqr(q[1] * PETSC_PI * 40.0 / 180.0), 1e-9, s.kinetic);
  assert_close(s.support_work, s.kinetic + s.gravity_potential, 1e-6, s.kinetic); /* chords of the circle: the strain of a substep */
  assert_petsc(TLEDDestroy(&tled));
}

/* at rest the clamp carries the weight, and its moment about the origin */
static void Reaction_IsTheWeight(void **state)
{
  const PetscReal  g[3] = {0.0, 0.0, -9.81};
  TLEDParams      *p;
  TLED             tled = NewBody("tests/meshes/beam_h1.msh", &p);
  const PetscReal *x;
  PetscReal        force[3], moment[3], lever = 0.0;

  (void)state;
  p->elastic.young = 3e8;
  AddName(&p->fixed, "clamp");
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDRelax(tled, 0.0, 1e-9, 200000, NULL, NULL));
  assert_petsc(TLEDGetReaction(tled, "clamp", force, moment));
  assert_petsc(TLEDGetPositions(tled, &x, NULL));
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) lever += tled->mass[a] * x[3 * a];
  assert_close(force[2], 98.1, 1e-7, 98.1);
  assert_close(moment[1], -9.81 * lever, 1e-7, 50.0);
  assert_petsc(TLEDDestroy(&tled));
}

/* the clamp shakes and turns the beam far: what it and the tip's support give is kinetic, strain and potential energy */
static void Work_OfMovingClampBalances(void **state)
{
  const PetscReal g[3] = {0.0, 0.0, -9.81};
  double          error[2];

  (void)state;
  for (int fine = 0; fine < 2; fine++) {
    TLEDParams          *p;
    TLED                 tled = NewBody("tests/meshes/beam_h1.msh", &p);
    TLEDConstraintParams shake = Constraint(TLED_CONSTRAINT_MOTION, "clamp"), rail = Constraint(TLED_CONSTRAINT_FIXED, "tip");
    TLEDStats            s;

    p->safety   = fine ? 0.2 : 0.4;
    p->damping  = 2.0;
    shake.angle = 25.0, shake.axis[0] = 1.0, shake.translation[2] = 0.05;
    shake.course.kind = COURSE_SINE, shake.course.frequency = 4.0, shake.course.duration = 0.1;
    AddName(&rail.components, "y");
    assert_petsc(TLEDAddConstraint(tled, "shake", &shake));
    assert_petsc(TLEDAddConstraint(tled, "rail", &rail));
    assert_petsc(TLEDSetGravity(tled, g));
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDAdvance(tled, 0.17, NULL));
    assert_petsc(TLEDGetStats(tled, &s));
    assert_true(s.external_work == s.support_work && fabs(s.support_work) > 0.5);
    error[fine] = fabs(s.kinetic + s.strain + s.gravity_potential + s.damping_loss - s.support_work) / (s.kinetic + s.strain);
    assert_petsc(TLEDDestroy(&tled));
  }
  assert_close(error[1], 0.0, 1e-3, 1.0); /* (omega dt)^2/12 of the modes that move */
  assert_true(error[1] < 0.5 * error[0]);
}

/* conditions that ask the same of a node go together, those that do not are refused with the node and the names */
static void Conflicts_AreRefused(void **state)
{
  TLEDParams          *p;
  TLED                 tled;
  TLEDConstraintParams mirror = Constraint(TLED_CONSTRAINT_SYMMETRY, "xmin"), slide = Constraint(TLED_CONSTRAINT_MOTION, "zmax");

  (void)state;
  slide.translation[2] = 0.1, slide.course.kind = COURSE_LINEAR, slide.course.duration = 1.0;
  for (int across = 0; across < 2; across++) { /* within the symmetry plane; then across it */
    tled                 = NewBody("tests/meshes/cube_h1.msh", &p);
    slide.translation[0] = across * 1e-3;
    assert_petsc(TLEDAddConstraint(tled, "mirror", &mirror));
    assert_petsc(TLEDAddConstraint(tled, "slide", &slide));
    if (across) assert_int_equal((int)TLEDSetUp(tled), (int)BY_ERR_INPUT);
    else assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDDestroy(&tled));
  }
  tled                 = NewBody("tests/meshes/cube_h1.msh", &p); /* the same motion said twice */
  slide.translation[0] = 0.0;
  assert_petsc(TLEDAddConstraint(tled, "one", &slide));
  slide.translation[2] = 0.05, slide.course.duration = 0.5;
  assert_petsc(TLEDAddConstraint(tled, "two", &slide));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDDestroy(&tled));
  tled   = NewBody("meshes/ball.msh", &p);
  mirror = Constraint(TLED_CONSTRAINT_SYMMETRY, "skin");
  assert_petsc(TLEDAddConstraint(tled, "mirror", &mirror));
  assert_int_equal((int)TLEDSetUp(tled), (int)BY_ERR_INPUT);
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(Motion_LandsExactly), cmocka_unit_test(Projectors_SplitDirections), cmocka_unit_test(Symmetries_GiveUniaxialStretch),
           cmocka_unit_test(SymmetryPlane_LetsTheBodySlide), cmocka_unit_test(Reaction_IsMassTimesAcceleration),
           cmocka_unit_test(Reaction_IsTheWeight), cmocka_unit_test(Work_OfMovingClampBalances), cmocka_unit_test(Conflicts_AreRefused))
