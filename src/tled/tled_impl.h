/* tled_impl.h - the inside of a TLED; only src/tled includes it. */
#ifndef BY_TLED_IMPL_H
#define BY_TLED_IMPL_H

#include "tled/tled.h"
#include "tled/tled_constraint.h"
#include "tled/tled_step.h"
#include "tled/tled_element.h"
#include "tled/tled_t10.h"
#include "surface.h"
#include <petsc/private/petscimpl.h>

#define TLED_LANES           8   /* elements that are worked on at once: one AVX-512 register of doubles          */
#define TLED_BLOCK_TETS      256 /* elements of a block at most: its gradients and nodes stay in a core's L1/L2 cache */
#define TLED_BLOCK_TETS_T10  96  /* the same of ten-node elements, which carry four times as much                  */
#define TLED_BLOCK_NODES     256 /* nodes of a block at most                                                       */
#define TLED_CHUNK           128 /* nodes whose contributions to a sum are added first, for any number of threads  */
#define TLED_THREAD_BLOCKS   12  /* blocks that make one more thread worth its barriers, also on a busy machine       */
#define TLED_THREAD_BLOCKS_T10 6 /* the same of ten-node elements                                                  */
#define TLED_MATERIALS       (BY_NAMES_MAX + 1) /* of a body at most: its own and the further ones                 */
#define TLED_CORNERS_MAX     10  /* nodes of an element at most                                                    */
#define TLED_GROUPS_MAX      62  /* named physical groups of a mesh: bits of a 64-bit number                       */
#define TLED_MESSAGE         512 /* characters of a breakdown message                                              */

/* gmsh's numbers of the kinds of elements that make a mesh */
enum { TLED_GMSH_TRIANGLE3 = 2, TLED_GMSH_TET4 = 4, TLED_GMSH_TRIANGLE6 = 9, TLED_GMSH_TET10 = 11 };

/* A named physical group of the mesh file. */
typedef struct {
  char      name[BY_NAME_MAX];
  PetscInt  dim;         /* 2 surface, 3 volume                                        */
  PetscInt  n_nodes;     /* nodes of the group, ascending                              */
  PetscInt *nodes;
  PetscInt  n_triangles; /* boundary triangles of a surface group, numbers of TLEDMesh.triangles */
  PetscInt *triangles;
  PetscInt  n_tets;      /* elements of a volume group, ascending                      */
  PetscInt *tets;
} TLEDGroup;

/* The mesh as read, then renumbered block by block. */
typedef struct {
  PetscInt   n_nodes, n_tets, n_faces, n_triangles, n_groups;
  PetscInt   n_corners; /* nodes of a tetrahedron: 4, or 10 in VTK's order  */
  PetscInt   n_face_nodes; /* 3, or 6: corners, then the nodes after each along the edges */
  PetscReal *X;         /* n_nodes x 3 [m]                                  */
  PetscInt  *tets;      /* n_tets x n_corners                               */
  PetscInt  *tag;       /* number of each tetrahedron in the gmsh file      */
  PetscInt  *material;  /* n_tets: number of the law in TLEDLoops.laws      */
  PetscInt  *faces;     /* boundary, n_faces x n_face_nodes, outward        */
  PetscInt  *triangles; /* these as n_triangles x 3: the face, or four for a quadratic one */
  TLEDGroup *groups;
} TLEDMesh;

/* What a gmsh file holds. */
typedef struct {
  PetscInt     n_groups; /* named physical groups                             */
  char         name[TLED_GROUPS_MAX][BY_NAME_MAX];
  PetscInt     dim[TLED_GROUPS_MAX], number[TLED_GROUPS_MAX];
  PetscInt     n_nodes, n_elements;
  PetscReal   *X;        /* n_nodes x 3, in the file's order                  */
  signed char *type;     /* n_elements: gmsh's number of the kind             */
  PetscInt    *tag;      /* n_elements: number in the file                    */
  PetscInt    *first;    /* n_elements + 1, into corner                       */
  PetscInt    *corner;   /* nodes of the elements, places in X                */
  PetscInt64  *groups;   /* n_elements: bit g: it belongs to named group g    */
} TLEDGmshFile;

