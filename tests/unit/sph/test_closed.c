/* projection with the compact Laplacian, corrected gradients and shifting (sph_isph.c, sph_shift.c) */
#include "fluid.h"

#include <omp.h>
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
  SPHVelocityGradient_Internal(sph, v, NULL);
  for (int i = 0; i < 125; i++)
    for (int k = 0; k < 9; k++) assert_close(sph->compact.velocity_gradient[9 * i + k], L[k], 1e-10, 2.0);
  assert_petsc(SPHDestroy(&sph));
}

/* a sheared periodic lattice has an even concentration: nothing is shifted, though |grad v| is not zero */
static void ShiftingKeepsALattice(void **state)
{
  SPH       sph = Box(10, 0.0, 0, 7);
  static PetscReal x[3000], v[3000], diagonal[1000];

  (void)state;
  for (int i = 0; i < 1000; i++) sph->v[3 * i] = sin(2.0 * PETSC_PI * sph->x[3 * i + 1] / 0.1);
  memcpy(x, sph->x, sizeof(x));
  memcpy(v, sph->v, sizeof(v));
  assert_petsc(SPHCompact_Internal(sph, diagonal));
  assert_petsc(SPHShift_Internal(sph, 1e-3));
  for (int i = 0; i < 3000; i++) {
    assert_close(sph->x[i], x[i], 1e-12, 0.01);
    assert_close(sph->v[i], v[i], 1e-12, 1.0);
  }
  assert_petsc(SPHDestroy(&sph));
}

/* Taylor-Green vortices, Re 100, 16 x 16 x 4 for 0.4 s: error 3 % measured, without shifting 38 %. Momentum is not conserved by construction: its drift,
   2e-3 of the largest speed measured, is held to 5e-3 */
static void VorticesDecayAsTheyShould(void **state)
{
  const PetscInt  n  = 16;
  const PetscReal dx = 1.0 / 16, lo[3] = {0, 0, 0}, hi[3] = {1, 1, 4 * dx}, k = 2.0 * PETSC_PI;
  SPH             sph = NewFluid(dx);
  PetscReal       t = 0, error = 0, size = 0, drift = 0;

  (void)state;
  sph->params.solver       = SPH_SOLVER_AUTO;
  sph->params.free_surface = PETSC_FALSE; // means isph
  sph->params.precision    = SPH_PRECISION_SINGLE;
  sph->params.viscosity    = 10.0;
  assert_petsc(SPHSetDomain(sph, lo, hi, 0, 7));
  AddLattice(sph, n, n, 4, dx, 0.0, NULL);
  for (PetscInt i = 0; i < n * n * 4; i++) {
    const PetscReal *x = sph->x + 3 * i;
    sph->v[3 * i]      = sin(k * x[0]) * cos(k * x[1]);
    sph->v[3 * i + 1]  = -cos(k * x[0]) * sin(k * x[1]);
  }
  assert_petsc(SPHSetUp(sph));
  while (t < 0.4) {
    PetscReal dt;
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHGetTimeStep(sph, &dt));
    assert_petsc(SPHPredict(sph, dt));
    assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
    assert_true(sph->converged);
    assert_petsc(SPHAdvance(sph, dt));
    t += dt;
  }
  for (PetscInt i = 0; i < sph->n; i++) {
    const PetscReal *x = sph->x + 3 * i, *v = sph->v + 3 * i, fall = exp(-8.0 * PETSC_PI * PETSC_PI * t / 100.0);
    const PetscReal  u[3] = {fall * sin(k * x[0]) * cos(k * x[1]), -fall * cos(k * x[0]) * sin(k * x[1]), 0};
    for (int a = 0; a < 3; a++) {
      error += PetscSqr(v[a] - u[a]);
      size += PetscSqr(u[a]);
    }
    drift += v[0] / sph->n;
  }
  assert_close(sqrt(error / size), 0.0, 0.05, 1.0);
  assert_close(drift, 0.0, 5e-3, 1.0);
  assert_petsc(SPHDestroy(&sph));
}

static void Steps(SPH sph, int n)
{
  for (int s = 0; s < n; s++) {
    PetscReal dt;
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHGetTimeStep(sph, &dt));
    assert_petsc(SPHPredict(sph, dt));
    assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
    assert_petsc(SPHAdvance(sph, dt));
  }
}

/* a box full to its lid: pressure gradient rho g, floor less lid is the weight, sides in balance. 1e-4 of rho g H measured, 0.3 % of the weight
   (a quadrature over the layers at the walls) */
