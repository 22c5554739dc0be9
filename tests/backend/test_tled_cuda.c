/* The T4 forces on the device are those of the CPU, to the rounding that fused operations and another order of sums leave. Ends
   with status 77 (skipped) where there is no device or no CUDA in this build. */
#include "unit/tled/body.h"
#include "backend.h"
#include "tled/tled_device.h"

static void Bend(const PetscReal X[3], PetscReal u[3])
{
  u[0] = -0.3 * X[0] * X[2] + 0.02 * sin(9 * X[1]);
  u[1] = 0.05 * X[1] * X[0];
  u[2] = -0.25 * X[0] * X[0] + 0.03 * cos(7 * X[2]);
}

static void DeviceForces_AreTheCPUs(void **state)
{
  (void)state;
  for (int law = 0; law <= TLED_MATERIAL_TRANSVERSELY_ISOTROPIC; law++) {
    TLEDParams      *p;
    TLED             tled = NewBody("tests/meshes/beam_h2.msh", &p);
    TLEDDevice       device;
    Vec              u, f;
    const PetscReal *ua, *fa;
    PetscReal       *on_device, *again, top;
    PetscInt         n;

    p->elastic.material = law;
    if (law == TLED_MATERIAL_MOONEY_RIVLIN) p->elastic.young = 0.0, p->elastic.c10 = 4e5, p->elastic.c01 = 1.8e5;
    if (law == TLED_MATERIAL_TRANSVERSELY_ISOTROPIC) p->elastic.fibre_stiffness = 2e6, p->elastic.fibre[0] = p->elastic.fibre[2] = 1.0;
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDGetSize(tled, &n, NULL));
    assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
    assert_petsc(VecDuplicate(u, &f));
    SetVec(tled, u, Bend);
    assert_petsc(TLEDInternalForce(tled, u, f));
    assert_petsc(VecNorm(f, NORM_INFINITY, &top));
    assert_petsc(PetscMalloc2(3 * n, &on_device, 3 * n, &again));
    assert_petsc(TLEDDeviceCreate(tled, &device));
    assert_petsc(VecGetArrayRead(u, &ua));
    assert_petsc(TLEDDeviceForces(device, ua, on_device));
    assert_petsc(TLEDDeviceForces(device, ua, again));
    assert_petsc(VecRestoreArrayRead(u, &ua));
    assert_petsc(VecGetArrayRead(f, &fa));
    for (PetscInt k = 0; k < 3 * n; k++) assert_close(on_device[k], fa[k], 1e-13, top);
    assert_memory_equal(on_device, again, 3 * (size_t)n * sizeof *again);
    assert_petsc(VecRestoreArrayRead(f, &fa));
    assert_petsc(TLEDDeviceDestroy(&device));
    assert_petsc(PetscFree2(on_device, again));
    assert_petsc(VecDestroy(&f));
    assert_petsc(TLEDDestroy(&tled));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[]   = {cmocka_unit_test(DeviceForces_AreTheCPUs)};
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
