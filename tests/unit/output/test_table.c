/* Tables, the summary and the progress line: numbers read back exactly, a resumed table drops later rows and a broken last one,
   JSON is valid whatever the text and the numbers, and a full disk takes no whole row away. */
#define _GNU_SOURCE /* pipe2 */
#include "check.h"
#include "output.h"
#include <fcntl.h>
#include <float.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static char              directory[1024];
static const char *const headers[3] = {"time [s]", "work, fluid [J]", "steps [1]"};

static const char *Text(const char name[])
{
  static char text[8192];
  char        path[1100];
  FILE       *f;
  size_t      n;

  snprintf(path, sizeof(path), "%s/%s", directory, name);
  f = fopen(path, "rb");
  if (!f) return "(no file)";
  n       = fread(text, 1, sizeof(text) - 1, f);
  text[n] = '\0';
  fclose(f);
  return text;
}

static void PutText(const char name[], const char text[])
{
  char  path[1100];
  FILE *f;

  snprintf(path, sizeof(path), "%s/%s", directory, name);
  f = fopen(path, "wb");
  fputs(text, f);
  fclose(f);
}

static void numbers_of_a_table_read_back_exactly(void **state)
{
  static const double values[][3] = {{0, 0.1, 1}, {1.0 / 3, -DBL_MAX, 2}, {0.5, DBL_MIN / 3, 3e9}};
  Table               table;
  const char         *row;

  (void)state;
  assert_petsc(TableCreate(directory, "t.csv", 3, headers, PETSC_FALSE, 0, &table));
  for (int i = 0; i < 3; i++) {
    assert_petsc(TableWrite(table, values[i])); // on disk at once:
    row = Text("t.csv");
    for (int k = 0; k <= i; k++) row = strchr(row, '\n') + 1;
    for (int c = 0; c < 3; c++) {
      char *end;
      assert_true(strtod(row, &end) == values[i][c]);
      assert_true(*end == (c < 2 ? ',' : '\n'));
      row = end + 1;
    }
  }
  assert_petsc(TableDestroy(&table));
  assert_true(strncmp(Text("t.csv"), "time [s],\"work, fluid [J]\",steps [1]\n0,0.1,1\n", 45) == 0);
}

static void a_resumed_table_drops_later_and_broken_rows(void **state)
{
  static const double row[3] = {0.4, 7, 8};
  Table               table;

  (void)state;
  PutText(
      "t.csv",
      "time [s],\"work, fluid [J]\",steps [1]\n0,0.1,1\n0.30000000000000004,2,3\nnot,a,row\n0.4,5,6\n0.5,1"); // the last was cut
  assert_petsc(TableCreate(directory, "t.csv", 3, headers, PETSC_TRUE, 0.3, &table));
  assert_petsc(TableWrite(table, row));
  assert_petsc(TableDestroy(&table));
  assert_string_equal(Text("t.csv"), "time [s],\"work, fluid [J]\",steps [1]\n0,0.1,1\n0.30000000000000004,2,3\n0.4,7,8\n");
  assert_petsc(TableCreate(directory, "new.csv", 3, headers, PETSC_TRUE, 0.3, &table)); // not there: a new one
  assert_petsc(TableDestroy(&table));
  assert_string_equal(Text("new.csv"), "time [s],\"work, fluid [J]\",steps [1]\n");
}

static void a_table_with_other_columns_is_refused(void **state)
{
  Table table;

  (void)state;
  PutText("t.csv", "time [s],height [m]\n0,1\n");
  assert_int_equal(TableCreate(directory, "t.csv", 3, headers, PETSC_TRUE, 0.3, &table), BY_ERR_INPUT);
  assert_null(table);
  assert_string_equal(Text("t.csv"), "time [s],height [m]\n0,1\n");
}

static void a_limit_leaves_whole_rows(void **state)
{
  static const double row[3] = {0.123456789, 0.123456789, 0.123456789};
  struct rlimit       old, limit;
  Table               table;
  PetscErrorCode      status = 0;
  int                 n = 0, lines = 0;

  (void)state;
  assert_petsc(OutputMakeDirectory(directory)); // takes SIGXFSZ away
  assert_petsc(TableCreate(directory, "t.csv", 3, headers, PETSC_FALSE, 0, &table));
  getrlimit(RLIMIT_FSIZE, &old);
  limit          = old;
  limit.rlim_cur = 200;
  setrlimit(RLIMIT_FSIZE, &limit);
  while (!status && n < 100) {
    status = TableWrite(table, row);
    n += !status;
  }
  assert_int_equal(TableWrite(table, row), BY_ERR_OUTPUT);
  setrlimit(RLIMIT_FSIZE, &old);
  assert_int_equal(status, BY_ERR_OUTPUT);
  assert_petsc(TableDestroy(&table));
  for (const char *s = Text("t.csv"); *s; s++) {
    lines += *s == '\n';
    if (!s[1]) assert_int_equal(*s, '\n');
  }
  assert_int_equal(lines, n + 1);
}

