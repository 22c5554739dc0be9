/* main.c - the program: byssus run | check | info | plot. */
#include "backend.h"
#include "coupler/coupler.h"
#include "scene.h"

#include <petscviewer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

/* read the scene, then simulate or plan; errors found behind the reader (meshes, physical groups) are counted here */
static PetscErrorCode WithScene(int argc, char *argv[], PetscBool simulate)
{
  const char    *resume;
  Scene          scene;
  PetscErrorCode result;
  PetscInt       before, errors;

  result = TakeResume(&argc, argv, &resume);
  if (!result) result = SceneRead(argv[0], argc - 1, argv + 1, CouplerSchema, &scene);
  if (result) return result;
  before = InputErrorCount();
  result = simulate ? CouplerRun(scene, resume) : CouplerCheck(scene);
  errors = InputErrorCount() - before;
  if (result == BY_ERR_INPUT && !PetscGlobalRank)
    fprintf(stderr, "%" PetscInt_FMT " error%s in %s; nothing was run\n", errors, errors == 1 ? "" : "s", argv[0]);
  if (!result) (void)SceneReportUnused(scene);
  (void)SceneDestroy(&scene);
  return result;
}

static PetscErrorCode Run(int argc, char *argv[]) { return WithScene(argc, argv, PETSC_TRUE); }

static PetscErrorCode Check(int argc, char *argv[]) { return WithScene(argc, argv, PETSC_FALSE); }

static PetscErrorCode Info(int argc, char *argv[])
{
  if (argc > 0 && !strcmp(argv[0], "-keys")) return ScenePrintKeys(CouplerSchema, "markdown", stdout);
  return BackendView(PETSC_VIEWER_STDOUT_WORLD);
}

static const Command commands[] = {
    {"run", "SCENE.yaml [-resume DIR] [-key value ...]", "simulate into a run directory", Run},
    {"check", "SCENE.yaml [-key value ...]", "validate and print the plan; writes nothing", Check},
    {"plot", "RUN...", "pictures of runs", NULL},
    {"info", "[-keys]", "version, libraries, devices; all keys as markdown", Info},
};
enum { N_COMMANDS = sizeof commands / sizeof *commands };

static int Help(void)
{
  for (int i = 0; i < N_COMMANDS; i++) printf("byssus %-5s %-42s %s\n", commands[i].name, commands[i].arguments, commands[i].help);
  printf("\nExit status: 0 done, 1 failure, 2 bad input (nothing was run), 3 the simulation broke down (state saved), 130 "
         "interrupted.\n\n");
  return ExitStatus(ScenePrintKeys(CouplerSchema, "text", stdout));
}

static int Usage(void)
{
  fprintf(stderr, "usage: byssus run|check SCENE.yaml [-key value ...]   or   byssus plot RUN...   or   byssus info\n");
  fprintf(stderr, "       byssus -help lists commands and keys\n");
  return BY_EXIT_INPUT;
}

/* hand over to the Python program that draws: share/byssus/plot.py of an installation, else that of the source tree */
static int Plot(char *argv[])
{
  char          path[PETSC_MAX_PATH_LEN] = "", installed[PETSC_MAX_PATH_LEN + 64];
  const ssize_t n                        = readlink("/proc/self/exe", path, sizeof path - 1);
  char         *slash                    = n > 0 ? strrchr(path, '/') : NULL;

  if (slash) *slash = 0;
  snprintf(installed, sizeof installed, "%s/../share/byssus/plot.py", path);
  argv[0] = (char[]){"python3"};
  argv[1] = access(installed, R_OK) ? (char[]){BYSSUS_PLOT_PATH} : installed;
  execv("/usr/bin/python3", argv);
  perror("/usr/bin/python3");
  return BY_EXIT_FAILURE;
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
  if (!command->run) return Plot(argv);
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
