/* surfaces that touch the fluid, given as src/proxy gives them: here a floor of a few proxies that is the plane z = 0 exactly */
#include "floor.h"

#include "mat3.h"

static SPH Water(unsigned walls, PetscReal viscosity)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.05, 0.05, 0.2}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(0.01);

  sph->params.viscosity = viscosity;
  sph->params.tolerance = 1e-11; // what the solver leaves is not compared
  assert_petsc(SPHSetDomain(sph, lo, hi, walls, 0));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, 5, 5, 7, 0.01, 0.1, NULL);
  assert_petsc(SPHSetUp(sph));
  return sph;
}

/* a floor of proxies does what the plane does, with friction and in the corners with walls, until a particle comes so near that the plane stops
   it (at proxies the coupler does) */
static void FloorOfProxiesIsThePlane(void **state)
{
  SPH       a = Water(31, 1.0), b = Water(15, 1.0);
  Floor     floor;
  PetscReal forces[18], other[18];

  (void)state;
  for (int s = 0; s < 2; s++) {
    OneStep(a, 2e-4);
    assert_petsc(SPHUpdateNeighbors(b));
    Touch(b, 2, &floor);
    assert_petsc(SPHSetContacts(b, 1, &floor.contacts));
    assert_petsc(SPHPredict(b, 2e-4));
    assert_petsc(SPHSolvePressure(b, 2e-4, NULL, NULL));
    assert_petsc(SPHGetForces(b));
    assert_petsc(SPHAdvance(b, 2e-4));
  }
  for (int i = 0; i < 3 * 175; i++) assert_close(a->x[i], b->x[i], 1e-8, 0.01); // the distance from lambda is found to 1e-6 h
  assert_petsc(SPHGetWallForces(a, forces));
  assert_petsc(SPHGetWallForces(b, other));
  for (int k = 0; k < 3; k++) assert_close(floor.contacts.total[k], forces[12 + k], 1e-4, forces[14]);
  for (int k = 0; k < 12; k++) assert_close(other[k], forces[k], 1e-4, forces[14]);
  assert_petsc(SPHDestroy(&a));
  assert_petsc(SPHDestroy(&b));
}

/* two surfaces that cross and one plane: union factors are the products of what the others leave open, the gradient is theirs */
static void SurfacesMergeAsTheirUnion(void **state)
{
  SPH              sph = Water(4, 0.0);
  Floor            floor[2];
  SPHContacts      contacts[2];
  const PetscReal *c[2];

  (void)state;
  assert_petsc(SPHUpdateNeighbors(sph));
  Touch(sph, 2, &floor[0]);
  Touch(sph, 0, &floor[1]);
  contacts[0] = floor[0].contacts;
  contacts[1] = floor[1].contacts;
  assert_petsc(SPHSetContacts(sph, 2, contacts));
  assert_petsc(SPHSetContacts(sph, 2, contacts)); // twice is once
  assert_petsc(SPHGetUnionFactors(sph, 0, &c[0]));
  assert_petsc(SPHGetUnionFactors(sph, 1, &c[1]));
  for (PetscInt i = 0; i < sph->n; i++) {
    const PetscReal s = sph->wall_factor, *x = sph->x + 3 * i;
    PetscReal       open[3], slope[3];

    for (int k = 0; k < 3; k++) {
      open[k]  = 1.0 - s * SPHHalfSpace(0, x[k], sph->h);
      slope[k] = s * SPHHalfSpaceSlope(0, x[k], sph->h);
    }
    assert_close(sph->open[i], open[0] * open[1] * open[2], 1e-12, 1.0);
    for (int k = 0; k < 3; k++) assert_close(sph->G[3 * i + k], RHO0 * slope[k] * open[(k + 1) % 3] * open[(k + 2) % 3], 1e-10, RHO0 / sph->h);
  }
  for (PetscInt t = 0; t < contacts[1].n_touched; t++) {
    const PetscReal *x = sph->x + 3 * contacts[1].particle[t];
    assert_close(c[1][t], (1.0 - sph->wall_factor * SPHHalfSpace(0, x[1], sph->h)) * (1.0 - sph->wall_factor * SPHHalfSpace(0, x[2], sph->h)), 1e-12, 1.0);
  }
  assert_petsc(SPHDestroy(&sph));
}

