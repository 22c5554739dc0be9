/* tled_openmp.c - the element loops on the CPU: blocks over threads, packs of elements over vector lanes. No formula here.

   Every function may be called by all threads of a parallel region (the work is shared, with a barrier at the end) or outside one. */
#include "tled/tled_impl.h"
#include "tled/tled_element.h"
#include <omp.h>

#define L TLED_LANES

/* inlined without question: a vector loop has no calls, and constants handed in (the law) fold away */
#define INLINE static inline __attribute__((always_inline))

/* what a block works on: its nodes' values as structures of arrays, its forces with a padded row per node */
typedef struct {
  double u[3][TLED_BLOCK_NODES];
  double value[2][TLED_BLOCK_NODES];
  double f[TLED_BLOCK_NODES][4];
} Scratch;

/* values of a pack of elements */
typedef struct {
  double H[9][L], jm1[L], ln_J[L];
} Pack;

static void LoadNodes(const TLEDBlocks *b, int block, const double u[], Scratch *s)
{
  const int *node = b->node + b->node_offset[block], n = b->node_offset[block + 1] - b->node_offset[block];

  for (int a = 0; a < n; a++) {
    s->u[0][a] = u[3*node[a]];
    s->u[1][a] = u[3*node[a] + 1];
    s->u[2][a] = u[3*node[a] + 2];
  }
}

/* how many lanes are broken: det F <= 0 or NaN */
INLINE int CountBroken(const double jm1[])
{
  int broken = 0;

  for (int l = 0; l < L; l++) broken += !(jm1[l] > -1.0);
  return broken;
}

/* displacement gradient and J - 1 of each lane; returns how many lanes are broken */
static int PackGradients(const int local[], const double G[], const Scratch *s, Pack *p)
{
  const int *n0 = local, *n1 = local + L, *n2 = local + 2*L, *n3 = local + 3*L;

#pragma omp simd /* gathers: worth it here, though the compiler's cost model thinks not */
  for (int l = 0; l < L; l++) {
    const double x = s->u[0][n0[l]], y = s->u[1][n0[l]], z = s->u[2][n0[l]];
    const double d[9] = {s->u[0][n1[l]] - x, s->u[1][n1[l]] - y, s->u[2][n1[l]] - z, s->u[0][n2[l]] - x, s->u[1][n2[l]] - y,
                         s->u[2][n2[l]] - z, s->u[0][n3[l]] - x, s->u[1][n3[l]] - y, s->u[2][n3[l]] - z};
    const double g[9] = {G[l], G[L + l], G[2*L + l], G[3*L + l], G[4*L + l], G[5*L + l], G[6*L + l], G[7*L + l], G[8*L + l]};
    double       H[9];
    TLEDDisplacementGradient(d, g, H);
    p->jm1[l] = TLEDJacobianMinusOne(H);
    p->H[0][l] = H[0]; p->H[1][l] = H[1]; p->H[2][l] = H[2];
    p->H[3][l] = H[3]; p->H[4][l] = H[4]; p->H[5][l] = H[5];
    p->H[6][l] = H[6]; p->H[7][l] = H[7]; p->H[8][l] = H[8];
  }
  return CountBroken(p->jm1);
}

/* ln J of each lane: a series for all at once where it holds, as it nearly always does */
static void PackLogarithms(const double jm1[], double ln_J[])
{
  int far = 0;

  for (int l = 0; l < L; l++) far += !(fabs(jm1[l]) <= TLED_LOG_REACH);
  if (!far) {
#pragma GCC ivdep
    for (int l = 0; l < L; l++) ln_J[l] = TLEDLogSeries(jm1[l]);
  } else {
    for (int l = 0; l < L; l++) ln_J[l] = TLEDLogJacobian(jm1[l]);
  }
}

/* nodal forces of each lane, f[3 a + i] of the nodes a = 1, 2, 3 in rows 3 to 11, of node 0 in rows 0 to 2 */
INLINE void StoreForces(const double P[9], const double G[], const double V0[], int l, double f[12][L])
{
  const double g[9] = {G[l], G[L + l], G[2*L + l], G[3*L + l], G[4*L + l], G[5*L + l], G[6*L + l], G[7*L + l], G[8*L + l]};
  double       n[9];

  TLEDNodalForces(P, g, V0[l], n);
  f[0][l] = -(n[0] + n[3] + n[6]); f[1][l] = -(n[1] + n[4] + n[7]); f[2][l] = -(n[2] + n[5] + n[8]);
  f[3][l] = n[0]; f[4][l] = n[1];  f[5][l] = n[2];
  f[6][l] = n[3]; f[7][l] = n[4];  f[8][l] = n[5];
  f[9][l] = n[6]; f[10][l] = n[7]; f[11][l] = n[8];
}

