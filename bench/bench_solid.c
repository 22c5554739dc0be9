/* bench.solid - what an element and step of the solid cost, and what share of this machine that is.

     bench.solid [seconds] [-only ELEMENT] [-csv FILE]

   In one run: (1) what the machine can do, on one thread and on all: multiply-adds in registers (the arithmetic peak) and a triad a = b + s c
   over arrays far larger than the caches (the bandwidth); (2) nanoseconds per element and whole time step (forces, gathering, motion, works)
   for every element and law, on bars of 6 x 10 m x m x m tetrahedra made here: wall clock and processor time, the median of REPEATS repeats of
   `seconds` (default 0.3) each; beside it the worst energy error of those steps over the most energy that moved, since a step that blows up
   is fast too; (3) flops and bytes of an element and step, counted by hand below, and the shares that follow.

   Bytes are those that must move once a step when nothing stays in a cache: a bar that fits into the caches has a share of the bandwidth
   that says little, and it may exceed 1. Flops are those of the formulas, a division or root counted as one (by hand, and the same by
   running the functions on numbers that count). */
#include "bench_bar.h"
#include "bench_peak.h"
#include "tled/tled.h"
#include <omp.h>
#include <petsctime.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#define REPEATS 5

/* ---- flops, by the formulas of tled_element.h, tled_material.h and tled_step.h ----
   differences of corners 9 | H = sum d G 9 x 5 = 45 | J - 1: minors 9, determinant 11, sums 6 = 26 | ln J, series: 26 | nodal forces V0 P G 54,
   node 0 6 | adding to the block's nodes 12 */
#define FLOPS_H       (9 + 45)
#define FLOPS_J       26
#define FLOPS_LOG     26
#define FLOPS_FORCES  (54 + 6)
#define FLOPS_SCATTER 12
/* average pressure: volume ratio of the corners 4 | r = (Jbar/J)^(1/3) 37, Hbar 12 | pbar 22 | stress back: F 3, cofactor 27, c 2, 9 x 3 = 59 */
#define FLOPS_AVERAGE (4 + 37 + 12 + 22)
#define FLOPS_BACK    59
/* a node: about 33 a direction for both half kicks with their works, and 3 for each block that has it (taken as 2) */
#define FLOPS_NODE    (3 * 33 + 6)

/* ten nodes, four points: slopes of a direction 74, its forces 68; at a point: H 45, pull-back 54 */
#define FLOPS_T10       (3 * (74 + 68) + 3 * 10)
#define FLOPS_T10_POINT (45 + 54 + FLOPS_J)

/* stress of a law, as its function stands */
static const struct {
  const char *name;
  double      flops, logs; /* of the stress; 1: ln J is needed */
} laws[] = {
  {"neo_hookean",           62,  1}, /* 1/J 2, c 3, F 3, cofactor 27, P 27        */
  {"st_venant_kirchhoff",   105, 0}, /* E 45, S 12, F 3, P = F S 45               */
  {"neo_hookean_iso",       215, 0}, /* with J^(-1/3) 37                          */
  {"mooney_rivlin",         268, 0},
  {"transversely_isotropic", 400, 0},
};

/* ---- bytes ----
   an element: gradients 72, volume 8, corners 16; each block's slot of a node: partial force written and read 48, numbers 8; a node: u and v read
   and written 96, force written and read 48, external force 24, mass 8, place 24, displacement loaded by its blocks 48 */
#define BYTES_T4      (72 + 8 + 16)
/* of ten nodes, straight edges: one inverse Jacobian, weights of four points, corners */
#define BYTES_T10     (72 + 4 * 8 + 40)
#define SLOTS_A_NODE  2
#define BYTES_SLOT    56
#define BYTES_NODE    (96 + 48 + 24 + 8 + 24 + 48)

typedef struct {
  double flops, bytes; /* of an element and step */
} Work;

typedef struct {
  double wall, cpu; /* [s] */
} Clock;

typedef struct {
  double wall, cpu; /* ns per element and step, medians */
  double error;     /* of energy                        */
} Cost;

static Clock Now(void)
{
  struct rusage  usage;
  PetscLogDouble wall;

  (void)PetscTime(&wall);
  getrusage(RUSAGE_SELF, &usage);
  return (Clock){wall, (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) + 1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec)};
}

static int Compare(const void *a, const void *b) { return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b); }

static double Median(double x[], int n)
{
  qsort(x, (size_t)n, sizeof *x, Compare);
  return x[n / 2];
}

/* words of a KEY_CHOICE among the body's keys */
static const char *const *Choices(const char name[])
{
  for (const Key *key = TLEDKeys; key->name; key++) {
    if (!strcmp(key->name, name)) return key->choices;
  }
  return NULL;
}

