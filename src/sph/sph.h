/* sph.h - the incompressible fluid: smoothed particles, pressure solvers, planar walls. */
#ifndef BY_SPH_H
#define BY_SPH_H

#include "course.h"
#include "motion.h"

typedef struct _p_SPH *SPH;

typedef enum {
  SPH_SOLVER_AUTO,         /* iisph with a free surface, isph without                          */
  SPH_SOLVER_IISPH,        /* implicit, p >= 0 by projected Newton-Krylov steps (sph_iisph.c)  */
  SPH_SOLVER_IISPH_JACOBI, /* the same system by the paper's relaxed Jacobi (sph_iisph.c)      */
  SPH_SOLVER_ISPH,         /* projection with a compact Laplacian (sph_isph.c)                 */
  SPH_SOLVER_DFSPH,        /* divergence-free SPH (sph_dfsph.c)                                */
  SPH_SOLVER_PCISPH,       /* predictive-corrective SPH (sph_pcisph.c)                         */
  SPH_SOLVER_PBF,          /* position-based fluids (sph_pbf.c)                                */
  SPH_SOLVER_WCSPH         /* weakly compressible: pressure from density (sph_wcsph.c)         */
} SPHSolver;
typedef enum { SPH_KERNEL_CUBIC_SPLINE, SPH_KERNEL_WENDLAND_C2, SPH_KERNEL_POLY6, SPH_KERNEL_SPIKY } SPHKernelType;
typedef enum { SPH_NORM_AUTO, SPH_NORM_MEAN, SPH_NORM_LARGEST } SPHNorm;
typedef enum { SPH_VISCOUS_MORRIS, SPH_VISCOUS_MONAGHAN } SPHViscousForm;
typedef enum { SPH_BOUNDED_NEWTON, SPH_BOUNDED_MPRGP } SPHBounded;
typedef enum { SPH_VISCOSITY_AUTO, SPH_VISCOSITY_EXPLICIT, SPH_VISCOSITY_IMPLICIT } SPHViscositySolver; /* auto: implicit where explicit would halve the step */
typedef enum { SPH_PRECISION_SINGLE, SPH_PRECISION_DOUBLE } SPHPrecision;

/* Parameters of the section `sph:`; SPHKeys[] (sph_keys.c) declares each with unit, default and range. */
typedef struct {
  PetscReal spacing;          /* dx [m], initial particle spacing; required                              */
  PetscReal density;          /* rho0 [kg/m^3]                                                           */
  PetscReal viscosity;        /* mu [Pa s], 0 = inviscid: no viscous pass at all                         */
  PetscReal support;          /* h / dx, support radius over spacing                                     */
  PetscReal tolerance;        /* mean residual of the pressure solve over rho0; 0 = of the solver        */
  int       tolerance_norm;   /* SPHNorm of the compression that pcisph, dfsph and pbf stop at           */
  PetscReal gamma;            /* exponent of wcsph's equation of state, 1 = plain                        */
  PetscReal sound_speed;      /* c [m/s] of wcsph; 0 = 10 sqrt(v0^2 + 2 g H)                             */
  PetscReal stiffness;        /* k = c^2 [m^2/s^2] of p = k (rho - rho0); 0 = from the speed of sound    */
  PetscReal artificial_viscosity; /* alpha of wcsph                                                      */
  PetscReal divergence_tolerance; /* of dfsph: mean compression that the velocity would cause in one step */
  PetscInt  max_iterations;   /* per step; reaching it is reported                                       */
  PetscReal cfl;              /* of 0.4                                                                  */
  PetscReal time_step;        /* fixed step [s]; 0 = adaptive                                            */
  PetscReal max_time_step;    /* upper bound [s] of the adaptive step; 0 = none                          */
  PetscReal relax_time;       /* tau [s] of the density source; 0 = 0.5 h/max(sqrt(g h), mean velocity)  */
  PetscReal wall_factor;      /* s of method 2; 0 = calibrated value of kernel and h/dx                  */
  PetscReal noise_damping;    /* rate of the noise filter over sqrt(g/h); 0 = no filter                  */
  PetscReal shifting;         /* strength of particle shifting; negative = auto: 4 with isph, else 0       */
  PetscInt  pbf_iterations;   /* of pbf, a fixed number; 0 = until the tolerance is met                  */
  PetscReal pbf_warm_start;   /* part of the last pressure that pbf starts from                          */
  PetscReal pbf_relaxation;   /* epsilon of pbf over the sum of squared gradients in a full lattice      */
  PetscReal artificial_pressure, artificial_pressure_distance, artificial_pressure_exponent; /* s_corr of pbf: k over lambda of C = 1, |delta q| / h, n */
  PetscReal xsph;             /* c of XSPH                                                               */
  PetscReal vorticity_confinement; /* epsilon [m/s]                                                      */
  PetscReal mean_velocity[3]; /* target of the body-force controller [m/s]; 0 0 0 = no controller        */
  PetscBool free_surface;     /* clamp p >= 0                                                            */
  int       solver;           /* SPHSolver                                                               */
  int       bounded;          /* SPHBounded                                                              */
  int       kernel;           /* SPHKernelType of density                                                */
  int       gradient_kernel;  /* of every gradient, at pairs and walls: 0 = the same, else SPHKernelType + 1 */
  int       viscous_form;     /* SPHViscousForm                                                          */
  int       viscosity_solver; /* SPHViscositySolver                                                        */
  int       precision;        /* SPHPrecision of the pair loops; positions and velocities are kept in double */
  PetscBool settle;           /* start from rest under hydrostatic pressure                              */
  Names     fill;             /* names of blocks sph.<name>: read by the coupler's scene builder         */
  Names     inflow, outflow, sources; /* names of openings sph.<name>                                    */
} SPHParams;

