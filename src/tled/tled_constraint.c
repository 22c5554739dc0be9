/* tled_constraint.c - supports: conditions of the scene's constraints on nodes, combined node by node; projectors, prescribed
   motion, reactions. */
#include "tled/tled_impl.h"
#include <petscblaslapack.h>
#include <string.h>

#define PARALLEL 1e-3 /* [rad] directions nearer than this are one: normals of one plane from two groups of a mesh            */
#define PLANE    1e-5 /* of a symmetry group's extent: how far its nodes may lie from its plane (meshes from surfaces are rounded) */
#define AGREE    1e-9 /* of the displacement: two motions that differ by less ask the same                                  */
#define SAMPLES  24   /* times over a course at which two motions are compared                                              */

static const char *const constraint_kinds[]      = {"fixed", "symmetry", "motion", NULL}; /* in the order of TLEDConstraintKind */
static const char *const constraint_components[] = {"x", "y", "z", NULL};

#define ROW(key, type, unit, def, lo, hi, flags, choices, help) {#key, type, offsetof(TLEDConstraintParams, key), unit, def, lo, hi, flags, choices, help}

const Key TLEDConstraintKeys[] = {
    ROW(kind, KEY_CHOICE, "", "fixed", 0, 0, 0, constraint_kinds,
        "fixed: held where they are; symmetry: the group's plane is one of symmetry; motion: moved"),
    ROW(groups, KEY_NAMES, "", NULL, 0, 0, KEY_REQUIRED, NULL, "physical groups of the mesh whose nodes it acts on"),
    ROW(components, KEY_NAMES, "", NULL, 0, 0, 0, constraint_components, "of fixed and motion: directions in which they are held or moved; none: all"),
    ROW(translation, KEY_VEC3, "m", "0,0,0", -1e9, 1e9, 0, NULL, "of motion: displacement where the course is 1"),
    ROW(angle, KEY_REAL, "deg", "0", -1e9, 1e9, 0, NULL, "of motion: rotation where the course is 1, right-handed about axis through point"),
    ROW(axis, KEY_VEC3, "1", "0,0,0", -1e9, 1e9, 0, NULL, "of motion: direction of the axis of rotation"),
    ROW(point, KEY_VEC3, "m", "0,0,0", -1e9, 1e9, 0, NULL, "of motion: a point of the axis"),
    COURSE_KEYS(TLEDConstraintParams, course),
    KEY_END};

