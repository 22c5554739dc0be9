/* checkpoint.c - the full state in one HDF5 file of checksummed arrays; see checkpoint.h.

   Writing goes to checkpoint.h5.new, which is synced and renamed by CheckpointCommit(): at any moment checkpoint.h5 is a whole
   file. The attribute `complete` is written last. HDF5 1.8's format guards its own tables by checksums, and every array carries one
   of its bytes, so that a damaged file is told from a good one. */
#include "checkpoint.h"
#include "output_file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#define FORMAT 1 /* raised when older checkpoints can no longer be read */

struct _Checkpoint {
  char       path[PETSC_MAX_PATH_LEN], directory[PETSC_MAX_PATH_LEN]; /* path: without .new */
  PetscBool  active, writing;
  OutputFile file;
};

/* report what is wrong with a checkpoint that is read */
static PetscErrorCode ReportUnreadable(Checkpoint checkpoint, const char reason[])
{
  return InputError("resume", "the checkpoint %s cannot be read: %s", checkpoint->path, reason);
}

static PetscErrorCode Begin(const char directory[], PetscBool writing, Checkpoint *checkpoint)
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(PetscNew(checkpoint));
  (*checkpoint)->file.id = -1;
  (*checkpoint)->writing = writing;
  (*checkpoint)->active  = rank == 0 || !writing ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscStrncpy((*checkpoint)->directory, directory && *directory ? directory : ".", PETSC_MAX_PATH_LEN));
  PetscFunctionReturn(OutputPath(directory, "checkpoint.h5", "", (*checkpoint)->path));
}

static void NewName(Checkpoint checkpoint, char path[PETSC_MAX_PATH_LEN + 8])
{
  snprintf(path, PETSC_MAX_PATH_LEN + 8, "%s.new", checkpoint->path);
}

