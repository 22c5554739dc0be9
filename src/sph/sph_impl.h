/* sph_impl.h - the struct behind SPH; included only in src/sph. */
#ifndef BY_SPH_IMPL_H
#define BY_SPH_IMPL_H

#include <petsc/private/petscimpl.h>

#include "sph.h"
#include "sph_frame.h"
#include "sph_loops.h"
#include "sph_pair.h"

#define SPH_CHUNK 1024 /* particles of one partial sum: sums are the same for every number of threads */
#define SPH_SUMS  8    /* partial sums that one pass over the particles may form */

/* first and one past the last particle of chunk c */
#define SPH_FIRST(c)   ((c) * SPH_CHUNK)
#define SPH_LAST(c, n) (((c) + 1) * SPH_CHUNK < (n) ? ((c) + 1) * SPH_CHUNK : (n))
#define SPH_CHUNKS(n)  (((n) + SPH_CHUNK - 1) / SPH_CHUNK)

typedef struct _SPHViscous *SPHViscous;

/* what friction of walls needs of one touched particle of a surface */
typedef struct {
  PetscReal *union_factor; /* c of SPHGetUnionFactors, n_touched [1] */
  PetscReal *friction;     /* k of SPHWallFriction, n_touched [1/s]  */
  PetscReal *velocity;     /* proxies' velocities that friction saw, n_proxies x 3 [m/s]; viscous flows only */
  PetscInt   proxies;      /* allocated                              */
  PetscInt   capacity;     /* elements allocated                     */
} SPHSurfaceWork;

/* What a solve is for: the operator is out = S (dt^2 D D^T + response) S y */
typedef struct {
  PetscReal   dt;
  SPHResponse response;
  void       *ctx;
  PetscBool   compact; /* the compact Laplacian of sph_isph.c in place of D D^T */
} SPHOperator;

/* A pressure solver (sph.solver), one file each. Whatever it does, its effect on a step is one p~ a particle at the configuration of the step,
   the sum of all its iterations and sub-solves: what SPHGetForces() and SPHPlaneForces_Internal() give walls and proxies is then the impulse
   that the fluid has lost. Entries may be NULL unless said otherwise; a solver without Solve is refused. */
typedef struct {
  const char *name;                                                    /* as in the scene                                                          */
  PetscReal   tolerance;                                               /* what sph.tolerance 0 means; never 0                                      */
  PetscBool   relaxes;                                                 /* sph.relax_time 0 means 0.5 h/speed; else all at once                     */
  PetscBool   responds;                                                /* Solve takes op->response; else the coupler's walls are predicted alone   */
  PetscBool   ignores_rate;                                            /* Solve does not read sph->rate: it is not computed                        */
  PetscErrorCode (*SetUp)(SPH sph);                                    /* end of SPHSetUp: check parameters, allocate sph->method_data; arrays of particles by SPHAddArray_Internal() */
  PetscErrorCode (*Destroy)(SPH sph);                                  /* free sph->method_data                                                         */
  PetscErrorCode (*LimitStep)(SPH sph, PetscReal *dt);                 /* lower the adaptive step [s]                                              */
  PetscErrorCode (*Predict)(SPH sph, PetscReal dt);                    /* add to v* forces of its own, before rate = D v*; rho is current          */
  PetscErrorCode (*Solve)(SPH sph, const SPHOperator *op);             /* sph->p [Pa], iterations, converged; wall_rate is current; v* and x stay: it may be called again */
  PetscErrorCode (*PlaneForces)(SPH sph, PetscReal force[6]);          /* along the planes' axes, of pressure [N]; NULL: of p~ at the configuration of the step */
  PetscErrorCode (*Accelerate)(SPH sph, PetscReal dt);                 /* sph->accel = acceleration of v* by pressure; NULL: -D^T p~               */
  PetscErrorCode (*Drift)(SPH sph, PetscReal dt, PetscReal *path);     /* move x (wrapped by the caller), tell the longest path [m]; NULL: x += dt v */
} SPHSolverOps;

extern const SPHSolverOps SPHSolverIISPH, SPHSolverIISPHJacobi, SPHSolverISPH, SPHSolverDFSPH, SPHSolverPCISPH, SPHSolverPBF, SPHSolverWCSPH;

