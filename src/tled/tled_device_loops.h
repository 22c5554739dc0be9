/* tled_device_loops.h - what one thread of a device does: the bodies of the loops of tled_cuda.cu as functions of the thread's number,
   for host and device, so that a machine without a device can run them one after the other and compare. Indices only: the formulas are
   those of tled_element.h, tled_t10.h and tled_material.h.

   A pass has a thread for each lane (an element; padding included), each node, or each average (of a node and a material). Its threads read what passes before it wrote and
   each writes places of its own, so that their order is of no effect: lanes write what they give to their nodes, then nodes and averages
   gather it from their lanes in ascending order. No atomics, the same bits every time. */
#ifndef BY_TLED_DEVICE_LOOPS_H
#define BY_TLED_DEVICE_LOOPS_H

#include "tled/tled_element.h"
#include "tled/tled_t10.h"

#define TLED_DEVICE_LANES 8 /* TLED_LANES: elements side by side in the structures of arrays */

/* What the threads read and write; lanes, packs and points are those of TLEDBlocks. */
typedef struct {
  int            n_lanes, n_nodes, n_laws;
  int            n_corners, n_points; /* nodes and integration points of an element                                  */
  const TLEDLaw *laws;                /* of each material, without Prony series                                      */
  const int     *material;            /* n_packs: number of the law                                                  */
  const int     *corner;              /* n_packs x n_corners x 8: node of each corner                                */
  const int     *first_point;         /* n_packs + 1, as in TLEDBlocks                                               */
  const int     *offset;              /* n_nodes + 1, into list                                                      */
  const int     *list;                /* corners n_corners lane + a of each node, ascending                          */
  const double  *G, *V0;              /* as in TLEDBlocks                                                            */
  const double  *fibre;               /* n_packs x 3 x 8; NULL: no law has fibres                                    */
  const double  *weight;              /* n_nodes x n_laws: 1/sum of V0 [1/m^3], 0 for none; anp only, like the next three */
  const double  *u;                   /* n_nodes x 3 [m]                                                             */
  double        *value;               /* n_lanes: V0 (J - 1) [m^3], then V0 pbar [N m]                               */
  double        *volume;              /* n_nodes x n_laws: J_a - 1 of the elements of each material                  */
  double        *pressure;            /* n_nodes x n_laws: q_a [Pa]                                                  */
  double        *corner_force;        /* n_lanes x n_corners x 3 [N]                                                 */
  double        *force;               /* n_nodes x 3 [N]                                                             */
} TLEDThreads;

/* the passes; those of an element, in order, are in tled_device.c */
enum {
  TLED_PASS_FORCES_T4,     /* lanes: corner_force                        */
  TLED_PASS_VOLUMES,       /* lanes: value, the changes of volume        */
  TLED_PASS_MEAN_VOLUME,   /* averages: volume                           */
  TLED_PASS_PRESSURES,     /* lanes: value, the pressures                */
  TLED_PASS_MEAN_PRESSURE, /* averages: pressure                         */
  TLED_PASS_FORCES_ANP,    /* lanes: corner_force                        */
  TLED_PASS_FORCES_T10,    /* lanes: corner_force                        */
  TLED_PASS_GATHER,        /* nodes: force                               */
  TLED_PASSES
};

/* Threads of a pass. */
BY_HD int TLEDPassSize(const TLEDThreads *t, int pass)
{
  if (pass == TLED_PASS_MEAN_VOLUME || pass == TLED_PASS_MEAN_PRESSURE) return t->n_nodes*t->n_laws;
  return pass == TLED_PASS_GATHER ? t->n_nodes : t->n_lanes;
}

/* n numbers of a lane of a group of eight (a pack; a Jacobian of a pack) */
BY_HD void TLEDThreadNumbers(const double from[], int n, int group, int lane, double to[])
{
  for (int k = 0; k < n; k++) to[k] = from[(n*group + k)*TLED_DEVICE_LANES + lane % TLED_DEVICE_LANES];
}

