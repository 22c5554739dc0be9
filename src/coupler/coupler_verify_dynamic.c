/* coupler_verify_dynamic.c - the explicit solid at falling steps against a fine implicit run: how the difference falls.

   Implicit runs at a step and at half of it are extrapolated to no step at all, u = (4 u_half - u)/3 (both are of second order); what the
   finer of them is off that is printed as the reference's own error. Explicit runs are compared with u at `samples` times. */
#include "coupler_verify.h"

/* One run in time. */
typedef struct {
  PetscInt       n_steps;
  PetscReal      step;    /* [s]                                                                        */
  PetscReal     *u;       /* displacement at the samples, samples x (n_nodes x 3) [m]                   */
  PetscReal      drift;   /* largest imbalance of energy over the largest energy in motion and strain   */
  VerifyClock    time;    /* taken                                                                      */
  VerifyDifference apart; /* from the reference, worst of all samples                                   */
} Trajectory;

/* an implicit solver; unless the scene says otherwise it loses nothing of any mode (trapezoidal rule), as the explicit one */
static PetscErrorCode NewImplicit(Verify *v, TLEDImplicit *implicit)
{
  TLEDImplicitParams *params;
  PetscBool           named;
  char                option[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(TLEDImplicitCreate(PETSC_COMM_WORLD, VerifyBody(v, IMPLICIT), implicit));
  PetscCall(TLEDImplicitSetFromOptions(*implicit));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_implicit_rho_infinity", VerifyName(v)));
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &named));
  PetscCall(TLEDImplicitGetParams(*implicit, &params));
  if (!named) params->rho_infinity = 1.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode KeepSample(Verify *v, int side, PetscReal u[])
{
  const PetscReal *x;
  PetscInt         n;
  Vec              vec;

  PetscFunctionBegin;
  PetscCall(TLEDGetSize(VerifyBody(v, side), &n, NULL));
  PetscCall(TLEDGetVectors(VerifyBody(v, side), &vec, NULL, NULL));
  PetscCall(VecGetArrayRead(vec, &x));
  PetscCall(PetscArraycpy(u, x, 3 * n));
  PetscCall(VecRestoreArrayRead(vec, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* energy that should not change [J], and the part of it that moves to and fro */
static PetscErrorCode Energy(TLED tled, PetscReal *balance, PetscReal *moving)
{
  TLEDStats s;

  PetscFunctionBegin;
  PetscCall(TLEDGetStats(tled, &s));
  *moving  = s.kinetic + s.strain;
  *balance = s.kinetic + s.strain + s.gravity_potential + s.damping_loss - s.external_work;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the part of a run up to the next sample */
static PetscErrorCode AdvanceSide(Verify *v, int side, TLEDImplicit implicit, const Trajectory *m, PetscInt n_steps)
{
  TLED           tled = VerifyBody(v, side);
  PetscErrorCode ierr = PETSC_SUCCESS;
  PetscInt       taken;

  PetscFunctionBegin;
  if (side == IMPLICIT) ierr = TLEDImplicitAdvance(implicit, m->step, n_steps);
  for (PetscInt k = 0; k < n_steps && !ierr && side == EXPLICIT; k++) {
    ierr = TLEDAdvance(tled, m->step, &taken);
    if (!ierr && taken != 1)
      PetscFunctionReturn(InputError("verify.steps", "%s has stiffened: a step of %g s is no longer stable\nask for smaller ones, or a shorter duration", VerifyName(v),
                                     (double)m->step));
  }
  if (ierr == BY_ERR_BREAKDOWN) ByCall(VerifyBreakdown(v, side, side == IMPLICIT ? "implicit motion" : "explicit motion"));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one run from the state that was saved, m->n_steps steps */
static PetscErrorCode Move(Verify *v, int side, Trajectory *m)
{
  TLED           tled = VerifyBody(v, side);
  TLEDImplicit   implicit = NULL;
  const PetscInt samples = v->params.samples;
  PetscReal      start_energy = 0.0, moving, largest = 0.0, worst = 0.0;
  VerifyClock    start, now;
  PetscInt       n;

  PetscFunctionBegin;
  PetscCall(TLEDGetSize(tled, &n, NULL));
  PetscCall(TLEDRestore(tled));
  m->step = v->params.duration / m->n_steps;
  PetscCall(PetscMalloc1(samples * 3 * n, &m->u));
  PetscCall(VerifyClockRead(&start));
  if (side == IMPLICIT) PetscCall(NewImplicit(v, &implicit));
  PetscCall(Energy(tled, &start_energy, &largest));
  for (PetscInt k = 0; k < samples; k++) {
    PetscReal energy = 0.0;

    ByCall(AdvanceSide(v, side, implicit, m, m->n_steps / samples));
    PetscCall(KeepSample(v, side, &m->u[k * 3 * n]));
    PetscCall(Energy(tled, &energy, &moving));
    largest = PetscMax(largest, moving);
    worst   = PetscMax(worst, PetscAbsReal(energy - start_energy));
  }
  m->drift = largest > 0.0 ? worst / largest : 0.0;
  PetscCall(VerifyClockRead(&now));
  m->time.wall = now.wall - start.wall;
  m->time.cpu  = now.cpu - start.cpu;
  if (implicit) PetscCall(TLEDImplicitDestroy(&implicit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* worst of all samples; differences are relative to the largest displacement of the whole run */
static VerifyDifference CompareRuns(PetscInt samples, PetscInt n, const PetscReal a[], const PetscReal b[])
{
  VerifyDifference worst = {0.0, 0.0, 0.0};

  for (PetscInt k = 0; k < samples; k++) {
    const VerifyDifference d = VerifyCompare(n, &a[k * 3 * n], &b[k * 3 * n]);

    worst.largest = PetscMax(worst.largest, d.largest);
    worst.max     = PetscMax(worst.max, d.max * d.largest);
    worst.rms     = PetscMax(worst.rms, d.rms * d.largest);
  }
  if (worst.largest > 0.0) {
    worst.max /= worst.largest;
    worst.rms /= worst.largest;
  }
  return worst;
}

/* two implicit runs, extrapolated into reference->u */
static PetscErrorCode Reference(Verify *v, PetscInt n, PetscReal critical, Trajectory *reference)
{
  const PetscInt samples = v->params.samples;
  Trajectory         coarse  = {0};

  PetscFunctionBegin;
  coarse.n_steps     = samples * (PetscInt)PetscCeilReal(v->params.duration / (samples * v->params.implicit_step * critical));
  reference->n_steps = 2 * coarse.n_steps;
  ByCall(Move(v, IMPLICIT, &coarse));
  ByCall(Move(v, IMPLICIT, reference));
  for (PetscInt k = 0; k < samples * 3 * n; k++) coarse.u[k] = (4.0 * reference->u[k] - coarse.u[k]) / 3.0;
  reference->apart = CompareRuns(samples, n, reference->u, coarse.u);
  PetscCall(PetscArraycpy(reference->u, coarse.u, samples * 3 * n));
  reference->time.wall += coarse.time.wall;
  reference->time.cpu += coarse.time.cpu;
  PetscCall(PetscFree(coarse.u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MotionEntry(Verify *v, const char key[], const Trajectory *m, PetscReal order)
{
  PetscFunctionBegin;
  PetscCall(JsonBegin(v->json, key));
  PetscCall(JsonReal(v->json, "step", m->step));
  PetscCall(JsonInt(v->json, "steps", m->n_steps));
  PetscCall(JsonReal(v->json, "difference_max", m->apart.max));
  PetscCall(JsonReal(v->json, "difference_rms", m->apart.rms));
  PetscCall(JsonReal(v->json, "energy_drift", m->drift));
  PetscCall(JsonReal(v->json, "seconds", m->time.wall));
  PetscCall(JsonReal(v->json, "cpu_seconds", m->time.cpu));
  if (order != 0.0) PetscCall(JsonReal(v->json, "order", order));
  PetscCall(JsonEnd(v->json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Order(const Trajectory *coarse, const Trajectory *fine)
{
  return PetscLogReal(coarse->apart.max / fine->apart.max) / PetscLogReal(coarse->step / fine->step);
}

static PetscErrorCode PrintTable(Verify *v, const Trajectory *reference, PetscInt n_runs, const Trajectory runs[])
{
  char            text[160];
  const Trajectory   *finest = &runs[n_runs - 1];
  const PetscReal order  = n_runs > 1 ? Order(&runs[n_runs - 2], finest) : 0.0;

  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  dynamic, %g s; differences relative to the largest displacement, %.6g m\n", (double)v->params.duration,
                        (double)reference->apart.largest));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-10s %12s %8s %14s %12s %7s %13s %10s\n", "", "step [s]", "steps", "difference", "rms", "order", "energy drift", "time [s]"));
  PetscCall(JsonBegin(v->json, "dynamic"));
  PetscCall(JsonReal(v->json, "duration", v->params.duration));
  PetscCall(JsonReal(v->json, "displacement", reference->apart.largest));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-10s %12.4e %8" PetscInt_FMT " %14.3e %12.3e %7s %13s %10.3g\n", "implicit", (double)reference->step,
                        reference->n_steps, (double)reference->apart.max, (double)reference->apart.rms, "", "", reference->time.wall));
  PetscCall(MotionEntry(v, "implicit", reference, 0.0));
  for (PetscInt k = 0; k < n_runs; k++) {
    const PetscReal p = k ? Order(&runs[k - 1], &runs[k]) : 0.0;
    char            key[32], shown[16] = "";

    PetscCall(PetscSNPrintf(key, sizeof(key), "explicit_%d", (int)k + 1));
    if (k) PetscCall(PetscSNPrintf(shown, sizeof(shown), "%.2f", (double)p));
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-10s %12.4e %8" PetscInt_FMT " %14.3e %12.3e %7s %13.2e %10.3g\n", "explicit", (double)runs[k].step,
                          runs[k].n_steps, (double)runs[k].apart.max, (double)runs[k].apart.rms, shown, (double)runs[k].drift, runs[k].time.wall));
    PetscCall(MotionEntry(v, key, &runs[k], p));
  }
  PetscCall(JsonReal(v->json, "order", order));
  PetscCall(JsonReal(v->json, "tolerance", v->params.dynamic_tolerance));
  PetscCall(JsonEnd(v->json));
  PetscCall(PetscSNPrintf(text, sizeof(text), "difference of the finest run %.2e, allowed %.2g", (double)finest->apart.max, (double)v->params.dynamic_tolerance));
  PetscCall(VerifyJudge(v, text, (PetscBool)(finest->apart.max <= v->params.dynamic_tolerance)));
  if (v->params.order > 0.0 && n_runs > 1) {
    PetscCall(PetscSNPrintf(text, sizeof(text), "observed order %.2f, at least %.2f asked", (double)order, (double)v->params.order));
    PetscCall(VerifyJudge(v, text, (PetscBool)(order >= v->params.order)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* node that moves most in the reference */
static PetscInt BusiestNode(PetscInt samples, PetscInt n, const PetscReal u[])
{
  PetscInt  node = 0;
  PetscReal most = -1.0;

  for (PetscInt k = 0; k < samples * n; k++) {
    const PetscReal *a = &u[3 * k], square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];

    if (square <= most) continue;
    most = square;
    node = k % n;
  }
  return node;
}

/* <body>_dynamic.csv: the node that moves most, in the reference and in the finest explicit run, and the difference of every run */
static PetscErrorCode History(Verify *v, PetscInt n, const Trajectory *reference, PetscInt n_runs, const Trajectory runs[])
{
  const PetscInt samples = v->params.samples, node = BusiestNode(samples, n, reference->u);
  char           file[2 * BY_NAME_MAX], names[BY_REALS_MAX][64];
  const char    *headers[7 + BY_REALS_MAX] = {"time [s]", "implicit_x [m]", "implicit_y [m]", "implicit_z [m]", "explicit_x [m]", "explicit_y [m]", "explicit_z [m]"};
  Table          table;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s_dynamic.csv", VerifyName(v)));
  for (PetscInt k = 0; k < n_runs; k++) {
    PetscCall(PetscSNPrintf(names[k], sizeof(names[k]), "difference, step %.3e s [m]", (double)runs[k].step));
    headers[7 + k] = names[k];
  }
  ByCall(TableCreate(v->params.directory, file, 7 + n_runs, headers, PETSC_FALSE, 0.0, &table));
  for (PetscInt s = 0; s < samples; s++) {
    PetscReal row[7 + BY_REALS_MAX];

    row[0] = v->params.duration * (PetscReal)(s + 1) / samples;
    for (int i = 0; i < 3; i++) {
      row[1 + i] = reference->u[3 * (s * n + node) + i];
      row[4 + i] = runs[n_runs - 1].u[3 * (s * n + node) + i];
    }
    for (PetscInt k = 0; k < n_runs; k++) {
      const VerifyDifference d = VerifyCompare(n, &runs[k].u[3 * s * n], &reference->u[3 * s * n]);

      row[7 + k] = d.max * d.largest;
    }
    ByCall(TableWrite(table, row));
  }
  PetscCall(TableDestroy(&table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Results(Verify *v, PetscInt n, const Trajectory *reference, const Trajectory *finest)
{
  Series series[2];

  PetscFunctionBegin;
  ByCall(VerifySeriesCreate(v, "dynamic_explicit", &series[EXPLICIT]));
  ByCall(VerifySeriesCreate(v, "dynamic_implicit", &series[IMPLICIT]));
  for (PetscInt s = 0; s < v->params.samples; s++) {
    const PetscReal  time = v->params.duration * (PetscReal)(s + 1) / v->params.samples;
    const PetscReal *a = &finest->u[3 * s * n], *b = &reference->u[3 * s * n];

    ByCall(VerifySeriesWrite(v, series[EXPLICIT], time, a, b));
    ByCall(VerifySeriesWrite(v, series[IMPLICIT], time, b, NULL));
  }
  for (int side = 0; side < 2; side++) PetscCall(SeriesDestroy(&series[side]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* explicit runs; each step is a whole part of the next larger one, as near to what was asked as that allows */
static PetscErrorCode ExplicitRuns(Verify *v, PetscInt n, PetscReal critical, const Trajectory *reference, Trajectory runs[])
{
  const VerifyParams *p = &v->params;
  const PetscInt      first = p->samples * (PetscInt)PetscCeilReal(p->duration / (p->samples * p->steps.value[0] * critical));

  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->steps.n; k++) {
    runs[k].n_steps = p->samples * PetscMax(1, (PetscInt)PetscFloorReal(0.5 + first * p->steps.value[0] / (p->samples * p->steps.value[k])));
    ByCall(Move(v, EXPLICIT, &runs[k]));
    runs[k].apart = CompareRuns(p->samples, n, runs[k].u, reference->u);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ VerifyDynamic - implicit reference, explicit runs at every step, table, history; both sides are put back to where they were @*/
PetscErrorCode VerifyDynamic(Verify *v)
{
  Trajectory      reference = {0}, runs[BY_REALS_MAX] = {{0}};
  PetscReal   critical;
  PetscInt    n;

  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) PetscCall(TLEDSave(VerifyBody(v, side)));
  PetscCall(TLEDGetSize(VerifyBody(v, EXPLICIT), &n, NULL));
  ByCall(TLEDGetCriticalStep(VerifyBody(v, EXPLICIT), &critical));
  ByCall(Reference(v, n, critical, &reference));
  ByCall(ExplicitRuns(v, n, critical, &reference, runs));
  ByCall(PrintTable(v, &reference, v->params.steps.n, runs));
  ByCall(History(v, n, &reference, v->params.steps.n, runs));
  ByCall(Results(v, n, &reference, &runs[v->params.steps.n - 1]));
  for (int side = 0; side < 2; side++) PetscCall(TLEDRestore(VerifyBody(v, side)));
  PetscCall(PetscFree(reference.u));
  for (PetscInt k = 0; k < v->params.steps.n; k++) PetscCall(PetscFree(runs[k].u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
