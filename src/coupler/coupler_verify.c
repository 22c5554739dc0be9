/* coupler_verify.c - the command `byssus verify`: every body of a scene solved explicitly and implicitly on the same mesh, compared. */
#include "coupler_verify.h"
#include "backend.h"
#include <petsctime.h>
#include <sys/resource.h>

TLED VerifyBody(const Verify *verify, int side) { return verify->side[side]->surface[verify->body].tled; }

const char *VerifyName(const Verify *verify) { return verify->side[EXPLICIT]->surface[verify->body].name; }

PetscErrorCode VerifyClockRead(VerifyClock *clock)
{
  struct rusage usage;

  PetscFunctionBegin;
  PetscCall(PetscTime(&clock->wall));
  getrusage(RUSAGE_SELF, &usage);
  clock->cpu = (PetscLogDouble)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) + 1e-6 * (PetscLogDouble)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  PetscFunctionReturn(PETSC_SUCCESS);
}

VerifyDifference VerifyCompare(PetscInt n_nodes, const PetscReal a[], const PetscReal b[])
{
  VerifyDifference d = {0.0, 0.0, 0.0};

  for (PetscInt k = 0; k < 3 * n_nodes; k += 3) {
    const PetscReal c[3] = {a[k] - b[k], a[k + 1] - b[k + 1], a[k + 2] - b[k + 2]};
    const PetscReal square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];

    d.largest = PetscMax(d.largest, b[k] * b[k] + b[k + 1] * b[k + 1] + b[k + 2] * b[k + 2]);
    d.max     = PetscMax(d.max, square);
    d.rms += square;
  }
  d.largest = PetscSqrtReal(d.largest);
  if (d.largest > 0.0) {
    d.max = PetscSqrtReal(d.max) / d.largest;
    d.rms = PetscSqrtReal(d.rms / n_nodes) / d.largest;
  }
  return d;
}

/* one line of judgement; what fails makes the command fail */
PetscErrorCode VerifyJudge(Verify *verify, const char what[], PetscBool good)
{
  PetscFunctionBegin;
  if (!good) verify->failed = PETSC_TRUE;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %s: %s\n", good ? "passed" : "FAILED", what));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VerifyBreakdown(Verify *verify, int side, const char when[])
{
  const char *why;

  PetscFunctionBegin;
  PetscCall(TLEDGetBreakdown(VerifyBody(verify, side), &why));
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, stderr, "%s, %s: %s\n", VerifyName(verify), when, why));
  PetscFunctionReturn(BY_ERR_BREAKDOWN);
}

