/* coupler_motion.c - what a scene moves by prescription: walls of the domain, obstacles, the whole tank (motion.h). Obstacles are placed from
   the coupler's clock at the start of every step, so that a restart finds them at the same bits; the fluid sees their mean velocity over the
   step and meets them where they end it. */
#include "coupler_impl.h"

static const char *const sides[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};

static PetscBool Has(const Names *names, const char name[])
{
  PetscBool same = PETSC_FALSE;

  for (PetscInt k = 0; k < names->n && !same; k++) (void)PetscStrcmp(names->name[k], name, &same);
  return same;
}

/* whether the options have anything of a motion's section */
static PetscErrorCode HasMotion(const char prefix[], PetscBool *has)
{
  char name[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  *has = PETSC_FALSE;
  for (const Key *key = MotionKeys; key->name && !*has; key++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "-%s%s", prefix, key->name));
    PetscCall(PetscOptionsHasName(NULL, NULL, name, has));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one section of domain.moving */
static PetscErrorCode MoveWall(Coupler c, const char name[], const DomainParams *domain, unsigned *moved)
{
  WallMotionParams params;
  MotionParams     motion = {0};
  char             prefix[2 * BY_NAME_MAX], section[2 * BY_NAME_MAX], key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "domain_%s_", name));
  PetscCall(PetscSNPrintf(section, sizeof(section), "domain.%s", name));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.walls", section));
  PetscCall(KeysSetDefaults(WallMotionKeys, &params));
  PetscCall(KeysSetFromOptions(WallMotionKeys, prefix, &params));
  PetscCall(PetscArraycpy(motion.translation, params.translation, 3));
  motion.course = params.course;
  if (!params.walls.n) PetscFunctionReturn(InputError(key, "names no wall that moves\nexpected some of domain.walls"));
  ByCall(MotionCreate(section, &motion, &c->wall_motion[c->n_wall_motions]));
  for (int k = 0; k < 6; k++) {
    if (!Has(&params.walls, sides[k])) continue;
    if (!Has(&domain->walls, sides[k])) PetscFunctionReturn(InputError(key, "has %s, which is not a wall\nname it in domain.walls", sides[k]));
    if (*moved >> k & 1) PetscFunctionReturn(InputError(key, "has %s, which another section moves already", sides[k]));
    *moved |= 1u << k;
    PetscCall(SPHSetWallMotion(c->sph, 1u << k, &c->wall_motion[c->n_wall_motions]));
  }
  c->n_wall_motions++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the tank as a frame; bodies would need its forces too */
static PetscErrorCode SetFrame(Coupler c, const DomainParams *domain)
{
  static const char *const axes[] = {"x", "y", "z"};
  MotionSection            params;
  PetscBool                has;

  PetscFunctionBegin;
  PetscCall(HasMotion("frame_", &has));
  if (!has) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KeysSetDefaults(MotionKeys, &params));
  PetscCall(KeysSetFromOptions(MotionKeys, "frame_", &params));
  if (c->n_bodies) PetscFunctionReturn(InputError("bodies", "cannot be in a tank that moves: elastic bodies do not feel a frame's acceleration\nleave out the section frame, or move walls and obstacles instead"));
  ByCall(MotionCreate("frame", &params.motion, &c->frame));
  for (int k = 0; k < 3; k++) {
    const PetscBool turns = (PetscBool)(c->frame.angle != 0.0 && PetscAbsReal(c->frame.axis[k]) < 1.0 - 1e-12);

    if (turns && Has(&domain->periodic, axes[k]))
      PetscFunctionReturn(InputError("domain.periodic", "has %s, which a tank that turns does not keep\nonly the axis of rotation can be periodic", axes[k]));
  }
  PetscCall(SPHSetFrame(c->sph, &c->frame));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* walls that slip, walls that move, the tank that moves: what the scene says of the domain */
