/* fluid_hard.h - hard cases of the fluid, each with every pressure solver: a line `hard fluid: case | solver | outcome | figures | within`
   for a report, and the check that goes with it. What is asked of all: no particle outside, no number that is none, or a stop that tells why. */
#ifndef BY_TEST_FLUID_HARD_H
#define BY_TEST_FLUID_HARD_H

#include <string.h>
#include <time.h>

#include "sph/sph_impl.h"
#include "unit/sph/fluid.h"

#define LONGEST 20.0 /* [s of the processor] a case that takes longer has hung */

typedef struct {
  PetscErrorCode ierr;                   /* 0, BY_ERR_BREAKDOWN or BY_ERR_INPUT                                    */
  const char    *reason;
  PetscInt       steps, outside;         /* outside: particles beyond a wall, the most at the end of a step        */
  PetscReal      time, seconds;          /* seconds of the processor                                               */
  PetscReal      deepest, speed;         /* smallest distance from a wall [dx]; largest speed at the end of a step */
  PetscReal      first, highest, last;   /* energy [J]                                                             */
  PetscReal      compression;            /* largest of the last step                                               */
  PetscReal      imbalance;              /* |momentum - impulses of walls and weight|, largest over the run [N s]  */
} HardRun;

static int hard_failures; /* rows not within, of the running test */

/* names of the solvers: choices of the key `solver` */
static inline const char *const *HardSolvers(void)
{
  const Key *k = SPHKeys;

  while (strcmp(k->name, "solver")) k++;
  return k->choices;
}

/* -solver NAME takes that one, -solver all each; without it the default */
static inline PetscBool HardSkips(const char solver[])
{
  char only[64] = "iisph";

  assert_petsc(PetscOptionsGetString(NULL, NULL, "-solver", only, sizeof only, NULL));
  if (!strcmp(only, "all")) return (PetscBool)!strcmp(solver, "auto");
  return (PetscBool) !!strcmp(only, solver);
}

/* a fluid as a scene has it: defaults, single precision; walls as SPHSetDomain() */
static inline SPH HardFluid(int solver, PetscReal dx, const PetscReal hi[3], unsigned walls)
{
  const PetscReal lo[3] = {0, 0, 0}, g[3] = {0, 0, -9.81};
  SPH             sph   = NewFluid(dx);
  SPHParams      *par;

  assert_petsc(SPHGetParams(sph, &par));
  par->precision = SPH_PRECISION_SINGLE;
  par->solver    = solver;
  assert_petsc(SPHSetDomain(sph, lo, hi, walls, 0));
  assert_petsc(SPHSetGravity(sph, g));
  return sph;
}

/* n particles of spacing `a`, the first at `from` */
static inline void HardBlock(SPH sph, const PetscReal from[3], const PetscInt n[3], PetscReal a, const PetscReal v[3])
{
  const PetscInt total = n[0] * n[1] * n[2];
  PetscReal     *x = (PetscReal *)malloc(sizeof(*x) * 3 * (size_t)total), *w = (PetscReal *)malloc(sizeof(*w) * 3 * (size_t)total);
  PetscInt       m = 0;

  for (PetscInt k = 0; k < n[2]; k++)
    for (PetscInt j = 0; j < n[1]; j++)
      for (PetscInt i = 0; i < n[0]; i++, m++) {
        x[3 * m]     = from[0] + i * a;
        x[3 * m + 1] = from[1] + j * a;
        x[3 * m + 2] = from[2] + k * a;
        for (int q = 0; q < 3; q++) w[3 * m + q] = v ? v[q] : 0.0;
      }
  assert_petsc(SPHAddParticles(sph, total, x, w));
  free(x);
  free(w);
}

