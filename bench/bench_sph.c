/* bench_sph.c - speed and error of the fluid alone, both from one run: water poured into a tank as a lattice comes to rest, or a dam breaks.
     bench.sph [-all]                                       every solver beside the others: still water, then a dam break
     bench.sph -n 24,24,40 -end 1 [-sph_solver dfsph ...] [-pack] [-quiet] [-length 1.0] [-max_steps 100] [-cpu] [-json FILE]
    n particles along x, y, z; walls on five sides (-open_sides: periodic in x and y); depth H = n_z dx = 0.4 m. Prints compression,
   pressure against rho g z, force on the floor, speed and offset of the wetted surface, then times by phase. A tank longer than the
   water (-length [m]) makes a dam break; then energies, the front and the particle deepest in a wall are what to look at. -cpu: time of the
   processor, for machines that others use too. -json: all that was measured, and how front, energies and pressure went. */
#include <math.h>
#include <petsctime.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "sph/sph.h"

enum { NEIGHBORS, PREDICT, PRESSURE, FORCES, ADVANCE, N_PHASES };
static const char *const PhaseNames[N_PHASES] = {"neighbours and density", "predict", "pressure", "forces and gauges", "advance"};

#define N_SAMPLES 100 /* of the series, evenly in time */
enum { TIME, FRONT, TOP, KINETIC, POTENTIAL, FAR_FORCE, FLOOR_FORCE, COMPRESSION_MEAN, COMPRESSION_MAX, N_SERIES }; /* the far force is a mean since the last row */
static const char *const SeriesNames[N_SERIES] = {"time", "front", "top", "kinetic", "potential", "far_force", "floor_force", "compression_mean", "compression_max"};

/* what is run */
typedef struct {
  PetscInt  n[3], max_steps;   /* 0: none */
  PetscReal end, from, length; /* [s], [s], [m] */
  PetscBool open_sides, cpu, pack, quiet;
  int       solver;            /* SPHSolver, or -1: what the options say */
} Case;

/* what came out */
typedef struct {
  PetscReal      depth, lo[2], hi[2], g; /* of the still water; walls stand at lo and hi of x, y */
  PetscBool      walls, cpu;
  PetscReal      phase[N_PHASES + 1];
  PetscLogDouble start;
  PetscReal      gauge[3], gauge_sum[3], gauge_square[3]; /* depths of gauges in the middle of the tank over H; p/(rho g z) */
  PetscReal      deepest, energy; /* smallest distance from a wall [m]; kinetic and potential energy at the start [J] */
  PetscReal      force_sum, force_square, height_sum, error_sum, iterations, compression, compression_max;
  PetscReal      compression_top, compression_peak, energy_left; /* over the whole run: largest mean, largest of one particle; energy over the first */
  PetscReal      dt_min, time, from, mass, dx, far_impulse, since;
  PetscReal      series[N_SAMPLES + 1][N_SERIES];
  PetscInt       n, n_steps, n_measured, not_converged, worst, n_samples;
  SPHStats       stats;
  PetscErrorCode ierr;
  char           reason[512];
} Run;