/* Elements in blocks, a block's elements in packs of TLED_LANES as structures of arrays; the elements of a block are of one material. Each block adds up the forces on its own nodes
   in a fixed order; each node then adds its blocks in a fixed order: the same bits for any number of threads, no atomics. */
typedef struct {
  int     n_blocks, n_packs, n_slots, n_nodes;
  int     n_corners;   /* nodes of an element: 4 or 10                                           */
  int     n_points;    /* integration points of an element                                       */
  int    *pack_offset; /* n_blocks + 1                                                           */
  int    *node_offset; /* n_blocks + 1, into `node`; also the block's slots of a partial sum     */
  int    *node;        /* n_slots: node of each slot                                             */
  int    *material;    /* n_packs: number of the law                                             */
  int    *local;       /* n_packs x n_corners x TLED_LANES: the corners as numbers within the block      */
  int    *element;     /* n_packs x TLED_LANES: number of the element, -1 for padding            */
  double *G;           /* n_packs x 9 x TLED_LANES [1/m], 0 for padding; of ten nodes first_point[n_packs] x 9 x TLED_LANES: Jinv */
  int    *first_point; /* n_packs + 1, ten nodes: how many are stored before a pack, 1 for straight elements, else n_points */
  double *V0;          /* n_packs x n_points x TLED_LANES: volume of a point [m^3], 0 for padding */
  double *fibre;       /* n_packs x 3 x TLED_LANES: unit vector along the fibres, 0 for none     */
  int    *slot_offset; /* n_nodes + 1                                                            */
  int    *slot;        /* n_slots: the slots of each node                                        */
  int    *slot_material; /* n_slots: number of the law of the slot's block                       */
} TLEDBlocks;

typedef struct _TLEDElementOps TLEDElementOps;

/* what forces, energies and stiffnesses mean in materials with a Prony series, see TLEDSetViscous_Private() */
typedef enum { TLED_VISCOUS_INSTANT, TLED_VISCOUS_STEP, TLED_VISCOUS_COMMIT } TLEDViscousMode;

/* What the element loops need; raw pointers only, so that they run inside a parallel region. */
typedef struct {
  const TLEDBlocks     *blocks;
  const TLEDElementOps *ops;     /* the element                                                    */
  const TLEDLaw        *laws;    /* of each material; the first is the body's own                  */
  int               n_laws;
  int               anp;         /* 1 = average nodal pressure: ops->averaged                      */
  int               viscous;        /* 1: some material has a Prony series; all below are NULL without */
  int               viscous_mode;   /* TLEDViscousMode                                              */
  TLEDPronyStep    *prony;          /* n_laws: of the step of the mode                              */
  double           *history;        /* what has been, of all packs with such a material [Pa]        */
  size_t           *history_offset; /* n_packs                                                      */
  double           *partial;     /* n_slots x 3: forces of a block on its nodes [N]                */
  double           *nodal;       /* n_nodes x n_laws: J_a - 1 of the elements of each material (anp) */
  double           *pressure;    /* n_nodes x n_laws: q_a [Pa] (anp)                               */
  double           *weight;      /* n_nodes x n_laws: 1/sum_e V0_e [1/m^3], 0 for none (anp)       */
  int              *status;      /* n_blocks: 1 where an element has det F <= 0 or NaN             */
} TLEDLoops;

/* place of a node's average over the elements of a material around it, in nodal, pressure and weight: materials do not share volume
   changes, whose pressures differ by the ratio of their stiffnesses */
static inline PetscInt TLEDAverageOf(const TLEDLoops *loops, PetscInt node, int material) { return loops->n_laws * node + material; }

/* An element: what the loops over the body ask of it. One for each kind, in tled_element.c; the loops of a backend fill `forces`. */
struct _TLEDElementOps {
  const char *name;      /* as in the key `element`                                                   */
  int         n_corners; /* nodes: 4 or 10                                                            */
  int         averaged;  /* 1: its laws see the averaged gradient, loops->nodal holds the J_a - 1     */
  /* forces at displacement u into the blocks' partial sums, and the blocks' status; called by all threads of a parallel region */
  void (*forces)(const TLEDLoops *loops, const double u[]);
  /* reference gradients dN_a/dX [1/m] (n_corners x 3) and volume [m^3] of one integration point of the element in a lane */
  void (*point)(const TLEDBlocks *blocks, int lane, int point, double G[], double *V0);
};