static void a_summary_is_valid_json(void **state)
{
  Json json;

  (void)state;
  PutText("summary.json", "old");
  assert_petsc(JsonCreate(directory, "summary.json", &json));
  assert_petsc(JsonString(json, "status", "a \"quoted\"\n\\path\t\x01 \xc3\xa9"));
  assert_petsc(JsonBegin(json, "fluid"));
  assert_petsc(JsonInt(json, "particles", 25000));
  assert_petsc(JsonBegin(json, "empty"));
  assert_petsc(JsonEnd(json));
  assert_petsc(JsonReal(json, "third", 1.0 / 3));
  assert_petsc(JsonEnd(json));
  assert_petsc(JsonReal(json, "tenth", 0.1));
  assert_petsc(JsonReal(json, "nan", NAN));
  assert_petsc(JsonReal(json, "inf", -INFINITY));
  assert_string_equal(Text("summary.json"), "old"); // until the end
  assert_petsc(JsonDestroy(&json));
  assert_string_equal(Text("summary.json"),
                      "{\n  \"status\": \"a \\\"quoted\\\"\\n\\\\path\\t\\u0001 \xc3\xa9\",\n  \"fluid\": {\n    \"particles\": "
                      "25000,\n    \"empty\": {},\n"
                      "    \"third\": 0.3333333333333333\n  },\n  \"tenth\": 0.1,\n  \"nan\": null,\n  \"inf\": null\n}\n");
}

static void a_log_shows_progress_every_ten_seconds_and_at_the_end(void **state)
{
  Progress      progress;
  ProgressState s = {0, 1, 1e-3, 0, 0, 5};
  int           ends[2], kept = dup(STDERR_FILENO), lines = 0;
  char          text[8192];
  ssize_t       n;

  (void)state;
  assert_petsc(pipe2(ends, O_NONBLOCK));
  fflush(stderr);
  dup2(ends[1], STDERR_FILENO);
  assert_petsc(ProgressCreate(&progress));
  for (s.step = 0; s.step < 1000; s.step++) { // 40 seconds of 25 steps a second
    s.time = 1e-3 * s.step;
    s.wall = 0.04 * s.step;
    assert_petsc(ProgressShow(progress, &s, PETSC_FALSE));
  }
  s.time = 1;
  s.wall = 40;
  assert_petsc(ProgressShow(progress, &s, PETSC_TRUE));
  assert_petsc(ProgressDestroy(&progress));
  fflush(stderr);
  dup2(kept, STDERR_FILENO);
  n = read(ends[0], text, sizeof(text) - 1);
  assert_true(n > 0);
  text[n] = '\0';
  for (const char *c = text; *c; c++) lines += *c == '\n';
  assert_int_equal(lines, 4); // at 10, 20, 30 s and the end
  assert_true(strncmp(text, " 25.0 %  time 0.25 / 1 s  step 250  dt 1.00e-03 s  5 iterations  25 steps/s  left 00:00:30\n", 91) ==
              0);
  assert_non_null(strstr(text, "100.0 %  time 1 / 1 s  step 1000  dt 1.00e-03 s  5 iterations  25 steps/s  took 00:00:40\n"));
}

static int Begin(void **state)
{
  (void)state;
  snprintf(directory, sizeof(directory), "/tmp/byssus.XXXXXX");
  return mkdtemp(directory) ? 0 : -1;
}

static int End(void **state)
{
  char command[1100];

  (void)state;
  snprintf(command, sizeof(command), "rm -r %s", directory);
  return system(command);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_of_a_table_read_back_exactly),
      cmocka_unit_test(a_resumed_table_drops_later_and_broken_rows),
      cmocka_unit_test(a_table_with_other_columns_is_refused),
      cmocka_unit_test(a_limit_leaves_whole_rows),
      cmocka_unit_test(a_summary_is_valid_json),
      cmocka_unit_test(a_log_shows_progress_every_ten_seconds_and_at_the_end),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, Begin, End);
  return PetscFinalize() || failed ? 1 : 0;
}
