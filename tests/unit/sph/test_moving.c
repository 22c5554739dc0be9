/* walls and tanks that move by prescription: pistons, lids, frames (method 2) */
#include "fluid.h"
#include "mat3.h"

#include <string.h>

#include "sph/sph_impl.h"

static Motion MakeMotion(int kind, PetscReal duration, const PetscReal translation[3], PetscReal degrees, const PetscReal axis[3])
{
  MotionParams params = {.course = {.kind = kind, .duration = duration}, .angle = degrees};
  Motion       motion;

  for (int k = 0; k < 3; k++) {
    params.translation[k] = translation ? translation[k] : 0.0;
    params.axis[k]        = axis ? axis[k] : 0.0;
    params.point[k]       = 0.1 * k;
  }
  assert_petsc(MotionCreate("test", &params, &motion));
  return motion;
}

static PetscReal Total(SPH sph) { return sph->mass * (PetscReal)sph->n; }

/* A column stands on the plane behind it, which pushes it up against gravity, a = 2 m/s^2: the piston carries m (g + a), and the column moves with
   it as one: relative velocities are those of settling water, which fade. The piston is where its course says, and its work is the energy gained. */
static void PistonPushesColumnRigidly(void **state)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {1, 0.06, 0.06}, g[3] = {-9.81, 0, 0}, a = 2.0, dt = 1e-3, along[3] = {0.5 * a, 0.3, 0.0};
  const int       rest = 300, steps = 200;
  SPH             sph   = NewFluid(0.01);
  Motion          push  = MakeMotion(COURSE_QUADRATIC, 1.0, along, 0.0, NULL);
  SPHStats        start, end;
  PetscReal       force = 0.0, speed = a * dt * (steps - 0.5), relative = 0.0, weight;

  (void)state;
  push.course.start = rest * dt;
  assert_petsc(SPHSetDomain(sph, lo, hi, 1, 6));
  assert_petsc(SPHSetGravity(sph, g));
  assert_petsc(SPHSetWallMotion(sph, 1, &push));
  AddLattice(sph, 8, 6, 6, 0.01, 0.0, NULL);
  assert_petsc(SPHSetUp(sph));
  weight = Total(sph) * 9.81;
  for (int s = 0; s < rest; s++) OneStep(sph, dt);
  assert_petsc(SPHGetStats(sph, &start));
  for (int s = 0; s < steps; s++) {
    OneStep(sph, dt);
    if (s > 0) force += sph->wall_force[0] / (steps - 1); // the first step starts within the course's corner
  }
  assert_close(sph->plane[0], 0.5 * a * PetscSqr(steps * dt), 1e-12, 1.0);
  assert_petsc(SPHGetStats(sph, &end));
  assert_close(force, -weight * (9.81 + a) / 9.81, 0.005, weight);
  assert_close(end.momentum[0], Total(sph) * speed, 0.01, Total(sph) * speed);
  for (int i = 0; i < sph->n; i++) relative += PetscSqr(sph->v[3 * i] - speed) / (PetscReal)sph->n;
  assert_true(sqrt(relative) < start.speed_rms);
  assert_close(end.kinetic + end.potential - start.kinetic - start.potential, end.wall_work, 0.02, end.wall_work);
  assert_petsc(SPHDestroy(&sph));
}

/* A particle on which nothing acts goes straight in the laboratory while its tank turns and shifts: X = p + R (x - p) + t is X0 + V0 t; with equal
   steps to round-off. Its kinetic energy as seen from the tank grows by the work of the tank's motion. */
static void FreeParticleGoesStraightInTheLaboratory(void **state)
{
  const PetscReal lo[3] = {-9, -9, -9}, hi[3] = {9, 9, 9}, t[3] = {0.3, -0.1, 0.2}, axis[3] = {1, 2, -1}, x0[3] = {0.2, 0.1, -0.3}, v0[3] = {0.1, 0.4, 0.2}, dt = 0.01;
  SPH             sph  = NewFluid(0.01);
  Motion          tank = MakeMotion(COURSE_QUADRATIC, 1.0, t, 90.0, axis);
  RigidMotion     at;
  PetscReal       X[3], start[3], V[3], moved[3];
  SPHStats        stats;

  (void)state;
  tank.course.start = -1.0; // it moves already
  assert_petsc(SPHSetDomain(sph, lo, hi, 0, 0));
  assert_petsc(SPHSetFrame(sph, &tank));
  assert_petsc(SPHAddParticles(sph, 1, x0, v0));
  assert_petsc(SPHSetUp(sph));
  for (int s = 0; s < 100; s++) {
    OneStep(sph, dt);
    MotionAt(&tank, sph->time, &at);
    RigidMotionOf(&at, sph->x, MOTION_DISPLACEMENT, moved);
    for (int k = 0; k < 3; k++) {
      const PetscReal now = sph->x[k] + moved[k];
      if (s == 0) start[k] = now;
      if (s == 1) V[k] = (now - start[k]) / dt;
      if (s > 1) assert_close(now, start[k] + s * dt * V[k], 1e-12, 1.0);
      X[k] = now;
    }
  }
  assert_true(fabs(X[0] - start[0]) + fabs(X[1] - start[1]) > 0.1); // it did move
  assert_petsc(SPHGetStats(sph, &stats));
  assert_close(stats.kinetic - 0.5 * sph->mass * Dot3(v0, v0), stats.frame_work, 1e-12, stats.kinetic);
  assert_petsc(SPHDestroy(&sph));
}

