/* backend.h - which backends were built, and what this machine has. */
#ifndef BY_BACKEND_H
#define BY_BACKEND_H

#include "base.h"

BY_EXTERN PetscErrorCode BackendGetThreads(PetscInt *threads);
BY_EXTERN PetscBool      BackendHasCUDA(void);                                             /* compiled in          */
BY_EXTERN PetscErrorCode BackendGetDevice(PetscInt *n_devices, char name[], size_t n_name); /* 0 devices: name "none" */
BY_EXTERN const char    *BackendGetVersion(void);                                          /* "0.1.0"              */
BY_EXTERN const char    *BackendGetRevision(void);  /* of git when the build was configured, "unknown" without git    */
BY_EXTERN PetscErrorCode BackendView(PetscViewer viewer);                                   /* for `byssus info`    */

#endif
