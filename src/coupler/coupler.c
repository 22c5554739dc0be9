/* coupler.c - the Coupler object and its staggered step (method 5.2, 5.3). */
#include "coupler_impl.h"
#include "relaxation.h"
#include "mat3.h"
#include <time.h>

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
  PetscCall(PetscCalloc7(3 * s->n_nodes, &s->force, 3 * s->n_nodes, &s->last_force, 3 * s->n_nodes, &s->start, 3 * s->n_nodes, &s->mean_velocity, 3 * s->n_nodes, &s->wall_velocity,
                         3 * s->n_nodes, &s->answer, 3 * s->n_nodes, &s->seen));
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

/* bodies may come to lie on an obstacle at rest; obstacles beside each other keep their faces, which hold water out of the slots between them */
PetscErrorCode CouplerAddNeighbours(Coupler c)
{
  SPHParams *params;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(c->sph, &params));
  for (PetscInt j = c->n_bodies; j < c->n_surfaces; j++) {
    CouplerSurface *o = &c->surface[j];
    PetscReal       lo[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[3] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL};

    if (o->moves || o->index || !c->n_bodies) continue;
    PetscCall(SurfaceIndexCreate(o->n_nodes, o->x, o->n_triangles, o->triangles, PROXY_NEIGHBOUR_REACH * params->support * params->spacing, &o->index));
    for (PetscInt i = 0; i < 3 * o->n_nodes; i++) {
      lo[i % 3] = PetscMin(lo[i % 3], o->x[i]);
      hi[i % 3] = PetscMax(hi[i % 3], o->x[i]);
    }
    for (PetscInt k = 0; k < c->n_surfaces; k++)
      if (c->surface[k].proxy && k < c->n_bodies) PetscCall(ProxyAddNeighbour(c->surface[k].proxy, o->index, lo, hi));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerSetUp - fix the coupling scheme and the first contacts; the parts must be set up

  Collective

  Input Parameter:
. coupler - with its fluid, bodies and obstacles

  Options Database Key:
. -coupler_scheme (auto|explicit|iterated|mass) - scheme_select.c

.seealso: CouplerStep()
@*/
PetscErrorCode CouplerSetUp(Coupler c)
{
  SPHParams  *params;
  const char *solver;
  PetscBool   isph;

  PetscFunctionBegin;
  if (c->setup) PetscFunctionReturn(PETSC_SUCCESS);
  c->setup = PETSC_TRUE;
  if (!c->sph) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SPHGetParams(c->sph, &params));
  PetscCall(SPHGetMass(c->sph, &c->mass));
  c->rest_density = params->density;
  PetscCall(CouplerAddNeighbours(c));
  PetscCall(SPHGetSolver(c->sph, &solver, NULL));
  PetscCall(PetscStrcmp(solver, "isph", &isph));
  for (PetscInt k = 0; k < c->n_bodies && isph && !params->free_surface; k++) {
    if (!c->surface[k].proxy) continue;
    PetscFunctionReturn(InputError("sph.solver", "isph knows the pressure of a closed flow but for a constant, which elastic body %s would be squeezed by: take iisph, or an obstacle in its place", c->surface[k].name));
  }
  ByCall(CouplerSelectSchemes(c));
  PetscCall(CouplerNumberInterface(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerTimer(Coupler c, CouplerPhase phase)
{
  PetscLogDouble  now;
  struct timespec used;

  PetscFunctionBegin;
  PetscCall(PetscTime(&now));
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  const PetscLogDouble cpu = (PetscLogDouble)used.tv_sec + 1e-9 * (PetscLogDouble)used.tv_nsec;
  if (phase < N_PHASES) {
    c->phase[phase] += now - c->mark;
    c->phase_cpu[phase] += cpu - c->mark_cpu;
  }
  c->mark     = now;
  c->mark_cpu = cpu;
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
    PetscCall(ProxyUpdate(s->proxy, x, s->tled ? s->mean_velocity : s->v_nodes));
    PetscCall(ProxyGetContacts(s->proxy, &c->contacts[k]));
    if (c->contacts[k].n_proxies > s->capacity) {
      s->capacity = c->contacts[k].n_proxies + c->contacts[k].n_proxies / 2;
      PetscCall(PetscFree2(s->proxy_force, s->proxy_work));
      PetscCall(PetscMalloc2(3 * s->capacity, &s->proxy_force, 3 * s->capacity, &s->proxy_work));
    }
    c->contacts[k].force       = s->proxy_force;
    c->contacts[k].coefficient = s->tled ? c->params.contact_coefficient : 1.0;
  }
  PetscCall(SPHSetContacts(c->sph, c->n_surfaces, c->contacts));
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
  c->within_step = PETSC_TRUE;
  PetscCall(CouplerTimer(c, N_PHASES));
  if (c->sph) {
    PetscReal dt_fluid;
    SPHStats  stats;

    if (!c->step) PetscCall(CouplerGetBalance(c, &c->balance_start));
    ByCall(SPHUpdateNeighbors(c->sph));
    PetscCall(CouplerTimer(c, PHASE_NEIGHBOURS));
    PetscCall(SPHGetTimeStep(c->sph, &dt_fluid));
    PetscCall(CouplerLimitStep(c, &dt_fluid));
    /* two equal steps rather than a full and a tiny one before an output */
    if (dt_max > (1.0 + 1e-9) * dt_fluid) *dt = dt_max < 2.0 * dt_fluid ? 0.5 * dt_max : dt_fluid; /* 1e-9: a fixed step stays one */
    ByCall(CouplerCoupledStep(c, *dt));
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
  c->within_step = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerView(Coupler c, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "Coupler: %" PetscInt_FMT " bodies, %" PetscInt_FMT " obstacles\n", c->n_bodies, c->n_surfaces - c->n_bodies));
  if (c->sph) PetscCall(SPHView(c->sph, viewer));
  PetscCall(CouplerViewSchemes(c, viewer));
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
    PetscCall(SurfaceIndexDestroy(&s->index));
    PetscCall(TLEDDestroy(&s->tled));
    PetscCall(CouplerResponseDestroy(&s->response));
    PetscCall(PetscFree2(s->x, s->triangles));
    PetscCall(PetscFree3(s->x_rest, s->x_next, s->v_nodes));
    PetscCall(MotionDestroy(&s->motion));
    PetscCall(PetscFree7(s->force, s->last_force, s->start, s->mean_velocity, s->wall_velocity, s->answer, s->seen));
    PetscCall(PetscFree2(s->proxy_force, s->proxy_work));
    PetscCall(PetscFree(s->interface));
    PetscCall(PetscFree(s->arm));
  }
  PetscCall(PetscFree2(c->interface, c->residual));
  PetscCall(RelaxationDestroy(&c->relaxation));
  for (PetscInt k = 0; k < c->n_wall_motions; k++) PetscCall(MotionDestroy(&c->wall_motion[k]));
  PetscCall(MotionDestroy(&c->frame));
  PetscCall(PetscHeaderDestroy(coupler));
  PetscFunctionReturn(PETSC_SUCCESS);
}
