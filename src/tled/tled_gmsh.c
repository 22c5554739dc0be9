/* tled_gmsh.c - a first look at a gmsh file: is it one, which groups has it, which elements, and their numbers.
   PETSc reads the mesh; this look makes the messages that a user needs when something is wrong with the file. */
#include "tled/tled_impl.h"
#include <errno.h>
#include <string.h>

typedef struct {
  FILE       *stream;
  const char *key, *path;
  int         version; /* 22, 40, 41 */
  PetscBool   binary;
} Reader;

static PetscErrorCode Broken(const Reader *r, const char what[])
{
  return InputError(r->key, "is a broken gmsh file: %s\n  write it again with gmsh (formats 4.1 and 2.2 are read)", what);
}

/* what a gmsh element type is called when it is not one of those we use; NULL for the useful and the harmless ones */
static const char *OtherElement(int type)
{
  switch (type) {
  case 1:
  case 2:
  case 4:
  case 15:
    return NULL; /* line, triangle, tetrahedron, point */
  case 3:
    return "4-node quadrangle";
  case 5:
    return "8-node hexahedron";
  case 6:
    return "6-node prism";
  case 7:
    return "5-node pyramid";
  case 8:
    return "second-order line";
  case 9:
    return "second-order triangle";
  case 11:
    return "second-order (10-node) tetrahedron";
  default:
    return "element of another kind";
  }
}

static void SkipLine(FILE *stream)
{
  int c;
  while ((c = fgetc(stream)) != EOF && c != '\n') {}
}

/* the next section's name, "$Nodes" say; returns 0 at the end of the file */
static int NextSection(FILE *stream, char name[64])
{
  char line[256];

  while (fgets(line, sizeof line, stream)) {
    if (line[0] == '$' && strncmp(line, "$End", 4)) return sscanf(line, "%63s", name) == 1;
    if (!strchr(line, '\n')) SkipLine(stream);
  }
  return 0;
}

