/* The forces on the device are those of the CPU, to the rounding that fused operations and another order of sums leave: every element,
   rule and law, several materials. Ends with status 77 (skipped) where there is no device or no CUDA in this build. */
#include "unit/tled/device.h"
#include "backend.h"

static void DeviceForces_AreTheCPUs(void **state)
{
  static const DeviceForces twice[] = {TLEDDeviceForces, TLEDDeviceForces};

  (void)state;
  CheckDeviceBodies(2, twice);
}

/* an unstructured mesh: nodes with many elements or few */
static void DeviceForces_OfALargerBody(void **state)
{
  static const DeviceForces twice[] = {TLEDDeviceForces, TLEDDeviceForces};

  (void)state;
  for (int element = TLED_ELEMENT_T4; element <= TLED_ELEMENT_ANP; element++) {
    TLEDParams *p;
    TLED        tled = NewBody("tests/meshes/beam_h2.msh", &p);
    p->element = element;
    assert_petsc(TLEDSetUp(tled));
    device_amplitude = 1.0;
    CheckDeviceForces(tled, "beam", 0, 2, twice);
    assert_petsc(TLEDDestroy(&tled));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(DeviceForces_AreTheCPUs), cmocka_unit_test(DeviceForces_OfALargerBody)};
  PetscInt                n_devices = 0;
  char                    name[256];

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (BackendGetDevice(&n_devices, name, sizeof name)) return 1;
  if (!BackendHasCUDA() || !n_devices) {
    printf("skipped: %s\n", BackendHasCUDA() ? "no CUDA device" : "built without CUDA");
    return PetscFinalize() ? 1 : 77;
  }
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed ? 1 : 0;
}