BY_EXTERN const Key SPHKeys[];

/* SPHKernelType that gradients are taken from */
static inline int SPHGradientKernel(const SPHParams *params) { return params->gradient_kernel ? params->gradient_kernel - 1 : params->kernel; }
/* Openings (sph_open.c): a rectangle on a side of the domain, or a disc in it. */
typedef enum { SPH_PROFILE_UNIFORM, SPH_PROFILE_PARABOLIC, SPH_PROFILE_TABLE } SPHProfile;

typedef struct {
  int          side;           /* 0..5: xmin xmax ymin ymax zmin zmax                           */
  PetscReal    min[3], max[3]; /* rectangle on it, clipped to the domain [m]                    */
  PetscReal    velocity;       /* mean [m/s], times the course                                  */
  int          profile;        /* SPHProfile                                                    */
  int          profile_axis;   /* 0..2                                                          */
  char         profile_table[PETSC_MAX_PATH_LEN];
  CourseParams course;
} SPHInflowParams;

typedef struct {
  int          side;
  PetscReal    min[3], max[3];
  PetscReal    velocity;        /* [m/s]; negative: what arrives leaves, against a given pressure */
  PetscReal    pressure, level; /* [Pa]; [m] of still water against gravity, -1e6: none           */
  CourseParams course;          /* of velocity                                                    */
} SPHOutflowParams;

typedef struct {
  PetscReal    center[3], direction[3], radius; /* [m], [1], [m]                                */
  PetscReal    velocity, flow_rate;             /* one of them: [m/s], [m^3/s]                  */
  int          profile;                         /* SPHProfile, no table                         */
  PetscReal    volume;                          /* [m^3] that comes out; 0 = no end             */
  CourseParams course;
} SPHSourceParams;

BY_EXTERN const Key SPHInflowKeys[], SPHOutflowKeys[], SPHSourceKeys[];

/* What one surface (elastic body or obstacle) does to the particles within reach, made by src/proxy each step.
   phi is the part of the kernel's volume that lies in the body (method 2: lambda; 0 far away), grad its gradient with
   respect to the particle's position. share says which proxy gives which part: sum over a particle's pairs of share =
   grad. SPH merges surfaces and planes: phi_i = 1 - prod_k (1 - phi_ik), G_i = rho0 grad phi_i, and scales shares alike. */