static Work Count(int element, const char law[], PetscInt n_nodes, PetscInt n_tets)
{
  const double nodes = (double)n_nodes / (double)n_tets;
  Work         w     = {0.0, 0.0};

  for (size_t k = 0; k < sizeof laws / sizeof *laws; k++) {
    if (strcmp(laws[k].name, law)) continue;
    const double stress = laws[k].flops + FLOPS_LOG * laws[k].logs;

    if (element == TLED_ELEMENT_T4) w.flops = FLOPS_H + FLOPS_J + stress + FLOPS_FORCES + FLOPS_SCATTER;
    /* three passes: volumes; pressures; forces */
    if (element == TLED_ELEMENT_ANP) w.flops = 3 * (FLOPS_H + FLOPS_J) + 2 * (FLOPS_AVERAGE + stress) + 10 + 5 + 4 + FLOPS_BACK + FLOPS_FORCES + FLOPS_SCATTER;
    if (element == TLED_ELEMENT_T10) w.flops = FLOPS_T10 + 4 * (FLOPS_T10_POINT + stress);
  }
  w.bytes = element == TLED_ELEMENT_T10 ? BYTES_T10 : (element == TLED_ELEMENT_ANP ? 3 : 1) * BYTES_T4;
  w.bytes += nodes * (BYTES_NODE + (element == TLED_ELEMENT_ANP ? 3 : 1) * SLOTS_A_NODE * BYTES_SLOT);
  if (w.flops > 0.0) w.flops += nodes * FLOPS_NODE;
  return w;
}

/* E 3 MPa and nu, for laws without them the same at small strain; fibres along the bar */
static void SetConstants(TLEDMaterialParams *m, double poisson)
{
  const double young = 3e6, shear = young / (2.0 * (1.0 + poisson));

  m->poisson = poisson;
  if (m->material == TLED_MATERIAL_MOONEY_RIVLIN) {
    m->c10  = 0.35 * shear;
    m->c01  = 0.15 * shear;
    m->bulk = young / (3.0 * (1.0 - 2.0 * poisson));
    return;
  }
  m->young = young;
  if (m->material != TLED_MATERIAL_TRANSVERSELY_ISOTROPIC) return;
  m->fibre_stiffness = shear;
  m->fibre[0]        = 1.0;
}

