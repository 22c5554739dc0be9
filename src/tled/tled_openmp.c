/* tled_openmp.c - the element loops on the CPU: blocks over threads, packs of elements over vector lanes. No formula here.

   Every function may be called by all threads of a parallel region (the work is shared, with a barrier at the end) or outside. */
#include "tled/tled_lanes.h"
#include <omp.h>

/* values of a pack of elements */
typedef struct {
  double H[9][L], jm1[L], ln_J[L];
} __attribute__((aligned(64))) Pack;

/* u_a - u_0 of each lane for the corners a = 1, 2, 3, d[3 (a - 1) + i] */
INLINE void PackDifferences(const int local[], const Scratch *s, double d[9][L])
{
  for (int l = 0; l < L; l += 4) {
    const Row o[4] = {s->u[local[l]], s->u[local[l + 1]], s->u[local[l + 2]], s->u[local[l + 3]]};
    for (int a = 1; a < 4; a++) {
      const int *n = local + a * L + l;
      RowsToLanes(s->u[n[0]] - o[0], s->u[n[1]] - o[1], s->u[n[2]] - o[2], s->u[n[3]] - o[3], &d[3 * a - 3][l], &d[3 * a - 2][l],
                  &d[3 * a - 1][l]);
    }
  }
}

/* displacement gradient and J - 1 of each lane; returns how many lanes are broken */
INLINE int PackGradients(const int local[], const double G[], const Scratch *s, Pack *p)
{
  double e[9][L] __attribute__((aligned(64)));

  PackDifferences(local, s, e);
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    const double d[9] = {e[0][l], e[1][l], e[2][l], e[3][l], e[4][l], e[5][l], e[6][l], e[7][l], e[8][l]};
    const double g[9] = {G[l],         G[L + l],     G[2 * L + l], G[3 * L + l], G[4 * L + l],
                         G[5 * L + l], G[6 * L + l], G[7 * L + l], G[8 * L + l]};
    double       H[9];
    TLEDDisplacementGradient(d, g, H);
    p->jm1[l]  = TLEDJacobianMinusOne(H);
    p->H[0][l] = H[0];
    p->H[1][l] = H[1];
    p->H[2][l] = H[2];
    p->H[3][l] = H[3];
    p->H[4][l] = H[4];
    p->H[5][l] = H[5];
    p->H[6][l] = H[6];
    p->H[7][l] = H[7];
    p->H[8][l] = H[8];
  }
  return CountBroken(p->jm1);
}

/* nodal forces of each lane, f[3 a + i] of the nodes a = 1, 2, 3 in rows 3 to 11, of node 0 in rows 0 to 2 */
INLINE void StoreForces(const double P[9], const double G[], const double V0[], int l, double f[12][L])
{
  const double g[9] = {G[l],         G[L + l],     G[2 * L + l], G[3 * L + l], G[4 * L + l],
                       G[5 * L + l], G[6 * L + l], G[7 * L + l], G[8 * L + l]};
  double       n[9];

  TLEDNodalForces(P, g, V0[l], n);
  f[0][l]  = -(n[0] + n[3] + n[6]);
  f[1][l]  = -(n[1] + n[4] + n[7]);
  f[2][l]  = -(n[2] + n[5] + n[8]);
  f[3][l]  = n[0];
  f[4][l]  = n[1];
  f[5][l]  = n[2];
  f[6][l]  = n[3];
  f[7][l]  = n[4];
  f[8][l]  = n[5];
  f[9][l]  = n[6];
  f[10][l] = n[7];
  f[11][l] = n[8];
}

INLINE void LaneGradient(const Pack *p, int l, double H[9])
{
  H[0] = p->H[0][l];
  H[1] = p->H[1][l];
  H[2] = p->H[2][l];
  H[3] = p->H[3][l];
  H[4] = p->H[4][l];
  H[5] = p->H[5][l];
  H[6] = p->H[6][l];
  H[7] = p->H[7][l];
  H[8] = p->H[8][l];
}

/* forces of the lanes, f[3 a + i] */
INLINE void PackForces(int law, const TLEDLaw *material, const Pack *p, const double fibre[], const double G[], const double V0[],
                       double f[12][L])
{
  const TLEDLaw m = KnownLaw(law, material);

#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    double H[9], P[9], a[3];
    LaneGradient(p, l, H);
    LaneFibre(fibre, l, a);
    TLEDStress(&m, a, H, p->ln_J[l], 1.0 / (1.0 + p->jm1[l]), P);
    StoreForces(P, G, V0, l, f);
  }
}

