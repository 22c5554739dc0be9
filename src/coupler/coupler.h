/* coupler.h - the staggered loop: scene -> fluid, bodies, obstacles -> steps -> run directory. */
#ifndef BY_COUPLER_H
#define BY_COUPLER_H

#include "scene.h"
#include "output.h"
#include "sph/sph.h"
#include "tled/tled.h"
#include "proxy/proxy.h"

typedef struct _p_Coupler *Coupler;

typedef enum { COUPLER_SCHEME_AUTO, COUPLER_SCHEME_EXPLICIT, COUPLER_SCHEME_ITERATED, COUPLER_SCHEME_MASS } CouplerScheme;
typedef enum { COUPLER_FORCES_HELD, COUPLER_FORCES_INTERPOLATED } CouplerForces;
typedef enum {
  PROBE_DISPLACEMENT, /* of a body's material point [m], 3 columns                     */
  PROBE_VELOCITY,     /* of a body's point, or of the water at a place [m/s]           */
  PROBE_PRESSURE,     /* of the water, Shepard-normalised; on a body, obstacle or wall: mean over a patch [Pa] */
  PROBE_HEIGHT,       /* of the water above the floor: volume of a column over its area [m] */
  PROBE_FORCE,        /* of the fluid on a body, an obstacle or a wall [N]             */
  PROBE_SURFACE,      /* height of the free surface, without splashes [m]              */
  PROBE_FLOW_RATE,    /* of the water through a rectangle [m^3/s]                      */
  PROBE_POWER,        /* of the fluid on a wall or obstacle that moves [W]             */
  PROBE_MOMENT        /* of the fluid on a body or an obstacle about a place [N m]     */
} ProbeQuantity;

typedef struct {
  PetscReal end, output_every, fields_every, checkpoint_every; /* [s]                                */
  PetscInt  max_steps;                                         /* stop after this many steps; 0 = no */
  char      directory[PETSC_MAX_PATH_LEN];
} RunParams;

typedef struct {
  PetscReal min[3], max[3];
  Names     walls, periodic, slip, moving;
} DomainParams;

typedef struct {
  PetscReal gravity[3];
  Names     bodies, obstacles, probes;
} TopParams;

typedef enum { FILL_BOX, FILL_SPHERE, FILL_CYLINDER } FillShape;
typedef enum { FIELD_UNIFORM, FIELD_TAYLOR_GREEN, FIELD_ROTATION, FIELD_SHEAR, FIELD_STRAIN } FillField; /* sph/sph_field.h */

typedef struct {
  PetscReal min[3], max[3], velocity[3];
  char      surface[PETSC_MAX_PATH_LEN];
  PetscReal scale, translate[3];
  int       shape;                       /* FillShape                                                     */
  int       axis;                        /* 0..2: of a cylinder and of a field                            */
  PetscReal center[3], radius, length;   /* [m] of a sphere or cylinder; the centre is also the field's   */
  int       field;                       /* FillField                                                     */
  PetscReal amplitude, wavelength, rate; /* [m/s], [m], [1/s] of the field                                */
} FillParams;

typedef struct {
  char      surface[PETSC_MAX_PATH_LEN];
  PetscReal scale, translate[3];
  PetscBool slip;
} ObstacleParams;

typedef struct {
  Names        walls;
  PetscReal    translation[3];
  CourseParams course;
} WallMotionParams;

typedef struct {
  MotionParams motion;
} MotionSection;

typedef struct {
  int       scheme;         /* CouplerScheme                                                          */
  PetscReal response_beta;  /* stiffness in the interface response (M + beta dt^2 K)^-1 of `mass`     */
  PetscInt  response_every; /* steps between refreshes of the response's tangent                      */
  PetscInt  passes;         /* most pressure solves a step of `mass`                                  */
  int       relaxation;     /* RelaxationKind of `iterated`                                           */
  PetscReal relaxation_start; /* its first factor without a response                                  */
  PetscBool response;       /* `iterated`: walls answer within the pressure solve                     */
  PetscInt  reuse;          /* steps whose differences the quasi-Newton iteration keeps               */
  PetscReal tolerance;      /* relative change of the interface's velocity at which iterations end    */
  PetscInt  iterations;     /* most pressure solves a step of `iterated`                              */
  int       forces;         /* CouplerForces                                                          */
  PetscReal contact_coefficient; /* K_c of the paper: contact forces of bodies are scaled by it       */
} CouplerParams;

typedef struct {
  char      body[PETSC_MAX_PATH_LEN]; /* body, obstacle, or wall (xmin ... zmax); empty: the water */
  PetscReal at[3];
  PetscReal to[3];         /* end of a line, or the far corner of a rectangle, that begins at `at`     */
  Reals     samples;       /* n of a line, n x m of a rectangle; empty: a point                        */
  PetscReal min[3], max[3]; /* box of a patch, or rectangle of a flow rate                             */
  int       quantity;      /* ProbeQuantity                                                            */
  PetscBool mean;          /* over the time since the last row                                         */
} ProbeParams;

typedef enum { VERIFY_STATIC, VERIFY_DYNAMIC, VERIFY_BOTH, VERIFY_IMPLICIT, VERIFY_NONE } VerifyKind;

