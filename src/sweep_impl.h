/* sweep_impl.h - the grid of a sweep and its runs; for sweep*.c only. */
#ifndef BY_SWEEP_IMPL_H
#define BY_SWEEP_IMPL_H

#include "output_file.h"
#include "sweep.h"
#include <sys/types.h>

#define SWEEP_AXES_MAX     12
#define SWEEP_KEYS_MAX     12  /* of one axis, and of the reference */
#define SWEEP_SETTINGS_MAX (SWEEP_AXES_MAX * SWEEP_KEYS_MAX)
#define SWEEP_POINTS_MAX   10000

typedef struct {
  char *option, *value; /* "sph_spacing", "0.01" */
} SweepSetting;

typedef struct {
  char        *label; /* the value as the user wrote it */
  PetscInt     n;
  SweepSetting setting[SWEEP_KEYS_MAX];
} SweepChoice;

typedef struct {
  char       *name; /* "spacing" of sph.spacing, or the name of its section */
  PetscInt    n;
  SweepChoice choice[BY_NAMES_MAX];
} SweepAxis;

typedef enum { SWEEP_WAITING, SWEEP_PAUSED, SWEEP_RUNNING, SWEEP_DONE, SWEEP_BREAKDOWN, SWEEP_FAILED } SweepState; /* paused: can be resumed */

/* one run */
typedef struct {
  char         name[256], directory[PETSC_MAX_PATH_LEN];
  char        *label[SWEEP_AXES_MAX]; /* its value of each axis                              */
  PetscInt     n;
  SweepSetting setting[SWEEP_SETTINGS_MAX];
  char        *scene;     /* text of the scene as run, without run.directory and `sweep`     */
  char        *why;       /* what a run that broke down said, NULL: nothing                  */
  SweepState   state;
  PetscBool    known;     /* it was finished before this sweep began                         */
  double       cost;      /* [s] estimated wall time                                         */
  double       start;     /* [s] when its process began                                      */
  double       took;      /* [s] that it took in this sweep                                  */
  pid_t        pid;       /* of its process, 0: none                                         */
  FILE        *out;       /* what its check prints                                           */
} SweepPoint;

typedef struct {
  const char         *path; /* of the scene */
  const SceneSection *sections;
  SweepParams         params;
  int                 n_overrides;
  char              **overrides;      /* words -key value that go to every run                                  */
  int                 n_over;         /* -over of the command line; they replace those of the scene            */
  const char         *over[SWEEP_AXES_MAX], *reference_text;
  Names               probes;         /* whose errors are tabulated                                             */
  PetscInt            n_axes, n_reference, n_points, reference_point; /* reference_point -1: none               */
  SweepAxis           axis[SWEEP_AXES_MAX];
  SweepSetting        reference[SWEEP_KEYS_MAX];
  SweepPoint         *point;
  PetscInt            n_strings, capacity;
  char              **strings;        /* owned texts */
} Sweep;

/* sweep_grid.c: command line and scene -> axes -> points, all checked */
PETSC_INTERN PetscErrorCode SweepReadArguments(Sweep *sweep, int argc, char *argv[]);
PETSC_INTERN PetscErrorCode SweepReadAxes(Sweep *sweep);
PETSC_INTERN PetscErrorCode SweepMakePoints(Sweep *sweep);
PETSC_INTERN PetscErrorCode SweepKeep(Sweep *sweep, const char text[], size_t n, char **kept); /* a copy that the sweep frees */

/* sweep_jobs.c: processes */
PETSC_INTERN PetscErrorCode SweepLoadStates(Sweep *sweep);
PETSC_INTERN PetscErrorCode SweepEstimate(Sweep *sweep, PetscBool *interrupted);
PETSC_INTERN PetscErrorCode SweepExecute(Sweep *sweep, PetscBool *interrupted);

/* sweep_table.c: what the runs left */
PETSC_INTERN PetscErrorCode SweepReadText(const char directory[], const char file[], char **text); /* NULL: not there; PetscFree it */
PETSC_INTERN PetscErrorCode SweepWriteTables(Sweep *sweep, PetscBool show);

#endif