typedef struct {
  PetscInt         n_touched;     /* particles with phi > 0                                                */
  const PetscInt  *particle;      /* n_touched, ascending particle index (current sorted order)            */
  const PetscReal *position;      /* n_touched x 3 [m], the periodic image of the particle that touches    */
  const PetscReal *phi;           /* n_touched [1], calibration factor s of the proxy kernel included      */
  const PetscReal *grad;          /* n_touched x 3 [1/m]                                                   */
  const PetscInt  *start;         /* n_touched + 1, into proxy[] and share[]                               */
  const PetscInt  *proxy;         /* proxy index of each pair                                              */
  const PetscReal *share;         /* n_pairs x 3 [1/m]                                                     */
  PetscInt         n_proxies;
  const PetscReal *area;          /* n_proxies [m^2]; NULL = not known                                     */
  const PetscReal *velocity;      /* n_proxies x 3 [m/s], mean over the coming step; NULL = at rest        */
  const PetscReal *place;         /* n_proxies x 3 [m]; with `rotation` [rad/s] the velocity at a particle is v_b + rotation x (x_i - x_b); NULL: v_b */
  const PetscReal *rotation;
  PetscBool        slip;          /* a viscous fluid slips along it                                        */
  PetscReal        coefficient;   /* on grad where forces and rates are concerned, not on phi; 0 = 1       */
  PetscReal       *force;         /* n_proxies x 3 [N], out: force of the fluid on each proxy; may be NULL */
  PetscReal        total[3];      /* [N] out: total force of the fluid on this surface                     */
  PetscReal        moment[3];     /* [N m] out: its moment about the origin, applied where the particles are */
  PetscReal        power;         /* [W] out: sum of force . velocity as the fluid sees it                  */
} SPHContacts;

/* Compliant walls (method 5.3): adds to a wall-normal density-rate operator. Given p~ = p/rho0^2 of every particle
   (length n, double), adds to Ap the term of the solids' velocity response. Must be linear, symmetric and positive. */
typedef PetscErrorCode (*SPHResponse)(void *ctx, PetscInt n, const PetscReal p[], PetscReal Ap[]);

/* life: Create -> Set... -> SetFromOptions (-sph_*) -> SetUp -> steps -> Destroy */
BY_EXTERN PetscErrorCode SPHCreate(MPI_Comm comm, SPH *sph);
BY_EXTERN PetscErrorCode SPHGetParams(SPH sph, SPHParams **params); /* writable until SetUp */
BY_EXTERN PetscErrorCode SPHSetFromOptions(SPH sph);
/* walls: bit 2k = plane at min of axis k, bit 2k+1 = plane at max; periodic: bit k = axis k */
BY_EXTERN PetscErrorCode SPHSetDomain(SPH sph, const PetscReal min[3], const PetscReal max[3], unsigned walls, unsigned periodic);
BY_EXTERN PetscErrorCode SPHSetGravity(SPH sph, const PetscReal g[3]);
/* prescribed motion (sph_motion.c): planes that a viscous fluid slips along, planes that move, a tank that moves; motions are borrowed */
BY_EXTERN PetscErrorCode SPHSetSlip(SPH sph, unsigned walls);
BY_EXTERN PetscErrorCode SPHSetWallMotion(SPH sph, unsigned walls, const Motion *motion);
BY_EXTERN PetscErrorCode SPHSetFrame(SPH sph, const Motion *motion);
/* positions n x 3 [m], velocities n x 3 [m/s]; may be called several times before SetUp; copied */
BY_EXTERN PetscErrorCode SPHAddParticles(SPH sph, PetscInt n, const PetscReal x[], const PetscReal v[]);
/* volume of fluid [m^3] that a particle stands for, where it is not spacing^3: a lattice stretched to fill a closed box exactly; before SetUp */
BY_EXTERN PetscErrorCode SPHSetParticleVolume(SPH sph, PetscReal volume);
/* openings, after SPHSetDomain and before SPHSetUp; those that the options name (sph.inflow, outflow, sources) are added by SPHSetUp */
BY_EXTERN PetscErrorCode SPHAddInflow(SPH sph, const char name[], const SPHInflowParams *params);
BY_EXTERN PetscErrorCode SPHAddOutflow(SPH sph, const char name[], const SPHOutflowParams *params);
BY_EXTERN PetscErrorCode SPHAddSource(SPH sph, const char name[], const SPHSourceParams *params);
BY_EXTERN PetscErrorCode SPHSetUp(SPH sph);
BY_EXTERN PetscErrorCode SPHView(SPH sph, PetscViewer viewer);
BY_EXTERN PetscErrorCode SPHDestroy(SPH *sph);

