/* coupler_verify_static.c - equilibrium by dynamic relaxation of the explicit solid against Newton's method on the same mesh. */
#include "coupler_verify.h"

/* One way to equilibrium. */
typedef struct {
  PetscReal     *u;         /* displacement, n_nodes x 3 [m]                       */
  PetscReal      energy;    /* strain energy [J]                                   */
  PetscReal      residual;  /* relative                                            */
  PetscInt       steps;     /* of the explicit solid, or Newton iterations         */
  VerifyClock    time;      /* taken                                               */
} Equilibrium;

static PetscErrorCode Elapsed(const VerifyClock *start, VerifyClock *elapsed)
{
  VerifyClock now;

  PetscFunctionBegin;
  PetscCall(VerifyClockRead(&now));
  elapsed->wall = now.wall - start->wall;
  elapsed->cpu  = now.cpu - start->cpu;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* copy the state that a side came to */
static PetscErrorCode Keep(Verify *v, int side, Equilibrium *e)
{
  const PetscReal *x;
  PetscInt         n;
  TLEDStats        stats;
  Vec              u;

  PetscFunctionBegin;
  PetscCall(TLEDGetSize(VerifyBody(v, side), &n, NULL));
  PetscCall(TLEDGetVectors(VerifyBody(v, side), &u, NULL, NULL));
  PetscCall(PetscMalloc1(3 * n, &e->u));
  PetscCall(VecGetArrayRead(u, &x));
  PetscCall(PetscArraycpy(e->u, x, 3 * n));
  PetscCall(VecRestoreArrayRead(u, &x));
  PetscCall(TLEDGetStats(VerifyBody(v, side), &stats));
  e->energy = stats.strain;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveExplicit(Verify *v, Equilibrium *e)
{
  TLED           tled = VerifyBody(v, EXPLICIT);
  VerifyClock    start;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(VerifyClockRead(&start));
  ierr = TLEDRelax(tled, v->params.time, v->params.relax_tolerance, v->params.relax_steps, &e->steps, &e->residual);
  if (ierr == BY_ERR_BREAKDOWN) ByCall(VerifyBreakdown(v, EXPLICIT, "explicit relaxation"));
  ByCall(ierr);
  PetscCall(Elapsed(&start, &e->time));
  PetscCall(Keep(v, EXPLICIT, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveImplicit(Verify *v, Equilibrium *e)
{
  TLED              tled = VerifyBody(v, IMPLICIT);
  TLEDImplicit      implicit;
  TLEDImplicitStats stats;
  VerifyClock       start;
  PetscErrorCode    ierr;

  PetscFunctionBegin;
  PetscCall(VerifyClockRead(&start));
  PetscCall(TLEDImplicitCreate(PETSC_COMM_WORLD, tled, &implicit));
  PetscCall(TLEDImplicitSetFromOptions(implicit));
  ierr = TLEDImplicitSolveStatic(implicit, v->params.time);
  PetscCall(TLEDImplicitGetStats(implicit, &stats));
  PetscCall(TLEDImplicitDestroy(&implicit));
  if (ierr == BY_ERR_BREAKDOWN) ByCall(VerifyBreakdown(v, IMPLICIT, "implicit static solve"));
  ByCall(ierr);
  e->steps    = stats.newton;
  e->residual = stats.residual;
  PetscCall(Elapsed(&start, &e->time));
  PetscCall(Keep(v, IMPLICIT, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* without an explicit side its numbers are left out */
static PetscBool Alone(const Verify *v) { return (PetscBool)(v->params.kind == VERIFY_IMPLICIT); }

static PetscReal Relative(PetscReal a, PetscReal b) { return PetscAbsReal(b) > 0.0 ? PetscAbsReal(a / b - 1.0) : PetscAbsReal(a); }

/* one row of the table, and its entry in the summary */
static PetscErrorCode Row(Verify *v, const char label[], const char key[], PetscReal a, PetscReal b, PetscReal difference)
{
  char shown[64] = "";

  PetscFunctionBegin;
  if (!Alone(v)) PetscCall(PetscSNPrintf(shown, sizeof(shown), "%.10g", (double)a));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-34s %18s %18.10g", label, shown, (double)b));
  if (difference >= 0.0 && !Alone(v)) PetscCall(PetscPrintf(PETSC_COMM_WORLD, " %12.2e", (double)difference));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "\n"));
  PetscCall(JsonBegin(v->json, key));
  if (!Alone(v)) PetscCall(JsonReal(v->json, "explicit", a));
  PetscCall(JsonReal(v->json, "implicit", b));
  if (difference >= 0.0 && !Alone(v)) PetscCall(JsonReal(v->json, "difference", difference));
  PetscCall(JsonEnd(v->json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* force and moment that the supports of one group apply to the body, on both sides; differences relative to the vectors' lengths */
static PetscErrorCode ReactionRows(Verify *v, const char group[])
{
  PetscReal   force[2][3], moment[2][3];
  const char *names[2] = {"force", "moment"}, *units[2] = {"N", "N m"};

  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) PetscCall(TLEDGetReaction(VerifyBody(v, side), group, force[side], moment[side]));
  PetscCall(JsonBegin(v->json, group));
  for (int q = 0; q < 2; q++) {
    const PetscReal *a = q ? moment[EXPLICIT] : force[EXPLICIT], *b = q ? moment[IMPLICIT] : force[IMPLICIT];
    const PetscReal  length = PetscSqrtReal(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);

    for (int i = 0; i < 3; i++) {
      char label[128], key[32];

      PetscCall(PetscSNPrintf(label, sizeof(label), "%s of %s, %c [%s]", names[q], group, "xyz"[i], units[q]));
      PetscCall(PetscSNPrintf(key, sizeof(key), "%s_%c", names[q], "xyz"[i]));
      PetscCall(Row(v, label, key, a[i], b[i], length > 0.0 ? PetscAbsReal(a[i] - b[i]) / length : 0.0));
    }
  }
  PetscCall(JsonEnd(v->json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* names without those that are there already */
static PetscErrorCode Add(Names *all, const Names *more)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < more->n && all->n < BY_NAMES_MAX; k++) {
    PetscBool known = PETSC_FALSE;

    for (PetscInt j = 0; j < all->n && !known; j++) PetscCall(PetscStrcmp(all->name[j], more->name[k], &known));
    if (!known) PetscCall(PetscStrncpy(all->name[all->n++], more->name[k], BY_NAME_MAX));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of every physical group that is held or moved */
static PetscErrorCode Reactions(Verify *v)
{
  TLEDParams          *params;
  TLEDConstraintParams support;
  Names                groups = {0};

  PetscFunctionBegin;
  PetscCall(TLEDGetParams(VerifyBody(v, EXPLICIT), &params));
  PetscCall(Add(&groups, &params->fixed));
  PetscCall(Add(&groups, &params->prescribed));
  for (PetscInt k = 0; k < params->constraints.n; k++) {
    char prefix[3 * BY_NAME_MAX];

    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_%s_", VerifyName(v), params->constraints.name[k]));
    PetscCall(KeysSetDefaults(TLEDConstraintKeys, &support));
    PetscCall(KeysSetFromOptions(TLEDConstraintKeys, prefix, &support));
    PetscCall(Add(&groups, &support.groups));
  }
  PetscCall(JsonBegin(v->json, "reactions"));
  for (PetscInt k = 0; k < groups.n; k++) PetscCall(ReactionRows(v, groups.name[k]));
  PetscCall(JsonEnd(v->json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the scene's probes on this body, as both sides have them */
static PetscErrorCode Probes(Verify *v)
{
  PetscReal row[2][3 * BY_NAMES_MAX + 1];
  char      headers[3 * BY_NAMES_MAX + 1][2 * BY_NAME_MAX];
  PetscInt  n;

  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) PetscCall(CouplerProbeRow(v->side[side], row[side]));
  PetscCall(CouplerProbeHeaders(v->side[EXPLICIT], &n, headers));
  PetscCall(JsonBegin(v->json, "probes"));
  for (PetscInt k = 0, column = 1; k < v->side[EXPLICIT]->n_probes; k++) {
    const CouplerProbe *probe = &v->side[EXPLICIT]->probe[k];

    /* displacement and velocity, the only ones here, have three columns; at rest the latter says nothing */
    for (int i = 0; i < 3; i++, column++) {
      char key[2 * BY_NAME_MAX];

      if (probe->surface != v->body || probe->params.quantity != PROBE_DISPLACEMENT) continue;
      PetscCall(PetscSNPrintf(key, sizeof(key), "%s_%c", probe->name, "xyz"[i]));
      PetscCall(Row(v, headers[column], key, row[EXPLICIT][column], row[IMPLICIT][column], Relative(row[EXPLICIT][column], row[IMPLICIT][column])));
    }
  }
  PetscCall(JsonEnd(v->json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Results(Verify *v, const Equilibrium e[2])
{
  static const char *const names[2] = {"static_explicit", "static_implicit"};

  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) {
    Series series;

    ByCall(VerifySeriesCreate(v, names[side], &series));
    ByCall(VerifySeriesWrite(v, series, v->params.time, e[side].u, side == EXPLICIT ? e[IMPLICIT].u : NULL));
    PetscCall(SeriesDestroy(&series));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* how far the nodes are apart */
static PetscErrorCode Differences(Verify *v, const Equilibrium e[2])
{
  PetscInt         n;
  VerifyDifference apart, back;

  PetscFunctionBegin;
  PetscCall(TLEDGetSize(VerifyBody(v, EXPLICIT), &n, NULL));
  apart = VerifyCompare(n, e[EXPLICIT].u, e[IMPLICIT].u);
  back  = VerifyCompare(n, e[IMPLICIT].u, e[EXPLICIT].u);
  PetscCall(Row(v, "largest displacement [m]", "displacement", back.largest, apart.largest, apart.max));
  if (Alone(v)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-34s %18s %18s %12.2e\n", "  root mean square of the nodes", "", "", (double)apart.rms));
  PetscCall(JsonReal(v->json, "difference_max", apart.max));
  PetscCall(JsonReal(v->json, "difference_rms", apart.rms));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* both equilibria, side by side */
static PetscErrorCode PrintTable(Verify *v, const Equilibrium e[2])
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-34s %18s %18s %12s\n", "static", Alone(v) ? "" : "explicit, relaxed", "implicit", Alone(v) ? "" : "difference"));
  PetscCall(JsonBegin(v->json, "static"));
  PetscCall(Differences(v, e));
  PetscCall(Row(v, "strain energy [J]", "energy", e[EXPLICIT].energy, e[IMPLICIT].energy, Relative(e[EXPLICIT].energy, e[IMPLICIT].energy)));
  PetscCall(Reactions(v));
  PetscCall(Probes(v));
  PetscCall(Row(v, "residual", "residual", e[EXPLICIT].residual, e[IMPLICIT].residual, -1.0));
  PetscCall(Row(v, "steps, Newton iterations", "steps", e[EXPLICIT].steps, e[IMPLICIT].steps, -1.0));
  PetscCall(Row(v, "time [s]", "seconds", e[EXPLICIT].time.wall, e[IMPLICIT].time.wall, -1.0));
  PetscCall(Row(v, "processor time [s]", "cpu_seconds", e[EXPLICIT].time.cpu, e[IMPLICIT].time.cpu, -1.0));
  PetscCall(JsonReal(v->json, "tolerance", v->params.tolerance));
  PetscCall(JsonEnd(v->json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Judge(Verify *v, const Equilibrium e[2])
{
  PetscInt  n;
  PetscReal apart;
  char      text[128];

  PetscFunctionBegin;
  PetscCall(TLEDGetSize(VerifyBody(v, EXPLICIT), &n, NULL));
  apart = VerifyCompare(n, e[EXPLICIT].u, e[IMPLICIT].u).max;
  PetscCall(PetscSNPrintf(text, sizeof(text), "largest nodal difference %.2e of the largest displacement, allowed %.2g", (double)apart, (double)v->params.tolerance));
  PetscCall(VerifyJudge(v, text, (PetscBool)(apart <= v->params.tolerance)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ VerifyStatic - relax the explicit side, solve the implicit one, compare; kind implicit: the latter alone @*/
PetscErrorCode VerifyStatic(Verify *v)
{
  Equilibrium e[2] = {{0}, {0}};

  PetscFunctionBegin;
  if (!Alone(v)) ByCall(SolveExplicit(v, &e[EXPLICIT]));
  else PetscCall(Keep(v, EXPLICIT, &e[EXPLICIT]));
  ByCall(SolveImplicit(v, &e[IMPLICIT]));
  ByCall(PrintTable(v, e));
  if (!Alone(v)) {
    ByCall(Judge(v, e));
    ByCall(Results(v, e));
  }
  for (int side = 0; side < 2; side++) PetscCall(PetscFree(e[side].u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