/* an array with a place for each particle (sph_arrays.c) */
#define SPH_ARRAYS_MAX 96
typedef struct {
  void **array; /* where the fluid keeps the pointer */
  size_t bytes; /* of one particle                   */
} SPHArray;

/* a rectangle on a planar wall whose pressure is watched (sph_patch.c) */
typedef struct {
  int       wall;           /* 0..5                                                       */
  PetscReal min[3], max[3]; /* [m], within the domain                                     */
  PetscReal area, force;    /* [m^2], [N] along the outward normal, of the last step      */
} SPHPatch;
/* what a particle is: its velocity or its pressure may be prescribed where water enters and leaves (sph_open.c) */
enum { SPH_FREE, SPH_HELD = SPH_LOOPS_HELD, SPH_GIVEN };
#define SPH_OPENINGS_MAX 100
typedef struct _SPHOpening SPHOpening;

/* of the compact operator and of corrected gradients (sph_isph.c, sph_shift.c); allocated when first used */
typedef struct {
  PetscInt   allocated;              /* particles                                              */
  size_t     slots;                  /* pairs                                                  */
  PetscReal *distance;               /* n x SPH_IMAGES [m]                                     */
  PetscReal *moments;                /* n x 6, B: inverse of sum_j V (x_j - x_i) grad W_ij [1] */
  PetscReal *trace;                  /* n, of the moments with images [kg/m^3]                 */
  PetscReal *stretch;                /* n x 6, N of SPHPairStretch [1]                         */
  PetscReal *velocity_gradient;      /* n x 9 [1/s]                                            */
  PetscReal *pressure_gradient;      /* n x 3 [Pa/m]                                           */
  PetscReal *fullness;               /* n, least eigenvalue of the full moments [1]            */
  PetscReal *shift;                  /* n x 3 [m]                                              */
} SPHCompactWork;

struct _p_SPH {
  PETSCHEADER(int);
  SPHParams params;
  PetscBool setup;

  const SPHSolverOps *method;        /* the solver in use                                */
  void               *method_data;   /* its own data                                     */

  /* domain and forces */
  PetscBool has_domain;
  PetscReal min[3], max[3];          /* [m]                                              */
  unsigned  walls, periodic;         /* bits of SPHSetDomain                             */
  PetscReal particle_volume;         /* [m^3] asked for; 0 = spacing^3                   */
  PetscReal gravity[3];              /* [m/s^2] of the laboratory                        */

  /* prescribed motion; motions are borrowed, NULL = at rest */
  PetscReal     time;                /* [s]                                              */
  const Motion *motion[6], *frame;   /* of the planes, of the whole tank                 */
  unsigned      slip;                /* planes without friction                          */
  PetscReal     plane[6];            /* where they are, along their axes [m]             */
  PetscReal     plane_velocity[18];  /* mean over the coming step, from SPHPredict [m/s] */
  PetscReal     gravity_now[3];      /* as seen from the tank [m/s^2]                    */
  PetscReal    *frame_kick;          /* n x 3 [m/s] of the step; with a frame only       */
  PetscReal     wall_work, frame_work; /* [J] on the fluid since the start               */

  /* derived at SetUp */
  PetscReal surface_part;            /* factor on phi of surfaces: 1, less while isph packs                   */
  PetscReal wall_flux;               /* factor on rho0 grad phi in G: 1, or 2/s where images share the flux (sph_isph.c) */
  PetscReal shifting;                /* strength in use [1]                              */
  PetscReal h, mass, wall_factor;    /* [m], [kg], [1]                                   */
  int       gradient_kernel;         /* SPHKernelType                                    */
  PetscReal prototype;               /* sum |m grad W|^2 over a full lattice [kg^2/m^8]  */
  PetscReal sound_speed;             /* [m/s] of wcsph, else 0                           */
  PetscReal relax_time;              /* [s]; 0: correct all at once; negative: 10 dt     */
  PetscReal viscous_norm;            /* K_ii of a full lattice over nu [1/m^2]           */
  PetscReal mu_pairs;                /* viscosity that the pair loop needs to show the fluid's [Pa s] */
  PetscReal flow_speed;              /* that the scene prescribes: mean velocity, openings [m/s] */
  PetscReal filter_rate, filter_norm; /* [1/s], [kg^2/m^8]                               */

