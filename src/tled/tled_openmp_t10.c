/* tled_openmp_t10.c - the loops over ten-node tetrahedra on the CPU: blocks over threads, packs of elements over vector lanes, the
   integration points of a pack one after the other. No formula here. */
#include "tled/tled_t10.h"
#include "tled/tled_lanes.h"

/* values of a pack of elements; H to ln_J are those of one integration point */
typedef struct {
  double d[27][L];                 /* u_a - u_0 of the nodes a = 1 ... 9, row 3 (a - 1) + i       */
  double f[30][L];                 /* forces, row 3 a + i                                         */
  double T[TLED_T10_POINTS][9][L]; /* of a point the slopes of the displacements, then w P Jinv^T */
  double H[9][L], jm1[L], ln_J[L];
} __attribute__((aligned(64))) Pack;

/* u_a - u_0 of each lane */
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
}

/* nine numbers of a lane */
INLINE void LaneMatrix(const double from[], int l, double to[9])
{
  for (int k = 0; k < 9; k++) to[k] = from[k * L + l];
}

/* one component of u_a - u_0 of a lane */
INLINE void LaneComponent(const Pack *p, int i, int l, double u[10])
{
  u[0] = 0.0;
  for (int a = 1; a < 10; a++) u[a] = p->d[3 * (a - 1) + i][l];
}

/* slopes of the displacements at the four points */
INLINE void SlopesFour(Pack *p)
{
  for (int i = 0; i < 3; i++) {
#pragma GCC ivdep
    for (int l = 0; l < L; l++) {
      double u[10], slope[12];
      LaneComponent(p, i, l, u);
      TLEDSlopesFourT10(u, slope);
      for (int k = 0; k < 3; k++) {
        p->T[0][3 * i + k][l] = slope[k];
        p->T[1][3 * i + k][l] = slope[3 + k];
        p->T[2][3 * i + k][l] = slope[6 + k];
        p->T[3][3 * i + k][l] = slope[9 + k];
      }
    }
  }
}

/* forces of the four points on the nodes */
INLINE void ForcesFour(Pack *p)
{
  for (int i = 0; i < 3; i++) {
#pragma GCC ivdep
    for (int l = 0; l < L; l++) {
      double T[12], f[10];
      for (int k = 0; k < 3; k++) {
        T[k]     = p->T[0][3 * i + k][l];
        T[3 + k] = p->T[1][3 * i + k][l];
        T[6 + k] = p->T[2][3 * i + k][l];
        T[9 + k] = p->T[3][3 * i + k][l];
      }
      TLEDForcesFourT10(T, f);
      for (int a = 0; a < 10; a++) p->f[3 * a + i][l] = f[a];
    }
  }
}

/* slopes of the displacements at one point of another rule */
INLINE void SlopesAt(const double L4[4], double T[9][L], const Pack *p)
{
  for (int i = 0; i < 3; i++) {
#pragma GCC ivdep
    for (int l = 0; l < L; l++) {
      double u[10], slope[3];
      LaneComponent(p, i, l, u);
      TLEDSlopesT10(L4, u, slope);
      for (int k = 0; k < 3; k++) T[3 * i + k][l] = slope[k];
    }
  }
}

/* add the forces of that point on the nodes; the first one writes them */
INLINE void ForcesAt(const double L4[4], int first, double T[9][L], Pack *p)
{
  for (int i = 0; i < 3; i++) {
#pragma GCC ivdep
    for (int l = 0; l < L; l++) {
      const double t[3] = {T[3 * i][l], T[3 * i + 1][l], T[3 * i + 2][l]};
      double       f[10];
      for (int a = 0; a < 10; a++) f[a] = first ? 0.0 : p->f[3 * a + i][l];
      TLEDAddForcesT10(L4, t, f);
      for (int a = 0; a < 10; a++) p->f[3 * a + i][l] = f[a];
    }
  }
}

/* displacement gradient and J - 1 of each lane at an integration point from its slopes; returns how many lanes are broken */
INLINE int PointGradients(const double Jinv[], double T[9][L], Pack *p)
{
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    double slope[9], M[9], H[9];
    LaneMatrix(T[0], l, slope);
    LaneMatrix(Jinv, l, M);
    TLEDPushForwardT10(slope, M, H);
    p->jm1[l] = TLEDJacobianMinusOne(H);
    for (int k = 0; k < 9; k++) p->H[k][l] = H[k];
  }
  return CountBroken(p->jm1);
}