INLINE void LaneGradient(const Pack *p, int l, double H[9])
{
  H[0] = p->H[0][l]; H[1] = p->H[1][l]; H[2] = p->H[2][l];
  H[3] = p->H[3][l]; H[4] = p->H[4][l]; H[5] = p->H[5][l];
  H[6] = p->H[6][l]; H[7] = p->H[7][l]; H[8] = p->H[8][l];
}

INLINE void PackForces(int law, const Pack *p, const double G[], const double V0[], double mu, double lambda, double f[12][L])
{
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    double H[9], P[9];
    LaneGradient(p, l, H);
    TLEDStress(law, H, p->ln_J[l], 1.0 / (1.0 + p->jm1[l]), mu, lambda, P);
    StoreForces(P, G, V0, l, f);
  }
}

/* add the forces of a pack to the block's nodes, lane after lane */
static void AddForces(const int local[], double f[12][L], Scratch *s)
{
  for (int l = 0; l < L; l++) {
    for (int a = 0; a < 4; a++) {
      double *to = s->f[local[a*L + l]];
      to[0] += f[3*a][l];
      to[1] += f[3*a + 1][l];
      to[2] += f[3*a + 2][l];
    }
  }
}

/* partial sums of the block's nodes to its slots, three numbers a node */
static void StoreBlock(const TLEDBlocks *b, int block, const Scratch *s, double partial[])
{
  const int first = b->node_offset[block], n = b->node_offset[block + 1] - first;

  for (int a = 0; a < n; a++)
    for (int k = 0; k < 3; k++) partial[3*(first + a) + k] = s->f[a][k];
}

static void ClearForces(const TLEDBlocks *b, int block, Scratch *s)
{
  const int n = b->node_offset[block + 1] - b->node_offset[block];

  for (int a = 0; a < n; a++) s->f[a][0] = s->f[a][1] = s->f[a][2] = s->f[a][3] = 0.0;
}

static void ForcesT4(const TLEDLoops *w, const double u[])
{
  const TLEDBlocks *b = w->blocks;

#pragma omp for schedule(static)
  for (int block = 0; block < b->n_blocks; block++) {
    Scratch s;
    Pack    p;
    double  f[12][L];
    int     broken = 0;
    LoadNodes(b, block, u, &s);
    ClearForces(b, block, &s);
    for (int pack = b->pack_offset[block]; pack < b->pack_offset[block + 1]; pack++) {
      const int    *local = b->local + 4*L*pack;
      const double *G = b->G + 9*L*pack, *V0 = b->V0 + L*pack;
      broken += PackGradients(local, G, &s, &p);
      if (w->law == TLED_LAW_NEO_HOOKEAN) {
        PackLogarithms(p.jm1, p.ln_J);
        PackForces(TLED_LAW_NEO_HOOKEAN, &p, G, V0, w->mu, w->lambda, f);
      } else PackForces(TLED_LAW_ST_VENANT_KIRCHHOFF, &p, G, V0, w->mu, w->lambda, f);
      AddForces(local, f, &s);
    }
    StoreBlock(b, block, &s, w->partial);
    w->status[block] = broken;
  }
}

/* a nodal average from the blocks' partial sums (column k of partial): value_a = weight_a sum, weight 1/sum of V0 */
static void GatherAverage(const TLEDLoops *w, double factor, double value[])
{
  const TLEDBlocks *b = w->blocks;

#pragma omp for schedule(static)
  for (int a = 0; a < b->n_nodes; a++) {
    double sum = 0.0;
    for (int k = b->slot_offset[a]; k < b->slot_offset[a + 1]; k++) sum += w->partial[3*b->slot[k]];
    value[a] = factor*w->weight[a]*sum;
  }
}

/* add one value per lane to the four nodes of each element */
static void AddValues(const int local[], const double value[], Scratch *s)
{
  for (int l = 0; l < L; l++)
    for (int a = 0; a < 4; a++) s->f[local[a*L + l]][0] += value[l];
}

static void LoadValues(const TLEDBlocks *b, int block, const double from[], double to[])
{
  const int *node = b->node + b->node_offset[block], n = b->node_offset[block + 1] - b->node_offset[block];

  for (int a = 0; a < n; a++) to[a] = from[node[a]];
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
      broken += PackGradients(b->local + 4*L*pack, b->G + 9*L*pack, &s, &p);
#pragma GCC ivdep
      for (int l = 0; l < L; l++) dV[l] = b->V0[L*pack + l]*p.jm1[l];
      AddValues(b->local + 4*L*pack, dV, &s);
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
  for (int l = 0; l < L; l++) sum[l] = factor*((value[local[l]] + value[local[L + l]]) + (value[local[2*L + l]] + value[local[3*L + l]]));
}

/* Stress of the averaged gradient: V0 pbar of each lane or, with `forces`, the forces with the nodal pressures of the lanes. ln_Jbar is used
   by the laws that need it. */
