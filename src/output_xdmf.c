/* output_xdmf.c - the .xmf beside a .vtkhdf, for viewers that do not read temporal VTKHDF (ParaView before 5.12; of its readers
   choose "XDMF Reader", those called Xdmf3 do not know pieces of data sets): a temporal collection of grids whose arrays are pieces
   (hyperslabs) of the same data sets. Written anew after every step and renamed. */
#include "output_series.h"
#include <stdlib.h>
#include <string.h>

/* text of `s` for XML */
static PetscErrorCode AddEscaped(OutputText *text, const char s[])
{
  PetscFunctionBegin;
  for (; *s; s++) {
    switch (*s) {
    case '<':
      PetscCall(OutputTextAdd(text, "&lt;"));
      break;
    case '>':
      PetscCall(OutputTextAdd(text, "&gt;"));
      break;
    case '&':
      PetscCall(OutputTextAdd(text, "&amp;"));
      break;
    case '"':
      PetscCall(OutputTextAdd(text, "&quot;"));
      break;
    default:
      PetscCall(OutputTextAdd(text, "%c", *s));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rows [start, start + rows) of a data set with `total` rows and `columns` columns */
static PetscErrorCode AddSlab(OutputText *text, Series series, const char set[], const char number[], PetscInt64 start,
                              PetscInt64 rows, PetscInt64 total, int columns)
{
  PetscFunctionBegin;
  if (columns > 1) {
    PetscCall(OutputTextAdd(text, "        <DataItem ItemType=\"HyperSlab\" Dimensions=\"%lld %d\">\n", (long long)rows, columns));
    PetscCall(OutputTextAdd(text, "          <DataItem Dimensions=\"3 2\" Format=\"XML\">%lld 0 1 1 %lld %d</DataItem>\n",
                            (long long)start, (long long)rows, columns));
    PetscCall(
        OutputTextAdd(text, "          <DataItem Dimensions=\"%lld %d\" %s Format=\"HDF\">", (long long)total, columns, number));
  } else {
    PetscCall(OutputTextAdd(text, "        <DataItem ItemType=\"HyperSlab\" Dimensions=\"%lld\">\n", (long long)rows));
    PetscCall(OutputTextAdd(text, "          <DataItem Dimensions=\"3 1\" Format=\"XML\">%lld 1 %lld</DataItem>\n",
                            (long long)start, (long long)rows));
    PetscCall(OutputTextAdd(text, "          <DataItem Dimensions=\"%lld\" %s Format=\"HDF\">", (long long)total, number));
  }
  PetscCall(AddEscaped(text, series->name));
  PetscCall(OutputTextAdd(text, ".vtkhdf:%s</DataItem>\n        </DataItem>\n", set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one time */
static PetscErrorCode AddGrid(OutputText *text, Series series, const Step *step, PetscInt64 total_points, PetscInt64 total_ids)
{
  const SeriesLayout *layout = &series_layouts[series->kind];
  const Part         *part   = &series->parts[step->part];
  const char *number = series->double_precision ? "NumberType=\"Float\" Precision=\"8\"" : "NumberType=\"Float\" Precision=\"4\"";
  char        set[256], time[32];

  PetscFunctionBegin;
  OutputFormatReal(step->time, time);
  PetscCall(OutputTextAdd(text, "    <Grid Name=\""));
  PetscCall(AddEscaped(text, series->name));
  PetscCall(OutputTextAdd(text, "\" GridType=\"Uniform\">\n      <Time Value=\"%s\"/>\n", time));
  PetscCall(OutputTextAdd(text, "      <Topology TopologyType=\"%s\" NumberOfElements=\"%lld\"%s>\n", layout->xdmf,
                          (long long)part->n_cells, series->kind == SERIES_POINTS ? " NodesPerElement=\"1\"" : ""));
  snprintf(set, sizeof(set), "%s/Connectivity", layout->cells);
  PetscCall(AddSlab(text, series, set, "NumberType=\"Int\" Precision=\"8\"", part->id_offset, part->n_cells * layout->nodes,
                    total_ids, 1));
  PetscCall(OutputTextAdd(text, "      </Topology>\n      <Geometry GeometryType=\"XYZ\">\n"));
  PetscCall(AddSlab(text, series, "/VTKHDF/Points", number, step->point_offset, part->n_points, total_points, 3));
  PetscCall(OutputTextAdd(text, "      </Geometry>\n"));
  for (PetscInt f = 0; f < series->n_fields; f++) {
    const int components = (int)series->fields[f].components;

    PetscCall(OutputTextAdd(text, "      <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">\n", series->fields[f].name,
                            components == 3 ? "Vector" : "Scalar"));
    snprintf(set, sizeof(set), "/VTKHDF/PointData/%s", series->fields[f].name);
    PetscCall(AddSlab(text, series, set, number, step->point_offset, part->n_points, total_points, components));
    PetscCall(OutputTextAdd(text, "      </Attribute>\n"));
  }
  PetscCall(OutputTextAdd(text, "    </Grid>\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SeriesWriteXdmf(Series series)
{
  const SeriesLayout *layout = &series_layouts[series->kind];
  const Step         *last   = series->n_steps ? &series->steps[series->n_steps - 1] : NULL;
  const Part         *final  = series->n_parts ? &series->parts[series->n_parts - 1] : NULL;
  const PetscInt64    points = last ? last->point_offset + series->parts[last->part].n_points : 0;
  const PetscInt64    ids    = final ? final->id_offset + final->n_cells * layout->nodes : 0;
  OutputText          text   = {NULL, 0, 0};
  PetscErrorCode      status;

  PetscFunctionBegin;
  PetscCall(OutputTextAdd(&text, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n    <Grid "
                                 "Name=\"series\" GridType=\"Collection\" CollectionType=\"Temporal\">\n"));
  for (size_t i = 0; i < series->n_steps; i++) {
    // viewers stop at a grid without points: a time at which there were none is left out
    if (series->parts[series->steps[i].part].n_points) PetscCall(AddGrid(&text, series, &series->steps[i], points, ids));
  }
  PetscCall(OutputTextAdd(&text, "    </Grid>\n  </Domain>\n</Xdmf>\n"));
  status = OutputReplaceText(series->xdmf_path, text.text, text.n, PETSC_FALSE);
  free(text.text);
  if (status) series->failed = PETSC_TRUE;
  PetscFunctionReturn(status);
}
