/* densities that are known exactly: lattices, planes, periodic images; mass on its way through a periodic side */
#include "fluid.h"

#include "sph/sph_impl.h"

/* a periodic lattice has rest density everywhere, in both precisions and for both kernels */
static void FullLatticeHasRestDensity(void **state)
{
  const PetscReal dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {6 * dx, 5 * dx, 9 * dx};

  (void)state;
  for (int variant = 0; variant < 4; variant++) {
    SPH              sph = NewFluid(dx);
    SPHParams       *par;
    const PetscReal *rho;
    PetscInt         n;

    assert_petsc(SPHGetParams(sph, &par));
    par->precision = variant & 1;
    par->kernel    = variant / 2;
    par->support   = variant / 2 ? 2.5 : 2.0;
    assert_petsc(SPHSetDomain(sph, lo, hi, 0, 7));
    AddLattice(sph, 6, 5, 9, dx, 0.0, NULL);
    assert_petsc(SPHSetUp(sph));
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHPredict(sph, 1e-3));
    assert_petsc(SPHGetSize(sph, &n));
    assert_petsc(SPHGetState(sph, NULL, NULL, NULL, &rho, NULL));
    for (PetscInt i = 0; i < n; i++) assert_close(rho[i], RHO0, variant & 1 ? 1e-12 : 1e-6, RHO0); // round-off of the sum
    assert_petsc(SPHDestroy(&sph));
  }
}

/* lists against all pairs, with walls and periodic sides mixed */
static void ListsHoldEveryPairOnce(void **state)
{
  const PetscReal dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {4 * dx, 5 * dx, 7 * dx};
  SPH             sph = NewFluid(dx);
  PetscInt        n, found = 0, expected = 0;

  (void)state;
  assert_petsc(SPHSetDomain(sph, lo, hi, 1u << 4, 3));
  AddLattice(sph, 4, 5, 7, dx, 0.2, NULL);
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHGetSize(sph, &n));
  for (PetscInt i = 0; i < n; i++) {
    found += sph->loops.count[i];
    for (PetscInt j = 0; j < n; j++) {
      PetscReal r2 = 0.0;
      for (int k = 0; k < 3; k++) {
        PetscReal d = sph->x[3 * i + k] - sph->x[3 * j + k];
        if (k < 2) d -= hi[k] * rint(d / hi[k]);
        r2 += d * d;
      }
      expected += j != i && r2 < sph->h * sph->h;
    }
  }
  assert_int_equal(found, expected);
  assert_petsc(SPHDestroy(&sph));
}

/* a plane adds rho0 s lambda(d), two planes their union, and the gradient of both is that of the sum */
static void PlanesAddTheirUnion(void **state)
{
  const PetscReal dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1}, at[3] = {0.006, 0.5, 0.004}, e = 1e-7;
  PetscReal       rho[3] = {0, 0, 0}, G[3] = {0, 0, 0};

  (void)state;
  for (int shift = 0; shift < 3; shift++) {
    SPH              sph = NewFluid(dx);
    PetscReal        x[3] = {at[0] + (shift - 1) * e, at[1], at[2]};
    const PetscReal *r;

    assert_petsc(SPHSetDomain(sph, lo, hi, 63, 0));
    assert_petsc(SPHAddParticles(sph, 1, x, NULL));
    assert_petsc(SPHSetUp(sph));
    assert_petsc(SPHUpdateNeighbors(sph));
    assert_petsc(SPHPredict(sph, 1e-3));
    assert_petsc(SPHGetState(sph, NULL, NULL, NULL, &r, NULL));
    rho[shift] = r[0];
    if (shift == 1) {
      const PetscReal a = sph->wall_factor * SPHHalfSpace(0, at[0], sph->h), b = sph->wall_factor * SPHHalfSpace(0, at[2], sph->h);
      assert_close(r[0], sph->mass * SPHKernelW(0, 0.0, sph->h) + RHO0 * (a + b - a * b), 1e-12, RHO0);
      for (int k = 0; k < 3; k++) G[k] = sph->G[k];
    }
    assert_petsc(SPHDestroy(&sph));
  }
  assert_close((rho[2] - rho[0]) / (2 * e), G[0], 1e-6, G[0]); // difference of order e
  assert_true(G[1] == 0.0 && G[2] < 0.0);
}

