/* output_series.c - a time series of one object in one HDF5 file, VTKHDF 2.0 temporal layout, and an XDMF beside it.

   Layout (VTKHDF specification, "Temporal Data"): all steps of a data set follow each other, `Steps` tells where each begins.
   A topology is written when it changes and counted as one part; steps that share it name the same part:
     Steps/PartOffsets[step]             = part
     NumberOfPoints[part], NumberOfCells[part], NumberOfConnectivityIds[part]
     Steps/CellOffsets[step]             = cells of the parts before
     Steps/ConnectivityIdOffsets[step]   = connectivity ids of the parts before
     Offsets                             = cells + 1 numbers a part, so the part's begin at CellOffsets + PartOffsets
     Steps/PointOffsets[step]            = points of the steps before; point data have the same offsets
   PolyData have four categories of cells, of which one is used. The number of steps (attribute NSteps) is written last. */
#include "output_series.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define STEP_CHUNK 256 /* rows of the small tables in a chunk */

const SeriesLayout series_layouts[] = {
    {"PolyData", "/VTKHDF/Vertices", "Polyvertex", 1, 1, 0},
    {"PolyData", "/VTKHDF/Polygons", "Triangle", 3, 5, 2},
    {"UnstructuredGrid", "/VTKHDF", "Tetrahedron", 4, 10, 0},
    {"UnstructuredGrid", "/VTKHDF", "Tetrahedron_10", 10, 24, 0},
};
static const char *const poly_groups[] = {"/VTKHDF/Vertices", "/VTKHDF/Lines", "/VTKHDF/Polygons", "/VTKHDF/Strips"};

typedef struct {
  char text[256];
} Path;

static Path In(const char group[], const char name[])
{
  Path path;

  snprintf(path.text, sizeof(path.text), "%s/%s", group, name);
  return path;
}

static PetscBool IsGrid(Series series) { return (PetscBool)(series->kind >= SERIES_TETRAHEDRA); }

static int CategoryCount(Series series) { return IsGrid(series) ? 1 : 4; }

static const char *Category(Series series, int c) { return IsGrid(series) ? "/VTKHDF" : poly_groups[c]; }