static PetscErrorCode Lap(Run *run, int phase)
{
  PetscLogDouble now;

  PetscFunctionBegin;
  if (run->cpu) {
    struct timespec t;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    now = (PetscLogDouble)t.tv_sec + 1e-9 * (PetscLogDouble)t.tv_nsec;
  } else {
    PetscCall(PetscTime(&now));
  }
  run->phase[phase] += now - run->start;
  run->start = now;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mean |p - rho g (H - z)|/(rho g H) over particles away from surface, floor and walls; mean height */
static PetscErrorCode Measure(SPH sph, Run *run, PetscReal *error, PetscReal *height)
{
  const PetscReal *x, *p;
  PetscReal        h, sum = 0.0, z = 0.0;
  PetscInt         n, count = 0;

  PetscFunctionBegin;
  PetscCall(SPHGetSize(sph, &n));
  PetscCall(SPHGetState(sph, &x, NULL, &p, NULL, NULL));
  PetscCall(SPHGetSupport(sph, &h));
  for (PetscInt i = 0; i < n; i++) {
    PetscBool inside = (PetscBool)(x[3 * i + 2] > 2 * h && x[3 * i + 2] < run->depth - 2 * h);

    z += x[3 * i + 2] / n;
    for (int k = 0; k < 2 && run->walls; k++) inside = (PetscBool)(inside && x[3 * i + k] > run->lo[k] + 2 * h && x[3 * i + k] < run->hi[k] - 2 * h);
    if (!inside) continue;
    sum += PetscAbsReal(p[i] - 1000.0 * run->g * (run->depth - x[3 * i + 2])) / (1000.0 * run->g * (run->depth - x[3 * i + 2]));
    count++;
  }
  *error  = count ? sum / count : 0.0;
  *height = z;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Deepest(SPH sph, Run *run)
{
  const PetscReal *x;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCall(SPHGetSize(sph, &n));
  PetscCall(SPHGetState(sph, &x, NULL, NULL, NULL, NULL));
  for (PetscInt i = 0; i < n; i++) {
    run->deepest = PetscMin(run->deepest, x[3 * i + 2]);
    for (int k = 0; k < 2 && run->walls; k++) run->deepest = PetscMin(run->deepest, PetscMin(x[3 * i + k] - run->lo[k], run->hi[k] - x[3 * i + k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int Larger(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;
  return x > y ? -1 : x < y;
}

/* one row of the series: the front is where all but 1/2 % of the particles are behind, the top the same upwards */
static PetscErrorCode Sample(SPH sph, Run *run)
{
  PetscReal       *row = run->series[run->n_samples], *sorted, force[18];
  const PetscReal *x;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(run->n, &sorted));
  PetscCall(SPHGetState(sph, &x, NULL, NULL, NULL, NULL));
  for (int k = 0; k < 2; k++) {
    for (PetscInt i = 0; i < run->n; i++) sorted[i] = x[3 * i + 2 * k];
    qsort(sorted, (size_t)run->n, sizeof(*sorted), Larger);
    row[FRONT + k] = sorted[run->n / 200];
  }
  PetscCall(PetscFree(sorted));
  PetscCall(SPHGetWallForces(sph, force));
  row[TIME]             = run->time;
  row[FLOOR_FORCE]      = -force[14];
  row[KINETIC]          = run->stats.kinetic;
  row[POTENTIAL]        = run->stats.potential;
  row[FAR_FORCE]        = run->time > run->since ? run->far_impulse / (run->time - run->since) : 0.0;
  row[COMPRESSION_MEAN] = run->stats.compression_mean;
  row[COMPRESSION_MAX]  = run->stats.compression_max;
  run->far_impulse      = 0.0;
  run->since            = run->time;
  run->n_samples++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Step(SPH sph, Run *run)
{
  PetscReal dt, force[18], error, height;
  SPHStats  stats;

  PetscFunctionBegin;
  PetscCall(Lap(run, N_PHASES)); // measurements since the last step are nobody's time
  ByCall(SPHUpdateNeighbors(sph));
  PetscCall(Lap(run, NEIGHBORS));
  PetscCall(SPHGetTimeStep(sph, &dt));
  PetscCall(SPHPredict(sph, dt));
  PetscCall(Lap(run, PREDICT));
  ByCall(SPHSolvePressure(sph, dt, NULL, NULL));
  PetscCall(Lap(run, PRESSURE));
  PetscCall(SPHGetForces(sph));
  PetscCall(SPHGetWallForces(sph, force));
  PetscCall(SPHGetStats(sph, &stats));
  PetscCall(Lap(run, FORCES));
  ByCall(SPHAdvance(sph, dt));
  PetscCall(Lap(run, ADVANCE));
  run->time += dt;
  run->n_steps++;
  run->iterations += stats.iterations;
  run->stats  = stats;
  run->dt_min = PetscMin(run->dt_min, dt);
  run->far_impulse += dt * force[3];
  PetscCall(Deepest(sph, run));
  if (run->n_steps == 1) run->energy = stats.kinetic + stats.potential;
  run->worst = PetscMax(run->worst, stats.iterations);
  run->not_converged += !stats.converged;
  run->compression_top  = PetscMax(run->compression_top, stats.compression_mean);
  run->compression_peak = PetscMax(run->compression_peak, stats.compression_max);
  if (run->time >= run->from) {
    PetscCall(Measure(sph, run, &error, &height));
    run->n_measured++;
    for (int k = 0; k < 3; k++) {
      const PetscReal at[3] = {0.5 * run->hi[0], 0.5 * run->hi[1], (1.0 - run->gauge[k]) * run->depth};
      PetscReal       p, v[3];
      PetscBool       inside;
      PetscCall(SPHInterpolate(sph, at, &p, v, &inside));
      p /= 1000.0 * run->g * run->gauge[k] * run->depth;
      run->gauge_sum[k] += p;
      run->gauge_square[k] += p * p;
    }
    run->force_sum += force[14];
    run->force_square += force[14] * force[14];
    run->height_sum += height;
    run->error_sum += error;
    run->compression += stats.compression_mean;
    run->compression_max = PetscMax(run->compression_max, stats.compression_max);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Seconds(const Run *run)
{
  PetscReal total = 0.0;

  for (int k = 0; k < N_PHASES; k++) total += run->phase[k];
  return total;
}

/* root mean square of p/(rho g z) - 1 of gauge k, or about its mean alone */
static PetscReal GaugeError(const Run *run, int k, PetscBool noise)
{
  const PetscReal mean = run->gauge_sum[k] / run->n_measured, about = noise ? mean : 1.0;
  return sqrt(PetscMax(0.0, run->gauge_square[k] / run->n_measured - 2.0 * about * mean + about * about));
}

static PetscReal Weight(const Run *run) { return run->n * run->mass * run->g; }

static PetscReal ForceNoise(const Run *run)
{
  const PetscReal mean = run->force_sum / run->n_measured;
  return sqrt(PetscMax(0.0, run->force_square / run->n_measured - mean * mean)) / Weight(run);
}

static PetscErrorCode Report(const Run *run)
{
  const SPHStats *s = &run->stats;

  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "particles %d, steps %d, time %.3f s, measured from %.3f s\n", (int)run->n, (int)run->n_steps, (double)run->time, (double)run->from));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "compression: mean %.2e, largest %.2e; over the whole run %.2e, %.2e\n", (double)(run->compression / run->n_measured), (double)run->compression_max,
                        (double)run->compression_top, (double)run->compression_peak));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "pressure against rho g z: mean error %.2f %%\n", 100.0 * (double)(run->error_sum / run->n_measured)));
  for (int k = 0; k < 3; k++)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "gauge at %.2f of the depth / rho g z: %.4f, rms %.2f %%\n", (double)run->gauge[k], (double)(run->gauge_sum[k] / run->n_measured), 100.0 * (double)GaugeError(run, k, PETSC_TRUE)));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "force on the floor / weight: %.5f, noise (rms) %.2f %%\n", (double)(run->force_sum / run->n_measured / Weight(run)), 100.0 * (double)ForceNoise(run)));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "offset of the wetted surface: %.3f dx\n", (double)((run->height_sum / run->n_measured - 0.5 * run->depth) / run->dx)));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "speed / sqrt(g H): rms %.2f %%, largest %.2f %%\n", 100.0 * (double)(s->speed_rms / sqrt(run->g * run->depth)), 100.0 * (double)(s->speed_max / sqrt(run->g * run->depth))));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "smallest distance from a wall: %.3f dx; energy left: %.4f of what was there at first\n", (double)(run->deepest / run->dx), (double)run->energy_left));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "operator applications a step: mean %.2f, most %d; solves that stopped at the limit: %d\n", (double)(run->iterations / run->n_steps),
                        (int)run->worst, (int)run->not_converged));
  for (int k = 0; k < N_PHASES; k++) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%-24s %8.3f ms a step\n", PhaseNames[k], 1e3 * (double)(run->phase[k] / run->n_steps)));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%-24s %8.3f ms a step; pressure %.3f ms an operator application\n", "all", 1e3 * (double)(Seconds(run) / run->n_steps),
                        1e3 * (double)(run->phase[PRESSURE] / PetscMax(1.0, run->iterations))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* JSON has no numbers that are none */