#define FORCES_OF(Law, number)                                                                                                     \
  KERNEL void Forces##Law(const TLEDLaw *m, const Pack *p, const double fibre[], const double G[], const double V0[], double f[12][L]) \
  {                                                                                                                                \
    PackForces(number, m, p, fibre, G, V0, f);                                                                                     \
  }
FORCES_OF(NeoHookean, TLED_LAW_NEO_HOOKEAN)
FORCES_OF(StVenantKirchhoff, TLED_LAW_ST_VENANT_KIRCHHOFF)
FORCES_OF(NeoHookeanIso, TLED_LAW_NEO_HOOKEAN_ISO)
FORCES_OF(MooneyRivlin, TLED_LAW_MOONEY_RIVLIN)
FORCES_OF(Transverse, TLED_LAW_TRANSVERSE)

/* the same by the law of the pack */
INLINE void PackForcesLaw(const TLEDLaw *m, Pack *p, const double fibre[], const double G[], const double V0[], double f[12][L])
{
  switch (m->law) {
  case TLED_LAW_NEO_HOOKEAN:
    PackLogarithms(p->jm1, p->ln_J);
    ForcesNeoHookean(m, p, NULL, G, V0, f);
    break;
  case TLED_LAW_ST_VENANT_KIRCHHOFF: ForcesStVenantKirchhoff(m, p, NULL, G, V0, f); break;
  case TLED_LAW_NEO_HOOKEAN_ISO: ForcesNeoHookeanIso(m, p, NULL, G, V0, f); break;
  case TLED_LAW_MOONEY_RIVLIN: ForcesMooneyRivlin(m, p, NULL, G, V0, f); break;
  default: ForcesTransverse(m, p, fibre, G, V0, f); break;
  }
}

/* the same of a pack whose material has a Prony series */
static void PackViscousForces(const TLEDLoops *w, int pack, Pack *p, const double G[], const double V0[], double f[12][L])
{
  double P_of[9][L] __attribute__((aligned(64)));

  TLEDViscousStress_OpenMP(w, pack, 0, 1, p->H, P_of);
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    const double P[9] = {P_of[0][l], P_of[1][l], P_of[2][l], P_of[3][l], P_of[4][l], P_of[5][l], P_of[6][l], P_of[7][l], P_of[8][l]};
    StoreForces(P, G, V0, l, f);
  }
}

/* add the forces of a pack to the block's nodes, corner after corner and lane after lane */
INLINE void AddForces(const int local[], double f[12][L], Scratch *s)
{
  for (int a = 0; a < 4; a++) {
    for (int l = 0; l < L; l += 4) {
      const int *n = local + a * L + l;
      AddLanesToRows(&f[3 * a][l], &f[3 * a + 1][l], &f[3 * a + 2][l], &s->f[n[0]], &s->f[n[1]], &s->f[n[2]], &s->f[n[3]]);
    }
  }
}

/* forces of all four-node tetrahedra */
void TLEDForcesT4_OpenMP(const TLEDLoops *w, const double u[])
{
  const TLEDBlocks *b = w->blocks;

#pragma omp for schedule(static)
  for (int block = 0; block < b->n_blocks; block++) {
    Scratch s;
    Pack    p;
    double  f[12][L] __attribute__((aligned(64)));
    int     broken = 0;
    LoadNodes(b, block, u, &s);
    ClearForces(b, block, &s);
    for (int pack = b->pack_offset[block]; pack < b->pack_offset[block + 1]; pack++) {
      const int    *local = b->local + 4 * L * pack;
      const double *G = b->G + 9 * L * pack, *V0 = b->V0 + L * pack, *fibre = b->fibre ? b->fibre + 3 * L * pack : NULL;
      const TLEDLaw *m = &w->laws[b->material[pack]];
      broken += PackGradients(local, G, &s, &p);
      if (m->n_prony) PackViscousForces(w, pack, &p, G, V0, f);
      else PackForcesLaw(m, &p, fibre, G, V0, f);
      AddForces(local, f, &s);
    }
    StoreBlock(b, block, &s, w->partial);
    w->status[block] = broken;
  }
}