/*@
  TLEDAddConstraint - a support, before TLEDSetUp()

  Input Parameters:
+ tled   - the body
. name   - name of the support, for messages
- params - what it holds; KeysSetDefaults(TLEDConstraintKeys, &params) gives a support that holds its groups

  Reads the options -<body>_<name>_<key> no more: TLEDSetFromOptions() does for those that the body's key `constraints` names.

.seealso: TLEDSetUp(), TLEDGetReaction()
@*/
PetscErrorCode TLEDAddConstraint(TLED tled, const char name[], const TLEDConstraintParams *params)
{
  TLEDConstraints *c = &tled->constraints;

  PetscFunctionBegin;
  PetscCheck(!tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDAddConstraint() comes before TLEDSetUp()");
  PetscCall(PetscRealloc((size_t)(c->n + 1) * sizeof *c->item, &c->item));
  PetscCall(PetscMemzero(&c->item[c->n], sizeof *c->item));
  PetscCall(PetscSNPrintf(c->item[c->n].key, sizeof c->item->key, "%s.%s", ((PetscObject)tled)->name, name));
  c->item[c->n].params = *params;
  c->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the constraints that the body's parameters name, from the options */
PetscErrorCode TLEDConstraintsFromOptions_Private(TLED tled)
{
  const Names         *names = &tled->params.constraints;
  TLEDConstraintParams params;
  char                 prefix[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < names->n; i++) {
    PetscCall(PetscSNPrintf(prefix, sizeof prefix, "%s%s_", ((PetscObject)tled)->prefix, names->name[i]));
    PetscCall(KeysSetDefaults(TLEDConstraintKeys, &params));
    PetscCall(KeysSetFromOptions(TLEDConstraintKeys, prefix, &params));
    PetscCall(TLEDAddConstraint(tled, names->name[i], &params));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the shorthands `fixed` and `prescribed` as constraints, before the others */
static PetscErrorCode AddShorthands(TLED tled)
{
  const TLEDParams    *p      = &tled->params;
  const PetscInt       n_own  = tled->constraints.n;
  TLEDConstraintParams params;

  PetscFunctionBegin;
  PetscCall(KeysSetDefaults(TLEDConstraintKeys, &params));
  if (p->fixed.n) {
    params.groups = p->fixed;
    PetscCall(TLEDAddConstraint(tled, "fixed", &params));
    tled->constraints.item[tled->constraints.n - 1].shorthand = PETSC_TRUE;
  }
  if (p->prescribed.n) {
    params.kind            = TLED_CONSTRAINT_MOTION;
    params.groups          = p->prescribed;
    params.course.kind     = COURSE_LINEAR;
    params.course.duration = 1.0;
    PetscCall(PetscArraycpy(params.translation, p->prescribed_velocity, 3));
    PetscCall(TLEDAddConstraint(tled, "prescribed", &params));
    tled->constraints.item[tled->constraints.n - 1].shorthand = PETSC_TRUE;
  }
  for (PetscInt k = 0; k < tled->constraints.n - n_own; k++) { /* to the front */
    const TLEDConstraint last = tled->constraints.item[tled->constraints.n - 1];
    PetscCall(PetscMemmove(&tled->constraints.item[1], &tled->constraints.item[0], (size_t)(tled->constraints.n - 1) * sizeof last));
    tled->constraints.item[0] = last;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what does not go together within a section */
static PetscErrorCode CheckConstraint(const TLEDConstraint *c)
{
  const TLEDConstraintParams *p        = &c->params;
  const PetscBool             moves    = (PetscBool)(Norm3(p->translation) > 0.0 || p->angle != 0.0);
  char                        key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
#define REFUSE(what, ...)                                                     \
  do {                                                                        \
    PetscCall(PetscSNPrintf(key, sizeof key, "%s." what, c->key));            \
    PetscFunctionReturn(InputError(key, __VA_ARGS__));                        \
  } while (0)
  if (!p->groups.n) REFUSE("groups", "names no group of the mesh\nexpected a list of physical groups");
  if (c->shorthand) PetscFunctionReturn(PETSC_SUCCESS);
  if (p->kind != TLED_CONSTRAINT_MOTION && moves) REFUSE("kind", "does not move anything\nwrite kind: motion for a translation or an angle");
  if (p->kind == TLED_CONSTRAINT_SYMMETRY && p->components.n) REFUSE("components", "is not used by a symmetry, which has the group's plane\nleave it out, or write kind: fixed");
  if (p->kind != TLED_CONSTRAINT_MOTION) PetscFunctionReturn(PETSC_SUCCESS);
  if (!moves) REFUSE("translation", "moves nothing\na motion needs a translation [m] or an angle [deg]");
  if (p->angle != 0.0 && !(Norm3(p->axis) > 0.0)) REFUSE("axis", "has no direction\na rotation needs an axis, for example [0, 0, 1], and a point of it");
  if (p->course.kind == COURSE_CONSTANT) REFUSE("course", "would jump\na motion needs a course: linear, quadratic, ramp, sine or table");
#undef REFUSE
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* unit normal of the best plane through the nodes of a group: the direction in which they spread least */
static PetscErrorCode GroupPlane(TLED tled, const TLEDConstraint *c, const TLEDGroup *group, double normal[3])
{
  const PetscReal *X = tled->mesh.X;
  PetscReal        centre[3] = {0.0, 0.0, 0.0}, spread[9] = {0}, value[3], work[16], extent = 0.0, off = 0.0;
  PetscBLASInt     three = 3, n_work = 16, info;
  char             key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < group->n_nodes; i++)
    for (int k = 0; k < 3; k++) centre[k] += X[3 * group->nodes[i] + k] / (PetscReal)group->n_nodes;
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    double r[3];
    Sub3(&X[3 * group->nodes[i]], centre, r);
    extent = PetscMax(extent, Norm3(r));
    for (int k = 0; k < 9; k++) spread[k] += r[k / 3] * r[k % 3];
  }
  LAPACKsyev_("V", "U", &three, spread, &three, value, work, &n_work, &info);
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK syev failed with info %d", (int)info);
  for (int k = 0; k < 3; k++) normal[k] = PetscAbsReal(spread[k]) < 1e-10 ? 0.0 : spread[k]; /* an axis is meant to be one */
  const double length = Norm3(normal);
  for (int k = 0; k < 3; k++) normal[k] /= length;
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    double r[3];
    Sub3(&X[3 * group->nodes[i]], centre, r);
    off = PetscMax(off, PetscAbsReal(Dot3(r, normal)));
  }
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.groups", c->key));
  if (!(value[1] > PetscSqr(PLANE * extent) * (PetscReal)group->n_nodes))
    PetscFunctionReturn(InputError(key, "names the group %s, whose nodes lie on a line\na symmetry needs a group of a plane", group->name));
  if (off > PLANE * extent)
    PetscFunctionReturn(InputError(key,
                                   "names the group %s, which is not plane: nodes lie up to %.3g m off its best plane\n"
                                   "a symmetry needs plane groups; give each plane its own group",
                                   group->name, (double)off));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* motions of all supports at time t */
void TLEDMotionsAt_Private(const TLEDConstraints *c, PetscReal t, RigidMotion motions[])
{
  for (PetscInt i = 0; i < c->n; i++) {
    const TLEDConstraintParams *p = &c->item[i].params;
    double                      g[3];
    if (p->kind != TLED_CONSTRAINT_MOTION) continue;
    CourseAt(&c->item[i].course, t, g);
    RigidMotionAt(g, p->translation, PETSC_PI / 180.0 * p->angle, c->item[i].axis, p->point, &motions[i]);
  }
}

/* a time of the course of a support, s of its own duration after its start */
static PetscReal SampleTime(const Course *c, PetscReal s)
{
  PetscReal span = c->duration;

  if (c->kind == COURSE_SINE) span = 2.0 * PETSC_PI / c->omega;
  if (c->kind == COURSE_TABLE) span = c->time[c->n - 1] - c->time[0];
  return c->start + s * (span > 0.0 ? span : 1.0);
}

/* whether a condition in direction n that follows `motion` says what those already in `h` say, at all times compared */
static PetscBool Agrees(TLED tled, const TLEDHeld *h, PetscInt node, const double n[3], int motion)
{
  TLEDConstraints *c     = &tled->constraints;
  const TLEDHeld   asked = {1, {motion, -1, -1}, {n[0], n[1], n[2]}, {n[0], n[1], n[2]}, {0}};
  PetscBool        same  = PETSC_TRUE;

  for (int j = 0; j < h->n; j++) same = (PetscBool)(same && h->motion[j] == motion);
  if (same) return PETSC_TRUE;
  for (int j = -1; j < h->n; j++) {
    const int of = j < 0 ? motion : h->motion[j];
    for (int k = -1; k < SAMPLES && of >= 0; k++) {
      double a[3], b[3];
      TLEDMotionsAt_Private(c, SampleTime(&c->item[of].course, ((PetscReal)k + 0.37) / (0.75 * SAMPLES)), c->now);
      TLEDHeldPart(h, c->now, &tled->mesh.X[3 * node], MOTION_DISPLACEMENT, a);
      TLEDHeldPart(&asked, c->now, &tled->mesh.X[3 * node], MOTION_DISPLACEMENT, b);
      if (PetscAbsReal(Dot3(n, a) - Dot3(n, b)) > AGREE * (Norm3(a) + Norm3(b))) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

static PetscErrorCode ReportConflict(TLED tled, const TLEDConstraint *c, const TLEDGroup *group, PetscInt node, const int by[3], PetscInt n)
{
  const PetscReal *x = &tled->mesh.X[3 * node];
  char             key[3 * BY_NAME_MAX], others[3 * BY_NAME_MAX + 16] = "";
  size_t           used = 0;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(key, sizeof key, c->shorthand ? "%s" : "%s.groups", c->key));
  for (PetscInt j = 0; j < n; j++) {
    if (j && by[j] == by[j - 1]) continue;
    used += (size_t)snprintf(others + used, sizeof others - used, "%s%s", j ? " and " : "", tled->constraints.item[by[j]].key);
  }
  PetscFunctionReturn(InputError(key,
                                 "names the group %s, of which node %" PetscInt_FMT " at (%g, %g, %g) m has another motion by %s\n"
                                 "a node can follow one of them only: use groups that do not touch, or other components",
                                 group->name, node, (double)x[0], (double)x[1], (double)x[2], others));
}

/* One more condition on a node: direction n follows constraint number `i`. by[] are the constraints of its conditions. */
static PetscErrorCode AddCondition(TLED tled, PetscInt node, PetscInt i, const TLEDGroup *group, const double n[3], TLEDHeld *h, int by[3])
{
  const TLEDConstraint *c      = &tled->constraints.item[i];
  const int             motion = c->params.kind == TLED_CONSTRAINT_MOTION ? (int)i : -1;
  double                inside[3], rest[3];

  PetscFunctionBegin;
  TLEDHeldClose(h);
  Mul3(h->P, n, rest);
  Sub3(n, rest, inside);
  if (Norm3(rest) < PARALLEL) {
    if (!Agrees(tled, h, node, n, motion)) ByCall(ReportConflict(tled, c, group, node, by, h->n));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int k = 0; k < 3; k++) h->normal[3 * h->n + k] = n[k];
  h->motion[h->n] = motion;
  by[h->n++]      = (int)i;
  TLEDHeldClose(h);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the directions in which constraint c holds the nodes of a group, in rows */
static PetscErrorCode Directions(TLED tled, const TLEDConstraint *c, const TLEDGroup *group, int *n, double normal[9])
{
  const Names *components = &c->params.components;

  PetscFunctionBegin;
  *n = 0;
  PetscCall(PetscArrayzero(normal, 9));
  if (c->params.kind == TLED_CONSTRAINT_SYMMETRY) {
    ByCall(GroupPlane(tled, c, group, normal));
    *n = 1;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int k = 0; k < 3; k++) {
    PetscBool in = (PetscBool)!components->n;
    for (PetscInt j = 0; j < components->n; j++) in = (PetscBool)(in || !strcmp(components->name[j], constraint_components[k]));
    if (in) normal[3 * (*n)++ + k] = 1.0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the conditions of constraint number i on its nodes; held and by hold three places a node */
static PetscErrorCode AddConditions(TLED tled, PetscInt i, TLEDHeld held[], int by[])
{
  TLEDConstraint  *c = &tled->constraints.item[i];
  const TLEDGroup *group;
  double           normal[9];
  int              n;
  char             key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(key, sizeof key, c->shorthand ? "%s" : "%s.groups", c->key));
  for (PetscInt g = 0; g < c->params.groups.n; g++) {
    ByCall(TLEDMeshNeedGroup_Private(&tled->mesh, tled->params.mesh, key, c->params.groups.name[g], 0, &group));
    ByCall(Directions(tled, c, group, &n, normal));
    for (PetscInt k = 0; k < group->n_nodes; k++) {
      const PetscInt a = group->nodes[k];
      for (int j = 0; j < n; j++) ByCall(AddCondition(tled, a, i, group, &normal[3 * j], &held[a], &by[3 * a]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* keep the held nodes only, and mark all */
static PetscErrorCode KeepHeld(TLED tled, const TLEDHeld held[])
{
  TLEDConstraints *c = &tled->constraints;
  const PetscInt   n = tled->mesh.n_nodes;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < n; a++) c->n_held += held[a].n > 0;
  PetscCall(PetscMalloc3(n, &c->held_of, c->n_held, &c->held, c->n_held, &c->node));
  c->n_held = 0;
  for (PetscInt a = 0; a < n; a++) {
    PetscBool moved = PETSC_FALSE;
    c->held_of[a]   = -1;
    if (!held[a].n) continue;
    for (int j = 0; j < held[a].n; j++) moved = (PetscBool)(moved || held[a].motion[j] >= 0);
    c->held_of[a]        = (int)c->n_held;
    c->node[c->n_held]   = a;
    c->held[c->n_held++] = held[a];
    tled->constrained[a] = PETSC_TRUE;
    tled->motion[a]      = held[a].n == 3 && !moved ? TLED_FIXED : TLED_HELD;
    c->moves             = (PetscBool)(c->moves || moved);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDConstraintsSetUp_Private - combine all constraints node by node; fills tled->motion and tled->constrained

  Conditions are taken in the order of the constraints. One whose direction lies in the span of those before must ask the same motion
  at all times (compared at SAMPLES times of each course), else it is refused with the node and both names.

  Errors: BY_ERR_INPUT, reported
*/
PetscErrorCode TLEDConstraintsSetUp_Private(TLED tled)
{
  TLEDConstraints *c    = &tled->constraints;
  PetscErrorCode   ierr = PETSC_SUCCESS;
  TLEDHeld        *held;
  int             *by;

  PetscFunctionBegin;
  PetscCall(AddShorthands(tled));
  for (PetscInt i = 0; i < c->n; i++) {
    const double length = Norm3(c->item[i].params.axis);
    ByCall(CheckConstraint(&c->item[i]));
    if (c->item[i].params.kind == TLED_CONSTRAINT_MOTION) ByCall(CourseCreate(c->item[i].key, &c->item[i].params.course, &c->item[i].course));
    for (int k = 0; k < 3; k++) c->item[i].axis[k] = length > 0.0 ? c->item[i].params.axis[k] / length : 0.0;
  }
  PetscCall(PetscCalloc1(c->n, &c->now));
  PetscCall(PetscCalloc1(c->n, &c->next));
  PetscCall(PetscCalloc2(tled->mesh.n_nodes, &held, 3 * tled->mesh.n_nodes, &by));
  for (PetscInt i = 0; i < c->n && !ierr; i++) ierr = AddConditions(tled, i, held, by);
  if (!ierr) PetscCall(KeepHeld(tled, held));
  PetscCall(PetscFree2(held, by));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDConstraintsDestroy_Private(TLEDConstraints *c)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->n; i++) PetscCall(CourseDestroy(&c->item[i].course));
  PetscCall(PetscFree(c->item));
  PetscCall(PetscFree(c->now));
  PetscCall(PetscFree(c->next));
  PetscCall(PetscFree3(c->held_of, c->held, c->node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x <- P x at every node: x (n_nodes x 3) keeps its part in the free directions */
PetscErrorCode TLEDProject_Private(TLED tled, PetscReal x[])
{
  const TLEDConstraints *c = &tled->constraints;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->n_held; i++) {
    PetscReal *at = &x[3 * c->node[i]], part[3];
    Mul3(c->held[i].P, at, part);
    PetscCall(PetscArraycpy(at, part, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The held parts Q u, Q v, Q a of the prescribed displacement [m], velocity [m/s] and acceleration [m/s^2] at time t, n_nodes x 3, zero at
   free nodes and in free directions; each may be NULL. */
PetscErrorCode TLEDPrescribed_Private(TLED tled, PetscReal t, PetscReal u[], PetscReal v[], PetscReal a[])
{
  TLEDConstraints *c      = &tled->constraints;
  PetscReal       *to[3]  = {u, v, a};

  PetscFunctionBegin;
  for (int what = 0; what < 3; what++)
    if (to[what]) PetscCall(PetscArrayzero(to[what], 3 * tled->mesh.n_nodes));
  if (!c->moves) PetscFunctionReturn(PETSC_SUCCESS);
  TLEDMotionsAt_Private(c, t, c->now);
  for (PetscInt i = 0; i < c->n_held; i++)
    for (int what = MOTION_DISPLACEMENT; what <= MOTION_ACCELERATION; what++)
      if (to[what]) TLEDHeldPart(&c->held[i], c->now, &tled->mesh.X[3 * c->node[i]], what, &to[what][3 * c->node[i]]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* projector of a node onto its free directions, 3 x 3 row-major; NULL when all are free */
const double *TLEDConstraintProjector_Private(TLED tled, PetscInt node)
{
  const TLEDConstraints *c = &tled->constraints;

  return c->held_of[node] < 0 ? NULL : c->held[c->held_of[node]].P;
}

/*@
  TLEDGetReaction - force and moment of the supports on the nodes of a group, in the current state

  Input Parameters:
+ tled  - the body, set up
- group - physical group of the mesh

  Output Parameters:
+ force  - [N], 3
- moment - about the origin, at the current positions [N m], 3; may be NULL

  Equation:
  r_a = Q_a (m_a a_a + f_int,a - f_ext,a - m_a g),   force = sum_a r_a,   moment = sum_a x_a x r_a
  over the held nodes of the group, with the acceleration a_a of the prescribed motion; after a static solution (TLEDSetStatic()) without
  it. A node that two groups share counts in both. Stiffness damping is not in f_int here.

  Errors: BY_ERR_INPUT, reported, when the mesh has no such group; BY_ERR_BREAKDOWN when an element is inverted
  Tests: tests/unit/tled/test_constraint.c

.seealso: TLEDAddConstraint()
@*/
PetscErrorCode TLEDGetReaction(TLED tled, const char name[], PetscReal force[3], PetscReal moment[3])
{
  TLEDConstraints *c = &tled->constraints;
  const TLEDGroup *group;
  const PetscReal *u;
  PetscReal       *f_int = tled->trial, *f_ext = tled->probe;
  PetscErrorCode   ierr;
  PetscReal        sum[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

  PetscFunctionBegin;
  PetscCheck(tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDSetUp() comes before TLEDGetReaction()");
  ByCall(TLEDMeshNeedGroup_Private(&tled->mesh, tled->params.mesh, ((PetscObject)tled)->name, name, 0, &group));
  PetscCall(VecGetArrayRead(tled->u, &u));
  ierr = TLEDForces_Private(tled, u, f_int);
  if (ierr == BY_ERR_BREAKDOWN) ierr = TLEDReportBroken_Private(tled, u, tled->state.time);
  if (!ierr) ierr = TLEDExternalForces_Private(tled, tled->state.time, u, f_ext);
  TLEDMotionsAt_Private(c, tled->state.time, c->now);
  for (PetscInt i = 0; i < group->n_nodes && !ierr; i++) {
    const PetscInt a = group->nodes[i];
    PetscReal      r[3], free_r[3], x[3], m[3], held_a[3] = {0.0, 0.0, 0.0};
    if (c->held_of[a] < 0) continue;
    const TLEDHeld *h = &c->held[c->held_of[a]];
    Sub3(&f_int[3 * a], &f_ext[3 * a], r);
    Mul3(h->P, r, free_r);
    if (!(tled->state.is_static > 0.0)) TLEDHeldPart(h, c->now, &tled->mesh.X[3 * a], MOTION_ACCELERATION, held_a);
    for (int k = 0; k < 3; k++) {
      r[k] += tled->mass[a] * held_a[k] - free_r[k];
      x[k] = tled->mesh.X[3 * a + k] + u[3 * a + k];
    }
    Cross3(x, r, m);
    for (int k = 0; k < 3; k++) sum[k] += r[k], sum[3 + k] += m[k];
  }
  PetscCall(VecRestoreArrayRead(tled->u, &u));
  ByCall(ierr);
  PetscCall(PetscArraycpy(force, sum, 3));
  if (moment) PetscCall(PetscArraycpy(moment, &sum[3], 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}