typedef struct {
  int       kind;              /* VerifyKind                                                              */
  PetscReal tolerance;         /* of the static difference over the largest displacement                  */
  PetscReal relax_tolerance;   /* relative residual at which the explicit solid counts as at rest         */
  PetscInt  relax_steps;       /* that it may take                                                        */
  PetscReal time;              /* static: time of loads and motions [s]                                   */
  PetscReal duration;          /* of dynamic runs [s]                                                     */
  Reals     steps;             /* explicit steps over the critical one, falling                           */
  PetscReal implicit_step;     /* the same of the implicit reference, which runs at half of it too        */
  PetscInt  samples;           /* times at which dynamic runs are compared                                */
  PetscReal dynamic_tolerance; /* of the finest explicit run's difference                                 */
  PetscReal order;             /* least observed order between the two finest steps; 0 = not judged       */
  PetscInt  modes;             /* natural frequencies to be compared; 0 = none                            */
  PetscReal modes_tolerance;   /* relative                                                                */
  PetscReal periods;           /* of the lowest mode that the solid rings                                 */
  PetscBool picture;
  char      directory[PETSC_MAX_PATH_LEN];
} VerifyParams;

BY_EXTERN const SceneSection CouplerSchema[];
BY_EXTERN const Key          RunKeys[], DomainKeys[], TopKeys[], FillKeys[], ObstacleKeys[], WallMotionKeys[], MotionKeys[], CouplerKeys[], ProbeKeys[], VerifyKeys[];

/* the program's commands: run a scene into its directory (resume: directory of an earlier run, or NULL), or print the plan */
BY_EXTERN PetscErrorCode CouplerRun(Scene scene, const char resume[]);
BY_EXTERN PetscErrorCode CouplerCheck(Scene scene);
/* explicit against implicit, every body; directory: of the results, PETSC_MAX_PATH_LEN characters; picture: whether one is asked for */
BY_EXTERN PetscErrorCode CouplerVerify(Scene scene, char directory[], PetscBool *picture);

/* life: Create -> (AddBody, AddObstacle, SetFluid | SetFromOptions, which builds all of a scene from the options) -> SetUp -> Step -> Destroy.
   The coupler takes ownership of the objects handed in. */
BY_EXTERN PetscErrorCode CouplerCreate(MPI_Comm comm, Coupler *coupler);
BY_EXTERN PetscErrorCode CouplerGetParams(Coupler coupler, CouplerParams **params);
BY_EXTERN PetscErrorCode CouplerSetFluid(Coupler coupler, SPH sph);
BY_EXTERN PetscErrorCode CouplerAddBody(Coupler coupler, const char name[], TLED tled, Proxy proxy); /* proxy NULL: dry body */
BY_EXTERN PetscErrorCode CouplerAddObstacle(Coupler coupler, const char name[], Proxy proxy, PetscInt n_nodes, const PetscReal x[],
                                            PetscInt n_triangles, const PetscInt triangles[]);
BY_EXTERN PetscErrorCode CouplerSetObstacleMotion(Coupler coupler, PetscInt obstacle, const Motion *motion); /* taken over */
BY_EXTERN PetscErrorCode CouplerSetFromOptions(Coupler coupler);
BY_EXTERN PetscErrorCode CouplerSetUp(Coupler coupler);
BY_EXTERN PetscErrorCode CouplerStep(Coupler coupler, PetscReal dt_max, PetscReal *dt);
BY_EXTERN PetscErrorCode CouplerView(Coupler coupler, PetscViewer viewer);
BY_EXTERN PetscErrorCode CouplerDestroy(Coupler *coupler);
BY_EXTERN PetscErrorCode CouplerGetSPH(Coupler coupler, SPH *sph);                            /* NULL: no fluid */
BY_EXTERN PetscErrorCode CouplerGetBody(Coupler coupler, PetscInt k, TLED *tled, Proxy *proxy);
BY_EXTERN PetscErrorCode CouplerGetTime(Coupler coupler, PetscReal *time, PetscInt *step);
/* force of the fluid on body (or, counting on, obstacle) k during the last step [N] */
BY_EXTERN PetscErrorCode CouplerGetForce(Coupler coupler, PetscInt k, PetscReal force[3]);
/* name of the scheme that body k runs with; after CouplerSetUp() */
BY_EXTERN PetscErrorCode CouplerGetScheme(Coupler coupler, PetscInt k, const char *name[]);
BY_EXTERN PetscErrorCode CouplerGetBreakdown(Coupler coupler, const char **message);

/* A row of the ledger (method 5.4). */
typedef struct {
  PetscReal time, dt;
  PetscInt  step, iterations, proxies, penetrations, substeps;
  PetscReal fluid_kinetic, fluid_potential, fluid_viscous_loss;
  PetscReal solid_kinetic, solid_strain, solid_potential, solid_damping_loss;
  PetscReal work_fluid, work_solid;            /* at the interface since the start, as each side sees it [J] */
  PetscReal energy;                            /* of fluid and bodies, contact included [J]                  */
  PetscReal energy_error;                      /* what it has gained since the start beyond works and losses that are booked [J] */
  PetscReal work_exchanged;                    /* sum over bodies and steps of the fluid's absolute work at the interface [J] */
  PetscInt  solves;                            /* pressure solves of the last step                           */
  PetscReal interface_residual;                /* velocity of body less what the fluid has seen of it, rms over its rms; last step */
  PetscReal momentum[3], angular[3];           /* of fluid and bodies                                        */
  PetscReal compression_mean, compression_max; /* of the fluid                                               */
  PetscReal speed_max, speed_rms;              /* of the fluid                                               */
  PetscInt  fluid_particles;                   /* buffers of openings included                               */
  PetscReal fluid_entered, fluid_left;         /* through openings since the start [m^3]                     */
  PetscReal solid_volume;
  PetscReal work_motion;                       /* on the fluid since the start, by walls, obstacles and a tank that move [J] */
  PetscReal solid_contact_energy, solid_external_work; /* stored in contact; done by fluid, loads and supports since the start */
} CouplerLedger;
BY_EXTERN PetscErrorCode CouplerGetLedger(Coupler coupler, CouplerLedger *ledger);

#endif