PetscErrorCode VerifySeriesCreate(Verify *verify, const char name[], Series *series)
{
  char             file[3 * BY_NAME_MAX];
  PetscInt         n_tets, n_corners;
  const PetscInt  *tets;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s_%s", VerifyName(verify), name));
  PetscCall(TLEDGetSize(VerifyBody(verify, EXPLICIT), NULL, &n_tets));
  PetscCall(TLEDGetMesh(VerifyBody(verify, EXPLICIT), &n_corners, &tets, NULL));
  ByCall(SeriesCreate(verify->params.directory, file, n_corners == 4 ? SERIES_TETRAHEDRA : SERIES_TETRAHEDRA_QUADRATIC, verify->scene, PETSC_FALSE, 0.0, series));
  PetscCall(SeriesSetDoublePrecision(*series, PETSC_TRUE));
  ByCall(SeriesSetCells(*series, n_tets, tets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VerifySeriesWrite(Verify *verify, Series series, PetscReal time, const PetscReal u[], const PetscReal other[])
{
  const PetscReal *X;
  PetscReal       *x, *difference;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCall(TLEDGetSize(VerifyBody(verify, EXPLICIT), &n, NULL));
  PetscCall(TLEDGetMesh(VerifyBody(verify, EXPLICIT), NULL, NULL, &X));
  PetscCall(PetscMalloc2(3 * n, &x, 3 * n, &difference));
  for (PetscInt k = 0; k < 3 * n; k++) {
    x[k]          = X[k] + u[k];
    difference[k] = other ? u[k] - other[k] : 0.0;
  }
  const OutputField fields[] = {{"displacement", "m", 3, u}, {"difference", "m", 3, difference}};
  ByCall(SeriesWrite(series, time, n, x, other ? 2 : 1, fields));
  PetscCall(PetscFree2(x, difference));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadParams(VerifyParams *params)
{
  char      run[PETSC_MAX_PATH_LEN];
  PetscBool has_run;

  PetscFunctionBegin;
  PetscCall(KeysSetDefaults(VerifyKeys, params));
  PetscCall(KeysSetFromOptions(VerifyKeys, "verify_", params));
  if (!params->directory[0]) {
    PetscCall(PetscOptionsGetString(NULL, NULL, "-run_directory", run, sizeof(run), &has_run));
    if (!has_run) PetscFunctionReturn(InputError("verify.directory", "is not given, and the scene has no run.directory to stand beside\nfor example directory: runs/verify"));
    PetscCall(PetscSNPrintf(params->directory, sizeof(params->directory), "%s_verify", run));
  }
  if ((params->kind == VERIFY_DYNAMIC || params->kind == VERIFY_BOTH) && params->duration <= 0.0)
    PetscFunctionReturn(InputError("verify.duration", "must be given for a dynamic comparison\nhow long both solids move, for example 0.1 [s]"));
  for (PetscInt k = 1; k < params->steps.n; k++) {
    if (params->steps.value[k] >= params->steps.value[k - 1])
      PetscFunctionReturn(InputError("verify.steps", "must fall: the order is that between a step and the next smaller one"));
  }
  if (params->kind == VERIFY_NONE && !params->modes)
    PetscFunctionReturn(InputError("verify.kind", "compares nothing, and verify.modes is 0\nask for one of them"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what the body is: a line on the screen, entries of the summary */
static PetscErrorCode Describe(Verify *v)
{
  TLED        tled = VerifyBody(v, EXPLICIT);
  PetscInt    n_nodes, n_tets, n_corners;
  PetscReal   critical = 0.0;
  const char *element;

  PetscFunctionBegin;
  PetscCall(TLEDGetSize(tled, &n_nodes, &n_tets));
  PetscCall(TLEDGetMesh(tled, &n_corners, NULL, NULL));
  ByCall(TLEDGetCriticalStep(tled, &critical));
  PetscCall(TLEDGetElementName(tled, &element));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: %" PetscInt_FMT " nodes, %" PetscInt_FMT " %s elements; critical step %.6g s\n", VerifyName(v), n_nodes,
                        n_tets, element, (double)critical));
  PetscCall(JsonInt(v->json, "nodes", n_nodes));
  PetscCall(JsonInt(v->json, "elements", n_tets));
  PetscCall(JsonInt(v->json, "corners", n_corners));
  PetscCall(JsonString(v->json, "element", element));
  PetscCall(JsonReal(v->json, "critical_step", critical));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CompareBody(Verify *v)
{
  PetscErrorCode ierr;
  const int      kind = v->params.kind;

  PetscFunctionBegin;
  PetscCall(JsonBegin(v->json, VerifyName(v)));
  ByCall(Describe(v));
  ierr = PETSC_SUCCESS;
  /* modes first: about the body as it was built */
  if (v->params.modes) ierr = VerifyModes(v);
  if (!ierr && (kind == VERIFY_DYNAMIC || kind == VERIFY_BOTH)) ierr = VerifyDynamic(v);
  if (!ierr && (kind == VERIFY_STATIC || kind == VERIFY_BOTH || kind == VERIFY_IMPLICIT)) ierr = VerifyStatic(v);
  if (ierr != BY_ERR_BREAKDOWN) ByCall(ierr);
  PetscCall(JsonEnd(v->json));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Start(Verify *v, Scene scene)
{
  PetscErrorCode ierr;
  PetscBool      has_fluid;
  char           path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) {
    PetscCall(CouplerCreate(PETSC_COMM_SELF, &v->side[side]));
    ByCall(CouplerSetBodiesFromOptions(v->side[side]));
  }
  ierr = OutputMakeDirectory(v->params.directory);
  if (ierr == BY_ERR_OUTPUT) PetscFunctionReturn(InputError("verify.directory", "cannot be made or written\nname a directory that you may write"));
  PetscCall(ierr);
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/scene.yaml", v->params.directory));
  ByCall(SceneWrite(scene, path));
  PetscCall(SceneGetText(scene, &v->scene));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-sph_spacing", &has_fluid));
  if (has_fluid) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "the scene's fluid is left out: bodies are compared dry\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Summary(Verify *v, PetscErrorCode outcome)
{
  PetscInt    threads;
  const char *status = outcome ? "breakdown" : v->failed ? "failed" : "passed";

  PetscFunctionBegin;
  PetscCall(BackendGetThreads(&threads));
  PetscCall(JsonString(v->json, "status", status));
  PetscCall(JsonInt(v->json, "threads", threads));
  PetscCall(JsonInt(v->json, "ranks", PetscGlobalSize));
  PetscCall(JsonString(v->json, "version", BYSSUS_VERSION));
  ByCall(JsonDestroy(&v->json));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s; %s/summary.json\n", status, v->params.directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerVerify - solve every body of a scene explicitly and implicitly on the same mesh, print and write how far they are apart

  Collective

  Input Parameter:
. scene - read by SceneRead()

  Output Parameters:
+ directory - where the results are, PETSC_MAX_PATH_LEN characters
- picture   - whether the scene asks for a picture of them

  Errors:
  BY_ERR_INPUT; BY_ERR_BREAKDOWN when a solve broke down, or something is over its tolerance; all reported

.seealso: CouplerRun()
@*/
PetscErrorCode CouplerVerify(Scene scene, char directory[], PetscBool *picture)
{
  Verify         v       = {0};
  PetscErrorCode outcome = PETSC_SUCCESS;

  PetscFunctionBegin;
  *picture = PETSC_FALSE;
  ByCall(ReadParams(&v.params));
  outcome = Start(&v, scene);
  if (!outcome) {
    ByCall(JsonCreate(v.params.directory, "summary.json", &v.json));
    PetscCall(JsonString(v.json, "command", "verify"));
    PetscCall(JsonBegin(v.json, "bodies"));
    for (v.body = 0; !outcome && v.body < v.side[EXPLICIT]->n_bodies; v.body++) outcome = CompareBody(&v);
    if (outcome && outcome != BY_ERR_BREAKDOWN) ByCall(outcome);
    PetscCall(JsonEnd(v.json));
    ByCall(Summary(&v, outcome));
    PetscCall(PetscStrncpy(directory, v.params.directory, PETSC_MAX_PATH_LEN));
    *picture = v.params.picture;
  }
  for (int side = 0; side < 2; side++) PetscCall(CouplerDestroy(&v.side[side]));
  ByCall(outcome);
  PetscFunctionReturn(v.failed ? BY_ERR_BREAKDOWN : PETSC_SUCCESS);
}
