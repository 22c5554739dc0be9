/* plot.c - hand over to the Python program that draws. */
#include "plot.h"

#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define PYTHON "/usr/bin/python3"

extern char **environ;

/* share/byssus/plot.py of an installation, else that of the source tree */
static void FindProgram(char path[], size_t n)
{
  char          program[PETSC_MAX_PATH_LEN] = "";
  const ssize_t length                      = readlink("/proc/self/exe", program, sizeof program - 1);
  char         *slash                       = length > 0 ? strrchr(program, '/') : NULL;

  if (slash) *slash = 0;
  snprintf(path, n, "%s/../share/byssus/plot.py", program);
  if (access(path, R_OK)) snprintf(path, n, "%s", BYSSUS_PLOT_PATH);
}

int PlotProgram(char *argv[])
{
  char path[2 * PETSC_MAX_PATH_LEN];

  FindProgram(path, sizeof path);
  argv[0] = (char[]){"python3"};
  argv[1] = path;
  execv(PYTHON, argv);
  perror(PYTHON);
  return BY_EXIT_FAILURE;
}

void PlotDirectory(char directory[])
{
  char  path[2 * PETSC_MAX_PATH_LEN], *words[] = {(char[]){"python3"}, path, directory, NULL};
  int   status = -1;
  pid_t child;

  fflush(NULL);
  FindProgram(path, sizeof path);
  if (!posix_spawn(&child, PYTHON, NULL, NULL, words, environ)) waitpid(child, &status, 0);
  if (status) fprintf(stderr, "no picture was drawn; try: byssus plot %s\n", directory);
}