/* One step, driven by the coupler:
     SPHUpdateNeighbors   sort particles, neighbour lists, planar walls (phi of the planes)
     SPHSetContacts       contacts of all surfaces for the current positions (arrays are borrowed until the next call)
     SPHGetTimeStep       largest permitted step [s] for the current state
     SPHPredict           density, gravity, viscosity, mean-velocity controller: v* = v + dt a
     SPHSolvePressure     pressure for rest density; response may be NULL; may be called again with other wall velocities
     SPHGetForces         writes contacts[k].force and the wall forces from the current pressure (and viscous forces)
     SPHAdvance           v = v* + dt a_p, x += dt v (symplectic Euler); positions wrapped into periodic directions */
BY_EXTERN PetscErrorCode SPHUpdateNeighbors(SPH sph);
BY_EXTERN PetscErrorCode SPHSetContacts(SPH sph, PetscInt n_surfaces, SPHContacts contacts[]);
BY_EXTERN PetscErrorCode SPHGetTimeStep(SPH sph, PetscReal *dt);
BY_EXTERN PetscErrorCode SPHPredict(SPH sph, PetscReal dt);
BY_EXTERN PetscErrorCode SPHSolvePressure(SPH sph, PetscReal dt, SPHResponse response, void *ctx);
BY_EXTERN PetscErrorCode SPHGetForces(SPH sph);
BY_EXTERN PetscErrorCode SPHAdvance(SPH sph, PetscReal dt);
/* SPHAdvance in two halves, v then x, between which a coupler stops particles at its bodies */
#define SPH_STOP_GAP 0.05 /* [dx] no particle ends a step nearer to a wall or body; the first layer of still water stands at 0.15 to 0.25 */
BY_EXTERN PetscErrorCode SPHKick(SPH sph, PetscReal dt);
BY_EXTERN PetscErrorCode SPHDrift(SPH sph, PetscReal dt);
BY_EXTERN PetscErrorCode SPHStop(SPH sph, PetscInt particle, const PetscReal change[3], const PetscReal shift[3]);

/* Factor c = d phi_i / d phi_ik of the union for touched particle t of surface k (length n_touched): G_ik = rho0 c grad_ik.
   Valid after SPHSetContacts; the compliant-wall operator of the coupler needs it. */
BY_EXTERN PetscErrorCode SPHGetUnionFactors(SPH sph, PetscInt surface, const PetscReal *c[]);

/* Move an initial cloud until no particle is denser than rest density by more than `tol` (mean compression), velocities and
   time untouched; surfaces are asked for through `contacts(ctx, sph)`, which must call SPHSetContacts (NULL: none). */
BY_EXTERN PetscErrorCode SPHPack(SPH sph, PetscReal tol, PetscInt max_sweeps, PetscErrorCode (*contacts)(void *, SPH), void *ctx);

/* Damped steps without time until still water is at rest with hydrostatic pressure; velocities are zero afterwards. rest (may be NULL): rms
   acceleration that is left, over gravity. */
BY_EXTERN PetscErrorCode SPHSettle(SPH sph, PetscReal tol, PetscInt max_steps, PetscErrorCode (*contacts)(void *, SPH), void *ctx, PetscReal *rest);

/* state in the current sorted order, double; arrays are borrowed, valid until the next SPHUpdateNeighbors */
BY_EXTERN PetscErrorCode SPHGetSize(SPH sph, PetscInt *n);
BY_EXTERN PetscErrorCode SPHGetState(SPH sph, const PetscReal *x[], const PetscReal *v[], const PetscReal *p[], const PetscReal *rho[], const PetscInt *id[]);
BY_EXTERN PetscErrorCode SPHGetMass(SPH sph, PetscReal *particle_mass);
BY_EXTERN PetscErrorCode SPHGetSupport(SPH sph, PetscReal *h);
BY_EXTERN PetscErrorCode SPHGetDomain(SPH sph, PetscReal min[3], PetscReal max[3], unsigned *walls, unsigned *periodic);
/* restart: all particles, any number of them where there are openings, by id: x, v [n x 3], p [n] (warm start) */
BY_EXTERN PetscErrorCode SPHSetState(SPH sph, PetscInt n, const PetscInt id[], const PetscReal x[], const PetscReal v[], const PetscReal p[]);
/* numbers beside the particles that the next step depends on, so that a restart gives the same bits */
#define SPH_INTERNALS 14
BY_EXTERN PetscErrorCode SPHGetInternals(SPH sph, PetscReal state[SPH_INTERNALS]);
BY_EXTERN PetscErrorCode SPHSetInternals(SPH sph, const PetscReal state[SPH_INTERNALS]);
/* volume [m^3] that has come in and gone out through openings since the start; buffers beyond them are outside */
BY_EXTERN PetscErrorCode SPHGetVolumes(SPH sph, PetscReal *entered, PetscReal *left);
/* the internals of openings, as many numbers as *n tells (0 without openings; state NULL: ask for n) */
BY_EXTERN PetscErrorCode SPHGetFlows(SPH sph, PetscInt *n, PetscReal state[]);
BY_EXTERN PetscErrorCode SPHSetFlows(SPH sph, PetscInt n, const PetscReal state[]);

