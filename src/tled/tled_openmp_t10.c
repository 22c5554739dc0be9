/* tled_openmp_t10.c - the loops over ten-node tetrahedra on the CPU: blocks over threads, packs of elements over vector lanes, the
   integration points of a pack one after the other. No formula here. */
#include "tled/tled_t10.h"
#include "tled/tled_lanes.h"

/* values of a pack of elements; H to ln_J are those of one integration point */
typedef struct {
  double d[27][L]; /* u_a - u_0 of the nodes a = 1 ... 9, row 3 (a - 1) + i */
  double f[30][L]; /* forces, row 3 a + i                                   */
  double H[9][L], jm1[L], ln_J[L];
} __attribute__((aligned(64))) Pack;

/* barycentric coordinates of the integration points */
typedef struct {
  double L4[TLED_T10_POINTS_FINE][4];
} Points;

static void SetPoints(int n_points, Points *points)
{
  for (int q = 0; q < n_points; q++) (void)TLEDQuadratureT10(n_points, q, points->L4[q]);
}

/* u_a - u_0 of each lane, and no forces yet */
static void LoadPack(const int local[], const Scratch *s, Pack *p)
{
  for (int l = 0; l < L; l += 4) {
    const Row o[4] = {s->u[local[l]], s->u[local[l + 1]], s->u[local[l + 2]], s->u[local[l + 3]]};
    for (int a = 1; a < 10; a++) {
      const int *n = local + a * L + l;
      RowsToLanes(s->u[n[0]] - o[0], s->u[n[1]] - o[1], s->u[n[2]] - o[2], s->u[n[3]] - o[3], &p->d[3 * a - 3][l],
                  &p->d[3 * a - 2][l], &p->d[3 * a - 1][l]);
    }
  }
  for (int k = 0; k < 30; k++)
    for (int l = 0; l < L; l++) p->f[k][l] = 0.0;
}

/* nine numbers of a lane */
INLINE void LaneMatrix(const double from[], int l, double to[9])
{
  for (int k = 0; k < 9; k++) to[k] = from[k * L + l];
}

/* displacement gradient and J - 1 of each lane at an integration point; returns how many lanes are broken */
INLINE int PointGradients(const double L4[4], const double Jinv[], Pack *p)
{
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    double slope[9], M[9], H[9];
    for (int i = 0; i < 3; i++) {
      const double u[10] = {0.0,            p->d[i][l],      p->d[3 + i][l],  p->d[6 + i][l],  p->d[9 + i][l],
                            p->d[12 + i][l], p->d[15 + i][l], p->d[18 + i][l], p->d[21 + i][l], p->d[24 + i][l]};
      TLEDSlopesT10(L4, u, &slope[3 * i]);
    }
    LaneMatrix(Jinv, l, M);
    TLEDPushForwardT10(slope, M, H);
    p->jm1[l] = TLEDJacobianMinusOne(H);
    for (int k = 0; k < 9; k++) p->H[k][l] = H[k];
  }
  return CountBroken(p->jm1);
}

/* add the forces of the stress at an integration point of one lane */
INLINE void AddPoint(const double P[9], const double L4[4], const double Jinv[], const double V0[], int l, Pack *p)
{
  double M[9], T[9];

  LaneMatrix(Jinv, l, M);
  TLEDPullBackT10(P, M, V0[l], T);
  for (int i = 0; i < 3; i++) {
    double f[10];
    for (int b = 0; b < 10; b++) f[b] = p->f[3 * b + i][l];
    TLEDAddForcesT10(L4, &T[3 * i], f);
    for (int b = 0; b < 10; b++) p->f[3 * b + i][l] = f[b];
  }
}

/* add the forces of an integration point of each lane */
INLINE void PointForces(const TLEDLaw *m, const double L4[4], const double Jinv[], const double V0[], const double fibre[], Pack *p)
{
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    double H[9], P[9], a[3];
    LaneMatrix(p->H[0], l, H);
    LaneFibre(fibre, l, a);
    TLEDStress(m, a, H, p->ln_J[l], 1.0 / (1.0 + p->jm1[l]), P);
    AddPoint(P, L4, Jinv, V0, l, p);
  }
}