static PetscErrorCode Grow(void **array, size_t *capacity, size_t n, size_t element)
{
  PetscFunctionBegin;
  if (n > *capacity) {
    const size_t more = n + n / 2 + 16;
    void        *p    = realloc(*array, more * element);

    PetscCheck(p, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for %zu steps", more);
    *array    = p;
    *capacity = more;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Finish(Series series, OutputFile *file)
{
  if (OutputFileClose(file, PETSC_FALSE)) return PETSC_SUCCESS;
  series->failed = PETSC_TRUE;
  return OutputReport(file->path, file->reason);
}

static void CreateTable(OutputFile *file, const char group[], const char name[], size_t columns)
{
  OutputFileCreateSet(file, In(group, name).text, H5T_STD_I64LE, columns, STEP_CHUNK, PETSC_FALSE);
}

static PetscErrorCode CreateFile(Series series, const char scene_text[])
{
  const SeriesLayout *layout     = &series_layouts[series->kind];
  const PetscInt64    version[2] = {2, 0}, none = 0;
  const size_t        n_categories = (size_t)CategoryCount(series);
  OutputFile          file;

  OutputFileOpen(series->path, OUTPUT_CREATE, strlen(scene_text), PETSC_FALSE, &file);
  OutputFileGroup(&file, "/VTKHDF");
  OutputFileSetInts(&file, "/VTKHDF", "Version", 2, version);
  OutputFileSetText(&file, "/VTKHDF", "Type", layout->type);
  OutputFileGroup(&file, "/VTKHDF/PointData");
  CreateTable(&file, "/VTKHDF", "NumberOfPoints", 1);
  for (int c = 0; c < CategoryCount(series); c++) {
    if (!IsGrid(series)) OutputFileGroup(&file, Category(series, c));
    CreateTable(&file, Category(series, c), "NumberOfCells", 1);
    CreateTable(&file, Category(series, c), "NumberOfConnectivityIds", 1);
  }

  OutputFileGroup(&file, "/VTKHDF/Steps");
  OutputFileSetInts(&file, "/VTKHDF/Steps", "NSteps", 1, &none);
  OutputFileCreateSet(&file, "/VTKHDF/Steps/Values", H5T_IEEE_F64LE, 1, STEP_CHUNK, PETSC_FALSE);
  OutputFileSetText(&file, "/VTKHDF/Steps/Values", "units", "s");
  CreateTable(&file, "/VTKHDF/Steps", "PartOffsets", 1);
  CreateTable(&file, "/VTKHDF/Steps", "NumberOfParts", 1);
  CreateTable(&file, "/VTKHDF/Steps", "PointOffsets", 1);
  CreateTable(&file, "/VTKHDF/Steps", "CellOffsets", n_categories);
  CreateTable(&file, "/VTKHDF/Steps", "ConnectivityIdOffsets", n_categories);
  OutputFileGroup(&file, "/VTKHDF/Steps/PointDataOffsets");

  // what VTK does not know stays outside its group
  OutputFileGroup(&file, "/byssus");
  OutputFileSetText(&file, "/byssus", "version", BY_VERSION);
  OutputFileSetText(&file, "/byssus", "cell", layout->xdmf);
  OutputFileWriteText(&file, "/byssus/scene", scene_text);
  return Finish(series, &file);
}

/* take a field into the list that all steps share */
static PetscErrorCode AddField(Series series, const char name[], const char unit[], PetscInt components)
{
  PetscFunctionBegin;
  PetscCheck(series->n_fields < SERIES_FIELDS_MAX, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "more than %d fields in %s",
             SERIES_FIELDS_MAX, series->path);
  PetscCheck(strlen(name) < sizeof(series->fields[0].name) && !strpbrk(name, "/.<>&\""), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "field name \"%s\" is too long or has one of / . < > & \"", name);
  snprintf(series->fields[series->n_fields].name, sizeof(series->fields[0].name), "%s", name);
  snprintf(series->fields[series->n_fields].unit, sizeof(series->fields[0].unit), "%s", unit ? unit : "");
  series->fields[series->n_fields++].components = components;
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  Series      series;
  OutputFile *file;
} FieldVisit;

/* learn a field of an existing file */
static herr_t VisitField(hid_t group, const char name[], const H5L_info_t *info, void *context)
{
  FieldVisit *visit = (FieldVisit *)context;
  PetscInt64  rows, columns;

  (void)group;
  (void)info;
  OutputFileGetSize(visit->file, In("/VTKHDF/PointData", name).text, &rows, &columns, NULL);
  if (rows < 0 || (columns != 1 && columns != 3)) OutputFileFail(visit->file, "field %s has an unexpected shape", name);
  return visit->file->failed || AddField(visit->series, name, "", (PetscInt)columns) ? -1 : 0;
}

/* read the tables of steps and parts of a file that is to be continued, up to `time` */
static PetscErrorCode ReadTables(Series series, OutputFile *file, PetscReal time)
{
  const SeriesLayout *layout = &series_layouts[series->kind];
  PetscInt64          n, n_parts, points, *buffer;
  PetscReal          *times;
  PetscInt64          cells = 0, ids = 0;

  PetscFunctionBegin;
  n = OutputFileGetInt(file, "/VTKHDF/Steps", "NSteps"); // rows beyond belong to a step that was not finished
  OutputFileGetSize(file, "/VTKHDF/NumberOfPoints", &n_parts, NULL, NULL);
  if (n < 0 || n_parts < 0) OutputFileFail(file, "not a series of this program");
  OutputFileGetSize(file, "/VTKHDF/Points", &points, NULL, NULL);
  series->has_sets = points >= 0 ? PETSC_TRUE : PETSC_FALSE;
  if (file->failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Grow((void **)&series->steps, &series->step_capacity, (size_t)n, sizeof(Step)));
  PetscCall(Grow((void **)&series->parts, &series->part_capacity, (size_t)n_parts, sizeof(Part)));
  PetscCall(PetscMalloc2(PetscMax(n, n_parts) + 1, &buffer, n + 1, &times));

  OutputFileRead(file, "/VTKHDF/Steps/Values", H5T_NATIVE_DOUBLE, 0, (size_t)n, times);
  OutputFileRead(file, "/VTKHDF/Steps/PartOffsets", H5T_NATIVE_INT64, 0, (size_t)n, buffer);
  for (PetscInt64 i = 0; i < n && !file->failed; i++) {
    // a step at the time itself was written before the checkpoint was, and stays
    if (times[i] > time + 1e-9 * PetscMax(1e-3, PetscAbsReal(time))) break;
    series->steps[i].time = times[i];
    series->steps[i].part = buffer[i];
    if (buffer[i] < 0 || buffer[i] >= n_parts) OutputFileFail(file, "step %lld has no topology", (long long)i);
    series->n_steps = (size_t)i + 1;
    series->n_parts = PetscMax(series->n_parts, (size_t)buffer[i] + 1);
  }
  OutputFileRead(file, "/VTKHDF/Steps/PointOffsets", H5T_NATIVE_INT64, 0, series->n_steps, buffer);
  for (size_t i = 0; i < series->n_steps && !file->failed; i++) series->steps[i].point_offset = buffer[i];
  OutputFileRead(file, "/VTKHDF/NumberOfPoints", H5T_NATIVE_INT64, 0, series->n_parts, buffer);
  for (size_t i = 0; i < series->n_parts && !file->failed; i++) series->parts[i].n_points = buffer[i];
  OutputFileRead(file, In(layout->cells, "NumberOfCells").text, H5T_NATIVE_INT64, 0, series->n_parts, buffer);
  for (size_t i = 0; i < series->n_parts && !file->failed; i++) {
    series->parts[i].n_cells     = buffer[i];
    series->parts[i].cell_offset = cells;
    series->parts[i].id_offset   = ids;
    cells += buffer[i];
    ids += buffer[i] * layout->nodes;
  }
  PetscCall(PetscFree2(buffer, times));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* points and cells of all steps that are kept */
static void CountRows(Series series, PetscInt64 *points, PetscInt64 *cells)
{
  const Step *step = series->n_steps ? &series->steps[series->n_steps - 1] : NULL;
  const Part *part = series->n_parts ? &series->parts[series->n_parts - 1] : NULL;

  *points = step ? step->point_offset + series->parts[step->part].n_points : 0;
  *cells  = part ? part->cell_offset + part->n_cells : 0;
}

/* cut all data sets back to the steps and parts that are kept */
static void Shrink(Series series, OutputFile *file)
{
  static const char *const step_tables[] = {"Values",       "PartOffsets", "NumberOfParts",
                                            "PointOffsets", "CellOffsets", "ConnectivityIdOffsets"};
  const SeriesLayout      *layout        = &series_layouts[series->kind];
  const PetscInt64         n_steps       = (PetscInt64)series->n_steps;
  PetscInt64               points, cells, rows;

  CountRows(series, &points, &cells);
  OutputFileSetInts(file, "/VTKHDF/Steps", "NSteps", 1, &n_steps);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(step_tables); i++)
    OutputFileResize(file, In("/VTKHDF/Steps", step_tables[i]).text, series->n_steps);
  OutputFileResize(file, "/VTKHDF/NumberOfPoints", series->n_parts);
  for (int c = 0; c < CategoryCount(series); c++) {
    const PetscBool used = c == layout->category ? PETSC_TRUE : PETSC_FALSE;

    OutputFileResize(file, In(Category(series, c), "NumberOfCells").text, series->n_parts);
    OutputFileResize(file, In(Category(series, c), "NumberOfConnectivityIds").text, series->n_parts);
    OutputFileGetSize(file, In(Category(series, c), "Offsets").text, &rows, NULL, NULL);
    if (rows < 0) continue; // a file without steps
    OutputFileResize(file, In(Category(series, c), "Offsets").text, (size_t)(used ? cells : 0) + series->n_parts);
    OutputFileResize(file, In(Category(series, c), "Connectivity").text, (size_t)(used ? cells * layout->nodes : 0));
    if (IsGrid(series)) OutputFileResize(file, "/VTKHDF/Types", (size_t)cells);
  }
  if (series->has_sets) OutputFileResize(file, "/VTKHDF/Points", (size_t)points);
  for (PetscInt f = 0; f < series->n_fields; f++) {
    OutputFileResize(file, In("/VTKHDF/PointData", series->fields[f].name).text, (size_t)points);
    OutputFileResize(file, In("/VTKHDF/Steps/PointDataOffsets", series->fields[f].name).text, series->n_steps);
  }
}

/* go on with a file from `time`; later steps go */
static PetscErrorCode ContinueFile(Series series, PetscReal time)
{
  OutputFile file;
  FieldVisit visit = {series, &file};
  PetscBool  readable;

  PetscFunctionBegin;
  // first only look: what cannot be understood is left as it is
  OutputFileOpen(series->path, OUTPUT_READ, 0, PETSC_FALSE, &file);
  PetscCall(ReadTables(series, &file, time));
  if (!file.failed &&
      H5Literate_by_name(file.id, "/VTKHDF/PointData", H5_INDEX_NAME, H5_ITER_NATIVE, NULL, VisitField, &visit, H5P_DEFAULT) < 0)
    OutputFileFail(&file, "no fields");
  readable = OutputFileClose(&file, PETSC_FALSE);
  if (!readable) {
    series->failed = PETSC_TRUE;
    PetscFunctionReturn(InputError("resume", "the results %s cannot be continued: %s\n  move that file away to begin a new one",
                                   series->path, file.reason));
  }
  OutputFileOpen(series->path, OUTPUT_CHANGE, 0, PETSC_FALSE, &file);
  Shrink(series, &file);
  PetscFunctionReturn(Finish(series, &file));
}

/*@
  SeriesCreate - begin or continue the time series of one object: `<directory>/<name>.vtkhdf` and `.xmf`

  Not Collective, rank 0 writes and the others return

  Input Parameters:
+ directory  - exists (OutputMakeDirectory())
. name       - of the object
. kind       - points, triangles or tetrahedra
. scene_text - stored as /byssus/scene
. append     - continue a file that is there, without its steps later than `time`; without a file a new one begins
- time       - of the state from which the run goes on [s]

  Output Parameter:
. series - closed on disk between two writes, so that a viewer can open it at any time

  Errors:
  BY_ERR_OUTPUT when the file cannot be written; BY_ERR_INPUT when a file to be continued cannot be read; both reported

  Reference:
  VTKHDF file format specification 2.0, https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/
@*/
PetscErrorCode SeriesCreate(const char directory[], const char name[], SeriesKind kind, const char scene_text[], PetscBool append,
                            PetscReal time, Series *series)
{
  PetscMPIInt    rank;
  Series         s;
  PetscErrorCode status;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(PetscNew(&s));
  *series   = s;
  s->kind   = kind;
  s->active = rank == 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!s->active) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(s->name, name, sizeof(s->name)));
  status = OutputPath(directory, name, ".vtkhdf", s->path);
  if (!status) status = OutputPath(directory, name, ".xmf", s->xdmf_path);
  if (!status) {
    if (append && !access(s->path, F_OK)) status = ContinueFile(s, time);
    else status = CreateFile(s, scene_text ? scene_text : "");
  }
  if (!status) status = SeriesWriteXdmf(s);
  if (status) {
    PetscCall(SeriesDestroy(series));
    PetscFunctionReturn(status);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SeriesSetDoublePrecision - store points and fields in double precision, before the first step; the default is single
@*/
PetscErrorCode SeriesSetDoublePrecision(Series series, PetscBool flag)
{
  PetscFunctionBegin;
  PetscCheck(!series->active || !series->has_sets || flag == series->double_precision, PETSC_COMM_SELF, PETSC_ERR_ORDER,
             "%s has steps already", series->path);
  series->double_precision = flag;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SeriesSetCells - the triangles or tetrahedra, once, before the first SeriesWrite()

  Input Parameters:
+ series  - of triangles or tetrahedra
. n_cells - how many
- cells   - point numbers from 0, n_cells x 3, 4 or 10 (VTK's order), copied
@*/
PetscErrorCode SeriesSetCells(Series series, PetscInt n_cells, const PetscInt cells[])
{
  PetscFunctionBegin;
  if (!series->active) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(series->kind != SERIES_POINTS, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "points have no cells");
  PetscCheck(!series->cells_checked, PETSC_COMM_SELF, PETSC_ERR_ORDER, "%s has its cells already", series->path);
  PetscCall(PetscFree(series->cells));
  PetscCall(PetscMalloc1((size_t)n_cells * (size_t)series_layouts[series->kind].nodes, &series->cells));
  PetscCall(PetscArraycpy(series->cells, cells, (size_t)n_cells * (size_t)series_layouts[series->kind].nodes));
  series->n_cells = n_cells;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* whether the last topology in the file is the one to be written */
static PetscErrorCode IsLastPart(Series series, OutputFile *file, PetscInt n, PetscBool *same)
{
  const SeriesLayout *layout = &series_layouts[series->kind];
  const Part         *part   = series->n_parts ? &series->parts[series->n_parts - 1] : NULL;

  PetscFunctionBegin;
  *same = PETSC_FALSE;
  if (!part || part->n_points != n) PetscFunctionReturn(PETSC_SUCCESS);
  *same = PETSC_TRUE; // points are numbered through, and cells stay as they were set
  if (series->kind != SERIES_POINTS && !series->cells_checked) {
    const size_t n_ids = (size_t)part->n_cells * (size_t)layout->nodes;
    PetscInt    *old;

    *same = part->n_cells == series->n_cells ? PETSC_TRUE : PETSC_FALSE;
    if (*same) {
      PetscCall(PetscCalloc1(n_ids, &old));
      OutputFileRead(file, In(layout->cells, "Connectivity").text, sizeof(PetscInt) == 4 ? H5T_NATIVE_INT32 : H5T_NATIVE_INT64,
                     (size_t)part->id_offset, n_ids, old);
      PetscCall(PetscArraycmp(old, series->cells, n_ids, same));
      PetscCall(PetscFree(old));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* write the topology of n points as a new part */
static PetscErrorCode AddPart(Series series, OutputFile *file, PetscInt n)
{
  const SeriesLayout *layout  = &series_layouts[series->kind];
  const PetscInt      n_cells = series->kind == SERIES_POINTS ? n : series->n_cells;
  const size_t        n_ids   = (size_t)n_cells * (size_t)layout->nodes;
  const hid_t         id_type = sizeof(PetscInt) == 4 ? H5T_NATIVE_INT32 : H5T_NATIVE_INT64;
  PetscInt64         *offsets, points, cells;
  PetscInt           *ids;
  unsigned char      *types;
  Part               *part;

  PetscFunctionBegin;
  PetscCall(Grow((void **)&series->parts, &series->part_capacity, series->n_parts + 1, sizeof(Part)));
  CountRows(series, &points, &cells);
  part  = &series->parts[series->n_parts++];
  *part = (Part){.n_points = n, .n_cells = n_cells, .cell_offset = cells, .id_offset = cells * layout->nodes};

  PetscCall(PetscMalloc3((size_t)n_cells + 1, &offsets, n_ids, &ids, (size_t)n_cells, &types));
  for (PetscInt c = 0; c <= n_cells; c++) offsets[c] = (PetscInt64)c * layout->nodes;
  for (size_t i = 0; i < n_ids; i++) ids[i] = series->kind == SERIES_POINTS ? (PetscInt)i : series->cells[i];
  if (n_cells) memset(types, layout->vtk_cell, (size_t)n_cells);
  OutputFileAppend(file, "/VTKHDF/NumberOfPoints", H5T_NATIVE_INT64, 1, &part->n_points);
  for (int c = 0; c < CategoryCount(series); c++) {
    const PetscBool  used = c == layout->category ? PETSC_TRUE : PETSC_FALSE;
    const PetscInt64 m = used ? n_cells : 0, m_ids = used ? (PetscInt64)n_ids : 0;
    const char      *group = Category(series, c);

    OutputFileAppend(file, In(group, "NumberOfCells").text, H5T_NATIVE_INT64, 1, &m);
    OutputFileAppend(file, In(group, "NumberOfConnectivityIds").text, H5T_NATIVE_INT64, 1, &m_ids);
    OutputFileAppend(file, In(group, "Offsets").text, H5T_NATIVE_INT64, (size_t)m + 1, offsets);
    OutputFileAppend(file, In(group, "Connectivity").text, id_type, (size_t)m_ids, ids);
  }
  if (IsGrid(series)) OutputFileAppend(file, "/VTKHDF/Types", H5T_NATIVE_UCHAR, (size_t)n_cells, types);
  PetscCall(PetscFree3(offsets, ids, types));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the data sets whose chunks follow the size of the first step */
static PetscErrorCode CreateSets(Series series, OutputFile *file, PetscInt n, PetscInt n_fields, const OutputField fields[])
{
  const SeriesLayout *layout  = &series_layouts[series->kind];
  const hid_t         type    = series->double_precision ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
  const size_t        rows    = PetscMax((size_t)n, 64);
  const size_t        n_cells = PetscMax((size_t)(series->kind == SERIES_POINTS ? n : series->n_cells), 64);

  PetscFunctionBegin;
  series->has_sets = PETSC_TRUE;
  for (int c = 0; c < CategoryCount(series); c++) {
    const PetscBool used = c == layout->category ? PETSC_TRUE : PETSC_FALSE;

    OutputFileCreateSet(file, In(Category(series, c), "Offsets").text, H5T_STD_I64LE, 1, used ? n_cells + 1 : STEP_CHUNK, used);
    OutputFileCreateSet(file, In(Category(series, c), "Connectivity").text, H5T_STD_I64LE, 1,
                        used ? n_cells * (size_t)layout->nodes : STEP_CHUNK, used);
  }
  if (IsGrid(series)) OutputFileCreateSet(file, "/VTKHDF/Types", H5T_STD_U8LE, 1, n_cells, PETSC_TRUE);
  OutputFileCreateSet(file, "/VTKHDF/Points", type, 3, rows, PETSC_TRUE);
  OutputFileSetText(file, "/VTKHDF/Points", "units", "m");
  for (PetscInt f = 0; f < n_fields; f++) {
    const Path path = In("/VTKHDF/PointData", fields[f].name);

    PetscCheck(fields[f].components == 1 || fields[f].components == 3, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "field %s has %" PetscInt_FMT " components", fields[f].name, fields[f].components);
    PetscCall(AddField(series, fields[f].name, fields[f].unit, fields[f].components));
    OutputFileCreateSet(file, path.text, type, (size_t)fields[f].components, rows, PETSC_TRUE);
    OutputFileSetText(file, path.text, "units", fields[f].unit && *fields[f].unit ? fields[f].unit : "1");
    CreateTable(file, "/VTKHDF/Steps/PointDataOffsets", fields[f].name, 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the fields of a step must be those of the file; their order is free */
static PetscErrorCode CheckFields(Series series, PetscInt n_fields, const OutputField fields[])
{
  PetscFunctionBegin;
  PetscCheck(n_fields == series->n_fields, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "%s has %" PetscInt_FMT " fields, now %" PetscInt_FMT, series->path, series->n_fields, n_fields);
  for (PetscInt f = 0; f < n_fields; f++) {
    PetscInt g = 0;

    while (g < series->n_fields &&
           (strcmp(series->fields[g].name, fields[f].name) || series->fields[g].components != fields[f].components))
      g++;
    PetscCheck(g < series->n_fields, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "%s has no field %s with %" PetscInt_FMT " components",
               series->path, fields[f].name, fields[f].components);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the row of a step in every table of Steps; NSteps last */
static void AddStep(Series series, OutputFile *file, const Step *step)
{
  const SeriesLayout *layout  = &series_layouts[series->kind];
  const Part         *part    = &series->parts[step->part];
  const PetscInt64    n_steps = (PetscInt64)series->n_steps + 1, one = 1;
  PetscInt64          cells[4] = {0, 0, 0, 0}, ids[4] = {0, 0, 0, 0};

  cells[layout->category] = part->cell_offset;
  ids[layout->category]   = part->id_offset;
  OutputFileAppend(file, "/VTKHDF/Steps/Values", H5T_NATIVE_DOUBLE, 1, &step->time);
  OutputFileAppend(file, "/VTKHDF/Steps/PartOffsets", H5T_NATIVE_INT64, 1, &step->part);
  OutputFileAppend(file, "/VTKHDF/Steps/NumberOfParts", H5T_NATIVE_INT64, 1, &one);
  OutputFileAppend(file, "/VTKHDF/Steps/PointOffsets", H5T_NATIVE_INT64, 1, &step->point_offset);
  OutputFileAppend(file, "/VTKHDF/Steps/CellOffsets", H5T_NATIVE_INT64, 1, cells);
  OutputFileAppend(file, "/VTKHDF/Steps/ConnectivityIdOffsets", H5T_NATIVE_INT64, 1, ids);
  for (PetscInt f = 0; f < series->n_fields; f++)
    OutputFileAppend(file, In("/VTKHDF/Steps/PointDataOffsets", series->fields[f].name).text, H5T_NATIVE_INT64, 1,
                     &step->point_offset);
  // only when all of the step is in the file may it be counted: whoever kills the run leaves whole steps
  OutputFileFlush(file);
  OutputFileSetInts(file, "/VTKHDF/Steps", "NSteps", 1, &n_steps);
}

/* upper bound of what a step adds to the file [bytes] */
static size_t StepBytes(Series series, PetscInt n, PetscInt n_fields, const OutputField fields[])
{
  const PetscBool new_part = !series->n_parts || series->parts[series->n_parts - 1].n_points != n ||
                                     (series->kind != SERIES_POINTS && !series->cells_checked)
                                 ? PETSC_TRUE
                                 : PETSC_FALSE;
  const size_t    nodes    = (size_t)series_layouts[series->kind].nodes;
  const size_t    n_cells  = (size_t)(series->kind == SERIES_POINTS ? n : series->n_cells);
  size_t          numbers  = 3;

  for (PetscInt f = 0; f < n_fields; f++) numbers += (size_t)fields[f].components;
  return numbers * (size_t)n * (series->double_precision ? 8 : 4) + (new_part ? n_cells * (8 + 8 * nodes + 1) : 0);
}

/*@
  SeriesWrite - add one time

  Not Collective, rank 0 writes

  Input Parameters:
+ series   - the series; of triangles and tetrahedra after SeriesSetCells()
. time     - later than the last [s]
. n        - number of points; may change from time to time where there are only points
. x        - positions [m], n x 3
. n_fields - number of point fields
- fields   - the same names and components every time

  Errors:
  BY_ERR_OUTPUT, reported once; what was written before stays readable, and later calls return BY_ERR_OUTPUT in silence
@*/
PetscErrorCode SeriesWrite(Series series, PetscReal time, PetscInt n, const PetscReal x[], PetscInt n_fields,
                           const OutputField fields[])
{
  OutputFile file;
  PetscBool  same;
  Step       step;
  PetscInt64 points, cells;

  PetscFunctionBegin;
  if (!series->active) PetscFunctionReturn(PETSC_SUCCESS);
  if (series->failed) PetscFunctionReturn(BY_ERR_OUTPUT);
  PetscCheck(series->kind == SERIES_POINTS || series->cells, PETSC_COMM_SELF, PETSC_ERR_ORDER,
             "SeriesSetCells comes before the first SeriesWrite of %s", series->path);
  PetscCall(Grow((void **)&series->steps, &series->step_capacity, series->n_steps + 1, sizeof(Step)));
  OutputFileOpen(series->path, OUTPUT_CHANGE, StepBytes(series, n, n_fields, fields), PETSC_FALSE, &file);
  PetscCall(IsLastPart(series, &file, n, &same));
  if (!series->has_sets) PetscCall(CreateSets(series, &file, n, n_fields, fields));
  PetscCall(CheckFields(series, n_fields, fields));
  CountRows(series, &points, &cells);
  if (!same) PetscCall(AddPart(series, &file, n));
  series->cells_checked = PETSC_TRUE;

  step = (Step){.part = (PetscInt64)series->n_parts - 1, .point_offset = points, .time = time};
  OutputFileAppend(&file, "/VTKHDF/Points", H5T_NATIVE_DOUBLE, (size_t)n, x);
  for (PetscInt f = 0; f < n_fields; f++)
    OutputFileAppend(&file, In("/VTKHDF/PointData", fields[f].name).text, H5T_NATIVE_DOUBLE, (size_t)n, fields[f].data);
  AddStep(series, &file, &step);
  if (Finish(series, &file)) PetscFunctionReturn(BY_ERR_OUTPUT);
  series->steps[series->n_steps++] = step;
  PetscFunctionReturn(SeriesWriteXdmf(series));
}

PetscErrorCode SeriesDestroy(Series *series)
{
  PetscFunctionBegin;
  if (!*series) PetscFunctionReturn(PETSC_SUCCESS);
  free((*series)->steps);
  free((*series)->parts);
  PetscCall(PetscFree((*series)->cells));
  PetscCall(PetscFree(*series));
  PetscFunctionReturn(PETSC_SUCCESS);
}