/* Shepard-normalised value at a point: pressure [Pa] and velocity [m/s]; *inside = PETSC_FALSE where no fluid is within h */
BY_EXTERN PetscErrorCode SPHInterpolate(SPH sph, const PetscReal at[3], PetscReal *pressure, PetscReal velocity[3], PetscBool *inside);
/* height of the water [m] above the domain's floor in the column of radius h around (x, y), along -gravity */
BY_EXTERN PetscErrorCode SPHGetHeight(SPH sph, const PetscReal at[3], PetscReal *height);
/* height of the free surface [m] above the domain's floor, found upwards from `at`: where the fluid's density falls below half; splashes do not count */
BY_EXTERN PetscErrorCode SPHGetSurface(SPH sph, const PetscReal at[3], PetscReal *height);
/* force [N] along the outward normal on a rectangle of a planar wall, watched from the next step on, and its area [m^2] */
BY_EXTERN PetscErrorCode SPHAddPatch(SPH sph, PetscInt wall, const PetscReal min[3], const PetscReal max[3], PetscInt *patch);
BY_EXTERN PetscErrorCode SPHGetPatch(SPH sph, PetscInt patch, PetscReal *force, PetscReal *area);
/* volume [m^3/s] through a rectangle across an axis, positive along the axis */
BY_EXTERN PetscErrorCode SPHGetFlowRate(SPH sph, PetscInt axis, const PetscReal min[3], const PetscReal max[3], PetscReal *rate);
/* where the six planes are, along their axes [m], order xmin xmax ymin ymax zmin zmax */
BY_EXTERN PetscErrorCode SPHGetPlanes(SPH sph, PetscReal plane[6]);
/* force [N] of the fluid on the six planes, order xmin xmax ymin ymax zmin zmax */
BY_EXTERN PetscErrorCode SPHGetWallForces(SPH sph, PetscReal force[18]);
/* power [W] of the fluid on each of them in the last step */
BY_EXTERN PetscErrorCode SPHGetWallPowers(SPH sph, PetscReal power[6]);

typedef struct {
  PetscReal kinetic, potential;    /* [J]                                                                  */
  PetscReal momentum[3];           /* [kg m/s]                                                             */
  PetscReal angular[3];            /* about the origin [kg m^2/s]                                          */
  PetscReal compression_mean;      /* mean of max(0, rho - rho0)/rho0 over all particles                   */
  PetscReal compression_max;
  PetscReal speed_max, speed_rms;  /* [m/s]                                                                */
  PetscReal viscous_loss;          /* [J] since the start                                                  */
  PetscReal wall_work, frame_work; /* [J] done on the fluid since the start by planes that move, and by the motion of the tank */
  PetscInt  iterations;            /* operator applications of all pressure solves of the last step        */
  PetscInt  viscous_solves, viscous_iterations; /* implicit viscosity, by this process since its start     */
  PetscBool converged;             /* of the last pressure solve                                           */
  PetscReal body_force[3];         /* of the mean-velocity controller [m/s^2]                              */
  PetscInt  particles;             /* buffers of openings included                                         */
} SPHStats;
BY_EXTERN PetscErrorCode SPHGetStats(SPH sph, SPHStats *stats);

/* the solver in use (auto resolved by SPHSetUp), and whether it can take the response of compliant walls (method 5.3) */
BY_EXTERN PetscErrorCode SPHGetSolver(SPH sph, const char *name[], PetscBool *responds);

/* A step that cannot go on (NaN, particle out of the domain) returns BY_ERR_BREAKDOWN; this tells what and where. */
BY_EXTERN PetscErrorCode SPHGetBreakdown(SPH sph, const char **message);

#endif
