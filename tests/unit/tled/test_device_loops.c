/* The loops of the device, run without one: all threads of each pass one after the other on the CPU. They give the forces of the CPU's
   own loops, in whatever order the threads run; only the launch is left to backend/test_tled_cuda. */
#include "unit/tled/device.h"
#include <string.h>

/* what bodies the runs have met */
static int met_padding, met_curved, met_straight;

/* thread numbers in order, backwards, and scattered: k -> k s mod n with s prime to n */
typedef enum { FORWARD, BACKWARD, SCATTERED } Order;

static int CommonDivisor(int a, int b) { return b ? CommonDivisor(b, a % b) : a; }

static void Spoil(int n, double values[])
{
  for (int k = 0; k < n && values; k++) values[k] = NAN;
}

/* All threads of a pass. Before the first pass of an element all that passes write is NaN, so that nothing can be read before it is
   written, nor stay from an earlier run. */
static int RunPass(const TLEDThreads *t, int pass, Order order)
{
  const int n = TLEDPassSize(t, pass), n_packs = t->n_lanes / TLED_DEVICE_LANES;
  int       step = 7919;

  while (CommonDivisor(n, step) > 1) step++;
  if (pass == TLED_PASS_FORCES_T4 || pass == TLED_PASS_VOLUMES || pass == TLED_PASS_FORCES_T10) {
    Spoil(t->n_lanes, t->value);
    Spoil(t->n_laws * t->n_nodes, t->volume);
    Spoil(t->n_laws * t->n_nodes, t->pressure);
    Spoil(3 * t->n_corners * t->n_lanes, t->corner_force);
    Spoil(3 * t->n_nodes, t->force);
    met_padding += t->n_lanes > DEVICE_TETS && t->offset[t->n_nodes] == t->n_corners * DEVICE_TETS;
  }
  for (int pack = 0; pack < n_packs && pass == TLED_PASS_FORCES_T10; pack++)
    *(t->first_point[pack + 1] - t->first_point[pack] == 1 ? &met_straight : &met_curved) += 1;
  for (int k = 0; k < n; k++)
    TLEDThread(t, pass, order == FORWARD ? k : order == BACKWARD ? n - 1 - k : (int)((long long)k * step % n));
  return 0;
}

static int RunForward(const TLEDThreads *t, int pass) { return RunPass(t, pass, FORWARD); }
static int RunBackward(const TLEDThreads *t, int pass) { return RunPass(t, pass, BACKWARD); }
static int RunScattered(const TLEDThreads *t, int pass) { return RunPass(t, pass, SCATTERED); }

static PetscErrorCode Forward(TLEDDevice d, const PetscReal u[], PetscReal f[]) { return TLEDDeviceForcesOnHost(d, RunForward, u, f); }
static PetscErrorCode Backward(TLEDDevice d, const PetscReal u[], PetscReal f[]) { return TLEDDeviceForcesOnHost(d, RunBackward, u, f); }
static PetscErrorCode Scattered(TLEDDevice d, const PetscReal u[], PetscReal f[]) { return TLEDDeviceForcesOnHost(d, RunScattered, u, f); }

static void ThreadsInAnyOrder_GiveTheCPUsForces(void **state)
{
  static const DeviceForces orders[] = {Forward, Backward, Scattered, Forward};

  (void)state;
  CheckDeviceBodies(4, orders);
  assert_true(met_padding > 0 && met_curved > 0 && met_straight > 0);
}

/* a body of one pack that is not full, and one of a single law without fibres */
static void SmallBody_GivesTheCPUsForces(void **state)
{
  static const DeviceForces orders[] = {Forward, Scattered};

  (void)state;
  for (int k = 0; k < DEVICE_BODIES; k++) {
    const Block block = {.n = {1, 1, 1}, .size = {0.2, 0.2, 0.2}, .order = device_bodies[k].element == TLED_ELEMENT_T10 ? 2 : 1};
    TLEDParams *p;
    TLED        tled = NewBlock(&block, &p);
    p->element    = device_bodies[k].element;
    p->quadrature = device_bodies[k].quadrature;
    assert_petsc(TLEDSetUp(tled));
    RemoveBlock(p);
    device_amplitude = 1.0;
    CheckDeviceForces(tled, "one cell", 0, 2, orders);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* a material with a Prony series, here the second of two, is refused by name */
static void PronySeries_IsRefused(void **state)
{
  const Block        block = {.n = {2, 1, 1}, .size = {0.2, 0.1, 0.1}, .order = 1, .n_lower = 1};
  TLEDParams        *p;
  TLEDMaterialParams upper;
  TLED               tled   = NewBlock(&block, &p);
  TLEDDevice         device = NULL;
  const char        *text;
  char              *message = NULL;

  (void)state;
  upper = p->elastic;
  AddName(&upper.volumes, "upper");
  upper.prony_alpha.n = upper.prony_tau.n = 1;
  upper.prony_alpha.value[0] = 0.4, upper.prony_tau.value[0] = 0.1;
  assert_petsc(TLEDAddMaterial(tled, "viscous", &upper));
  assert_petsc(TLEDSetUp(tled));
  RemoveBlock(p);
  assert_petsc(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  const PetscErrorCode ierr = TLEDDeviceCreate(tled, &device);
  assert_petsc(PetscPopErrorHandler());
  assert_int_equal((int)ierr, PETSC_ERR_SUP);
  assert_null(device);
  assert_petsc(PetscErrorMessage(ierr, &text, &message));
  if (!strstr(message, "body.viscous has a Prony series")) fail_msg("the message is: %s", message);
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(ThreadsInAnyOrder_GiveTheCPUsForces), cmocka_unit_test(SmallBody_GivesTheCPUsForces),
           cmocka_unit_test(PronySeries_IsRefused))
