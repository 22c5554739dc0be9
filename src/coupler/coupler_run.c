/* coupler_run.c - the commands `byssus run` and `byssus check`: time loop, outputs, checkpoints, Ctrl-C. */
#include "coupler_results.h"
#include <signal.h>

static volatile sig_atomic_t interrupted = 0;

static void OnSignal(int signal_number)
{
  (void)signal_number;
  interrupted = 1;
}

typedef struct {
  Coupler        coupler;
  CouplerResults results;
  Progress       progress;
  RunParams      params;
  const char    *scene_text;
  PetscInt       n_outputs;     /* output k is at time k * output_every */
  PetscInt       fields_stride; /* every so many outputs the fields are written too */
  PetscReal      next_checkpoint;
  PetscBool      same_directory; /* resumes into the directory of its checkpoint: files go on */
  PetscLogDouble start;
} Run;

static PetscErrorCode ReadRunParams(RunParams *params)
{
  PetscReal ratio;

  PetscFunctionBegin;
  PetscCall(KeysSetDefaults(RunKeys, params));
  PetscCall(KeysSetFromOptions(RunKeys, "run_", params));
  if (params->output_every <= 0.0) params->output_every = params->end / 50.0;
  if (params->fields_every <= 0.0) params->fields_every = params->output_every;
  ratio = params->fields_every / params->output_every;
  if (ratio < 0.5 || PetscAbsReal(ratio - PetscFloorReal(ratio + 0.5)) > 1e-6 * ratio) {
    PetscFunctionReturn(InputError("run.fields_every", "must be a multiple of run.output_every, which is %g s", (double)params->output_every));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal WallSeconds(const Run *run)
{
  PetscLogDouble now = run->start;

  (void)PetscTime(&now);
  return now - run->start;
}

static PetscErrorCode Save(Run *run)
{
  Coupler c = run->coupler;

  PetscFunctionBegin;
  PetscCall(CouplerTimer(c, N_PHASES));
  ByCall(CouplerSave(c, run->params.directory, run->scene_text));
  PetscCall(CouplerTimer(c, PHASE_OUTPUT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one step to at most the next output or the end; results and checkpoints when due */
static PetscErrorCode Advance(Run *run)
{
  Coupler         c    = run->coupler;
  const PetscReal next = PetscMin(run->n_outputs * run->params.output_every, run->params.end);
  PetscReal       dt;

  PetscFunctionBegin;
  ByCall(CouplerStep(c, next - c->time, &dt));
  run->results.steps++;
  PetscCall(CouplerProbeStep(c, dt));
  if (next - c->time > 1e-9 * run->params.output_every) PetscFunctionReturn(PETSC_SUCCESS);
  c->time = next;
  ByCall(CouplerResultsWrite(c, &run->results, (PetscBool)(run->n_outputs % run->fields_stride == 0 || c->time >= run->params.end * (1.0 - 1e-9))));
  run->n_outputs++;
  if (run->params.checkpoint_every > 0.0 && c->time >= run->next_checkpoint - 1e-9 * run->params.output_every) {
    ByCall(Save(run));
    run->next_checkpoint = c->time + run->params.checkpoint_every;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Show(Run *run, PetscBool last)
{
  Coupler       c     = run->coupler;
  ProgressState state = {c->time, run->params.end, c->dt, WallSeconds(run), c->step, 0};

  PetscFunctionBegin;
  if (c->sph) {
    SPHStats stats;

    PetscCall(SPHGetStats(c->sph, &stats));
    state.iterations = stats.iterations;
  }
  PetscCall(ProgressShow(run->progress, &state, last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Loop(Run *run)
{
  Coupler c = run->coupler;

  PetscFunctionBegin;
  while (c->time < run->params.end * (1.0 - 1e-12) && !interrupted) {
    if (run->params.max_steps && c->step >= run->params.max_steps) break;
    ByCall(Advance(run));
    PetscCall(Show(run, PETSC_FALSE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the state after the loop, however it ended: checkpoint, summary, what to do next */
static PetscErrorCode Finish(Run *run, PetscErrorCode outcome)
{
  Coupler     c      = run->coupler;
  const char *status = outcome == BY_ERR_BREAKDOWN ? "breakdown" : interrupted ? "interrupted" : c->time < run->params.end * (1.0 - 1e-9) ? "stopped" : "done";
  const char *why;

  PetscFunctionBegin;
  PetscCall(Show(run, PETSC_TRUE));
  if (outcome == BY_ERR_BREAKDOWN) {
    PetscCall(CouplerGetBreakdown(c, &why));
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr, "the simulation broke down at %s\n", why));
    ByCall(CouplerResultsWrite(c, &run->results, PETSC_TRUE));
    ByCall(CouplerResultsSummary(c, &run->results, status, WallSeconds(run)));
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr, "the state at the breakdown is the last of the results in %s\n", run->params.directory));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  ByCall(Save(run));
  ByCall(CouplerResultsSummary(c, &run->results, status, WallSeconds(run)));
  if (interrupted) {
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr, "interrupted at %g s; state saved. Go on with: byssus run SCENE -resume %s\n", (double)c->time,
                           run->params.directory));
    PetscFunctionReturn(BY_ERR_INTERRUPTED);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Start(Run *run, Scene scene, const char resume[])
{
  Coupler        c;
  PetscErrorCode ierr;
  char           path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(CouplerCreate(PETSC_COMM_SELF, &run->coupler));
  c = run->coupler;
  ByCall(CouplerSetFromOptions(c));
  ierr = OutputMakeDirectory(run->params.directory);
  if (ierr == BY_ERR_OUTPUT) PetscFunctionReturn(InputError("run.directory", "cannot be made or written\nname a directory that you may write"));
  PetscCall(ierr);
  ByCall(CouplerSetUp(c));
  if (resume) {
    ByCall(CouplerLoad(c, resume));
    PetscCall(PetscStrcmp(resume, run->params.directory, &run->same_directory));
  }
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/scene.yaml", run->params.directory));
  ByCall(SceneWrite(scene, path));
  PetscCall(SceneGetText(scene, &run->scene_text));
  ByCall(CouplerResultsCreate(c, run->params.directory, run->scene_text, run->same_directory, &run->results));
  PetscCall(CouplerViewSchemes(c, PETSC_VIEWER_STDOUT_SELF));
  PetscCall(ProgressCreate(&run->progress));
  if (!resume) {
    if (c->sph) {
      ByCall(SPHUpdateNeighbors(c->sph));
      PetscCall(CouplerUpdateContacts(c));
    }
    ByCall(CouplerResultsWrite(c, &run->results, PETSC_TRUE));
  }
  run->fields_stride   = (PetscInt)PetscFloorReal(run->params.fields_every / run->params.output_every + 0.5);
  run->n_outputs       = 1 + (PetscInt)PetscFloorReal(c->time / run->params.output_every + 1e-6);
  run->next_checkpoint = c->time + run->params.checkpoint_every;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SayAtOnce(Coupler c)
{
  const char *why;

  PetscFunctionBegin;
  PetscCall(CouplerGetBreakdown(c, &why));
  PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr, "the scene breaks down at once: %s\n", why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerRun - run a scene to its end into its run directory

  Collective

  Input Parameters:
+ scene  - read by SceneRead(): its keys are in the options database
- resume - directory with the checkpoint to go on from, or NULL

  Errors:
  BY_ERR_INPUT, BY_ERR_OUTPUT, BY_ERR_BREAKDOWN, BY_ERR_INTERRUPTED, each already reported; state is saved for the last two

.seealso: CouplerCheck()
@*/
PetscErrorCode CouplerRun(Scene scene, const char resume[])
{
  Run            run = {0};
  PetscErrorCode outcome;

  PetscFunctionBegin;
  ByCall(ReadRunParams(&run.params));
  PetscCall(PetscTime(&run.start));
  interrupted = 0;
  signal(SIGINT, OnSignal);
  signal(SIGTERM, OnSignal);
  outcome = Start(&run, scene, resume && resume[0] ? resume : NULL);
  if (outcome == BY_ERR_BREAKDOWN) PetscCall(SayAtOnce(run.coupler)); /* while it settled: there is no state worth saving */
  if (!outcome) {
    outcome = Loop(&run);
    if (!outcome || outcome == BY_ERR_BREAKDOWN) outcome = Finish(&run, outcome);
  }
  PetscCall(ProgressDestroy(&run.progress));
  PetscCall(CouplerResultsDestroy(&run.results));
  PetscCall(CouplerDestroy(&run.coupler));
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  ByCall(outcome);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* wall seconds of one step, from three steps on a throw-away copy of the scene */
static PetscErrorCode TimeSteps(Coupler c, PetscReal limit, PetscReal *dt, PetscReal *seconds)
{
  PetscLogDouble start, now;
  const PetscInt n = 3;

  PetscFunctionBegin;
  *dt = 0.0;
  PetscCall(PetscTime(&start));
  for (PetscInt k = 0; k < n; k++) {
    PetscReal step;

    ByCall(CouplerStep(c, limit, &step));
    *dt = PetscMax(*dt, step);
  }
  PetscCall(PetscTime(&now));
  *seconds = (now - start) / n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerCheck - build a scene, take three steps of it in memory, and print the plan: counts, steps, memory, time; writes nothing

  Collective

  Input Parameter:
. scene - read by SceneRead()

.seealso: CouplerRun()
@*/
PetscErrorCode CouplerCheck(Scene scene)
{
  RunParams      params;
  Coupler        c;
  PetscReal      dt = 0.0, seconds = 0.0;
  PetscLogDouble memory;
  PetscErrorCode ierr;
  const char    *path;

  PetscFunctionBegin;
  ByCall(ReadRunParams(&params));
  PetscCall(CouplerCreate(PETSC_COMM_SELF, &c));
  ierr = CouplerSetFromOptions(c);
  if (!ierr) ierr = CouplerSetUp(c);
  if (!ierr) ierr = TimeSteps(c, PetscMin(params.output_every, params.end), &dt, &seconds);
  if (ierr == BY_ERR_BREAKDOWN) PetscCall(SayAtOnce(c));
  if (!ierr) {
    PetscCall(SceneGetPath(scene, &path));
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "%s is good\n", path));
    PetscCall(CouplerView(c, PETSC_VIEWER_STDOUT_SELF));
    PetscCall(PetscMemoryGetCurrentUsage(&memory));
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "plan: %g s of simulated time in about %" PetscInt_FMT " steps of up to %.3g s\n", (double)params.end,
                          (PetscInt)PetscCeilReal(params.end / dt), (double)dt));
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "      about %.0f s of wall time at %.3g s a step, %.0f MB of memory, %" PetscInt_FMT " outputs into %s\n",
                          (double)(seconds * params.end / dt), (double)seconds, (double)(memory / 1e6),
                          1 + (PetscInt)PetscCeilReal(params.end / params.output_every - 1e-9), params.directory));
  }
  PetscCall(CouplerDestroy(&c));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