/* w P Jinv^T of one lane at an integration point */
INLINE void StorePoint(const double P[9], const double Jinv[], const double V0[], int l, double T[9][L])
{
  double M[9], t[9];

  LaneMatrix(Jinv, l, M);
  TLEDPullBackT10(P, M, V0[l], t);
  for (int k = 0; k < 9; k++) T[k][l] = t[k];
}

/* the stress of an integration point of each lane */
INLINE void PointStress(const TLEDLaw *m, const double Jinv[], const double V0[], const double fibre[], const Pack *p, double T[9][L])
{
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    double H[9], P[9], a[3];
    LaneMatrix(p->H[0], l, H);
    LaneFibre(fibre, l, a);
    TLEDStress(m, a, H, p->ln_J[l], 1.0 / (1.0 + p->jm1[l]), P);
    StorePoint(P, Jinv, V0, l, T);
  }
}

/* stresses of a material with a Prony series at one point of each lane, as PointStress() */
static void ViscousStress(const TLEDLoops *w, int pack, int point, const double Jinv[], const double V0[], Pack *p, double T[9][L])
{
  double P_of[9][L] __attribute__((aligned(64)));

  TLEDViscousStress_OpenMP(w, pack, point, 1, p->H, P_of);
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    double P[9];
    LaneMatrix(P_of[0], l, P);
    StorePoint(P, Jinv, V0, l, T);
  }
}

#define VISCOUS (-1) /* in place of a law: any, with a Prony series */

/* forces of a pack at all integration points, for one law known to the compiler; returns how many points are broken */
INLINE int PackForces(int law, const TLEDLoops *w, int pack, Pack *p)
{
  const TLEDBlocks *b      = w->blocks;
  const double     *fibre  = b->fibre && law == TLED_LAW_TRANSVERSE ? b->fibre + 3 * L * pack : NULL;
  const TLEDLaw     m      = KnownLaw(law, &w->laws[b->material[pack]]);
  const int         four   = b->n_points == TLED_T10_POINTS;
  int               broken = 0;

  if (four) SlopesFour(p);
  for (int q = 0; q < b->n_points; q++) {
    const double *Jinv = b->G + 9 * L * TLEDJacobianPlace(b, pack, q), *V0 = b->V0 + (b->n_points * pack + q) * L;
    double(*T)[L]      = p->T[four ? q : 0], L4[4];
    if (!four) {
      (void)TLEDQuadratureT10(b->n_points, q, L4);
      SlopesAt(L4, T, p);
    }
    broken += PointGradients(Jinv, T, p);
    if (law == VISCOUS) ViscousStress(w, pack, q, Jinv, V0, p, T);
    else {
      if (law == TLED_LAW_NEO_HOOKEAN) PackLogarithms(p->jm1, p->ln_J);
      PointStress(&m, Jinv, V0, fibre, p, T);
    }
    if (!four) ForcesAt(L4, q == 0, T, p);
  }
  if (four) ForcesFour(p);
  return broken;
}

#define FORCES_OF(Law, number) \
  KERNEL int Forces##Law(const TLEDLoops *w, int pack, Pack *p) { return PackForces(number, w, pack, p); }
FORCES_OF(NeoHookean, TLED_LAW_NEO_HOOKEAN)
FORCES_OF(StVenantKirchhoff, TLED_LAW_ST_VENANT_KIRCHHOFF)
FORCES_OF(NeoHookeanIso, TLED_LAW_NEO_HOOKEAN_ISO)
FORCES_OF(MooneyRivlin, TLED_LAW_MOONEY_RIVLIN)
FORCES_OF(Transverse, TLED_LAW_TRANSVERSE)
FORCES_OF(Viscous, VISCOUS)

/* the same by the material of the pack */
static int PackForcesLaw(const TLEDLoops *w, int pack, Pack *p)
{
  const TLEDLaw *m = &w->laws[w->blocks->material[pack]];

  if (m->n_prony) return ForcesViscous(w, pack, p);
  switch (m->law) {
  case TLED_LAW_NEO_HOOKEAN: return ForcesNeoHookean(w, pack, p);
  case TLED_LAW_ST_VENANT_KIRCHHOFF: return ForcesStVenantKirchhoff(w, pack, p);
  case TLED_LAW_NEO_HOOKEAN_ISO: return ForcesNeoHookeanIso(w, pack, p);
  case TLED_LAW_MOONEY_RIVLIN: return ForcesMooneyRivlin(w, pack, p);
  default: return ForcesTransverse(w, pack, p);
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
      broken += PackForcesLaw(w, pack, &p);
      AddForces(local, &p, &s);
    }
    StoreBlock(b, block, &s, w->partial);
    w->status[block] = broken;
  }
}
