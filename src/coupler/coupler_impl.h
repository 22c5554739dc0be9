/* coupler_impl.h - struct _p_Coupler; included only in src/coupler. */
#ifndef BY_COUPLER_IMPL_H
#define BY_COUPLER_IMPL_H

#include "coupler/coupler.h"
#include "surface.h"
#include "checkpoint.h"
#include <petscksp.h>
#include <petsc/private/petscimpl.h>

#define COUPLER_MAX_SURFACES (2 * BY_NAMES_MAX)

/* interface response of a body: mean velocity over the step = z solves (M + beta dt^2 K) z = dt/2 F */
typedef struct {
  Mat       tangent, matrix;
  KSP       ksp;
  Vec       rhs, solution;
  PetscReal dt;     /* [s] step for which the matrix was made; 0 = none yet */
  PetscReal dt_step; /* [s] the current step                                 */
  PetscReal share;   /* of dt/2: 1 with held forces                           */
  PetscReal *at;     /* n x 3 [m] displacement of which it is made            */
  PetscInt  age;     /* steps since the matrix was made                      */
} CouplerResponse;

typedef struct {
  char            name[BY_NAME_MAX];
  TLED            tled;  /* NULL for an obstacle                                                          */
  Proxy           proxy; /* NULL for a body that no fluid can reach                                       */
  PetscInt        n_nodes;
  PetscReal      *x;             /* n x 3 positions of an obstacle; NULL for a body                        */
  CouplerScheme   scheme;        /* of a body                                                              */
  PetscReal       water, stiffness; /* mass of water that the body must move over its own; (omega dt)^2 of its softest motion; negative = not asked for */
  PetscBool       touched, answers, iterates; /* this step: by water; within the pressure solve; is run until both sides agree */
  PetscInt        n_interface, interface_start, *interface; /* nodes of the wetted surface, their place in the interface's vector */
  PetscBool       slip, moves;   /* an obstacle along which fluid slips, one that moves                    */
  Motion          motion;
  PetscReal      *x_rest, *x_next, *v_nodes; /* n x 3, of one that moves: before its motion, at the end of the step [m]; mean velocity [m/s] */
  PetscReal       power;         /* [W] of the fluid on an obstacle that moves, last step                  */
  PetscInt       *triangles;     /* of an obstacle                                                         */
  PetscInt        n_triangles;
  SurfaceIndex    index;         /* of an obstacle at rest, on which others may lie                         */
  PetscReal      *force;         /* n x 3 [N] forces of the fluid on the nodes, last step                  */
  PetscReal      *last_force;    /* n x 3 [N] those of the step before                                     */
  PetscReal      *start;         /* n x 3 [m] displacement at the start of the step                        */
  PetscReal      *mean_velocity; /* n x 3 [m/s] of the surface over the step                               */
  PetscReal      *wall_velocity; /* n x 3 [m/s] what the fluid sees, less the response to the new forces   */
  PetscReal      *seen;          /* n x 3 [m/s] what the fluid has seen in the last solve                  */
  PetscReal      *answer;        /* n x 3 [m/s] response to the new forces                                 */
  PetscReal      *proxy_force;   /* per proxy, 3 [N]                                                       */
  PetscReal      *proxy_work;    /* per proxy, 3: scratch of the response                                  */
  PetscInt        capacity;      /* proxies allocated                                                      */
  PetscReal      *arm;           /* per touched particle, 3: couple of its pairs' shares about their proxies; of bodies that answer */
  PetscInt        n_arms;        /* allocated                                                              */
  PetscReal       work_step, work_force; /* [J] of the forces on the body: in this step, and since the start without stops */
  PetscReal       work_fluid, work_solid, work_exchanged; /* [J] since the start; the last is the sum of the fluid's absolute works */
  PetscReal       total[3];      /* [N] of the last step                                                   */
  PetscReal       moment[3];     /* [N m] of the last step about the origin                                */
  PetscInt        substeps;      /* of the last step                                                       */
  PetscReal       n_substeps_sum, n_proxies_sum; /* over the steps since the start                         */
  PetscReal       n_substeps_run;                /* trial runs and passes included, by this process        */
  CouplerResponse response;
} CouplerSurface;