/* node of a corner of a lane */
BY_HD int TLEDThreadNode(const TLEDThreads *t, int lane, int corner)
{
  return t->corner[(t->n_corners*(lane / TLED_DEVICE_LANES) + corner)*TLED_DEVICE_LANES + lane % TLED_DEVICE_LANES];
}

/* sum over the corners of a four-node element of its material's averages, in the order of the CPU's loops */
BY_HD double TLEDThreadSum(const TLEDThreads *t, int lane, const double average[])
{
  const double *own = &average[t->material[lane / TLED_DEVICE_LANES]];

  return (own[t->n_laws*TLEDThreadNode(t, lane, 0)] + own[t->n_laws*TLEDThreadNode(t, lane, 1)])
       + (own[t->n_laws*TLEDThreadNode(t, lane, 2)] + own[t->n_laws*TLEDThreadNode(t, lane, 3)]);
}

/* gradients of the nodes 1 to 3 and displacement gradient of a four-node element; returns J - 1 */
BY_HD double TLEDThreadGradient(const TLEDThreads *t, int lane, double G[9], double H[9])
{
  const double *origin = &t->u[3*TLEDThreadNode(t, lane, 0)];
  double        d[9];

  for (int a = 1; a < 4; a++) Sub3(&t->u[3*TLEDThreadNode(t, lane, a)], origin, &d[3*(a - 1)]);
  TLEDThreadNumbers(t->G, 9, lane / TLED_DEVICE_LANES, lane, G);
  TLEDDisplacementGradient(d, G, H);
  return TLEDJacobianMinusOne(H);
}

/* stress of the law of a lane at the gradient H, jm1 = det F - 1 */
BY_HD void TLEDThreadStress(const TLEDThreads *t, int lane, const double H[9], double jm1, double P[9])
{
  const TLEDLaw *law  = &t->laws[t->material[lane / TLED_DEVICE_LANES]];
  const double   ln_J = law->law == TLED_LAW_NEO_HOOKEAN ? TLEDLogJacobian(jm1) : 0.0; /* the others do without */
  double         a[3] = {0.0, 0.0, 0.0};

  if (t->fibre) TLEDThreadNumbers(t->fibre, 3, lane / TLED_DEVICE_LANES, lane, a);
  TLEDStress(law, a, H, ln_J, 1.0 / (1.0 + jm1), P);
}

/* forces of a four-node element on its corners from its stress */
BY_HD void TLEDThreadStore(const TLEDThreads *t, int lane, const double P[9], const double G[9])
{
  double *to = &t->corner_force[12*lane], f[9];

  TLEDNodalForces(P, G, t->V0[lane], f);
  for (int i = 0; i < 3; i++) to[i] = -(f[i] + f[3 + i] + f[6 + i]);
  for (int k = 0; k < 9; k++) to[3 + k] = f[k];
}

/* forces of a four-node tetrahedron */
BY_HD void TLEDThreadForcesT4(const TLEDThreads *t, int lane)
{
  double       G[9], H[9], P[9];
  const double jm1 = TLEDThreadGradient(t, lane, G, H);

  TLEDThreadStress(t, lane, H, jm1, P);
  TLEDThreadStore(t, lane, P, G);
}

/* change of volume that an element of average nodal pressure gives to its nodes */
BY_HD void TLEDThreadVolume(const TLEDThreads *t, int lane)
{
  double G[9], H[9];

  t->value[lane] = t->V0[lane]*TLEDThreadGradient(t, lane, G, H);
}

/* pressure that an element of average nodal pressure gives to its nodes or, with `forces`, its forces */
BY_HD void TLEDThreadAverage(const TLEDThreads *t, int lane, int forces)
{
  double       G[9], H[9], Hbar[9], P[9];
  const double inv_J = 1.0 / (1.0 + TLEDThreadGradient(t, lane, G, H));
  const double jbar = 0.25*TLEDThreadSum(t, lane, t->volume), Jbar = 1.0 + jbar, r = TLEDAverageGradient(H, inv_J, Jbar, Hbar);

  TLEDThreadStress(t, lane, Hbar, jbar, P);
  const double pbar = TLEDAveragePressure(Hbar, P, Jbar);
  if (forces) {
    TLEDAverageStress(H, r, inv_J, Jbar, pbar, TLEDThreadSum(t, lane, t->pressure), P);
    TLEDThreadStore(t, lane, P, G);
  } else t->value[lane] = pbar*t->V0[lane];
}

