/* output.h - results on disk: time series that ParaView opens (VTKHDF 2.0 and an XDMF beside it), CSV tables, JSON summary,
   progress line. Writing errors (disk full, not writable) are reported with the path and reason and returned as BY_ERR_OUTPUT. */
#ifndef BY_OUTPUT_H
#define BY_OUTPUT_H

#include "base.h"

#define BY_ERR_OUTPUT ((PetscErrorCode)9003) /* result could not be written; already reported; exit status 1, state kept */

typedef struct {
  const char      *name, *unit;
  PetscInt         components; /* 1 or 3 */
  const PetscReal *data;       /* n x components */
} OutputField;

/* A series of one object: points (particles), a surface of triangles, or tetrahedra of first or second order. */
typedef struct _Series *Series;
typedef enum { SERIES_POINTS, SERIES_TRIANGLES, SERIES_TETRAHEDRA, SERIES_TETRAHEDRA_QUADRATIC } SeriesKind;

/* <directory>/<name>.vtkhdf and .xmf. Attributes (scene text, version, units) are stored once. `append`: go on after a resume, dropping
   steps later than `time`. */
BY_EXTERN PetscErrorCode SeriesCreate(const char directory[], const char name[], SeriesKind kind, const char scene_text[], PetscBool append, PetscReal time, Series *series);
BY_EXTERN PetscErrorCode SeriesSetDoublePrecision(Series series, PetscBool flag); /* before the first step */
/* connectivity, written once; before the first step (not for points) */
BY_EXTERN PetscErrorCode SeriesSetCells(Series series, PetscInt n_cells, const PetscInt cells[]);
/* one time: positions n x 3 and point fields (the same names every time); stored single unless SeriesSetDoublePrecision */
BY_EXTERN PetscErrorCode SeriesWrite(Series series, PetscReal time, PetscInt n, const PetscReal x[], PetscInt n_fields, const OutputField fields[]);
BY_EXTERN PetscErrorCode SeriesDestroy(Series *series);

/* CSV with a header row "time [s],name [unit],..."; flushed row by row. `append` drops rows later than time. */
typedef struct _Table *Table;
BY_EXTERN PetscErrorCode TableCreate(const char directory[], const char file[], PetscInt n_columns, const char *const headers[], PetscBool append, PetscReal time, Table *table);
BY_EXTERN PetscErrorCode TableWrite(Table table, const PetscReal values[]);
BY_EXTERN PetscErrorCode TableDestroy(Table *table);

/* JSON writer for summary.json: Begin/End objects, keys in the order given; written to a new name, then renamed. */
typedef struct _Json *Json;
BY_EXTERN PetscErrorCode JsonCreate(const char directory[], const char file[], Json *json);
BY_EXTERN PetscErrorCode JsonBegin(Json json, const char key[]); /* nested object */
BY_EXTERN PetscErrorCode JsonEnd(Json json);
BY_EXTERN PetscErrorCode JsonReal(Json json, const char key[], PetscReal value);
BY_EXTERN PetscErrorCode JsonInt(Json json, const char key[], PetscInt value);
BY_EXTERN PetscErrorCode JsonString(Json json, const char key[], const char value[]);
BY_EXTERN PetscErrorCode JsonDestroy(Json *json); /* commits */

/* Make a directory (and parents); a path that cannot be written is reported. */
BY_EXTERN PetscErrorCode OutputMakeDirectory(const char path[]);

/* Progress: one updating line on a terminal, a plain line every ten seconds in a log (stderr). */
typedef struct {
  PetscReal time, end, dt, wall;  /* simulated time, its end, step, wall seconds since the start */
  PetscInt  step, iterations;
} ProgressState;
typedef struct _Progress *Progress;
BY_EXTERN PetscErrorCode ProgressCreate(Progress *progress);
BY_EXTERN PetscErrorCode ProgressShow(Progress progress, const ProgressState *state, PetscBool last);
BY_EXTERN PetscErrorCode ProgressDestroy(Progress *progress);

#endif