/* a box of still water, walls on all sides but the top, accelerated sideways: by its walls, or as a frame */
static SPH PushedTank(const Motion *walls, const Motion *frame)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.08, 0.06, 0.2}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(0.01);

  sph->params.tolerance = 1e-9;
  assert_petsc(SPHSetDomain(sph, lo, hi, 19, 2));
  assert_petsc(SPHSetGravity(sph, g));
  if (walls) assert_petsc(SPHSetWallMotion(sph, 19, walls));
  if (frame) assert_petsc(SPHSetFrame(sph, frame));
  AddLattice(sph, 8, 6, 6, 0.01, 0.05, NULL);
  assert_petsc(SPHSetUp(sph));
  return sph;
}

/* The forces on the walls are the same whether the walls move or the tank is the frame: the two discrete schemes are the same up to the
   tolerance of the pressure solve, which a bounded run amplifies. The floor carries the weight, the walls push with m a. */
static void FrameAndMovingWallsGiveTheSameForces(void **state)
{
  const PetscReal a = 2.0, dt = 1e-3, along[3] = {0.5 * a, 0.0, 0.0};
  Motion          push = MakeMotion(COURSE_QUADRATIC, 1.0, along, 0.0, NULL);
  SPH             by_walls = PushedTank(&push, NULL), by_frame = PushedTank(NULL, &push);
  const PetscReal weight = Total(by_walls) * 9.81;
  SPHStats        walls, frame;

  (void)state;
  for (int s = 0; s < 40; s++) {
    OneStep(by_walls, dt);
    OneStep(by_frame, dt);
    for (int k = 0; k < 18; k++) assert_close(by_walls->wall_force[k], by_frame->wall_force[k], 1e-4, weight);
  }
  assert_petsc(SPHGetStats(by_walls, &walls));
  assert_petsc(SPHGetStats(by_frame, &frame));
  // the tank has the speed a t of its last mean, 39.5 steps
  assert_close(walls.momentum[0] - Total(by_walls) * a * 39.5 * dt, frame.momentum[0], 1e-4, Total(by_walls) * a * 40 * dt);
  assert_petsc(SPHDestroy(&by_walls));
  assert_petsc(SPHDestroy(&by_frame));
}

/* planes of one axis have nothing of a kernel in common: between two planes half a support apart their parts add */
static void PlanesOfOneAxisAdd(void **state)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {1, 1, 0.01}, x[3] = {0.5, 0.5, 0.005};
  SPH             sph = NewFluid(0.01);

  (void)state;
  assert_petsc(SPHSetDomain(sph, lo, hi, 48, 0));
  assert_petsc(SPHAddParticles(sph, 1, x, NULL));
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_close(sph->open[0], 1.0 - 2.0 * sph->wall_factor * SPHHalfSpace(sph->params.kernel, 0.005, sph->h), 1e-15, 1.0);
  assert_close(sph->G[2], 0.0, 1e-12, sph->params.density / sph->h);
  assert_petsc(SPHDestroy(&sph));
}

/* A floor that slides under a viscous layer gives it momentum and energy at the rate of its drag; one that slips gives nothing. Stokes' first
   problem: after t a layer of depth 2 sqrt(nu t/pi) has the floor's speed; resolved by 2.3 spacings, within 10 %. */