/* $PhysicalNames: n, then lines `dim tag "name"` */
static PetscErrorCode ReadNames(Reader *r, TLEDGmshFile *file)
{
  int n;

  PetscFunctionBegin;
  if (fscanf(r->stream, "%d", &n) != 1) PetscFunctionReturn(Broken(r, "its $PhysicalNames section cannot be read"));
  for (int i = 0; i < n; i++) {
    int  dim, tag;
    char name[128];
    if (fscanf(r->stream, "%d %d \"%127[^\"]\"", &dim, &tag, name) != 3)
      PetscFunctionReturn(Broken(r, "its $PhysicalNames section cannot be read"));
    if (file->n_groups == BY_NAMES_MAX) continue;
    file->dim[file->n_groups] = dim;
    PetscCall(PetscStrncpy(file->name[file->n_groups++], name, BY_NAME_MAX));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void CountElement(TLEDGmshFile *file, int type, PetscInt tag)
{
  if (type == 4) file->tag[file->n_tets++] = tag;
  else if (type == 2) file->n_triangles++;
  else if (OtherElement(type) && !file->n_other++) (void)PetscStrncpy(file->other, OtherElement(type), sizeof file->other);
}

/* $Elements of an ASCII file */
static PetscErrorCode ReadElements(Reader *r, TLEDGmshFile *file)
{
  long n_blocks = 1, n = 0, done = 0;
  char end[64];

  PetscFunctionBegin;
  if (r->version == 22) {
    if (fscanf(r->stream, "%ld", &n) != 1) n = -1;
  } else if (fscanf(r->stream, "%ld %ld", &n_blocks, &n) != 2) n = -1;
  if (n < 0 || n > PETSC_MAX_INT || n_blocks < 0) PetscFunctionReturn(Broken(r, "its $Elements section cannot be read"));
  SkipLine(r->stream);
  PetscCall(PetscMalloc1(n + 1, &file->tag));
  for (long b = 0; b < n_blocks; b++) {
    int  dim, entity, type = 0, tag;
    long m = n;
    if (r->version == 40 && fscanf(r->stream, "%d %d %d %ld", &entity, &dim, &type, &m) != 4) m = -1;
    if (r->version == 41 && fscanf(r->stream, "%d %d %d %ld", &dim, &entity, &type, &m) != 4) m = -1;
    if (m < 0 || done + m > n) PetscFunctionReturn(Broken(r, "its $Elements section cannot be read"));
    for (long i = 0; i < m; i++, done++) {
      if (r->version == 22 ? fscanf(r->stream, "%d %d", &tag, &type) != 2 : fscanf(r->stream, "%d", &tag) != 1)
        PetscFunctionReturn(Broken(r, "it ends within its $Elements section"));
      CountElement(file, type, tag);
      SkipLine(r->stream);
    }
  }
  if (fscanf(r->stream, "%63s", end) != 1 || strcmp(end, "$EndElements"))
    PetscFunctionReturn(Broken(r, "it ends before $EndElements"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadSections(Reader *r, TLEDGmshFile *file)
{
  double    version = 0.0;
  int       kind = 0, bytes = 0;
  char      line[256], section[64];
  PetscBool nodes = PETSC_FALSE, elements = PETSC_FALSE;

  PetscFunctionBegin;
  if (!fgets(line, sizeof line, r->stream) || strncmp(line, "$MeshFormat", 11))
    PetscFunctionReturn(InputError(
        r->key, "is not a gmsh mesh: it does not begin with $MeshFormat\n  expected a .msh file of gmsh, format 4.1 or 2.2"));
  if (!fgets(line, sizeof line, r->stream) || sscanf(line, "%lf %d %d", &version, &kind, &bytes) != 3)
    PetscFunctionReturn(Broken(r, "its format line cannot be read"));
  r->version = (int)(10.0 * version + 0.5);
  r->binary  = kind ? PETSC_TRUE : PETSC_FALSE;
  if (r->version != 22 && r->version != 40 && r->version != 41)
    PetscFunctionReturn(
        InputError(r->key, "is in gmsh format %g, which is not read\n  expected format 4.1 or 2.2 (gmsh -format msh41)", version));
  while (NextSection(r->stream, section)) {
    if (!strcmp(section, "$PhysicalNames")) ByCall(ReadNames(r, file));
    if (!strcmp(section, "$Nodes")) nodes = PETSC_TRUE;
    if (r->binary && nodes) break; /* from here on PETSc */
    if (!strcmp(section, "$Elements")) {
      elements = PETSC_TRUE;
      ByCall(ReadElements(r, file));
    }
  }
  if (!nodes) PetscFunctionReturn(Broken(r, "it has no $Nodes section"));
  if (!elements && !r->binary) PetscFunctionReturn(Broken(r, "it has no $Elements section"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDGmshRead_Private - look at a gmsh file: header, names of physical groups, kinds and numbers of the elements

  Input Parameters:
+ key  - the scene key that names the file, "flap.mesh", for messages
- path - the file

  Output Parameter:
. file - what it holds; TLEDGmshDestroy_Private() frees it, also after an error

  Errors: BY_ERR_INPUT, reported: cannot be opened, not gmsh, unknown format, broken
*/
PetscErrorCode TLEDGmshRead_Private(const char key[], const char path[], TLEDGmshFile *file)
{
  Reader         reader = {NULL, key, path, 0, PETSC_FALSE};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(file, sizeof *file));
  reader.stream = fopen(path, "rb");
  if (!reader.stream) PetscFunctionReturn(InputError(key, "cannot be opened: %s (%s)", path, strerror(errno)));
  ierr = ReadSections(&reader, file);
  fclose(reader.stream);
  ByCall(ierr);
  if (reader.binary) file->n_tets = file->n_triangles = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDGmshDestroy_Private(TLEDGmshFile *file)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(file->tag));
  PetscFunctionReturn(PETSC_SUCCESS);
}
