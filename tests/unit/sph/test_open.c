/* Water enters and leaves: a uniform stream stays uniform, the books are right to a particle, a restart gives the same bits. */
#include <string.h>

#include "fluid.h"

#define DX   0.1
#define U    1.5
#define LAST 600 /* steps */

/* a stream through a box that repeats across: 1 x 0.4 x 0.4 m, its first particles displaced by up to jitter dx */
static SPH NewStream(PetscReal jitter)
{
  const PetscReal  min[3] = {0, 0, 0}, max[3] = {1.0, 0.4, 0.4}, v[3] = {U, 0, 0};
  SPHInflowParams  in;
  SPHOutflowParams out;
  SPH              sph = NewFluid(DX);

  assert_petsc(SPHSetDomain(sph, min, max, 0, 6));
  AddLattice(sph, 10, 4, 4, DX, jitter, v);
  assert_petsc(KeysSetDefaults(SPHInflowKeys, &in));
  assert_petsc(KeysSetDefaults(SPHOutflowKeys, &out));
  in.side     = 0;
  in.velocity = U;
  out.side    = 1;
  assert_petsc(SPHAddInflow(sph, "in", &in));
  assert_petsc(SPHAddOutflow(sph, "out", &out));
  assert_petsc(SPHSetUp(sph));
  return sph;
}

/* largest relative error of velocity, and of density, of the particles within the domain; how many there are */
static PetscInt Errors(SPH sph, PetscReal *velocity, PetscReal *density)
{
  const PetscReal *x, *v, *rho;
  PetscInt         n, inside = 0;

  assert_petsc(SPHGetSize(sph, &n));
  assert_petsc(SPHGetState(sph, &x, &v, NULL, &rho, NULL));
  *velocity = *density = 0.0;
  for (PetscInt i = 0; i < n; i++) {
    if (x[3 * i] < 0 || x[3 * i] > 1.0) continue;
    inside++;
    *velocity = fmax(*velocity, hypot(v[3 * i] - U, hypot(v[3 * i + 1], v[3 * i + 2])) / U);
    *density  = fmax(*density, fabs(rho[i] / RHO0 - 1));
  }
  return inside;
}

/* what enters is a perfect lattice, so that after the first flow-through nothing but round-off may disturb it; nor may it before */
static void stream_stays_uniform(void **state)
{
  SPH       sph = NewStream(0.0);
  PetscReal velocity, density, t = 0.0, entered, left;

  (void)state;
  for (int step = 0; step < LAST; step++) {
    OneStep(sph, 0.005);
    t += 0.005;
    const PetscInt n = Errors(sph, &velocity, &density);
    assert_close(velocity, 0.0, 1e-6, 1);
    assert_close(density, 0.0, 1e-6, 1); // double precision; the kernel's sum is exact on the lattice
    assert_in_range(n, 160 - 16, 160 + 16);
  }
  assert_petsc(SPHGetVolumes(sph, &entered, &left));
  assert_close(entered, U * t * 0.16, 0.51 * 16 * DX * DX * DX, 1); // half a layer
  assert_close(left, U * t * 0.16, 0.51 * 16 * DX * DX * DX, 1);
  assert_petsc(SPHDestroy(&sph));
}

/* a disturbance is carried out and leaves nothing behind */
static void disturbance_leaves(void **state)
{
  SPH       sph = NewStream(0.2);
  PetscReal velocity, density;

  (void)state;
  Errors(sph, &velocity, &density);
  for (int step = 0; step < LAST; step++) OneStep(sph, 0.005); // four and a half flow-throughs
  Errors(sph, &velocity, &density);
  assert_close(velocity, 0.0, 0.01, 1);
  assert_close(density, 0.0, 0.01, 1);
  assert_petsc(SPHDestroy(&sph));
}

/* particles made less particles taken out is the change of their number, and no id is there twice */
static void books_and_ids(void **state)
{
  SPH             sph = NewStream(0.1);
  const PetscInt *id;
  PetscInt        n0, n, n_flows, copy[1000];
  PetscReal       before[3], flows[3];

  (void)state;
  assert_petsc(SPHGetSize(sph, &n0));
  assert_petsc(SPHGetFlows(sph, &n_flows, before));
  assert_int_equal(n_flows, 3);
  for (int step = 0; step < 100; step++) {
    OneStep(sph, 0.01);
    assert_petsc(SPHGetSize(sph, &n));
    assert_petsc(SPHGetFlows(sph, &n_flows, flows));
    assert_int_equal(n - n0, (PetscInt)(flows[1] - before[1]) - (PetscInt)(flows[2] - before[2]));
    assert_int_equal((PetscInt)(flows[0] - before[0]), (PetscInt)(flows[1] - before[1])); // an id for each that is made
  }
  assert_true(flows[2] - before[2] > 100);
  assert_petsc(SPHGetState(sph, NULL, NULL, NULL, NULL, &id));
  memcpy(copy, id, sizeof(*id) * (size_t)n);
  assert_petsc(PetscSortInt(n, copy));
  for (PetscInt i = 1; i < n; i++) assert_true(copy[i] > copy[i - 1]);
  assert_petsc(SPHDestroy(&sph));
}

