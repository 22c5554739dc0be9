/* coupler_results.h - the files of one run; included only in src/coupler. */
#ifndef BY_COUPLER_RESULTS_H
#define BY_COUPLER_RESULTS_H

#include "coupler_impl.h"

typedef struct {
  char      directory[PETSC_MAX_PATH_LEN];
  Table     ledger, probes, profile[BY_NAMES_MAX]; /* one file for each probe on a line or rectangle */
  Series    fluid, body[COUPLER_MAX_SURFACES], proxies[COUPLER_MAX_SURFACES];
  PetscInt  n_series, n_rows;      /* written by this process                        */
  PetscInt  steps;                 /* taken by this process                          */
  PetscInt  penetrations_max;      /* largest number seen in a row of the ledger     */
  PetscReal compression_mean_sum, compression_max;
  PetscReal momentum_start[3], momentum_end[3];
} CouplerResults;

PETSC_INTERN PetscErrorCode CouplerResultsCreate(Coupler c, const char directory[], const char scene[], PetscBool append, CouplerResults *r);
PETSC_INTERN PetscErrorCode CouplerResultsWrite(Coupler c, CouplerResults *r, PetscBool fields);
PETSC_INTERN PetscErrorCode CouplerResultsSummary(Coupler c, CouplerResults *r, const char status[], PetscReal wall_seconds);
PETSC_INTERN PetscErrorCode CouplerResultsDestroy(CouplerResults *r);

#endif
