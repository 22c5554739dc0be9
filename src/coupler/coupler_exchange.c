/* coupler_exchange.c - what passes between fluid and bodies in a step: the velocity of the walls, forces on the nodes, the bodies' way under
   them, and the work of both sides (method 5.1, 5.4). */
#include "coupler_impl.h"
#include "mat3.h"

/* mean velocity of the body over the step that it has just made from s->start */
static PetscErrorCode MeanVelocity(CouplerSurface *s, PetscReal dt, PetscReal velocity[])
{
  const PetscReal *u;
  Vec              U, V, F;

  PetscFunctionBegin;
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArrayRead(U, &u));
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) velocity[i] = (u[i] - s->start[i]) / dt;
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the forces of the fluid, and `part` of their change since the last step, into the solid */
static PetscErrorCode SetForce(CouplerSurface *s, PetscReal part)
{
  PetscReal *f;
  Vec        U, V, F;

  PetscFunctionBegin;
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArrayWrite(F, &f));
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) f[i] = s->force[i] + part * (s->force[i] - s->last_force[i]);
  PetscCall(VecRestoreArrayWrite(F, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Velocity of the surface over the coming step as the fluid is to see it, in s->mean_velocity: the mean over the step under the last forces, by a trial run of
   the solid; where no water is near that of now. With the velocity of now the work at the interface of a heavy body in a resolved motion
   was wrong by 1e-1, and by 2e-4 with this mean, second order in dt. The body's state is saved for CouplerReturnBody(). */
PetscErrorCode CouplerPredictWall(Coupler c, CouplerSurface *s, PetscReal dt)
{
  const PetscReal *x, *v, *u;
  Vec              U, V, F;

  PetscFunctionBegin;
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(PetscArraycpy(s->start, u, 3 * s->n_nodes));
  PetscCall(VecRestoreArrayRead(U, &u));
  if (!s->touched) {
    PetscCall(PetscArraycpy(s->mean_velocity, v, 3 * s->n_nodes));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (s->answers) PetscCall(CouplerResponseSetUp(c, s, dt));
  PetscCall(TLEDSave(s->tled));
  PetscCall(SetForce(s, 0.0));
  ByCall(TLEDAdvance(s->tled, dt, &s->substeps));
  s->n_substeps_run += s->substeps;
  PetscCall(MeanVelocity(s, dt, s->mean_velocity));
  PetscCall(TLEDRestore(s->tled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the body back to the beginning of the step */
PetscErrorCode CouplerReturnBody(CouplerSurface *s)
{
  PetscFunctionBegin;
  PetscCall(TLEDRestore(s->tled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Velocity of the wall in the pressure equation less what the pressure solve itself adds to it: the mean velocity less the response to the forces that made
   it, v_mean - S f (method 5.3); without a response the mean velocity itself. */
PetscErrorCode CouplerBaseVelocity(CouplerSurface *s)
{
  PetscFunctionBegin;
  if (s->answers) PetscCall(CouplerResponseSolve(s, s->force, s->wall_velocity));
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) s->wall_velocity[i] = s->mean_velocity[i] - (s->answers ? s->wall_velocity[i] : 0.0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* give a body that nothing holds the angular momentum `lost` [N m s] as a rigid rotation of its velocity */
PetscErrorCode CouplerAddRotation(CouplerSurface *s, const PetscReal lost[3])
{
  const PetscReal *mass, *x, *v_read;
  PetscReal       *v, total = 0.0, center[3] = {0, 0, 0}, inertia[9] = {0}, inverse[9], omega[3];
  Vec              U, V, F;

  PetscFunctionBegin;
  PetscCall(TLEDGetMass(s->tled, &mass));
  PetscCall(TLEDGetPositions(s->tled, &x, &v_read));
  for (PetscInt a = 0; a < s->n_nodes; a++) {
    for (int k = 0; k < 3; k++) center[k] += mass[a] * x[3 * a + k];
    total += mass[a];
  }
  for (int k = 0; k < 3; k++) center[k] /= total;
  for (PetscInt a = 0; a < s->n_nodes; a++) {
    double r[3];

    Sub3(&x[3 * a], center, r);
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) inertia[3 * i + j] += mass[a] * ((i == j ? Dot3(r, r) : 0.0) - r[i] * r[j]);
    }
  }
  if (Invert3(inertia, inverse) == 0.0) PetscFunctionReturn(PETSC_SUCCESS);
  Mul3(inverse, lost, omega);
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArray(V, &v));
  for (PetscInt a = 0; a < s->n_nodes; a++) {
    double r[3], turn[3];

    Sub3(&x[3 * a], center, r);
    Cross3(omega, r, turn);
    for (int k = 0; k < 3; k++) v[3 * a + k] += turn[k];
  }
  PetscCall(VecRestoreArray(V, &v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sum_a x_a x f_a [N m] */
void CouplerMoment(PetscInt n, const PetscReal x[], const PetscReal f[], PetscReal moment[3])
{
  for (int k = 0; k < 3; k++) moment[k] = 0.0;
  for (PetscInt a = 0; a < n; a++) {
    double m[3];

    Cross3(&x[3 * a], &f[3 * a], m);
    for (int k = 0; k < 3; k++) moment[k] += m[k];
  }
}

/* sum_a m_a x_a x v_a of a body [kg m^2/s]; center (may be NULL): its centre of mass [m] */
PetscErrorCode CouplerAngularMomentum(CouplerSurface *s, PetscReal L[3], PetscReal center[3])
{
  const PetscReal *mass, *x, *v;
  PetscReal        total = 0.0;

  PetscFunctionBegin;
  PetscCall(TLEDGetMass(s->tled, &mass));
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) s->answer[i] = mass[i / 3] * v[i];
  CouplerMoment(s->n_nodes, x, s->answer, L);
  if (!center) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 3; k++) center[k] = 0.0;
  for (PetscInt a = 0; a < s->n_nodes; a++) {
    total += mass[a];
    for (int k = 0; k < 3; k++) center[k] += mass[a] * x[3 * a + k];
  }
  for (int k = 0; k < 3; k++) center[k] /= total;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The body's substeps under the forces of the fluid. Interpolated, they are f(t) = f + (f - f_last) (t - dt/2)/((dt + dt_last)/2), constant in each substep
   at its middle: linear through the means of both steps, with the impulse dt f that the fluid has lost. */
static PetscErrorCode Substeps(Coupler c, CouplerSurface *s, PetscReal dt)
{
  const PetscReal *u, between = 0.5 * (dt + (c->dt > 0.0 ? c->dt : dt));
  PetscInt         n = 1, taken;
  Vec              U, V, F;

  PetscFunctionBegin;
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  if (c->params.forces == COUPLER_FORCES_INTERPOLATED) ByCall(TLEDGetSubsteps(s->tled, dt, &n));
  s->work_step = 0.0;
  s->substeps  = 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal  part = n > 1 ? ((k + 0.5) / n - 0.5) * dt / between : 0.0;
    const PetscReal *f;

    PetscCall(SetForce(s, part));
    PetscCall(VecGetArrayRead(F, &f));
    PetscCall(VecGetArrayRead(U, &u));
    for (PetscInt i = 0; i < 3 * s->n_nodes; i++) s->work_step -= f[i] * u[i];
    PetscCall(VecRestoreArrayRead(U, &u));
    ByCall(TLEDAdvance(s->tled, dt / n, &taken));
    PetscCall(VecGetArrayRead(U, &u));
    for (PetscInt i = 0; i < 3 * s->n_nodes; i++) s->work_step += f[i] * u[i];
    PetscCall(VecRestoreArrayRead(U, &u));
    PetscCall(VecRestoreArrayRead(F, &f));
    s->substeps += taken;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Run the solid over dt. The forces are held while the nodes move, so the moment that they give misses the one that the fluid has lost,
   dt sum_a x_a(0) x f_a, at second order (and stiffness damping acts a little ahead of the nodes). A free body gets the rest as a
   rotation: angular momentum of fluid and bodies is then exact. Gravity's own part is that of the parabola of the centre of mass. */
static PetscErrorCode AdvanceKeepingMoment(Coupler c, CouplerSurface *s, PetscReal dt)
{
  const PetscReal *x, *v, *mass;
  PetscReal        before[3], after[3], lost[3], from[3], to[3], middle[3], weight[3], fall[3], total = 0.0;
  PetscBool        is_free;
  TLEDParams      *params;

  PetscFunctionBegin;
  PetscCall(TLEDIsFree(s->tled, &is_free));
  PetscCall(TLEDGetParams(s->tled, &params));
  if (!is_free || params->damping > 0.0) {
    ByCall(Substeps(c, s, dt));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CouplerAngularMomentum(s, before, from));
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  CouplerMoment(s->n_nodes, x, s->force, lost);
  ByCall(Substeps(c, s, dt));
  PetscCall(CouplerAngularMomentum(s, after, to));
  PetscCall(TLEDGetMass(s->tled, &mass));
  for (PetscInt a = 0; a < s->n_nodes; a++) total += mass[a];
  for (int k = 0; k < 3; k++) {
    PetscReal force = total * c->gravity[k];

    for (PetscInt a = 0; a < s->n_nodes; a++) force += s->force[3 * a + k];
    middle[k] = 0.5 * (from[k] + to[k]) - force / total * dt * dt / 12.0;
    weight[k] = dt * total * c->gravity[k];
  }
  Cross3(middle, weight, fall);
  for (int k = 0; k < 3; k++) lost[k] = dt * lost[k] + fall[k] - (after[k] - before[k]);
  PetscCall(CouplerAddRotation(s, lost));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* run the body over the step with the forces now in it, and know its mean velocity */
PetscErrorCode CouplerAdvanceBody(Coupler c, CouplerSurface *s, PetscReal dt)
{
  PetscFunctionBegin;
  ByCall(AdvanceKeepingMoment(c, s, dt));
  s->n_substeps_run += s->substeps;
  if (s->proxy) PetscCall(MeanVelocity(s, dt, s->mean_velocity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one pressure solve against the walls' velocities, forces to the nodes; s->seen gets the velocity that the fluid has seen: with compliant walls the
   response to the new forces included */
PetscErrorCode CouplerSolveFluid(Coupler c, PetscReal dt)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];

    if (s->proxy) PetscCall(ProxySetVelocity(s->proxy, s->wall_velocity));
  }
  PetscCall(CouplerTimer(c, PHASE_TRANSFER));
  ByCall(SPHSolvePressure(c->sph, dt, c->compliant ? CouplerResponseApply : NULL, c));
  PetscCall(SPHGetForces(c->sph));
  PetscCall(CouplerTimer(c, PHASE_PRESSURE));
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    CouplerSurface *s = &c->surface[k];

    if (!s->proxy) continue;
    PetscCall(PetscArraycpy(s->total, c->contacts[k].total, 3));
    PetscCall(PetscArraycpy(s->moment, c->contacts[k].moment, 3));
    if (!s->tled) continue;
    PetscCall(PetscArrayzero(s->force, 3 * s->n_nodes));
    PetscCall(ProxyTransfer(s->proxy, s->proxy_force, c->contacts[k].moment, s->force));
    if (s->answers) PetscCall(CouplerResponseSolve(s, s->force, s->seen));
    for (PetscInt i = 0; i < 3 * s->n_nodes; i++) s->seen[i] = s->wall_velocity[i] + (s->answers ? s->seen[i] : 0.0);
  }
  PetscCall(CouplerTimer(c, PHASE_TRANSFER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Work at the interface over the step: forces times the velocity that the fluid has seen, and along the way that the body has made. Held forces do
   f . (u - u_start), taken apart from works in the bodies' own books: with the same sum of products as the fluid's, so that both are equal where both
   velocities are. */
void CouplerAddWork(Coupler c, CouplerSurface *s, PetscReal dt)
{
  PetscReal fluid = 0.0, solid = 0.0;

  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) {
    fluid += dt * s->force[i] * s->seen[i];
    solid += dt * s->force[i] * s->mean_velocity[i];
  }
  if (c->params.forces == COUPLER_FORCES_INTERPOLATED) solid = s->work_step;
  s->work_fluid += fluid;
  s->work_exchanged += PetscAbsReal(fluid);
  s->work_solid += solid;
  s->work_force += s->work_step;
}
