/* checkpoint.h - full state in double precision in one HDF5 file, written under a new name, synced, then renamed. */
#ifndef BY_CHECKPOINT_H
#define BY_CHECKPOINT_H

#include "output.h"

typedef struct _Checkpoint *Checkpoint;

/* Writing: Create, Write..., Commit (renames onto <directory>/checkpoint.h5; the old one stays whole until then). A failure (disk full)
   is reported, the new file removed, the old checkpoint kept, BY_ERR_OUTPUT returned. */
BY_EXTERN PetscErrorCode CheckpointCreate(const char directory[], Checkpoint *checkpoint);
BY_EXTERN PetscErrorCode CheckpointWriteReal(Checkpoint checkpoint, const char name[], PetscInt n, const PetscReal values[]); /* name "group/name" */
BY_EXTERN PetscErrorCode CheckpointWriteInt(Checkpoint checkpoint, const char name[], PetscInt n, const PetscInt values[]);
BY_EXTERN PetscErrorCode CheckpointWriteString(Checkpoint checkpoint, const char name[], const char value[]);
BY_EXTERN PetscErrorCode CheckpointCommit(Checkpoint *checkpoint);

/* Reading: a truncated or foreign file is a user error that names the file and what is wrong (InputError on key "resume"). */
BY_EXTERN PetscErrorCode CheckpointOpen(const char directory[], Checkpoint *checkpoint);
BY_EXTERN PetscErrorCode CheckpointGetSize(Checkpoint checkpoint, const char name[], PetscInt *n); /* -1: not there */
BY_EXTERN PetscErrorCode CheckpointReadReal(Checkpoint checkpoint, const char name[], PetscInt n, PetscReal values[]);
BY_EXTERN PetscErrorCode CheckpointReadInt(Checkpoint checkpoint, const char name[], PetscInt n, PetscInt values[]);
BY_EXTERN PetscErrorCode CheckpointReadString(Checkpoint checkpoint, const char name[], size_t n, char value[]);
BY_EXTERN PetscErrorCode CheckpointClose(Checkpoint *checkpoint);

#endif