/* nodal averages, one for each material, from the blocks' partial sums: value = weight sum, weight 1/sum of V0 */
static void GatherAverage(const TLEDLoops *w, double factor, double value[])
{
  const TLEDBlocks *b = w->blocks;

#pragma omp for schedule(static)
  for (int a = 0; a < b->n_nodes; a++) {
    double *sum = &value[w->n_laws * a];
    for (int m = 0; m < w->n_laws; m++) sum[m] = 0.0;
    for (int k = b->slot_offset[a]; k < b->slot_offset[a + 1]; k++) sum[b->slot_material[b->slot[k]]] += w->partial[3 * b->slot[k]];
    for (int m = 0; m < w->n_laws; m++) sum[m] *= factor * w->weight[w->n_laws * a + m];
  }
}

/* add one value per lane to the four nodes of each element */
static void AddValues(const int local[], const double value[], Scratch *s)
{
  for (int l = 0; l < L; l++)
    for (int a = 0; a < 4; a++) s->f[local[a * L + l]][0] += value[l];
}

static void LoadValues(const TLEDLoops *w, int block, const double from[], double to[])
{
  const TLEDBlocks *b = w->blocks;
  const int        *node = b->node + b->node_offset[block], n = b->node_offset[block + 1] - b->node_offset[block];

  from += b->material[b->pack_offset[block]];
  for (int a = 0; a < n; a++) to[a] = from[w->n_laws * node[a]];
}

/* nodal volume ratios J_a - 1 */
void TLEDNodalVolumes_OpenMP(const TLEDLoops *w, const double u[])
{
  const TLEDBlocks *b = w->blocks;

#pragma omp for schedule(static)
  for (int block = 0; block < b->n_blocks; block++) {
    Scratch s;
    Pack    p;
    double  dV[L];
    int     broken = 0;
    LoadNodes(b, block, u, &s);
    ClearForces(b, block, &s);
    for (int pack = b->pack_offset[block]; pack < b->pack_offset[block + 1]; pack++) {
      broken += PackGradients(b->local + 4 * L * pack, b->G + 9 * L * pack, &s, &p);
#pragma GCC ivdep
      for (int l = 0; l < L; l++) dV[l] = b->V0[L * pack + l] * p.jm1[l];
      AddValues(b->local + 4 * L * pack, dV, &s);
    }
    StoreBlock(b, block, &s, w->partial);
    w->status[block] = broken;
  }
  GatherAverage(w, 1.0, w->nodal);
}

/* sum over the corners of each lane */
static void PackSum(const int local[], const double value[], double factor, double sum[])
{
#pragma GCC ivdep
  for (int l = 0; l < L; l++)
    sum[l] = factor * ((value[local[l]] + value[local[L + l]]) + (value[local[2 * L + l]] + value[local[3 * L + l]]));
}

/* Stress of the averaged gradient: V0 pbar of each lane or, with `forces`, the forces with the nodal pressures of the lanes.
   ln_Jbar is used by the laws that need it. */
INLINE void PackAverage(int law, int forces, const TLEDLaw *material, const Pack *p, const double jbar[], const double nodal[],
                        const double fibre[], const double G[], const double V0[], double pbar[], double f[12][L])
{
  double        ln_Jbar[L] = {0.0};
  const TLEDLaw m          = KnownLaw(law, material);

  if (law == TLED_LAW_NEO_HOOKEAN) PackLogarithms(jbar, ln_Jbar);
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    const double Jbar = 1.0 + jbar[l], inv_J = 1.0 / (1.0 + p->jm1[l]);
    double       H[9], Hbar[9], P[9], a[3];
    LaneGradient(p, l, H);
    LaneFibre(fibre, l, a);
    const double r = TLEDAverageGradient(H, inv_J, Jbar, Hbar);
    TLEDStress(&m, a, Hbar, ln_Jbar[l], 1.0 / Jbar, P);
    const double q = TLEDAveragePressure(Hbar, P, Jbar);
    if (forces) {
      TLEDAverageStress(H, r, inv_J, Jbar, q, nodal[l], P);
      StoreForces(P, G, V0, l, f);
    } else pbar[l] = q * V0[l];
  }
}

