/* sweep.h - the command `byssus sweep`: a grid of runs over any keys of a scene, each a process and a run directory of its own; their errors
   against a reference run and their cost in a table. Knows no physics: the caller hands in the tables of keys. */
#ifndef BY_SWEEP_H
#define BY_SWEEP_H

#include "scene.h"

/* Parameters of `sweep:`; SweepKeys[] (sweep.c) declares each. */
typedef struct {
  Names     over, reference, probes;
  PetscInt  jobs; /* runs at the same time */
  PetscBool picture;
  char      directory[PETSC_MAX_PATH_LEN];
} SweepParams;

/* one axis of the grid, `sweep.<name>:` */
typedef struct {
  Names keys, values;
} SweepAxisParams;

BY_EXTERN const Key SweepKeys[], SweepAxisKeys[];

/* argv: SCENE [-over KEY=V,V ...] [-reference KEY=V,...] [-probe NAME ...] [-directory DIR] [-jobs N] [-key value ...] */
BY_EXTERN PetscErrorCode SweepRun(int argc, char *argv[], const SceneSection sections[]);

#endif
