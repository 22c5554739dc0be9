/* Checkpoints: every value comes back bit for bit; a checkpoint that is truncated anywhere, damaged, foreign or of another scene is
   refused with the file's name and what is wrong; and the old checkpoint survives a new one that cannot be written. */
#define _GNU_SOURCE /* pipe2 */
#include "check.h"
#include "checkpoint.h"
#include <fcntl.h>
#include <hdf5.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#define N 2000
static char directory[1024], path[1100];

static PetscReal Value(int i, int generation) { return sin(1.7 * i * i) * pow(10, i % 600 - 300) + generation; }

static PetscErrorCode Save(const char where[], int generation, PetscInt n)
{
  Checkpoint     c;
  PetscReal     *x;
  const PetscInt step = 100 + generation;
  PetscErrorCode status;

  x = (PetscReal *)malloc((size_t)n * sizeof(*x));
  for (PetscInt i = 0; i < n; i++) x[i] = Value(i, generation);
  status = CheckpointCreate(where, &c);
  if (!status) {
    assert_petsc(CheckpointWriteInt(c, "run/step", 1, &step));
    assert_petsc(CheckpointWriteReal(c, "fluid/x", n, x));
    assert_petsc(CheckpointWriteReal(c, "flap/u", 0, NULL));
    assert_petsc(CheckpointWriteString(c, "run/scene", "run: {end: 1} # \xc3\xa9\n"));
    status = CheckpointCommit(&c);
  }
  assert_null(c);
  free(x);
  return status;
}

#define WRONG_VALUE 1

/* 0, or the status of whatever fails first */
static PetscErrorCode Load(const char where[], int generation)
{
  Checkpoint     c;
  PetscReal      x[N];
  PetscInt       step, n, n_none, n_missing;
  char           text[64];
  PetscBool      same;
  PetscErrorCode status = CheckpointOpen(where, &c);

  if (status) return status;
  status = CheckpointReadInt(c, "run/step", 1, &step);
  if (!status) status = CheckpointGetSize(c, "fluid/x", &n);
  if (!status) status = CheckpointReadReal(c, "fluid/x", N, x);
  if (!status) status = CheckpointReadString(c, "run/scene", sizeof(text), text);
  if (!status) status = CheckpointGetSize(c, "flap/u", &n_none);
  if (!status) status = CheckpointGetSize(c, "no/such", &n_missing);
  if (!status) {
    same = step == 100 + generation && n == N && n_none == 0 && n_missing == -1 && !strcmp(text, "run: {end: 1} # \xc3\xa9\n")
               ? PETSC_TRUE
               : PETSC_FALSE;
    for (int i = 0; i < N && same; i++) {
      const PetscReal expected = Value(i, generation);
      same                     = memcmp(&x[i], &expected, sizeof(expected)) ? PETSC_FALSE : PETSC_TRUE;
    }
    if (!same) status = WRONG_VALUE;
  }
  assert_petsc(CheckpointClose(&c));
  return status;
}

/* stderr of what follows goes to a pipe (that no limit of files concerns) until Release() */
static int  kept = -1, catcher = -1;
static void Catch(void)
{
  int ends[2];

  fflush(stderr);
  kept = dup(STDERR_FILENO);
  assert_petsc(pipe2(ends, O_NONBLOCK));
  dup2(ends[1], STDERR_FILENO);
  close(ends[1]);
  catcher = ends[0];
}

static const char *Release(void)
{
  static char text[4096];
  ssize_t     n;

  if (kept < 0) return text;
  fflush(stderr);
  n                   = read(catcher, text, sizeof(text) - 1);
  text[n > 0 ? n : 0] = '\0';
  dup2(kept, STDERR_FILENO);
  close(kept);
  close(catcher);
  kept = -1;
  return text;
}

/* after a test that failed while stderr was caught */
static int ReleaseAfter(void **state)
{
  (void)state;
  (void)Release();
  return 0;
}

/* the message names the file, says `what`, and the status is that of bad input */
#define assert_refused(status, what)                                                                                               \
  do {                                                                                                                             \
    const PetscErrorCode got_  = (status);                                                                                         \
    const char          *text_ = Release();                                                                                        \
    if (got_ != BY_ERR_INPUT || !strstr(text_, path) || !strstr(text_, what))                                                      \
      fail_msg("status %d, message \"%s\", expected %s and \"%s\"", (int)got_, text_, path, what);                                 \
  } while (0)

static void every_value_comes_back_bit_for_bit(void **state)
{
  (void)state;
  assert_petsc(Save(directory, 1, N));
  assert_petsc(Load(directory, 1));
  assert_petsc(Save(directory, 2, N)); // over the old one
  assert_petsc(Load(directory, 2));
}

static char *Bytes(size_t *n)
{
  FILE *f = fopen(path, "rb");
  char *bytes;

  fseek(f, 0, SEEK_END);
  *n = (size_t)ftell(f);
  rewind(f);
  bytes = (char *)malloc(*n);
  assert_int_equal(fread(bytes, 1, *n, f), *n);
  fclose(f);
  return bytes;
}

static void PutBytes(const char bytes[], size_t n)
{
  FILE *f = fopen(path, "wb");

  assert_int_equal(fwrite(bytes, 1, n, f), n);
  fclose(f);
}

static void a_truncated_checkpoint_is_refused_at_every_length(void **state)
{
  size_t n;
  char  *bytes;

  (void)state;
  assert_petsc(Save(directory, 3, N));
  bytes = Bytes(&n);
  for (size_t length = 0; length < n; length += length < 200 || n - length < 200 ? 1 : 487) {
    PutBytes(bytes, length);
    Catch();
    assert_refused(Load(directory, 3), "not a whole HDF5 file");
  }
  PutBytes(bytes, n);
  assert_petsc(Load(directory, 3));
  free(bytes);
}

