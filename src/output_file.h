/* output_file.h - one HDF5 file as the results and the checkpoint use it; private to output_*.c and checkpoint.c.
   Errors stick: after the first one every call does nothing, and OutputFileClose reports it once. So the code that
   writes reads as a list of what is written. Nothing is left open between two outputs: the file on disk is complete
   and can be opened by others after every OutputFileClose. Not collective: rank 0 calls. */
#ifndef BY_OUTPUT_FILE_H
#define BY_OUTPUT_FILE_H

#include "output.h"
#include <hdf5.h>

#define OUTPUT_CHUNK_MAX 65536 /* rows in a chunk: 3 doubles of these are 1.5 MB, the order of HDF5's chunk cache */

typedef struct {
  char        path[PETSC_MAX_PATH_LEN];
  hid_t       id;      /* negative: not open                                  */
  PetscBool   writing; /* opened to write                                     */
  PetscBool   failed;  /* something went wrong; `reason` tells what, in words */
  char        reason[512];
  H5E_auto2_t print; /* the caller's HDF5 error printer, back at close      */
  void       *print_data;
} OutputFile;

typedef enum { OUTPUT_READ, OUTPUT_CHANGE, OUTPUT_CREATE } OutputMode;

/* Open or create; to write, only when about `bytes` more fit on the disk and under the shell's limit. `checksums`: HDF5 1.8 file
   format, whose metadata carry checksums (checkpoints; results keep to what older readers know). */
PETSC_INTERN void OutputFileOpen(const char path[], OutputMode mode, size_t bytes, PetscBool checksums, OutputFile *file);
/* see that `bytes` more fit, so that a full disk is found before they are half written */
PETSC_INTERN void OutputFileReserve(OutputFile *file, size_t bytes);
/* all that was written so far to the system */
PETSC_INTERN void OutputFileFlush(OutputFile *file);
/* Close. After a failure what is not yet on disk is dropped, never half written. Returns whether all went well. */
PETSC_INTERN PetscBool OutputFileClose(OutputFile *file, PetscBool sync);

PETSC_INTERN void OutputFileFail(OutputFile *file, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PETSC_INTERN void OutputFileGroup(OutputFile *file, const char name[]);
/* an empty extendable data set of `columns` columns (1: one-dimensional) that will be filled by about `rows` rows at a time */
PETSC_INTERN void OutputFileCreateSet(OutputFile *file, const char name[], hid_t type, size_t columns, size_t rows,
                                      PetscBool compress);
/* a data set of n values that stays as it is */
PETSC_INTERN void OutputFileWriteArray(OutputFile *file, const char name[], hid_t type, hid_t memory_type, size_t n,
                                       const void *data);
PETSC_INTERN void OutputFileAppend(OutputFile *file, const char name[], hid_t memory_type, size_t rows, const void *data);
PETSC_INTERN void OutputFileResize(OutputFile *file, const char name[], size_t rows);
PETSC_INTERN void OutputFileRead(OutputFile *file, const char name[], hid_t memory_type, size_t start, size_t rows, void *data);
/* rows and columns of a data set; -1 rows when it is not there */
PETSC_INTERN void OutputFileGetSize(OutputFile *file, const char name[], PetscInt64 *rows, PetscInt64 *columns, H5T_class_t *kind);
PETSC_INTERN void OutputFileWriteText(OutputFile *file, const char name[], const char value[]); /* a data set of one string */
/* attributes of the object `name`; one that is there is overwritten */
PETSC_INTERN void OutputFileSetText(OutputFile *file, const char name[], const char attribute[], const char value[]);
PETSC_INTERN void OutputFileSetInts(OutputFile *file, const char name[], const char attribute[], size_t n,
                                    const PetscInt64 values[]);
/* an integer attribute, -1 when it is not there or something else */
PETSC_INTERN PetscInt64 OutputFileGetInt(OutputFile *file, const char name[], const char attribute[]);

/* output.c: the one line that every failed write ends in; returns BY_ERR_OUTPUT */
PETSC_INTERN PetscErrorCode OutputReport(const char path[], const char reason[]);
/* <directory>/<name><suffix>; too long a path is reported */
PETSC_INTERN PetscErrorCode OutputPath(const char directory[], const char name[], const char suffix[],
                                       char path[PETSC_MAX_PATH_LEN]);
/* the whole of a text file at once: a new name, synced if asked, renamed */
PETSC_INTERN PetscErrorCode OutputReplaceText(const char path[], const char text[], size_t n, PetscBool sync);
/* the shortest decimal number that reads back as x */
PETSC_INTERN void OutputFormatReal(PetscReal x, char text[32]);
/* growing text */
typedef struct {
  char  *text;
  size_t n, capacity;
} OutputText;
PETSC_INTERN PetscErrorCode OutputTextAdd(OutputText *text, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
/* a file over the limit of the shell is an error of write(), not a signal that kills */
PETSC_INTERN void OutputIgnoreSizeSignal(void);

#endif