INLINE void PackAverage(int law, int forces, const TLEDLoops *w, const Pack *p, const double jbar[], const double nodal[], const double G[], const double V0[], double pbar[], double f[12][L])
{
  const double mu = w->mu, lambda = w->lambda;
  double       ln_Jbar[L] = {0.0};

  if (law == TLED_LAW_NEO_HOOKEAN) PackLogarithms(jbar, ln_Jbar);
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    const double Jbar = 1.0 + jbar[l], inv_J = 1.0 / (1.0 + p->jm1[l]);
    double       H[9], Hbar[9], P[9];
    LaneGradient(p, l, H);
    const double r = TLEDAverageGradient(H, inv_J, Jbar, Hbar);
    TLEDStress(law, Hbar, ln_Jbar[l], 1.0 / Jbar, mu, lambda, P);
    const double q = TLEDAveragePressure(Hbar, P, Jbar);
    if (forces) {
      TLEDAverageStress(H, r, inv_J, Jbar, q, nodal[l], P);
      StoreForces(P, G, V0, l, f);
    } else pbar[l] = q*V0[l];
  }
}

/* one pass of the average nodal pressure element: the pressures that elements pass to their nodes, or the forces */
INLINE void PassAverage(int law, int forces, const TLEDLoops *w, const double u[])
{
  const TLEDBlocks *b = w->blocks;

#pragma omp for schedule(static)
  for (int block = 0; block < b->n_blocks; block++) {
    Scratch s;
    Pack    p;
    double  f[12][L], jbar[L], pbar[L], nodal[L];
    LoadNodes(b, block, u, &s);
    LoadValues(b, block, w->nodal, s.value[0]);
    if (forces) LoadValues(b, block, w->pressure, s.value[1]);
    ClearForces(b, block, &s);
    for (int pack = b->pack_offset[block]; pack < b->pack_offset[block + 1]; pack++) {
      const int    *local = b->local + 4*L*pack;
      const double *G = b->G + 9*L*pack, *V0 = b->V0 + L*pack;
      (void)PackGradients(local, G, &s, &p);
      PackSum(local, s.value[0], 0.25, jbar);
      if (forces) {
        PackSum(local, s.value[1], 1.0, nodal);
        PackAverage(law, 1, w, &p, jbar, nodal, G, V0, pbar, f);
        AddForces(local, f, &s);
      } else {
        PackAverage(law, 0, w, &p, jbar, nodal, G, V0, pbar, f);
        AddValues(local, pbar, &s);
      }
    }
    StoreBlock(b, block, &s, w->partial);
  }
}

/* how many threads share the work: one for every TLED_THREAD_BLOCKS blocks; results do not depend on it */
int TLEDThreads_OpenMP(const TLEDLoops *w)
{
  const int wanted = w->blocks->n_blocks / TLED_THREAD_BLOCKS, most = omp_get_max_threads();

  return wanted < 1 ? 1 : wanted < most ? wanted : most;
}

/* Forces of all elements at displacement u [m] into the blocks' partial sums, and the blocks' status. */
void TLEDElementForces_OpenMP(const TLEDLoops *w, const double u[])
{
  if (w->anp) {
    TLEDNodalVolumes_OpenMP(w, u);
    if (w->law == TLED_LAW_NEO_HOOKEAN) PassAverage(TLED_LAW_NEO_HOOKEAN, 0, w, u);
    else PassAverage(TLED_LAW_ST_VENANT_KIRCHHOFF, 0, w, u);
    GatherAverage(w, 0.25, w->pressure);
    if (w->law == TLED_LAW_NEO_HOOKEAN) PassAverage(TLED_LAW_NEO_HOOKEAN, 1, w, u);
    else PassAverage(TLED_LAW_ST_VENANT_KIRCHHOFF, 1, w, u);
  } else ForcesT4(w, u);
}

/* Each node adds its blocks: f [N], n_nodes x 3. */
void TLEDGatherForces_OpenMP(const TLEDLoops *w, double f[])
{
  const TLEDBlocks *b = w->blocks;

#pragma omp for schedule(static)
  for (int a = 0; a < b->n_nodes; a++) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (int k = b->slot_offset[a]; k < b->slot_offset[a + 1]; k++)
      for (int i = 0; i < 3; i++) sum[i] += w->partial[3*b->slot[k] + i];
    for (int i = 0; i < 3; i++) f[3*a + i] = sum[i];
  }
}

/* 1 when an element is inverted or NaN in the forces last computed; no work sharing: every thread gets the answer */
int TLEDElementsBroken_OpenMP(const TLEDLoops *w)
{
  int broken = 0;

  for (int block = 0; block < w->blocks->n_blocks; block++) broken += w->status[block];
  return broken > 0;
}