/* forces of a ten-node tetrahedron: its integration points one after the other, for either rule */
BY_HD void TLEDThreadForcesT10(const TLEDThreads *t, int lane)
{
  const int     pack = lane / TLED_DEVICE_LANES;
  const double *origin = &t->u[3*TLEDThreadNode(t, lane, 0)];
  double        u[30], f[30], L[4], Jinv[9], slope[9], H[9], P[9], T[9], V0; /* u and f: component by component */

  for (int a = 0; a < 10; a++) {
    const double *from = &t->u[3*TLEDThreadNode(t, lane, a)];
    for (int i = 0; i < 3; i++) u[10*i + a] = from[i] - origin[i], f[10*i + a] = 0.0;
  }
  for (int q = 0; q < t->n_points; q++) {
    (void)TLEDQuadratureT10(t->n_points, q, L);
    for (int i = 0; i < 3; i++) TLEDSlopesT10(L, &u[10*i], &slope[3*i]);
    TLEDThreadNumbers(t->G, 9, TLEDJacobianNumber(t->first_point, pack, q), lane, Jinv);
    TLEDThreadNumbers(t->V0, 1, t->n_points*pack + q, lane, &V0);
    TLEDPushForwardT10(slope, Jinv, H);
    TLEDThreadStress(t, lane, H, TLEDJacobianMinusOne(H), P);
    TLEDPullBackT10(P, Jinv, V0, T);
    for (int i = 0; i < 3; i++) TLEDAddForcesT10(L, &T[3*i], &f[10*i]);
  }
  for (int k = 0; k < 30; k++) t->corner_force[30*lane + k] = f[10*(k % 3) + k / 3];
}

/* average k = n_laws node + material of the values of the node's lanes of this material; `factor` 1 for volumes, 1/4 for pressures */
BY_HD void TLEDThreadMean(const TLEDThreads *t, int k, double factor, double mean[])
{
  const int node = k / t->n_laws, material = k % t->n_laws;
  double    sum = 0.0;

  for (int i = t->offset[node]; i < t->offset[node + 1]; i++) {
    const int lane = t->list[i] / 4;
    if (t->material[lane / TLED_DEVICE_LANES] == material) sum += t->value[lane];
  }
  mean[k] = factor*t->weight[k]*sum;
}

/* force on a node */
BY_HD void TLEDThreadGather(const TLEDThreads *t, int node)
{
  double sum[3] = {0.0, 0.0, 0.0};

  for (int k = t->offset[node]; k < t->offset[node + 1]; k++)
    for (int i = 0; i < 3; i++) sum[i] += t->corner_force[3*t->list[k] + i];
  for (int i = 0; i < 3; i++) t->force[3*node + i] = sum[i];
}

/* Thread k of a pass. */
BY_HD void TLEDThread(const TLEDThreads *t, int pass, int k)
{
  switch (pass) {
  case TLED_PASS_FORCES_T4: TLEDThreadForcesT4(t, k); break;
  case TLED_PASS_VOLUMES: TLEDThreadVolume(t, k); break;
  case TLED_PASS_MEAN_VOLUME: TLEDThreadMean(t, k, 1.0, t->volume); break;
  case TLED_PASS_PRESSURES: TLEDThreadAverage(t, k, 0); break;
  case TLED_PASS_MEAN_PRESSURE: TLEDThreadMean(t, k, 0.25, t->pressure); break;
  case TLED_PASS_FORCES_ANP: TLEDThreadAverage(t, k, 1); break;
  case TLED_PASS_FORCES_T10: TLEDThreadForcesT10(t, k); break;
  default: TLEDThreadGather(t, k); break;
  }
}

#endif
