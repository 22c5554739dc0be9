/* The density and pressure passes on the device are those of the CPU, to what fused operations and another order of sums leave in single
   precision. Ends with status 77 (skipped) where there is no device or no CUDA in this build. */
#include "unit/sph/fluid.h"

#include <string.h>

#include "array.h"
#include "backend.h"
#include "sph/sph_cuda.h"
#include "sph/sph_impl.h"

#if defined(BYSSUS_HAVE_CUDA)
/* an array with a copy of `from` on the device (NULL: uninitialised); *p is its device address */
static void OnDevice(Array *array, size_t element, size_t n, const void *from, void *p)
{
  void *host;

  assert_petsc(ArrayCreate(element, n, array));
  if (from) {
    assert_petsc(ArrayHostOverwrite(array, &host));
    memcpy(host, from, element * n);
    assert_petsc(ArrayDeviceRead(array, p));
  } else {
    assert_petsc(ArrayDeviceOverwrite(array, p));
  }
}

static void DevicePassesAreTheCPUs(void **state)
{
  const PetscReal  dx = 0.01, lo[3] = {0, 0, 0}, hi[3] = {0.12, 0.1, 0.3};
  SPH              sph = NewFluid(dx);
  SPHLoops        *l   = &sph->loops;
  SPHDeviceList    list;
  Array            arrays[10];
  const double    *x;
  const float     *p, *G;
  float           *a;
  double          *density, *rate, *pressure, *expected, top = 0.0;
  const double    *result;
  int              n;
  size_t           slots;

  (void)state;
  sph->params.precision = SPH_PRECISION_SINGLE;
  assert_petsc(SPHSetDomain(sph, lo, hi, 12 | 16, 1));
  AddLattice(sph, 12, 10, 14, dx, 0.2, NULL);
  assert_petsc(SPHSetUp(sph));
  assert_petsc(SPHUpdateNeighbors(sph));
  n        = (int)sph->n;
  slots    = (size_t)((n + SPH_PAIR_CHUNK - 1) / SPH_PAIR_CHUNK) * SPH_PAIR_CHUNK * (size_t)l->capacity;
  pressure = (double *)malloc(sizeof(double) * (size_t)n);
  expected = (double *)malloc(sizeof(double) * (size_t)n);
  for (int i = 0; i < n; i++) pressure[i] = 1.0 + sin(0.1 * i);

  // the CPU: D (-D^T p)
  sph->table->SetPressure(l, pressure, NULL);
  sph->table->Acceleration(l);
  sph->table->Rate(l, -2.0, NULL, expected);

  list.n      = n;
  list.kernel = l->kernel;
  list.gradient_kernel = l->gradient_kernel;
  list.h      = l->h;
  list.mass   = l->mass;
  for (int k = 0; k < 3; k++) list.period[k] = l->grid.period[k];
  OnDevice(&arrays[0], sizeof(int), (size_t)n, l->start, &list.start);
  OnDevice(&arrays[1], sizeof(int), (size_t)n, l->count, &list.count);
  OnDevice(&arrays[2], sizeof(int), slots, l->neighbour, &list.neighbour);
  OnDevice(&arrays[3], sizeof(float), 3 * slots, NULL, &list.gradient);
  OnDevice(&arrays[4], sizeof(double), 3 * (size_t)n, sph->x, &x);
  OnDevice(&arrays[5], sizeof(double), (size_t)n, NULL, &density);
  OnDevice(&arrays[6], sizeof(float), (size_t)n, l->pressure, &p);
  OnDevice(&arrays[7], sizeof(float), 4 * (size_t)n, l->wall, &G);
  OnDevice(&arrays[8], sizeof(float), 4 * (size_t)n, NULL, &a);
  OnDevice(&arrays[9], sizeof(double), (size_t)n, NULL, &rate);
  assert_int_equal(SPHDensity_CUDA(&list, x, density), 0);
  assert_int_equal(SPHAcceleration_CUDA(&list, p, G, a), 0);
  assert_int_equal(SPHRate_CUDA(&list, a, G, -2.0, rate), 0);

  assert_petsc(ArrayHostRead(&arrays[5], &result));
  for (int i = 0; i < n; i++) assert_close(result[i], sph->rho_pairs[i], 1e-6, RHO0);
  assert_petsc(ArrayHostRead(&arrays[9], &result));
  for (int i = 0; i < n; i++) top = PetscMax(top, PetscAbsReal(expected[i]));
  for (int i = 0; i < n; i++) assert_close(result[i], expected[i], 1e-5, top); // 33 pairs twice in single precision
  for (int k = 0; k < 10; k++) assert_petsc(ArrayDestroy(&arrays[k]));
  free(pressure);
  free(expected);
  assert_petsc(SPHDestroy(&sph));
}
#endif

int main(int argc, char **argv)
{
  PetscInt n_devices = 0;
  char     name[256];
  int      failed = 0;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (BackendGetDevice(&n_devices, name, sizeof name)) return 1;
  if (!BackendHasCUDA() || !n_devices) {
    printf("skipped: %s\n", BackendHasCUDA() ? "no CUDA device" : "built without CUDA");
    return PetscFinalize() ? 1 : 77;
  }
#if defined(BYSSUS_HAVE_CUDA)
  const struct CMUnitTest tests[] = {cmocka_unit_test(DevicePassesAreTheCPUs)};
  failed                          = cmocka_run_group_tests(tests, NULL, NULL);
#endif
  return PetscFinalize() || failed ? 1 : 0;
}