static void FullBoxIsHydrostatic(void **state)
{
  SPH              sph = Box(8, 0.0, 63, 0);
  const PetscReal *f;
  PetscReal        weight, error = 0, mean = 0;

  (void)state;
  Steps(sph, 10);
  f      = sph->wall_force;
  weight = 512 * sph->mass * 9.81;
  assert_close(-(f[14] + f[17]), weight, 0.01, weight);
  assert_close(f[0] + f[3], 0.0, 1e-3, weight);
  for (int i = 0; i < 512; i++) mean += sph->x[3 * i + 2] / 512;
  for (int i = 0; i < 512; i++) error += PetscSqr(sph->p[i] + RHO0 * 9.81 * (sph->x[3 * i + 2] - mean)) / 512;
  assert_close(sqrt(error), 0.0, 2e-3, RHO0 * 9.81 * 0.08);
  assert_petsc(SPHDestroy(&sph));
}

/* a lattice that fills the box is packed as it is, though phi and its calibrated factor would press the first layer out of place */
static void PackingKeepsALattice(void **state)
{
  SPH       sph = Box(8, 0.0, 63, 0);
  PetscReal x[1536];
  PetscReal flux = sph->wall_flux, factor = sph->wall_factor;

  (void)state;
  memcpy(x, sph->x, sizeof(x));
  assert_petsc(SPHPack(sph, 1e-3, 100, NULL, NULL));
  for (int i = 0; i < 1536; i++) assert_close(sph->x[i], x[i], 1e-3, 0.01);
  assert_true(sph->wall_flux == flux && sph->wall_factor == factor);
  assert_petsc(SPHDestroy(&sph));
}

/* out += factor (g . p) g: what a wall without elasticity adds */
static PetscErrorCode Response(void *ctx, PetscInt n, const PetscReal p[], PetscReal Ap[])
{
  const PetscReal *g = (const PetscReal *)ctx;
  PetscReal        sum = 0;

  for (PetscInt i = 0; i < n; i++) sum += g[i] * p[i];
  for (PetscInt i = 0; i < n; i++) Ap[i] += sum * g[i];
  return 0;
}

/* with a compliant wall the solution of the compact system fulfils it, response included */
static void ResponseEntersTheProjection(void **state)
{
  SPH         sph = Box(6, 0.1, 63, 0);
  PetscReal   g[216], out[216];
  SPHOperator op = {1e-3, Response, g, PETSC_TRUE};

  (void)state;
  for (int i = 0; i < 216; i++) g[i] = sph->x[3 * i + 2] < 0.01 ? 1.0 : 0.0;
  sph->params.max_iterations = 2000;
  assert_petsc(SPHPredict(sph, 1e-3));
  assert_petsc(SPHSolvePressure(sph, 1e-3, Response, g));
  assert_true(sph->converged);
  assert_petsc(SPHApply_Internal(sph, &op, sph->y, out));
  for (int i = 0; i < 216; i++) assert_close((out[i] - sph->rhs[i]) * sph->root[i], 0.0, 1e-6, RHO0);
  assert_petsc(SPHDestroy(&sph));
}

/* the same bits with one and two threads, and after a restart */
static void ThreadsAndRestartsGiveTheSameBits(void **state)
{
  SPH              one = Box(8, 0.2, 63, 0), two = Box(8, 0.2, 63, 0), again = Box(8, 0.2, 63, 0);
  const PetscReal *x, *v, *p;
  const PetscInt  *id;
  PetscInt         n;
  PetscReal        internals[SPH_INTERNALS];

  (void)state;
  omp_set_num_threads(2);
  Steps(two, 6);
  omp_set_num_threads(1);
  Steps(one, 3);
  assert_petsc(SPHGetSize(one, &n));
  assert_petsc(SPHGetState(one, &x, &v, &p, NULL, &id));
  assert_petsc(SPHGetInternals(one, internals));
  assert_petsc(SPHSetState(again, n, id, x, v, p));
  assert_petsc(SPHSetInternals(again, internals));
  Steps(one, 3);
  Steps(again, 3);
  assert_memory_equal(one->x, two->x, sizeof(PetscReal) * 3 * 512);
  assert_memory_equal(one->p, two->p, sizeof(PetscReal) * 512);
  assert_memory_equal(one->x, again->x, sizeof(PetscReal) * 3 * 512);
  assert_memory_equal(one->p, again->p, sizeof(PetscReal) * 512);
  assert_petsc(SPHDestroy(&one));
  assert_petsc(SPHDestroy(&two));
  assert_petsc(SPHDestroy(&again));
}

CHECK_MAIN(cmocka_unit_test(CompactOperatorIsSymmetricAndKeepsConstants), cmocka_unit_test(GradientsOfLinearFieldsAreExact), cmocka_unit_test(ShiftingKeepsALattice),
           cmocka_unit_test(VorticesDecayAsTheyShould), cmocka_unit_test(FullBoxIsHydrostatic), cmocka_unit_test(PackingKeepsALattice), cmocka_unit_test(ResponseEntersTheProjection),
           cmocka_unit_test(ThreadsAndRestartsGiveTheSameBits))