#define AVERAGE_OF(Law, number)                                                                                                    \
  KERNEL void AverageForces##Law(const TLEDLaw *m, const Pack *p, const double jbar[], const double nodal[], const double fibre[], \
                                 const double G[], const double V0[], double f[12][L])                                             \
  {                                                                                                                                \
    PackAverage(number, 1, m, p, jbar, nodal, fibre, G, V0, NULL, f);                                                              \
  }                                                                                                                                \
  KERNEL void AveragePressure##Law(const TLEDLaw *m, const Pack *p, const double jbar[], const double fibre[], const double V0[],  \
                                   double pbar[])                                                                                  \
  {                                                                                                                                \
    PackAverage(number, 0, m, p, jbar, NULL, fibre, NULL, V0, pbar, NULL);                                                         \
  }
AVERAGE_OF(NeoHookean, TLED_LAW_NEO_HOOKEAN)
AVERAGE_OF(StVenantKirchhoff, TLED_LAW_ST_VENANT_KIRCHHOFF)
AVERAGE_OF(NeoHookeanIso, TLED_LAW_NEO_HOOKEAN_ISO)
AVERAGE_OF(MooneyRivlin, TLED_LAW_MOONEY_RIVLIN)
AVERAGE_OF(Transverse, TLED_LAW_TRANSVERSE)

/* the forces by the law of the pack */
INLINE void AverageForcesLaw(const TLEDLaw *m, const Pack *p, const double jbar[], const double nodal[], const double fibre[],
                             const double G[], const double V0[], double f[12][L])
{
  switch (m->law) {
  case TLED_LAW_NEO_HOOKEAN: AverageForcesNeoHookean(m, p, jbar, nodal, NULL, G, V0, f); break;
  case TLED_LAW_ST_VENANT_KIRCHHOFF: AverageForcesStVenantKirchhoff(m, p, jbar, nodal, NULL, G, V0, f); break;
  case TLED_LAW_NEO_HOOKEAN_ISO: AverageForcesNeoHookeanIso(m, p, jbar, nodal, NULL, G, V0, f); break;
  case TLED_LAW_MOONEY_RIVLIN: AverageForcesMooneyRivlin(m, p, jbar, nodal, NULL, G, V0, f); break;
  default: AverageForcesTransverse(m, p, jbar, nodal, fibre, G, V0, f); break;
  }
}

/* the pressures by the law of the pack */
INLINE void AveragePressureLaw(const TLEDLaw *m, const Pack *p, const double jbar[], const double fibre[], const double V0[],
                               double pbar[])
{
  switch (m->law) {
  case TLED_LAW_NEO_HOOKEAN: AveragePressureNeoHookean(m, p, jbar, NULL, V0, pbar); break;
  case TLED_LAW_ST_VENANT_KIRCHHOFF: AveragePressureStVenantKirchhoff(m, p, jbar, NULL, V0, pbar); break;
  case TLED_LAW_NEO_HOOKEAN_ISO: AveragePressureNeoHookeanIso(m, p, jbar, NULL, V0, pbar); break;
  case TLED_LAW_MOONEY_RIVLIN: AveragePressureMooneyRivlin(m, p, jbar, NULL, V0, pbar); break;
  default: AveragePressureTransverse(m, p, jbar, fibre, V0, pbar); break;
  }
}

/* Pressures (V0 pbar) or forces of a pack whose material has a Prony series; the histories go on with the forces. */
static void AverageViscous(int forces, const TLEDLoops *w, int pack, const Pack *p, const double jbar[], const double nodal[],
                           const double G[], const double V0[], double pbar[], double f[12][L])
{
  double Hbar_of[9][L] __attribute__((aligned(64))), P_of[9][L] __attribute__((aligned(64))), r_of[L];

  for (int l = 0; l < L; l++) {
    double H[9], Hbar[9];
    LaneGradient(p, l, H);
    r_of[l] = TLEDAverageGradient(H, 1.0 / (1.0 + p->jm1[l]), 1.0 + jbar[l], Hbar);
    for (int k = 0; k < 9; k++) Hbar_of[k][l] = Hbar[k];
  }
  TLEDViscousStress_OpenMP(w, pack, 0, forces, Hbar_of, P_of);
  for (int l = 0; l < L; l++) {
    double H[9], Hbar[9], P[9];
    LaneGradient(p, l, H);
    for (int k = 0; k < 9; k++) Hbar[k] = Hbar_of[k][l], P[k] = P_of[k][l];
    const double q = TLEDAveragePressure(Hbar, P, 1.0 + jbar[l]);
    if (forces) {
      TLEDAverageStress(H, r_of[l], 1.0 / (1.0 + p->jm1[l]), 1.0 + jbar[l], q, nodal[l], P);
      StoreForces(P, G, V0, l, f);
    } else pbar[l] = q * V0[l];
  }
}

