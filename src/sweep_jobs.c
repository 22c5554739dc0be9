/* sweep_jobs.c - the processes of a sweep: what is done already, estimates by `byssus check`, runs by `byssus run`, Ctrl-C. Next to a run's own
   results its directory has sweep.scene (what it was run from: the run is done when that is unchanged), sweep.cpu (seconds of all processes
   that worked on it) and log.txt. */
#include "sweep_impl.h"

#include <errno.h>
#include <fcntl.h>
#include <petsctime.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define LOOK_EVERY 0.02 /* [s] between two looks at the processes */
#define SHOW_EVERY 0.5  /* [s] between two lines on a terminal    */

static volatile sig_atomic_t stopped = 0;

static void OnSignal(int number)
{
  (void)number;
  stopped = 1;
}

static double Now(void)
{
  PetscLogDouble now = 0.0;

  (void)PetscTime(&now);
  return (double)now;
}

/* The environment that this process was started with: MPI has put marks of its own into the present one, which a child would take for orders of
   a launcher. Ends with `threads` ("OMP_NUM_THREADS=n") when it is given. */
static PetscErrorCode Environment(const char threads[], char **text, char ***words)
{
  FILE  *file = fopen("/proc/self/environ", "rb");
  size_t n    = 0, capacity = 1 << 16;
  int    count = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(capacity + 1, text));
  for (size_t m = 1; file && m;) {
    if (n == capacity) PetscCall(PetscRealloc((capacity *= 2) + 1, text));
    n += m = fread(*text + n, 1, capacity - n, file);
  }
  if (file) fclose(file);
  (*text)[n] = 0;
  for (size_t i = 0; i < n; i++) count += !(*text)[i];
  PetscCall(PetscMalloc1((size_t)count + 3, words));
  count = 0;
  for (char *word = *text; word < *text + n; word += strlen(word) + 1) {
    if (!threads || strncmp(word, "OMP_NUM_THREADS=", 16)) (*words)[count++] = word;
  }
  if (threads) (*words)[count++] = (char *)(uintptr_t)threads;
  (*words)[count] = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* start this program with a command for a point, output to `fd`. In a process group of its own, so that Ctrl-C reaches the sweep alone, which
   hands it on once; when the sweep is killed its runs save their state and end. */
