/* output_file.c - one HDF5 file with errors that stick; see output_file.h. */
#define _GNU_SOURCE /* fallocate, memfd_create */
#include "output_file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/* room for HDF5's own tables beside the data of one step */
#define RESERVE_EXTRA ((size_t)128 * 1024)

void OutputFileFail(OutputFile *file, const char format[], ...)
{
  va_list arguments;

  if (file->failed) return;
  file->failed = PETSC_TRUE;
  va_start(arguments, format);
  vsnprintf(file->reason, sizeof(file->reason), format, arguments);
  va_end(arguments);
}

/* innermost first: the system's own words when there are some, else HDF5's innermost description */
static herr_t FindReason(unsigned n, const H5E_error2_t *error, void *context)
{
  static const char mark[] = "error message = '";
  char             *reason = (char *)context;
  const char       *words  = error->desc ? strstr(error->desc, mark) : NULL;

  if (words) {
    const char *end = strchr(words + sizeof(mark) - 1, '\'');
    snprintf(reason, 256, "%.*s", end ? (int)(end - words - (sizeof(mark) - 1)) : 200, words + sizeof(mark) - 1);
    return 1;
  }
  if (n == 0 && error->desc) snprintf(reason, 256, "%s", error->desc);
  return 0;
}

static void FailFromHDF5(OutputFile *file, const char doing[], const char name[])
{
  char reason[256] = "unknown reason";

  if (file->failed) return;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, FindReason, reason);
  if (file->writing) OutputFileFail(file, "%s", reason);
  else OutputFileFail(file, "%s%s%s: %s", doing, *name ? " " : "", name, reason);
}

/* the file descriptor behind an open file, -1 when there is none */
static int GetDescriptor(OutputFile *file)
{
  void *handle = NULL;

  if (file->id < 0 || H5Fget_vfd_handle(file->id, H5P_DEFAULT, &handle) < 0 || !handle) return -1;
  return *(int *)handle;
}

/* see that `bytes` more fit behind a descriptor */
static void Reserve(OutputFile *file, int fd, size_t bytes)
{
  struct rlimit limit;
  struct stat   status;

  if (fstat(fd, &status)) return;
  bytes += bytes / 50 + RESERVE_EXTRA;
  if (!getrlimit(RLIMIT_FSIZE, &limit) && limit.rlim_cur != RLIM_INFINITY && (rlim_t)status.st_size + bytes > limit.rlim_cur) {
    OutputFileFail(file, "%s", strerror(EFBIG));
    return;
  }
  // blocks beyond the end of the file; file systems that cannot do it find out while writing
  if (fallocate(fd, FALLOC_FL_KEEP_SIZE, status.st_size, (off_t)bytes) && (errno == ENOSPC || errno == EDQUOT || errno == EFBIG))
    OutputFileFail(file, "%s", strerror(errno));
}

void OutputFileReserve(OutputFile *file, size_t bytes)
{
  const int fd = GetDescriptor(file);

  if (!file->failed && fd >= 0) Reserve(file, fd, bytes);
}

void OutputFileOpen(const char path[], OutputMode mode, size_t bytes, PetscBool checksums, OutputFile *file)
{
  hid_t access, create;
  int   fd;

  memset(file, 0, sizeof(*file));
  file->id      = -1;
  file->writing = mode == OUTPUT_READ ? PETSC_FALSE : PETSC_TRUE;
  snprintf(file->path, sizeof(file->path), "%s", path);
  OutputIgnoreSizeSignal();
  H5open();
  H5Eget_auto2(H5E_DEFAULT, &file->print, &file->print_data);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);

  // the system first: its reasons are clearer than HDF5's, and HDF5 is best not begun with a disk that is full
  fd = open(path, mode == OUTPUT_READ ? O_RDONLY : mode == OUTPUT_CHANGE ? O_RDWR : O_RDWR | O_CREAT | O_TRUNC, 0666);
  if (fd < 0) {
    OutputFileFail(file, "%s", strerror(errno));
    return;
  }
  if (mode != OUTPUT_READ) Reserve(file, fd, bytes);
  close(fd);
  if (file->failed) return;

  // no locks: a viewer that has the file open must not stop the run, nor the run the viewer
  access = H5Pcreate(H5P_FILE_ACCESS);
  create = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_fapl_sec2(access);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  H5Pset_file_locking(access, 0, 1);

  // space that was given up is never used again: until a flush is through, the file on disk still refers to it
  if (!checksums) H5Pset_file_space_strategy(create, H5F_FSPACE_STRATEGY_NONE, 0, 1);
  if (checksums) H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
  if (mode == OUTPUT_CREATE) file->id = H5Fcreate(path, H5F_ACC_TRUNC, create, access);
  else file->id = H5Fopen(path, mode == OUTPUT_READ ? H5F_ACC_RDONLY : H5F_ACC_RDWR, access);
  if (file->id < 0) FailFromHDF5(file, "not a whole HDF5 file", "");
  H5Pclose(create);
  H5Pclose(access);
}

