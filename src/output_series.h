/* output_series.h - what output_series.c (HDF5) and output_xdmf.c share. */
#ifndef BY_OUTPUT_SERIES_H
#define BY_OUTPUT_SERIES_H

#include "output_file.h"

#define SERIES_FIELDS_MAX 32

typedef struct {
  PetscInt64 part, point_offset; /* topology, and the row where the points begin */
  PetscReal  time;               /* [s]                                          */
} Step;

typedef struct {
  PetscInt64 n_points, n_cells;      /* of this topology                 */
  PetscInt64 cell_offset, id_offset; /* sums of the topologies before it */
} Part;

struct _Series {
  char       name[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN], xdmf_path[PETSC_MAX_PATH_LEN];
  SeriesKind kind;
  PetscBool  active;           /* this rank writes                                             */
  PetscBool  failed;           /* a write failed: nothing more is tried                        */
  PetscBool  double_precision; /* points and fields on disk                                    */
  PetscBool  cells_checked;    /* the last topology in the file is the one of SeriesSetCells() */
  PetscInt   n_cells, *cells;
  size_t     n_steps, n_parts, step_capacity, part_capacity;
  Step      *steps;
  Part      *parts;
  PetscBool  has_sets; /* the data sets of points and fields are there: a first step was written */
  PetscInt   n_fields;
  struct {
    char     name[64], unit[32];
    PetscInt components;
  } fields[SERIES_FIELDS_MAX];
};

typedef struct {
  const char *type;     /* VTK's data type                                   */
  const char *cells;    /* group of the cells                                */
  const char *xdmf;     /* XDMF's name of a cell                             */
  int         nodes;    /* points of a cell                                  */
  int         vtk_cell; /* VTK's number of the cell type                     */
  int         category; /* of Vertices, Lines, Polygons, Strips the one used */
} SeriesLayout;
extern PETSC_VISIBILITY_INTERNAL const SeriesLayout series_layouts[]; /* by SeriesKind */

/* write the .xmf anew from the tables of steps and parts */
PETSC_INTERN PetscErrorCode SeriesWriteXdmf(Series series);

#endif
