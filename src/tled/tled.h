/* tled.h - the nonlinear elastic solid: total Lagrangian explicit dynamics on tetrahedra. */
#ifndef BY_TLED_H
#define BY_TLED_H

#include "course.h"
#include "keys.h"
#include "surface.h"
#include <petscmat.h>

typedef struct _p_TLED *TLED;

typedef enum {
  TLED_MATERIAL_NEO_HOOKEAN,
  TLED_MATERIAL_ST_VENANT_KIRCHHOFF,
  TLED_MATERIAL_NEO_HOOKEAN_ISO,
  TLED_MATERIAL_MOONEY_RIVLIN,
  TLED_MATERIAL_TRANSVERSELY_ISOTROPIC
} TLEDMaterial;
typedef enum { TLED_ELEMENT_AUTO, TLED_ELEMENT_T4, TLED_ELEMENT_ANP, TLED_ELEMENT_T10 } TLEDElement;
typedef enum { TLED_QUADRATURE_4, TLED_QUADRATURE_14 } TLEDQuadrature;

/* An elastic material; TLEDMaterialKeys[] (tled_keys.c) declares each member. The body's own one is TLEDParams.elastic. */
typedef struct {
  Names     volumes;                       /* physical volumes made of it; not for the body's own, which has the rest    */
  int       material;                      /* TLEDMaterial                                                               */
  PetscReal density;                       /* rho [kg/m^3]                                                               */
  PetscReal young, poisson;                /* E [Pa], nu [1] at small strain                                             */
  PetscReal bulk;                          /* kappa [Pa] of the laws that split volume from shape; 0 = from poisson      */
  PetscReal c10, c01;                      /* of Mooney and Rivlin [Pa], in place of young                               */
  PetscReal fibre_stiffness;               /* eta [Pa] of a transversely isotropic material                              */
  PetscReal fibre[3];                      /* direction of its fibres, of any length                                     */
  char      fibre_field[PETSC_MAX_PATH_LEN]; /* or the view on the mesh's elements that has their directions             */
  Reals     prony_alpha, prony_tau;        /* part of the isochoric stress that relaxes [1], in which time [s]           */
} TLEDMaterialParams;

/* Parameters of a body's section `<body>:`; TLEDKeys[] (tled_keys.c) declares each. */
typedef struct {
  char      mesh[PETSC_MAX_PATH_LEN]; /* gmsh .msh with named physical groups; required                     */
  TLEDMaterialParams elastic;         /* of all elements that no other material has                          */
  Names     materials;                /* names of further materials, see TLEDAddMaterial()                   */
  PetscReal damping;                  /* alpha [1/s] of D = alpha M                                          */
  PetscReal stiffness_damping;        /* beta [s] of a stiffness-proportional viscous stress; 0 = none       */
  PetscReal safety;                   /* of the critical step                                                */
  PetscReal step;                     /* substep [s]; 0 = from the critical step                              */
  PetscReal step_limit;               /* [s]; the run ends when the critical step falls below it              */
  PetscReal mass_scaling;             /* critical step that short elements get mass to reach [s]; 0 = none    */
  PetscReal scale;                    /* mesh coordinates times this                                         */
  PetscReal translate[3];             /* [m], after scaling                                                  */
  PetscReal velocity[3];              /* initial velocity [m/s]                                              */
  PetscReal prescribed_velocity[3];   /* of the groups in `prescribed` [m/s]                                 */
  Names     fixed;                    /* physical groups held                                                */
  Names     prescribed;               /* physical groups moved                                               */
  Names     constraints;              /* supports, a section each (TLEDConstraintParams)                     */
  Names     loads;                    /* a section each (TLEDLoadParams)                                     */
  Names     contact;                  /* walls and obstacles that it cannot pass; the coupler adds them      */
  PetscReal contact_stiffness;        /* k [Pa/m] of tled_contact.h; 0 = from Young's modulus                */
  Names     wetted;                   /* surface groups in contact with fluid; empty = whole boundary        */
  int       element;   /* TLEDElement; auto = t10 on a second-order mesh, else anp above nu 0.4, else t4 */
  int       quadrature; /* TLEDQuadrature: integration points of t10                                  */
} TLEDParams;

typedef enum { TLED_CONSTRAINT_FIXED, TLED_CONSTRAINT_SYMMETRY, TLED_CONSTRAINT_MOTION } TLEDConstraintKind;

/* A support: the section `<body>.<name>` for each name in the body's key `constraints`. */
typedef struct {
  int          kind;           /* TLEDConstraintKind                                                 */
  Names        groups;         /* physical groups                                                    */
  Names        components;     /* x, y, z; none: all                                                 */
  PetscReal    translation[3]; /* [m], times the course                                              */
  PetscReal    angle;          /* [deg], times the course                                            */
  PetscReal    axis[3];        /* of the rotation, any length                                        */
  PetscReal    point[3];       /* of the axis [m]                                                    */
  CourseParams course;
} TLEDConstraintParams;

