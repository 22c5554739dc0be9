/* coupler_verify.h - the parts of `byssus verify`; included only in src/coupler. */
#ifndef BY_COUPLER_VERIFY_H
#define BY_COUPLER_VERIFY_H

#include "coupler_impl.h"
#include "tled/tled_implicit.h"

/* of two, one for each way of solving */
enum { EXPLICIT = 0, IMPLICIT = 1 };

typedef struct {
  VerifyParams params;
  Coupler      side[2];  /* the same bodies, built twice; each side keeps its own state         */
  PetscInt     body;     /* number of the body that is looked at                                */
  Json         json;     /* summary.json                                                        */
  const char  *scene;    /* text of the scene, for the results                                  */
  PetscBool    failed;   /* something was over its tolerance                                    */
} Verify;

/* How far two displacement fields of one body are apart. */
typedef struct {
  PetscReal largest;  /* displacement of the second field [m]                                    */
  PetscReal max, rms; /* largest and root mean square nodal difference over `largest`            */
} VerifyDifference;

typedef struct {
  PetscLogDouble wall, cpu; /* [s] */
} VerifyClock;

/* coupler_verify.c */
PETSC_INTERN TLED           VerifyBody(const Verify *verify, int side);
PETSC_INTERN const char    *VerifyName(const Verify *verify);
PETSC_INTERN PetscErrorCode VerifyClockRead(VerifyClock *clock);
PETSC_INTERN VerifyDifference VerifyCompare(PetscInt n_nodes, const PetscReal a[], const PetscReal b[]);
PETSC_INTERN PetscErrorCode VerifyJudge(Verify *verify, const char what[], PetscBool good);
PETSC_INTERN PetscErrorCode VerifyBreakdown(Verify *verify, int side, const char when[]);
/* a state of one side into <body>_<name>.vtkhdf; other: the other side's displacement, n_nodes x 3, or NULL */
PETSC_INTERN PetscErrorCode VerifySeriesCreate(Verify *verify, const char name[], Series *series);
PETSC_INTERN PetscErrorCode VerifySeriesWrite(Verify *verify, Series series, PetscReal time, const PetscReal u[], const PetscReal other[]);
/* coupler_verify_static.c, coupler_verify_dynamic.c, coupler_verify_modes.c */
PETSC_INTERN PetscErrorCode VerifyStatic(Verify *verify);
PETSC_INTERN PetscErrorCode VerifyDynamic(Verify *verify);
PETSC_INTERN PetscErrorCode VerifyModes(Verify *verify);

#endif
