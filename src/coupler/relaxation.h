/* relaxation.h - next iterate of a fixed-point problem x = H(x) from its residuals H(x) - x: Aitken's factor, interface quasi-Newton.

   [Kuettler & Wall, Comput. Mech. 43 (2008) 61; Degroote, Bathe & Vierendeels, Comput. Struct. 87 (2009) 793] */
#ifndef BY_RELAXATION_H
#define BY_RELAXATION_H

#include "base.h"

typedef enum { RELAXATION_IQN_ILS, RELAXATION_AITKEN } RelaxationKind;

#define RELAXATION_COLUMNS 64   /* differences kept at most, the newest                                                        */
#define RELAXATION_FILTER  1e-2 /* a difference whose part outside those newer than it is smaller than this is left out        */
#define RELAXATION_NOISE   0.01  /* of the largest difference of a step: smaller ones are not kept for the next steps           */

typedef struct Relaxation {
  int        kind;                         /* RelaxationKind                                                                  */
  PetscReal  start, factor;                /* first factor of all, Aitken's last one                                          */
  PetscReal  size;                         /* |residual| of the last iterate                                                  */
  PetscInt   n, reuse;                     /* unknowns; steps whose differences are kept                                      */
  PetscInt   count;                        /* iterates of this step so far                                                    */
  PetscReal *x, *residual;                 /* the last iterate and its residual                                               */
  PetscReal *V[RELAXATION_COLUMNS], *W[RELAXATION_COLUMNS]; /* differences of residuals and of H, newest first                 */
  PetscReal *Q[RELAXATION_COLUMNS];        /* orthonormal basis of V, scratch                                                 */
  PetscInt   n_columns, age[RELAXATION_COLUMNS]; /* steps ago that each was made                                               */
} Relaxation;

PETSC_INTERN PetscErrorCode RelaxationCreate(int kind, PetscReal start, PetscInt reuse, PetscInt n, Relaxation **relaxation);
PETSC_INTERN PetscErrorCode RelaxationDestroy(Relaxation **relaxation);
/* a new problem, near the last one: its differences grow older, those of more than `reuse` problems ago are dropped */
PETSC_INTERN PetscErrorCode RelaxationBegin(Relaxation *relaxation);
/* the problem has changed: nothing that was learnt holds */
PETSC_INTERN PetscErrorCode RelaxationForget(Relaxation *relaxation);
/* x: iterate, then the next one; residual = H(x) - x of the first */
PETSC_INTERN PetscErrorCode RelaxationNext(Relaxation *relaxation, PetscReal x[], const PetscReal residual[]);
/* what the next problem depends on, as n numbers (state NULL: ask for n), and back */
PETSC_INTERN PetscErrorCode RelaxationGetState(const Relaxation *relaxation, PetscInt *n, PetscReal state[]);
PETSC_INTERN PetscErrorCode RelaxationSetState(Relaxation *relaxation, PetscInt n, const PetscReal state[]);

#endif