static PetscErrorCode Spawn(Sweep *s, SweepPoint *p, const char command[], PetscBool resume, int fd)
{
  char        program[PETSC_MAX_PATH_LEN] = "", threads[64], **words, *text, **environment;
  char        directory_key[] = "-run_directory", resume_key[] = "-resume";
  int         n = 0;
  const char *inherited = getenv("OMP_NUM_THREADS");
  const long  all       = inherited && atol(inherited) > 0 ? atol(inherited) : sysconf(_SC_NPROCESSORS_ONLN);

  PetscFunctionBegin;
  PetscCheck(readlink("/proc/self/exe", program, sizeof(program) - 1) > 0, PETSC_COMM_SELF, PETSC_ERR_SYS, "/proc/self/exe: %s", strerror(errno));
  PetscCall(PetscMalloc1((size_t)s->n_overrides + 2 * (size_t)p->n + 8, &words));
  words[n++] = program;
  words[n++] = (char *)(uintptr_t)command;
  words[n++] = (char *)(uintptr_t)s->path;
  for (int i = 0; i < s->n_overrides; i++) words[n++] = s->overrides[i];
  for (PetscInt i = 0; i < p->n; i++) {
    char option[PETSC_MAX_PATH_LEN];

    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", p->setting[i].option));
    PetscCall(SweepKeep(s, option, strlen(option), &words[n++]));
    words[n++] = p->setting[i].value;
  }
  words[n++] = directory_key;
  words[n++] = p->directory;
  if (resume) {
    words[n++] = resume_key;
    words[n++] = p->directory;
  }
  words[n] = NULL;
  PetscCall(PetscSNPrintf(threads, sizeof(threads), "OMP_NUM_THREADS=%ld", PetscMax(1L, all / (long)s->params.jobs)));
  PetscCall(Environment(s->params.jobs > 1 ? threads : NULL, &text, &environment));
  fflush(NULL);
  p->pid = fork();
  if (!p->pid) {
    (void)setpgid(0, 0);
    (void)prctl(PR_SET_PDEATHSIG, SIGINT);
    if (dup2(fd, STDOUT_FILENO) >= 0 && dup2(fd, STDERR_FILENO) >= 0) execve(program, words, environment);
    _exit(BY_EXIT_FAILURE);
  }
  PetscCheck(p->pid > 0, PETSC_COMM_SELF, PETSC_ERR_SYS, "%s cannot be started: %s", program, strerror(errno));
  p->start = Now();
  PetscCall(PetscFree(words));
  PetscCall(PetscFree(text));
  PetscCall(PetscFree(environment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* hours, minutes, seconds */
static const char *Duration(double seconds, char text[32])
{
  const long n = (long)(PetscMax(seconds, 0.0) + 0.5);

  snprintf(text, 32, "%02ld:%02ld:%02ld", n / 3600, n / 60 % 60, n % 60);
  return text;
}

/* what a pool of processes works on */
typedef struct {
  PetscErrorCode (*start)(Sweep *, SweepPoint *);
  PetscErrorCode (*end)(Sweep *, SweepPoint *, int status, double cpu);
  void (*show)(Sweep *, PetscInt n, const PetscInt todo[]);
} Pool;

/* the points `todo` in this order, `jobs` at a time; after Ctrl-C those that run are told to stop, and no more begin */
static PetscErrorCode RunPool(Sweep *s, const Pool *pool, PetscInt n, const PetscInt todo[])
{
  const struct timespec pause = {0, (long)(1e9 * LOOK_EVERY)};
  PetscInt              next = 0, running = 0;
  PetscBool             told = PETSC_FALSE;

  PetscFunctionBegin;
  while (running || (next < n && !stopped)) {
    struct rusage usage;
    int           status;
    pid_t         pid;

    while (running < s->params.jobs && next < n && !stopped) {
      ByCall(pool->start(s, &s->point[todo[next++]]));
      running++;
    }
    pid = wait4(-1, &status, WNOHANG, &usage);
    for (PetscInt k = 0; k < s->n_points && pid > 0; k++) {
      const double cpu = (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) + 1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);

      if (s->point[k].pid != pid) continue;
      s->point[k].pid = 0;
      running--;
      ByCall(pool->end(s, &s->point[k], status, cpu));
      break;
    }
    if (pid > 0) continue;
    for (PetscInt k = 0; k < s->n_points && stopped && !told; k++) {
      if (s->point[k].pid) kill(s->point[k].pid, SIGINT);
    }
    told = (PetscBool)stopped;
    if (pool->show) pool->show(s, n, todo);
    nanosleep(&pause, NULL);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void CatchSignals(PetscBool on)
{
  struct sigaction action = {0};

  action.sa_handler = on ? OnSignal : SIG_DFL;
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

/* the word behind "status": in summary.json */
static void ReadStatus(const char directory[], char status[32])
{
  char       *text = NULL;
  const char *at;

  status[0] = 0;
  if (SweepReadText(directory, "summary.json", &text) || !text) return;
  at = strstr(text, "\"status\"");
  if (at) (void)sscanf(at, "\"status\" : \"%31[a-z]", status);
  (void)PetscFree(text);
}

/* last line of the log that tells of a breakdown */
static PetscErrorCode ReadWhy(Sweep *s, SweepPoint *p)
{
  char       *text;
  const char *found = NULL;

  PetscFunctionBegin;
  PetscCall(SweepReadText(p->directory, "log.txt", &text));
  for (const char *at = text; at && (at = strstr(at, "broke down")); at++) found = at;
  if (found) PetscCall(SweepKeep(s, found, strcspn(found, "\n"), &p->why));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ SweepLoadStates - what is done already, with the same scene @*/
PetscErrorCode SweepLoadStates(Sweep *s)
{
  char  path[PETSC_MAX_PATH_LEN], status[32], *text;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->n_points; k++) {
    SweepPoint *p = &s->point[k];
    PetscBool   same;

    PetscCall(SweepReadText(p->directory, "sweep.scene", &text));
    same = (PetscBool)(text && !strcmp(text, p->scene));
    PetscCall(PetscFree(text));
    if (!same) continue;
    ReadStatus(p->directory, status);
    ByCall(OutputPath(p->directory, "checkpoint", ".h5", path));
    if (!strcmp(status, "done") || !strcmp(status, "stopped")) p->state = SWEEP_DONE;
    else if (!strcmp(status, "breakdown")) p->state = SWEEP_BREAKDOWN;
    else if (!strcmp(status, "interrupted") && !access(path, R_OK)) p->state = SWEEP_PAUSED;
    p->known = (PetscBool)(p->state == SWEEP_DONE || p->state == SWEEP_BREAKDOWN);
    if (p->state == SWEEP_BREAKDOWN) PetscCall(ReadWhy(s, p));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StartCheck(Sweep *s, SweepPoint *p)
{
  PetscFunctionBegin;
  p->out = tmpfile();
  PetscCheck(p->out, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "no temporary file: %s", strerror(errno));
  PetscCall(Spawn(s, p, "check", PETSC_FALSE, fileno(p->out)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* steps and seconds a step from the plan that `byssus check` prints (coupler_run.c); what it found wrong with the scene is handed on */
static PetscErrorCode EndCheck(Sweep *s, SweepPoint *p, int status, double cpu)
{
  char        text[65536];
  const char *at;
  double      steps, seconds;
  size_t      n;

  PetscFunctionBegin;
  (void)cpu;
  rewind(p->out);
  n       = fread(text, 1, sizeof(text) - 1, p->out);
  text[n] = 0;
  fclose(p->out);
  p->out = NULL;
  if (WIFEXITED(status) && WEXITSTATUS(status) == BY_EXIT_INPUT) {
    fputs(text, stderr);
    PetscCall(InputError(s->path, "cannot be run with %s: see above", p->name) == BY_ERR_INPUT ? PETSC_SUCCESS : PETSC_ERR_PLIB);
  }
  at = strstr(text, "in about ");
  if (at && sscanf(at, "in about %lf", &steps) == 1 && (at = strstr(at, " wall time at ")) && sscanf(at, " wall time at %lf", &seconds) == 1) p->cost = steps * seconds + PetscMax(0.0, Now() - p->start - 3.0 * seconds); /* steps, and building the scene */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ SweepEstimate - cost of every run that is to be made; what cannot be built is found here @*/
PetscErrorCode SweepEstimate(Sweep *s, PetscBool *interrupted)
{
  static const Pool checks = {StartCheck, EndCheck, NULL};
  PetscInt         *todo, n = 0, before = InputErrorCount();

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->n_points, &todo));
  for (PetscInt k = 0; k < s->n_points; k++) {
    if (!s->point[k].known) todo[n++] = k;
  }
  if (n) fprintf(stderr, "sweep: checking %" PetscInt_FMT " run%s\n", n, n == 1 ? "" : "s");
  CatchSignals(PETSC_TRUE);
  ByCall(RunPool(s, &checks, n, todo));
  CatchSignals(PETSC_FALSE);
  PetscCall(PetscFree(todo));
  *interrupted = (PetscBool)stopped;
  PetscFunctionReturn(InputErrorCount() > before ? BY_ERR_INPUT : PETSC_SUCCESS);
}

/* a run from its beginning or its checkpoint; everything of an earlier, other run goes */
static PetscErrorCode StartRun(Sweep *s, SweepPoint *p)
{
  static const char *const old[] = {"summary.json", "checkpoint.h5", "sweep.cpu", "log.txt"};
  const PetscBool          resume = (PetscBool)(p->state == SWEEP_PAUSED);
  char                     path[PETSC_MAX_PATH_LEN];
  int                      fd;

  PetscFunctionBegin;
  ByCall(OutputMakeDirectory(p->directory));
  for (int k = 0; k < 4 && !resume; k++) {
    ByCall(OutputPath(p->directory, old[k], "", path));
    unlink(path);
  }
  ByCall(OutputPath(p->directory, "sweep.scene", "", path));
  ByCall(OutputReplaceText(path, p->scene, strlen(p->scene), PETSC_FALSE));
  ByCall(OutputPath(p->directory, "log.txt", "", path));
  fd = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (fd < 0) PetscFunctionReturn(OutputReport(path, strerror(errno)));
  PetscCall(Spawn(s, p, "run", resume, fd));
  close(fd);
  p->state = SWEEP_RUNNING;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* seconds of CPU of all processes that have worked on a run */
static PetscErrorCode AddCPU(SweepPoint *p, double cpu)
{
  char *text, path[PETSC_MAX_PATH_LEN], number[32];

  PetscFunctionBegin;
  PetscCall(SweepReadText(p->directory, "sweep.cpu", &text));
  OutputFormatReal(cpu + (text ? atof(text) : 0.0), number);
  PetscCall(PetscFree(text));
  ByCall(OutputPath(p->directory, "sweep.cpu", "", path));
  ByCall(OutputReplaceText(path, number, strlen(number), PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* estimated seconds of what is not done, from the estimates and how far off those of the finished runs were */
static double SecondsLeft(const Sweep *s)
{
  double expected = 0.0, taken = 0.0, left = 0.0;
  double rate;

  for (PetscInt k = 0; k < s->n_points; k++) {
    const SweepPoint *p = &s->point[k];
    if (p->known || p->state < SWEEP_DONE) continue;
    expected += p->cost;
    taken += p->took;
  }
  rate = expected > 0.0 && taken > 0.0 ? taken / expected : 1.0;
  for (PetscInt k = 0; k < s->n_points; k++) {
    const SweepPoint *p = &s->point[k];
    if (p->state < SWEEP_RUNNING) left += rate * p->cost;
    if (p->state == SWEEP_RUNNING) left += PetscMax(0.0, rate * p->cost - (Now() - p->start));
  }
  return left / (double)s->params.jobs;
}

static PetscInt CountFinished(const Sweep *s)
{
  PetscInt n = 0;

  for (PetscInt k = 0; k < s->n_points; k++) n += s->point[k].state >= SWEEP_DONE;
  return n;
}

static PetscErrorCode EndRun(Sweep *s, SweepPoint *p, int status, double cpu)
{
  static const char *const words[] = {"waits", "saved", "running", "done", "broke down", "failed"};
  const double             seconds = Now() - p->start;
  char                     left[32], took[32], name[32];

  PetscFunctionBegin;
  ReadStatus(p->directory, name);
  if (WIFEXITED(status) && WEXITSTATUS(status) == BY_EXIT_DONE) p->state = SWEEP_DONE;
  else if (WIFEXITED(status) && WEXITSTATUS(status) == BY_EXIT_BREAKDOWN) p->state = SWEEP_BREAKDOWN;
  else if (stopped && !strcmp(name, "interrupted")) p->state = SWEEP_PAUSED;
  else if (stopped && WIFSIGNALED(status)) p->state = SWEEP_WAITING;
  else p->state = SWEEP_FAILED;
  p->took = seconds;
  ByCall(AddCPU(p, cpu));
  if (p->state == SWEEP_BREAKDOWN) PetscCall(ReadWhy(s, p));
  fprintf(stderr, "%s[%" PetscInt_FMT "/%" PetscInt_FMT "] %s: %s after %s", isatty(STDERR_FILENO) ? "\r\033[K" : "", CountFinished(s), s->n_points, p->name, words[p->state],
          Duration(seconds, took));
  if (p->state == SWEEP_FAILED) fprintf(stderr, ", see %s/log.txt", p->directory);
  if (!stopped) fprintf(stderr, "; left about %s", Duration(SecondsLeft(s), left));
  fputc('\n', stderr);
  ByCall(SweepWriteTables(s, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* on a terminal: what runs now, and how long all will take */
static void ShowRunning(Sweep *s, PetscInt n, const PetscInt todo[])
{
  static double shown = 0.0;
  const double  now   = Now();
  char          left[32], took[32];
  PetscInt      running = 0;

  if (!isatty(STDERR_FILENO) || now - shown < SHOW_EVERY) return;
  shown = now;
  fprintf(stderr, "\r\033[K");
  for (PetscInt k = 0; k < n; k++) {
    const SweepPoint *p = &s->point[todo[k]];
    if (p->pid) fprintf(stderr, "%s%s %s", running++ ? ", " : "running ", p->name, Duration(now - p->start, took));
  }
  fprintf(stderr, "; left about %s", Duration(SecondsLeft(s), left));
  fflush(stderr);
}

/* cheapest first; equal ones as in the grid */
static void SortByCost(const Sweep *s, PetscInt n, PetscInt todo[])
{
  for (PetscInt i = 1; i < n; i++) {
    const PetscInt k = todo[i];
    PetscInt       j = i;

    for (; j > 0 && s->point[todo[j - 1]].cost > s->point[k].cost; j--) todo[j] = todo[j - 1];
    todo[j] = k;
  }
}

/*@ SweepExecute - run what is not done, the cheapest first; tables are written again after each run @*/
PetscErrorCode SweepExecute(Sweep *s, PetscBool *interrupted)
{
  static const Pool runs = {StartRun, EndRun, ShowRunning};
  PetscInt         *todo, n = 0;
  char              left[32];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->n_points, &todo));
  for (PetscInt k = 0; k < s->n_points; k++) {
    if (!s->point[k].known) todo[n++] = k;
  }
  SortByCost(s, n, todo);
  fprintf(stderr, "sweep: %" PetscInt_FMT " runs in %s, %" PetscInt_FMT " of them done before", s->n_points, s->params.directory, s->n_points - n);
  if (n) fprintf(stderr, "; about %s", Duration(SecondsLeft(s), left));
  fputc('\n', stderr);
  CatchSignals(PETSC_TRUE);
  ByCall(RunPool(s, &runs, n, todo));
  CatchSignals(PETSC_FALSE);
  PetscCall(PetscFree(todo));
  *interrupted = (PetscBool)stopped;
  if (stopped) fprintf(stderr, "interrupted with %" PetscInt_FMT " of %" PetscInt_FMT " runs finished; the same command goes on\n", CountFinished(s), s->n_points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
