/* test_scene_errors.c - each way in which a scene can be wrong: the message names the place, what is wrong and what is allowed. */
#include "scene_tables.h"

typedef struct {
  const char *scene;       /* text of the file                                                         */
  const char *options[4];  /* the command line                                                         */
  const char *expected[4]; /* fragments of the report; "@" stands for the path of the scene            */
  int         errors;      /* how many in all                                                          */
} Case;

static const Case cases[] = {
  /* keys */
  {"sph:\n  spacing: 0.1\n  viscocity: 1\n", {0}, {"@:3: sph.viscocity is not a known key\n", "  did you mean sph.viscosity (line 1 has the section)?\n"}, 1},
  {"sph:\n  spacing: 0.1\n  colour: red\n", {0}, {"@:3: sph.colour is not a known key\n", "known here: spacing, viscosity"}, 1},
  {"viscosity: 1\nsph: {spacing: 0.1}\n", {0}, {"@:1: viscosity is not a known key\n  did you mean sph.viscosity?\n"}, 1},
  {"sph:\n  spacing: 0.1\n  solver: pcg\n  spacing: 0.2\n", {0}, {"@:4: spacing is given twice\n  first in line 2\n"}, 1},
  {"sph:\n  solver: pcg\n", {0}, {"@:1: sph.spacing is missing\n  expected a finite number > 0 [m]: particle spacing\n"}, 1},
  {"sph:\n", {0}, {"@:1: sph.spacing is missing\n"}, 1},
  /* values */
  {"sph:\n  spacing: -0.01\n", {0}, {"@:2: sph.spacing = -0.01 is out of range\n  expected a finite number > 0 [m]\n"}, 1},
  {"sph: {spacing: 0.1, viscosity: -0.001}\n", {0}, {"@:1: sph.viscosity = -0.001 is out of range\n  expected a finite number >= 0 [Pa s], for example 1e-3\n"}, 1},
  {"sph: {spacing: .nan}\n", {0}, {"sph.spacing = .nan is not a number\n"}, 1},
  {"sph: {spacing: nan}\n", {0}, {"sph.spacing = nan is not a finite number\n"}, 1},
  {"gravity: [0, 0, inf]\n", {0}, {"@:1: gravity = [0, 0, inf] is not a finite number\n"}, 1},
  {"gravity: [0, 0]\n", {0}, {"gravity = [0, 0] does not have three components\n  expected three finite numbers [x, y, z], each"}, 1},
  {"gravity: -9.81\n", {0}, {"gravity = -9.81 does not have three components\n"}, 1},
  {"sph: {spacing: 1 cm}\n", {0}, {"sph.spacing = 1 cm has text after the number"}, 1},
  {"sph: {spacing: [1, 2]}\n", {0}, {"sph.spacing = [1, 2] is a list\n  expected a finite number > 0 [m]\n"}, 1},
  {"sph: {spacing: {a: 1}}\n", {0}, {"sph.spacing = {a: 1} is a section\n"}, 1},
  {"sph: {spacing: }\n", {0}, {"sph.spacing =  is empty\n"}, 1},
  {"sph: {spacing: 1, iterations: 1.5}\n", {0}, {"is not an integer\n  expected an integer >= 1 and <= 100000, for example 200\n"}, 1},
  {"sph: {spacing: 1, free_surface: maybe}\n", {0}, {"is neither true nor false\n"}, 1},
  {"sph: {spacing: 1, solver: pgc}\n", {0}, {"sph.solver = pgc is not known\n  expected one of pcg, jacobi\n  did you mean pcg?\n"}, 1},
  {"walls: [xmin, ymin]\n", {0}, {"walls = [xmin, ymin] has the unknown word ymin\n  expected a list out of xmin, xmax, zmin"}, 1},
  {"walls: [[xmin]]\n", {0}, {"walls = [[xmin]] is not a plain list\n"}, 1},
  /* sections and lists */
  {"shp:\n  spacing: 1\n", {0}, {"@:1: shp is not a known section\n  did you mean sph?\n"}, 1},
  {"sph: 5\n", {0}, {"@:1: sph = 5 is not a section\n"}, 1},
  {"bodies: [flap]\n", {0}, {"@:1: bodies names flap, but there is no section flap\n"}, 1},
  {"bodies: [flap]\nflpa: {mesh: scene.yaml}\n", {0}, {"there is no section flap\n", "@:2: flpa is not a known section\n  did you mean flap?\n"}, 2},
  {"heart: {mesh: scene.yaml}\n", {0}, {"@:1: heart is a section that no list names\n  add it to one of the lists: bodies\n"}, 1},
  {"bodies: [sph]\nsph: {spacing: 1}\n", {0}, {"@:1: bodies names sph, but that name is taken\n"}, 1},
  {"bodies: [a-b]\n", {0}, {"bodies names 'a-b', which cannot be a section\n"}, 1},
  {"bodies: [b, B]\nb: {mesh: scene.yaml}\nB: {mesh: scene.yaml}\n", {0}, {"@:3: the names B and b cannot be in one scene"}, 1},
  {"bodies: [b, b_1]\nb: {mesh: scene.yaml}\nb_1: {mesh: scene.yaml}\n", {0}, {"@:3: the names b_1 and b cannot be in one scene"}, 1},
  {"bodies: [b, b_proxy]\nb: {mesh: scene.yaml}\nb_proxy: {mesh: scene.yaml}\n", {0}, {"cannot be in one scene"}, 1},
  {"sph: {spacing: 1, fill: [box]}\n", {0}, {"@:1: sph.fill names box, but there is no section sph.box\n"}, 1},
  {"sph: {spacing: 1, fill: [box], box: {height: 0}}\n", {0}, {"sph.box.height = 0 is out of range\n"}, 1},
  {"bodies: [flap]\nflap:\n  mesh: scene.yaml\n  proxy: {adaptiv: true}\n", {0}, {"@:4: flap.proxy.adaptiv is not a known key\n  did you mean flap.proxy.adaptive"}, 1},
  /* files */
  {"bodies: [flap]\nflap: {mesh: no/such.msh}\n", {0}, {"@:2: flap.mesh = no/such.msh cannot be read: No such file or directory\n  looked for /tmp/"}, 1},
  {"bodies: [flap]\nflap: {mesh: /tmp}\n", {0}, {"flap.mesh = /tmp is not a file\n"}, 1},
  /* YAML itself */
  {"sph:\n  spacing: 0.1\n viscosity: 1\n", {0}, {"@:3: YAML: "}, 1},
  {"sph: {spacing: 0.1\n", {0}, {"@:2: YAML: "}, 1},
  {"- a\n- b\n", {0}, {"@:1: a scene is a set of `key: value` lines\n"}, 1},
  {"", {0}, {"@:1: the scene is empty\n"}, 1},
  {"a: &x 1\nb: *x\n", {0}, {"@:2: aliases (*x) are not part of a scene\n"}, 1},
  {"gravity: [0, 0, 0]\n---\ngravity: [0, 0, 1]\n", {0}, {"@:3: a second document begins here"}, 1},
  {"a: [[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]\n", {0}, {"nested deeper than"}, 1},
  /* the command line */
  {"sph: {spacing: 0.1}\n", {"-sph_spacing", "-1"}, {"command line: -sph_spacing = -1 is out of range\n  expected a finite number > 0 [m]\n"}, 1},
  {"sph: {spacing: 0.1}\n", {"-sph_spacng", "1"}, {"command line: -sph_spacng is not a known option\n  did you mean -sph_spacing?\n"}, 1},
  {"sph: {spacing: 0.1}\n", {"spacing", "-sph_solver", "pcg"}, {"command line: spacing is not an option\n"}, 1},
  {"sph: {spacing: 0.1}\n", {"-sph_spacing", "1", "-sph_spacing", "2"}, {"command line: -sph_spacing is given twice\n"}, 1},
  {"sph: {spacing: 0.1}\n", {"-colour"}, {"command line: -colour is not a known option\n"}, 1},
  {"sph: {spacing: 0.1}\n", {"-sph_spacing"}, {"command line: -sph_spacing =  is empty\n"}, 1},
  /* all at once, in the order of lines, and counted */
  {"gravity: [0, 0, nan]\nsph:\n  solver: 4\n  spacin: 1\n", {"-walls", "zmax"}, {"@:1: gravity", "@:3: sph.solver", "@:4: sph.spacin is", "command line: -walls = [zmax]"}, 5},
};