/* A load: the section `<body>.<name>` for each name in the body's key `loads`; several kinds may be given. */
typedef struct {
  Names        groups;        /* physical groups; none: a force at a place                          */
  PetscReal    pressure;      /* [Pa] on the current surface, times the course                      */
  PetscReal    traction[3];   /* [Pa] per reference area                                            */
  PetscReal    body_force[3]; /* [N/m^3] per reference volume                                       */
  PetscReal    force[3];      /* [N] in all                                                         */
  Reals        at;            /* place [m] whose nearest node takes the force                       */
  CourseParams course;
} TLEDLoadParams;

BY_EXTERN const Key TLEDKeys[], TLEDMaterialKeys[], TLEDConstraintKeys[], TLEDLoadKeys[];

/* life: Create -> GetParams/SetFromOptions (options prefix "<body>_") -> SetGravity -> SetUp -> Advance -> Destroy.
   SetUp reads the mesh; user errors (missing mesh, no such group, not tetrahedra, inverted element) are
   printed as design.md says, and BY_ERR_INPUT is returned. */
BY_EXTERN PetscErrorCode TLEDCreate(MPI_Comm comm, const char name[], TLED *tled);
BY_EXTERN PetscErrorCode TLEDGetParams(TLED tled, TLEDParams **params);
BY_EXTERN PetscErrorCode TLEDSetFromOptions(TLED tled);
/* one more material, for the physical volumes that it names; before TLEDSetUp(). SetFromOptions does it for each name in `materials`,
   with the options -<body>_<name>_<key>. */
BY_EXTERN PetscErrorCode TLEDAddMaterial(TLED tled, const char name[], const TLEDMaterialParams *params);
/* a support, before SetUp, beside those that SetFromOptions finds */
BY_EXTERN PetscErrorCode TLEDAddConstraint(TLED tled, const char name[], const TLEDConstraintParams *params);
/* a load, the same way */
BY_EXTERN PetscErrorCode TLEDAddLoad(TLED tled, const char name[], const TLEDLoadParams *params);
/* contact with a plane (the body is on the side of the normal) and with a closed surface at rest, before SetUp; frictionless */
BY_EXTERN PetscErrorCode TLEDAddContactPlane(TLED tled, const char name[], const PetscReal point[3], const PetscReal normal[3]);
BY_EXTERN PetscErrorCode TLEDAddContactSurface(TLED tled, const char name[], const Surface *surface);
BY_EXTERN PetscErrorCode TLEDSetGravity(TLED tled, const PetscReal g[3]);
BY_EXTERN PetscErrorCode TLEDSetUp(TLED tled);
BY_EXTERN PetscErrorCode TLEDView(TLED tled, PetscViewer viewer);
BY_EXTERN PetscErrorCode TLEDDestroy(TLED *tled);

BY_EXTERN PetscErrorCode TLEDGetSize(TLED tled, PetscInt *n_nodes, PetscInt *n_tets);
/* tetrahedra n_tets x n_corners and reference coordinates n_nodes x 3, borrowed; n_corners is 4, or 10 for a mesh of second order: 4
   vertices, then the nodes of the edges 01, 12, 02, 03, 13, 23 (VTK's order) */
BY_EXTERN PetscErrorCode TLEDGetMesh(TLED tled, PetscInt *n_corners, const PetscInt *tets[], const PetscReal *X[]);
/* boundary triangles, n x 3 node numbers, outward by the right-hand rule, four for each quadratic face; wetted_only picks the groups of `wetted` */
BY_EXTERN PetscErrorCode TLEDGetSurface(TLED tled, PetscBool wetted_only, PetscInt *n_triangles, const PetscInt *triangles[]);
/* nodes of a physical group; unknown group: n = 0 */
BY_EXTERN PetscErrorCode TLEDGetGroup(TLED tled, const char name[], PetscInt *n, const PetscInt *nodes[]);
/* name of the element that `auto` stands for in this body: t4, anp, t10; after SetUp */
BY_EXTERN PetscErrorCode TLEDGetElementName(TLED tled, const char *name[]);
BY_EXTERN PetscErrorCode TLEDGetMass(TLED tled, const PetscReal *mass[]); /* lumped, n_nodes [kg] */
/* mass that mass scaling added: [kg], and per cent of the mass before; either may be NULL */
BY_EXTERN PetscErrorCode TLEDGetAddedMass(TLED tled, PetscReal *mass, PetscReal *percent);
BY_EXTERN PetscErrorCode TLEDIsFree(TLED tled, PetscBool *free);          /* nothing but f and gravity acts: no support, load, contact */
/* n_nodes: which nodes are not entirely free: held in some direction, or moved */
BY_EXTERN PetscErrorCode TLEDIsConstrained(TLED tled, const PetscBool *constrained[]);
/* projector of a node onto its free directions, 3 x 3 row-major, borrowed; NULL when it is entirely free */
BY_EXTERN PetscErrorCode TLEDGetProjector(TLED tled, PetscInt node, const PetscReal **P);
/* force [N] and moment about the origin [N m] (may be NULL) that the supports give to the nodes of a group in the current state */
BY_EXTERN PetscErrorCode TLEDGetReaction(TLED tled, const char group[], PetscReal force[3], PetscReal moment[3]);