/* One integration point of an element in the deformed body, for loops that are not part of a step. */
typedef struct {
  TLEDLocalLaw   law;
  double         G[30];   /* dN_a/dX [1/m], n_corners x 3                        */
  double         V0;      /* [m^3]                                               */
  double         H[9];    /* displacement gradient                               */
  double         jm1;     /* det F - 1                                           */
  double         seen[9]; /* what the law sees: H, or Hbar of the averaged one   */
} TLEDPoint;

/* A support of the scene. */
typedef struct {
  char                 key[2 * BY_NAME_MAX + 2]; /* section, "block.plate"; key, "block.fixed", for a shorthand */
  PetscBool            shorthand;
  TLEDConstraintParams params;
  Course               course;  /* of a motion                   */
  double               axis[3]; /* unit vector, or zero          */
} TLEDConstraint;

/* All supports, combined node by node. */
typedef struct {
  PetscInt        n;
  TLEDConstraint *item;
  RigidMotion     *now, *next; /* n: of the moving ones, at the end of a substep and of the one after */
  PetscInt        n_held;
  int            *held_of;    /* n_nodes: place in `held`, -1 for a free node                        */
  TLEDHeld       *held;       /* n_held                                                              */
  PetscInt       *node;       /* n_held                                                              */
  PetscBool       moves;      /* some node is moved                                                  */
} TLEDConstraints;

/* A load of the scene. */
typedef struct {
  char           key[2 * BY_NAME_MAX + 2]; /* section, "block.push" */
  TLEDLoadParams params;
  Course         course;
} TLEDLoad;

/* All loads, sorted by nodes. */
typedef struct {
  PetscInt  n;
  TLEDLoad *item;
  double   *scale;       /* n: courses at the time last asked for                               */
  int      *dead_offset; /* n_nodes + 1, into dead_load and dead: forces that do not follow     */
  int      *dead_load;
  double   *dead;        /* x 3 [N], where the course is 1                                      */
  int       n_faces;     /* under pressure; a face may come more than once                      */
  int      *face, *face_load; /* n_faces: number in the mesh; load                              */
  double   *face_force;  /* n_faces x n_face_nodes x 3 [N]                                      */
  int      *slot_offset; /* n_nodes + 1, into slot                                              */
  int      *slot;        /* places of the node in face_force, in threes                         */
} TLEDLoads;

/* What the body's surface cannot pass: a plane, or a closed surface at rest. */
typedef struct {
  char         name[BY_NAME_MAX];
  double       normal[3], offset; /* of a plane: n . x >= offset [m]                                        */
  Surface      surface;           /* of a surface                                                           */
  SurfaceIndex index;             /* NULL for a plane                                                       */
  double      *last;              /* n_nodes x 4: where a node was when its distance was last found, and that */
} TLEDObstacle;

typedef struct {
  PetscInt      n;
  TLEDObstacle *item;
  double       *area;      /* n_nodes: of the undeformed surface [m^2]                             */
  double        reach;     /* mean edge of the surface's triangles [m]                             */
  double        soft;      /* depth over which the pressure sets in [m]                            */
  double        stiffness; /* [Pa/m]                                                               */
  double        crowding;  /* largest eigenvalue of the sum of n n^T of surfaces touched together  */
  double        rate;      /* largest stiffness over mass of a node [1/s^2], known with state.critical */
} TLEDContact;

