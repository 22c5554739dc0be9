/* bench_sph.c - speed and error of the fluid alone, both from one run: water poured into a tank as a lattice comes to rest.
     bench.sph -n 24,24,40 -end 1 [-sph_solver iisph_jacobi ...] [-pack] [-quiet] [-length 1.0] [-cpu]
    n particles along x, y, z; walls on five sides (-open_sides: periodic in x and y); depth H = n_z dx = 0.4 m. Prints compression,
   pressure against rho g z, force on the floor, speed and offset of the wetted surface, then times by phase. A tank longer than the
   water (-length [m]) makes a dam break; then energies and the particle deepest in a wall are what to look at. */
#include <math.h>
#include <petsctime.h>
#include <time.h>

#include "sph/sph.h"

enum { NEIGHBORS, PREDICT, PRESSURE, FORCES, ADVANCE, N_PHASES };
static const char *const PhaseNames[N_PHASES] = {"neighbours and density", "predict", "pressure", "forces and gauges", "advance"};

typedef struct {
  PetscReal      depth, area, lo[2], hi[2], g; /* of the still water; walls stand at lo and hi of x, y */
  PetscBool      walls, cpu;     /* cpu: time of the processor, for machines that others use too */
  PetscReal      phase[N_PHASES + 1];
  PetscLogDouble start;
  PetscReal      gauge[3], gauge_sum[3], gauge_square[3]; /* depths of gauges in the middle of the tank over H; p/(rho g z) */
  PetscReal      deepest, energy; /* smallest distance from a wall [m]; kinetic and potential energy at the start [J] */
  PetscReal      force_sum, force_square, height_sum, error_sum, iterations, compression, compression_max;
  PetscInt       n_steps, n_measured, not_converged, worst;
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

static PetscErrorCode Step(SPH sph, Run *run, PetscReal *time, PetscReal from)
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
  *time += dt;
  run->n_steps++;
  run->iterations += stats.iterations;
  PetscCall(Deepest(sph, run));
  if (run->n_steps == 1) run->energy = stats.kinetic + stats.potential;
  run->worst = PetscMax(run->worst, stats.iterations);
  run->not_converged += !stats.converged;
  if (*time >= from) {
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

static PetscErrorCode Report(SPH sph, Run *run, PetscReal time, PetscReal from)
{
  PetscReal mass, total = 0.0, weight, mean, dx;
  PetscInt  n;
  SPHStats  stats;
  SPHParams *par;

  PetscFunctionBegin;
  PetscCall(SPHGetMass(sph, &mass));
  PetscCall(SPHGetSize(sph, &n));
  PetscCall(SPHGetStats(sph, &stats));
  PetscCall(SPHGetParams(sph, &par));
  dx     = par->spacing;
  weight = n * mass * run->g;
  mean   = run->force_sum / run->n_measured;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "particles %d, steps %d, time %.3f s, measured from %.3f s\n", (int)n, (int)run->n_steps, (double)time, (double)from));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "compression: mean %.2e, largest %.2e\n", (double)(run->compression / run->n_measured), (double)run->compression_max));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "pressure against rho g z: mean error %.2f %%\n", 100.0 * (double)(run->error_sum / run->n_measured)));
  for (int k = 0; k < 3; k++) {
    const PetscReal p = run->gauge_sum[k] / run->n_measured;
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "gauge at %.2f of the depth / rho g z: %.4f, rms %.2f %%\n", (double)run->gauge[k], (double)p,
                          100.0 * sqrt(PetscMax(0.0, (double)(run->gauge_square[k] / run->n_measured - p * p)))));
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "force on the floor / weight: %.5f, noise (rms) %.2f %%\n", (double)(mean / weight),
                        100.0 * sqrt(PetscMax(0.0, (double)(run->force_square / run->n_measured - mean * mean))) / (double)weight));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "offset of the wetted surface: %.3f dx\n", (double)((run->height_sum / run->n_measured - 0.5 * run->depth) / dx)));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "speed / sqrt(g H): rms %.2f %%, largest %.2f %%\n", 100.0 * (double)(stats.speed_rms / sqrt(run->g * run->depth)),
                        100.0 * (double)(stats.speed_max / sqrt(run->g * run->depth))));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "smallest distance from a wall: %.3f dx; energy left: %.4f of what was there at first\n", (double)(run->deepest / dx),
                        (double)((stats.kinetic + stats.potential) / run->energy)));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "operator applications a step: mean %.2f, most %d; solves that stopped at the limit: %d\n", (double)(run->iterations / run->n_steps),
                        (int)run->worst, (int)run->not_converged));
  for (int k = 0; k < N_PHASES; k++) {
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%-24s %8.3f ms a step\n", PhaseNames[k], 1e3 * (double)(run->phase[k] / run->n_steps)));
    total += run->phase[k];
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%-24s %8.3f ms a step; pressure %.3f ms an operator application\n", "all", 1e3 * (double)(total / run->n_steps),
                        1e3 * (double)(run->phase[PRESSURE] / run->iterations)));
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