  /* state, sorted by cell then id */
  PetscInt   n, capacity;            /* particles, and how many the arrays have room for */
  PetscInt   n_arrays;
  SPHArray   array[SPH_ARRAYS_MAX];
  PetscReal *x, *v, *p, *rho;        /* n x 3 [m], n x 3 [m/s], n [Pa], n [kg/m^3]       */
  PetscInt  *id;
  PetscInt   next_id;                /* of the next particle that enters; ids are never used again */

  /* openings; kind and opened_by only when there are any */
  PetscInt       n_openings;
  SPHOpening    *opening;
  PetscBool      gives_pressure;     /* one of them gives a pressure that is not 0       */
  PetscBool      packing;            /* nothing enters or leaves                         */
  unsigned char *kind;               /* n, SPH_FREE, SPH_HELD, SPH_GIVEN                 */
  signed char   *opened_by;          /* n, by which opening, or -1                       */

  /* of the current step */
  PetscReal *v_star;                 /* n x 3 [m/s] velocity before pressure             */
  PetscReal *accel;                  /* n x 3 [m/s^2] scratch of predict and advance     */
  PetscReal *rho_pairs;              /* n, sum_j m W_ij                                  */
  PetscReal *open;                   /* n, prod_k (1 - phi_k) over planes, then over all */
  PetscReal *open_surfaces;          /* n, the product over surfaces alone               */
  PetscReal *G_planes, *G;           /* n x 3 [kg/m^4], planes alone and the union       */
  PetscReal *rate;                   /* n, D v* without the walls' own motion [kg/(m^3 s)] */
  PetscReal *wall_rate;              /* n, sum_b rho0 c share . v_b                      */
  PetscReal *confine;                /* 2 n x 3, vorticity [1/s] and slope of its size; confinement only */
  PetscReal *friction_planes;        /* n, k of the planes [1/s]; viscous flows only, like what follows */
  PetscReal *volume;                 /* n, 1/rho as viscosity sees it [m^3/kg]           */
  PetscReal *push;                   /* n x 3, sum_k k v_wall of walls in motion [m/s^2] */
  PetscReal *v_viscous;              /* n x 3, velocity that friction acts on [m/s]      */
  SPHViscous viscous;                /* of the implicit solve (sph_viscosity.c), or NULL */
  PetscInt   viscous_solves, viscous_iterations; /* since the start of this process      */

  /* pressure solve; y = p~/scale, root = 1/scale or 0 */
  PetscReal *rhs, *root, *scale, *y, *residual, *direction, *Adirection, *p_tilde, *response;
  PetscReal *mode;                   /* where the power iteration for the norm starts    */
  PetscReal  norm;                   /* largest eigenvalue of S D D^T S [1]              */
  PetscReal *partial;                /* SPH_CHUNKS(capacity) x SPH_SUMS                  */

  SPHCompactWork   compact;
  const PetscReal *wall_gradient;    /* n x 3 [Pa/m] by which p is continued to walls; NULL = not continued */

  /* second copies for sorting */
  PetscReal *x_alt, *v_alt, *p_alt;
  PetscInt  *id_alt, *order;

  SPHLoops            loops;
  const SPHLoopTable *table;
  PetscInt            grid_allocated, list_chunks; /* cells; chunks of particles that the neighbour list has room for */
  PetscReal           grid_drift;    /* how far particles may have moved since they were sorted [m] */

  PetscInt        n_surfaces, surfaces_allocated;
  SPHContacts    *contacts;          /* borrowed                                         */
  SPHSurfaceWork *surfaces;

  /* time step, controller, ledger */
  PetscInt  step;
  PetscReal dt_last, accel_max;      /* [s], [m/s^2]                                     */
  PetscReal body_force[3], control[3]; /* [m/s^2], and its integral part                 */
  PetscReal viscous_loss;            /* [J]                                              */
  PetscReal wall_force[18];          /* [N]                                              */
  PetscInt  n_patches;
  SPHPatch *patches;                 /* n_patches                                        */
  PetscInt  iterations, iterations_before; /* of the current pressure solve, of earlier ones of the step */
  PetscBool converged;
  char      breakdown[512];
};