/*@
  CheckpointCreate - begin a checkpoint in `directory`; the one that is there stays until CheckpointCommit()

  Not Collective, rank 0 writes

  Errors:
  BY_ERR_OUTPUT, reported as `cannot write <directory>/checkpoint.h5: reason`. Errors while writing are reported by
CheckpointCommit(), which is to be called in any case.
@*/
PetscErrorCode CheckpointCreate(const char directory[], Checkpoint *checkpoint)
{
  const PetscInt64 format = FORMAT;
  char             path[PETSC_MAX_PATH_LEN + 8];
  PetscErrorCode   status;

  PetscFunctionBegin;
  status = Begin(directory, PETSC_TRUE, checkpoint);
  if (status) {
    PetscCall(PetscFree(*checkpoint));
    PetscFunctionReturn(status);
  }
  if (!(*checkpoint)->active) PetscFunctionReturn(PETSC_SUCCESS);
  NewName(*checkpoint, path);
  OutputFileOpen(path, OUTPUT_CREATE, 0, PETSC_TRUE, &(*checkpoint)->file);
  OutputFileSetText(&(*checkpoint)->file, "/", "program", "byssus " BY_VERSION);
  OutputFileSetInts(&(*checkpoint)->file, "/", "format", 1, &format);
  if ((*checkpoint)->file.failed) PetscFunctionReturn(CheckpointCommit(checkpoint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FNV-1a, 64 bit, over the bytes of an array as they are in memory; its lower 63 bits, as -1 means that there is none */
static PetscInt64 Checksum(const void *values, size_t n)
{
  const unsigned char *byte = (const unsigned char *)values;
  uint64_t             sum  = 14695981039346656037u;

  for (size_t i = 0; i < n; i++) sum = (sum ^ byte[i]) * 1099511628211u;
  return (PetscInt64)(sum >> 1);
}

/* one array; errors wait for the commit */
static PetscErrorCode WriteArray(Checkpoint checkpoint, const char name[], hid_t type, hid_t memory_type, size_t element, size_t n,
                                 const void *values)
{
  const PetscInt64 sum = Checksum(values, n * element);

  PetscFunctionBegin;
  if (!checkpoint->active) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(checkpoint->writing, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "%s is open to be read", checkpoint->path);
  OutputFileReserve(&checkpoint->file, n * 8);
  OutputFileWriteArray(&checkpoint->file, name, type, memory_type, n, values);
  OutputFileSetInts(&checkpoint->file, name, "sum", 1, &sum);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointWriteReal(Checkpoint checkpoint, const char name[], PetscInt n, const PetscReal values[])
{
  return WriteArray(checkpoint, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, sizeof(PetscReal), (size_t)n, values);
}

PetscErrorCode CheckpointWriteInt(Checkpoint checkpoint, const char name[], PetscInt n, const PetscInt values[])
{
  return WriteArray(checkpoint, name, H5T_STD_I64LE, sizeof(PetscInt) == 4 ? H5T_NATIVE_INT32 : H5T_NATIVE_INT64, sizeof(PetscInt),
                    (size_t)n, values);
}

PetscErrorCode CheckpointWriteString(Checkpoint checkpoint, const char name[], const char value[])
{
  return WriteArray(checkpoint, name, H5T_STD_U8LE, H5T_NATIVE_UCHAR, 1, strlen(value), value);
}

/*@
  CheckpointCommit - sync the checkpoint, put it in the place of the old one and free the object

  Errors:
  BY_ERR_OUTPUT for whatever failed since CheckpointCreate(), reported; the new file is then removed and the old one kept
@*/
PetscErrorCode CheckpointCommit(Checkpoint *checkpoint)
{
  const PetscInt64 complete = 1;
  Checkpoint       c        = *checkpoint;
  PetscErrorCode   status   = PETSC_SUCCESS;
  char             path[PETSC_MAX_PATH_LEN + 8];
  int              fd;

  PetscFunctionBegin;
  if (c && c->active) {
    NewName(c, path);
    OutputFileSetInts(&c->file, "/", "complete", 1, &complete);
    if (!OutputFileClose(&c->file, PETSC_TRUE)) status = OutputReport(c->path, c->file.reason);
    else if (rename(path, c->path)) status = OutputReport(c->path, strerror(errno));
    if (status) unlink(path);
    // the rename itself survives a power cut only when the directory is on disk
    fd = status ? -1 : open(c->directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd >= 0) {
      (void)fsync(fd);
      close(fd);
    }
  }
  PetscCall(PetscFree(*checkpoint));
  PetscFunctionReturn(status);
}

/*@
  CheckpointOpen - open the checkpoint of a run directory to read it

  Not Collective, every rank reads

  Errors:
  BY_ERR_INPUT, reported with the file's name, when there is none, or it is truncated, damaged or something else
@*/
PetscErrorCode CheckpointOpen(const char directory[], Checkpoint *checkpoint)
{
  const char    *reason = NULL;
  char           text[600];
  PetscErrorCode status;

  PetscFunctionBegin;
  status = Begin(directory, PETSC_FALSE, checkpoint);
  if (status) {
    PetscCall(PetscFree(*checkpoint));
    PetscFunctionReturn(status);
  }
  OutputFileOpen((*checkpoint)->path, OUTPUT_READ, 0, PETSC_TRUE, &(*checkpoint)->file);
  if ((*checkpoint)->file.failed) reason = (*checkpoint)->file.reason;
  else if (OutputFileGetInt(&(*checkpoint)->file, "/", "format") < 0)
    reason = "it is an HDF5 file, but not a checkpoint of this program";
  else if (OutputFileGetInt(&(*checkpoint)->file, "/", "complete") != 1) reason = "it was not written to the end";
  else if (OutputFileGetInt(&(*checkpoint)->file, "/", "format") != FORMAT) {
    snprintf(text, sizeof(text), "its format is %lld, this program reads %d",
             (long long)OutputFileGetInt(&(*checkpoint)->file, "/", "format"), FORMAT);
    reason = text;
  }
  if (!reason) PetscFunctionReturn(PETSC_SUCCESS);
  status = ReportUnreadable(*checkpoint, reason);
  PetscCall(CheckpointClose(checkpoint));
  PetscFunctionReturn(status);
}

PetscErrorCode CheckpointGetSize(Checkpoint checkpoint, const char name[], PetscInt *n)
{
  PetscInt64 rows;

  PetscFunctionBegin;
  OutputFileGetSize(&checkpoint->file, name, &rows, NULL, NULL);
  if (checkpoint->file.failed) PetscFunctionReturn(ReportUnreadable(checkpoint, checkpoint->file.reason));
  *n = (PetscInt)rows;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one array of exactly n values of the kind asked for */
static PetscErrorCode ReadArray(Checkpoint checkpoint, const char name[], H5T_class_t kind, hid_t type, size_t element, PetscInt n,
                                void *values)
{
  H5T_class_t found = H5T_NO_CLASS;
  PetscInt64  rows, columns;
  char        text[600];

  PetscFunctionBegin;
  text[0] = '\0';
  OutputFileGetSize(&checkpoint->file, name, &rows, &columns, &found);
  if (!checkpoint->file.failed) {
    if (rows < 0) snprintf(text, sizeof(text), "it has no %s", name);
    else if (found != kind || columns != 1)
      snprintf(text, sizeof(text), "%s holds %s where %s are expected", name,
               found == H5T_INTEGER ? "integers"
               : found == H5T_FLOAT ? "real numbers"
                                    : "something else",
               kind == H5T_INTEGER ? "integers" : "real numbers");
    else if (rows != n)
      snprintf(text, sizeof(text), "%s has %lld values where the scene needs %" PetscInt_FMT, name, (long long)rows, n);
    else {
      OutputFileRead(&checkpoint->file, name, type, 0, (size_t)n, values);
      if (!checkpoint->file.failed && OutputFileGetInt(&checkpoint->file, name, "sum") != Checksum(values, (size_t)n * element))
        snprintf(text, sizeof(text), "%s is damaged", name);
    }
  }
  if (checkpoint->file.failed) snprintf(text, sizeof(text), "%s", checkpoint->file.reason);
  if (text[0]) PetscFunctionReturn(ReportUnreadable(checkpoint, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CheckpointReadReal - read an array of exactly n values

  Errors:
  BY_ERR_INPUT, reported, when the array is not there, has another size or kind, or is damaged
@*/
PetscErrorCode CheckpointReadReal(Checkpoint checkpoint, const char name[], PetscInt n, PetscReal values[])
{
  return ReadArray(checkpoint, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, sizeof(PetscReal), n, values);
}

PetscErrorCode CheckpointReadInt(Checkpoint checkpoint, const char name[], PetscInt n, PetscInt values[])
{
  return ReadArray(checkpoint, name, H5T_INTEGER, sizeof(PetscInt) == 4 ? H5T_NATIVE_INT32 : H5T_NATIVE_INT64, sizeof(PetscInt), n,
                   values);
}

/* n: room in `value`, the terminating zero included */
PetscErrorCode CheckpointReadString(Checkpoint checkpoint, const char name[], size_t n, char value[])
{
  PetscInt length = 0;

  PetscFunctionBegin;
  ByCall(CheckpointGetSize(checkpoint, name, &length));
  if (length >= (PetscInt)n) PetscFunctionReturn(ReportUnreadable(checkpoint, "a text in it is too long"));
  ByCall(ReadArray(checkpoint, name, H5T_INTEGER, H5T_NATIVE_UCHAR, 1, PetscMax(length, 0), value));
  value[length] = '\0';
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointClose(Checkpoint *checkpoint)
{
  PetscFunctionBegin;
  if (*checkpoint && (*checkpoint)->active) (void)OutputFileClose(&(*checkpoint)->file, PETSC_FALSE);
  PetscCall(PetscFree(*checkpoint));
  PetscFunctionReturn(PETSC_SUCCESS);
}
