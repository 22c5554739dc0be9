/* coupler_state.c - the whole state of a coupled run into a checkpoint and back. */
#include "coupler_impl.h"
#include "relaxation.h"

/* the response is made anew every so many steps: where and when it was made last */
static PetscErrorCode SaveResponse(Checkpoint file, CouplerSurface *s)
{
  const CouplerResponse *r        = &s->response;
  const PetscReal        clock[2] = {r->dt, (PetscReal)r->age};
  char                   name[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/response", s->name));
  ByCall(CheckpointWriteReal(file, name, 2, clock));
  if (!(r->dt > 0.0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/response_at", s->name));
  ByCall(CheckpointWriteReal(file, name, 3 * s->n_nodes, r->at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadResponse(Coupler c, Checkpoint file, CouplerSurface *s)
{
  CouplerResponse *r = &s->response;
  PetscReal        clock[2];
  char             name[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/response", s->name));
  ByCall(CheckpointReadReal(file, name, 2, clock));
  r->dt  = clock[0];
  r->age = (PetscInt)clock[1];
  if (!(r->dt > 0.0)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!r->at) PetscCall(PetscMalloc1(3 * s->n_nodes, &r->at));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/response_at", s->name));
  ByCall(CheckpointReadReal(file, name, 3 * s->n_nodes, r->at));
  PetscCall(CouplerResponseMake(c, s, r->dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SaveBody(Checkpoint file, CouplerSurface *s)
{
  Vec              vec[3];
  const PetscReal *values;
  PetscReal        sums[7], *state;
  PetscInt         n_state;
  const char      *names[] = {"displacement", "velocity"};
  char             name[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(TLEDGetVectors(s->tled, &vec[0], &vec[1], &vec[2]));
  for (int k = 0; k < 2; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/%s", s->name, names[k]));
    PetscCall(VecGetArrayRead(vec[k], &values));
    ByCall(CheckpointWriteReal(file, name, 3 * s->n_nodes, values));
    PetscCall(VecRestoreArrayRead(vec[k], &values));
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/force", s->name));
  ByCall(CheckpointWriteReal(file, name, 3 * s->n_nodes, s->force));
  PetscCall(TLEDGetState(s->tled, &n_state, NULL));
  PetscCall(PetscMalloc1(n_state, &state));
  PetscCall(TLEDGetState(s->tled, &n_state, state));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/state", s->name));
  ByCall(CheckpointWriteReal(file, name, n_state, state));
  PetscCall(PetscFree(state));
  if (s->proxy) {
    PetscCall(ProxyGetSampling(s->proxy, &values));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/sampling", s->name));
    ByCall(CheckpointWriteReal(file, name, 3 * s->n_nodes, values));
  }
  sums[0] = s->work_fluid;
  sums[1] = s->work_solid;
  sums[2] = s->n_substeps_sum;
  sums[3] = s->n_proxies_sum;
  sums[4] = s->work_exchanged;
  sums[5] = s->work_force;
  sums[6] = (PetscReal)s->scheme;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/sums", s->name));
  ByCall(CheckpointWriteReal(file, name, 7, sums));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/mean_velocity", s->name));
  ByCall(CheckpointWriteReal(file, name, 3 * s->n_nodes, s->mean_velocity));
  ByCall(SaveResponse(file, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* an obstacle that moves: where it is the clock tells; how it was sampled, and the work done on it */
static PetscErrorCode SaveObstacle(Checkpoint file, CouplerSurface *s)
{
  const PetscReal *values, sums[3] = {s->work_fluid, s->work_solid, s->n_proxies_sum};
  char             name[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(ProxyGetSampling(s->proxy, &values));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/sampling", s->name));
  ByCall(CheckpointWriteReal(file, name, 3 * s->n_nodes, values));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/sums", s->name));
  ByCall(CheckpointWriteReal(file, name, 3, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadObstacle(Checkpoint file, CouplerSurface *s)
{
  PetscReal *values, sums[3];
  char       name[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * s->n_nodes, &values));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/sampling", s->name));
  ByCall(CheckpointReadReal(file, name, 3 * s->n_nodes, values));
  PetscCall(ProxySetSampling(s->proxy, values));
  PetscCall(PetscFree(values));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/sums", s->name));
  ByCall(CheckpointReadReal(file, name, 3, sums));
  s->work_fluid    = sums[0];
  s->work_solid    = sums[1];
  s->n_proxies_sum = sums[2];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadBody(Coupler c, Checkpoint file, CouplerSurface *s)
{
  Vec         vec[3];
  PetscReal  *values, sums[7], *state;
  PetscInt    n_state;
  const char *names[] = {"displacement", "velocity"};
  char        name[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(TLEDGetVectors(s->tled, &vec[0], &vec[1], &vec[2]));
  for (int k = 0; k < 2; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/%s", s->name, names[k]));
    PetscCall(VecGetArrayWrite(vec[k], &values));
    ByCall(CheckpointReadReal(file, name, 3 * s->n_nodes, values));
    PetscCall(VecRestoreArrayWrite(vec[k], &values));
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/force", s->name));
  ByCall(CheckpointReadReal(file, name, 3 * s->n_nodes, s->force));
  PetscCall(VecGetArrayWrite(vec[2], &values));
  PetscCall(PetscArraycpy(values, s->force, 3 * s->n_nodes));
  PetscCall(VecRestoreArrayWrite(vec[2], &values));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/sums", s->name));
  ByCall(CheckpointReadReal(file, name, 7, sums));
  s->work_exchanged = sums[4];
  s->work_force     = sums[5];
  s->scheme         = (CouplerScheme)sums[6];
  s->work_fluid     = sums[0];
  s->work_solid     = sums[1];
  s->n_substeps_sum = sums[2];
  s->n_proxies_sum  = sums[3];
  if (s->proxy) {
    PetscCall(PetscMalloc1(3 * s->n_nodes, &values));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/sampling", s->name));
    ByCall(CheckpointReadReal(file, name, 3 * s->n_nodes, values));
    PetscCall(ProxySetSampling(s->proxy, values));
    PetscCall(PetscFree(values));
  }
  PetscCall(TLEDGetState(s->tled, &n_state, NULL));
  PetscCall(PetscMalloc1(n_state, &state));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/state", s->name));
  ByCall(CheckpointReadReal(file, name, n_state, state));
  PetscCall(TLEDSetState(s->tled, n_state, state));
  PetscCall(PetscFree(state));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/mean_velocity", s->name));
  ByCall(CheckpointReadReal(file, name, 3 * s->n_nodes, s->mean_velocity));
  ByCall(LoadResponse(c, file, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SaveFlows(SPH sph, Checkpoint file)
{
  PetscReal flows[2 * BY_REALS_MAX * BY_NAMES_MAX];
  PetscInt  n;

  PetscFunctionBegin;
  PetscCall(SPHGetFlows(sph, &n, flows));
  if (n) ByCall(CheckpointWriteReal(file, "fluid/flows", n, flows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadFlows(SPH sph, Checkpoint file)
{
  PetscReal flows[2 * BY_REALS_MAX * BY_NAMES_MAX];
  PetscInt  n, n_saved;

  PetscFunctionBegin;
  PetscCall(SPHGetFlows(sph, &n, NULL));
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckpointGetSize(file, "fluid/flows", &n_saved));
  if (n_saved != n) PetscFunctionReturn(InputError("resume", "the saved state has %d inlets, outlets and sources, the scene has %d", (int)PetscMax(0, n_saved - 1), (int)(n - 1)));
  ByCall(CheckpointReadReal(file, "fluid/flows", n, flows));
  PetscCall(SPHSetFlows(sph, n, flows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what iterations have learnt, and their books */
static PetscErrorCode SaveInterface(Coupler c, Checkpoint file)
{
  PetscReal  sums[6] = {(PetscReal)c->solves, c->mismatch, c->solves_sum, c->mismatch_sum, (PetscReal)c->n_unsettled, c->balance_start}, *state;
  PetscInt   n;

  PetscFunctionBegin;
  PetscCall(RelaxationGetState(c->relaxation, &n, NULL));
  PetscCall(PetscMalloc1(n, &state));
  PetscCall(RelaxationGetState(c->relaxation, &n, state));
  ByCall(CheckpointWriteReal(file, "interface/relaxation", n, state));
  PetscCall(PetscFree(state));
  ByCall(CheckpointWriteReal(file, "interface/sums", 6, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadInterface(Coupler c, Checkpoint file)
{
  PetscReal sums[6], *state;
  PetscInt  n;

  PetscFunctionBegin;
  PetscCall(CheckpointGetSize(file, "interface/relaxation", &n));
  if (n < 0) PetscFunctionReturn(InputError("resume", "the checkpoint has no interface, but the scene has fluid and bodies"));
  PetscCall(PetscMalloc1(n, &state));
  ByCall(CheckpointReadReal(file, "interface/relaxation", n, state));
  PetscCall(RelaxationSetState(c->relaxation, n, state));
  PetscCall(PetscFree(state));
  ByCall(CheckpointReadReal(file, "interface/sums", 6, sums));
  c->solves       = (PetscInt)sums[0];
  c->mismatch     = sums[1];
  c->solves_sum   = sums[2];
  c->mismatch_sum = sums[3];
  c->n_unsettled  = (PetscInt)sums[4];
  c->balance_start = sums[5];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* write DIRECTORY/checkpoint.h5: everything a step reads */
PetscErrorCode CouplerSave(Coupler c, const char directory[], const char scene[])
{
  Checkpoint file;
  PetscReal  clock[3], internals[SPH_INTERNALS];

  PetscFunctionBegin;
  ByCall(CheckpointCreate(directory, &file));
  clock[0]  = c->time;
  clock[1]  = c->dt;
  clock[2]  = c->iterations_sum;
  ByCall(CheckpointWriteReal(file, "run/clock", 3, clock));
  ByCall(CheckpointWriteInt(file, "run/step", 1, &c->step));
  ByCall(CheckpointWriteString(file, "run/scene", scene));
  if (c->sph) {
    PetscInt         n;
    const PetscInt  *id;
    const PetscReal *x, *v, *p, *rho;

    PetscCall(SPHGetSize(c->sph, &n));
    PetscCall(SPHGetState(c->sph, &x, &v, &p, &rho, &id));
    ByCall(CheckpointWriteInt(file, "fluid/id", n, id));
    ByCall(CheckpointWriteReal(file, "fluid/position", 3 * n, x));
    ByCall(CheckpointWriteReal(file, "fluid/velocity", 3 * n, v));
    ByCall(CheckpointWriteReal(file, "fluid/pressure", n, p));
    PetscCall(SPHGetInternals(c->sph, internals));
    ByCall(CheckpointWriteReal(file, "fluid/internals", SPH_INTERNALS, internals));
    ByCall(SaveFlows(c->sph, file));
    ByCall(SaveInterface(c, file));
  }
  for (PetscInt k = 0; k < c->n_bodies; k++) ByCall(SaveBody(file, &c->surface[k]));
  for (PetscInt k = c->n_bodies; k < c->n_surfaces; k++)
    if (c->surface[k].moves) ByCall(SaveObstacle(file, &c->surface[k]));
  ByCall(CheckpointCommit(&file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadFluid(Coupler c, Checkpoint file)
{
  PetscInt  *id, n;
  PetscReal *x, *v, *p, internals[SPH_INTERNALS];

  PetscFunctionBegin;
  PetscCall(CheckpointGetSize(file, "fluid/id", &n));
  if (n < 0) PetscFunctionReturn(InputError("resume", "the checkpoint has no fluid, but the scene has one"));
  PetscCall(PetscMalloc4(n, &id, 3 * n, &x, 3 * n, &v, n, &p));
  ByCall(CheckpointReadInt(file, "fluid/id", n, id));
  ByCall(CheckpointReadReal(file, "fluid/position", 3 * n, x));
  ByCall(CheckpointReadReal(file, "fluid/velocity", 3 * n, v));
  ByCall(CheckpointReadReal(file, "fluid/pressure", n, p));
  PetscCall(SPHSetState(c->sph, n, id, x, v, p));
  ByCall(LoadFlows(c->sph, file));
  ByCall(CheckpointReadReal(file, "fluid/internals", SPH_INTERNALS, internals));
  PetscCall(SPHSetInternals(c->sph, internals));
  PetscCall(PetscFree4(id, x, v, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerLoad(Coupler c, const char directory[])
{
  Checkpoint file;
  PetscReal  clock[3];

  PetscFunctionBegin;
  ByCall(CheckpointOpen(directory, &file));
  ByCall(CheckpointReadReal(file, "run/clock", 3, clock));
  ByCall(CheckpointReadInt(file, "run/step", 1, &c->step));
  c->time           = clock[0];
  c->dt             = clock[1];
  c->iterations_sum = clock[2];
  if (c->sph) ByCall(LoadFluid(c, file));
  if (c->sph) ByCall(LoadInterface(c, file));
  for (PetscInt k = 0; k < c->n_bodies; k++) ByCall(LoadBody(c, file, &c->surface[k]));
  for (PetscInt k = c->n_bodies; k < c->n_surfaces; k++)
    if (c->surface[k].moves) ByCall(LoadObstacle(file, &c->surface[k]));
  PetscCall(CouplerPlaceObstacles(c));
  PetscCall(CheckpointClose(&file));
  PetscFunctionReturn(PETSC_SUCCESS);
}
