/* bench_krylov.c - the bounded pressure system of IISPH by every solver there is, each from the same states.
     bench.krylov [-n 20,8,30] [-length 0.8] [-from 0.1] [-every 0.03] [-samples 6] [-tolerances 1e-3,1e-4,1e-5] [-types cg,minres,...]
   A dam of n particles breaks (a tank as long as the water: still water) under the default solver. At `samples` moments the step's system is solved by
   each method to each tolerance from the last pressure, and what came out is judged by one measure, the mean of |projected b - A y|/S over rho0 over
   particles with pressure or wanting it, which is what sph.tolerance means. Relaxed Jacobi stops at another measure: its own tolerance is lowered
   until that one is met. Prints, by method and tolerance: operator applications, processor time, residual. */
#include <math.h>
#include <time.h>

#include "sph/sph_impl.h"

typedef struct {
  char        name[32];
  const char *option, *value; /* chooses a solver of PETSc */
  int         bounded;        /* SPHBounded, or -1: relaxed Jacobi */
} Method;

typedef struct {
  PetscReal applications, seconds, residual;
  PetscInt  most, failed, solves;
} Tally;

#define MAX_METHODS    16
#define MAX_TOLERANCES 6

static PetscReal Seconds(void)
{
  struct timespec t;
  (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (PetscReal)t.tv_sec + 1e-9 * (PetscReal)t.tv_nsec;
}

/* the common measure of sph->p */
static PetscErrorCode Residual(SPH sph, const SPHOperator *op, PetscReal *residual)
{
  const PetscReal rho0 = sph->params.density, to_tilde = 1.0 / (rho0 * rho0);
  PetscReal       sum = 0.0, count = 0.0;

  PetscFunctionBegin;
  SPHPrepare_Internal(sph, op->dt, 0.0);
  for (PetscInt i = 0; i < sph->n; i++) sph->y[i] = to_tilde * sph->p[i] * sph->root[i];
  PetscCall(SPHApply_Internal(sph, op, sph->y, sph->residual));
  for (PetscInt i = 0; i < sph->n; i++) {
    const PetscReal g = sph->residual[i] - sph->rhs[i];
    if (sph->y[i] > 0 || g < 0) {
      sum += PetscAbsReal(g) * sph->root[i];
      count += 1.0;
    }
  }
  *residual = sum / (rho0 * PetscMax(1.0, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one solve from `start`; sph->p is the answer */
static PetscErrorCode Once(SPH sph, const Method *m, const PetscReal start[], PetscReal dt, PetscReal *seconds, PetscInt *applications, PetscReal *residual)
{
  const SPHOperator op    = {dt, NULL, NULL};
  PetscReal         begin;

  PetscFunctionBegin;
  sph->method         = m->bounded < 0 ? &SPHSolverIISPHJacobi : &SPHSolverIISPH;
  sph->params.bounded = PetscMax(0, m->bounded);
  PetscCall(PetscArraycpy(sph->p, start, sph->n));
  begin = Seconds();
  ByCall(SPHSolvePressure(sph, dt, NULL, NULL));
  *seconds      = Seconds() - begin;
  *applications = sph->iterations;
  PetscCall(Residual(sph, &op, residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Try(SPH sph, const Method *m, const PetscReal start[], PetscReal dt, PetscReal tolerance, Tally *tally)
{
  const PetscInt limit = 2000;
  PetscReal      seconds, residual;
  PetscInt       applications;

  PetscFunctionBegin;
  if (m->option) PetscCall(PetscOptionsSetValue(NULL, m->option, m->value));
  sph->params.max_iterations = limit;
  sph->params.tolerance      = tolerance;
  PetscCall(Once(sph, m, start, dt, &seconds, &applications, &residual)); // the first makes PETSc's objects
  if (m->option) PetscCall(Once(sph, m, start, dt, &seconds, &applications, &residual));
  while (m->bounded < 0 && residual > tolerance && applications < limit) {
    sph->params.tolerance *= 0.6;
    PetscCall(Once(sph, m, start, dt, &seconds, &applications, &residual));
  }
  if (m->option) {
    PetscCall(SPHDestroyKSP_Internal(sph));
    PetscCall(PetscOptionsClearValue(NULL, m->option));
  }
  tally->applications += applications;
  tally->seconds += seconds;
  tally->residual = PetscMax(tally->residual, residual);
  tally->most     = PetscMax(tally->most, applications);
  tally->failed += residual > 1.5 * tolerance;
  tally->solves++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Fill(SPH sph, const PetscInt n[3], PetscReal dx)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n[2]; k++)
    for (PetscInt j = 0; j < n[1]; j++)
      for (PetscInt i = 0; i < n[0]; i++) {
        const PetscReal x[3] = {(i + 0.5) * dx, (j + 0.5) * dx, (k + 0.5) * dx};
        PetscCall(SPHAddParticles(sph, 1, x, NULL));
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt Methods(Method methods[], char *types[], PetscInt n_types)
{
  PetscInt n = 0;

  methods[n++] = (Method){"relaxed Jacobi", NULL, NULL, -1};
  methods[n++] = (Method){"MPRGP", NULL, NULL, SPH_BOUNDED_MPRGP};
  methods[n++] = (Method){"Newton-CR (default)", NULL, NULL, SPH_BOUNDED_NEWTON};
  for (PetscInt k = 0; k < n_types && n < MAX_METHODS; k++) {
    const PetscBool tao = (PetscBool)(types[k][0] == 'b' || !strcmp(types[k], "gpcg")); // TAO's names of methods for bounds

    methods[n] = (Method){"", tao ? "-sph_tao_type" : "-sph_ksp_type", types[k], SPH_BOUNDED_NEWTON};
    (void)PetscSNPrintf(methods[n].name, sizeof(methods[n].name), "%s %s", tao ? "TAO" : "KSP", types[k]);
    n++;
  }
  return n;
}

static PetscErrorCode Main(void)
{
  PetscInt        n[3] = {20, 8, 30}, three = 3, n_tolerances = MAX_TOLERANCES, n_types = MAX_METHODS - 3, samples = 6, n_methods;
  PetscReal       length = 0.0, from = 0.1, every = 0.03, tolerance[MAX_TOLERANCES] = {1e-3, 1e-4, 1e-5}, time = 0.0, *start;
  const PetscReal gravity[3] = {0, 0, -9.81}, lo[3] = {0, 0, 0};
  char           *types[MAX_METHODS];
  PetscBool       given;
  Method          methods[MAX_METHODS];
  Tally           tally[MAX_METHODS][MAX_TOLERANCES] = {{{0, 0, 0, 0, 0, 0}}};
  SPHParams      *par;
  SPH             sph;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetIntArray(NULL, NULL, "-n", n, &three, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-length", &length, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-from", &from, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-every", &every, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-samples", &samples, NULL));
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, "-tolerances", tolerance, &n_tolerances, &given));
  if (!given) n_tolerances = 3;
  PetscCall(PetscOptionsGetStringArray(NULL, NULL, "-types", types, &n_types, &given));
  if (!given) n_types = 0;
  n_methods = Methods(methods, types, n_types);
  const PetscReal dx = 0.4 / n[2], hi[3] = {PetscMax(length, n[0] * dx), n[1] * dx, 0.8};

  PetscCall(SPHCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SPHGetParams(sph, &par));
  par->spacing = dx;
  PetscCall(SPHSetFromOptions(sph));
  par->solver = SPH_SOLVER_IISPH;
  PetscCall(SPHSetDomain(sph, lo, hi, 31, 0));
  PetscCall(SPHSetGravity(sph, gravity));
  PetscCall(Fill(sph, n, dx));
  ByCall(SPHSetUp(sph));
  ByCall(SPHPack(sph, 1e-3, 50, NULL, NULL));
  PetscCall(PetscMalloc1(sph->n, &start));
  for (PetscInt taken = 0; taken < samples;) {
    const PetscReal usual = sph->params.tolerance;
    const PetscInt  limit = sph->params.max_iterations;
    PetscReal       dt;

    ByCall(SPHUpdateNeighbors(sph));
    PetscCall(SPHGetTimeStep(sph, &dt));
    PetscCall(SPHPredict(sph, dt));
    if (time >= from + taken * every) {
      const PetscReal norm = sph->norm;
      taken++;
      PetscCall(PetscArraycpy(start, sph->p, sph->n));
      for (PetscInt m = 0; m < n_methods; m++)
        for (PetscInt t = 0; t < n_tolerances; t++) ByCall(Try(sph, &methods[m], start, dt, tolerance[t], &tally[m][t]));
      PetscCall(PetscArraycpy(sph->p, start, sph->n));
      sph->method                = &SPHSolverIISPH;
      sph->params.bounded        = SPH_BOUNDED_NEWTON;
      sph->params.tolerance      = usual;
      sph->params.max_iterations = limit;
      sph->norm                  = norm;
    }
    ByCall(SPHSolvePressure(sph, dt, NULL, NULL));
    ByCall(SPHAdvance(sph, dt));
    time += dt;
  }
  for (PetscInt m = 0; m < n_methods; m++)
    for (PetscInt t = 0; t < n_tolerances; t++) {
      const Tally *q = &tally[m][t];
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "krylov: %d | %s | %g | %.1f | %d | %.4g | %.3g | %d\n", (int)sph->n, methods[m].name, (double)tolerance[t], (double)(q->applications / q->solves),
                            (int)q->most, 1e3 * (double)(q->seconds / q->solves), (double)q->residual, (int)q->failed));
    }
  for (PetscInt k = 0; k < n_types; k++) PetscCall(PetscFree(types[k]));
  PetscCall(PetscFree(start));
  PetscCall(SPHDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscErrorCode ierr;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  ierr = Main();
  return PetscFinalize() || ierr ? 1 : 0;
}