/* a lattice that drifts through periodic sides stays a lattice: density, number, and unwrapped speed */
static void NothingIsLostThroughPeriodicSides(void **state)
{
  const PetscReal dx = 0.01, lo[3] = {-0.02, 0, 0.1}, hi[3] = {0.03, 0.05, 0.16}, velocity[3] = {0.7, -0.4, 0.3};
  SPH             sph = NewFluid(dx);
  SPHStats        stats;

  (void)state;
  assert_petsc(SPHSetDomain(sph, lo, hi, 0, 7));
  AddLattice(sph, 5, 5, 6, dx, 0.0, velocity);
  assert_petsc(SPHSetUp(sph));
  for (int step = 0; step < 60; step++) OneStep(sph, 5e-3);
  assert_petsc(SPHUpdateNeighbors(sph));
  assert_petsc(SPHPredict(sph, 5e-3));
  assert_petsc(SPHGetStats(sph, &stats));
  assert_close(stats.compression_max, 0.0, 1e-11, 1.0);
  for (int k = 0; k < 3; k++) assert_close(stats.momentum[k], 150 * sph->mass * velocity[k], 1e-12, 150 * sph->mass);
  for (int i = 0; i < 150; i++)
    for (int k = 0; k < 3; k++) assert_true(sph->x[3 * i + k] >= lo[k] && sph->x[3 * i + k] < hi[k]);
  assert_petsc(SPHDestroy(&sph));
}

/* gradients and density of the same lists at other positions are those of particles that were there all along; back again, the same bits */
static void MoveIsWhatTheSearchWouldFind(void **state)
{
  const PetscReal dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {0.08, 0.08, 0.08};
  SPH             a = NewFluid(dx), b = NewFluid(dx);
  PetscReal       x[3 * 512], moved[512], only[512], p[512], back[512];

  (void)state;
  for (int k = 0; k < 2; k++) {
    SPH sph = k ? b : a;
    assert_petsc(SPHSetDomain(sph, lo, hi, 0, 7));
    AddLattice(sph, 8, 8, 8, dx, 0.2, NULL);
    assert_petsc(SPHSetUp(sph));
    assert_petsc(SPHUpdateNeighbors(sph));
  }
  assert_true(a->id[100] == b->id[100]); // the same order

  // one third of a spacing along a wave that fits the box, less than the list's reach: only pairs at h, where W vanishes, come and go
  for (int i = 0; i < 512; i++) {
    for (int k = 0; k < 3; k++) x[3 * i + k] = a->x[3 * i + k] + 1e-4 * dx * sin(2.0 * PETSC_PI * a->x[3 * i + (k + 1) % 3] / 0.08);
    p[i] = sin(1.7 * (double)a->id[i]);
  }
  a->table->Density(&a->loops, x, only);
  a->table->SetPressure(&a->loops, p, NULL);
  a->table->Acceleration(&a->loops);
  a->table->GetVector(&a->loops, a->accel);
  a->table->Move(&a->loops, x, moved);
  a->table->Acceleration(&a->loops);
  a->table->GetVector(&a->loops, a->v_star);
  for (int i = 0; i < 512; i++)
    for (int k = 0; k < 3; k++) b->x[3 * i + k] = x[3 * i + k] < 0 ? x[3 * i + k] + 0.08 : x[3 * i + k] >= 0.08 ? x[3 * i + k] - 0.08 : x[3 * i + k];
  assert_true(b->table->Pairs(&b->loops, b->rho_pairs) == 0);
  b->table->SetPressure(&b->loops, p, NULL);
  b->table->Acceleration(&b->loops);
  b->table->GetVector(&b->loops, b->accel);
  PetscReal change = 0.0, scale = 0.0;
  for (int i = 0; i < 512; i++) {
    assert_true(only[i] == moved[i]);
    assert_close(moved[i], b->rho_pairs[i], 1e-9, RHO0); // W and its slope vanish at h
    for (int k = 0; k < 3; k++) {
      scale  = PetscMax(scale, PetscAbsReal(b->accel[3 * i + k]));
      change = PetscMax(change, PetscAbsReal(a->accel[3 * i + k] - b->accel[3 * i + k]));
    }
  }
  assert_true(change > 1e-5 * scale); // the move is seen
  for (int i = 0; i < 3 * 512; i++) assert_close(a->v_star[i], b->accel[i], 1e-7, scale);
  a->table->Move(&a->loops, a->x, back);
  a->table->Acceleration(&a->loops);
  a->table->GetVector(&a->loops, b->v_star);
  for (int i = 0; i < 512; i++) assert_true(back[i] == a->rho_pairs[i]);
  assert_petsc(SPHDestroy(&a));
  assert_petsc(SPHDestroy(&b));
}

CHECK_MAIN(cmocka_unit_test(MoveIsWhatTheSearchWouldFind), cmocka_unit_test(FullLatticeHasRestDensity), cmocka_unit_test(ListsHoldEveryPairOnce), cmocka_unit_test(PlanesAddTheirUnion),
           cmocka_unit_test(NothingIsLostThroughPeriodicSides))