/* State that Advance changes; u and v apart (they are Vecs). */
typedef struct {
  PetscReal time;          /* [s]                                                                   */
  PetscReal damping_loss;  /* by mass-proportional damping [J]                                      */
  PetscReal external_work; /* by f and the loads [J]                                                              */
  PetscReal support_work;  /* by the supports [J]                                                   */
  PetscReal internal_work; /* by the internal forces including stiffness damping [J]; only with it  */
  PetscReal moment[3];     /* of the external forces in the last Advance, about the origin [N m s]; free bodies only */
  PetscReal critical;      /* critical step [s]; 0 = not known                                      */
  PetscReal stretch[2];    /* smallest det F and largest |F|^2 when it was computed                 */
  PetscReal since, look;   /* substeps taken since; how many when the deformation is looked at next  */
  PetscReal put_in;        /* energy that the body had when the watch on it began [J]; 0 = not watched (tled_breakdown.c) */
  PetscReal given, owned;  /* works of loads, supports and gravity then, and what it had over them [J] */
  PetscReal is_static;     /* 1: u is a static solution, in which supports give no inertia (Advance: 0) */
} TLEDState;

struct _p_TLED {
  PETSCHEADER(int);
  TLEDParams   params;
  PetscReal    gravity[3];     /* [m/s^2]                                                     */
  PetscBool    set_up;
  TLEDMesh     mesh;
  PetscInt     n_wetted;       /* triangles of the wetted groups                              */
  PetscInt    *wetted;         /* n_wetted x 3                                                */
  PetscReal   *mass;           /* lumped, n_nodes [kg]                                        */
  PetscReal    mass_total;     /* without what mass scaling added [kg]                        */
  PetscReal    mass_added;     /* by mass scaling, which is in `mass` [kg]                    */
  PetscInt     n_scaled;       /* elements to which it was added                              */
  PetscReal    volume;         /* reference [m^3]                                             */
  PetscBool   *constrained;    /* n_nodes                                                     */
  signed char *motion;         /* n_nodes: TLED_FREE, TLED_FIXED at rest, TLED_HELD any other */
  TLEDConstraints constraints;
  TLEDLoads    loads;
  TLEDContact  contact;
  PetscBool    is_free;
  TLEDBlocks   blocks;
  TLEDLoops    loops;
  PetscInt     n_materials;                    /* the body's own and the further ones         */
  TLEDMaterialParams materials[TLED_MATERIALS]; /* the first is params.elastic, from SetUp on  */
  char         material_name[TLED_MATERIALS][BY_NAME_MAX];
  TLEDLaw      laws[TLED_MATERIALS];
  PetscInt     n_history;      /* numbers in loops.history                                    */
  PetscReal   *saved_history;
  Vec          u, v, f;
  PetscReal   *x;              /* X + u, n_nodes x 3, of TLEDGetPositions()                   */
  PetscReal   *force;          /* f_int of the last substep, n_nodes x 3 [N]                  */
  PetscReal   *probe;          /* work: displacement at which forces are asked, n_nodes x 3   */
  PetscReal   *mode;           /* highest mode, of unit mass norm, n_nodes x 3                */
  PetscReal   *krylov;         /* work of the critical step, 5 x (n_nodes x 3)                */
  PetscReal   *trial;          /* work: forces, n_nodes x 3                                   */
  PetscReal   *sums;           /* work: n_chunks x TLED_SUMS                                  */
  PetscObjectState force_state; /* state of u for which `force` is right, with force_valid    */
  PetscBool    force_valid;
  PetscObjectState speed_state; /* state of v that the last substep left                      */
  TLEDState    state, saved_state;
  PetscReal   *saved;          /* u, v, force, mode: 4 x (n_nodes x 3)                        */
  PetscBool    saved_valid, saved_force_valid;
  PetscInt     substeps, saved_substeps; /* taken since the start                             */
  struct TLEDAssembly *assembly; /* of the public tangents, tled_assembly.h; NULL before the first */
  char         breakdown[TLED_MESSAGE];
};

extern PetscLogEvent TLED_EVENT_ADVANCE, TLED_EVENT_TANGENT, TLED_EVENT_CRITICAL;

/* tled_gmsh.c */
PetscErrorCode TLEDGmshRead_Private(const char key[], const char path[], TLEDGmshFile *file);
PetscErrorCode TLEDGmshDestroy_Private(TLEDGmshFile *file);
/* tled_mesh.c */
PetscErrorCode TLEDMeshRead_Private(const char key[], const TLEDParams *params, TLEDMesh *mesh);
PetscErrorCode TLEDMeshDestroy_Private(TLEDMesh *mesh);
PetscErrorCode TLEDMeshFindGroup_Private(const TLEDMesh *mesh, const char name[], const TLEDGroup **group);
PetscErrorCode TLEDMeshNeedGroup_Private(const TLEDMesh *mesh, const char path[], const char key[], const char name[], PetscInt dim,
                                         const TLEDGroup **group);