/* state: displacement u, velocity v (at the same time level, see TLEDAdvance), external force f: PETSc Vecs of block size 3,
   owned by the TLED; change them between Advance calls only */
BY_EXTERN PetscErrorCode TLEDGetVectors(TLED tled, Vec *u, Vec *v, Vec *f);
/* current coordinates X + u and velocities as borrowed arrays, n_nodes x 3 */
BY_EXTERN PetscErrorCode TLEDGetPositions(TLED tled, const PetscReal *x[], const PetscReal *v[]);

/* critical step 2/omega_max of the current state by power iteration [s], without the safety factor */
BY_EXTERN PetscErrorCode TLEDGetCriticalStep(TLED tled, PetscReal *dt);
/* Advance by exactly `dt` in the fewest equal substeps <= safety * critical step, external force f held, central differences in
   velocity form (half kick, drift, half kick: u and v at the same time); n_substeps is what was taken. An inverted element or a NaN
   returns BY_ERR_BREAKDOWN, TLEDGetBreakdown tells element, position and time. The critical step is renewed as the body deforms. */
BY_EXTERN PetscErrorCode TLEDGetSubsteps(TLED tled, PetscReal dt, PetscInt *n_substeps);
BY_EXTERN PetscErrorCode TLEDAdvance(TLED tled, PetscReal dt, PetscInt *n_substeps);
/* From the state at its time to rest under the loads and supports of time `time`, by dynamic relaxation: the same internal forces as
   Advance in fictitious time. u is then the static solution, v = 0, the TLED's time is `time`. Ended when the residual over the
   forces and the estimated error of u over the largest u are below `tolerance` (1e-7 gives six digits); steps and residual may be
   NULL. BY_ERR_BREAKDOWN when max_steps do not suffice or an element breaks; TLEDGetBreakdown() says why. */
BY_EXTERN PetscErrorCode TLEDRelax(TLED tled, PetscReal time, PetscReal tolerance, PetscInt max_steps, PetscInt *steps,
                                   PetscReal *residual);
BY_EXTERN PetscErrorCode TLEDGetBreakdown(TLED tled, const char **message);
/* snapshot of u, v, time, energies and back (one level; the staggered loop runs a step twice) */
BY_EXTERN PetscErrorCode TLEDSave(TLED tled);
BY_EXTERN PetscErrorCode TLEDRestore(TLED tled);
/* sum over the substeps of the last Advance of dt_s sum_a x_a x f_a [N m s], the moment that the held forces f really gave (3 numbers,
   borrowed; zero for a body that is held): the coupler keeps angular momentum with it */
BY_EXTERN PetscErrorCode TLEDGetAngularImpulse(TLED tled, const PetscReal *impulse[]);
/* what Advance carries on besides u and v (time, works, critical step, its mode) as n numbers, for a checkpoint: with u, v and f set to
   what they were and then SetState, a run goes on with the same bits. GetState(tled, &n, NULL) asks for n. */
BY_EXTERN PetscErrorCode TLEDGetState(TLED tled, PetscInt *n, PetscReal state[]);
BY_EXTERN PetscErrorCode TLEDSetState(TLED tled, PetscInt n, const PetscReal state[]);
BY_EXTERN PetscErrorCode TLEDGetTime(TLED tled, PetscReal *time);
BY_EXTERN PetscErrorCode TLEDSetTime(TLED tled, PetscReal time);

/* internal force f(u) [N] at displacement u, and its tangent K(u) = df/du as an n x n AIJ matrix of block size 3 (created on first
   call when *K is NULL, rows of constrained nodes are kept: the caller treats them); TLEDResponse() is the same but for anp, where it is a
   cheaper response operator with few numbers a row */
BY_EXTERN PetscErrorCode TLEDInternalForce(TLED tled, Vec u, Vec f);
BY_EXTERN PetscErrorCode TLEDTangent(TLED tled, Vec u, Mat *K);
BY_EXTERN PetscErrorCode TLEDResponse(TLED tled, Vec u, Mat *K);

typedef struct {
  PetscReal kinetic, strain, gravity_potential; /* [J]                                      */
  PetscReal damping_loss, external_work;        /* [J] since the start; of f, loads and supports */
  PetscReal support_work;                       /* [J] the supports' part of external_work  */
  PetscReal contact_energy;                     /* [J] stored in contact                    */
  PetscReal momentum[3], angular[3];            /* about the origin                         */
  PetscReal volume, volume_reference;           /* [m^3]                                    */
  PetscReal speed_max;                          /* [m/s]                                    */
} TLEDStats;
BY_EXTERN PetscErrorCode TLEDGetStats(TLED tled, TLEDStats *stats);

#endif