/* `fragment` of a report, with the path in place of "@" */
static PetscBool Contains(const char text[], const char fragment[])
{
  char full[1024];

  if (fragment[0] == '@') snprintf(full, sizeof full, "%s/scene.yaml%s", scene_directory, fragment + 1);
  else snprintf(full, sizeof full, "%s", fragment);
  return (PetscBool)(strstr(text, full) != NULL);
}

static void every_error_is_reported_with_its_place(void **state)
{
  int failed = 0;

  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const PetscInt before = InputErrorCount();
    char          *options[4], last[64];
    int            n = 0;
    PetscBool      good = PETSC_TRUE;
    Scene          scene;

    for (; n < 4 && cases[i].options[n]; n++) options[n] = (char *)(uintptr_t)cases[i].options[n];
    if (ReadScene(cases[i].scene, n, options, &scene) != BY_ERR_INPUT || scene) good = PETSC_FALSE;
    for (int k = 0; k < 4 && cases[i].expected[k]; k++) good = (PetscBool)(good && Contains(reported, cases[i].expected[k]));
    snprintf(last, sizeof last, "%d error%s in ", cases[i].errors, cases[i].errors == 1 ? "" : "s");
    good = (PetscBool)(good && strstr(reported, last) && strstr(reported, "; nothing was run\n") && InputErrorCount() - before == cases[i].errors);
    if (good) continue;
    failed++;
    print_error("case %zu:\n%s--- printed:\n%s---\n", i, cases[i].scene, reported);
  }
  assert_int_equal(failed, 0);
}