static PetscErrorCode Main(void)
{
  SPH              sph;
  SPHParams       *par;
  Run              run;
  PetscInt         n[3] = {24, 24, 40}, n_read = 3;
  PetscReal        end = 1.0, from = -1.0, length = 0.0, time = 0.0, next = 0.0, dx, particle_mass;
  PetscBool        open_sides = PETSC_FALSE, quiet = PETSC_FALSE, pack = PETSC_FALSE;
  const PetscReal  g[3] = {0, 0, -9.81}, lo[3] = {0, 0, 0};

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&run, sizeof(run)));
  PetscCall(PetscOptionsGetIntArray(NULL, NULL, "-n", n, &n_read, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-end", &end, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-from", &from, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-open_sides", &open_sides, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-cpu", &run.cpu, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-quiet", &quiet, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-pack", &pack, NULL));
  if (from < 0) from = 0.5 * end;
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-length", &length, NULL));
  dx = 0.4 / n[2];
  const PetscReal hi[3] = {PetscMax(length, n[0] * dx), n[1] * dx, 0.8};

  PetscCall(SPHCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SPHGetParams(sph, &par));
  par->spacing = dx;
  PetscCall(SPHSetFromOptions(sph));
  PetscCall(SPHSetDomain(sph, lo, hi, open_sides ? 1u << 4 : 31u, open_sides ? 3u : 0u));
  PetscCall(SPHSetGravity(sph, g));
  PetscCall(Fill(sph, n, dx));
  ByCall(SPHSetUp(sph));
  if (pack) ByCall(SPHPack(sph, 1e-3, 50, NULL, NULL));
  run.walls   = (PetscBool)!open_sides;
  run.deepest = 1.0;
  run.g     = 9.81;
  for (int k = 0; k < 3; k++) run.gauge[k] = 0.25 * (k + 1);
  for (int k = 0; k < 2; k++) run.hi[k] = hi[k];
  PetscCall(SPHGetMass(sph, &particle_mass));
  run.area  = hi[0] * hi[1];
  run.depth = n[0] * n[1] * n[2] * particle_mass / par->density / run.area;
  while (time < end) {
    ByCall(Step(sph, &run, &time, from));
    if (!quiet && time >= next) {
      SPHStats  s;
      PetscReal f[18], error, height;

      PetscCall(SPHGetStats(sph, &s));
      PetscCall(SPHGetWallForces(sph, f));
      PetscCall(Measure(sph, &run, &error, &height));
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "t %.3f dt %.2e E %.4f it %d floor %.4f rms %.4f max %.3f comp %.1e %.1e offset %.3f p error %.3f\n", (double)time, (double)(time / run.n_steps), (double)((s.kinetic + s.potential) / run.energy), (int)s.iterations,
                            (double)(f[14] / (-particle_mass * n[0] * n[1] * n[2] * run.g)), (double)(s.speed_rms / sqrt(run.g * run.depth)), (double)s.speed_max, (double)s.compression_mean, (double)s.compression_max,
                            (double)((height - 0.5 * run.depth) / dx), (double)error));
      next += end / 20;
    }
  }
  run.force_sum = -run.force_sum;
  PetscCall(Report(sph, &run, time, from));
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
