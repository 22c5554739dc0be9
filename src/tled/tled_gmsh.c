/* tled_gmsh.c - the reader of gmsh files: formats 4.1 and 2.2, text and binary, elements of first and second order, physical groups by
   name. Nothing in the file is believed: counts, numbers and ends of sections are checked, and what is wrong is told. */
#include "tled/tled_impl.h"
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* a geometric entity of format 4.1 and the physical groups that it belongs to */
typedef struct {
  PetscInt   number;
  PetscInt64 groups; /* bit g: named group g */
} Entity;

typedef struct {
  const char   *key, *path;
  char         *text;          /* whole file, ends with 0             */
  size_t        size, at;      /* bytes, reading position             */
  int           version;       /* 22, 41                              */
  PetscBool     binary, swap;  /* swap: bytes of the other order      */
  PetscInt     *tags, *places; /* numbers of the nodes, ascending, and where they stand in the file */
  PetscInt      n_entities[4]; /* of each dimension (format 4.1)      */
  Entity       *entity[4];     /* by ascending number                 */
  TLEDGmshFile *file;
} Reader;

static PetscErrorCode Broken(const Reader *r, const char what[])
{
  return InputError(r->key, "is a broken gmsh file: %s\n  write it again with gmsh (formats 4.1 and 2.2 are read)", what);
}

/* nodes and dimension of the gmsh element types that are used; n_nodes 0 for the others, with what they are called */
static const char *ElementKind(PetscInt type, PetscInt *n_nodes, PetscInt *dim)
{
  static const struct {
    PetscInt type, n_nodes, dim;
  } used[] = {{15, 1, 0}, {1, 2, 1}, {8, 3, 1}, {2, 3, 2}, {9, 6, 2}, {TLED_GMSH_TET4, 4, 3}, {TLED_GMSH_TET10, 10, 3}};
  static const struct {
    PetscInt    type;
    const char *name;
  } other[] = {{3, "4-node quadrangle"},       {5, "8-node hexahedron"},        {6, "6-node prism"},
               {7, "5-node pyramid"},          {10, "9-node quadrangle"},       {12, "27-node hexahedron"},
               {16, "8-node quadrangle"},      {17, "20-node hexahedron"},      {21, "third-order triangle"},
               {26, "third-order line"},       {29, "third-order tetrahedron"}, {30, "fourth-order tetrahedron"},
               {23, "fourth-order triangle"},  {27, "fourth-order line"},       {31, "fifth-order tetrahedron"}};

  *n_nodes = *dim = 0;
  for (size_t i = 0; i < sizeof used / sizeof *used; i++) {
    if (used[i].type != type) continue;
    *n_nodes = used[i].n_nodes, *dim = used[i].dim;
    return "";
  }
  for (size_t i = 0; i < sizeof other / sizeof *other; i++)
    if (other[i].type == type) return other[i].name;
  return "a kind that is not known";
}

/* `bytes` of the file as they lie in memory here */
static PetscBool ReadBytes(Reader *r, size_t bytes, void *value)
{
  if (r->size - r->at < bytes) return PETSC_FALSE;
  for (size_t i = 0; i < bytes; i++) ((char *)value)[i] = r->text[r->at + (r->swap ? bytes - 1 - i : i)];
  r->at += bytes;
  return PETSC_TRUE;
}

/* a number written out, with an end */
static PetscBool TextEnds(Reader *r, const char *end)
{
  const char *begin = r->text + r->at;

  if (end == begin || (*end && !isspace((unsigned char)*end))) return PETSC_FALSE;
  r->at = (size_t)(end - r->text);
  return PETSC_TRUE;
}

/* whole numbers that fit a PetscInt; in a binary file of 4 or 8 bytes each */
static PetscBool ReadInts(Reader *r, int bytes, PetscInt n, PetscInt values[])
{
  for (PetscInt i = 0; i < n; i++) {
    long long v;
    if (r->binary && bytes == 4) {
      int word;
      if (!ReadBytes(r, 4, &word)) return PETSC_FALSE;
      v = word;
    } else if (r->binary) {
      if (!ReadBytes(r, 8, &v)) return PETSC_FALSE;
    } else {
      char *end;
      errno = 0;
      v     = strtoll(r->text + r->at, &end, 10);
      if (errno || !TextEnds(r, end)) return PETSC_FALSE;
    }
    if (v < -PETSC_MAX_INT || v > PETSC_MAX_INT) return PETSC_FALSE;
    values[i] = (PetscInt)v;
  }
  return PETSC_TRUE;
}

