/* tled_energy.c - strain energy, volume and stretches of the body, and which element broke. Not part of the step: plain scalar
   loops over blocks, added block after block, so that the sums have the same bits for any number of threads. */
#include "tled/tled_impl.h"
#include "tled/tled_element.h"

/* displacement gradient of one element */
static void ElementGradient(const TLEDBlocks *b, int lane_of, const PetscInt tets[], const PetscReal u[], double H[9], double G[9])
{
  const int       pack = lane_of / TLED_LANES, lane = lane_of % TLED_LANES;
  const PetscInt *corner = &tets[4 * b->element[lane_of]];
  double          d[9];

  for (int k = 0; k < 9; k++) G[k] = b->G[(9 * pack + k) * TLED_LANES + lane];
  for (int a = 0; a < 3; a++) Sub3(&u[3 * corner[a + 1]], &u[3 * corner[0]], &d[3 * a]);
  TLEDDisplacementGradient(d, G, H);
}

/* energy density [J/m^3] of an element; `ratio` are the nodal J_a - 1 of the average nodal pressure element, NULL for the
   plain one */
static double EnergyDensity(const TLEDLoops *w, const double H[9], const PetscInt corner[4], const double ratio[])
{
  double Hbar[9], jbar = 0.0;

  if (!ratio) return TLEDEnergy(w->law, H, w->mu, w->lambda);
  for (int a = 0; a < 4; a++) jbar += 0.25 * ratio[corner[a]];
  (void)TLEDAverageGradient(H, 1.0 / (1.0 + TLEDJacobianMinusOne(H)), 1.0 + jbar, Hbar);
  return TLEDEnergy(w->law, Hbar, w->mu, w->lambda);
}

/*
  TLEDStrain_Private - strain energy [J], current volume [m^3] and the extremes of deformation at displacement u

  Output Parameter (each may be NULL):
+ energy  - sum_e V0_e W
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
  if (w->anp && energy) {
#pragma omp parallel num_threads(TLEDThreads_OpenMP(w))
    TLEDNodalVolumes_OpenMP(w, u);
  }
#pragma omp          parallel for schedule(static) num_threads(TLEDThreads_OpenMP(w))
  for (int block = 0; block < b->n_blocks; block++) {
             double q[4] = {0.0, 0.0, PETSC_MAX_REAL, 0.0}, H[9], G[9];
             for (int l = TLED_LANES * b->pack_offset[block]; l < TLED_LANES * b->pack_offset[block + 1]; l++) {
               double F2 = 3.0;
               if (b->element[l] < 0) continue;
      ElementGradient(b, l, tets, u, H, G);
               const double J = 1.0 + TLEDJacobianMinusOne(H);
               for (int k = 0; k < 9; k++) F2 += H[k] * H[k];
      F2 += 2.0 * (H[0] + H[4] + H[8]);
               if (energy) q[0] += b->V0[l] * EnergyDensity(w, H, &tets[4 * b->element[l]], w->anp ? w->nodal : NULL);
      q[1] += b->V0[l] * J;
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

/* Write the breakdown message: the first broken element in the file's numbers, its place and det F, the time. Returns
 * BY_ERR_BREAKDOWN. */
PetscErrorCode TLEDReportBroken_Private(TLED tled, const PetscReal u[], PetscReal time)
{
  const TLEDBlocks *b     = &tled->blocks;
  const TLEDMesh   *mesh  = &tled->mesh;
  PetscInt          first = -1, n_broken = 0;
  double            H[9], G[9], J_first = 0.0, x[3] = {0.0, 0.0, 0.0};

  PetscFunctionBegin;
  for (int l = 0; l < TLED_LANES * b->n_packs; l++) {
    if (b->element[l] < 0) continue;
    ElementGradient(b, l, mesh->tets, u, H, G);
    const double J = 1.0 + TLEDJacobianMinusOne(H);
    if (J > 0.0) continue;
    if (!n_broken++) first = b->element[l], J_first = J;
  }
  if (first < 0) {
    PetscCall(PetscSNPrintf(tled->breakdown, TLED_MESSAGE, "body %s: the internal forces are not finite at time %g s",
                            ((PetscObject)tled)->name, (double)time));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  for (int a = 0; a < 4; a++)
    for (int k = 0; k < 3; k++) x[k] += 0.25 * (mesh->X[3 * mesh->tets[4 * first + a] + k] + u[3 * mesh->tets[4 * first + a] + k]);
  PetscCall(PetscSNPrintf(
      tled->breakdown, TLED_MESSAGE,
      "body %s: element %" PetscInt_FMT " of the mesh file %s at (%.4g, %.4g, %.4g) m, time %.6g s: det F = %.3g (%" PetscInt_FMT
      " such elements)",
      ((PetscObject)tled)->name, mesh->tag[first], PetscIsNanReal(J_first) ? "is lost (not a number)" : "turned inside out", x[0],
      x[1], x[2], (double)time, J_first, n_broken));
  PetscFunctionReturn(BY_ERR_BREAKDOWN);
}
