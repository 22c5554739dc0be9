/* projection with the compact Laplacian, corrected gradients and shifting (sph_isph.c, sph_shift.c) */
#include "fluid.h"

#include <string.h>

#include "mat3.h"
#include "sph/sph_impl.h"

/* a jittered closed box, n x n x n, ready for a solve */
static SPH Box(PetscInt n, PetscReal jitter, unsigned walls, unsigned periodic)
{
  const PetscReal dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {n * dx, n * dx, n * dx}, g[3] = {0, 0, -9.81};
  SPH             sph = NewFluid(dx);

  sph->params.solver       = SPH_SOLVER_ISPH;
  sph->params.free_surface = PETSC_FALSE;
  sph->params.tolerance    = 1e-9;
  assert_petsc(SPHSetDomain(sph, lo, hi, walls, periodic));
  assert_petsc(SPHSetGravity(sph, g));
  AddLattice(sph, n, n, n, dx, jitter, NULL);
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  return sph;
}

/* p . A q = A p . q, p . A p >= 0, A 1 = 0 and no row gains or loses: with images in six walls, edges and corners */
static void CompactOperatorIsSymmetricAndKeepsConstants(void **state)
{
  SPH       sph = Box(6, 0.2, 63, 0);
  PetscReal p[216], q[216], Ap[216], Aq[216], diagonal[216], pAq = 0, qAp = 0, pAp = 0, sum = 0, size = 0;

  (void)state;
  assert_petsc(SPHCompact_Internal(sph, diagonal));
  for (int i = 0; i < 216; i++) {
    p[i] = sin(1.7 * i);
    q[i] = cos(0.9 * i * i);
  }
  sph->table->SetPressure(&sph->loops, q, NULL);
  sph->table->Laplacian(&sph->loops, 1.0, NULL, Aq);
  sph->table->SetPressure(&sph->loops, p, NULL);
  sph->table->Laplacian(&sph->loops, 1.0, NULL, Ap);
  for (int i = 0; i < 216; i++) {
    pAq += p[i] * Aq[i];
    qAp += q[i] * Ap[i];
    pAp += p[i] * Ap[i];
    sum += Ap[i];
    size += PetscAbsReal(Ap[i]);
  }
  assert_close(pAq, qAp, 1e-12, pAp);
  assert_close(sum, 0.0, 1e-12, size);
  assert_true(pAp > 0);
  for (int i = 0; i < 216; i++) {
    p[i] = 3.0;
    assert_true(diagonal[i] > 0);
  }
  sph->table->SetPressure(&sph->loops, p, NULL);
  sph->table->Laplacian(&sph->loops, 1.0, NULL, Ap);
  for (int i = 0; i < 216; i++) assert_close(Ap[i], 0.0, 1e-14, 3.0 * diagonal[i]);
  assert_petsc(SPHDestroy(&sph));
}

/* velocity gradient of v = c + L x, to round-off, in disorder and in corners */
static void GradientsOfLinearFieldsAreExact(void **state)
{
  const PetscReal L[9] = {0.3, -1.2, 0.7, 2.0, 0.1, -0.4, 0.9, 0.5, -0.4};
  SPH             sph  = Box(5, 0.25, 63, 0);
  PetscReal       v[375], diagonal[125];

  (void)state;
  assert_petsc(SPHCompact_Internal(sph, diagonal));
  for (int i = 0; i < 125; i++)
    for (int a = 0; a < 3; a++) v[3 * i + a] = 0.7 + Dot3(L + 3 * a, sph->x + 3 * i);
  SPHVelocityGradient_Internal(sph, v);
  for (int i = 0; i < 125; i++)
    for (int k = 0; k < 9; k++) assert_close(sph->compact.velocity_gradient[9 * i + k], L[k], 1e-10, 2.0);
  assert_petsc(SPHDestroy(&sph));
}

/* a sheared periodic lattice has an even concentration: nothing is shifted, though |grad v| is not zero */
static void ShiftingKeepsALattice(void **state)
{
  SPH       sph = Box(6, 0.0, 0, 7);
  PetscReal x[648], v[648], diagonal[216];

  (void)state;
  for (int i = 0; i < 216; i++) sph->v[3 * i] = sin(2.0 * PETSC_PI * sph->x[3 * i + 1] / 0.06);
  memcpy(x, sph->x, sizeof(x));
  memcpy(v, sph->v, sizeof(v));
  assert_petsc(SPHCompact_Internal(sph, diagonal));
  assert_petsc(SPHShift_Internal(sph, 1e-3));
  for (int i = 0; i < 648; i++) {
    assert_close(sph->x[i], x[i], 1e-12, 0.01);
    assert_close(sph->v[i], v[i], 1e-12, 1.0);
  }
  assert_petsc(SPHDestroy(&sph));
}

CHECK_MAIN(cmocka_unit_test(CompactOperatorIsSymmetricAndKeepsConstants), cmocka_unit_test(GradientsOfLinearFieldsAreExact), cmocka_unit_test(ShiftingKeepsALattice))
