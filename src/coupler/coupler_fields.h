/* coupler_fields.h - fields of the water on a surface; included only in src/coupler. */
#ifndef BY_COUPLER_FIELDS_H
#define BY_COUPLER_FIELDS_H

#include "coupler_impl.h"

/* at the proxies or at the nodes of a body or obstacle */
typedef struct {
  PetscReal *pressure;       /* [Pa] force along the normal over area        */
  PetscReal *water;          /* [1] part of the kernel in front that is full */
  PetscReal *water_pressure; /* [Pa] Shepard mean of the particles'          */
  PetscReal *water_velocity; /* [m/s] x 3, Shepard mean of the particles'    */
} CouplerFields;

PETSC_INTERN PetscErrorCode CouplerFieldsCreate(Coupler c, PetscInt k, CouplerFields *proxies, CouplerFields *nodes);
PETSC_INTERN PetscErrorCode CouplerFieldsDestroy(CouplerFields *fields);

#endif
