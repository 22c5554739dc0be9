/* tled_gmsh.c - a first look at a gmsh file: is it one, which groups has it, which elements, and their numbers.
   PETSc reads the mesh; this look makes the messages that a user needs when something is wrong with the file. */
#include "tled/tled_impl.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  FILE       *stream;
  const char *key, *path;
  int         version; /* 22, 41                                         */
  PetscBool   binary;
  long        size;          /* of the file, bytes            */
  size_t      n_numbers;     /* nodes of an ASCII file        */
  PetscInt   *numbers;       /* their numbers, ascending      */
  size_t      n_entities[4]; /* of each dimension (format 4.1) */
  PetscInt   *entity[4];     /* their numbers, ascending       */
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

/* $PhysicalNames: n, then lines `dim tag "name"`, in exactly this form: PETSc's reader takes nothing else, and does not check */
static PetscErrorCode ReadNames(Reader *r, TLEDGmshFile *file)
{
  int  n;
  char line[256], again[256];

  PetscFunctionBegin;
  if (fscanf(r->stream, "%d", &n) != 1 || n < 0 || fgetc(r->stream) == EOF)
    PetscFunctionReturn(Broken(r, "its $PhysicalNames section cannot be read"));
  for (int i = 0; i < n; i++) {
    int  dim, tag;
    char name[128];
    if (!fgets(line, sizeof line, r->stream) || sscanf(line, "%d %d \"%127[^\"]\"", &dim, &tag, name) != 3)
      PetscFunctionReturn(Broken(r, "its $PhysicalNames section cannot be read"));
    line[strcspn(line, "\r\n")] = 0;
    PetscCall(PetscSNPrintf(again, sizeof again, "%d %d \"%s\"", dim, tag, name));
    if (strcmp(line, again)) PetscFunctionReturn(Broken(r, "its $PhysicalNames section cannot be read"));
    if (file->n_groups == BY_NAMES_MAX) continue;
    file->dim[file->n_groups] = dim;
    PetscCall(PetscStrncpy(file->name[file->n_groups++], name, BY_NAME_MAX));
  }
  if (!fgets(line, sizeof line, r->stream) || strncmp(line, "$EndPhysicalNames", 17))
    PetscFunctionReturn(Broken(r, "its $PhysicalNames section cannot be read"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int CompareInts(const void *a, const void *b)
{
  return (*(const PetscInt *)a > *(const PetscInt *)b) - (*(const PetscInt *)a < *(const PetscInt *)b);
}

/* whole numbers that fit a PetscInt */
static PetscBool ReadInts(Reader *r, int n, PetscInt values[])
{
  for (int i = 0; i < n; i++) {
    long v;
    if (fscanf(r->stream, "%ld", &v) != 1 || v < -PETSC_MAX_INT || v > PETSC_MAX_INT) return PETSC_FALSE;
    values[i] = (PetscInt)v;
  }
  return PETSC_TRUE;
}

static PetscBool SkipReals(Reader *r, int n)
{
  double v;

  for (int i = 0; i < n; i++)
    if (fscanf(r->stream, "%lf", &v) != 1) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* a counted list of whole numbers that do not matter here */
static PetscBool SkipList(Reader *r)
{
  PetscInt n, v;

  if (!ReadInts(r, 1, &n) || n < 0 || n > 1000) return PETSC_FALSE;
  for (PetscInt i = 0; i < n; i++)
    if (!ReadInts(r, 1, &v)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* a count that the file can hold: each thing takes at least two characters */
static PetscBool Plausible(const Reader *r, PetscInt n) { return n >= 0 && n <= r->size / 2 + 1 ? PETSC_TRUE : PETSC_FALSE; }

static PetscBool SectionEnds(Reader *r, const char name[])
{
  char end[64];

  return fscanf(r->stream, "%63s", end) == 1 && !strcmp(end, name) ? PETSC_TRUE : PETSC_FALSE;
}

/* $Entities (format 4.1): numbers of the points, curves, surfaces and volumes, each with its lists of physical groups and boundary
 */
static PetscErrorCode ReadEntities(Reader *r)
{
  PetscInt n[4];

  PetscFunctionBegin;
  if (!ReadInts(r, 4, n)) PetscFunctionReturn(Broken(r, "its $Entities section cannot be read"));
  for (int dim = 0; dim < 4; dim++) {
    if (!Plausible(r, n[dim]) || r->entity[dim]) PetscFunctionReturn(Broken(r, "its $Entities section cannot be read"));
    PetscCall(PetscMalloc1(n[dim] + 1, &r->entity[dim]));
    for (PetscInt i = 0; i < n[dim]; i++) {
      if (!ReadInts(r, 1, &r->entity[dim][i]) || !SkipReals(r, dim ? 6 : 3) || !SkipList(r) || (dim && !SkipList(r)))
        PetscFunctionReturn(Broken(r, "its $Entities section cannot be read"));
    }
    r->n_entities[dim] = (size_t)n[dim];
    qsort(r->entity[dim], r->n_entities[dim], sizeof(PetscInt), CompareInts);
  }
  if (!SectionEnds(r, "$EndEntities")) PetscFunctionReturn(Broken(r, "its $Entities section cannot be read"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* is there an entity of that dimension and number? Format 2.2 has none to ask for. */
static PetscBool HasEntity(const Reader *r, PetscInt dim, PetscInt number)
{
  if (r->version == 22) return PETSC_TRUE;
  if (dim < 0 || dim > 3 || !r->entity[dim]) return PETSC_FALSE;
  return bsearch(&number, r->entity[dim], r->n_entities[dim], sizeof number, CompareInts) ? PETSC_TRUE : PETSC_FALSE;
}

/* a block of nodes: in format 2.2 number and place of each, in 4.1 a head, all numbers, then all places */
static PetscBool ReadNodeBlock(Reader *r, PetscInt n_left, PetscInt numbers[], PetscInt *n)
{
  PetscInt head[4]; /* dimension, entity, parametric, count */

  *n = n_left;
  if (r->version == 41) {
    if (!ReadInts(r, 4, head) || !HasEntity(r, head[0], head[1]) || head[2] || head[3] < 0 || head[3] > n_left) return PETSC_FALSE;
    *n = head[3];
    if (!ReadInts(r, (int)*n, numbers)) return PETSC_FALSE;
  }
  for (PetscInt i = 0; i < *n; i++)
    if ((r->version == 22 && !ReadInts(r, 1, &numbers[i])) || !SkipReals(r, 3)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* $Nodes: the nodes' numbers, sorted; each once, and not so far apart that a table from the first to the last would not fit */
static PetscErrorCode ReadNodes(Reader *r)
{
  PetscInt head[4] = {1, 0, 0, 0}, done = 0; /* blocks, nodes, smallest and largest number */

  PetscFunctionBegin;
  if (r->numbers || !(r->version == 22 ? ReadInts(r, 1, &head[1]) : ReadInts(r, 4, head)) || !Plausible(r, head[0]) ||
      !Plausible(r, head[1]))
    PetscFunctionReturn(Broken(r, "its $Nodes section cannot be read"));
  PetscCall(PetscMalloc1(head[1] + 1, &r->numbers));
  for (PetscInt b = 0; b < head[0]; b++) {
    PetscInt n;
    if (!ReadNodeBlock(r, head[1] - done, r->numbers + done, &n))
      PetscFunctionReturn(Broken(r, "its $Nodes section cannot be read"));
    done += n;
  }
  if (done < head[1] || !done || !SectionEnds(r, "$EndNodes")) PetscFunctionReturn(Broken(r, "its $Nodes section cannot be read"));
  r->n_numbers = (size_t)done;
  qsort(r->numbers, r->n_numbers, sizeof *r->numbers, CompareInts);
  for (PetscInt i = 1; i < done; i++)
    if (r->numbers[i] == r->numbers[i - 1]) PetscFunctionReturn(Broken(r, "two nodes have the same number"));
  if (r->numbers[0] < 1 || r->numbers[done - 1] / 1000 > 1000 + done)
    PetscFunctionReturn(Broken(r, "its nodes' numbers are not from 1 on"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the corners of an element: they exist, and are different nodes */
static PetscErrorCode ReadCorners(Reader *r, PetscInt type, PetscInt tag)
{
  const int n = type == 15 ? 1 : type == 1 ? 2 : type == 2 ? 3 : 4;
  PetscInt  corner[4];
  char      what[128];

  PetscFunctionBegin;
  if (!ReadInts(r, n, corner)) PetscFunctionReturn(Broken(r, "it ends within its $Elements section"));
  for (int i = 0; i < n; i++) {
    const char *fault =
        bsearch(&corner[i], r->numbers, r->n_numbers, sizeof *corner, CompareInts) ? NULL : "which is not in the file";
    for (int k = 0; k < i; k++)
      if (corner[k] == corner[i]) fault = "twice";
    if (!fault) continue;
    PetscCall(PetscSNPrintf(what, sizeof what, "element %" PetscInt_FMT " has node %" PetscInt_FMT ", %s", tag, corner[i], fault));
    PetscFunctionReturn(Broken(r, what));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One element: in format 2.2 number, type, tags, corners; in 4.1, of a block of `type`, number and corners. Of types that are not
   used only the first is looked at: the mesh is refused for it. */
static PetscErrorCode ReadElement(Reader *r, PetscInt type, TLEDGmshFile *file)
{
  PetscInt head[3] = {0, type, 0}, tag; /* number, type, how many tags */

  PetscFunctionBegin;
  if (!ReadInts(r, r->version == 22 ? 3 : 1, head) || head[2] < 0 || head[2] > 16)
    PetscFunctionReturn(Broken(r, "it ends within its $Elements section"));
  if (OtherElement((int)head[1])) {
    file->n_other++;
    PetscCall(PetscStrncpy(file->other, OtherElement((int)head[1]), sizeof file->other));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt i = 0; i < head[2]; i++)
    if (!ReadInts(r, 1, &tag)) PetscFunctionReturn(Broken(r, "it ends within its $Elements section"));
  ByCall(ReadCorners(r, head[1], head[0]));
  if (head[1] == 4) file->tag[file->n_tets++] = head[0];
  if (head[1] == 2) file->n_triangles++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* $Elements, up to the first of a kind that is not used */
static PetscErrorCode ReadElements(Reader *r, TLEDGmshFile *file)
{
  PetscInt head[4] = {1, 0, 0, 0}, block[4] = {0, 0, 0, 0},
           done = 0; /* blocks, elements, numbers; dimension, entity, type, count */

  PetscFunctionBegin;
  if (file->tag || !r->numbers || !(r->version == 22 ? ReadInts(r, 1, &head[1]) : ReadInts(r, 4, head)) || !Plausible(r, head[0]) ||
      !Plausible(r, head[1]))
    PetscFunctionReturn(Broken(r, "its $Elements section cannot be read"));
  PetscCall(PetscMalloc1(head[1] + 1, &file->tag));
  block[3] = head[1];
  for (PetscInt b = 0; b < head[0]; b++) {
    if (r->version == 41 && (!ReadInts(r, 4, block) || !HasEntity(r, block[0], block[1]))) block[3] = -1;
    if (block[3] < 0 || block[3] > head[1] - done) PetscFunctionReturn(Broken(r, "its $Elements section cannot be read"));
    for (PetscInt i = 0; i < block[3]; i++, done++) {
      ByCall(ReadElement(r, block[2], file));
      if (file->n_other) PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  if (done < head[1] || !SectionEnds(r, "$EndElements")) PetscFunctionReturn(Broken(r, "it ends before $EndElements"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadHeader(Reader *r)
{
  double version = 0.0;
  int    kind = 0, bytes = 0;
  char   line[256];

  PetscFunctionBegin;
  if (!fgets(line, sizeof line, r->stream) || strncmp(line, "$MeshFormat", 11))
    PetscFunctionReturn(InputError(r->key, "is not a gmsh mesh: it does not begin with $MeshFormat\n"
                                           "  expected a .msh file of gmsh, format 4.1 or 2.2"));
  if (!fgets(line, sizeof line, r->stream) || sscanf(line, "%lf %d %d", &version, &kind, &bytes) != 3)
    PetscFunctionReturn(Broken(r, "its format line cannot be read"));
  r->version = (int)(10.0 * version + 0.5);
  r->binary  = kind ? PETSC_TRUE : PETSC_FALSE;
  if ((r->version != 22 && r->version != 41) || fabs(0.1 * r->version - version) > 1e-9)
    PetscFunctionReturn(
        InputError(r->key, "is in gmsh format %g, which is not read\n  expected format 4.1 or 2.2 (gmsh -format msh41)", version));
  if (kind < 0 || kind > 1 || bytes != 8) PetscFunctionReturn(Broken(r, "its format line cannot be read"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadSections(Reader *r, TLEDGmshFile *file)
{
  char section[64];

  PetscFunctionBegin;
  ByCall(ReadHeader(r));
  while (!file->n_other && NextSection(r->stream, section)) {
    if (!strcmp(section, "$PhysicalNames")) ByCall(ReadNames(r, file));
    if (r->binary) {
      if (!strcmp(section, "$Nodes")) PetscFunctionReturn(PETSC_SUCCESS); /* from here on PETSc */
      continue;
    }
    if (!strcmp(section, "$Entities") && r->version == 41) ByCall(ReadEntities(r));
    if (!strcmp(section, "$Nodes")) ByCall(ReadNodes(r));
    if (!strcmp(section, "$Elements")) ByCall(ReadElements(r, file));
  }
  if (!r->numbers) PetscFunctionReturn(Broken(r, "it has no $Nodes section"));
  if (!file->tag) PetscFunctionReturn(Broken(r, "it has no $Elements section"));
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
  Reader         reader = {NULL, key, path, 0, PETSC_FALSE, 0, 0, NULL, {0}, {NULL}};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(file, sizeof *file));
  reader.stream = fopen(path, "rb");
  if (!reader.stream) PetscFunctionReturn(InputError(key, "cannot be opened: %s (%s)", path, strerror(errno)));
  if (!fseek(reader.stream, 0, SEEK_END)) reader.size = ftell(reader.stream);
  rewind(reader.stream);
  ierr = ReadSections(&reader, file);
  fclose(reader.stream);
  PetscCall(PetscFree(reader.numbers));
  for (int dim = 0; dim < 4; dim++) PetscCall(PetscFree(reader.entity[dim]));
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