void OutputFileFlush(OutputFile *file)
{
  if (!file->failed && H5Fflush(file->id, H5F_SCOPE_LOCAL) < 0) FailFromHDF5(file, "flush", "");
}

PetscBool OutputFileClose(OutputFile *file, PetscBool sync)
{
  const H5E_auto2_t print = file->print;
  struct stat       status;

  if (file->id >= 0) {
    // everything to the system first, while a failure can still be told from a bad close
    if (file->writing) OutputFileFlush(file);
    if (!file->failed && file->writing && sync && fsync(GetDescriptor(file))) OutputFileFail(file, "%s", strerror(errno));

    // after a failure HDF5 would try again to write what it holds, over a file that is good up to the last step, and when that
    // fails too it crashes at exit (1.10.8): let it write into memory that is then given up
    if (file->failed && file->writing) {
      const int fd = GetDescriptor(file), memory = memfd_create("byssus", MFD_CLOEXEC);

      if (fd >= 0 && memory >= 0) dup2(memory, fd);
      if (memory >= 0) close(memory);
    }
    if (H5Fclose(file->id) < 0 && !file->failed) FailFromHDF5(file, "close", "");
    file->id = -1;
  }
  // give back the blocks that were reserved and not used
  if (file->writing && !stat(file->path, &status) && truncate(file->path, status.st_size))
    OutputFileFail(file, "%s", strerror(errno));
  H5Eset_auto2(H5E_DEFAULT, print, file->print_data);
  return file->failed ? PETSC_FALSE : PETSC_TRUE;
}

void OutputFileGroup(OutputFile *file, const char name[])
{
  hid_t group;

  if (file->failed) return;
  group = H5Gcreate2(file->id, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group < 0 || H5Gclose(group) < 0) FailFromHDF5(file, "group", name);
}

void OutputFileCreateSet(OutputFile *file, const char name[], hid_t type, size_t columns, size_t rows, PetscBool compress)
{
  const size_t n_chunks =
      (rows + OUTPUT_CHUNK_MAX - 1) / OUTPUT_CHUNK_MAX; // of about equal size, so that chunks end where steps do
  const hsize_t none[2] = {0, columns}, most[2] = {H5S_UNLIMITED, columns};
  const hsize_t chunk[2] = {n_chunks ? (rows + n_chunks - 1) / n_chunks : 1, columns};
  const int     rank     = columns > 1 ? 2 : 1;
  hid_t         space, create, links, set;

  if (file->failed) return;
  space  = H5Screate_simple(rank, none, most);
  create = H5Pcreate(H5P_DATASET_CREATE);
  links  = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  H5Pset_chunk(create, rank, chunk);
  if (compress) {
    H5Pset_shuffle(create);
    H5Pset_deflate(create, 1);
  }
  set = H5Dcreate2(file->id, name, type, space, links, create, H5P_DEFAULT);
  if (set < 0 || H5Dclose(set) < 0) FailFromHDF5(file, "data set", name);
  H5Pclose(links);
  H5Pclose(create);
  H5Sclose(space);
}