static void errors_come_in_the_order_of_lines(void **state)
{
  const Case *last = &cases[sizeof cases / sizeof *cases - 1];
  char       *options[2] = {(char *)(uintptr_t)last->options[0], (char *)(uintptr_t)last->options[1]};
  const char *at = reported;
  Scene       scene;

  (void)state;
  (void)ReadScene(last->scene, 2, options, &scene);
  for (int k = 0; k < 4; k++) {
    at = strstr(at, last->expected[k] + (last->expected[k][0] == '@'));
    assert_non_null(at);
  }
}

static void a_file_that_is_not_there_or_not_a_scene_is_said(void **state)
{
  Scene scene;
  char  large[128];
  FILE *file;

  (void)state;
  assert_int_equal((int)SceneRead("/no/such/scene.yaml", 0, NULL, sections, &scene), (int)BY_ERR_INPUT);
  assert_int_equal((int)SceneRead("/tmp", 0, NULL, sections, &scene), (int)BY_ERR_INPUT);
  snprintf(large, sizeof large, "%s/large", scene_directory);
  file = fopen(large, "w");
  for (int i = 0; i < 200000; i++) fputs("# 567890\n", file);
  fclose(file);
  assert_int_equal((int)SceneRead(large, 0, NULL, sections, &scene), (int)BY_ERR_INPUT);
}

/* text of what InputError prints */
static const char *Reported(const char key[], const char what[])
{
  char  path[128];
  FILE *file;
  int   saved = dup(2);

  snprintf(path, sizeof path, "%s/log", scene_directory);
  fflush(stderr);
  file = fopen(path, "w+");
  dup2(fileno(file), 2);
  assert_int_equal((int)InputError(key, "%s", what), (int)BY_ERR_INPUT);
  fflush(stderr);
  dup2(saved, 2);
  close(saved);
  rewind(file);
  reported[fread(reported, 1, sizeof reported - 1, file)] = 0;
  fclose(file);
  return reported;
}

static void later_errors_find_their_line(void **state)
{
  char *options[] = {"-flap_poisson", "0.3"};
  Scene scene;

  (void)state;
  assert_petsc(ReadScene(good_scene, 2, options, &scene));
  assert_true(Contains(Reported("flap.fixed", "names no group of the mesh\nthe mesh has: skin"), "@:9: flap.fixed = [root] names no group of the mesh\n  the mesh has: skin\n"));
  assert_true(Contains(Reported("sph.column.height", "is more than the tank"), "@:7: sph.column.height = 0.3 is more than the tank\n"));
  assert_true(Contains(Reported("sph.viscosity", "is odd"), "@:3: sph.viscosity = 1e-3 (default) is odd\n"));
  assert_true(Contains(Reported("flap.poisson", "is odd"), "command line: -flap_poisson = 0.3 is odd\n"));
  assert_true(Contains(Reported("sph", "has no water"), "@:3: sph: has no water\n"));
  assert_true(Contains(Reported("resume", "no checkpoint"), "@: resume: no checkpoint\n"));
  assert_petsc(SceneDestroy(&scene));
  assert_string_equal(Reported("resume", "no checkpoint"), "byssus: resume: no checkpoint\n");
}

CHECK_MAIN(cmocka_unit_test(every_error_is_reported_with_its_place), cmocka_unit_test(errors_come_in_the_order_of_lines),
           cmocka_unit_test(a_file_that_is_not_there_or_not_a_scene_is_said), cmocka_unit_test(later_errors_find_their_line))