extern PetscLogEvent SPH_Neighbors, SPH_Contacts, SPH_Predict, SPH_Pressure, SPH_Apply, SPH_Forces, SPH_Advance;

/* sph_arrays.c: arrays with `bytes` for each particle; field is the address of the pointer */
PETSC_INTERN PetscErrorCode SPHAddArray_Internal(SPH sph, void *field, size_t bytes);
PETSC_INTERN PetscErrorCode SPHReserve_Internal(SPH sph, PetscInt n);
PETSC_INTERN PetscErrorCode SPHFreeArrays_Internal(SPH sph);

/* sph_sums.c: sums over fixed chunks, in order; `partial` is filled by chunk */
PETSC_INTERN void SPHSumPartials(SPH sph, int n_sums, PetscReal sums[]);

/* sph_walls.c */
PETSC_INTERN PetscErrorCode SPHFindPlanes_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHWallRate_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHPlaneForces_Internal(SPH sph);
/* walls at a place x near that of particle i, dt later: what planes leave open and, by plane, rho0 grad phi along its axis [kg/m^4]; what surfaces leave
   open, linear in the way relative to them, with `solid` = their part of G */
PETSC_INTERN void      SPHPlanesAt_Internal(SPH sph, PetscReal dt, const PetscReal x[3], PetscReal *open, PetscReal part[6]);
PETSC_INTERN PetscReal SPHSurfacesAt_Internal(SPH sph, int i, PetscReal dt, const PetscReal x[3], const PetscReal solid[3]);
/* force [N] of the pressure of particle i on plane k along the plane's axis */
PETSC_INTERN PetscReal SPHPlanePressure_Internal(SPH sph, int i, int k);
PETSC_INTERN PetscReal SPHSurfaceDistance_Internal(SPH sph, const SPHContacts *contacts, PetscInt t);
/* rho_i += density of the walls at positions x (n x 3, not wrapped) near those of the step, dt later */
PETSC_INTERN void SPHAddWallDensity_Internal(SPH sph, PetscReal dt, const PetscReal x[], PetscReal rho[]);
/* distance [m] of a position from plane k (0..5), positive inside; gradient +-1 along its axis in *sign */
static inline PetscReal SPHPlaneDistance(SPH sph, int k, const PetscReal x[3], PetscReal *sign)
{
  *sign = k % 2 ? -1.0 : 1.0;
  return *sign * (x[k / 2] - sph->plane[k]);
}
/* friction of the planes that move at particle i: drag = sum_k k_k v_k [m/s^2]; returns sum_k k_k |v_k|^2 [m^2/s^3] */
PETSC_INTERN PetscReal SPHPlaneDrag_Internal(SPH sph, int i, PetscReal drag[3]);
PETSC_INTERN PetscBool SPHPlanesMove_Internal(SPH sph);

/* sph_motion.c */
PETSC_INTERN void      SPHPlace_Internal(SPH sph);
PETSC_INTERN void      SPHMovePlanes_Internal(SPH sph, PetscReal dt);
PETSC_INTERN PetscReal SPHFastestPlane_Internal(SPH sph);
PETSC_INTERN PetscReal SPHFrameAcceleration_Internal(SPH sph);
PETSC_INTERN void      SPHFramePredict_Internal(SPH sph, PetscReal dt, PetscReal gravity[3]);
PETSC_INTERN void      SPHFrameWork_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHTick_Internal(SPH sph, PetscReal dt);

/* sph_patch.c */
PETSC_INTERN void SPHPatchForces_Internal(SPH sph);
PETSC_INTERN void SPHPatchStop_Internal(SPH sph, int wall, int i, PetscReal force);

/* sph_stop.c */
PETSC_INTERN void SPHStopAtPlanes_Internal(SPH sph, PetscReal dt);

/* sph_gauge.c: visit(sph, particle, displacement of its nearest image from `at`, ctx) for all particles of the cells in a box of +- reach */
typedef void (*SPHVisit)(SPH sph, int i, const PetscReal d[3], void *ctx);
PETSC_INTERN void SPHVisitBox_Internal(SPH sph, const PetscReal at[3], const PetscReal reach[3], SPHVisit visit, void *ctx);