/* what the fluid gains the proxies lose: impulse over a step, moment about the origin, power */
static void ReactionEqualsAction(void **state)
{
  const PetscReal dt = 1e-3;
  SPH             sph = Water(0, 0.7);
  Floor           floor;
  SPHStats        before, after;
  PetscReal       sum[3] = {0, 0, 0}, power = 0.0, weight, x_sum[3] = {0, 0, 0}, weight_moment[3];

  (void)state;
  assert_petsc(SPHUpdateNeighbors(sph));
  Touch(sph, 2, &floor);
  for (int b = 0; b < 4; b++) {
    floor.velocity[3 * b]     = 0.3 * b;
    floor.velocity[3 * b + 2] = 0.5;
  }
  assert_petsc(SPHSetContacts(sph, 1, &floor.contacts));
  assert_petsc(SPHPredict(sph, dt));
  assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
  assert_petsc(SPHGetForces(sph));
  assert_petsc(SPHGetStats(sph, &before));
  for (PetscInt i = 0; i < sph->n; i++)
    for (int k = 0; k < 3; k++) x_sum[k] += sph->mass * sph->x[3 * i + k];
  assert_petsc(SPHAdvance(sph, dt));

  // angular momentum with the velocities after the step and the positions before it
  PetscReal angular[3] = {0, 0, 0};
  assert_petsc(SPHGetStats(sph, &after));
  for (PetscInt i = 0; i < sph->n; i++) {
    const PetscReal *v = sph->v + 3 * i;
    PetscReal        x[3], c[3];
    for (int k = 0; k < 3; k++) x[k] = sph->x[3 * i + k] - dt * v[k];
    Cross3(x, v, c);
    for (int k = 0; k < 3; k++) angular[k] += sph->mass * c[k];
  }
  Cross3(x_sum, sph->gravity, weight_moment);
  weight = sph->mass * (PetscReal)sph->n * 9.81;
  for (int b = 0; b < 4; b++) {
    for (int k = 0; k < 3; k++) sum[k] += floor.force[3 * b + k];
    power += Dot3(floor.force + 3 * b, floor.velocity + 3 * b);
  }
  assert_true(PetscAbsReal(sum[2]) > weight); // the floor pushes hard: a real load
  for (int k = 0; k < 3; k++) {
    const PetscReal gravity = k == 2 ? -weight : 0.0;
    assert_close(floor.contacts.total[k], sum[k], 1e-12, weight);
    assert_close((after.momentum[k] - before.momentum[k]) / dt, gravity - sum[k], 1e-10, PetscAbsReal(sum[2]));
    assert_close((angular[k] - before.angular[k]) / dt, weight_moment[k] - floor.contacts.moment[k], 1e-10, PetscAbsReal(sum[2]) * 0.05);
  }
  assert_close(floor.contacts.power, power, 1e-12, power);
  assert_petsc(SPHDestroy(&sph));
}

/* new velocities between two solves of one step: the fluid follows the wall */
static void VelocitiesAreReadAtTheSolve(void **state)
{
  const PetscReal dt = 1e-3;
  SPH             sph = Water(15, 0.0);
  Floor           floor;
  PetscReal       rest, moving;

  (void)state;
  assert_petsc(SPHUpdateNeighbors(sph));
  Touch(sph, 2, &floor);
  assert_petsc(SPHSetContacts(sph, 1, &floor.contacts));
  assert_petsc(SPHPredict(sph, dt));
  assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
  assert_petsc(SPHGetForces(sph));
  rest = floor.contacts.total[2];
  for (int b = 0; b < 4; b++) floor.velocity[3 * b + 2] = 0.1;
  assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
  assert_petsc(SPHGetForces(sph));
  moving = floor.contacts.total[2];
  // to speed the whole column up to 0.1 m/s in a step takes ten times its weight; the loose top does not follow at once
  assert_true(rest - moving > 175 * sph->mass * 9.81 && rest - moving < 10.5 * 175 * sph->mass * 9.81);
  for (int b = 0; b < 4; b++) floor.velocity[3 * b + 2] = 0.0;
  assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
  assert_petsc(SPHGetForces(sph));
  assert_close(floor.contacts.total[2], rest, 5e-3, rest); // both to the tolerance of the solve
  assert_petsc(SPHDestroy(&sph));
}

CHECK_MAIN(cmocka_unit_test(FloorOfProxiesIsThePlane), cmocka_unit_test(SurfacesMergeAsTheirUnion), cmocka_unit_test(ReactionEqualsAction),
           cmocka_unit_test(VelocitiesAreReadAtTheSolve))