static PetscErrorCode NewBody(const char mesh[], int element, int law, TLED *tled)
{
  TLEDParams     *p;
  const PetscReal g[3] = {0.0, 0.0, -9.81};

  PetscFunctionBegin;
  PetscCall(TLEDCreate(PETSC_COMM_SELF, "bar", tled));
  PetscCall(TLEDGetParams(*tled, &p));
  PetscCall(PetscStrncpy(p->mesh, mesh, sizeof p->mesh));
  p->elastic.density  = 1000.0;
  p->elastic.material = law;
  p->element          = element;
  SetConstants(&p->elastic, element == TLED_ELEMENT_ANP ? 0.45 : 0.3);
  PetscCall(PetscStrncpy(p->fixed.name[p->fixed.n++], "clamp", BY_NAME_MAX));
  PetscCall(TLEDSetGravity(*tled, g));
  ByCall(TLEDSetUp(*tled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one repeat: at least `seconds`, in calls of n steps */
static PetscErrorCode Repeat(TLED tled, PetscReal step, double seconds, Cost *cost, double *moving)
{
  const Clock start = Now();
  Clock       now;
  PetscInt    n_tets, n, steps = 0;
  TLEDStats   s;

  PetscFunctionBegin;
  PetscCall(TLEDGetSize(tled, NULL, &n_tets));
  do {
    ByCall(TLEDAdvance(tled, 20 * step, &n));
    steps += n;
    now = Now();
  } while (now.wall - start.wall < seconds);
  cost->wall = 1e9 * (now.wall - start.wall) / ((double)steps * (double)n_tets);
  cost->cpu  = 1e9 * (now.cpu - start.cpu) / ((double)steps * (double)n_tets);
  PetscCall(TLEDGetStats(tled, &s));
  *moving     = PetscMax(*moving, s.kinetic + s.strain);
  cost->error = PetscMax(cost->error, PetscAbsReal(s.kinetic + s.strain + s.gravity_potential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Measure(TLED tled, int threads, double seconds, Cost *cost)
{
  double    wall[REPEATS], cpu[REPEATS], moving = 0.0;
  PetscReal critical;

  PetscFunctionBegin;
  omp_set_num_threads(threads);
  ByCall(TLEDGetCriticalStep(tled, &critical));
  cost->error = 0.0;
  ByCall(TLEDAdvance(tled, 0.85 * critical * 20, NULL)); /* warm */
  for (int r = 0; r < REPEATS; r++) {
    ByCall(Repeat(tled, 0.85 * critical, seconds, cost, &moving));
    wall[r] = cost->wall;
    cpu[r]  = cost->cpu;
  }
  cost->wall = Median(wall, REPEATS);
  cost->cpu  = Median(cpu, REPEATS);
  cost->error /= moving;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PrintHeader(FILE *csv)
{
  printf("\n%-4s %-20s %9s %7s %9s %9s %6s %6s %8s %9s %8s %9s %9s\n", "", "law", "elements", "threads", "ns", "cpu ns", "flops", "bytes", "Gflop/s", "of peak", "GB/s",
         "of triad", "energy");
  if (csv) fprintf(csv, "element,law,elements,threads,ns,cpu_ns,flops,bytes,gflops,peak_share,gbytes,triad_share,energy_error\n");
}

static void PrintRow(FILE *csv, const char element[], const char law[], PetscInt n_tets, int threads, const Cost *c, Work w, const Peak *peak)
{
  const double gflops = w.flops / c->wall, gbytes = w.bytes / c->wall;
  const double peak_share = gflops / peak->gflops, triad_share = gbytes / peak->gbytes;

  printf("%-4s %-20s %9d %7d %9.2f %9.2f %6.0f %6.0f %8.2f %8.1f%% %8.2f %8.1f%% %9.1e\n", element, law, (int)n_tets, threads, c->wall, c->cpu, w.flops, w.bytes, gflops,
         100 * peak_share, gbytes, 100 * triad_share, c->error);
  fflush(stdout);
  if (csv) fprintf(csv, "%s,%s,%d,%d,%g,%g,%g,%g,%g,%g,%g,%g,%g\n", element, law, (int)n_tets, threads, c->wall, c->cpu, w.flops, w.bytes, gflops, peak_share, gbytes, triad_share, c->error);
}

/* assembly of the tangent, by itself: it runs on one thread */
static PetscErrorCode MeasureTangent(TLED tled, const char element[], PetscInt n_tets)
{
  Vec    u;
  Mat    K = NULL;
  double ns[REPEATS];

  PetscFunctionBegin;
  PetscCall(TLEDGetVectors(tled, &u, NULL, NULL));
  PetscCall(TLEDTangent(tled, u, &K)); /* makes the matrix */
  for (int r = 0; r < REPEATS; r++) {
    const Clock start = Now();

    PetscCall(TLEDTangent(tled, u, &K));
    ns[r] = 1e9 * (Now().wall - start.wall) / (double)n_tets;
  }
  printf("%-4s %-20s %9d %7s %9.0f\n", element, "tangent, assembled", (int)n_tets, "", Median(ns, REPEATS));
  PetscCall(MatDestroy(&K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* all laws of one element on one bar; on the largest bar the first law alone */
static PetscErrorCode MeasureBar(int element, int m, PetscBool all_laws, double seconds, const Peak peak[2], FILE *csv)
{
  const char *const *names = Choices("material"), *const *elements = Choices("element");
  const int          most = omp_get_num_procs();
  char               mesh[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(BarWrite(m, element > TLED_ELEMENT_ANP ? 2 : 1, mesh, sizeof mesh));
  for (int law = 0; names[law] && (all_laws || !law); law++) {
    TLED     tled;
    PetscInt n_nodes, n_tets;
    Work     work;

    ByCall(NewBody(mesh, element, law, &tled));
    PetscCall(TLEDGetSize(tled, &n_nodes, &n_tets));
    work = Count(element, names[law], n_nodes, n_tets);
    for (int t = 0; t < (most > 1 ? 2 : 1); t++) {
      Cost cost = {0.0, 0.0, 0.0};

      ByCall(Measure(tled, t ? most : 1, seconds, &cost));
      PrintRow(csv, elements[element], names[law], n_tets, t ? most : 1, &cost, work, &peak[t]);
    }
    if (m == 4) ByCall(MeasureTangent(tled, elements[element], n_tets));
    PetscCall(TLEDDestroy(&tled));
  }
  BarRemove(mesh);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Run(double seconds, const char only[], FILE *csv)
{
  static const int   bars[] = {4, 10, 20}; /* 3,840, 60,000 and 480,000 tetrahedra */
  const char *const *elements = Choices("element");
  Peak               peak[2];

  PetscFunctionBegin;
  PeakMeasure(peak);
  PrintHeader(csv);
  for (int element = TLED_ELEMENT_T4; elements[element]; element++) {
    if (only && strcmp(only, elements[element])) continue;
    for (int k = 0; k < 3; k++) {
      if (element > TLED_ELEMENT_ANP && bars[k] > 10) continue; /* of second order: 60,000 elements are as large as 480,000 of first */
      ByCall(MeasureBar(element, bars[k], (PetscBool)(bars[k] == 10), seconds, peak, csv));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscErrorCode ierr;
  double         seconds = 0.3;
  const char    *only    = NULL;
  FILE          *csv     = NULL;

  for (int i = 1; i < argc; i++) {
    if (!strcmp(argv[i], "-only") && i + 1 < argc) only = argv[++i];
    else if (!strcmp(argv[i], "-csv") && i + 1 < argc) csv = fopen(argv[++i], "w");
    else if (atof(argv[i]) > 0.0) seconds = atof(argv[i]);
    else {
      fprintf(stderr, "bench.solid [seconds] [-only ELEMENT] [-csv FILE]\n");
      return BY_EXIT_INPUT;
    }
  }
  ierr = PetscInitializeNoArguments();
  if (ierr) return BY_EXIT_FAILURE;
  ierr = Run(seconds, only, csv);
  if (csv) fclose(csv);
  if (PetscFinalize()) return BY_EXIT_FAILURE;
  return ierr == BY_ERR_INPUT ? BY_EXIT_INPUT : ierr ? BY_EXIT_FAILURE : BY_EXIT_DONE;
}