/* finite numbers */
static PetscBool ReadReals(Reader *r, PetscInt n, PetscReal values[])
{
  for (PetscInt i = 0; i < n; i++) {
    double v;
    if (r->binary) {
      if (!ReadBytes(r, 8, &v)) return PETSC_FALSE;
    } else {
      char *end;
      v = strtod(r->text + r->at, &end);
      if (!TextEnds(r, end)) return PETSC_FALSE;
    }
    if (!isfinite(v)) return PETSC_FALSE;
    values[i] = v;
  }
  return PETSC_TRUE;
}

static void SkipLine(Reader *r)
{
  while (r->at < r->size && r->text[r->at] != '\n') r->at++;
  if (r->at < r->size) r->at++;
}

/* the one number of a line of text, also in a binary file */
static PetscBool ReadCount(Reader *r, PetscInt *n)
{
  const PetscBool binary = r->binary;

  r->binary             = PETSC_FALSE;
  const PetscBool found = ReadInts(r, 4, 1, n);
  r->binary             = binary;
  if (binary) SkipLine(r);
  return found;
}

/* a count that the file can hold: each thing takes at least two characters */
static PetscBool Plausible(const Reader *r, PetscInt n) { return n >= 0 && (size_t)n <= r->size / 2 + 1 ? PETSC_TRUE : PETSC_FALSE; }