PetscErrorCode CouplerMoveDomain(Coupler c, const DomainParams *domain)
{
  unsigned slip = 0, moved = 0;

  PetscFunctionBegin;
  for (int k = 0; k < 6; k++) {
    if (!Has(&domain->slip, sides[k])) continue;
    if (!Has(&domain->walls, sides[k])) PetscFunctionReturn(InputError("domain.slip", "has %s, which is not a wall\nname it in domain.walls", sides[k]));
    slip |= 1u << k;
  }
  PetscCall(SPHSetSlip(c->sph, slip));
  if (domain->moving.n > 6) PetscFunctionReturn(InputError("domain.moving", "has more names than a box has walls"));
  for (PetscInt k = 0; k < domain->moving.n; k++) ByCall(MoveWall(c, domain->moving.name[k], domain, &moved));
  ByCall(SetFrame(c, domain));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a wall or an obstacle with which a body is in contact stays at rest */
PetscErrorCode CouplerRefuseMoving(const char key[], const char with[], const DomainParams *domain)
{
  char      prefix[2 * BY_NAME_MAX];
  PetscBool has;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < domain->moving.n; k++) {
    WallMotionParams params;

    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "domain_%s_", domain->moving.name[k]));
    PetscCall(KeysSetDefaults(WallMotionKeys, &params));
    PetscCall(KeysSetFromOptions(WallMotionKeys, prefix, &params));
    if (Has(&params.walls, with)) PetscFunctionReturn(InputError(key, "has %s, which domain.%s moves\ncontact needs walls at rest", with, domain->moving.name[k]));
  }
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_motion_", with));
  PetscCall(HasMotion(prefix, &has));
  if (has) PetscFunctionReturn(InputError(key, "has %s, which moves\ncontact needs obstacles at rest", with));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* walls at rest from which an obstacle never parts: bits of SPHSetDomain */
