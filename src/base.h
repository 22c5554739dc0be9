/* base.h - what every file of Byssus may rely on: host/device marks, PETSc 3.18 gaps, exit statuses. */
#ifndef BY_BASE_H
#define BY_BASE_H

#include <petscsys.h>

#ifndef PETSC_SUCCESS
  #define PETSC_SUCCESS 0 /* appeared in PETSc 3.19 */
#endif

#define BY_EXTERN extern PETSC_VISIBILITY_PUBLIC

/* exit statuses of the program (docs: README, "Exit status") */
enum { BY_EXIT_DONE = 0, BY_EXIT_FAILURE = 1, BY_EXIT_INPUT = 2, BY_EXIT_BREAKDOWN = 3, BY_EXIT_INTERRUPTED = 130 };

/* error codes of ours beside PETSc's: the user's input is wrong (already reported by InputError), a simulation that broke
   down (the object's GetBreakdown tells why), and Ctrl-C with the state saved. They, and all codes from 9001 to 9099, travel without a
   traceback: call with ByCall. */
#define BY_ERR_INPUT       ((PetscErrorCode)9001)
#define BY_ERR_BREAKDOWN   ((PetscErrorCode)9002)
#define BY_ERR_INTERRUPTED ((PetscErrorCode)9004)

#define ByCall(...) \
  do { \
    const PetscErrorCode by_ierr_ = (__VA_ARGS__); \
    if ((int)by_ierr_ >= 9001 && (int)by_ierr_ <= 9099) PetscFunctionReturn(by_ierr_); \
    PetscCall(by_ierr_); \
  } while (0)

/* Report that the user's value of the scene key `key` ("flap.fixed", "sph.spacing") cannot be used: prints
     file:line: key = value <what>
       <hint lines of what, after a newline>
   with the place when a scene is open (scene.c), else the key alone. Returns BY_ERR_INPUT, so that a check reads
   `if (bad) return InputError("sph.spacing", "...")`. Several may be reported before giving up. scene.c implements it. */
BY_EXTERN PetscErrorCode InputError(const char key[], const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
BY_EXTERN PetscInt       InputErrorCount(void); /* reported so far in this process */

#endif