static double Finite(PetscReal x) { return isfinite(x) ? (double)x : 1e300; }

/* everything as JSON, for reports */
static PetscErrorCode WriteJSON(const Run *run, const char path[])
{
  FILE *file = fopen(path, "w");

  PetscFunctionBegin;
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write %s", path);
  fprintf(file, "{\"particles\": %d, \"steps\": %d, \"time\": %.9g, \"seconds\": %.6g, \"dt_min\": %.9g, \"iterations\": %.6g, \"worst\": %d, \"not_converged\": %d,\n", (int)run->n, (int)run->n_steps,
          (double)run->time, (double)Seconds(run), Finite(run->dt_min), (double)(run->iterations / PetscMax(1, run->n_steps)), (int)run->worst, (int)run->not_converged);
  fprintf(file, " \"stopped\": \"%s\", \"deepest\": %.6g, \"energy_left\": %.6g, \"weight\": %.9g, \"energy\": %.9g, \"compression_peak\": %.6g, \"compression_top\": %.6g,\n", run->ierr ? run->reason : "",
          Finite(run->deepest / run->dx), Finite(run->energy_left), Finite(Weight(run)), Finite(run->energy), Finite(run->compression_peak), Finite(run->compression_top));
  if (run->n_measured) {
    fprintf(file, " \"gauge_error\": [%.6g, %.6g, %.6g], \"force\": %.9g, \"force_noise\": %.6g, \"offset\": %.6g, \"compression\": %.6g, \"speed_rms\": %.6g,\n", Finite(GaugeError(run, 0, PETSC_FALSE)),
            Finite(GaugeError(run, 1, PETSC_FALSE)), Finite(GaugeError(run, 2, PETSC_FALSE)), Finite(run->force_sum / run->n_measured / Weight(run)), Finite(ForceNoise(run)),
            Finite((run->height_sum / run->n_measured - 0.5 * run->depth) / run->dx), Finite(run->compression / run->n_measured), Finite(run->stats.speed_rms / sqrt(run->g * run->depth)));
  }
  for (int k = 0; k < N_PHASES; k++) fprintf(file, " \"%s\": %.6g,\n", PhaseNames[k], (double)run->phase[k]);
  for (int q = 0; q < N_SERIES; q++) {
    fprintf(file, " \"%s\": [", q == TIME ? "times" : SeriesNames[q]);
    for (PetscInt k = 0; k < run->n_samples; k++) fprintf(file, "%s%.7g", k ? ", " : "", Finite(run->series[k][q]));
    fprintf(file, "]%s\n", q + 1 < N_SERIES ? "," : "}");
  }
  PetscCheck(!fclose(file), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write %s", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a lattice of n particles, half a spacing from floor and walls */
static PetscErrorCode Fill(SPH sph, const PetscInt n[3], PetscReal dx)
{
  PetscReal *x;
  PetscInt   m = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * n[0] * n[1] * n[2], &x));
  for (PetscInt k = 0; k < n[2]; k++)
    for (PetscInt j = 0; j < n[1]; j++)
      for (PetscInt i = 0; i < n[0]; i++) {
        x[m++] = (i + 0.5) * dx;
        x[m++] = (j + 0.5) * dx;
        x[m++] = (k + 0.5) * dx;
      }
  PetscCall(SPHAddParticles(sph, m / 3, x, NULL));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a line now and then */
static PetscErrorCode Tell(SPH sph, const Run *run)
{
  PetscReal       f[18], error, height;
  const SPHStats *s = &run->stats;

  PetscFunctionBegin;
  PetscCall(SPHGetWallForces(sph, f));
  PetscCall(Measure(sph, (Run *)run, &error, &height));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "t %.3f dt %.2e E %.4f it %d floor %.4f rms %.4f max %.3f comp %.1e %.1e offset %.3f p error %.3f\n", (double)run->time, (double)(run->time / run->n_steps),
                        (double)((s->kinetic + s->potential) / run->energy), (int)s->iterations, (double)(-f[14] / Weight(run)), (double)(s->speed_rms / sqrt(run->g * run->depth)), (double)s->speed_max,
                        (double)s->compression_mean, (double)s->compression_max, (double)((height - 0.5 * run->depth) / run->dx), (double)error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(SPH sph, const Case *c, Run *run)
{
  const PetscReal g[3] = {0, 0, -9.81}, lo[3] = {0, 0, 0}, dx = 0.4 / c->n[2], hi[3] = {PetscMax(c->length, c->n[0] * dx), c->n[1] * dx, 0.8};
  SPHParams      *par;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(sph, &par));
  par->spacing = dx;
  PetscCall(SPHSetFromOptions(sph));
  if (c->solver >= 0) par->solver = c->solver;
  PetscCall(SPHSetDomain(sph, lo, hi, c->open_sides ? 1u << 4 : 31u, c->open_sides ? 3u : 0u));
  PetscCall(SPHSetGravity(sph, g));
  PetscCall(Fill(sph, c->n, dx));
  ByCall(SPHSetUp(sph));
  if (c->pack) ByCall(SPHPack(sph, 1e-3, 50, NULL, NULL));
  PetscCall(SPHGetSize(sph, &run->n));
  PetscCall(SPHGetMass(sph, &run->mass));
  run->walls   = (PetscBool)!c->open_sides;
  run->cpu     = c->cpu;
  run->deepest = 1.0;
  run->dt_min  = PETSC_MAX_REAL;
  run->from    = c->from;
  run->g       = 9.81;
  run->dx      = dx;
  for (int k = 0; k < 3; k++) run->gauge[k] = 0.25 * (k + 1);
  for (int k = 0; k < 2; k++) run->hi[k] = hi[k];
  run->depth = run->n * run->mass / par->density / (hi[0] * hi[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Steps(SPH sph, const Case *c, Run *run)
{
  PetscReal next = 0.0;

  PetscFunctionBegin;
  while (run->time < c->end && !(c->max_steps && run->n_steps >= c->max_steps)) {
    ByCall(Step(sph, run));
    if (run->n_samples <= N_SAMPLES && run->time >= run->n_samples * c->end / N_SAMPLES) PetscCall(Sample(sph, run));
    if (!c->quiet && run->time >= next) {
      PetscCall(Tell(sph, run));
      next += c->end / 20;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* run->ierr tells whether it came to its end */
static PetscErrorCode RunCase(const Case *c, Run *run)
{
  SPH         sph;
  const char *reason;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(run, sizeof(*run)));
  PetscCall(SPHCreate(PETSC_COMM_SELF, &sph));
  run->ierr = SetUp(sph, c, run);
  if (!run->ierr) run->ierr = Steps(sph, c, run);
  if (run->ierr && run->ierr != BY_ERR_BREAKDOWN && run->ierr != BY_ERR_INPUT) PetscCall(run->ierr);
  PetscCall(SPHGetBreakdown(sph, &reason));
  PetscCall(PetscStrncpy(run->reason, run->ierr == BY_ERR_INPUT ? "refused" : reason ? reason : "", sizeof(run->reason)));
  run->force_sum   = -run->force_sum;
  run->energy_left = run->energy > 0 ? (run->stats.kinetic + run->stats.potential) / run->energy : 1.0;
  PetscCall(SPHDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* every solver on the same water */
static PetscErrorCode Compare(Case *c)
{
  const Key *key = SPHKeys;
  Run       *run;

  PetscFunctionBegin;
  while (strcmp(key->name, "solver")) key++;
  PetscCall(PetscNew(&run));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: %d x %d x %d particles, %g s, %s time\n", c->length > 0 ? "dam break" : "still water", (int)c->n[0], (int)c->n[1], (int)c->n[2], (double)c->end, c->cpu ? "processor" : "wall"));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%-14s %9s %7s %8s %9s %9s %10s %10s %9s %8s\n", "solver", "seconds", "steps", "ms/step", "applied", c->length > 0 ? "front" : "gauges",
                        c->length > 0 ? "energy" : "floor", c->length > 0 ? "deepest" : "speed", "mean", "largest"));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%-14s %9s %7s %8s %9s %9s %10s %10s %9s %8s\n", "", "", "", "", "a step", c->length > 0 ? "m" : "rms, %", c->length > 0 ? "kept" : "noise, %", c->length > 0 ? "dx" : "rms, %",
                        "compr.", "compr."));
  for (int k = 0; key->choices[k]; k++) {
    if (!strcmp(key->choices[k], "auto")) continue;
    c->solver = k;
    PetscCall(RunCase(c, run));
    if (run->ierr) {
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%-14s %s\n", key->choices[k], run->reason));
      continue;
    }
    const PetscBool dam = (PetscBool)(c->length > 0);
    PetscReal       gauge = 0.0;

    for (int q = 0; q < 3; q++) gauge += GaugeError(run, q, PETSC_FALSE) / 3.0;
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%-14s %9.2f %7d %8.3f %9.1f %9.3f %10.3f %10.3f %9.1e %8.1e\n", key->choices[k], (double)Seconds(run), (int)run->n_steps, 1e3 * (double)(Seconds(run) / run->n_steps),
                          (double)(run->iterations / run->n_steps), (double)(dam ? run->series[run->n_samples - 1][FRONT] : 100.0 * gauge), (double)(dam ? run->energy_left : 100.0 * ForceNoise(run)),
                          (double)(dam ? run->deepest / run->dx : 100.0 * run->stats.speed_rms / sqrt(run->g * run->depth)), (double)(dam ? run->compression_top : run->compression / run->n_measured),
                          (double)(dam ? run->compression_peak : run->compression_max)));
  }
  PetscCall(PetscFree(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CompareAll(void)
{
  Case tank = {{12, 12, 20}, 0, 3.0, 2.0, 0.0, PETSC_FALSE, PETSC_TRUE, PETSC_TRUE, PETSC_TRUE, -1};
  Case dam  = {{16, 8, 24}, 0, 0.25, 0.0, 1.2, PETSC_FALSE, PETSC_TRUE, PETSC_TRUE, PETSC_TRUE, -1};

  PetscFunctionBegin;
  PetscCall(Compare(&tank));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "\n"));
  PetscCall(Compare(&dam));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Main(PetscBool bare)
{
  Case      c = {{24, 24, 40}, 0, 1.0, -1.0, 0.0, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, -1};
  Run      *run;
  PetscInt  n_read = 3;
  PetscBool all = bare, json;
  char      path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-all", &all, NULL));
  if (all) {
    PetscCall(CompareAll());
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscOptionsGetIntArray(NULL, NULL, "-n", c.n, &n_read, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-max_steps", &c.max_steps, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-end", &c.end, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-from", &c.from, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-length", &c.length, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-open_sides", &c.open_sides, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-cpu", &c.cpu, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-quiet", &c.quiet, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-pack", &c.pack, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-json", path, sizeof(path), &json));
  if (c.from < 0) c.from = 0.5 * c.end;
  PetscCall(PetscNew(&run));
  PetscCall(RunCase(&c, run));
  if (json) PetscCall(WriteJSON(run, path));
  if (run->ierr) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "stopped: %s\n", run->reason));
  else if (run->n_measured) PetscCall(Report(run));
  PetscCall(PetscFree(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const PetscBool bare = (PetscBool)(argc == 1);
  PetscErrorCode  ierr;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  ierr = Main(bare);
  return PetscFinalize() || ierr ? 1 : 0;
}
