/* tled_energy.c - strain energy, volume and stretches of the body. Not part of the step: plain scalar
   loops over blocks, added block after block, so that the sums have the same bits for any number of threads. */
#include "tled/tled_impl.h"

/*
  TLEDStrain_Private - strain energy [J], current volume [m^3] and the extremes of deformation at displacement u

  Output Parameter (each may be NULL):
+ energy  - sum_e V0_e W; a part that is inside out, as the state at a breakdown may have some, has none
. volume  - sum_e V0_e J
- stretch - smallest det F, largest |F|^2 of all elements
*/
PetscErrorCode TLEDStrain_Private(TLED tled, const PetscReal u[], PetscReal *energy, PetscReal *volume, PetscReal stretch[2])
{
  const TLEDBlocks *b      = &tled->blocks;
  const TLEDLoops  *w      = &tled->loops;
  const PetscInt   *tets   = tled->mesh.tets;
  PetscReal         sum[2] = {0.0, 0.0}, extreme[2] = {PETSC_MAX_REAL, 0.0}, *part;

  PetscFunctionBegin;
  part = w->partial; /* four numbers fit: every block has at least four slots of three */
  TLEDKnowVolumes_Private(w, u);
#pragma omp parallel for schedule(static) num_threads(TLEDThreads_OpenMP(w))
  for (int block = 0; block < b->n_blocks; block++) {
    double q[4] = {0.0, 0.0, PETSC_MAX_REAL, 0.0};
    for (int k = TLED_LANES * b->n_points * b->pack_offset[block]; k < TLED_LANES * b->n_points * b->pack_offset[block + 1]; k++) {
      const int l = k / b->n_points;
      double    F2 = 3.0;
      TLEDPoint p;
      if (b->element[l] < 0) continue;
      TLEDPointAt_Private(w, tets, l, k % b->n_points, u, &p);
      const double J = 1.0 + p.jm1;
      for (int i = 0; i < 9; i++) F2 += p.H[i] * p.H[i];
      F2 += 2.0 * (p.H[0] + p.H[4] + p.H[8]);
      if (energy && J > 0.0) q[0] += p.V0 * TLEDLocalEnergy_Private(w, l, k % b->n_points, &p.law, p.seen);
      q[1] += p.V0 * J;
      q[2] = J < q[2] ? J : q[2];
      q[3] = F2 > q[3] ? F2 : q[3];
    }
    for (int k = 0; k < 4; k++) part[3 * b->node_offset[block] + k] = q[k];
  }
  for (int block = 0; block < b->n_blocks; block++) {
    const PetscReal *q = &part[3 * b->node_offset[block]];
    sum[0] += q[0], sum[1] += q[1];
    extreme[0] = PetscMin(extreme[0], q[2]);
    extreme[1] = PetscMax(extreme[1], q[3]);
  }
  if (energy) *energy = sum[0];
  if (volume) *volume = sum[1];
  if (stretch) stretch[0] = extreme[0], stretch[1] = extreme[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}
