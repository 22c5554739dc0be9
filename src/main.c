/* main.c - the program: byssus run | check | verify | sweep | plot | info. */
#include "backend.h"
#include "coupler/coupler.h"
#include "plot.h"
#include "sweep.h"

#include <petscviewer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const char *name, *arguments, *help;
  PetscErrorCode (*run)(int argc, char *argv[]); /* NULL: needs no PETSc, see main; argv[0] is the first behind the name */
} Command;

static int ExitStatus(PetscErrorCode code)
{
  if (!code) return BY_EXIT_DONE;
  if (code == BY_ERR_INPUT) return BY_EXIT_INPUT;
  if (code == BY_ERR_BREAKDOWN) return BY_EXIT_BREAKDOWN;
  if (code == BY_ERR_INTERRUPTED) return BY_EXIT_INTERRUPTED;
  return BY_EXIT_FAILURE;
}

/* take "-resume DIR" out of the arguments */
static PetscErrorCode TakeResume(int *argc, char *argv[], const char **directory)
{
  *directory = NULL;
  for (int i = 1; i < *argc; i++) {
    if (strcmp(argv[i], "-resume")) continue;
    if (i + 1 == *argc || argv[i + 1][0] == '-')
      return InputError("resume", "names no directory\nexpected -resume DIR, the directory of an earlier run");
    *directory = argv[i + 1];
    *argc -= 2;
    for (int k = i; k < *argc; k++) argv[k] = argv[k + 2];
    return PETSC_SUCCESS;
  }
  return PETSC_SUCCESS;
}

static void ReportErrors(PetscErrorCode result, PetscInt errors, const char scene[])
{
  if (result == BY_ERR_INPUT && !PetscGlobalRank)
    fprintf(stderr, "%" PetscInt_FMT " error%s in %s; nothing was run\n", errors, errors == 1 ? "" : "s", scene);
}

/* read the scene, then simulate or plan; errors found behind the reader (meshes, physical groups) are counted here */
static PetscErrorCode WithScene(int argc, char *argv[], PetscBool simulate)
{
  const char    *resume;
  Scene          scene;
  PetscErrorCode result;
  PetscInt       before;

  result = TakeResume(&argc, argv, &resume);
  if (!result) result = SceneRead(argv[0], argc - 1, argv + 1, CouplerSchema, &scene);
  if (result) return result;
  before = InputErrorCount();
  result = simulate ? CouplerRun(scene, resume) : CouplerCheck(scene);
  ReportErrors(result, InputErrorCount() - before, argv[0]);
  if (!result) (void)SceneReportUnused(scene);
  (void)SceneDestroy(&scene);
  return result;
}

static PetscErrorCode Sweep(int argc, char *argv[]) { return SweepRun(argc, argv, CouplerSchema); }
static PetscErrorCode Run(int argc, char *argv[]) { return WithScene(argc, argv, PETSC_TRUE); }
static PetscErrorCode Check(int argc, char *argv[]) { return WithScene(argc, argv, PETSC_FALSE); }
static PetscErrorCode Info(int argc, char *argv[])
{
  if (argc > 0 && !strcmp(argv[0], "-keys")) return ScenePrintKeys(CouplerSchema, "markdown", stdout);
  return BackendView(PETSC_VIEWER_STDOUT_WORLD);
}

static PetscErrorCode Verify(int argc, char *argv[])
{
  Scene          scene;
  PetscErrorCode result = SceneRead(argv[0], argc - 1, argv + 1, CouplerSchema, &scene);
  PetscBool      picture;
  PetscInt       before = InputErrorCount();
  char           directory[PETSC_MAX_PATH_LEN];

  if (result) return result;
  result = CouplerVerify(scene, directory, &picture);
  ReportErrors(result, InputErrorCount() - before, argv[0]);
  if (picture && !PetscGlobalRank) PlotDirectory(directory);
  if (!result) (void)SceneReportUnused(scene);
  (void)SceneDestroy(&scene);
  return result;
}

static const Command commands[] = {
    {"run", "SCENE.yaml [-resume DIR] [-key value ...]", "simulate into a run directory", Run},
    {"check", "SCENE.yaml [-key value ...]", "validate and print the plan; writes nothing", Check},
    {"verify", "SCENE.yaml [-key value ...]", "explicit against implicit solid, same mesh: table, picture", Verify},
    {"sweep", "SCENE.yaml -over key=v,v ... [-reference key=v]", "all combinations against a reference: table, picture", Sweep},
    {"plot", "RUN...", "pictures of runs", NULL},
    {"info", "[-keys]", "version, libraries, devices; all keys as markdown", Info},
};
enum { N_COMMANDS = sizeof commands / sizeof *commands };

static int Help(void)
{
  for (int i = 0; i < N_COMMANDS; i++) printf("byssus %-6s %-48s %s\n", commands[i].name, commands[i].arguments, commands[i].help);
  printf("\nExit status: 0 done, 1 failure, 2 bad input (nothing was run), 3 the simulation broke down (state saved) or verify found more than "
         "its tolerance, 130 interrupted.\n\n");
  return ExitStatus(ScenePrintKeys(CouplerSchema, "text", stdout));
}

static int Usage(void)
{
  fprintf(stderr, "usage: byssus run|check|verify|sweep SCENE.yaml [-key value ...]   or   byssus plot RUN...   or   byssus info\n"
                  "       byssus -help lists commands and keys\n");
  return BY_EXIT_INPUT;
}

static PetscBool AsksForHelp(const char word[])
{
  return (PetscBool)(!strcmp(word, "-help") || !strcmp(word, "--help") || !strcmp(word, "-h") || !strcmp(word, "help"));
}

int main(int argc, char *argv[])
{
  const Command *command = NULL;
  PetscErrorCode result;
  int            all   = argc; /* PETSc may reorder its copy */
  char         **words = argv;

  for (int i = 1; i < argc; i++) {
    if (AsksForHelp(argv[i])) return Help();
  }
  for (int i = 0; i < N_COMMANDS && argc > 1; i++) {
    if (!strcmp(argv[1], commands[i].name)) command = &commands[i];
  }
  if (!command || (command->run != Info && argc < 3)) return Usage();
  if (!command->run) return PlotProgram(argv);
  if (command->run != Info && argv[2][0] == '-') return Usage();

  /* without mpirun MPI is one process by itself: no helper daemon, and Ctrl-C and limits on files reach nobody else */
  if (!getenv("OMPI_COMM_WORLD_SIZE") && !getenv("PMIX_RANK")) setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  if (PetscInitialize(&all, &words, NULL, NULL)) return BY_EXIT_FAILURE;
  result = command->run(argc - 2, argv + 2);

  /* with several ranks a failure of one must end the others */
  if (ExitStatus(result) == BY_EXIT_FAILURE && PetscGlobalSize > 1) MPI_Abort(PETSC_COMM_WORLD, BY_EXIT_FAILURE);
  if (PetscFinalize() && !result) return BY_EXIT_FAILURE;
  return ExitStatus(result);
}