/* forces of a pack at all integration points, for one law known to the compiler; returns how many points are broken */
INLINE int PackForces(int law, const TLEDLaw *material, const TLEDBlocks *b, int pack, const Points *points, Pack *p)
{
  const double *fibre  = b->fibre && law == TLED_LAW_TRANSVERSE ? b->fibre + 3 * L * pack : NULL;
  const TLEDLaw m      = KnownLaw(law, material);
  int           broken = 0;

  for (int q = 0; q < b->n_points; q++) {
    const int     place = (b->n_points * pack + q) * L;
    const double *Jinv = b->G + 9 * place, *V0 = b->V0 + place;
    broken += PointGradients(points->L4[q], Jinv, p);
    if (law == TLED_LAW_NEO_HOOKEAN) PackLogarithms(p->jm1, p->ln_J);
    PointForces(&m, points->L4[q], Jinv, V0, fibre, p);
  }
  return broken;
}

#define FORCES_OF(Law, number)                                                                                    \
  KERNEL int Forces##Law(const TLEDLaw *m, const TLEDBlocks *b, int pack, const Points *points, Pack *p)          \
  {                                                                                                               \
    return PackForces(number, m, b, pack, points, p);                                                             \
  }
FORCES_OF(NeoHookean, TLED_LAW_NEO_HOOKEAN)
FORCES_OF(StVenantKirchhoff, TLED_LAW_ST_VENANT_KIRCHHOFF)
FORCES_OF(NeoHookeanIso, TLED_LAW_NEO_HOOKEAN_ISO)
FORCES_OF(MooneyRivlin, TLED_LAW_MOONEY_RIVLIN)
FORCES_OF(Transverse, TLED_LAW_TRANSVERSE)

/* the same of a pack whose material has a Prony series */
KERNEL int ForcesViscous(const TLEDLoops *w, int pack, const Points *points, Pack *p)
{
  const TLEDBlocks *b = w->blocks;
  double            P_of[9][L] __attribute__((aligned(64)));
  int               broken = 0;

  for (int q = 0; q < b->n_points; q++) {
    const int     place = (b->n_points * pack + q) * L;
    const double *Jinv = b->G + 9 * place, *V0 = b->V0 + place;
    broken += PointGradients(points->L4[q], Jinv, p);
    TLEDViscousStress_OpenMP(w, pack, q, 1, p->H, P_of);
#pragma GCC ivdep
    for (int l = 0; l < L; l++) {
      double P[9];
      LaneMatrix(P_of[0], l, P);
      AddPoint(P, points->L4[q], Jinv, V0, l, p);
    }
  }
  return broken;
}

/* the same by the material of the pack */
static int PackForcesLaw(const TLEDLoops *w, int pack, const Points *points, Pack *p)
{
  const TLEDBlocks *b = w->blocks;
  const TLEDLaw    *m = &w->laws[b->material[pack]];

  if (m->n_prony) return ForcesViscous(w, pack, points, p);
  switch (m->law) {
  case TLED_LAW_NEO_HOOKEAN: return ForcesNeoHookean(m, b, pack, points, p);
  case TLED_LAW_ST_VENANT_KIRCHHOFF: return ForcesStVenantKirchhoff(m, b, pack, points, p);
  case TLED_LAW_NEO_HOOKEAN_ISO: return ForcesNeoHookeanIso(m, b, pack, points, p);
  case TLED_LAW_MOONEY_RIVLIN: return ForcesMooneyRivlin(m, b, pack, points, p);
  default: return ForcesTransverse(m, b, pack, points, p);
  }
}

/* add the forces of a pack to the block's nodes, node after node and lane after lane */
static void AddForces(const int local[], Pack *p, Scratch *s)
{
  for (int a = 0; a < 10; a++) {
    for (int l = 0; l < L; l += 4) {
      const int *n = local + a * L + l;
      AddLanesToRows(&p->f[3 * a][l], &p->f[3 * a + 1][l], &p->f[3 * a + 2][l], &s->f[n[0]], &s->f[n[1]], &s->f[n[2]], &s->f[n[3]]);
    }
  }
}

/* forces of all ten-node tetrahedra */
void TLEDForcesT10_OpenMP(const TLEDLoops *w, const double u[])
{
  const TLEDBlocks *b = w->blocks;
  Points            points;

  SetPoints(b->n_points, &points);
#pragma omp for schedule(static)
  for (int block = 0; block < b->n_blocks; block++) {
    Scratch s;
    Pack    p;
    int     broken = 0;
    LoadNodes(b, block, u, &s);
    ClearForces(b, block, &s);
    for (int pack = b->pack_offset[block]; pack < b->pack_offset[block + 1]; pack++) {
      const int *local = b->local + 10 * L * pack;
      LoadPack(local, &s, &p);
      broken += PackForcesLaw(w, pack, &points, &p);
      AddForces(local, &p, &s);
    }
    StoreBlock(b, block, &s, w->partial);
    w->status[block] = broken;
  }
}