static void FloorDragsWhatDoesNotSlip(void **state)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.06, 0.06, 0.2}, g[3] = {0, 0, -9.81}, U[3] = {0.1, 0, 0}, dt = 2e-3;
  const int       steps = 20;

  (void)state;
  for (int slip = 0; slip < 2; slip++) {
    SPH       sph   = NewFluid(0.01);
    Motion    slide = MakeMotion(COURSE_LINEAR, 1.0, U, 0.0, NULL);
    SPHStats  start, end;
    PetscReal impulse = 0.0, gained;

    sph->params.viscosity = 10.0;
    assert_petsc(SPHSetDomain(sph, lo, hi, 16, 3));
    assert_petsc(SPHSetGravity(sph, g));
    assert_petsc(SPHSetWallMotion(sph, 16, &slide));
    assert_petsc(SPHSetSlip(sph, slip ? 16 : 0));
    slide.course.start = 100 * dt;
    AddLattice(sph, 6, 6, 8, 0.01, 0.02, NULL);
    assert_petsc(SPHSetUp(sph));
    for (int s = 0; s < 100; s++) OneStep(sph, dt);
    assert_petsc(SPHGetStats(sph, &start));
    for (int s = 0; s < steps; s++) {
      OneStep(sph, dt);
      impulse -= dt * sph->wall_force[12];
    }
    assert_petsc(SPHGetStats(sph, &end));
    gained = end.kinetic + end.potential + end.viscous_loss - start.kinetic - start.potential - start.viscous_loss;
    // the drag is measured after the noise filter, which it does not see
    assert_close(end.momentum[0] - start.momentum[0], impulse, 1e-3, Total(sph) * U[0]);
    assert_close(impulse, slip ? 0.0 : Total(sph) * U[0] * 2.0 * sqrt(0.01 * steps * dt / PETSC_PI) / 0.08, 0.1, Total(sph) * U[0] * 0.28);
    assert_close(gained, end.wall_work, 0.1, Total(sph) * U[0] * U[0]);
    assert_petsc(SPHDestroy(&sph));
  }
}

/* Water pressed where there is no room for it ends the run, and the message says why: between two plates that close on each other, open at the
   sides, and under the lid of a full box. */
static void PressedWaterEndsTheRunWithTheReason(void **state)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.04, 0.04, 0.04}, down[3] = {0, 0, -0.04};

  (void)state;
  for (int box = 0; box < 2; box++) {
    SPH            sph = NewFluid(0.01);
    Motion         lid = MakeMotion(COURSE_LINEAR, 0.04, down, 0.0, NULL);
    PetscErrorCode ierr = 0;

    assert_petsc(SPHSetDomain(sph, lo, hi, box ? 63 : 48, 0));
    assert_petsc(SPHSetWallMotion(sph, 32, &lid));
    AddLattice(sph, 4, 4, 4, 0.01, 0.01, NULL);
    assert_petsc(SPHSetUp(sph));
    for (int s = 0; s < 2000 && !ierr; s++) {
      PetscReal dt;

      assert_petsc(SPHUpdateNeighbors(sph));
      assert_petsc(SPHGetTimeStep(sph, &dt));
      assert_petsc(SPHPredict(sph, dt));
      ierr = SPHSolvePressure(sph, dt, NULL, NULL);
      if (!ierr) ierr = SPHAdvance(sph, dt);
    }
    assert_int_equal((int)ierr, (int)BY_ERR_BREAKDOWN);
    assert_non_null(strstr(sph->breakdown, box ? "has no room" : "closed to"));
    assert_petsc(SPHDestroy(&sph));
  }
}

/* A tank that has always been accelerated sideways is one in which gravity is tilted: the same particles at the same places. */
static void AcceleratedTankIsTiltedGravity(void **state)
{
  const PetscReal a = 2.0, dt = 1e-3, along[3] = {0.5 * a, 0.0, 0.0}, tilted[3] = {-a, 0.0, -9.81};
  Motion          push = MakeMotion(COURSE_QUADRATIC, 1.0, along, 0.0, NULL);
  SPH             frame = PushedTank(NULL, &push), still = PushedTank(NULL, NULL);

  (void)state;
  push.course.start = -1.0;
  assert_petsc(SPHSetGravity(still, tilted));
  still->filter_rate = frame->filter_rate; // both of gravity as the laboratory has it
  still->relax_time  = frame->relax_time;
  for (int s = 0; s < 20; s++) {
    OneStep(frame, dt);
    OneStep(still, dt);
    for (int k = 0; k < 18; k++) assert_close(frame->wall_force[k], still->wall_force[k], 1e-6, Total(still) * 9.81);
  }
  assert_petsc(SPHDestroy(&frame));
  assert_petsc(SPHDestroy(&still));
}

CHECK_MAIN(cmocka_unit_test(PistonPushesColumnRigidly), cmocka_unit_test(FreeParticleGoesStraightInTheLaboratory),
           cmocka_unit_test(FrameAndMovingWallsGiveTheSameForces), cmocka_unit_test(PlanesOfOneAxisAdd), cmocka_unit_test(FloorDragsWhatDoesNotSlip),
           cmocka_unit_test(PressedWaterEndsTheRunWithTheReason), cmocka_unit_test(AcceleratedTankIsTiltedGravity))
