/* test_keys.c - one parser for defaults, options and checks. */
#include "scene_tables.h"

#include <petscviewer.h>

static const char *Why(const Key *key, const char value[])
{
  static char why[1024];

  assert_petsc(KeyCheck(key, value, why, sizeof why));
  return why;
}

static void every_default_passes_its_own_check(void **state)
{
  const Key *const tables[] = {TopKeys, FluidKeys, FillKeys, BodyKeys, ProxyKeys};

  (void)state;
  for (size_t t = 0; t < sizeof tables / sizeof *tables; t++) {
    for (const Key *key = tables[t]; key->name; key++) {
      if (key->def && key->def[0]) assert_string_equal(Why(key, key->def), "");
    }
  }
}

static void only_finite_numbers_within_open_and_closed_ends_pass(void **state)
{
  static const Key  any    = {"any", KEY_REAL, 0, "m", NULL, 0, 0, 0, NULL, ""};
  static const Key  half   = {"half", KEY_REAL, 0, "1", NULL, 0, 0.5, KEY_HI_OPEN, NULL, ""};
  static const Key  open   = {"open", KEY_REAL, 0, "Pa s", "1e-3", 0, INFINITY, KEY_LO_OPEN, NULL, ""};
  static const Key  vector = {"vector", KEY_VEC3, 0, "m", NULL, -1, 1, 0, NULL, ""};
  static const Key  list   = {"list", KEY_REALS, 0, "s", NULL, 0, 10, KEY_LO_OPEN, NULL, ""};
  static const Key  count  = {"count", KEY_INT, 0, "1", NULL, 1, 10, 0, NULL, ""};
  const char *const bad[]  = {"nan", "NaN", "inf", "-inf", "1e400", "", " ", "x", "1 m", "1,2", "0.1.2", "--1"};

  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) assert_string_not_equal(Why(&any, bad[i]), "");
  assert_string_equal(Why(&any, "-1e30"), "");
  assert_string_equal(Why(&half, "0"), "");
  assert_string_not_equal(Why(&half, "0.5"), "");
  assert_string_not_equal(Why(&half, "-1e-300"), "");
  assert_string_not_equal(Why(&open, "0"), "");
  assert_string_equal(Why(&open, "1e-300"), "");
  assert_string_equal(Why(&open, "-0.001"), "is out of range\nexpected a finite number > 0 [Pa s], for example 1e-3");
  assert_string_equal(Why(&vector, "[1, -1, 0]"), "");
  assert_string_equal(Why(&vector, "1,0,0"), "");
  assert_string_not_equal(Why(&vector, "1,0,1.5"), "");
  assert_string_not_equal(Why(&vector, "1,0"), "");
  assert_string_not_equal(Why(&vector, "1,0,nan"), "");
  assert_string_not_equal(Why(&vector, "1,0,0,0"), "");
  assert_string_equal(Why(&list, ""), "");
  assert_string_equal(Why(&list, "[0.1, 10]"), "");
  assert_string_equal(Why(&list, "1, 0"), "is out of range\nexpected a list of finite numbers, each > 0 and <= 10 in [s]");
  assert_string_not_equal(Why(&list, "1, x"), "");
  assert_non_null(strstr(Why(&list, "1,2,3,4,5,6,7,8,9,10,1,2,3,4,5,6,7"), "more than 16"));
  assert_string_equal(Why(&count, "10"), "");
  assert_string_equal(Why(&count, "1e1"), "");
  assert_string_not_equal(Why(&count, "1.5"), "");
  assert_string_not_equal(Why(&count, "11"), "");
  assert_string_not_equal(Why(&count, "1e10"), "");
}

static void words_are_known_or_suggested(void **state)
{
  const Key *solver = &FluidKeys[6], *walls = &TopKeys[2], *names = &TopKeys[1];

  (void)state;
  assert_string_equal(Why(solver, "jacobi"), "");
  assert_non_null(strstr(Why(solver, "jacoby"), "did you mean jacobi?"));
  assert_non_null(strstr(Why(solver, "4"), "one of pcg, jacobi"));
  assert_null(strstr(Why(solver, "4"), "did you mean"));
  assert_string_equal(Why(walls, "xmin, zmin"), "");
  assert_non_null(strstr(Why(walls, "xmin, xmas"), "did you mean xmax?"));
  assert_non_null(strstr(Why(names, "a, b, a"), "a twice"));
  assert_non_null(strstr(Why(names, "a,,b"), "empty name"));
  assert_string_equal(Why(names, ""), "");
  assert_int_equal(KeyDistance("kitten", "sitting"), 3);
  assert_int_equal(KeyDistance("sph", "shp"), 1);
  assert_false(KeyIsNear("at", "it's"));
}

static void a_wrong_option_is_an_error_with_key_and_range(void **state)
{
  FluidParams fluid;

  (void)state;
  assert_petsc(KeysSetDefaults(FluidKeys, &fluid));
  assert_petsc(PetscOptionsSetValue(NULL, "-sph_tolerance", "1"));
  assert_petsc(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  assert_int_equal((int)KeysSetFromOptions(FluidKeys, "sph_", &fluid), PETSC_ERR_ARG_OUTOFRANGE);
  assert_petsc(PetscPopErrorHandler());
  assert_petsc(PetscOptionsClearValue(NULL, "-sph_tolerance"));
  assert_petsc(PetscOptionsSetValue(NULL, "-sph_free_surface", "off"));
  assert_petsc(KeysSetFromOptions(FluidKeys, "sph_", &fluid));
  assert_false(fluid.free_surface);
  assert_petsc(PetscOptionsClearValue(NULL, "-sph_free_surface"));
}

static void the_view_shows_every_key_with_its_unit(void **state)
{
  FluidParams fluid;
  PetscViewer viewer;
  char        path[]     = "/tmp/byssus_view_XXXXXX", text[4096];
  const int   descriptor = mkstemp(path);
  FILE       *file;

  (void)state;
  close(descriptor);
  assert_petsc(KeysSetDefaults(FluidKeys, &fluid));
  assert_petsc(PetscViewerASCIIOpen(PETSC_COMM_SELF, path, &viewer));
  assert_petsc(PetscViewerASCIIPushTab(viewer));
  assert_petsc(KeysView(FluidKeys, &fluid, viewer));
  assert_petsc(PetscViewerASCIIPopTab(viewer));
  assert_petsc(PetscViewerDestroy(&viewer));
  file                                        = fopen(path, "r");
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  unlink(path);
  assert_non_null(strstr(text, "viscosity = 0.001 [Pa s]\n"));
  assert_non_null(strstr(text, "solver = pcg\n"));
  assert_non_null(strstr(text, "mean = 0, 0, 0 [m/s]\n"));
  for (const Key *key = FluidKeys; key->name; key++) assert_non_null(strstr(text, key->name));
}

CHECK_MAIN(cmocka_unit_test(every_default_passes_its_own_check),
           cmocka_unit_test(only_finite_numbers_within_open_and_closed_ends_pass), cmocka_unit_test(words_are_known_or_suggested),
           cmocka_unit_test(a_wrong_option_is_an_error_with_key_and_range),
           cmocka_unit_test(the_view_shows_every_key_with_its_unit))