typedef struct {
  char        name[BY_NAME_MAX];
  ProbeParams params;
  PetscInt    surface; /* body or obstacle; -1 - wall for a wall; PETSC_MIN_INT for the water */
  PetscInt    n_nodes; /* of the element that holds the point, 4 or 10 */
  PetscInt    node[10];
  PetscReal   weight[10];
  PetscInt    patch;    /* of SPHAddPatch(): pressure on a wall                                      */
  PetscInt    n_points; /* of a line or rectangle, which has a file of its own; 0: columns in probes.csv */
  PetscInt    n_across; /* points along the second side of a rectangle; 1 on a line                  */
  PetscReal   sum[3];   /* of value x step since the last row, of a probe that is a mean             */
  PetscReal   time;     /* [s] of those steps                                                        */
} CouplerProbe;

typedef enum { PHASE_NEIGHBOURS, PHASE_PRESSURE, PHASE_PROXIES, PHASE_TRANSFER, PHASE_SOLID, PHASE_OUTPUT, N_PHASES } CouplerPhase;

struct _p_Coupler {
  PETSCHEADER(int);
  CouplerParams  params;
  SPH            sph;
  PetscInt       n_bodies, n_surfaces; /* bodies first, then obstacles */
  CouplerSurface surface[COUPLER_MAX_SURFACES];
  SPHContacts    contacts[COUPLER_MAX_SURFACES];
  PetscInt       n_probes;
  CouplerProbe   probe[BY_NAMES_MAX];
  PetscReal      gravity[3];
  PetscInt       n_wall_motions;
  Motion         wall_motion[6], frame;
  PetscBool      responds;         /* the solver takes a response                 */
  PetscBool      setup, compliant; /* compliant: some body answers within the pressure solve of this step */
  PetscBool      within_step;      /* a step has begun and has not ended: after a breakdown bodies may be ahead of the water */
  PetscInt       n_interface;      /* unknowns of the interface                   */
  PetscReal     *interface, *residual; /* [m/s] its velocity and residual         */
  struct Relaxation *relaxation;
  PetscInt       solves, n_unsettled;  /* pressure solves of the last step; steps whose iterations did not settle */
  PetscReal      balance_start;       /* [J] of CouplerGetBalance() at the start                                   */
  PetscReal      mismatch, solves_sum, mismatch_sum; /* relative residual of the last step; sums over all steps   */
  PetscReal      time, dt, mass;   /* mass of a particle [kg]                      */
  PetscReal      rest_density;
  PetscInt       step;
  PetscReal      iterations_sum;
  PetscLogDouble phase[N_PHASES], mark; /* [s] wall                                  */
  PetscLogDouble phase_cpu[N_PHASES], mark_cpu; /* [s] of all threads                */
  char           breakdown[1024];
};

