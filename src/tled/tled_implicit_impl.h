/* tled_implicit_impl.h - the inside of a TLEDImplicit; only src/tled/tled_implicit.c, tled_static.c and tled_newmark.c include it. */
#ifndef BY_TLED_IMPLICIT_IMPL_H
#define BY_TLED_IMPLICIT_IMPL_H

#include "tled/tled_assembly.h"
#include "tled/tled_implicit.h"

#define PAST 4 /* residuals of Newton's method that are looked back at */

/* What is solved for the displacement x:
     inertia M (x - u0) + f_int(y) - load f_ext(time, y) + constant = 0,   y = share x + (1 - share) u0,
   in the free directions, and x = held_at in the others. Static: share 1, inertia 0 (or a drag). */
typedef struct {
  PetscReal time;       /* of loads [s]                                                            */
  PetscReal share;      /* of the new displacement in that at which forces are taken, 1 - alpha_f  */
  PetscReal load;       /* part of the external forces that acts                                   */
  PetscReal inertia;    /* mass terms with x [1/s^2]                                               */
  PetscReal viscous;    /* stiffness damping: forces at y + viscous (x - u0) + rate  [1]           */
  PetscReal history;    /* time over which relaxing stresses relax [s]; PETSC_MAX_REAL: all of it  */
  PetscReal *constant;  /* n_nodes x 3 [N]                                                         */
  PetscReal *held_at;   /* n_nodes x 3: displacement of the constrained directions, else 0 [m]     */
  PetscReal *u0;        /* n_nodes x 3: displacement at the start of the step [m]                  */
  PetscReal *rate;      /* n_nodes x 3: see viscous; used when stiffness damping is on [m]         */
} TLEDImplicitProblem;

struct _n_TLEDImplicit {
  MPI_Comm            comm;
  TLED                tled;
  TLEDImplicitParams  params;
  TLEDImplicitStats   stats;
  char                prefix[BY_NAME_MAX + 16];
  TLEDAssembly       *assembly;
  SNES                snes;   /* NULL before the first solve */
  Vec                 x, r, everywhere;
  VecScatter          scatter;
  Mat                 K, P;   /* tangent; what the preconditioner is made of, NULL: K */
  PetscBool           by_factors; /* K is applied factor by factor (anp, iterative solver) */
  PetscReal           held;   /* stiffness in place of a constrained direction's [N/m] */
  PetscReal           scale;  /* 2-norm of the forces of the last residual [N]         */
  PetscReal           past[2 + PAST]; /* residuals: the first two, then the last ones [N] */
  TLEDImplicitProblem problem;
  PetscReal          *y;      /* n_nodes x 3: where forces are taken [m]                */
  PetscReal          *f_int, *f_ext, *residual; /* n_nodes x 3 [N]                      */
  PetscReal          *start, *trial, *last[3]; /* n_nodes x 3: displacements of load stepping [m] */
  PetscReal          *v, *a;  /* n_nodes x 3: velocity, acceleration of the time steps   */
  PetscReal          *inner, *outer; /* n_nodes x 3: at the last step's end, internal forces with contact's; loads' and f [N] */
  PetscObjectState    state[3]; /* of the TLED's vectors u, v, f when a was worked out   */
  PetscReal           state_time;
  PetscBool           stepped;
  PetscBool           follows, unsymmetric; /* a load follows the surface; the solvers know it  */
};

/* tled_implicit.c */
PetscReal      TLEDImplicitNorm_Private(PetscInt n, const PetscReal x[]);
PetscErrorCode TLEDImplicitSetUp_Private(TLEDImplicit im);
PetscErrorCode TLEDImplicitNewton_Private(TLEDImplicit im, PetscReal x[], PetscBool *converged);
PetscErrorCode TLEDImplicitLinear_Private(TLEDImplicit im, const PetscReal x[], const PetscReal rhs[], PetscReal dx[], PetscBool *solved);
PetscErrorCode TLEDImplicitResidual_Private(TLEDImplicit im, const PetscReal x[], PetscReal r[]);
PetscErrorCode TLEDImplicitForces_Private(TLEDImplicit im, const PetscReal y[], PetscReal f[]);
PetscErrorCode TLEDImplicitFinish_Private(TLEDImplicit im, const PetscReal u[], const PetscReal v[], PetscReal time);
#endif
