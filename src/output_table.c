/* output_table.c - tables (CSV, a row at a time) and the summary (JSON, all at once). */
#include "output_file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct _Table {
  char      path[PETSC_MAX_PATH_LEN];
  PetscInt  n_columns;
  int       fd;     /* -1 on ranks that do not write        */
  off_t     size;   /* of the file up to the last whole row */
  PetscBool failed; /* nothing more is tried                */
};

/* write a row at the end; a row that does not fit is taken back, so that the file ends in a whole row */
static PetscErrorCode AppendRow(Table table, const char row[], size_t n)
{
  ssize_t m = 0;
  size_t  done;

  for (done = 0; done < n; done += (size_t)m) {
    do m = write(table->fd, row + done, n - done);
    while (m < 0 && errno == EINTR);
    if (m <= 0) {
      const int failed = m < 0 ? errno : ENOSPC;

      table->failed = PETSC_TRUE;
      if (ftruncate(table->fd, table->size)) table->size += (off_t)done;
      return OutputReport(table->path, strerror(failed));
    }
  }
  table->size += (off_t)n;
  return PETSC_SUCCESS;
}

/* the header as one row */
static PetscErrorCode MakeHeader(PetscInt n_columns, const char *const headers[], OutputText *text)
{
  PetscFunctionBegin;
  for (PetscInt c = 0; c < n_columns; c++) {
    const PetscBool quote = strpbrk(headers[c], ",\"\n") ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(OutputTextAdd(text, "%s%s", c ? "," : "", quote ? "\"" : ""));
    for (const char *s = headers[c]; *s; s++) PetscCall(OutputTextAdd(text, quote && *s == '"' ? "\"%c" : "%c", *s));
    if (quote) PetscCall(OutputTextAdd(text, "\""));
  }
  PetscCall(OutputTextAdd(text, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadText(const char path[], OutputText *text)
{
  FILE  *file = fopen(path, "rb");
  char   buffer[65536];
  size_t n;

  PetscFunctionBegin;
  if (!file) PetscFunctionReturn(InputError("resume", "the table %s cannot be read: %s", path, strerror(errno)));
  while ((n = fread(buffer, 1, sizeof(buffer), file)) > 0) {
    for (size_t i = 0; i < n; i++) {
      if (!buffer[i]) buffer[i] = '?'; // not ours; the header tells
    }
    PetscCall(OutputTextAdd(text, "%.*s", (int)n, buffer));
  }
  fclose(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a whole row up to `end`: as many numbers as columns, the first not later than `time` */
static PetscBool IsRowKept(const char row[], const char *end, PetscInt n_columns, PetscReal time)
{
  PetscInt commas = 0;
  char    *stop;
  double   t;

  for (const char *s = row; s < end; s++) commas += *s == ',';
  t = strtod(row, &stop);
  return commas == n_columns - 1 && stop > row && stop <= end && t <= time + 1e-9 * PetscMax(1e-3, PetscAbsReal(time))
             ? PETSC_TRUE
             : PETSC_FALSE;
}

/* keep the rows up to `time` of a table that is there, under the same header */
static PetscErrorCode ContinueTable(Table table, const OutputText *header, PetscReal time)
{
  OutputText     old = {NULL, 0, 0}, kept = {NULL, 0, 0};
  PetscErrorCode status;

  PetscFunctionBegin;
  status = ReadText(table->path, &old);
  if (!status && (old.n < header->n || strncmp(old.text, header->text, header->n)))
    status = InputError("resume", "the table %s has other columns than this run writes\n  move that file away to begin a new one",
                        table->path);
  if (!status) {
    PetscCall(OutputTextAdd(&kept, "%s", header->text));
    for (const char *row = old.text + header->n, *end; (end = strchr(row, '\n')); row = end + 1) {
      if (IsRowKept(row, end, table->n_columns, time)) PetscCall(OutputTextAdd(&kept, "%.*s\n", (int)(end - row), row));
    }
    status = OutputReplaceText(table->path, kept.text, kept.n, PETSC_FALSE);
  }
  free(old.text);
  free(kept.text);
  PetscFunctionReturn(status);
}

/*@
  TableCreate - begin or continue a CSV table; every row is on disk when TableWrite() returns

  Not Collective, rank 0 writes

  Input Parameters:
+ directory - exists
. file      - name of the file, "ledger.csv"
. n_columns - with the time, which is the first
. headers   - of all columns, "time [s]" first
. append    - continue a table that is there, without the rows later than `time` and without a broken last row
- time      - of the state from which the run goes on [s]

  Errors:
  BY_ERR_OUTPUT, or BY_ERR_INPUT when the table to be continued has other columns; both reported
@*/
PetscErrorCode TableCreate(const char directory[], const char file[], PetscInt n_columns, const char *const headers[],
                           PetscBool append, PetscReal time, Table *table)
{
  PetscMPIInt    rank;
  OutputText     header = {NULL, 0, 0};
  PetscErrorCode status;
  struct stat    info;
  Table          t;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(PetscNew(&t));
  *table       = t;
  t->fd        = -1;
  t->n_columns = n_columns;
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MakeHeader(n_columns, headers, &header));
  status = OutputPath(directory, file, "", t->path);
  if (!status) {
    if (append && !access(t->path, F_OK)) status = ContinueTable(t, &header, time);
    else status = OutputReplaceText(t->path, header.text, header.n, PETSC_FALSE);
  }
  free(header.text);
  if (!status) {
    t->fd = open(t->path, O_WRONLY | O_APPEND | O_CLOEXEC);
    if (t->fd < 0 || fstat(t->fd, &info)) status = OutputReport(t->path, strerror(errno));
    else t->size = info.st_size;
  }
  if (status) PetscCall(TableDestroy(table));
  PetscFunctionReturn(status);
}

/*@
  TableWrite - add a row

  Input Parameters:
+ table  - the table
- values - one number a column, the time first; written with as many digits as read back to the same number

  Errors:
  BY_ERR_OUTPUT, reported once; later calls return it in silence
@*/
PetscErrorCode TableWrite(Table table, const PetscReal values[])
{
  OutputText     row = {NULL, 0, 0};
  char           number[32];
  PetscErrorCode status;

  PetscFunctionBegin;
  if (table->failed) PetscFunctionReturn(BY_ERR_OUTPUT);
  if (table->fd < 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt c = 0; c < table->n_columns; c++) {
    OutputFormatReal(values[c], number);
    PetscCall(OutputTextAdd(&row, "%s%s", c ? "," : "", number));
  }
  PetscCall(OutputTextAdd(&row, "\n"));
  status = AppendRow(table, row.text, row.n);
  free(row.text);
  PetscFunctionReturn(status);
}

PetscErrorCode TableDestroy(Table *table)
{
  PetscFunctionBegin;
  if (!*table) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*table)->fd >= 0) close((*table)->fd);
  PetscCall(PetscFree(*table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

struct _Json {
  char       path[PETSC_MAX_PATH_LEN];
  OutputText text;
  int        depth;  /* of open objects, the outermost included */
  PetscBool  first;  /* nothing yet in the innermost object     */
  PetscBool  active; /* this rank writes                        */
};

/*@
  JsonCreate - begin a JSON object that JsonDestroy() writes to `<directory>/<file>`, under a new name that is then renamed
@*/
PetscErrorCode JsonCreate(const char directory[], const char file[], Json *json)
{
  PetscMPIInt    rank;
  PetscErrorCode status = PETSC_SUCCESS;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(PetscNew(json));
  (*json)->active = rank == 0 ? PETSC_TRUE : PETSC_FALSE;
  (*json)->first  = PETSC_TRUE;
  (*json)->depth  = 1;
  PetscCall(OutputTextAdd(&(*json)->text, "{"));
  if ((*json)->active) status = OutputPath(directory, file, "", (*json)->path);
  if (status) {
    free((*json)->text.text);
    PetscCall(PetscFree(*json));
  }
  PetscFunctionReturn(status);
}

static PetscErrorCode AddQuoted(OutputText *text, const char s[])
{
  PetscFunctionBegin;
  PetscCall(OutputTextAdd(text, "\""));
  for (; *s; s++) {
    const unsigned char c = (unsigned char)*s;

    if (c == '"' || c == '\\') PetscCall(OutputTextAdd(text, "\\%c", c));
    else if (c == '\n') PetscCall(OutputTextAdd(text, "\\n"));
    else if (c == '\t') PetscCall(OutputTextAdd(text, "\\t"));
    else if (c < 0x20) PetscCall(OutputTextAdd(text, "\\u%04x", c));
    else PetscCall(OutputTextAdd(text, "%c", c));
  }
  PetscCall(OutputTextAdd(text, "\""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* comma, new line, indent, key */
static PetscErrorCode AddKey(Json json, const char key[])
{
  PetscFunctionBegin;
  PetscCheck(json->depth > 0, PETSC_COMM_SELF, PETSC_ERR_ORDER, "the outermost object is closed already");
  PetscCall(OutputTextAdd(&json->text, "%s\n%*s", json->first ? "" : ",", 2 * json->depth, ""));
  PetscCall(AddQuoted(&json->text, key));
  PetscCall(OutputTextAdd(&json->text, ": "));
  json->first = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode JsonBegin(Json json, const char key[])
{
  PetscFunctionBegin;
  PetscCall(AddKey(json, key));
  PetscCall(OutputTextAdd(&json->text, "{"));
  json->depth++;
  json->first = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode JsonEnd(Json json)
{
  PetscFunctionBegin;
  PetscCheck(json->depth > 1, PETSC_COMM_SELF, PETSC_ERR_ORDER, "JsonEnd without JsonBegin");
  json->depth--;
  if (json->first) PetscCall(OutputTextAdd(&json->text, "}"));
  else PetscCall(OutputTextAdd(&json->text, "\n%*s}", 2 * json->depth, ""));
  json->first = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* numbers that JSON does not have (NaN, infinity) become null */
PetscErrorCode JsonReal(Json json, const char key[], PetscReal value)
{
  char number[32];

  PetscFunctionBegin;
  PetscCall(AddKey(json, key));
  OutputFormatReal(value, number);
  PetscCall(OutputTextAdd(&json->text, "%s", PetscIsInfOrNanReal(value) ? "null" : number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode JsonInt(Json json, const char key[], PetscInt value)
{
  PetscFunctionBegin;
  PetscCall(AddKey(json, key));
  PetscCall(OutputTextAdd(&json->text, "%" PetscInt_FMT, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode JsonString(Json json, const char key[], const char value[])
{
  PetscFunctionBegin;
  PetscCall(AddKey(json, key));
  PetscCall(AddQuoted(&json->text, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  JsonDestroy - close what is open, write the file and free the object

  Errors:
  BY_ERR_OUTPUT, reported; a file of that name that was there is then still there
@*/
PetscErrorCode JsonDestroy(Json *json)
{
  PetscErrorCode status = PETSC_SUCCESS;

  PetscFunctionBegin;
  if (!*json) PetscFunctionReturn(PETSC_SUCCESS);
  while ((*json)->depth > 1) PetscCall(JsonEnd(*json));
  PetscCall(OutputTextAdd(&(*json)->text, "\n}\n"));
  if ((*json)->active) status = OutputReplaceText((*json)->path, (*json)->text.text, (*json)->text.n, PETSC_TRUE);
  free((*json)->text.text);
  PetscCall(PetscFree(*json));
  PetscFunctionReturn(status);
}