/* coupler_scene.c */
PETSC_INTERN PetscErrorCode CouplerSetBodiesFromOptions(Coupler coupler);
/* coupler_motion.c */
PETSC_INTERN PetscErrorCode CouplerMoveDomain(Coupler coupler, const DomainParams *domain);
PETSC_INTERN PetscErrorCode CouplerRefuseMoving(const char key[], const char with[], const DomainParams *domain);
PETSC_INTERN PetscErrorCode CouplerReadObstacleMotion(Coupler coupler, PetscInt obstacle, PetscBool slip);
PETSC_INTERN PetscErrorCode CouplerSealedWalls(const char obstacle[], const DomainParams *domain, unsigned *walls);
PETSC_INTERN PetscErrorCode CouplerPlaceObstacles(Coupler coupler);
PETSC_INTERN PetscErrorCode CouplerMoveObstacles(Coupler coupler, PetscReal dt);
PETSC_INTERN PetscErrorCode CouplerArriveObstacles(Coupler coupler, PetscReal dt);
PETSC_INTERN PetscErrorCode CouplerLimitStep(Coupler coupler, PetscReal *dt);
/* coupler_fill.c */
PETSC_INTERN PetscErrorCode CouplerBuildFluid(Coupler coupler, const DomainParams *domain);
/* scheme_mass.c */
PETSC_INTERN PetscErrorCode CouplerArms(Coupler coupler, PetscInt k);
PETSC_INTERN PetscErrorCode CouplerResponseSetUp(Coupler coupler, CouplerSurface *s, PetscReal dt);
PETSC_INTERN PetscErrorCode CouplerResponseMake(Coupler coupler, CouplerSurface *s, PetscReal dt);
PETSC_INTERN PetscErrorCode CouplerResponseSolve(CouplerSurface *s, const PetscReal force[], PetscReal velocity[]);
PETSC_INTERN PetscErrorCode CouplerResponseApply(void *coupler, PetscInt n, const PetscReal p[], PetscReal Ap[]);
PETSC_INTERN PetscErrorCode CouplerResponseDestroy(CouplerResponse *response);
/* scheme_select.c */
PETSC_INTERN PetscErrorCode CouplerSelectSchemes(Coupler coupler);
PETSC_INTERN const char    *CouplerSchemeName(Coupler coupler); /* of the body that needs most */
PETSC_INTERN PetscErrorCode CouplerViewSchemes(Coupler coupler, PetscViewer viewer);
/* coupler_ledger.c */
PETSC_INTERN PetscErrorCode CouplerGetBalance(Coupler coupler, PetscReal *balance);
/* scheme_iterated.c */
PETSC_INTERN PetscErrorCode CouplerNumberInterface(Coupler coupler);
PETSC_INTERN PetscErrorCode CouplerCoupledStep(Coupler coupler, PetscReal dt);
/* coupler.c */
PETSC_INTERN PetscErrorCode CouplerUpdateContacts(Coupler coupler);
PETSC_INTERN PetscErrorCode CouplerAddNeighbours(Coupler coupler);
PETSC_INTERN PetscErrorCode CouplerTimer(Coupler coupler, CouplerPhase phase);
/* coupler_exchange.c */
PETSC_INTERN PetscErrorCode CouplerPredictWall(Coupler coupler, CouplerSurface *s, PetscReal dt);
PETSC_INTERN PetscErrorCode CouplerBaseVelocity(CouplerSurface *s);
PETSC_INTERN PetscErrorCode CouplerSolveFluid(Coupler coupler, PetscReal dt);
PETSC_INTERN PetscErrorCode CouplerAdvanceBody(Coupler coupler, CouplerSurface *s, PetscReal dt);
PETSC_INTERN PetscErrorCode CouplerReturnBody(CouplerSurface *s);
PETSC_INTERN void           CouplerAddWork(Coupler coupler, CouplerSurface *s, PetscReal dt);
PETSC_INTERN PetscErrorCode CouplerAngularMomentum(CouplerSurface *s, PetscReal L[3], PetscReal center[3]);
PETSC_INTERN PetscErrorCode CouplerAddRotation(CouplerSurface *s, const PetscReal lost[3]);
PETSC_INTERN void           CouplerMoment(PetscInt n, const PetscReal x[], const PetscReal f[], PetscReal moment[3]);
/* coupler_stop.c */
PETSC_INTERN PetscErrorCode CouplerStop(Coupler coupler, PetscReal dt);
PETSC_INTERN PetscErrorCode CouplerPushOut(Coupler coupler, PetscInt *n_moved);
/* coupler_probes.c */
PETSC_INTERN PetscErrorCode CouplerAddProbes(Coupler coupler, const Names *names);
PETSC_INTERN PetscErrorCode CouplerProbeHeaders(Coupler coupler, PetscInt *n, char headers[][2 * BY_NAME_MAX]);
PETSC_INTERN PetscErrorCode CouplerProbeStep(Coupler coupler, PetscReal dt); /* what means over time need of a step */
PETSC_INTERN PetscErrorCode CouplerProbeRow(Coupler coupler, PetscReal row[]);
PETSC_INTERN PetscErrorCode CouplerProbeSamples(CouplerProbe *probe);
/* file of a line's or a rectangle's values: a row a point, the time first */
PETSC_INTERN PetscErrorCode CouplerProfileCreate(const CouplerProbe *probe, const char directory[], PetscBool append, PetscReal time, Table *table);
PETSC_INTERN PetscErrorCode CouplerProfileWrite(Coupler coupler, const CouplerProbe *probe, Table table);
/* coupler_state.c */
PETSC_INTERN PetscErrorCode CouplerSave(Coupler coupler, const char directory[], const char scene[]);
PETSC_INTERN PetscErrorCode CouplerLoad(Coupler coupler, const char directory[]);

#endif
