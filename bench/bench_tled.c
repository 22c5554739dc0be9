/* bench.tled - the solid's speed, with its error beside it.

     bench.tled MESH.msh [seconds]

   For each element and law, on one thread and on all, for `seconds` (default 2) each: nanoseconds per element and time step (the
   whole step: forces, gathering, motion), the mean and the fastest 200 steps, which other programs on the machine lengthen least;
   beside it the same steps' energy error (the worst, over the most energy that moved), since a step that blows up is fast too. Last
   the tangent's assembly. The mesh is held at its group "clamp" or "root". */
#include "tled/tled.h"
#include <omp.h>
#include <petsctime.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const element_names[] = {"auto", "t4", "anp"}, *const law_names[] = {"neo_hookean", "st_venant_kirchhoff"};

static PetscErrorCode NewBody(const char mesh[], int element, int law, TLED *tled)
{
  TLEDParams     *p;
  const PetscReal g[3] = {0.0, 0.0, -9.81};
  FILE           *f    = fopen(mesh, "r");
  char            line[256];
  const char     *held = NULL;

  PetscFunctionBegin;
  while (f && !held && fgets(line, sizeof line, f))
    held = strstr(line, "\"clamp\"") ? "clamp" : strstr(line, "\"root\"") ? "root" : NULL;
  if (f) fclose(f);
  PetscCall(TLEDCreate(PETSC_COMM_SELF, "body", tled));
  PetscCall(TLEDGetParams(*tled, &p));
  PetscCall(PetscStrncpy(p->mesh, mesh, sizeof p->mesh));
  p->elastic.young    = 3e6;
  p->elastic.density  = 1000.0;
  p->elastic.poisson  = element == TLED_ELEMENT_ANP ? 0.45 : 0.3;
  p->element  = element;
  p->elastic.material = law;
  if (held) PetscCall(PetscStrncpy(p->fixed.name[p->fixed.n++], held, BY_NAME_MAX));
  PetscCall(TLEDSetGravity(*tled, g));
  ByCall(TLEDSetUp(*tled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* run for about `seconds`; ns per element and step, mean and fastest, and energy error */
static PetscErrorCode Measure(const char mesh[], int element, int law, int threads, double seconds, double ns[2], double *error)
{
  TLED           tled;
  TLEDStats      s;
  PetscInt       n_tets, n, steps = 0;
  PetscReal      dt, moving = 0.0, worst = 0.0;
  PetscLogDouble t0, t1, total           = 0.0;

  PetscFunctionBegin;
  omp_set_num_threads(threads);
  ByCall(NewBody(mesh, element, law, &tled));
  PetscCall(TLEDGetSize(tled, NULL, &n_tets));
  ByCall(TLEDGetCriticalStep(tled, &dt));
  ByCall(TLEDAdvance(tled, 0.9 * dt * 50, &n)); /* warm */
  ns[1] = PETSC_MAX_REAL;
  while (total < seconds) {
    PetscCall(PetscTime(&t0));
    ByCall(TLEDAdvance(tled, 0.9 * dt * 200, &n));
    PetscCall(PetscTime(&t1));
    ns[1] = PetscMin(ns[1], 1e9 * (t1 - t0) / ((double)n * (double)n_tets));
    total += t1 - t0;
    steps += n;
    PetscCall(TLEDGetStats(tled, &s));
    moving = PetscMax(moving, s.kinetic + s.strain);
    worst  = PetscMax(worst, PetscAbsReal(s.kinetic + s.strain + s.gravity_potential));
  }
  ns[0]  = 1e9 * total / ((double)steps * (double)n_tets);
  *error = worst / moving;
  PetscCall(TLEDDestroy(&tled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MeasureTangent(const char mesh[], double *ms)
{
  TLED           tled;
  Vec            u;
  Mat            K = NULL;
  PetscLogDouble t0, t1;

  PetscFunctionBegin;
  ByCall(NewBody(mesh, TLED_ELEMENT_T4, TLED_MATERIAL_NEO_HOOKEAN, &tled));
  PetscCall(TLEDGetVectors(tled, &u, NULL, NULL));
  PetscCall(TLEDTangent(tled, u, &K));
  PetscCall(PetscTime(&t0));
  for (int i = 0; i < 10; i++) PetscCall(TLEDTangent(tled, u, &K));
  PetscCall(PetscTime(&t1));
  *ms = 1e2 * (t1 - t0);
  PetscCall(MatDestroy(&K));
  PetscCall(TLEDDestroy(&tled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Run(const char mesh[], double seconds)
{
  const int threads = omp_get_max_threads();
  TLED      tled;
  PetscInt  n_nodes, n_tets;
  double    ms = 0.0;

  PetscFunctionBegin;
  ByCall(NewBody(mesh, TLED_ELEMENT_T4, 0, &tled));
  PetscCall(TLEDGetSize(tled, &n_nodes, &n_tets));
  PetscCall(TLEDDestroy(&tled));
  printf("%s: %d nodes, %d tetrahedra\n", mesh, (int)n_nodes, (int)n_tets);
  printf("%-8s %-20s %8s %24s %16s %14s\n", "element", "law", "threads", "ns per element and step", "fastest, ns", "energy error");
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    for (int law = 0; law < 2; law++) {
      for (int t = 1; t <= threads; t += threads > 1 ? threads - 1 : 1) {
        double ns[2] = {0.0, 0.0}, error = 0.0;
        ByCall(Measure(mesh, element, law, t, seconds, ns, &error));
        printf("%-8s %-20s %8d %24.1f %16.1f %14.1e\n", element_names[element], law_names[law], t, ns[0], ns[1], error);
        fflush(stdout);
      }
    }
  }
  ByCall(MeasureTangent(mesh, &ms));
  printf("tangent (t4): %.2f ms, %.0f ns per element\n", ms, 1e6 * ms / (double)n_tets);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscErrorCode ierr;

  if (argc < 2) {
    fprintf(stderr, "bench.tled MESH.msh [seconds]\n");
    return BY_EXIT_INPUT;
  }
  ierr = PetscInitializeNoArguments();
  if (ierr) return BY_EXIT_FAILURE;
  ierr = Run(argv[1], argc > 2 ? atof(argv[2]) : 2.0);
  if (PetscFinalize()) return BY_EXIT_FAILURE;
  return ierr == BY_ERR_INPUT ? BY_EXIT_INPUT : ierr ? BY_EXIT_FAILURE : BY_EXIT_DONE;
}
