/* coupler.c - the Coupler object and its staggered step (method 5.2, 5.3). */
#include "coupler_impl.h"
#include "mat3.h"

static PetscClassId  COUPLER_CLASSID;
static PetscLogEvent coupler_events[N_PHASES];

static PetscErrorCode RegisterClass(void)
{
  static PetscBool   registered = PETSC_FALSE;
  static const char *names[]    = {"CplNeighbours", "CplPressure", "CplProxies", "CplTransfer", "CplSolid", "CplOutput"};

  PetscFunctionBegin;
  if (registered) PetscFunctionReturn(PETSC_SUCCESS);
  registered = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("Coupler", &COUPLER_CLASSID));
  for (int k = 0; k < N_PHASES; k++) PetscCall(PetscLogEventRegister(names[k], COUPLER_CLASSID, &coupler_events[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerCreate - make an empty coupler

  Collective

  Input Parameter:
. comm - communicator

  Output Parameter:
. coupler - the coupler; destroy with CouplerDestroy()

.seealso: CouplerSetFromOptions(), CouplerStep()
@*/
PetscErrorCode CouplerCreate(MPI_Comm comm, Coupler *coupler)
{
  Coupler c;

  PetscFunctionBegin;
  PetscCall(RegisterClass());
  PetscCall(PetscHeaderCreate(c, COUPLER_CLASSID, "Coupler", "Fluid-solid coupler", "Coupler", comm, CouplerDestroy, CouplerView));
  PetscCall(KeysSetDefaults(CouplerKeys, &c->params));
  *coupler = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerGetParams(Coupler coupler, CouplerParams **params)
{
  PetscFunctionBegin;
  *params = &coupler->params;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerSetFluid(Coupler coupler, SPH sph)
{
  PetscFunctionBegin;
  PetscCheck(!coupler->sph, PETSC_COMM_SELF, PETSC_ERR_ORDER, "A coupler holds one fluid");
  coupler->sph = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerAddBody(Coupler coupler, const char name[], TLED tled, Proxy proxy)
{
  CouplerSurface *s = &coupler->surface[coupler->n_surfaces];
  PetscInt        n_tets;

  PetscFunctionBegin;
  PetscCheck(coupler->n_surfaces == coupler->n_bodies, PETSC_COMM_SELF, PETSC_ERR_ORDER, "Add bodies before obstacles");
  PetscCheck(coupler->n_surfaces < COUPLER_MAX_SURFACES, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "At most %d bodies and obstacles",
             COUPLER_MAX_SURFACES);
  PetscCall(PetscStrncpy(s->name, name, sizeof(s->name)));
  s->tled  = tled;
  s->proxy = proxy;
  PetscCall(TLEDGetSize(tled, &s->n_nodes, &n_tets));
  PetscCall(PetscCalloc5(3 * s->n_nodes, &s->force, 3 * s->n_nodes, &s->start, 3 * s->n_nodes, &s->mean_velocity, 3 * s->n_nodes, &s->wall_velocity,
                         3 * s->n_nodes, &s->answer));
  coupler->n_bodies++;
  coupler->n_surfaces++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerAddObstacle(Coupler coupler, const char name[], Proxy proxy, PetscInt n_nodes, const PetscReal x[], PetscInt n_triangles,
                                  const PetscInt triangles[])
{
  CouplerSurface *s = &coupler->surface[coupler->n_surfaces];

  PetscFunctionBegin;
  PetscCheck(coupler->n_surfaces < COUPLER_MAX_SURFACES, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "At most %d bodies and obstacles",
             COUPLER_MAX_SURFACES);
  PetscCall(PetscStrncpy(s->name, name, sizeof(s->name)));
  s->proxy   = proxy;
  s->n_nodes = n_nodes;
  PetscCall(PetscMalloc2(3 * n_nodes, &s->x, 3 * n_triangles, &s->triangles));
  PetscCall(PetscArraycpy(s->x, x, 3 * n_nodes));
  PetscCall(PetscArraycpy(s->triangles, triangles, 3 * n_triangles));
  s->n_triangles = n_triangles;
  coupler->n_surfaces++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ratio r of the water's mass that a body must move to its own (method 5.3), from the slenderness of the body: a plate of area
   A/2 on each side and thickness t = 2V/A moves about rho L with L = sqrt(A/2). */
static PetscErrorCode AddedMassRatio(CouplerSurface *s, PetscReal rest_density, PetscReal *ratio)
{
  PetscInt         n;
  const PetscInt  *triangles;
  const PetscReal *x, *v;
  TLEDStats        stats;
  const PetscReal *mass;
  PetscReal        area = 0.0, total = 0.0;

  PetscFunctionBegin;
  PetscCall(TLEDGetSurface(s->tled, PETSC_FALSE, &n, &triangles));
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  PetscCall(TLEDGetStats(s->tled, &stats));
  PetscCall(TLEDGetMass(s->tled, &mass));
  for (PetscInt a = 0; a < s->n_nodes; a++) total += mass[a];
  for (PetscInt t = 0; t < n; t++) {
    double a[3], b[3], ab[3];

    Sub3(&x[3 * triangles[3 * t + 1]], &x[3 * triangles[3 * t]], a);
    Sub3(&x[3 * triangles[3 * t + 2]], &x[3 * triangles[3 * t]], b);
    Cross3(a, b, ab);
    area += 0.5 * Norm3(ab);
  }
  *ratio = rest_density * PetscSqrtReal(0.5 * area) / (total * 2.0 * stats.volume / (stats.volume_reference * area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerSetUp - fix the coupling scheme and the first contacts; the parts must be set up

  Collective

  Input Parameter:
. coupler - with its fluid, bodies and obstacles

  Options Database Key:
. -coupler_scheme (auto|explicit|mass) - auto takes explicit when every body has an added-mass ratio below 0.2

.seealso: CouplerStep()
@*/
PetscErrorCode CouplerSetUp(Coupler c)
{
  SPHParams  *params;
  const char *solver;
  PetscBool   responds, isph;

  PetscFunctionBegin;
  if (c->setup) PetscFunctionReturn(PETSC_SUCCESS);
  c->setup = PETSC_TRUE;
  if (!c->sph) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SPHGetParams(c->sph, &params));
  PetscCall(SPHGetMass(c->sph, &c->mass));
  c->rest_density = params->density;
  c->compliant    = (PetscBool)(c->params.scheme == COUPLER_SCHEME_MASS && c->n_bodies > 0);
  PetscCall(SPHGetSolver(c->sph, &solver, &responds));
  PetscCall(PetscStrcmp(solver, "isph", &isph));
  for (PetscInt k = 0; k < c->n_bodies && isph && !params->free_surface; k++) {
    if (!c->surface[k].proxy) continue;
    PetscFunctionReturn(InputError("sph.solver", "isph knows the pressure of a closed flow but for a constant, which elastic body %s would be squeezed by: take iisph, or an obstacle in its place", c->surface[k].name));
  }
  if (c->compliant && !responds) PetscFunctionReturn(InputError("coupler.scheme", "mass needs a pressure solver that takes the bodies' response: sph.solver %s does not, iisph does", solver));
  for (PetscInt k = 0; k < c->n_bodies && c->params.scheme == COUPLER_SCHEME_AUTO; k++) {
    PetscReal r = 0.0;

    if (!c->surface[k].proxy) continue;
    PetscCall(AddedMassRatio(&c->surface[k], c->rest_density, &r));
    PetscCall(PetscInfo(c, "%s: added-mass ratio about %g\n", c->surface[k].name, (double)r));
    if (r >= 0.2 && !responds) PetscFunctionReturn(InputError("sph.solver", "body %s is light (added-mass ratio %.2g, allowed below 0.2): its walls must answer within the pressure solve, which %s does not do; iisph does, and coupler.scheme explicit takes the risk", c->surface[k].name, (double)r, solver));
    if (r >= 0.2) c->compliant = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerTimer(Coupler c, CouplerPhase phase)
{
  PetscLogDouble now;

  PetscFunctionBegin;
  PetscCall(PetscTime(&now));
  if (phase < N_PHASES) c->phase[phase] += now - c->mark;
  c->mark = now;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* proxies follow their surfaces, contacts with the particles at their current positions; room for the proxies' forces */
PetscErrorCode CouplerUpdateContacts(Coupler c)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    CouplerSurface  *s = &c->surface[k];
    const PetscReal *x = s->x, *v = NULL;

    c->contacts[k] = (SPHContacts){0};
    if (!s->proxy) continue;
    if (s->tled) PetscCall(TLEDGetPositions(s->tled, &x, &v));
    if (s->tled || s->moves || !s->placed) PetscCall(ProxyUpdate(s->proxy, x, s->tled ? s->mean_velocity : s->v_nodes));
    s->placed = PETSC_TRUE;
    PetscCall(ProxyGetContacts(s->proxy, &c->contacts[k]));
    if (c->contacts[k].n_proxies > s->capacity) {
      s->capacity = c->contacts[k].n_proxies + c->contacts[k].n_proxies / 2;
      PetscCall(PetscFree2(s->proxy_force, s->proxy_work));
      PetscCall(PetscMalloc2(3 * s->capacity, &s->proxy_force, 3 * s->capacity, &s->proxy_work));
    }
    c->contacts[k].force = s->proxy_force;
  }
  PetscCall(SPHSetContacts(c->sph, c->n_surfaces, c->contacts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Velocity of the surface over the coming step as the fluid is to see it. `explicit`, or no water near: that of now. `mass`: the mean over the step under
   the last forces (a trial run of the solid), less the response to those forces, which the pressure solve puts back (method 5.3). */
static PetscErrorCode PredictWall(Coupler c, CouplerSurface *s, PetscReal dt)
{
  const PetscReal *x, *v, *u;
  Vec              U, V, F;

  PetscFunctionBegin;
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(PetscArraycpy(s->start, u, 3 * s->n_nodes));
  PetscCall(VecRestoreArrayRead(U, &u));
  if (!s->answers) {
    PetscCall(PetscArraycpy(s->mean_velocity, v, 3 * s->n_nodes));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CouplerResponseSetUp(c, s, dt));
  PetscCall(TLEDSave(s->tled));
  ByCall(TLEDAdvance(s->tled, dt, &s->substeps));
  s->n_substeps_run += s->substeps;
  PetscCall(VecGetArrayRead(U, &u));
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) s->mean_velocity[i] = (u[i] - s->start[i]) / dt;
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscCall(TLEDRestore(s->tled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* take the response to the forces already in the prediction out of the wall's velocity: v_wall = v_mean - S f */
static PetscErrorCode RemoveResponse(CouplerSurface *s, PetscReal velocity[])
{
  PetscFunctionBegin;
  PetscCall(CouplerResponseSolve(s, s->force, velocity));
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) velocity[i] = s->mean_velocity[i] - velocity[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* forces on proxies -> forces on nodes, and into the solid */
static PetscErrorCode TransferForces(CouplerSurface *s, SPHContacts *contacts)
{
  PetscReal *f;
  Vec        U, V, F;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(s->force, 3 * s->n_nodes));
  PetscCall(ProxyTransfer(s->proxy, s->proxy_force, contacts->moment, s->force));
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArrayWrite(F, &f));
  PetscCall(PetscArraycpy(f, s->force, 3 * s->n_nodes));
  PetscCall(VecRestoreArrayWrite(F, &f));
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
    ByCall(TLEDAdvance(s->tled, dt, &s->substeps));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CouplerAngularMomentum(s, before, from));
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  CouplerMoment(s->n_nodes, x, s->force, lost);
  ByCall(TLEDAdvance(s->tled, dt, &s->substeps));
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

/* run the solid over the step with the forces now in it; `velocity` gets its mean velocity, `work` what the forces did [J] */
static PetscErrorCode AdvanceSolid(Coupler c, CouplerSurface *s, PetscReal dt, PetscReal velocity[], PetscReal *work)
{
  const PetscReal *u;
  Vec              U, V, F;

  PetscFunctionBegin;
  ByCall(AdvanceKeepingMoment(c, s, dt));
  s->n_substeps_run += s->substeps;
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArrayRead(U, &u));
  *work = 0.0;
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) {
    *work += s->force[i] * (u[i] - s->start[i]);
    velocity[i] = (u[i] - s->start[i]) / dt;
  }
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one pressure solve against the predicted walls, forces to the nodes; with compliant walls the wall's velocity gets the response to
   the new forces, so that `contacts.velocity` is what the fluid has seen */
static PetscErrorCode SolveFluid(Coupler c, PetscReal dt)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];

    if (!s->proxy) continue;
    if (s->answers) PetscCall(RemoveResponse(s, s->wall_velocity));
    PetscCall(ProxySetVelocity(s->proxy, s->answers ? s->wall_velocity : s->mean_velocity));
  }
  PetscCall(CouplerTimer(c, PHASE_TRANSFER));
  ByCall(SPHSolvePressure(c->sph, dt, c->compliant ? CouplerResponseApply : NULL, c));
  PetscCall(SPHGetForces(c->sph));
  PetscCall(CouplerTimer(c, PHASE_PRESSURE));
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    CouplerSurface *s = &c->surface[k];

    if (!s->proxy) continue;
    for (int i = 0; i < 3; i++) s->total[i] = c->contacts[k].total[i];
    if (!s->tled) continue;
    PetscCall(TransferForces(s, &c->contacts[k]));
  }
  PetscCall(CouplerTimer(c, PHASE_TRANSFER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* work at the interface over the step as the fluid sees it: forces times the velocity of the wall in the pressure equation */
static PetscErrorCode FluidWork(Coupler c, PetscInt k, PetscReal dt)
{
  CouplerSurface *s = &c->surface[k];

  PetscFunctionBegin;
  if (!s->answers) {
    s->work_fluid += dt * c->contacts[k].power;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CouplerResponseSolve(s, s->force, s->answer));
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) s->work_fluid += dt * s->force[i] * (s->wall_velocity[i] + s->answer[i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* fluid and solids over dt from the same instant (method 5.2, steps 1 to 4) */
static PetscErrorCode CoupledStep(Coupler c, PetscReal dt)
{
  const PetscInt passes = c->compliant ? c->params.passes : 1;

  PetscFunctionBegin;
  PetscCall(CouplerMoveObstacles(c, dt));
  PetscCall(CouplerUpdateContacts(c));
  PetscCall(CouplerTimer(c, PHASE_PROXIES));
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];

    /* a body that no water touches needs no trial run */
    s->answers = (PetscBool)(c->compliant && c->contacts[k].n_touched > 0);
    if (s->proxy) ByCall(PredictWall(c, s, dt));
  }
  PetscCall(CouplerTimer(c, PHASE_SOLID));
  ByCall(SPHPredict(c->sph, dt));
  PetscCall(CouplerTimer(c, PHASE_PRESSURE));
  for (PetscInt pass = 0; pass < passes; pass++) {
    ByCall(SolveFluid(c, dt));
    for (PetscInt k = 0; k < c->n_bodies; k++) {
      CouplerSurface *s = &c->surface[k];
      PetscReal       work = 0.0;

      if (s->proxy && pass == passes - 1) PetscCall(FluidWork(c, k, dt));
      if (c->compliant && s->proxy && pass < passes - 1) PetscCall(TLEDSave(s->tled));
      ByCall(AdvanceSolid(c, s, dt, s->mean_velocity, &work));
      if (pass < passes - 1 && s->proxy) PetscCall(TLEDRestore(s->tled));
      else if (s->proxy) s->work_solid += work;
    }
    PetscCall(CouplerTimer(c, PHASE_SOLID));
  }
  PetscCall(SPHKick(c->sph, dt));
  PetscCall(CouplerTimer(c, PHASE_PRESSURE));
  PetscCall(CouplerStop(c, dt));
  PetscCall(CouplerArriveObstacles(c, dt));
  PetscCall(CouplerTimer(c, PHASE_TRANSFER));
  ByCall(SPHDrift(c->sph, dt));
  PetscCall(CouplerTimer(c, PHASE_PRESSURE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerStep - advance fluid and bodies by one step of the fluid

  Collective

  Input Parameters:
+ coupler - set up
- dt_max  - largest step wanted [s], for example the time left to the next output

  Output Parameter:
. dt - the step taken [s]

  Errors:
  BY_ERR_BREAKDOWN when fluid or solid cannot go on; CouplerGetBreakdown() tells why

.seealso: CouplerGetLedger()
@*/
PetscErrorCode CouplerStep(Coupler c, PetscReal dt_max, PetscReal *dt)
{
  PetscFunctionBegin;
  if (!c->setup) ByCall(CouplerSetUp(c));
  *dt = dt_max;
  PetscCall(CouplerTimer(c, N_PHASES));
  if (c->sph) {
    PetscReal dt_fluid;
    SPHStats  stats;

    ByCall(SPHUpdateNeighbors(c->sph));
    PetscCall(CouplerTimer(c, PHASE_NEIGHBOURS));
    PetscCall(SPHGetTimeStep(c->sph, &dt_fluid));
    PetscCall(CouplerLimitStep(c, &dt_fluid));
    /* two equal steps rather than a full and a tiny one before an output */
    if (dt_max < 2.0 * dt_fluid && dt_max > dt_fluid) *dt = 0.5 * dt_max;
    else *dt = PetscMin(dt_max, dt_fluid);
    ByCall(CoupledStep(c, *dt));
    PetscCall(SPHGetStats(c->sph, &stats));
    c->iterations_sum += stats.iterations;
  } else {
    for (PetscInt k = 0; k < c->n_bodies; k++) {
      ByCall(TLEDAdvance(c->surface[k].tled, *dt, &c->surface[k].substeps));
      c->surface[k].n_substeps_run += c->surface[k].substeps;
    }
    PetscCall(CouplerTimer(c, PHASE_SOLID));
  }
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    c->surface[k].n_substeps_sum += c->surface[k].substeps;
    c->surface[k].n_proxies_sum += c->contacts[k].n_proxies;
  }
  c->dt = *dt;
  c->time += *dt;
  c->step++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerView(Coupler c, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "Coupler: scheme %s, %" PetscInt_FMT " bodies, %" PetscInt_FMT " obstacles\n",
                                   c->compliant ? "mass" : "explicit", c->n_bodies, c->n_surfaces - c->n_bodies));
  if (c->sph) PetscCall(SPHView(c->sph, viewer));
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    if (c->surface[k].tled) PetscCall(TLEDView(c->surface[k].tled, viewer));
    if (c->surface[k].proxy) PetscCall(ProxyView(c->surface[k].proxy, viewer));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerGetSPH(Coupler c, SPH *sph)
{
  PetscFunctionBegin;
  *sph = c->sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerGetBody(Coupler c, PetscInt k, TLED *tled, Proxy *proxy)
{
  PetscFunctionBegin;
  PetscCheck(k >= 0 && k < c->n_surfaces, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "Body %" PetscInt_FMT " of %" PetscInt_FMT, k,
             c->n_surfaces);
  if (tled) *tled = c->surface[k].tled;
  if (proxy) *proxy = c->surface[k].proxy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerGetTime(Coupler c, PetscReal *time, PetscInt *step)
{
  PetscFunctionBegin;
  if (time) *time = c->time;
  if (step) *step = c->step;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerGetForce(Coupler c, PetscInt k, PetscReal force[3])
{
  PetscFunctionBegin;
  for (int i = 0; i < 3; i++) force[i] = c->surface[k].total[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerGetBreakdown(Coupler c, const char **message)
{
  const char *why = NULL;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n_bodies && !(why && why[0]); k++) PetscCall(TLEDGetBreakdown(c->surface[k].tled, &why));
  if (!(why && why[0]) && c->sph) PetscCall(SPHGetBreakdown(c->sph, &why));
  PetscCall(PetscSNPrintf(c->breakdown, sizeof(c->breakdown), "step %" PetscInt_FMT ", time %g s: %s", c->step + 1, (double)c->time,
                          why && why[0] ? why : "unknown reason"));
  *message = c->breakdown;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerDestroy(Coupler *coupler)
{
  Coupler c;

  PetscFunctionBegin;
  if (!*coupler) PetscFunctionReturn(PETSC_SUCCESS);
  c = *coupler;
  if (--((PetscObject)c)->refct > 0) {
    *coupler = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SPHDestroy(&c->sph));
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    CouplerSurface *s = &c->surface[k];

    PetscCall(ProxyDestroy(&s->proxy));
    PetscCall(TLEDDestroy(&s->tled));
    PetscCall(CouplerResponseDestroy(&s->response));
    PetscCall(PetscFree2(s->x, s->triangles));
    PetscCall(PetscFree3(s->x_rest, s->x_next, s->v_nodes));
    PetscCall(MotionDestroy(&s->motion));
    PetscCall(PetscFree5(s->force, s->start, s->mean_velocity, s->wall_velocity, s->answer));
    PetscCall(PetscFree2(s->proxy_force, s->proxy_work));
  }
  for (PetscInt k = 0; k < c->n_wall_motions; k++) PetscCall(MotionDestroy(&c->wall_motion[k]));
  PetscCall(MotionDestroy(&c->frame));
  PetscCall(PetscHeaderDestroy(coupler));
  PetscFunctionReturn(PETSC_SUCCESS);
}