PetscErrorCode CouplerSealedWalls(const char obstacle[], const DomainParams *domain, unsigned *walls)
{
  MotionSection params;
  char          prefix[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_motion_", obstacle));
  PetscCall(KeysSetDefaults(MotionKeys, &params));
  PetscCall(KeysSetFromOptions(MotionKeys, prefix, &params));
  *walls = 0;
  for (int k = 0; k < 6; k++) {
    const PetscReal *axis = params.motion.axis, across = Norm3(axis) - PetscAbsReal(axis[k / 2]);

    if (Has(&domain->walls, sides[k]) && params.motion.translation[k / 2] == 0.0 && !(params.motion.angle != 0.0 && across > 0.0)) *walls |= 1u << k;
  }
  for (PetscInt m = 0; m < domain->moving.n; m++) {
    WallMotionParams moving;

    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "domain_%s_", domain->moving.name[m]));
    PetscCall(KeysSetDefaults(WallMotionKeys, &moving));
    PetscCall(KeysSetFromOptions(WallMotionKeys, prefix, &moving));
    for (int k = 0; k < 6; k++)
      if (Has(&moving.walls, sides[k])) *walls &= ~(1u << k);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerSetObstacleMotion - let an obstacle move as a rigid body

  Input Parameters:
+ c        - the coupler
. obstacle - its number, counting bodies first
- motion   - taken over; it is destroyed with the coupler

.seealso: CouplerAddObstacle()
@*/
PetscErrorCode CouplerSetObstacleMotion(Coupler c, PetscInt obstacle, const Motion *motion)
{
  CouplerSurface *s = &c->surface[obstacle];

  PetscFunctionBegin;
  PetscCheck(obstacle >= c->n_bodies && obstacle < c->n_surfaces, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%" PetscInt_FMT " is not an obstacle", obstacle);
  PetscCheck(!s->moves, PETSC_COMM_SELF, PETSC_ERR_ORDER, "%s moves already", s->name);
  s->moves  = PETSC_TRUE;
  s->motion = *motion;
  PetscCall(PetscCalloc3(3 * s->n_nodes, &s->x_rest, 3 * s->n_nodes, &s->x_next, 3 * s->n_nodes, &s->v_nodes));
  PetscCall(PetscArraycpy(s->x_rest, s->x, 3 * s->n_nodes));
  PetscCall(CouplerPlaceObstacles(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* motion and slip of an obstacle as its sections say */
PetscErrorCode CouplerReadObstacleMotion(Coupler c, PetscInt obstacle, PetscBool slip)
{
  CouplerSurface *s = &c->surface[obstacle];
  MotionSection   params;
  Motion          motion;
  char            prefix[2 * BY_NAME_MAX], section[2 * BY_NAME_MAX];
  PetscBool       has;

  PetscFunctionBegin;
  s->slip = slip;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_motion_", s->name));
  PetscCall(PetscSNPrintf(section, sizeof(section), "%s.motion", s->name));
  PetscCall(HasMotion(prefix, &has));
  if (!has) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KeysSetDefaults(MotionKeys, &params));
  PetscCall(KeysSetFromOptions(MotionKeys, prefix, &params));
  ByCall(MotionCreate(section, &params.motion, &motion));
  PetscCall(CouplerSetObstacleMotion(c, obstacle, &motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PlacedAt(const CouplerSurface *s, PetscReal time, PetscReal x[])
{
  RigidMotion at;

  MotionAt(&s->motion, time, &at);
  for (PetscInt a = 0; a < s->n_nodes; a++) {
    PetscReal moved[3];

    RigidMotionOf(&at, s->x_rest + 3 * a, MOTION_DISPLACEMENT, moved);
    for (int i = 0; i < 3; i++) x[3 * a + i] = s->x_rest[3 * a + i] + moved[i];
  }
}

/* obstacles that move are where the clock says, at rest */
PetscErrorCode CouplerPlaceObstacles(Coupler c)
{
  PetscFunctionBegin;
  for (PetscInt k = c->n_bodies; k < c->n_surfaces; k++) {
    CouplerSurface *s = &c->surface[k];

    if (!s->moves) continue;
    PlacedAt(s, c->time, s->x);
    PetscCall(PetscArraycpy(s->x_next, s->x, 3 * s->n_nodes));
    PetscCall(PetscArrayzero(s->v_nodes, 3 * s->n_nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* where they end the coming step, and their mean velocities over it */
PetscErrorCode CouplerMoveObstacles(Coupler c, PetscReal dt)
{
  PetscFunctionBegin;
  for (PetscInt k = c->n_bodies; k < c->n_surfaces; k++) {
    CouplerSurface *s = &c->surface[k];

    if (!s->moves) continue;
    PlacedAt(s, c->time, s->x);
    PlacedAt(s, c->time + dt, s->x_next);
    s->power = 0.0;
    for (PetscInt i = 0; i < 3 * s->n_nodes; i++) s->v_nodes[i] = (s->x_next[i] - s->x[i]) / dt;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the end of a step: obstacles arrive; the work that the fluid did on them, where it stopped at them included */
PetscErrorCode CouplerArriveObstacles(Coupler c, PetscReal dt)
{
  PetscFunctionBegin;
  for (PetscInt k = c->n_bodies; k < c->n_surfaces; k++) {
    CouplerSurface *s = &c->surface[k];

    if (!s->moves) continue;
    s->power += c->contacts[k].power;
    s->work_fluid += dt * s->power;
    s->work_solid += dt * s->power;
    PetscCall(PetscArraycpy(s->x, s->x_next, 3 * s->n_nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* no node of a surface moves farther in a step than the fluid's particles may; of bodies as they moved in the last one */
PetscErrorCode CouplerLimitStep(Coupler c, PetscReal *dt)
{
  SPHParams *params;
  PetscReal  speed2 = 0.0;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(c->sph, &params));
  if (params->time_step > 0.0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    const CouplerSurface *s = &c->surface[k];

    for (PetscInt j = 0; j < s->n_interface; j++) speed2 = PetscMax(speed2, Dot3(s->mean_velocity + 3 * s->interface[j], s->mean_velocity + 3 * s->interface[j]));
  }
  if (speed2 > 0.0) *dt = PetscMin(*dt, params->cfl * params->spacing / PetscSqrtReal(speed2));
  for (PetscInt k = c->n_bodies; k < c->n_surfaces; k++) {
    CouplerSurface *s       = &c->surface[k];
    PetscReal       fastest = 0.0;
    RigidMotion     at;

    if (!s->moves) continue;
    MotionAt(&s->motion, c->time, &at);
    for (PetscInt a = 0; a < s->n_nodes; a++) {
      PetscReal v[3];

      RigidMotionOf(&at, s->x_rest + 3 * a, MOTION_VELOCITY, v);
      fastest = PetscMax(fastest, Dot3(v, v));
    }
    if (fastest > 0.0) *dt = PetscMin(*dt, params->cfl * params->spacing / PetscSqrtReal(fastest));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