void OutputFileWriteArray(OutputFile *file, const char name[], hid_t type, hid_t memory_type, size_t n, const void *data)
{
  const hsize_t extent[1] = {n};
  hid_t         space, links, set;

  if (file->failed) return;
  space = H5Screate_simple(1, extent, NULL);
  links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  set = H5Dcreate2(file->id, name, type, space, links, H5P_DEFAULT, H5P_DEFAULT);
  if (set < 0 || (n && H5Dwrite(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) || H5Dclose(set) < 0)
    FailFromHDF5(file, "write", name);
  H5Pclose(links);
  H5Sclose(space);
}

/* open a data set and tell its extent; negative after a failure */
static hid_t OpenSet(OutputFile *file, const char name[], int *rank, hsize_t extent[2])
{
  hid_t set, space;

  extent[0] = 0;
  extent[1] = 1;
  if (file->failed) return -1;
  set = H5Dopen2(file->id, name, H5P_DEFAULT);
  if (set < 0) {
    FailFromHDF5(file, "no data set", name);
    return -1;
  }
  space = H5Dget_space(set);
  *rank = H5Sget_simple_extent_ndims(space);
  if (*rank < 1 || *rank > 2 || H5Sget_simple_extent_dims(space, extent, NULL) < 0) {
    OutputFileFail(file, "data set %s has an unexpected shape", name);
    H5Dclose(set);
    set = -1;
  }
  H5Sclose(space);
  return set;
}

void OutputFileAppend(OutputFile *file, const char name[], hid_t memory_type, size_t rows, const void *data)
{
  hsize_t extent[2], start[2] = {0, 0}, count[2];
  int     rank;
  hid_t   set = OpenSet(file, name, &rank, extent), from, to;

  if (set < 0) return;
  start[0] = extent[0];
  count[0] = rows;
  count[1] = extent[1];
  extent[0] += rows;
  if (rows) {
    if (H5Dset_extent(set, extent) < 0) FailFromHDF5(file, "extend", name);
    from = H5Screate_simple(rank, count, NULL);
    to   = H5Dget_space(set);
    if (!file->failed && (H5Sselect_hyperslab(to, H5S_SELECT_SET, start, NULL, count, NULL) < 0 ||
                          H5Dwrite(set, memory_type, from, to, H5P_DEFAULT, data) < 0))
      FailFromHDF5(file, "write", name);
    H5Sclose(to);
    H5Sclose(from);
  }
  if (H5Dclose(set) < 0) FailFromHDF5(file, "write", name);
}

void OutputFileResize(OutputFile *file, const char name[], size_t rows)
{
  hsize_t extent[2];
  int     rank;
  hid_t   set = OpenSet(file, name, &rank, extent);

  if (set < 0) return;
  extent[0] = rows;
  if (H5Dset_extent(set, extent) < 0 || H5Dclose(set) < 0) FailFromHDF5(file, "resize", name);
}

void OutputFileRead(OutputFile *file, const char name[], hid_t memory_type, size_t start, size_t rows, void *data)
{
  hsize_t extent[2], from[2] = {start, 0}, count[2];
  int     rank;
  hid_t   set = OpenSet(file, name, &rank, extent), memory, space;

  if (set < 0) return;
  if (start + rows > extent[0])
    OutputFileFail(file, "data set %s has %llu rows where %llu are needed", name, (unsigned long long)extent[0],
                   (unsigned long long)(start + rows));
  if (rows && !file->failed) {
    count[0] = rows;
    count[1] = extent[1];
    memory   = H5Screate_simple(rank, count, NULL);
    space    = H5Dget_space(set);
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, from, NULL, count, NULL) < 0 ||
        H5Dread(set, memory_type, memory, space, H5P_DEFAULT, data) < 0)
      FailFromHDF5(file, "read", name);
    H5Sclose(space);
    H5Sclose(memory);
  }
  H5Dclose(set);
}

