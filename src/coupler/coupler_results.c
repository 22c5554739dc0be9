/* coupler_results.c - what a run writes: time series of fluid, bodies and proxies, ledger.csv, probes.csv, summary.json. */
#include "coupler_results.h"
#include "coupler_fields.h"
#include "backend.h"
#include <petscviewer.h>
#include <sys/resource.h>
#include <sys/stat.h>

static const char *const ledger_headers[] = {
  "time [s]", "step [1]", "dt [s]", "iterations [1]", "substeps [1]", "proxies [1]", "penetrations [1]", "compression_mean [1]",
  "compression_max [1]", "fluid_kinetic [J]", "fluid_potential [J]", "fluid_viscous_loss [J]", "solid_kinetic [J]", "solid_strain [J]",
  "solid_potential [J]", "solid_damping_loss [J]", "work_fluid [J]", "work_solid [J]", "momentum_x [kg m/s]", "momentum_y [kg m/s]",
  "momentum_z [kg m/s]", "angular_x [kg m^2/s]", "angular_y [kg m^2/s]", "angular_z [kg m^2/s]", "fluid_speed_max [m/s]",
  "fluid_speed_rms [m/s]", "solid_volume [m^3]",
  "solid_contact_energy [J]", "solid_external_work [J]", "work_motion [J]",
  "fluid_particles [1]", "fluid_entered [m^3]", "fluid_left [m^3]",
  "work_exchanged [J]", "solves [1]", "interface_residual [1]", "energy [J]", "energy_error [J]"};

enum { N_LEDGER = sizeof(ledger_headers) / sizeof(ledger_headers[0]) };

