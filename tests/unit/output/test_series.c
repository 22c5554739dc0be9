/* Results as time series: what is written is what is read back, a resumed series drops what came later, and a disk that is full,
   limited or not there is one line and a status, with everything written before still readable. The files of the first two tests
   are also read by test_results.py. */
#define _GNU_SOURCE /* O_TMPFILE */
#include "check.h"
#include "output_file.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char directory[1024];

static const char *In(const char name[])
{
  static char path[2048];

  snprintf(path, sizeof(path), "%s/%s", directory, name);
  return path;
}

/* n water particles at `time`: positions and fields with a value that tells time, particle and component */
static PetscErrorCode WriteWater(Series series, PetscReal time, PetscInt n)
{
  PetscReal  *x, *velocity, *pressure;
  OutputField fields[2];

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(3 * n, &x, 3 * n, &velocity, n, &pressure));
  for (PetscInt i = 0; i < n; i++) {
    for (int c = 0; c < 3; c++) x[3 * i + c] = 0.01 * i + c + time;
    for (int c = 0; c < 3; c++) velocity[3 * i + c] = 100 * time + i + 0.25 * c;
    pressure[i] = 1000 * time + i;
  }
  fields[0] = (OutputField){"velocity", "m/s", 3, velocity};
  fields[1] = (OutputField){"pressure", "Pa", 1, pressure};
  ByCall(SeriesWrite(series, time, n, x, 2, fields));
  PetscCall(PetscFree3(x, velocity, pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* like WriteWater, but hands BY_ERR_OUTPUT on without a traceback */
static PetscErrorCode TryWater(Series series, PetscReal time, PetscInt n)
{
  PetscReal        *data      = (PetscReal *)calloc((size_t)n * 3, sizeof(PetscReal));
  const OutputField fields[2] = {{"velocity", "m/s", 3, data}, {"pressure", "Pa", 1, data}};
  PetscErrorCode    status;

  for (PetscInt i = 0; i < 3 * n; i++) data[i] = sin(1.0 * i * i + time); // does not compress
  status = SeriesWrite(series, time, n, data, 2, fields);
  free(data);
  return status;
}

static void ReadColumn(const char file[], const char set[], size_t start, size_t rows, double *values)
{
  OutputFile f;

  OutputFileOpen(In(file), OUTPUT_READ, 0, PETSC_FALSE, &f);
  OutputFileRead(&f, set, H5T_NATIVE_DOUBLE, start, rows, values);
  if (!OutputFileClose(&f, PETSC_FALSE)) fail_msg("%s: %s", file, f.reason);
}

static PetscInt64 CountRows(const char file[], const char set[])
{
  OutputFile f;
  PetscInt64 rows;

  OutputFileOpen(In(file), OUTPUT_READ, 0, PETSC_FALSE, &f);
  OutputFileGetSize(&f, set, &rows, NULL, NULL);
  if (!OutputFileClose(&f, PETSC_FALSE)) fail_msg("%s: %s", file, f.reason);
  return rows;
}

static void particles_come_back_at_every_time(void **state)
{
  static const PetscInt n[4] = {5, 5, 7, 5}; // the number changes twice
  Series                series;
  double                values[21];

  (void)state;
  assert_petsc(SeriesCreate(directory, "fluid", SERIES_POINTS, "run: {end: 1}  # H\xc3\xb6he\n", PETSC_FALSE, 0, &series));
  for (int s = 0; s < 4; s++) assert_petsc(WriteWater(series, 0.1 * s, n[s]));
  assert_petsc(SeriesDestroy(&series));

  assert_int_equal(CountRows("fluid.vtkhdf", "/VTKHDF/Points"), 22);
  assert_int_equal(CountRows("fluid.vtkhdf", "/VTKHDF/NumberOfPoints"), 3); // the second step shares the first one's numbering
  ReadColumn("fluid.vtkhdf", "/VTKHDF/PointData/velocity", 10, 7, values);
  for (int i = 0; i < 7; i++)
    for (int c = 0; c < 3; c++) assert_close(values[3 * i + c], 20 + i + 0.25 * c, 1e-7, 30); // stored single
  ReadColumn("fluid.vtkhdf", "/VTKHDF/Steps/PointOffsets", 0, 4, values);
  assert_true(values[0] == 0 && values[1] == 5 && values[2] == 10 && values[3] == 17);
  ReadColumn("fluid.vtkhdf", "/VTKHDF/Steps/PartOffsets", 0, 4, values);
  assert_true(values[0] == 0 && values[1] == 0 && values[2] == 1 && values[3] == 2);
}

/* two tetrahedra whose points move */
static PetscErrorCode WriteBody(const char name[], PetscBool append, PetscReal from, int first, int last,
                                PetscBool double_precision)
{
  static const PetscReal rest[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
  static const PetscInt  tets[8]  = {0, 1, 2, 3, 1, 2, 3, 4};
  Series                 series;
  PetscReal              x[15], u[15];

  PetscFunctionBegin;
  ByCall(SeriesCreate(directory, name, SERIES_TETRAHEDRA, "", append, from, &series));
  PetscCall(SeriesSetDoublePrecision(series, double_precision));
  PetscCall(SeriesSetCells(series, 2, tets));
  for (int s = first; s <= last; s++) {
    const OutputField fields[1] = {{"displacement", "m", 3, u}};

    for (int i = 0; i < 15; i++) u[i] = 0.1 * s * (i + 1) / 3;
    for (int i = 0; i < 15; i++) x[i] = rest[i] + u[i];
    ByCall(SeriesWrite(series, 0.25 * s, 5, x, 1, fields));
  }
  PetscCall(SeriesDestroy(&series));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void topology_of_a_body_is_stored_once(void **state)
{
  double values[15];

  (void)state;
  assert_petsc(WriteBody("flap", PETSC_FALSE, 0, 0, 3, PETSC_TRUE));
  assert_int_equal(CountRows("flap.vtkhdf", "/VTKHDF/Connectivity"), 8);
  assert_int_equal(CountRows("flap.vtkhdf", "/VTKHDF/Types"), 2);
  assert_int_equal(CountRows("flap.vtkhdf", "/VTKHDF/Points"), 20);
  ReadColumn("flap.vtkhdf", "/VTKHDF/PointData/displacement", 15, 5, values);
  for (int i = 0; i < 15; i++) assert_close(values[i], 0.1 * 3 * (i + 1) / 3, 0, 1); // double: bit for bit
  ReadColumn("flap.vtkhdf", "/VTKHDF/Types", 0, 2, values);
  assert_true(values[0] == 10 && values[1] == 10);
}

/* one quadratic tetrahedron, its nodes in VTK's order */
static void quadratic_cells_are_stored(void **state)
{
  static const PetscReal x[30] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, .5, 0, 0, .5, .5, 0, 0, .5, 0, 0, 0, .5, .5, 0, .5, 0, .5, .5};
  static const PetscInt  cell[10] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const OutputField      fields[1] = {{"displacement", "m", 3, x}};
  double                 values[1];
  Series                 series;

  (void)state;
  assert_petsc(SeriesCreate(directory, "curved", SERIES_TETRAHEDRA_QUADRATIC, "", PETSC_FALSE, 0, &series));
  assert_petsc(SeriesSetCells(series, 1, cell));
  for (int s = 0; s < 2; s++) assert_petsc(SeriesWrite(series, s, 10, x, 1, fields));
  assert_petsc(SeriesDestroy(&series));
  assert_int_equal(CountRows("curved.vtkhdf", "/VTKHDF/Connectivity"), 10);
  ReadColumn("curved.vtkhdf", "/VTKHDF/Types", 0, 1, values);
  assert_true(values[0] == 24);
}

static void a_resumed_series_is_the_uninterrupted_one(void **state)
{
  static const char *const sets[] = {"/VTKHDF/Points",
                                     "/VTKHDF/PointData/displacement",
                                     "/VTKHDF/Steps/Values",
                                     "/VTKHDF/Steps/PointOffsets",
                                     "/VTKHDF/Steps/PartOffsets",
                                     "/VTKHDF/Steps/CellOffsets",
                                     "/VTKHDF/Steps/PointDataOffsets/displacement",
                                     "/VTKHDF/Connectivity",
                                     "/VTKHDF/Offsets",
                                     "/VTKHDF/NumberOfPoints"};

  (void)state;
  assert_petsc(WriteBody("whole", PETSC_FALSE, 0, 0, 5, PETSC_FALSE));
  assert_petsc(WriteBody("cut", PETSC_FALSE, 0, 0, 4, PETSC_FALSE)); // went on to 1.0 after the checkpoint at 0.5
  assert_petsc(WriteBody("cut", PETSC_TRUE, 0.5, 3, 5, PETSC_FALSE));
  for (size_t s = 0; s < PETSC_STATIC_ARRAY_LENGTH(sets); s++) {
    const PetscInt64 rows = CountRows("whole.vtkhdf", sets[s]);
    double           a[90], b[90];

    assert_int_equal(CountRows("cut.vtkhdf", sets[s]), rows);
    assert_true(rows > 0 && rows <= 30);
    memset(a, 0, sizeof(a));
    memset(b, 0, sizeof(b));
    ReadColumn("whole.vtkhdf", sets[s], 0, (size_t)rows, a);
    ReadColumn("cut.vtkhdf", sets[s], 0, (size_t)rows, b);
    assert_memory_equal(a, b, sizeof(a));
  }
}

static void a_series_resumed_before_its_first_step_begins_anew(void **state)
{
  Series series;

  (void)state;
  assert_petsc(SeriesCreate(directory, "early", SERIES_POINTS, "", PETSC_FALSE, 0, &series));
  assert_petsc(SeriesDestroy(&series));
  assert_petsc(SeriesCreate(directory, "early", SERIES_POINTS, "", PETSC_TRUE, 0, &series)); // killed before any output
  assert_petsc(WriteWater(series, 0.5, 9));
  assert_petsc(SeriesDestroy(&series));
  assert_petsc(SeriesCreate(directory, "early", SERIES_POINTS, "", PETSC_TRUE, 0.1, &series)); // before the only step
  assert_petsc(WriteWater(series, 0.25, 4));
  assert_petsc(SeriesDestroy(&series));
  assert_int_equal(CountRows("early.vtkhdf", "/VTKHDF/Points"), 4);
  assert_int_equal(CountRows("early.vtkhdf", "/VTKHDF/Steps/Values"), 1);
  assert_petsc(SeriesCreate(directory, "missing", SERIES_POINTS, "", PETSC_TRUE, 0.5, &series)); // lost: a new one
  assert_petsc(WriteWater(series, 0.75, 3));
  assert_petsc(SeriesDestroy(&series));
}

static void a_step_without_particles_is_stored(void **state)
{
  Series series;

  (void)state;
  assert_petsc(SeriesCreate(directory, "empty", SERIES_POINTS, "", PETSC_FALSE, 0, &series));
  assert_petsc(WriteWater(series, 0, 0)); // the body is still dry: no proxies
  assert_petsc(WriteWater(series, 1, 3));
  assert_petsc(WriteWater(series, 2, 0));
  assert_petsc(SeriesDestroy(&series));
  assert_int_equal(CountRows("empty.vtkhdf", "/VTKHDF/Steps/Values"), 3);
  assert_int_equal(CountRows("empty.vtkhdf", "/VTKHDF/Points"), 3);
}

static void a_surface_without_fields_can_be_continued(void **state)
{
  static const PetscReal x[12]    = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  static const PetscInt  cells[6] = {0, 1, 2, 1, 2, 3};
  Series                 series;

  (void)state;
  for (int i = 0; i < 3; i++) {
    assert_petsc(SeriesCreate(directory, "cylinder", SERIES_TRIANGLES, "", i > 0, 1.0 * i, &series));
    assert_petsc(SeriesSetCells(series, 2, cells));
    assert_petsc(SeriesWrite(series, i, 4, x, 0, NULL));
    assert_petsc(SeriesWrite(series, i + 0.5, 4, x, 0, NULL));
    assert_petsc(SeriesDestroy(&series));
  }
  assert_int_equal(CountRows("cylinder.vtkhdf", "/VTKHDF/Steps/Values"), 6);
  assert_int_equal(CountRows("cylinder.vtkhdf", "/VTKHDF/Polygons/Connectivity"), 6);
  assert_int_equal(CountRows("cylinder.vtkhdf", "/VTKHDF/Lines/Offsets"), 1);
}

/* run `body` with stderr into a file; returns its text */
static const char *Caught(void (*body)(void *), void *context)
{
  static char text[4096];
  const int   keep = dup(STDERR_FILENO), file = open("/tmp", O_TMPFILE | O_RDWR, 0600);
  ssize_t     n;

  assert_true(file >= 0);
  fflush(stderr);
  dup2(file, STDERR_FILENO);
  body(context);
  fflush(stderr);
  dup2(keep, STDERR_FILENO);
  close(keep);
  n                   = pread(file, text, sizeof(text) - 1, 0);
  text[n > 0 ? n : 0] = '\0';
  close(file);
  return text;
}

typedef struct {
  const char    *where;
  PetscErrorCode status;
  int            written;
} Attempt;

static void AttemptCreate(void *context)
{
  Attempt *a = (Attempt *)context;
  Series   series;

  a->status = SeriesCreate(a->where, "fluid", SERIES_POINTS, "", PETSC_FALSE, 0, &series);
}

static void AttemptMakeDirectory(void *context)
{
  Attempt *a = (Attempt *)context;

  a->status = OutputMakeDirectory(a->where);
}

static void what_cannot_be_created_is_one_line_with_the_reason(void **state)
{
  char    expected[2200], where[2048];
  Attempt a = {NULL, 0, 0};

  (void)state;
  snprintf(where, sizeof(where), "%s/nowhere", directory);
  a.where = where;
  snprintf(expected, sizeof(expected), "cannot write %s/fluid.vtkhdf: No such file or directory\n", where);
  assert_string_equal(Caught(AttemptCreate, &a), expected);
  assert_int_equal(a.status, BY_ERR_OUTPUT);

  fclose(fopen(In("file"), "w"));
  snprintf(where, sizeof(where), "%s/file/runs", directory);
  snprintf(expected, sizeof(expected), "cannot write %s: Not a directory\n", where);
  assert_string_equal(Caught(AttemptMakeDirectory, &a), expected);
  assert_int_equal(a.status, BY_ERR_OUTPUT);
  snprintf(where, sizeof(where), "/proc/no");
  assert_string_equal(Caught(AttemptMakeDirectory, &a), "cannot write /proc/no: No such file or directory\n");

  snprintf(where, sizeof(where), "%s/a/b//c/", directory);
  assert_petsc(OutputMakeDirectory(where));
  assert_petsc(OutputMakeDirectory(where)); // again
  assert_petsc(access(In("a/b/c"), F_OK));
}

/* steps until one fails */
static void AttemptSteps(void *context)
{
  Attempt *a = (Attempt *)context;
  Series   series;

  a->written = 0;
  a->status  = SeriesCreate(a->where, "fluid", SERIES_POINTS, "", PETSC_FALSE, 0, &series);
  while (!a->status && a->written < 100) {
    a->status = TryWater(series, 0.1 * a->written, 3000);
    if (!a->status) a->written++;
  }
  if (series) {
    assert_int_equal(TryWater(series, 100, 3000), BY_ERR_OUTPUT); // and silent
    assert_petsc(SeriesDestroy(&series));
  }
}

/* `written` whole steps can be read, and the XDMF names as many */
static void CheckWhole(const char where[], int written)
{
  OutputFile f;
  double     values[9000];
  char       path[2048], line[1024];
  int        times = 0;
  FILE      *xmf;

  snprintf(path, sizeof(path), "%s/fluid.vtkhdf", where);
  OutputFileOpen(path, OUTPUT_READ, 0, PETSC_FALSE, &f);
  for (int s = 0; s < written; s++) {
    OutputFileRead(&f, "/VTKHDF/PointData/velocity", H5T_NATIVE_DOUBLE, (size_t)s * 3000, 3000, values);
    if (!f.failed) assert_close(values[8999], sin(8999.0 * 8999.0 + 0.1 * s), 1e-7, 1);
  }
  OutputFileRead(&f, "/VTKHDF/Steps/Values", H5T_NATIVE_DOUBLE, 0, (size_t)written, values);
  if (!OutputFileClose(&f, PETSC_FALSE)) fail_msg("%s after %d steps: %s", path, written, f.reason);
  snprintf(path, sizeof(path), "%s/fluid.xmf", where);
  xmf = fopen(path, "r");
  assert_non_null(xmf);
  while (fgets(line, sizeof(line), xmf)) times += strstr(line, "<Time") != NULL;
  fclose(xmf);
  assert_true(times == written || times == written - 1); // the XDMF itself may be what did not fit
}

static void a_file_over_the_limit_is_reported_and_stays_readable(void **state)
{
  struct rlimit old, limit;
  Attempt       a = {directory, 0, 0};
  char          expected[2048];

  (void)state;
  getrlimit(RLIMIT_FSIZE, &old);
  limit          = old;
  limit.rlim_cur = 600000;
  assert_petsc(setrlimit(RLIMIT_FSIZE, &limit));
  const char *text = Caught(AttemptSteps, &a);
  assert_petsc(setrlimit(RLIMIT_FSIZE, &old));
  snprintf(expected, sizeof(expected), "cannot write %s/fluid.vtkhdf: File too large\n", directory);
  assert_string_equal(text, expected);
  assert_int_equal(a.status, BY_ERR_OUTPUT);
  assert_in_range(a.written, 2, 20);
  CheckWhole(directory, a.written);
}

static void a_full_disk_is_reported_and_results_stay_readable(void **state)
{
  char    where[2048];
  Attempt a = {where, 0, 0};

  (void)state;
  snprintf(where, sizeof(where), "%s/small", directory);
  assert_petsc(OutputMakeDirectory(where));
  if (mount("tmpfs", where, "tmpfs", 0, "size=700k")) {
    print_message("not root: no small disk to fill, test left out\n");
    return;
  }
  const char *text = Caught(AttemptSteps, &a);
  char        expected[2200];

  snprintf(expected, sizeof(expected), "cannot write %s/fluid.vtkhdf: No space left on device\n", where);
  if (strcmp(text, expected) == 0 && a.written >= 2) CheckWhole(where, a.written);
  assert_petsc(umount(where));
  assert_string_equal(text, expected);
  assert_int_equal(a.status, BY_ERR_OUTPUT);
  assert_in_range(a.written, 2, 20);
}

/* the write itself fails although space was asked for before, as on network disks: nothing is written over what is good */
static void AttemptBrokenDescriptor(void *context)
{
  Attempt   *a = (Attempt *)context;
  OutputFile f;
  double     values[60000];
  void      *handle;
  int        null;

  memset(values, 1, sizeof(values));
  OutputFileOpen(In("fluid.vtkhdf"), OUTPUT_CHANGE, 0, PETSC_FALSE, &f);
  H5Fget_vfd_handle(f.id, H5P_DEFAULT, &handle);
  null = open(In("fluid.vtkhdf"), O_RDONLY);
  dup2(null, *(int *)handle); // writing to it fails from here on
  close(null);
  OutputFileAppend(&f, "/VTKHDF/PointData/velocity", H5T_NATIVE_DOUBLE, 20000, values);
  a->status = OutputFileClose(&f, PETSC_FALSE) ? PETSC_SUCCESS : OutputReport(f.path, f.reason);
}

static void a_write_that_fails_late_leaves_the_file_as_it_was(void **state)
{
  Series      series;
  Attempt     a = {directory, 0, 0};
  struct stat before, after;
  char        expected[2048];

  (void)state;
  assert_petsc(SeriesCreate(directory, "fluid", SERIES_POINTS, "", PETSC_FALSE, 0, &series));
  for (int s = 0; s < 3; s++) assert_petsc(TryWater(series, 0.1 * s, 3000));
  assert_petsc(SeriesDestroy(&series));
  assert_petsc(stat(In("fluid.vtkhdf"), &before));
  snprintf(expected, sizeof(expected), "cannot write %s/fluid.vtkhdf: Bad file descriptor\n", directory);
  assert_string_equal(Caught(AttemptBrokenDescriptor, &a), expected);
  assert_int_equal(a.status, BY_ERR_OUTPUT);
  assert_petsc(stat(In("fluid.vtkhdf"), &after));
  assert_int_equal(before.st_size, after.st_size);
  CheckWhole(directory, 3);
}

/* written without pause until killed; the number of points changes, so that chunks are shared by steps */
static void WriteUntilKilled(void)
{
  Series series;

  if (SeriesCreate(directory, "killed", SERIES_POINTS, "", PETSC_FALSE, 0, &series)) _exit(1);
  for (int s = 0; !TryWater(series, 0.1 * s, 3000 + s % 3); s++) continue;
  _exit(1);
}

static void a_killed_run_leaves_whole_steps(void **state)
{
  (void)state;
  for (int attempt = 0; attempt < 12; attempt++) {
    const pid_t child = fork();
    OutputFile  f;
    double      values[9006], start;
    PetscInt64  n_steps;

    assert_true(child >= 0);
    if (!child) WriteUntilKilled();
    usleep((useconds_t)(30000 + 3700 * attempt));
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    OutputFileOpen(In("killed.vtkhdf"), OUTPUT_READ, 0, PETSC_FALSE, &f);
    n_steps = OutputFileGetInt(&f, "/VTKHDF/Steps", "NSteps");
    for (PetscInt64 s = 0; s < n_steps && !f.failed; s++) {
      const double last = 8999.0 + 3 * (double)(s % 3);

      OutputFileRead(&f, "/VTKHDF/Steps/PointOffsets", H5T_NATIVE_DOUBLE, (size_t)s, 1, &start);
      OutputFileRead(&f, "/VTKHDF/PointData/velocity", H5T_NATIVE_DOUBLE, (size_t)start, 3000 + (size_t)(s % 3), values);
      if (!f.failed) assert_close(values[(int)last], sin(last * last + 0.1 * (double)s), 1e-7, 1);
    }
    if (!OutputFileClose(&f, PETSC_FALSE) && n_steps > 0) fail_msg("killed after %lld steps: %s", (long long)n_steps, f.reason);
  }
}

static void a_damaged_series_is_refused_and_left_alone(void **state)
{
  Series         series;
  FILE          *file;
  PetscErrorCode status;

  (void)state;
  file = fopen(In("broken.vtkhdf"), "w");
  fputs("this is not HDF5", file);
  fclose(file);
  status = SeriesCreate(directory, "broken", SERIES_POINTS, "", PETSC_TRUE, 1, &series);
  assert_int_equal(status, BY_ERR_INPUT);
  struct stat info;
  assert_petsc(stat(In("broken.vtkhdf"), &info));
  assert_int_equal(info.st_size, 16);
}

static int Begin(void **state)
{
  const char *given = getenv("BYSSUS_TEST_DIRECTORY"); // test_results.py reads what is left there

  (void)state;
  if (given) {
    snprintf(directory, sizeof(directory), "%s", given);
    return 0;
  }
  snprintf(directory, sizeof(directory), "/tmp/byssus.XXXXXX");
  return mkdtemp(directory) ? 0 : -1;
}

static int End(void **state)
{
  char command[PETSC_MAX_PATH_LEN + 16];

  (void)state;
  if (getenv("BYSSUS_TEST_DIRECTORY")) return 0;
  snprintf(command, sizeof(command), "rm -r %s", directory);
  return system(command);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_file_over_the_limit_is_reported_and_stays_readable),
      cmocka_unit_test(a_full_disk_is_reported_and_results_stay_readable),
      cmocka_unit_test(a_write_that_fails_late_leaves_the_file_as_it_was),
      cmocka_unit_test(what_cannot_be_created_is_one_line_with_the_reason),
      cmocka_unit_test(a_killed_run_leaves_whole_steps),
    cmocka_unit_test(a_damaged_series_is_refused_and_left_alone),
      cmocka_unit_test(a_series_resumed_before_its_first_step_begins_anew),
      cmocka_unit_test(a_step_without_particles_is_stored),
      cmocka_unit_test(a_surface_without_fields_can_be_continued),
      cmocka_unit_test(a_resumed_series_is_the_uninterrupted_one),
      cmocka_unit_test(particles_come_back_at_every_time),
      cmocka_unit_test(topology_of_a_body_is_stored_once), cmocka_unit_test(quadratic_cells_are_stored),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, Begin, End);
  return PetscFinalize() || failed ? 1 : 0;
}