/* Whether every link of a path exists: H5Lexists alone fails on a missing group in the middle. */
static PetscBool PathExists(OutputFile *file, const char name[])
{
  char part[PETSC_MAX_PATH_LEN];

  for (const char *slash = strchr(name + 1, '/');; slash = strchr(slash + 1, '/')) {
    snprintf(part, sizeof(part), "%.*s", slash ? (int)(slash - name) : (int)strlen(name), name);
    const htri_t exists = H5Lexists(file->id, part, H5P_DEFAULT);

    if (exists < 0) FailFromHDF5(file, "group of", name);
    if (exists <= 0) return PETSC_FALSE;
    if (!slash) return PETSC_TRUE;
  }
}

void OutputFileGetSize(OutputFile *file, const char name[], PetscInt64 *rows, PetscInt64 *columns, H5T_class_t *kind)
{
  hsize_t extent[2];
  int     rank;
  hid_t   set, type;

  *rows = -1;
  if (columns) *columns = 1;
  if (file->failed || !PathExists(file, name)) return;
  set = OpenSet(file, name, &rank, extent);
  if (set < 0) return;
  *rows = (PetscInt64)extent[0];
  if (columns) *columns = (PetscInt64)extent[1];
  if (kind) {
    type  = H5Dget_type(set);
    *kind = H5Tget_class(type);
    H5Tclose(type);
  }
  H5Dclose(set);
}

/* fixed-length text, as wide as `value` */
static hid_t TextType(const char value[], H5T_cset_t characters)
{
  const hid_t type = H5Tcopy(H5T_C_S1);

  H5Tset_size(type, strlen(value) ? strlen(value) : 1);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, characters);
  return type;
}

void OutputFileWriteText(OutputFile *file, const char name[], const char value[])
{
  hid_t type, space, set;

  if (file->failed) return;
  type  = TextType(value, H5T_CSET_UTF8);
  space = H5Screate(H5S_SCALAR);
  set   = H5Dcreate2(file->id, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) < 0 || H5Dclose(set) < 0)
    FailFromHDF5(file, "write", name);
  H5Sclose(space);
  H5Tclose(type);
}

/* write an attribute; one that is there keeps its type and gets the new value */
static void SetAttribute(OutputFile *file, const char name[], const char attribute[], hid_t type, hid_t memory_type, hid_t space,
                         const void *value)
{
  hid_t object, a = -1;

  if (file->failed) return;
  object = H5Oopen(file->id, name, H5P_DEFAULT);
  if (object >= 0) {
    a = H5Aexists(object, attribute) > 0 ? H5Aopen(object, attribute, H5P_DEFAULT)
                                         : H5Acreate2(object, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT);
    if (a < 0 || H5Awrite(a, memory_type, value) < 0 || H5Aclose(a) < 0) FailFromHDF5(file, "attribute", attribute);
    H5Oclose(object);
  } else FailFromHDF5(file, "attribute", attribute);
}

void OutputFileSetText(OutputFile *file, const char name[], const char attribute[], const char value[])
{
  hid_t type, space;

  if (file->failed) return;
  type  = TextType(value, H5T_CSET_ASCII);
  space = H5Screate(H5S_SCALAR);
  SetAttribute(file, name, attribute, type, type, space, value);
  H5Sclose(space);
  H5Tclose(type);
}

void OutputFileSetInts(OutputFile *file, const char name[], const char attribute[], size_t n, const PetscInt64 values[])
{
  const hsize_t extent[1] = {n};
  hid_t         space;

  if (file->failed) return;
  space = n == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, extent, NULL);
  SetAttribute(file, name, attribute, H5T_STD_I64LE, H5T_NATIVE_INT64, space, values);
  H5Sclose(space);
}

PetscInt64 OutputFileGetInt(OutputFile *file, const char name[], const char attribute[])
{
  PetscInt64 value = -1;
  hid_t      a;

  if (file->failed || H5Aexists_by_name(file->id, name, attribute, H5P_DEFAULT) <= 0) return -1;
  a = H5Aopen_by_name(file->id, name, attribute, H5P_DEFAULT, H5P_DEFAULT);
  if (a < 0 || H5Aget_storage_size(a) != sizeof(value) || H5Aread(a, H5T_NATIVE_INT64, &value) < 0) value = -1;
  if (a >= 0) H5Aclose(a);
  return value;
}
