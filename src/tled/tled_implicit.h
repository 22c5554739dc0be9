/* tled_implicit.h - the solid solved implicitly: static and dynamic solutions of the same discrete problem through PETSc's SNES, and
   natural frequencies through SLEPc. The reference beside the explicit solid.

   A TLEDImplicit works on a communicator of any size: every rank holds the whole body (the same TLED, set up on PETSC_COMM_SELF from the
   same parameters), assembles the rows of its own nodes and takes part in the solve. The result is the state (u, v, time) of the TLED of
   every rank, the same numbers on each:

     TLEDImplicitCreate(PETSC_COMM_WORLD, tled, &implicit);   the TLED must be set up and outlive it
     TLEDImplicitSetFromOptions(implicit);                    -<body>_implicit_<key>; -<body>_implicit_snes_..., _ksp_..., _pc_...
     TLEDImplicitSolveStatic(implicit, time);                 or
     TLEDImplicitAdvance(implicit, dt, n_steps);
     TLEDGetVectors(tled, &u, &v, NULL), TLEDGetStats(tled, &stats), ...
     TLEDImplicitDestroy(&implicit); */
#ifndef BY_TLED_IMPLICIT_H
#define BY_TLED_IMPLICIT_H

#include "tled/tled.h"
#include <petscsnes.h>

typedef struct _n_TLEDImplicit *TLEDImplicit;

/* Parameters, options -<body>_implicit_<key>; TLEDImplicitKeys[] declares each. */
typedef struct {
  PetscReal tolerance;     /* of Newton's method: residual over the forces that make it up, 2-norms      */
  PetscReal load_step;     /* first part of the way to the load that is tried at once, 0 to 1             */
  PetscReal load_step_min; /* smallest part; below it the solve is given up                               */
  PetscReal rho_infinity;  /* of generalised-alpha: amplitude of the highest modes kept a step; 1 = none lost */
  PetscInt  direct_below;  /* unknowns below which linear systems are solved directly                     */
} TLEDImplicitParams;

BY_EXTERN const Key TLEDImplicitKeys[];

/* What the last SolveStatic or Advance took. */
typedef struct {
  PetscInt  load_steps, cuts;  /* load steps (time steps) done, tries that were taken back       */
  PetscInt  newton, linear;    /* iterations of Newton's method and of the linear solver         */
  PetscReal residual;          /* |residual| over |forces| at the end, 2-norms, free directions  */
  PetscReal seconds;           /* wall clock                                                     */
} TLEDImplicitStats;

BY_EXTERN PetscErrorCode TLEDImplicitCreate(MPI_Comm comm, TLED tled, TLEDImplicit *implicit);
BY_EXTERN PetscErrorCode TLEDImplicitGetParams(TLEDImplicit implicit, TLEDImplicitParams **params);
BY_EXTERN PetscErrorCode TLEDImplicitSetFromOptions(TLEDImplicit implicit);
BY_EXTERN PetscErrorCode TLEDImplicitView(TLEDImplicit implicit, PetscViewer viewer);
BY_EXTERN PetscErrorCode TLEDImplicitGetStats(TLEDImplicit implicit, TLEDImplicitStats *stats);
BY_EXTERN PetscErrorCode TLEDImplicitGetSNES(TLEDImplicit implicit, SNES *snes); /* borrowed */
BY_EXTERN PetscErrorCode TLEDImplicitDestroy(TLEDImplicit *implicit);

/* From the TLED's state (u, at its time) to equilibrium under the loads and constraints of time `time`, which becomes the TLED's time;
   v = 0 after it. On the way, part s of 1, loads and constraints are those of the time between, and what was out of balance at the
   start is given back as (1 - s) of it: any state is a fit start, and a load that is there from the beginning grows from nothing (from a
   body nearly at rest as itself, following the surface).
   Where Newton's method fails at contact, or in the shortest load step, the body is let go to its place as in a very viscous fluid.
   BY_ERR_BREAKDOWN, TLEDGetBreakdown() says why, when no equilibrium is found; the TLED then holds the last one found on the way. */
BY_EXTERN PetscErrorCode TLEDImplicitSolveStatic(TLEDImplicit implicit, PetscReal time);

/* n_steps time steps of dt [s] by generalised-alpha from the TLED's state. Second order in dt;
   no limit on dt for small vibrations, some fifty steps a period for large ones.
   BY_ERR_BREAKDOWN as above; the TLED then holds the last complete step. */
BY_EXTERN PetscErrorCode TLEDImplicitAdvance(TLEDImplicit implicit, PetscReal dt, PetscInt n_steps);

/* ---- natural frequencies, needs SLEPc ---- */

BY_EXTERN PetscErrorCode TLEDHaveModes(PetscBool *have); /* whether this program was built with SLEPc */

/* The n lowest natural frequencies [Hz] of small vibrations about the TLED's state: K(u) phi = (2 pi f)^2 M phi with the lumped mass and the
   constraints, ascending; a free body's first six are zero, an unstable mode's is negative (minus the root of the modulus).
   shapes (may be NULL): n x (n_nodes x 3), of unit mass norm, the same on every rank. */
BY_EXTERN PetscErrorCode TLEDModes(MPI_Comm comm, TLED tled, PetscInt n, PetscReal frequency[], PetscReal shapes[]);

/* 2/omega_max [s] of the TLED's state from SLEPc's largest eigenvalue to round-off: what TLEDGetCriticalStep() estimates */
BY_EXTERN PetscErrorCode TLEDExactCriticalStep(MPI_Comm comm, TLED tled, PetscReal *dt);

/* ---- ring-down of the explicit solid ---- */

/* Excite the modes `shapes` (n_modes, as from TLEDModes()) of the body at rest with velocity amplitudes such that each moves by at most
   `amplitude` [m] at the node where it is largest, run the explicit solid for n_samples x dt, and record at each sample, the start included:
   modal[k n_samples + i] = phi_k . M u and, when record is not NULL, record[3 i..] = displacement of node `node`. */
BY_EXTERN PetscErrorCode TLEDRingDown(TLED tled, PetscInt n_modes, const PetscReal frequency[], const PetscReal shapes[],
                                      PetscReal amplitude, PetscInt node, PetscReal dt, PetscInt n_samples, PetscReal modal[],
                                      PetscReal record[]);

/* Frequency [Hz] of the highest peak of a record's spectrum (Hann window) between f_min and f_max, by a parabola through the logarithm of its
   three highest points. */
BY_EXTERN PetscErrorCode TLEDSpectrumPeak(PetscInt n_samples, PetscReal dt, const PetscReal record[], PetscReal f_min, PetscReal f_max,
                                          PetscReal *frequency);

#endif