/* tled_materials.c: laws of the materials, and mesh->material */
PetscErrorCode TLEDMaterialsSetUp_Private(TLED tled);
PetscErrorCode TLEDFibresSetUp_Private(TLED tled); /* blocks.fibre */
/* tled_field.c */
PetscErrorCode TLEDFieldRead_Private(const char key[], const char path[], const char name[], const TLEDMesh *mesh, PetscReal value[]);
/* tled_viscous.c: materials with a Prony series */
PetscErrorCode TLEDViscousSetUp_Private(TLED tled);
PetscErrorCode TLEDViscousDestroy_Private(TLED tled);
void           TLEDSetViscous_Private(TLED tled, TLEDViscousMode mode, PetscReal dt);
PetscErrorCode TLEDCommitViscous_Private(TLED tled, const PetscReal u[], PetscReal dt);
void           TLEDLocalLawAt_Private(const TLEDLoops *loops, int lane, int point, TLEDLocalLaw *law);
double         TLEDLocalEnergy_Private(const TLEDLoops *loops, int lane, int point, const TLEDLocalLaw *law, const double H[9]);
void           TLEDViscousStress_OpenMP(const TLEDLoops *loops, int pack, int point, int commit, double H[9][TLED_LANES],
                                        double P[9][TLED_LANES]);
/* tled_element.c */
extern const TLEDElementOps TLEDElementT4, TLEDElementANP, TLEDElementT10;
PetscErrorCode TLEDElementPick_Private(TLED tled); /* loops->ops from the key `element` */
void TLEDKnowVolumes_Private(const TLEDLoops *loops, const PetscReal u[]);
void           TLEDPointAt_Private(const TLEDLoops *loops, const PetscInt tets[], int lane, int point, const double u[], TLEDPoint *p);
/* number of the stored Jacobian of a point of a pack of ten-node elements */
static inline int TLEDJacobianPlace(const TLEDBlocks *b, int pack, int point)
{
  return TLEDJacobianNumber(b->first_point, pack, point);
}
/* tled_blocks.c */
PetscErrorCode TLEDBlocksCreate_Private(TLEDMesh *mesh, int n_points, TLEDBlocks *blocks);
PetscErrorCode TLEDBlocksDestroy_Private(TLEDBlocks *blocks);
/* tled_openmp.c: called by all threads of a parallel region, or outside one */
int  TLEDThreads_OpenMP(const TLEDLoops *loops); /* threads that are worth while */
void TLEDElementForces_OpenMP(const TLEDLoops *loops, const double u[]);
void TLEDGatherForces_OpenMP(const TLEDLoops *loops, double f[]);
void TLEDForcesT4_OpenMP(const TLEDLoops *loops, const double u[]);
void TLEDForcesANP_OpenMP(const TLEDLoops *loops, const double u[]);
void TLEDNodalVolumes_OpenMP(const TLEDLoops *loops, const double u[]); /* fills loops->nodal (anp) */
int  TLEDElementsBroken_OpenMP(const TLEDLoops *loops);
/* tled_openmp_t10.c */
void TLEDForcesT10_OpenMP(const TLEDLoops *loops, const double u[]);
/* tled_energy.c */
PetscErrorCode TLEDStrain_Private(TLED tled, const PetscReal u[], PetscReal *energy, PetscReal *volume, PetscReal stretch[2]);
/* tled_breakdown.c */
PetscErrorCode TLEDReportBroken_Private(TLED tled, const PetscReal u[], PetscReal time);
PetscErrorCode TLEDWatch_Private(TLED tled, const PetscReal u[], const PetscReal v[], PetscReal time);
PetscBool      TLEDIsUnstable_Private(TLED tled, PetscReal dt);
PetscErrorCode TLEDReportUnstable_Private(TLED tled, const PetscReal u[], PetscReal time, PetscReal dt);
/* tled_assembly.c */
PetscErrorCode TLEDAssemblyDestroy_Private(struct TLEDAssembly **assembly);
/* tled_mass.c */
PetscErrorCode TLEDLumpMass_Private(TLED tled);
PetscErrorCode TLEDScaleMass_Private(TLED tled);
PetscReal      TLEDModeEnergy_Private(TLED tled, int lane, const PetscReal u[]); /* elastic, of an element in the highest mode */
void           TLEDStiffnessAt_Private(TLED tled, int lane, const PetscReal u[], double K[]);
/* tled_critical.c */
PetscErrorCode TLEDHighestMode_Private(TLED tled, const PetscReal mass[], const PetscReal u[], PetscInt n_steps, PetscReal mode[],
                                       PetscReal *top);