/* the next section's name, "$Nodes" say, and on to its first line; false at the end of the file */
static PetscBool NextSection(Reader *r, char name[64])
{
  for (; r->at < r->size; r->at++) {
    if (r->text[r->at] != '$' || (r->at && r->text[r->at - 1] != '\n') || !strncmp(r->text + r->at, "$End", 4)) continue;
    if (sscanf(r->text + r->at, "%63s", name) != 1) continue;
    SkipLine(r);
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscBool SectionEnds(Reader *r, const char end[])
{
  const size_t n = strlen(end);

  while (r->at < r->size && isspace((unsigned char)r->text[r->at])) r->at++;
  if (r->size - r->at < n || strncmp(r->text + r->at, end, n)) return PETSC_FALSE;
  r->at += n;
  return PETSC_TRUE;
}

/* $PhysicalNames: n, then lines `dim tag "name"` */
static PetscErrorCode ReadNames(Reader *r)
{
  TLEDGmshFile *file = r->file;
  PetscInt      n;

  PetscFunctionBegin;
  if (!ReadCount(r, &n) || n < 0) PetscFunctionReturn(Broken(r, "its $PhysicalNames section cannot be read"));
  for (PetscInt i = 0; i < n; i++) {
    int  dim, tag, used = 0;
    char name[128];
    if (sscanf(r->text + r->at, "%d %d \"%127[^\"\n]\"%n", &dim, &tag, name, &used) != 3 || !used || dim < 0 || dim > 3)
      PetscFunctionReturn(Broken(r, "its $PhysicalNames section cannot be read"));
    r->at += (size_t)used;
    if (file->n_groups == TLED_GROUPS_MAX)
      PetscFunctionReturn(InputError(r->key, "has more than %d named physical groups", TLED_GROUPS_MAX));
    file->dim[file->n_groups]    = dim;
    file->number[file->n_groups] = tag;
    PetscCall(PetscStrncpy(file->name[file->n_groups++], name, BY_NAME_MAX));
  }
  if (!SectionEnds(r, "$EndPhysicalNames")) PetscFunctionReturn(Broken(r, "its $PhysicalNames section cannot be read"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the named groups of dimension dim with a physical number; gmsh writes a minus where the entity is turned round */
static PetscInt64 GroupsOf(const TLEDGmshFile *file, PetscInt dim, PetscInt number)
{
  PetscInt64 groups = 0;

  for (PetscInt g = 0; g < file->n_groups; g++)
    if (file->dim[g] == dim && file->number[g] == PetscAbsInt(number)) groups |= (PetscInt64)1 << g;
  return groups;
}

static int CompareEntities(const void *a, const void *b)
{
  const PetscInt m = ((const Entity *)a)->number, n = ((const Entity *)b)->number;

  return (m > n) - (m < n);
}

/* an entity: number, box (a point's place), physical groups, and but for a point the entities of its boundary */
static PetscBool ReadEntity(Reader *r, PetscInt dim, Entity *entity)
{
  PetscReal box[6];
  PetscInt  n, v;

  entity->groups = 0;
  if (!ReadInts(r, 4, 1, &entity->number) || !ReadReals(r, dim ? 6 : 3, box)) return PETSC_FALSE;
  for (int list = 0; list < (dim ? 2 : 1); list++) {
    if (!ReadInts(r, 8, 1, &n) || !Plausible(r, n)) return PETSC_FALSE;
    for (PetscInt i = 0; i < n; i++) {
      if (!ReadInts(r, 4, 1, &v)) return PETSC_FALSE;
      if (list == 0) entity->groups |= GroupsOf(r->file, dim, v);
    }
  }
  return PETSC_TRUE;
}

/* $Entities (format 4.1): points, curves, surfaces and volumes */
static PetscErrorCode ReadEntities(Reader *r)
{
  PetscInt n[4];

  PetscFunctionBegin;
  if (!ReadInts(r, 8, 4, n)) PetscFunctionReturn(Broken(r, "its $Entities section cannot be read"));
  for (PetscInt dim = 0; dim < 4; dim++) {
    if (!Plausible(r, n[dim]) || r->entity[dim]) PetscFunctionReturn(Broken(r, "its $Entities section cannot be read"));
    PetscCall(PetscMalloc1(n[dim] + 1, &r->entity[dim]));
    for (PetscInt i = 0; i < n[dim]; i++)
      if (!ReadEntity(r, dim, &r->entity[dim][i])) PetscFunctionReturn(Broken(r, "its $Entities section cannot be read"));
    r->n_entities[dim] = n[dim];
    qsort(r->entity[dim], (size_t)n[dim], sizeof(Entity), CompareEntities);
  }
  if (!SectionEnds(r, "$EndEntities")) PetscFunctionReturn(Broken(r, "its $Entities section cannot be read"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the entity of that dimension and number, or NULL */
static const Entity *FindEntity(const Reader *r, PetscInt dim, PetscInt number)
{
  const Entity wanted = {number, 0};

  if (dim < 0 || dim > 3 || !r->n_entities[dim]) return NULL;
  return bsearch(&wanted, r->entity[dim], (size_t)r->n_entities[dim], sizeof wanted, CompareEntities);
}

/* a block of nodes: in format 2.2 number and place of each; in 4.1 a head, all numbers, then all places, which a parametric node
   follows with its coordinates on the entity */
static PetscBool ReadNodeBlock(Reader *r, PetscInt n_left, PetscInt tags[], PetscReal X[], PetscInt *n)
{
  PetscInt  head[4]; /* dimension, entity, parametric, count */
  PetscReal parametric[3];

  *n = n_left;
  if (r->version == 41) {
    if (!ReadInts(r, 4, 3, head) || !ReadInts(r, 8, 1, &head[3]) || !FindEntity(r, head[0], head[1]) || head[2] < 0 || head[2] > 1 ||
        head[3] < 0 || head[3] > n_left)
      return PETSC_FALSE;
    *n = head[3];
    if (!ReadInts(r, 8, *n, tags)) return PETSC_FALSE;
  }
  for (PetscInt i = 0; i < *n; i++) {
    if ((r->version == 22 && !ReadInts(r, 4, 1, &tags[i])) || !ReadReals(r, 3, &X[3 * i])) return PETSC_FALSE;
    if (r->version == 41 && head[2] && !ReadReals(r, head[0], parametric)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* $Nodes: places and numbers, each number once */
static PetscErrorCode ReadNodes(Reader *r)
{
  PetscInt head[4] = {1, 0, 0, 0}, done = 0; /* blocks, nodes, smallest and largest number */

  PetscFunctionBegin;
  if (r->tags || !(r->version == 22 ? ReadCount(r, &head[1]) : ReadInts(r, 8, 4, head)) || !Plausible(r, head[0]) ||
      !Plausible(r, head[1]))
    PetscFunctionReturn(Broken(r, "its $Nodes section cannot be read"));
  PetscCall(PetscMalloc2(head[1] + 1, &r->tags, head[1] + 1, &r->places));
  PetscCall(PetscMalloc1(3 * (size_t)head[1] + 1, &r->file->X));
  for (PetscInt b = 0; b < head[0]; b++) {
    PetscInt n;
    if (!ReadNodeBlock(r, head[1] - done, r->tags + done, r->file->X + 3 * (size_t)done, &n))
      PetscFunctionReturn(Broken(r, "its $Nodes section cannot be read"));
    done += n;
  }
  if (done < head[1] || !done || !SectionEnds(r, "$EndNodes")) PetscFunctionReturn(Broken(r, "its $Nodes section cannot be read"));
  r->file->n_nodes = done;
  for (PetscInt i = 0; i < done; i++) r->places[i] = i;
  PetscCall(PetscSortIntWithArray(done, r->tags, r->places));
  for (PetscInt i = 1; i < done; i++)
    if (r->tags[i] == r->tags[i - 1]) PetscFunctionReturn(Broken(r, "two nodes have the same number"));
  if (r->tags[0] < 1) PetscFunctionReturn(Broken(r, "its nodes' numbers are not from 1 on"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* where the node of a number stands in the file, -1 when it is not there; most files number without gaps */
static PetscInt FindNode(const Reader *r, PetscInt tag)
{
  const PetscInt guess = tag - r->tags[0];
  PetscInt       low = 0, high = r->file->n_nodes;

  if (guess >= 0 && guess < high && r->tags[guess] == tag) return r->places[guess];
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (r->tags[middle] < tag) low = middle + 1;
    else high = middle;
  }
  return low < r->file->n_nodes && r->tags[low] == tag ? r->places[low] : -1;
}

/* the nodes of an element: they exist, and are different */
static PetscErrorCode ReadCorners(Reader *r, PetscInt n, PetscInt tag, PetscInt corner[])
{
  char what[128];

  PetscFunctionBegin;
  if (!ReadInts(r, r->version == 22 ? 4 : 8, n, corner)) PetscFunctionReturn(Broken(r, "it ends within its $Elements section"));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt number = corner[i];
    const char    *fault  = NULL;
    corner[i]             = FindNode(r, number);
    if (corner[i] < 0) fault = "which is not in the file";
    for (PetscInt k = 0; k < i; k++)
      if (corner[k] == corner[i]) fault = "twice";
    if (!fault) continue;
    PetscCall(PetscSNPrintf(what, sizeof what, "element %" PetscInt_FMT " has node %" PetscInt_FMT ", %s", tag, number, fault));
    PetscFunctionReturn(Broken(r, what));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One element of `type` in the groups given: in format 2.2 number, tags (the first names the physical group), nodes; in a text each
   has its type and count of tags before these. In 4.1 number and nodes. */
static PetscErrorCode ReadElement(Reader *r, PetscInt type, PetscInt n_tags, PetscInt64 groups)
{
  TLEDGmshFile  *file = r->file;
  const PetscInt e    = file->n_elements;
  PetscInt       head[3], n_nodes, dim, tag;

  PetscFunctionBegin;
  if (!ReadInts(r, r->version == 22 ? 4 : 8, 1, head)) PetscFunctionReturn(Broken(r, "it ends within its $Elements section"));
  if (r->version == 22 && !r->binary) {
    if (!ReadInts(r, 4, 2, &head[1])) PetscFunctionReturn(Broken(r, "it ends within its $Elements section"));
    type = head[1], n_tags = head[2];
  }
  const char *other = ElementKind(type, &n_nodes, &dim);
  if (!n_nodes)
    PetscFunctionReturn(InputError(r->key, "holds an element of another kind: %s\n  expected a mesh of tetrahedra of first or second order (gmsh -3, -order 2)",
                                   other));
  if (n_tags < 0 || n_tags > 64) PetscFunctionReturn(Broken(r, "its $Elements section cannot be read"));
  for (PetscInt i = 0; i < n_tags; i++) {
    if (!ReadInts(r, 4, 1, &tag)) PetscFunctionReturn(Broken(r, "it ends within its $Elements section"));
    if (i == 0) groups = GroupsOf(file, dim, tag);
  }
  ByCall(ReadCorners(r, n_nodes, head[0], &file->corner[file->first[e]]));
  file->type[e]      = (signed char)type;
  file->tag[e]       = head[0];
  file->groups[e]    = groups;
  file->first[e + 1] = file->first[e] + n_nodes;
  file->n_elements++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a block of elements: in format 4.1 of one entity and type, in binary 2.2 of one type and count of tags, in text 2.2 all */
static PetscErrorCode ReadElementBlock(Reader *r, PetscInt n_left)
{
  PetscInt      block[4] = {0, 0, 0, n_left}; /* dimension, entity, type, count; in 2.2 type, count, tags */
  PetscInt      type = 0, n_tags = 0, n_nodes, dim;
  const Entity *entity = NULL;

  PetscFunctionBegin;
  if (r->version == 41) {
    if (!ReadInts(r, 4, 3, block) || !ReadInts(r, 8, 1, &block[3])) block[3] = -1;
    type   = block[2];
    entity = FindEntity(r, block[0], block[1]);
    (void)ElementKind(type, &n_nodes, &dim);
    if (!entity || (n_nodes && dim != block[0])) block[3] = -1;
  } else if (r->binary) {
    if (!ReadInts(r, 4, 3, block)) block[1] = -1;
    type = block[0], n_tags = block[2], block[3] = block[1] > 0 ? block[1] : -1;
  }
  if (block[3] < 0 || block[3] > n_left) PetscFunctionReturn(Broken(r, "its $Elements section cannot be read"));
  for (PetscInt i = 0; i < block[3]; i++) ByCall(ReadElement(r, type, n_tags, entity ? entity->groups : 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* $Elements */
static PetscErrorCode ReadElements(Reader *r)
{
  TLEDGmshFile *file    = r->file;
  PetscInt      head[4] = {1, 0, 0, 0}; /* blocks, elements, smallest and largest number */
  size_t        n;

  PetscFunctionBegin;
  if (file->tag || !r->tags || !(r->version == 22 ? ReadCount(r, &head[1]) : ReadInts(r, 8, 4, head)) || !Plausible(r, head[0]) ||
      !Plausible(r, head[1]))
    PetscFunctionReturn(Broken(r, "its $Elements section cannot be read"));
  n = (size_t)head[1] + 1;
  if (n > PETSC_MAX_INT / TLED_CORNERS_MAX) PetscFunctionReturn(InputError(r->key, "has more elements than can be numbered"));
  PetscCall(PetscMalloc5(n, &file->type, n, &file->tag, n, &file->first, n, &file->groups, TLED_CORNERS_MAX * n, &file->corner));
  file->first[0] = 0;
  if (r->version == 22) head[0] = r->binary ? head[1] : 1; /* binary: until all are read */
  for (PetscInt b = 0; b < head[0] && (r->version == 41 || file->n_elements < head[1]); b++)
    ByCall(ReadElementBlock(r, head[1] - file->n_elements));
  if (file->n_elements < head[1] || !SectionEnds(r, "$EndElements")) PetscFunctionReturn(Broken(r, "it ends before $EndElements"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the first lines: $MeshFormat, version, text or binary, and in a binary file the number 1, which tells the order of bytes */
static PetscErrorCode ReadHeader(Reader *r)
{
  double        version = 0.0;
  int           kind = 0, bytes = 0;
  unsigned char one[4];

  PetscFunctionBegin;
  if (strncmp(r->text, "$MeshFormat", 11))
    PetscFunctionReturn(InputError(r->key, "is not a gmsh mesh: it does not begin with $MeshFormat\n"
                                           "  expected a .msh file of gmsh, format 4.1 or 2.2"));
  SkipLine(r);
  if (sscanf(r->text + r->at, "%lf %d %d", &version, &kind, &bytes) != 3)
    PetscFunctionReturn(Broken(r, "its format line cannot be read"));
  if (!(version > 0.0 && version < 100.0)) PetscFunctionReturn(Broken(r, "its format line cannot be read"));
  r->version = (int)(10.0 * version + 0.5);
  r->binary  = kind ? PETSC_TRUE : PETSC_FALSE;
  if ((r->version != 22 && r->version != 41) || fabs(0.1 * r->version - version) > 1e-9)
    PetscFunctionReturn(
        InputError(r->key, "is in gmsh format %g, which is not read\n  expected format 4.1 or 2.2 (gmsh -format msh41)", version));
  if (kind < 0 || kind > 1 || bytes != 8) PetscFunctionReturn(Broken(r, "its format line cannot be read"));
  SkipLine(r);
  if (!r->binary) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ReadBytes(r, 4, one)) PetscFunctionReturn(Broken(r, "its format line cannot be read"));
  const int native = 1, low_first = *(const char *)&native;
  if (one[0] + one[1] + one[2] + one[3] != 1 || one[1] || one[2]) PetscFunctionReturn(Broken(r, "its order of bytes is not known"));
  r->swap = (PetscBool)(one[0] != low_first);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadSections(Reader *r)
{
  char section[64];

  PetscFunctionBegin;
  ByCall(ReadHeader(r));
  while (NextSection(r, section)) {
    if (!strcmp(section, "$PhysicalNames")) ByCall(ReadNames(r));
    if (!strcmp(section, "$Entities") && r->version == 41) ByCall(ReadEntities(r));
    if (!strcmp(section, "$Nodes")) ByCall(ReadNodes(r));
    if (!strcmp(section, "$Elements")) ByCall(ReadElements(r));
    if (!strcmp(section, "$PartitionedEntities"))
      PetscFunctionReturn(InputError(r->key, "is a mesh cut into partitions\n  write it again without them (gmsh -part 0)"));
  }
  if (!r->tags) PetscFunctionReturn(Broken(r, "it has no $Nodes section"));
  if (!r->file->tag) PetscFunctionReturn(Broken(r, "it has no $Elements section"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the whole file into memory */
static PetscErrorCode ReadText(Reader *r)
{
  FILE *stream = fopen(r->path, "rb");
  long  size   = 0;

  PetscFunctionBegin;
  if (!stream) PetscFunctionReturn(InputError(r->key, "cannot be opened: %s (%s)", r->path, strerror(errno)));
  if (fseek(stream, 0, SEEK_END) || (size = ftell(stream)) < 0 || size == LONG_MAX || fseek(stream, 0, SEEK_SET)) {
    fclose(stream);
    PetscFunctionReturn(InputError(r->key, "cannot be read: %s is not an ordinary file", r->path));
  }
  PetscCall(PetscMalloc1((size_t)size + 1, &r->text));
  r->size          = fread(r->text, 1, (size_t)size, stream);
  r->text[r->size] = 0;
  fclose(stream);
  if (r->size != (size_t)size) PetscFunctionReturn(InputError(r->key, "cannot be read to its end: %s", r->path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDGmshRead_Private - read a gmsh file: nodes, elements of first and second order, and the named physical groups they belong to

  Input Parameters:
+ key  - the scene key that names the file, "flap.mesh", for messages
- path - the file

  Output Parameter:
. file - what it holds; TLEDGmshDestroy_Private() frees it, also after an error

  Errors: BY_ERR_INPUT, reported: cannot be opened, not gmsh, unknown format, broken, elements of other kinds

  Reference: the MSH file format, gmsh's manual, versions 4.1 and 2.2.  Tests: tests/unit/tled/test_mesh.c, tests/fuzz/test_tled_mesh.c
*/
PetscErrorCode TLEDGmshRead_Private(const char key[], const char path[], TLEDGmshFile *file)
{
  Reader         reader = {.key = key, .path = path, .file = file};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(file, sizeof *file));
  ierr = ReadText(&reader);
  if (!ierr) ierr = ReadSections(&reader);
  PetscCall(PetscFree(reader.text));
  PetscCall(PetscFree2(reader.tags, reader.places));
  for (int dim = 0; dim < 4; dim++) PetscCall(PetscFree(reader.entity[dim]));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDGmshDestroy_Private(TLEDGmshFile *file)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(file->X));
  PetscCall(PetscFree5(file->type, file->tag, file->first, file->groups, file->corner));
  PetscFunctionReturn(PETSC_SUCCESS);
}
