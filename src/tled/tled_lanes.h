/* tled_lanes.h - what the element loops on the CPU share: the nodes of a block as vector registers, turned into lanes and back. No
   formula here. Only the files of these loops include it. */
#ifndef BY_TLED_LANES_H
#define BY_TLED_LANES_H

#include "tled/tled_impl.h"

#define L TLED_LANES

/* inlined without question: a vector loop has no calls, and constants handed in (the law) fold away */
#define INLINE static inline __attribute__((always_inline))
/* a function of its own with all that it calls inlined into it: the vector loop of one law */
#define KERNEL static __attribute__((noinline, flatten))

/* x, y, z of a node and a fourth number, as one vector register: corners are loaded and forces added a node at a time, and turned
   into lanes by transposition, which is cheaper than gathers of single numbers */
typedef double Row __attribute__((vector_size(32)));

/* what a block works on: its nodes' values and forces */
typedef struct {
  Row    u[TLED_BLOCK_NODES];
  Row    f[TLED_BLOCK_NODES];
  double value[2][TLED_BLOCK_NODES];
} Scratch;

static inline void LoadNodes(const TLEDBlocks *b, int block, const double u[], Scratch *s)
{
  const int *node = b->node + b->node_offset[block], n = b->node_offset[block + 1] - b->node_offset[block];

  for (int a = 0; a < n; a++) s->u[a] = (Row){u[3 * node[a]], u[3 * node[a] + 1], u[3 * node[a] + 2], 0.0};
}

/* how many lanes are broken: det F <= 0 or NaN */
INLINE int CountBroken(const double jm1[])
{
  int broken = 0;

  for (int l = 0; l < L; l++) broken += !(jm1[l] > -1.0);
  return broken;
}

/* x, y, z of four rows as lanes */
INLINE void RowsToLanes(Row r0, Row r1, Row r2, Row r3, double x[], double y[], double z[])
{
  typedef long long Pick __attribute__((vector_size(32)));
  const Row         xz01 = __builtin_shuffle(r0, r1, (Pick){0, 4, 2, 6}), y01 = __builtin_shuffle(r0, r1, (Pick){1, 5, 3, 7});
  const Row         xz23 = __builtin_shuffle(r2, r3, (Pick){0, 4, 2, 6}), y23 = __builtin_shuffle(r2, r3, (Pick){1, 5, 3, 7});

  *(Row *)x = __builtin_shuffle(xz01, xz23, (Pick){0, 1, 4, 5});
  *(Row *)y = __builtin_shuffle(y01, y23, (Pick){0, 1, 4, 5});
  *(Row *)z = __builtin_shuffle(xz01, xz23, (Pick){2, 3, 6, 7});
}

/* add x, y, z of four lanes to four rows; one after the other, since they may be the same row */
INLINE void AddLanesToRows(const double x[], const double y[], const double z[], Row *r0, Row *r1, Row *r2, Row *r3)
{
  typedef long long Pick __attribute__((vector_size(32)));
  const Row         X = *(const Row *)x, Y = *(const Row *)y, Z = *(const Row *)z, O = {0.0, 0.0, 0.0, 0.0};
  const Row         xy02 = __builtin_shuffle(X, Y, (Pick){0, 4, 2, 6}), xy13 = __builtin_shuffle(X, Y, (Pick){1, 5, 3, 7});
  const Row         z02 = __builtin_shuffle(Z, O, (Pick){0, 4, 2, 6}), z13 = __builtin_shuffle(Z, O, (Pick){1, 5, 3, 7});

  *r0 += __builtin_shuffle(xy02, z02, (Pick){0, 1, 4, 5});
  *r1 += __builtin_shuffle(xy13, z13, (Pick){0, 1, 4, 5});
  *r2 += __builtin_shuffle(xy02, z02, (Pick){2, 3, 6, 7});
  *r3 += __builtin_shuffle(xy13, z13, (Pick){2, 3, 6, 7});
}

/* ln J of each lane: a series for all at once where it holds, as it nearly always does */
static inline void PackLogarithms(const double jm1[], double ln_J[])
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

/* Unit vector along the fibres of a lane. */
INLINE void LaneFibre(const double fibre[], int l, double a[3])
{
  a[0] = fibre ? fibre[l] : 0.0;
  a[1] = fibre ? fibre[L + l] : 0.0;
  a[2] = fibre ? fibre[2 * L + l] : 0.0;
}

/* The law with its number known to the compiler. */
INLINE TLEDLaw KnownLaw(int law, const TLEDLaw *from)
{
  TLEDLaw m;

  m.law    = law;
  m.mu     = from->mu;
  m.lambda = from->lambda;
  m.kappa  = from->kappa;
  m.c10    = from->c10;
  m.c01    = from->c01;
  m.eta    = from->eta;
  return m;
}

/* partial sums of the block's nodes to its slots, three numbers a node */
static inline void StoreBlock(const TLEDBlocks *b, int block, const Scratch *s, double partial[])
{
  const int first = b->node_offset[block], n = b->node_offset[block + 1] - first;

  for (int a = 0; a < n; a++)
    for (int k = 0; k < 3; k++) partial[3 * (first + a) + k] = s->f[a][k];
}

static inline void ClearForces(const TLEDBlocks *b, int block, Scratch *s)
{
  const int n = b->node_offset[block + 1] - b->node_offset[block];

  for (int a = 0; a < n; a++) s->f[a] = (Row){0.0, 0.0, 0.0, 0.0};
}

#endif