static void a_damaged_checkpoint_is_refused_or_unhurt(void **state)
{
  size_t n, refused = 0, unhurt = 0;
  char  *bytes;

  (void)state;
  assert_petsc(Save(directory, 4, N));
  bytes = Bytes(&n);
  for (size_t at = 0; at < n; at += at < 4096 ? 37 : 173) {
    PetscErrorCode status;

    bytes[at] ^= 0x55;
    PutBytes(bytes, n);
    bytes[at] ^= 0x55;
    Catch();
    status           = Load(directory, 4); // with wrong values it is not good; with good ones what was hit was padding
    const char *text = Release();
    if (status && (status != BY_ERR_INPUT || !strstr(text, path))) fail_msg("byte %zu: status %d, \"%s\"", at, (int)status, text);
    if (status) refused++;
    else unhurt++;
  }
  assert_true(refused > 4 * unhurt); // most of the file is values under a checksum
  free(bytes);
}

static void what_is_not_a_checkpoint_of_this_scene_is_refused(void **state)
{
  Checkpoint c;
  PetscReal  x[N + 1];
  PetscInt   step[2];
  char       text[8], elsewhere[1200];
  hid_t      file;

  (void)state;
  assert_petsc(Save(directory, 5, N));
  assert_petsc(CheckpointOpen(directory, &c));
  Catch();
  assert_refused(CheckpointReadReal(c, "fluid/x", N + 1, x), "fluid/x has 2000 values where the scene needs 2001");
  Catch();
  assert_refused(CheckpointReadReal(c, "fluid/v", N, x), "it has no fluid/v");
  Catch();
  assert_refused(CheckpointReadInt(c, "fluid/x", N, step), "fluid/x holds real numbers where integers are expected");
  Catch();
  assert_refused(CheckpointReadString(c, "run/scene", sizeof(text), text), "too long");
  assert_petsc(CheckpointReadInt(c, "run/step", 1, step)); // still good
  assert_petsc(CheckpointClose(&c));

  unlink(path);
  Catch();
  assert_refused(Load(directory, 5), "No such file or directory");
  PutBytes("mesh", 4);
  Catch();
  assert_refused(Load(directory, 5), "not a whole HDF5 file");
  file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  Catch();
  assert_refused(Load(directory, 5), "not a checkpoint of this program");
  unlink(path);
  mkdir(path, 0777);
  Catch();
  assert_refused(Load(directory, 5), "not a whole HDF5 file");
  rmdir(path);

  snprintf(elsewhere, sizeof(elsewhere), "%s/nowhere", directory);
  Catch();
  assert_int_equal(CheckpointCreate(elsewhere, &c), BY_ERR_OUTPUT);
  assert_non_null(strstr(Release(), "/nowhere/checkpoint.h5: No such file or directory\n"));
  assert_null(c);
}

/* a failed Save says one line, leaves no new file and the old checkpoint */
static void CheckSurvival(const char where[], const char text[], const char reason[])
{
  char expected[2048], temporary[1200];

  snprintf(expected, sizeof(expected), "cannot write %s/checkpoint.h5: %s\n", where, reason);
  assert_string_equal(text, expected);
  snprintf(temporary, sizeof(temporary), "%s/checkpoint.h5.new", where);
  assert_int_equal(access(temporary, F_OK), -1);
  assert_petsc(Load(where, 6));
}

static void the_old_checkpoint_survives_a_failed_one(void **state)
{
  struct rlimit  old, limit;
  PetscErrorCode status;
  char           small[1100];

  (void)state;
  assert_petsc(Save(directory, 6, N));
  getrlimit(RLIMIT_FSIZE, &old);
  limit = old;
  for (rlim_t size = 0; size <= 400000; size += 100000) {
    limit.rlim_cur = size;
    Catch();
    setrlimit(RLIMIT_FSIZE, &limit);
    status = Save(directory, 7, 100000); // 800 kB
    setrlimit(RLIMIT_FSIZE, &old);
    CheckSurvival(directory, Release(), "File too large");
    assert_int_equal(status, BY_ERR_OUTPUT);
  }

  snprintf(small, sizeof(small), "%s/small", directory);
  assert_petsc(OutputMakeDirectory(small));
  if (mount("tmpfs", small, "tmpfs", 0, "size=600k")) {
    print_message("not root: no small disk to fill, half of the test left out\n");
    return;
  }
  assert_petsc(Save(small, 6, N));
  Catch();
  status           = Save(small, 7, 100000);
  const char *text = Release();
  if (status == BY_ERR_OUTPUT) CheckSurvival(small, text, "No space left on device");
  assert_petsc(umount(small));
  assert_int_equal(status, BY_ERR_OUTPUT);
}

static int Begin(void **state)
{
  (void)state;
  snprintf(directory, sizeof(directory), "/tmp/byssus.XXXXXX");
  if (!mkdtemp(directory)) return -1;
  snprintf(path, sizeof(path), "%s/checkpoint.h5", directory);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  return 0;
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
      cmocka_unit_test_teardown(every_value_comes_back_bit_for_bit, ReleaseAfter),
      cmocka_unit_test_teardown(a_truncated_checkpoint_is_refused_at_every_length, ReleaseAfter),
      cmocka_unit_test_teardown(a_damaged_checkpoint_is_refused_or_unhurt, ReleaseAfter),
      cmocka_unit_test_teardown(what_is_not_a_checkpoint_of_this_scene_is_refused, ReleaseAfter),
      cmocka_unit_test_teardown(the_old_checkpoint_survives_a_failed_one, ReleaseAfter),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, Begin, End);
  return PetscFinalize() || failed ? 1 : 0;
}