static inline void HardLook(SPH sph, HardRun *r, PetscReal start[3], PetscReal impulse[3], PetscReal dt)
{
  const PetscReal *x;
  PetscReal        force[18], mass, sign, off = 0.0;
  PetscInt         n, outside = 0;
  SPHParams       *par;
  SPHStats         s;

  assert_petsc(SPHGetSize(sph, &n));
  assert_petsc(SPHGetState(sph, &x, NULL, NULL, NULL, NULL));
  assert_petsc(SPHGetParams(sph, &par));
  assert_petsc(SPHGetMass(sph, &mass));
  assert_petsc(SPHGetWallForces(sph, force));
  assert_petsc(SPHGetStats(sph, &s));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal gap = PETSC_MAX_REAL;
    for (int k = 0; k < 6; k++)
      if (sph->walls >> k & 1) gap = PetscMin(gap, SPHPlaneDistance(sph, k, x + 3 * i, &sign)); // of planes where they are now
    r->deepest = PetscMin(r->deepest, gap / par->spacing);
    outside += !(gap >= 0.0); // not a number is outside too
  }
  for (int k = 0; k < 3; k++) {
    const PetscReal weight = k == 2 ? -9.81 * mass * n : 0.0;
    for (int w = 0; w < 6; w++) impulse[k] -= dt * force[3 * w + k];
    impulse[k] += dt * weight;
    if (r->steps == 0) start[k] = s.momentum[k];
    off += PetscSqr(s.momentum[k] - start[k] - impulse[k]);
  }
  r->imbalance   = PetscMax(r->imbalance, sqrt(off));
  r->outside     = PetscMax(r->outside, outside);
  r->speed       = PetscMax(r->speed, s.speed_max);
  r->last        = s.kinetic + s.potential;
  r->highest     = PetscMax(r->highest, r->last);
  r->compression = s.compression_max;
}

static inline PetscErrorCode HardStep(SPH sph, PetscReal *dt)
{
  PetscFunctionBegin;
  ByCall(SPHUpdateNeighbors(sph));
  ByCall(SPHGetTimeStep(sph, dt));
  ByCall(SPHPredict(sph, *dt));
  ByCall(SPHSolvePressure(sph, *dt, NULL, NULL));
  ByCall(SPHGetForces(sph));
  ByCall(SPHAdvance(sph, *dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SetUp, packing when asked, and steps until `end`, or until something stops them */
static inline HardRun HardGo(SPH sph, PetscBool pack, PetscReal end)
{
  const clock_t start   = clock();
  PetscReal     dt      = 0.0, momentum[3] = {0, 0, 0}, impulse[3] = {0, 0, 0};
  HardRun       r       = {.deepest = 1e3};

  r.ierr = SPHSetUp(sph);
  if (!r.ierr && pack) r.ierr = SPHPack(sph, 1e-3, 50, NULL, NULL);
  if (!r.ierr) HardLook(sph, &r, momentum, impulse, 0.0);
  r.first = r.highest = r.last;
  while (!r.ierr && r.time < end && r.seconds < LONGEST) {
    if ((r.ierr = HardStep(sph, &dt))) break;
    r.time += dt;
    r.steps++;
    HardLook(sph, &r, momentum, impulse, dt);
    r.seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  }
  if (r.ierr) assert_petsc(SPHGetBreakdown(sph, &r.reason));
  return r;
}

/* the line of a run, and whether it is as asked: refused, or stopped with a reason, or through without a particle outside, and `good` */
static inline void HardTell(const char name[], const char solver[], const HardRun *r, const char figures[], PetscBool good)
{
  const PetscBool refused = (PetscBool)(r->ierr == BY_ERR_INPUT), stopped = (PetscBool)(r->ierr == BY_ERR_BREAKDOWN && r->reason && r->reason[0]);
  const PetscBool through = (PetscBool)(r->ierr == PETSC_SUCCESS && r->seconds < LONGEST && r->outside == 0 && isfinite(r->last));
  const PetscBool within  = (PetscBool)(refused || stopped || (through && good));
  char            outcome[700];

  if (refused) snprintf(outcome, sizeof outcome, "refused");
  else if (r->ierr) snprintf(outcome, sizeof outcome, "stopped: %s", stopped ? r->reason : "no reason given");
  else snprintf(outcome, sizeof outcome, "%d steps, %d outside%s", (int)r->steps, (int)r->outside, r->seconds < LONGEST ? "" : ", hung");
  for (char *at = outcome; (at = strchr(at, '\n')); at++) *at = ' '; // a row is a line
  printf("hard fluid: %s | %s | %s | %s | %.2f | %s\n", name, solver, outcome, r->ierr ? "" : figures, (double)r->seconds, within ? "yes" : "no");
  fflush(stdout);
  hard_failures += !within;
}

#endif