/* sph_open.c, sph_open_setup.c */
PETSC_INTERN PetscErrorCode SPHOpenFromOptions_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHOpenSetUp_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHOpenDestroy_Internal(SPH sph);
PETSC_INTERN PetscReal      SPHOpenSpeed_Internal(SPH sph);
PETSC_INTERN PetscReal      SPHParticleVolume_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHExchange_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHOpenMirror_Internal(SPH sph);
PETSC_INTERN void           SPHOpenMark_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHOpenPredict_Internal(SPH sph, PetscReal dt);
PETSC_INTERN void           SPHOpenHold_Internal(SPH sph);
PETSC_INTERN void           SPHOpenPressure_Internal(SPH sph);
PETSC_INTERN PetscReal      SPHOpenSolid_Internal(SPH sph, int side, const PetscReal x[3]);

/* sph_viscosity.c */
PETSC_INTERN PetscErrorCode SPHViscousPredict_Internal(SPH sph, PetscReal dt);
PETSC_INTERN PetscReal      SPHViscousStep_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHViscousDestroy_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHFilterPredict_Internal(SPH sph, PetscReal dt);

/* sph_smooth.c */
PETSC_INTERN PetscErrorCode SPHSmoothPredict_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHConfinePredict_Internal(SPH sph, PetscReal dt);

/* sph_pressure.c: the solver that the parameters ask for */
PETSC_INTERN const SPHSolverOps *SPHFindSolver_Internal(const SPHParams *params);
/* one application of the scaled operator, out = S (dt^2 D D^T + response) S y */
PETSC_INTERN PetscErrorCode SPHApply_Internal(SPH sph, const SPHOperator *op, const PetscReal y[], PetscReal out[]);
/* S from the diagonal, b scaled, y from the last pressure times `warm`; and p from y */
PETSC_INTERN void SPHPrepare_Internal(SPH sph, PetscReal dt, PetscReal warm);
PETSC_INTERN void SPHStorePressure_Internal(SPH sph);
/* sph->accel = -D^T p~ of sph->p [m/s^2] */
PETSC_INTERN void SPHPressureAcceleration_Internal(SPH sph);
/* BY_ERR_BREAKDOWN when a pressure is not a number */
PETSC_INTERN PetscErrorCode SPHCheckPressure_Internal(SPH sph);

/* sph_newton.c, sph_mprgp.c, sph_closed.c, sph_iisph.c: what works on the operator */
PETSC_INTERN PetscErrorCode SPHFindNorm_Internal(SPH sph, const SPHOperator *op);
PETSC_INTERN PetscErrorCode SPHSolveMPRGP_Internal(SPH sph, const SPHOperator *op);
PETSC_INTERN PetscErrorCode SPHSolveNewton_Internal(SPH sph, const SPHOperator *op);
PETSC_INTERN PetscErrorCode SPHSolveCG_Internal(SPH sph, const SPHOperator *op);
/* sph_ksp.c: whether the options choose a KSP or TAO for the system, the solve, and what it keeps in method_data */
PETSC_INTERN PetscErrorCode SPHWantsKSP_Internal(SPH sph, PetscBool *wanted);
PETSC_INTERN PetscErrorCode SPHSolveKSP_Internal(SPH sph, const SPHOperator *op);
PETSC_INTERN PetscErrorCode SPHDestroyKSP_Internal(SPH sph);
/* sph_isph.c */
PETSC_INTERN PetscReal      SPHLatticeWallFactor_Internal(SPH sph);
PETSC_INTERN PetscErrorCode SPHCompact_Internal(SPH sph, PetscReal diagonal[]);
PETSC_INTERN PetscErrorCode SPHCompactDestroy_Internal(SPH sph);
PETSC_INTERN void           SPHVelocityGradient_Internal(SPH sph, const PetscReal v[], PetscReal deviation[]);
PETSC_INTERN void           SPHWallConcentration_Internal(SPH sph, PetscInt i, PetscReal C[3]);
/* sph_shift.c */
PETSC_INTERN PetscErrorCode SPHShift_Internal(SPH sph, PetscReal dt);
/* solve for the density alone, dt = 1, starting from nothing, with the walls at rest */
PETSC_INTERN PetscErrorCode SPHPackSolve_Internal(SPH sph);

/* sph_neighbors.c */
PETSC_INTERN PetscErrorCode SPHCheckState_Internal(SPH sph, const char when[]);

#endif
