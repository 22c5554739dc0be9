/* test_scene_mutations.c - whatever is in a scene file, the reader ends with a scene or with a report. Mutations come from a fixed
   seed; BYSSUS_FUZZ=n tries n of them (run it under ./dev asan). */
#include "../unit/scene/scene_tables.h"

/* xorshift64 (Marsaglia 2003): the same mutations on every machine */
static unsigned long long state_of_random = 88172645463325252ull;
static unsigned           Random(unsigned n)
{
  state_of_random ^= state_of_random << 13;
  state_of_random ^= state_of_random >> 7;
  state_of_random ^= state_of_random << 17;
  return (unsigned)(state_of_random % n);
}

/* pieces that mean something to YAML or to us */
static const char *const pieces[] = {
    "\n",           ": ",           "- ",     "[",        "]",         "{",     "}",   ",",    "#",
    "&a ",          "*a",           "!!int ", "|\n",      ">\n",       "\"",    "'",   "---",  "...",
    "%TAG ",        "? ",           "\t",     "nan",      "-1",        "1e999", "\\x", "\xff", "\xc3\xa9",
    "sph",          "fill",         "flap",   "bodies: ", "column",    "<<: ",  "~",   "null", "  ",
    "\r",           "\xef\xbb\xbf", "b_1",    "proxy",    "/dev/null", ".",     "@",   "`",    "=",
    "walls: [xmin]"};

static void Mutate(char text[], size_t n_max)
{
  const unsigned changes = 1 + Random(6);

  for (unsigned k = 0; k < changes; k++) {
    const size_t n = strlen(text), at = n ? Random((unsigned)n) : 0;
    const char  *piece = pieces[Random(sizeof pieces / sizeof *pieces)];

    switch (Random(5)) {
    case 0: /* another byte */
      if (n) text[at] = (char)(1 + Random(255));
      break;
    case 1: { /* cut out */
      const size_t length = 1 + Random(20);
      if (n > length + at) memmove(text + at, text + at + length, n - at - length + 1);
      break;
    }
    case 2: /* cut off */
      if (Random(4) == 0) text[at] = 0;
      break;
    case 3: { /* repeat a stretch */
      const size_t length = PetscMin(1 + Random(200), n - at);
      if (n + length < n_max) memmove(text + at + length, text + at, n - at + 1);
      break;
    }
    default: /* put a piece in */
      if (n + strlen(piece) < n_max) {
        memmove(text + at + strlen(piece), text + at, n - at + 1);
        memcpy(text + at, piece, strlen(piece));
      }
    }
  }
}

static void mutated_scenes_end_in_a_scene_or_a_report(void **state)
{
  const char *wanted = getenv("BYSSUS_FUZZ");
  const int   n      = wanted ? atoi(wanted) : 1000;
  char        text[8192];
  char       *options[] = {"-sph_spacing", "0.1", "-flap_poisson", "0.2"};
  int         good = 0, bad = 0;

  (void)state;
  for (int i = 0; i < n; i++) {
    Scene          scene;
    PetscErrorCode result;

    strcpy(text, good_scene);
    Mutate(text, sizeof text);
    result = ReadScene(text, Random(2) ? 4 : 0, options, &scene);
    if (result == 0) good++;
    else bad++;
    if (result != 0 && result != BY_ERR_INPUT) fail_msg("mutation %d: error %d\n%s", i, (int)result, text);
    if (result && (!strstr(reported, "nothing was run") || strstr(reported, "PETSC ERROR")))
      fail_msg("mutation %d: no report\n%s---\n%s", i, text, reported);

    /* what was accepted is written so that it is accepted again */
    if (!result) {
      char  path[128], again[3 * sizeof text];
      FILE *file;

      snprintf(path, sizeof path, "%s/as_run.yaml", scene_directory);
      assert_petsc(SceneWrite(scene, path));
      assert_petsc(SceneDestroy(&scene));
      file                                           = fopen(path, "r");
      again[fread(again, 1, sizeof again - 1, file)] = 0;
      fclose(file);
      if (ReadScene(again, 0, NULL, &scene))
        fail_msg("mutation %d: written scene is refused\n%s--- as\n%s---\n%s", i, text, again, reported);
      assert_petsc(SceneDestroy(&scene));
    }
  }
  print_message("%d scenes, %d reports\n", good, bad);
  assert_true(!wanted || good + bad == n);
}

CHECK_MAIN(cmocka_unit_test(mutated_scenes_end_in_a_scene_or_a_report))