/* one pass of the average nodal pressure element: the pressures that elements pass to their nodes, or the forces */
INLINE void PassAverage(int forces, const TLEDLoops *w, const double u[])
{
  const TLEDBlocks *b = w->blocks;

#pragma omp for schedule(static)
  for (int block = 0; block < b->n_blocks; block++) {
    Scratch s;
    Pack    p;
    double  f[12][L] __attribute__((aligned(64))), jbar[L], pbar[L], nodal[L];
    LoadNodes(b, block, u, &s);
    LoadValues(w, block, w->nodal, s.value[0]);
    if (forces) LoadValues(w, block, w->pressure, s.value[1]);
    ClearForces(b, block, &s);
    for (int pack = b->pack_offset[block]; pack < b->pack_offset[block + 1]; pack++) {
      const int    *local = b->local + 4 * L * pack;
      const double *G = b->G + 9 * L * pack, *V0 = b->V0 + L * pack, *fibre = b->fibre ? b->fibre + 3 * L * pack : NULL;
      const TLEDLaw *m = &w->laws[b->material[pack]];
      (void)PackGradients(local, G, &s, &p);
      PackSum(local, s.value[0], 0.25, jbar);
      if (forces) {
        PackSum(local, s.value[1], 1.0, nodal);
        if (m->n_prony) AverageViscous(1, w, pack, &p, jbar, nodal, G, V0, NULL, f);
        else AverageForcesLaw(m, &p, jbar, nodal, fibre, G, V0, f);
        AddForces(local, f, &s);
      } else {
        if (m->n_prony) AverageViscous(0, w, pack, &p, jbar, NULL, G, V0, pbar, NULL);
        else AveragePressureLaw(m, &p, jbar, fibre, V0, pbar);
        AddValues(local, pbar, &s);
      }
    }
    StoreBlock(b, block, &s, w->partial);
  }
}

/* how many threads share the work: one for so many blocks; results do not depend on it */
int TLEDThreads_OpenMP(const TLEDLoops *w)
{
  const int blocks = w->blocks->n_corners == 4 ? TLED_THREAD_BLOCKS : TLED_THREAD_BLOCKS_T10;
  const int wanted = w->blocks->n_blocks / blocks, most = omp_get_max_threads();

  return wanted < 1 ? 1 : wanted < most ? wanted : most;
}

/* forces of all tetrahedra of average nodal pressure */
void TLEDForcesANP_OpenMP(const TLEDLoops *w, const double u[])
{
  TLEDNodalVolumes_OpenMP(w, u);
  PassAverage(0, w, u);
  GatherAverage(w, 0.25, w->pressure);
  PassAverage(1, w, u);
}

/* Forces of all elements at displacement u [m] into the blocks' partial sums, and the blocks' status. */
void TLEDElementForces_OpenMP(const TLEDLoops *w, const double u[]) { w->ops->forces(w, u); }

/* Each node adds its blocks: f [N], n_nodes x 3. */
void TLEDGatherForces_OpenMP(const TLEDLoops *w, double f[])
{
  const TLEDBlocks *b = w->blocks;

#pragma omp for schedule(static)
  for (int a = 0; a < b->n_nodes; a++) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (int k = b->slot_offset[a]; k < b->slot_offset[a + 1]; k++)
      for (int i = 0; i < 3; i++) sum[i] += w->partial[3 * b->slot[k] + i];
    for (int i = 0; i < 3; i++) f[3 * a + i] = sum[i];
  }
}

/* 1 when an element is inverted or NaN in the forces last computed; no work sharing: every thread gets the answer */
int TLEDElementsBroken_OpenMP(const TLEDLoops *w)
{
  int broken = 0;

  for (int block = 0; block < w->blocks->n_blocks; block++) broken += w->status[block];
  return broken > 0;
}
