/* sweep.c - the command `byssus sweep`: grid, checks, estimates, runs in the order of their cost, tables, picture. */
#include "sweep_impl.h"
#include "plot.h"

#include <string.h>

#define AT(S, field) offsetof(S, field)

// clang-format off
const Key SweepKeys[] = {
  {"over",      KEY_NAMES,  AT(SweepParams, over),      "",  "",     0, 0, 0, NULL, "names of what is varied, each a section sweep.<name>; there is a run for every combination"},
  {"reference", KEY_NAMES,  AT(SweepParams, reference), "",  "",     0, 0, 0, NULL, "key=value of the run against which errors are taken, over what the scene says"},
  {"probes",    KEY_NAMES,  AT(SweepParams, probes),    "",  "",     0, 0, 0, NULL, "probes whose errors are tabulated; none = all"},
  {"directory", KEY_STRING, AT(SweepParams, directory), "",  "",     0, 0, 0, NULL, "directory of tables and picture, with one for each run; none = that of the run, with _sweep behind it"},
  {"jobs",      KEY_INT,    AT(SweepParams, jobs),      "1", "1",    1, 1024, 0, NULL, "runs at the same time, which share the threads"},
  {"picture",   KEY_BOOL,   AT(SweepParams, picture),   "",  "true", 0, 0, 0, NULL, "draw speed against error"},
  KEY_END};

const Key SweepAxisKeys[] = {
  {"keys",   KEY_NAMES, AT(SweepAxisParams, keys),   "", NULL, 0, 0, KEY_REQUIRED, NULL, "key of the scene that takes the values, as in sph.spacing; or several that change together"},
  {"values", KEY_NAMES, AT(SweepAxisParams, values), "", NULL, 0, 0, KEY_REQUIRED, NULL, "its values; those of several keys are joined by colons, as in half_space:0.4"},
  KEY_END};
// clang-format on

static PetscErrorCode ReadParams(Sweep *s)
{
  char      text[PETSC_MAX_PATH_LEN];
  PetscBool found;

  PetscFunctionBegin;
  PetscCall(KeysSetDefaults(SweepKeys, &s->params));
  PetscCall(KeysSetFromOptions(SweepKeys, "sweep_", &s->params));
  if (!s->params.directory[0]) {
    PetscCall(PetscOptionsGetString(NULL, NULL, "-run_directory", text, sizeof(text), &found));
    if (!found) PetscFunctionReturn(InputError("sweep.directory", "is not given, and the scene has no run.directory to stand beside\nfor example directory: runs/sweep"));
    PetscCall(PetscSNPrintf(s->params.directory, sizeof(s->params.directory), "%s_sweep", text));
  }

  /* the probes of the scene, and those asked for among them */
  const Key key = {"probes", KEY_NAMES, 0, "", "", 0, 0, 0, NULL, "probes"};
  const Key keys[] = {key, KEY_END};
  PetscCall(KeysSetDefaults(keys, &s->probes));
  PetscCall(KeysSetFromOptions(keys, "", &s->probes));
  for (PetscInt i = 0; i < s->params.probes.n; i++) {
    PetscBool same = PETSC_FALSE;

    for (PetscInt k = 0; k < s->probes.n && !same; k++) PetscCall(PetscStrcmp(s->params.probes.name[i], s->probes.name[k], &same));
    if (!same) PetscFunctionReturn(InputError("sweep.probes", "has %s, which is not a probe of the scene", s->params.probes.name[i]));
  }
  if (s->params.probes.n) s->probes = s->params.probes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* scene and command line -> grid; every error is found here, before anything runs */
static PetscErrorCode Prepare(Sweep *s, int argc, char *argv[])
{
  Scene          scene;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  if (PetscGlobalSize > 1) PetscFunctionReturn(InputError("sweep", "starts its runs itself and cannot be started by mpirun\nrun several at a time with -jobs"));
  ByCall(SweepReadArguments(s, argc, argv));
  ByCall(SceneRead(s->path, s->n_overrides, s->overrides, s->sections, &scene));
  ierr = ReadParams(s);
  if (!ierr) ierr = SweepReadAxes(s);
  PetscCall(SceneDestroy(&scene));
  ByCall(ierr);
  ByCall(SweepMakePoints(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Sweep **sweep)
{
  Sweep *s = *sweep;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->n_strings; i++) PetscCall(PetscFree(s->strings[i]));
  PetscCall(PetscFree(s->strings));
  PetscCall(PetscFree(s->overrides));
  PetscCall(PetscFree(s->point));
  PetscCall(PetscFree(*sweep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* estimates, runs, tables, picture */
static PetscErrorCode Work(Sweep *s)
{
  PetscErrorCode ierr;
  PetscBool      interrupted = PETSC_FALSE, failed = PETSC_FALSE;

  PetscFunctionBegin;
  ByCall(SweepLoadStates(s));
  ByCall(SweepEstimate(s, &interrupted));
  if (interrupted) PetscFunctionReturn(BY_ERR_INTERRUPTED);
  ierr = OutputMakeDirectory(s->params.directory);
  if (ierr == BY_ERR_OUTPUT) PetscFunctionReturn(InputError("sweep.directory", "cannot be made or written\nname a directory that you may write"));
  PetscCall(ierr);
  ByCall(SweepExecute(s, &interrupted));
  ByCall(SweepWriteTables(s, PETSC_TRUE));
  if (interrupted) PetscFunctionReturn(BY_ERR_INTERRUPTED);
  if (s->params.picture) PlotDirectory(s->params.directory);
  for (PetscInt k = 0; k < s->n_points; k++) failed = (PetscBool)(failed || s->point[k].state == SWEEP_FAILED);
  PetscFunctionReturn(failed ? BY_ERR_OUTPUT : PETSC_SUCCESS);
}

/*@
  SweepRun - run a scene with every combination of some keys' values, and tabulate errors against a reference run and cost

  Not Collective, one process

  Input Parameters:
+ argc     - words in argv
. argv     - the scene's path, then the command line behind it
- sections - tables of keys

  Errors:
  BY_ERR_INPUT before anything was run; BY_ERR_INTERRUPTED with all states saved: the same command goes on; BY_ERR_OUTPUT when a run failed
  for another reason than its physics. A run that breaks down is no error: it is a row of the table.

.seealso: CouplerRun()
@*/
PetscErrorCode SweepRun(int argc, char *argv[], const SceneSection sections[])
{
  Sweep         *s;
  PetscErrorCode ierr;
  PetscInt       before = InputErrorCount();

  PetscFunctionBegin;
  PetscCall(PetscNew(&s));
  s->sections        = sections;
  s->reference_point = -1;
  ierr               = Prepare(s, argc, argv);
  if (!ierr) ierr = Work(s);
  if (ierr == BY_ERR_INPUT) {
    const PetscInt n = InputErrorCount() - before;
    fprintf(stderr, "%" PetscInt_FMT " error%s in this sweep of %s; nothing was run\n", n, n == 1 ? "" : "s", s->path);
  }
  PetscCall(Destroy(&s));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