/*@ CouplerResultsCreate - open all files of a run; on a resume, rows and steps later than the coupler's time are dropped @*/
PetscErrorCode CouplerResultsCreate(Coupler c, const char directory[], const char scene[], PetscBool append, CouplerResults *r)
{
  char        headers[3 * BY_NAMES_MAX + 1][2 * BY_NAME_MAX];
  const char *pointers[3 * BY_NAMES_MAX + 1];
  PetscInt    n;

  PetscFunctionBegin;
  *r = (CouplerResults){0};
  PetscCall(PetscStrncpy(r->directory, directory, sizeof(r->directory)));
  ByCall(TableCreate(directory, "ledger.csv", N_LEDGER, ledger_headers, append, c->time, &r->ledger));
  if (c->n_probes) {
    PetscCall(CouplerProbeHeaders(c, &n, headers));
    for (PetscInt k = 0; k < n; k++) pointers[k] = headers[k];
    if (n > 1) ByCall(TableCreate(directory, "probes.csv", n, pointers, append, c->time, &r->probes));
    for (PetscInt k = 0; k < c->n_probes; k++)
      if (c->probe[k].n_points) ByCall(CouplerProfileCreate(&c->probe[k], directory, append, c->time, &r->profile[k]));
  }
  if (c->sph) ByCall(SeriesCreate(directory, "fluid", SERIES_POINTS, scene, append, c->time, &r->fluid));
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    CouplerSurface *s = &c->surface[k];
    char            name[2 * BY_NAME_MAX];

    if (s->tled) {
      PetscInt        n_nodes, n_tets, n_corners;
      const PetscInt *tets;

      PetscCall(TLEDGetSize(s->tled, &n_nodes, &n_tets));
      PetscCall(TLEDGetMesh(s->tled, &n_corners, &tets, NULL));
      ByCall(SeriesCreate(directory, s->name, n_corners == 4 ? SERIES_TETRAHEDRA : SERIES_TETRAHEDRA_QUADRATIC, scene, append, c->time, &r->body[k]));
      ByCall(SeriesSetCells(r->body[k], n_tets, tets));
    } else {
      ByCall(SeriesCreate(directory, s->name, SERIES_TRIANGLES, scene, append, c->time, &r->body[k]));
      ByCall(SeriesSetCells(r->body[k], s->n_triangles, s->triangles));
    }
    if (!s->proxy) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_proxies", s->name));
    ByCall(SeriesCreate(directory, name, SERIES_POINTS, scene, append, c->time, &r->proxies[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteLedger(Coupler c, CouplerResults *r)
{
  CouplerLedger l;

  PetscFunctionBegin;
  PetscCall(CouplerGetLedger(c, &l));
  r->penetrations_max    = PetscMax(r->penetrations_max, l.penetrations);
  r->compression_mean_sum += l.compression_mean;
  r->compression_max     = PetscMax(r->compression_max, l.compression_max);
  r->n_rows++;
  if (r->n_rows == 1) PetscCall(PetscArraycpy(r->momentum_start, l.momentum, 3));
  PetscCall(PetscArraycpy(r->momentum_end, l.momentum, 3));
  const PetscReal row[N_LEDGER] = {l.time, (PetscReal)l.step, l.dt, (PetscReal)l.iterations, (PetscReal)l.substeps, (PetscReal)l.proxies,
                                   (PetscReal)l.penetrations, l.compression_mean, l.compression_max, l.fluid_kinetic, l.fluid_potential,
                                   l.fluid_viscous_loss, l.solid_kinetic, l.solid_strain, l.solid_potential, l.solid_damping_loss, l.work_fluid,
                                   l.work_solid, l.momentum[0], l.momentum[1], l.momentum[2], l.angular[0], l.angular[1], l.angular[2],
                                   l.speed_max, l.speed_rms, l.solid_volume, l.solid_contact_energy,
                                   l.solid_external_work, l.work_motion, (PetscReal)l.fluid_particles, l.fluid_entered, l.fluid_left,
                                   l.work_exchanged, (PetscReal)l.solves, l.interface_residual, l.energy, l.energy_error};
  ByCall(TableWrite(r->ledger, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* fields of the water on a surface, behind those that it has anyway; the number of all */
static PetscInt AppendFields(const CouplerFields *water, PetscInt n, OutputField fields[])
{
  fields[n++] = (OutputField){"pressure", "Pa", 1, water->pressure};
  fields[n++] = (OutputField){"water", "1", 1, water->water};
  fields[n++] = (OutputField){"water_pressure", "Pa", 1, water->water_pressure};
  fields[n++] = (OutputField){"water_velocity", "m/s", 3, water->water_velocity};
  return n;
}

static PetscErrorCode WriteNodes(Coupler c, CouplerResults *r, PetscInt k, const CouplerFields *water)
{
  CouplerSurface  *s = &c->surface[k];
  const PetscReal *x, *v, *u;
  Vec              U, V, F;

  PetscFunctionBegin;
  if (!s->tled) {
    OutputField fields[4];

    if (!s->proxy && !s->moves && r->n_series) PetscFunctionReturn(PETSC_SUCCESS);
    ByCall(SeriesWrite(r->body[k], c->time, s->n_nodes, s->x, s->proxy ? AppendFields(water, 0, fields) : 0, fields));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArrayRead(U, &u));
  OutputField fields[7] = {{"displacement", "m", 3, u}, {"velocity", "m/s", 3, v}, {"force", "N", 3, s->force}};
  ByCall(SeriesWrite(r->body[k], c->time, s->n_nodes, x, s->proxy ? AppendFields(water, 3, fields) : 3, fields));
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteBody(Coupler c, CouplerResults *r, PetscInt k)
{
  const PetscReal *x, *normal, *kappa, *area;
  CouplerFields    at_proxies, at_nodes;
  PetscInt         n;

  PetscFunctionBegin;
  if (!r->proxies[k]) {
    ByCall(WriteNodes(c, r, k, NULL));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CouplerFieldsCreate(c, k, &at_proxies, &at_nodes));
  ByCall(WriteNodes(c, r, k, &at_nodes));
  PetscCall(ProxyGetPoints(c->surface[k].proxy, &n, &x, &normal, &kappa, &area));
  OutputField fields[7] = {{"normal", "1", 3, normal}, {"kappa", "1", 1, kappa}, {"area", "m^2", 1, area}};
  ByCall(SeriesWrite(r->proxies[k], c->time, n, x, AppendFields(&at_proxies, 3, fields), fields));
  PetscCall(CouplerFieldsDestroy(&at_proxies));
  PetscCall(CouplerFieldsDestroy(&at_nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteFields(Coupler c, CouplerResults *r)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n_probes; k++)
    if (r->profile[k]) ByCall(CouplerProfileWrite(c, &c->probe[k], r->profile[k]));
  if (r->fluid) {
    PetscInt         n;
    const PetscReal *x, *v, *p, *rho;
    const PetscInt  *id;

    PetscCall(SPHGetSize(c->sph, &n));
    PetscCall(SPHGetState(c->sph, &x, &v, &p, &rho, &id));
    const OutputField fields[] = {{"velocity", "m/s", 3, v}, {"pressure", "Pa", 1, p}, {"density", "kg/m^3", 1, rho}};
    ByCall(SeriesWrite(r->fluid, c->time, n, x, 3, fields));
  }
  for (PetscInt k = 0; k < c->n_surfaces; k++) ByCall(WriteBody(c, r, k));
  r->n_series++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ CouplerResultsWrite - append the current state to the tables and, with `fields`, to all other files @*/
PetscErrorCode CouplerResultsWrite(Coupler c, CouplerResults *r, PetscBool fields)
{
  PetscReal row[3 * BY_NAMES_MAX + 1];

  PetscFunctionBegin;
  PetscCall(CouplerTimer(c, N_PHASES));
  ByCall(WriteLedger(c, r));
  if (r->probes) {
    PetscCall(CouplerProbeRow(c, row));
    ByCall(TableWrite(r->probes, row));
  }
  if (fields) ByCall(WriteFields(c, r));
  PetscCall(CouplerTimer(c, PHASE_OUTPUT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SummaryFluid(Coupler c, CouplerResults *r, Json json)
{
  static const char *const precisions[] = {"single", "double"};
  const char              *solver;
  SPHParams               *params;
  SPHStats                 stats;
  PetscInt                 n;
  PetscReal                seconds = 0.0;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(c->sph, &params));
  PetscCall(SPHGetSolver(c->sph, &solver, NULL));
  PetscCall(SPHGetSize(c->sph, &n));
  for (int k = 0; k < PHASE_SOLID; k++) seconds += c->phase[k];
  PetscCall(JsonBegin(json, "fluid"));
  PetscCall(JsonInt(json, "particles", n));
  PetscCall(JsonString(json, "solver", solver));
  PetscCall(JsonString(json, "precision", precisions[params->precision]));
  PetscCall(JsonReal(json, "iterations_mean", c->iterations_sum / PetscMax(1, c->step)));
  PetscCall(SPHGetStats(c->sph, &stats));
  if (stats.viscous_solves) {
    PetscCall(JsonInt(json, "viscosity_solves", stats.viscous_solves));
    PetscCall(JsonReal(json, "viscosity_iterations_mean", (PetscReal)stats.viscous_iterations / (PetscReal)stats.viscous_solves));
  }
  PetscCall(JsonReal(json, "density_error_mean", r->compression_mean_sum / PetscMax(1, r->n_rows)));
  PetscCall(JsonReal(json, "density_error_max", r->compression_max));
  PetscCall(JsonReal(json, "seconds_per_step", seconds / PetscMax(1, r->steps)));
  PetscCall(JsonEnd(json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SummaryBodies(Coupler c, Json json)
{
  PetscFunctionBegin;
  PetscCall(JsonBegin(json, "bodies"));
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    CouplerSurface *s = &c->surface[k];
    PetscInt        n_nodes, n_tets;
    PetscReal       added;
    const char     *scheme;

    PetscCall(JsonBegin(json, s->name));
    if (s->tled) {
      PetscCall(TLEDGetSize(s->tled, &n_nodes, &n_tets));
      PetscCall(JsonInt(json, "nodes", n_nodes));
      PetscCall(JsonInt(json, "tets", n_tets));
      PetscCall(TLEDGetAddedMass(s->tled, NULL, &added));
      PetscCall(JsonReal(json, "added_mass_percent", added));
      if (c->sph) {
        PetscCall(CouplerGetScheme(c, k, &scheme));
        PetscCall(JsonString(json, "scheme", scheme));
        PetscCall(JsonReal(json, "water_over_mass", s->water));
        if (s->stiffness >= 0.0) PetscCall(JsonReal(json, "omega_dt", PetscSqrtReal(s->stiffness)));
      }
    }
    PetscCall(JsonReal(json, "proxies_mean", s->n_proxies_sum / PetscMax(1, c->step)));
    if (s->proxy) {
      PetscInt sampled, samplings;

      PetscCall(ProxyGetCounts(s->proxy, NULL, &sampled, &samplings));
      PetscCall(JsonInt(json, "proxies_sampled", sampled));
      PetscCall(JsonInt(json, "samplings", samplings));
    }
    if (s->tled) {
      PetscCall(JsonReal(json, "substeps", s->n_substeps_sum / PetscMax(1, c->step)));
      if (c->n_bodies == 1) PetscCall(JsonReal(json, "seconds_per_element_step", c->phase[PHASE_SOLID] / PetscMax(1.0, s->n_substeps_run * n_tets)));
    }
    PetscCall(JsonEnd(json));
  }
  PetscCall(JsonEnd(json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ CouplerResultsSummary - write summary.json; status is done, breakdown, interrupted or stopped @*/
PetscErrorCode CouplerResultsSummary(Coupler c, CouplerResults *r, const char status[], PetscReal wall_seconds)
{
  static const char *const phases[] = {"neighbours", "pressure", "proxies", "transfer", "solid", "output"};
  Json                     json;
  PetscInt                 threads, n_devices;
  struct rusage            usage;
  PetscReal                work_fluid = 0.0, work_solid = 0.0, work_exchanged = 0.0, drift = 0.0, cpu = 0.0;
  char                     device[256];
  const char              *reason;
  PetscBool                broken;

  PetscFunctionBegin;
  getrusage(RUSAGE_SELF, &usage);
  PetscCall(BackendGetThreads(&threads));
  PetscCall(BackendGetDevice(&n_devices, device, sizeof(device)));
  ByCall(JsonCreate(r->directory, "summary.json", &json));
  PetscCall(JsonString(json, "status", status));
  PetscCall(PetscStrcmp(status, "breakdown", &broken));
  if (broken) {
    PetscCall(CouplerGetBreakdown(c, &reason));
    PetscCall(JsonString(json, "reason", reason));
  }
  PetscCall(JsonInt(json, "steps", c->step));
  PetscCall(JsonReal(json, "time_end", c->time));
  PetscCall(JsonReal(json, "wall_seconds", wall_seconds));
  PetscCall(JsonReal(json, "cpu_seconds", (PetscReal)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                                            1e-6 * (PetscReal)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec)));
  for (int k = 0; k < PHASE_OUTPUT; k++) cpu += c->phase_cpu[k];
  PetscCall(JsonReal(json, "cpu_seconds_per_step", cpu / PetscMax(1, r->steps)));
  PetscCall(JsonBegin(json, "phases"));
  for (int k = 0; k < N_PHASES; k++) PetscCall(JsonReal(json, phases[k], c->phase[k]));
  PetscCall(JsonEnd(json));
  PetscCall(JsonBegin(json, "phases_cpu"));
  for (int k = 0; k < N_PHASES; k++) PetscCall(JsonReal(json, phases[k], c->phase_cpu[k]));
  PetscCall(JsonEnd(json));
  if (c->sph) PetscCall(SummaryFluid(c, r, json));
  if (c->n_surfaces) PetscCall(SummaryBodies(c, json));
  if (c->sph && c->n_surfaces) {
    for (PetscInt k = 0; k < c->n_surfaces; k++) {
      work_fluid += c->surface[k].work_fluid;
      work_solid += c->surface[k].work_solid;
      work_exchanged += c->surface[k].work_exchanged;
    }
    for (int i = 0; i < 3; i++) drift = PetscMax(drift, PetscAbsReal(r->momentum_end[i] - r->momentum_start[i]));
    PetscCall(JsonBegin(json, "coupling"));
    PetscCall(JsonString(json, "scheme", CouplerSchemeName(c)));
    PetscCall(JsonReal(json, "solves_mean", c->solves_sum / PetscMax(1, c->step)));
    PetscCall(JsonInt(json, "unsettled_steps", c->n_unsettled));
    PetscCall(JsonReal(json, "work_fluid", work_fluid));
    PetscCall(JsonReal(json, "work_solid", work_solid));
    PetscCall(JsonReal(json, "work_exchanged", work_exchanged));
    PetscCall(JsonReal(json, "momentum_drift", drift));
    PetscCall(JsonInt(json, "penetrations", r->penetrations_max));
    PetscCall(JsonEnd(json));
  }
  PetscCall(JsonString(json, "backend", "openmp"));
  PetscCall(JsonInt(json, "threads", threads));
  PetscCall(JsonInt(json, "ranks", 1));
  PetscCall(JsonString(json, "device", device));
  PetscCall(JsonString(json, "version", BYSSUS_VERSION));
  ByCall(JsonDestroy(&json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerResultsDestroy(CouplerResults *r)
{
  PetscFunctionBegin;
  PetscCall(TableDestroy(&r->ledger));
  PetscCall(TableDestroy(&r->probes));
  for (PetscInt k = 0; k < BY_NAMES_MAX; k++) PetscCall(TableDestroy(&r->profile[k]));
  PetscCall(SeriesDestroy(&r->fluid));
  for (PetscInt k = 0; k < COUPLER_MAX_SURFACES; k++) {
    PetscCall(SeriesDestroy(&r->body[k]));
    PetscCall(SeriesDestroy(&r->proxies[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