PetscErrorCode TLEDCriticalStep_Private(TLED tled, const PetscReal u[], PetscInt n_steps, PetscReal *dt);
/* tled_constraint.c */
PetscErrorCode TLEDConstraintsFromOptions_Private(TLED tled);
PetscErrorCode TLEDConstraintsSetUp_Private(TLED tled);
PetscErrorCode TLEDConstraintsDestroy_Private(TLEDConstraints *constraints);
void           TLEDMotionsAt_Private(const TLEDConstraints *constraints, PetscReal t, RigidMotion motions[]);
PetscErrorCode TLEDProject_Private(TLED tled, PetscReal x[]); /* x <- P x, n_nodes x 3 */
/* held parts of displacement, velocity, acceleration at time t, n_nodes x 3, zero elsewhere; each may be NULL */
PetscErrorCode TLEDPrescribed_Private(TLED tled, PetscReal t, PetscReal u[], PetscReal v[], PetscReal a[]);
const double  *TLEDConstraintProjector_Private(TLED tled, PetscInt node); /* 3 x 3; NULL: all directions are free */
/* tled_load.c */
/* f = f (the Vec) + m g + loads + contact at time t and displacement u, n_nodes x 3, not projected */
PetscErrorCode TLEDLoadsFromOptions_Private(TLED tled);
PetscErrorCode TLEDLoadsSetUp_Private(TLED tled);
PetscErrorCode TLEDLoadsDestroy_Private(TLEDLoads *loads);
void           TLEDLoadsAt_Private(TLEDLoads *loads, PetscReal t);
void           TLEDFaceForces_OpenMP(const TLEDLoads *loads, const TLEDMesh *mesh, const double u[]);
void           TLEDAddLoads_Private(const TLEDLoads *loads, int a, double f[3]);
PetscErrorCode TLEDExternalForces_Private(TLED tled, PetscReal t, const PetscReal u[], PetscReal f[]);
/* add(ctx, a, b, K): the 3 x 3 blocks of -df_ext/du, row node a, column node b, of what follows the surface; may come more than once */
typedef PetscErrorCode (*TLEDAddBlock)(void *ctx, PetscInt a, PetscInt b, const PetscReal K[9]);
PetscErrorCode TLEDExternalTangent_Private(TLED tled, PetscReal t, const PetscReal u[], TLEDAddBlock add, void *ctx);
/* tled_time.c: largest stable step of the state with contact and stiffness damping [s], once the critical step is known */
PetscReal TLEDStableStep_Private(TLED tled);
/* tled_contact.c */
PetscErrorCode TLEDContactSetUp_Private(TLED tled);
PetscErrorCode TLEDContactDestroy_Private(TLEDContact *contact);
double         TLEDContactAt_Private(TLED tled, PetscInt node, const double u[3], double f[3], double K[9], double *deep);
double         TLEDContactEnergy_Private(TLED tled, const double u[]);
double         TLEDContactRate_Private(TLED tled, const double mass[]); /* [1/s^2] */
PetscBool      TLEDContactKeepsSides_Private(TLED tled, const double u[], const double x[]);
PetscErrorCode TLEDContactReport_Private(TLED tled, const PetscReal u[], PetscReal time);
/* f(u), raw arrays; returns BY_ERR_BREAKDOWN (with no message) when an element is broken */
PetscErrorCode TLEDForces_Private(TLED tled, const PetscReal u[], PetscReal f[]);

#endif
