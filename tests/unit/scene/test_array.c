/* test_array.c - the array's two sides always agree; the device side where there is one. */
#include "array.h"
#include "backend.h"
#include "check.h"

#include <stdint.h>

static void contents_survive_growth(void **state)
{
  Array         array;
  double       *w;
  const double *r;

  (void)state;
  assert_petsc(ArrayCreate(sizeof(double), 10, &array));
  assert_petsc(ArrayHostOverwrite(&array, &w));
  assert_int_equal((uintptr_t)w % 64, 0);
  for (int i = 0; i < 10; i++) w[i] = i;
  assert_petsc(ArrayResize(&array, 1000, PETSC_TRUE));
  assert_petsc(ArrayHostRead(&array, &r));
  for (int i = 0; i < 10; i++) assert_true(r[i] == i);
  assert_int_equal(array.n, 1000);

  /* growing by one now and then costs few allocations */
  assert_petsc(ArrayResize(&array, 1001, PETSC_TRUE));
  assert_true(array.capacity >= 1500);
  assert_petsc(ArrayResize(&array, 5, PETSC_TRUE));
  assert_true(array.capacity >= 1500);
  assert_petsc(ArrayDestroy(&array));
  assert_petsc(ArrayDestroy(&array));
}

static void reading_what_was_never_written_is_refused(void **state)
{
  Array         array;
  double       *w;
  const double *r;

  (void)state;
  assert_petsc(ArrayCreate(sizeof(double), 4, &array));
  assert_petsc(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  assert_int_equal((int)ArrayHostRead(&array, &r), PETSC_ERR_ORDER);
  assert_petsc(ArrayHostOverwrite(&array, &w));
  assert_petsc(ArrayHostRead(&array, &r));
  assert_petsc(ArrayResize(&array, 4, PETSC_FALSE));
  assert_int_equal((int)ArrayHostRead(&array, &r), PETSC_ERR_ORDER);
  assert_petsc(PetscPopErrorHandler());
  assert_petsc(ArrayDestroy(&array));
  assert_petsc(ArrayCreate(sizeof(double), 0, &array));
  assert_petsc(ArrayHostRead(&array, &r));
  assert_petsc(ArrayDestroy(&array));
}

static void the_device_sees_what_the_host_wrote_and_back(void **state)
{
  Array      array;
  PetscInt   devices;
  char       name[256];
  int       *w;
  const int *r;
  void      *d;

  (void)state;
  assert_petsc(BackendGetDevice(&devices, name, sizeof name));
  if (!devices) skip();
  assert_petsc(ArrayCreate(sizeof(int), 3, &array));
  assert_petsc(ArrayHostOverwrite(&array, &w));
  for (int i = 0; i < 3; i++) w[i] = i + 1;
  assert_petsc(ArrayDeviceWrite(&array, &d));
  assert_int_equal(array.host_valid, 0);
  assert_petsc(ArrayResize(&array, 100, PETSC_TRUE));
  assert_petsc(ArrayHostRead(&array, &r));
  for (int i = 0; i < 3; i++) assert_int_equal(r[i], i + 1);
  assert_true(array.host_valid && array.device_valid);
  assert_petsc(ArrayDestroy(&array));
}

CHECK_MAIN(cmocka_unit_test(contents_survive_growth), cmocka_unit_test(reading_what_was_never_written_is_refused),
           cmocka_unit_test(the_device_sees_what_the_host_wrote_and_back))