/* N steps, against N/2, saved into another fluid, and N/2 */
static void resume_gives_the_same_bits(void **state)
{
  SPH              a = NewStream(0.2), b = NewStream(0.0);
  PetscInt         n, n_b, n_flows;
  const PetscReal *x, *v, *p, *xb;
  const PetscInt  *id, *idb;
  PetscReal        internals[SPH_INTERNALS], flows[3];

  (void)state;
  for (int step = 0; step < 60; step++) OneStep(a, 0.01);
  assert_petsc(SPHGetSize(a, &n));
  assert_petsc(SPHGetState(a, &x, &v, &p, NULL, &id));
  assert_petsc(SPHSetState(b, n, id, x, v, p));
  assert_petsc(SPHGetInternals(a, internals));
  assert_petsc(SPHSetInternals(b, internals));
  assert_petsc(SPHGetFlows(a, &n_flows, flows));
  assert_petsc(SPHSetFlows(b, n_flows, flows));
  for (int step = 0; step < 60; step++) {
    OneStep(a, 0.01);
    OneStep(b, 0.01);
  }
  assert_petsc(SPHGetSize(a, &n));
  assert_petsc(SPHGetSize(b, &n_b));
  assert_int_equal(n, n_b);
  assert_petsc(SPHGetState(a, &x, NULL, NULL, NULL, &id));
  assert_petsc(SPHGetState(b, &xb, NULL, NULL, NULL, &idb));
  assert_memory_equal(x, xb, sizeof(*x) * 3 * (size_t)n);
  assert_memory_equal(id, idb, sizeof(*id) * (size_t)n);
  assert_petsc(SPHDestroy(&a));
  assert_petsc(SPHDestroy(&b));
}

/* a tap into nothing, at an angle: what has come out is flow rate times time, to a particle a column; it is dry after its volume */
static SPH NewTap(PetscReal volume, int profile)
{
  const PetscReal min[3] = {-5, -5, -5}, max[3] = {5, 5, 5}, direction[3] = {1, -2, 0.5};
  SPHSourceParams tap;
  SPH             sph = NewFluid(DX);

  assert_petsc(SPHSetDomain(sph, min, max, 0, 0));
  assert_petsc(KeysSetDefaults(SPHSourceKeys, &tap));
  for (int k = 0; k < 3; k++) tap.direction[k] = direction[k];
  tap.radius    = 0.35;
  tap.flow_rate = 0.5;
  tap.volume    = volume;
  tap.profile   = profile;
  assert_petsc(SPHAddSource(sph, "tap", &tap));
  assert_petsc(SPHSetUp(sph));
  return sph;
}

static void tap_gives_its_flow_rate(void **state)
{
  (void)state;
  for (int profile = 0; profile < 2; profile++) {
    SPH       sph = NewTap(0.0, profile);
    PetscReal t   = 0.0, entered, left;
    PetscInt  n, n_flows;
    PetscReal flows[2];

    assert_petsc(SPHGetSize(sph, &n));
    for (int step = 0; step < 100; step++) {
      OneStep(sph, 0.01);
      t += 0.01;
      assert_petsc(SPHGetVolumes(sph, &entered, &left));
      assert_close(entered, 0.5 * t, 0.51, 0.385 * DX); // half a layer of pi R^2 dx
    }
    assert_petsc(SPHGetFlows(sph, &n_flows, flows));
    assert_petsc(SPHGetSize(sph, &n));
    assert_int_equal(n, (PetscInt)flows[1]);
    assert_close(left, 0.0, 1e-15, 1);
    assert_petsc(SPHDestroy(&sph));
  }
}

static void tap_runs_dry(void **state)
{
  SPH       sph = NewTap(0.2, 0);
  PetscInt  n;
  PetscReal entered, left;

  (void)state;
  for (int step = 0; step < 100; step++) OneStep(sph, 0.01);
  assert_petsc(SPHGetSize(sph, &n));
  assert_petsc(SPHGetVolumes(sph, &entered, &left));
  assert_int_equal(n, 200);
  assert_close(entered, 0.2, 1e-12, 1);
  assert_petsc(SPHDestroy(&sph));
}

CHECK_MAIN(cmocka_unit_test(stream_stays_uniform), cmocka_unit_test(disturbance_leaves), cmocka_unit_test(books_and_ids), cmocka_unit_test(resume_gives_the_same_bits),
           cmocka_unit_test(tap_gives_its_flow_rate), cmocka_unit_test(tap_runs_dry))
