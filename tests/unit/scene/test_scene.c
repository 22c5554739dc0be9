/* test_scene.c - what a good scene becomes: values in the options database, merged overrides, a scene written as run. */
#include "scene_tables.h"

static void a_scene_becomes_options(void **state)
{
  Scene       scene;
  FluidParams fluid;
  BodyParams  body;
  TopParams   top;
  PetscBool   has;

  (void)state;
  assert_petsc(ReadScene(good_scene, 0, NULL, &scene));
  assert_string_equal(reported, "");
  assert_petsc(KeysSetDefaults(FluidKeys, &fluid));
  assert_petsc(KeysSetFromOptions(FluidKeys, "sph_", &fluid));
  assert_true(fluid.spacing == 0.01 && fluid.viscosity == 1e-3 && fluid.iterations == 200 && fluid.free_surface);
  assert_int_equal(fluid.solver, 1);
  assert_int_equal(fluid.fill.n, 1);
  assert_string_equal(fluid.fill.name[0], "column");
  assert_petsc(KeysSetDefaults(BodyKeys, &body));
  assert_petsc(KeysSetFromOptions(BodyKeys, "flap_", &body));
  assert_int_equal(body.mesh[0], '/');
  assert_int_equal(access(body.mesh, R_OK), 0);
  assert_string_equal(body.fixed.name[0], "root");
  assert_petsc(KeysSetDefaults(TopKeys, &top));
  assert_petsc(KeysSetFromOptions(TopKeys, "", &top));
  assert_true(top.gravity[2] == -9.81);
  assert_int_equal(top.walls.n, 2);
  assert_petsc(SceneHas(scene, "flap.proxy", &has));
  assert_true(has);
  assert_petsc(SceneHas(scene, "flap", &has));
  assert_true(has);
  assert_petsc(SceneHas(scene, "coupler", &has));
  assert_false(has);
  assert_petsc(SceneDestroy(&scene));
}

static void the_command_line_wins_and_absent_sections_stay_absent(void **state)
{
  char       *options[] = {"-sph_spacing", "0.005", "-gravity", "0,0,-1.5", "-ksp_type", "cg", "-sph_mean", "-1,2,3", "-sph_view"};
  Scene       scene;
  FluidParams fluid;
  PetscBool   has;
  PetscReal   gravity[3];
  PetscInt    n = 3;

  (void)state;
  assert_petsc(ReadScene(good_scene, 9, options, &scene));
  assert_petsc(KeysSetDefaults(FluidKeys, &fluid));
  assert_petsc(KeysSetFromOptions(FluidKeys, "sph_", &fluid));
  assert_true(fluid.spacing == 0.005 && fluid.mean[0] == -1);
  assert_petsc(PetscOptionsGetRealArray(NULL, NULL, "-gravity", gravity, &n, NULL));
  assert_true(n == 3 && gravity[2] == -1.5);
  assert_petsc(PetscOptionsHasName(NULL, NULL, "-ksp_type", &has));
  assert_true(has);
  assert_petsc(SceneDestroy(&scene));

  /* the next scene without fluid has none of the options of the last one */
  assert_petsc(ReadScene("gravity: [0, 0, 1]\n", 0, NULL, &scene));
  assert_petsc(PetscOptionsHasName(NULL, NULL, "-sph_spacing", &has));
  assert_false(has);
  assert_petsc(SceneHas(scene, "sph", &has));
  assert_false(has);
  assert_petsc(SceneDestroy(&scene));
}

static void a_scene_as_run_reads_as_the_same_scene(void **state)
{
  char       *options[] = {"-sph_spacing", "0.005", "-gravity", "0,0,-1.5", "-directory", "out: a \"b\"\nc"};
  char        path[128], text[4096];
  Scene       scene, again;
  FluidParams fluid;
  TopParams   top;
  BodyParams  body;
  FILE       *file;

  (void)state;
  assert_petsc(ReadScene(good_scene, 6, options, &scene));
  snprintf(path, sizeof path, "%s/as_run.yaml", scene_directory);
  assert_petsc(SceneWrite(scene, path));
  assert_petsc(SceneDestroy(&scene));
  file                                        = fopen(path, "r");
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  assert_non_null(strstr(text, "spacing: 0.005"));
  assert_petsc(ReadScene(text, 0, NULL, &again));
  assert_petsc(KeysSetDefaults(FluidKeys, &fluid));
  assert_petsc(KeysSetFromOptions(FluidKeys, "sph_", &fluid));
  assert_petsc(KeysSetDefaults(TopKeys, &top));
  assert_petsc(KeysSetFromOptions(TopKeys, NULL, &top));
  assert_petsc(KeysSetDefaults(BodyKeys, &body));
  assert_petsc(KeysSetFromOptions(BodyKeys, "flap_", &body));
  assert_true(fluid.spacing == 0.005 && fluid.solver == 1 && top.gravity[2] == -1.5);
  assert_string_equal(top.directory, "out: a \"b\"\nc");
  assert_int_equal(body.mesh[0], '/');
  assert_petsc(SceneDestroy(&again));
}

static void json_is_read_by_the_same_reader(void **state)
{
  Scene     scene;
  PetscReal spacing;

  (void)state;
  assert_petsc(ReadScene("{\"sph\": {\"spacing\": 0.02, \"fill\": []},\n \"gravity\": [0, 0, 0]}\n", 0, NULL, &scene));
  assert_petsc(PetscOptionsGetReal(NULL, NULL, "-sph_spacing", &spacing, NULL));
  assert_true(spacing == 0.02);
  assert_petsc(SceneDestroy(&scene));
}

CHECK_MAIN(cmocka_unit_test(a_scene_becomes_options), cmocka_unit_test(the_command_line_wins_and_absent_sections_stay_absent),
           cmocka_unit_test(a_scene_as_run_reads_as_the_same_scene), cmocka_unit_test(json_is_read_by_the_same_reader))
