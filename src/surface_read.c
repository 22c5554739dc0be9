/* surface_read.c - triangle surfaces from files: STL and gmsh through gmsh, OFF, OBJ and PLY here; closed and outward. */
#include <ctype.h>
#include <errno.h>
#include <gmshc.h>
#include <string.h>
#include <sys/stat.h>
#include "surface.h"
#include "mat3.h"

/* a surface while it is read, and the text it is read from */
typedef struct {
  const char *key, *path;
  char       *text;                        /* whole file, ends with 0   */
  size_t      size, at;                    /* bytes, reading position   */
  double     *x;                           /* n_nodes x 3               */
  PetscInt   *triangles;                   /* n_triangles x 3           */
  size_t      n_nodes, n_triangles, node_capacity, triangle_capacity;
} Reading;

#define MAX_ITEMS 200000000u /* nodes or triangles: 32-bit indices of three times as many */

static PetscErrorCode Bad(const Reading *r, const char what[])
{
  return InputError(r->key, "is not a surface that can be read: %s\n  expected a closed triangle surface: STL, OFF, OBJ, PLY or gmsh .msh", what);
}

static PetscErrorCode AddNode(Reading *r, const double p[3])
{
  PetscFunctionBegin;
  if (r->n_nodes == r->node_capacity) {
    if (r->n_nodes >= MAX_ITEMS) PetscFunctionReturn(Bad(r, "too many points"));
    r->node_capacity = PetscMax(1024, 2*r->node_capacity);
    PetscCall(PetscRealloc(3*sizeof(double)*r->node_capacity, &r->x));
  }
  for (int k = 0; k < 3; k++) {
    if (!isfinite(p[k])) PetscFunctionReturn(Bad(r, "a coordinate is not a finite number"));
    r->x[3*r->n_nodes + k] = p[k];
  }
  r->n_nodes++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a polygon as a fan of triangles; indices are checked when all nodes are there */
static PetscErrorCode AddPolygon(Reading *r, long first, long before, long next)
{
  PetscFunctionBegin;
  if (r->n_triangles == r->triangle_capacity) {
    if (r->n_triangles >= MAX_ITEMS) PetscFunctionReturn(Bad(r, "too many triangles"));
    r->triangle_capacity = PetscMax(1024, 2*r->triangle_capacity);
    PetscCall(PetscRealloc(3*sizeof(PetscInt)*r->triangle_capacity, &r->triangles));
  }
  const long v[3] = {first, before, next};
  for (int k = 0; k < 3; k++) {
    if (v[k] < 0 || v[k] >= (long)MAX_ITEMS) PetscFunctionReturn(Bad(r, "a triangle names a point that is not there"));
    r->triangles[3*r->n_triangles + (size_t)k] = (PetscInt)v[k];
  }
  r->n_triangles++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadText(Reading *r)
{
  struct stat status;
  FILE       *f;
  long        size;

  PetscFunctionBegin;
  if (!stat(r->path, &status) && !S_ISREG(status.st_mode)) PetscFunctionReturn(InputError(r->key, "cannot be read: %s is not an ordinary file", r->path));
  f = fopen(r->path, "rb");
  if (!f || fseek(f, 0, SEEK_END) || (size = ftell(f)) < 0 || fseek(f, 0, SEEK_SET)) {
    const int error = errno;
    if (f) fclose(f);
    PetscFunctionReturn(InputError(r->key, "cannot be read: %s (%s)", r->path, strerror(error)));
  }
  PetscCall(PetscMalloc1((size_t)size + 1, &r->text));
  r->size = fread(r->text, 1, (size_t)size, f);
  fclose(f);
  r->text[r->size] = 0;
  if (r->size != (size_t)size) PetscFunctionReturn(InputError(r->key, "cannot be read to its end: %s", r->path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* next word of the text; '#' starts a comment; empty at the end, or at the end of the line when `line` */
static void Word(Reading *r, int line, char word[64])
{
  size_t n = 0;

  word[0] = 0;
  for (; r->at < r->size; r->at++) {
    const char c = r->text[r->at];
    if (c == '#') {
      while (r->at < r->size && r->text[r->at] != '\n') r->at++;
      if (line || r->at >= r->size) return;
    } else if (c == '\n' && line) return;
    else if (!isspace((unsigned char)c)) break;
  }
  while (r->at < r->size && !isspace((unsigned char)r->text[r->at]) && r->text[r->at] != '#') {
    if (n < 63) word[n++] = r->text[r->at];
    r->at++;
  }
  word[n] = 0;
}
static void NextLine(Reading *r)
{
  while (r->at < r->size && r->text[r->at] != '\n') r->at++;
  if (r->at < r->size) r->at++;
}
static int WordReal(Reading *r, int line, double *value)
{
  char word[64], *end;
  Word(r, line, word);
  *value = strtod(word, &end);
  return end != word && !*end;
}
static int WordInt(Reading *r, int line, long *value)
{
  char word[64], *end;
  Word(r, line, word);
  errno  = 0;
  *value = strtol(word, &end, 10);
  return end != word && !*end && !errno;
}

/* OFF: "OFF", counts of points, faces, edges; points; faces as count and indices, colours may follow on the line */
static PetscErrorCode ReadOFF(Reading *r)
{
  char   word[64];
  long   n_nodes, n_faces, n_edges, n, v[3];
  double p[3];

  PetscFunctionBegin;
  Word(r, 0, word);
  if (strcmp(word, "OFF")) PetscFunctionReturn(Bad(r, "an OFF file starts with the word OFF"));
  if (!WordInt(r, 0, &n_nodes) || !WordInt(r, 0, &n_faces) || !WordInt(r, 0, &n_edges) || n_nodes < 0 || n_faces < 0) PetscFunctionReturn(Bad(r, "its counts of points and faces cannot be read"));
  for (long i = 0; i < n_nodes; i++) {
    if (!WordReal(r, 0, &p[0]) || !WordReal(r, 0, &p[1]) || !WordReal(r, 0, &p[2])) PetscFunctionReturn(Bad(r, "it ends before all points, or a coordinate is not a number"));
    ByCall(AddNode(r, p));
  }
  for (long i = 0; i < n_faces; i++) {
    if (!WordInt(r, 0, &n) || n < 3 || !WordInt(r, 1, &v[0]) || !WordInt(r, 1, &v[1])) PetscFunctionReturn(Bad(r, "it ends before all faces, or a face has less than three points"));
    for (long k = 2; k < n; k++, v[1] = v[2]) {
      if (!WordInt(r, 1, &v[2])) PetscFunctionReturn(Bad(r, "a face has fewer points than it says"));
      ByCall(AddPolygon(r, v[0], v[1], v[2]));
    }
    NextLine(r);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* OBJ: lines `v x y z` and `f a b c ...`, indices from 1, negative from the end, `a/b/c` names a first */
static PetscErrorCode ReadOBJ(Reading *r)
{
  char   word[64];
  double p[3];

  PetscFunctionBegin;
  for (; r->at < r->size; NextLine(r)) {
    Word(r, 1, word);
    if (!strcmp(word, "v")) {
      if (!WordReal(r, 1, &p[0]) || !WordReal(r, 1, &p[1]) || !WordReal(r, 1, &p[2])) PetscFunctionReturn(Bad(r, "a line v does not have three numbers"));
      ByCall(AddNode(r, p));
    } else if (!strcmp(word, "f")) {
      long v[3] = {0, 0, 0};
      int  n    = 0;
      for (Word(r, 1, word); word[0]; Word(r, 1, word), n++) {
        char *end;
        long  i = strtol(word, &end, 10);
        if (end == word || (*end && *end != '/')) PetscFunctionReturn(Bad(r, "a line f has something that is not a point number"));
        i = i < 0 ? (long)r->n_nodes + i : i - 1;
        if (n < 2) {
          v[n] = i;
        } else {
          v[2] = i;
          ByCall(AddPolygon(r, v[0], v[1], v[2]));
          v[1] = v[2];
        }
      }
      if (n < 3) PetscFunctionReturn(Bad(r, "a line f has less than three points"));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PLY scalars */
typedef enum { PLY_NONE, PLY_I1, PLY_U1, PLY_I2, PLY_U2, PLY_I4, PLY_U4, PLY_F4, PLY_F8 } PLYType;

static PLYType PLYTypeOf(const char word[])
{
  static const char *const names[] = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  static const char *const sized[] = {"int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};
  for (int i = 0; i < 8; i++) {
    if (!strcmp(word, names[i]) || !strcmp(word, sized[i])) return (PLYType)(i + 1);
  }
  return PLY_NONE;
}

/* one scalar; binary < 0: text, 0: little-endian, 1: big-endian; 0 when the file ends or it is no number */
static int PLYValue(Reading *r, PLYType type, int binary, double *value)
{
  static const size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  const uint16_t      probe = 1;
  unsigned char       b[8];
  const size_t        n = sizes[type];
  union {
    int8_t i1; uint8_t u1; int16_t i2; uint16_t u2; int32_t i4; uint32_t u4; float f4; double f8;
    unsigned char b[8];
  } u;

  if (binary < 0) return WordReal(r, 0, value);
  if (r->size - r->at < n) return 0;
  memcpy(b, r->text + r->at, n);
  r->at += n;
  const int swap = *(const unsigned char *)&probe != (unsigned char)!binary;
  for (size_t i = 0; i < n; i++) u.b[i] = swap ? b[n - 1 - i] : b[i];
  switch (type) {
  case PLY_I1: *value = u.i1; break;
  case PLY_U1: *value = u.u1; break;
  case PLY_I2: *value = u.i2; break;
  case PLY_U2: *value = u.u2; break;
  case PLY_I4: *value = u.i4; break;
  case PLY_U4: *value = u.u4; break;
  case PLY_F4: *value = u.f4; break;
  default: *value = u.f8; break;
  }
  return 1;
}

#define PLY_PROPERTIES 32
#define PLY_ELEMENTS   8
typedef struct {
  char    name[16];
  long    count;
  int     n_properties;
  PLYType type[PLY_PROPERTIES], count_type[PLY_PROPERTIES]; /* count_type NONE: a scalar */
  int     role[PLY_PROPERTIES];                             /* 0..2: x y z; 3: vertex indices; -1 other */
} PLYElement;

/* header: format, elements and their properties in order */
static PetscErrorCode ReadPLYHeader(Reading *r, int *binary, int *n_elements, PLYElement element[PLY_ELEMENTS])
{
  char word[64];

  PetscFunctionBegin;
  Word(r, 0, word);
  if (strcmp(word, "ply")) PetscFunctionReturn(Bad(r, "a PLY file starts with the word ply"));
  *binary     = -2;
  *n_elements = 0;
  for (;;) {
    NextLine(r);
    if (r->at >= r->size) PetscFunctionReturn(Bad(r, "its header has no end"));
    Word(r, 1, word);
    if (!strcmp(word, "end_header")) break;
    if (!strcmp(word, "format")) {
      Word(r, 1, word);
      *binary = !strcmp(word, "ascii") ? -1 : !strcmp(word, "binary_little_endian") ? 0 : !strcmp(word, "binary_big_endian") ? 1 : -2;
    } else if (!strcmp(word, "element")) {
      PLYElement *e = &element[*n_elements];
      if (*n_elements == PLY_ELEMENTS) PetscFunctionReturn(Bad(r, "it has too many kinds of elements"));
      Word(r, 1, word);
      PetscCall(PetscStrncpy(e->name, word, sizeof(e->name)));
      e->n_properties = 0;
      if (!WordInt(r, 1, &e->count) || e->count < 0) PetscFunctionReturn(Bad(r, "an element's count cannot be read"));
      (*n_elements)++;
    } else if (!strcmp(word, "property")) {
      PLYElement *e = &element[*n_elements - 1];
      if (!*n_elements || e->n_properties == PLY_PROPERTIES) PetscFunctionReturn(Bad(r, "it has too many properties, or one before any element"));
      const int i = e->n_properties++;
      Word(r, 1, word);
      e->count_type[i] = PLY_NONE;
      if (!strcmp(word, "list")) {
        Word(r, 1, word);
        e->count_type[i] = PLYTypeOf(word);
        if (e->count_type[i] == PLY_NONE) PetscFunctionReturn(Bad(r, "a property has an unknown type"));
        Word(r, 1, word);
      }
      e->type[i] = PLYTypeOf(word);
      if (e->type[i] == PLY_NONE) PetscFunctionReturn(Bad(r, "a property has an unknown type"));
      Word(r, 1, word);
      e->role[i] = !strcmp(word, "x") ? 0 : !strcmp(word, "y") ? 1 : !strcmp(word, "z") ? 2 : -1;
      if (!strcmp(word, "vertex_indices") || !strcmp(word, "vertex_index")) e->role[i] = 3;
    }
  }
  NextLine(r);
  if (*binary == -2) PetscFunctionReturn(Bad(r, "its format is none of ascii, binary_little_endian, binary_big_endian"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadPLY(Reading *r)
{
  PLYElement element[PLY_ELEMENTS];
  int        binary = -1, n_elements = 0;

  PetscFunctionBegin;
  ByCall(ReadPLYHeader(r, &binary, &n_elements, element));
  for (int k = 0; k < n_elements; k++) {
    const PLYElement *e = &element[k];
    const PetscBool   vertex = (PetscBool)!strcmp(e->name, "vertex");
    for (long i = 0; i < e->count && e->n_properties; i++) {
      double p[3] = {0, 0, 0}, value;
      for (int j = 0; j < e->n_properties; j++) {
        double count = 1;
        long   v[3]  = {0, 0, 0};
        if (e->count_type[j] && !PLYValue(r, e->count_type[j], binary, &count)) PetscFunctionReturn(Bad(r, "it ends before all its elements"));
        if (e->role[j] == 3 && count < 3) PetscFunctionReturn(Bad(r, "a face has less than three points"));
        for (long m = 0; m < (long)count; m++) {
          if (!PLYValue(r, e->type[j], binary, &value)) PetscFunctionReturn(Bad(r, "it ends before all its elements"));
          if (vertex && !e->count_type[j] && e->role[j] >= 0 && e->role[j] < 3) p[e->role[j]] = value;
          if (e->role[j] != 3 || vertex) continue;
          v[m < 2 ? m : 2] = value >= 0 && value < MAX_ITEMS ? (long)value : -1;
          if (m >= 2) {
            ByCall(AddPolygon(r, v[0], v[1], v[2]));
            v[1] = v[2];
          }
        }
      }
      if (vertex) ByCall(AddNode(r, p));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* STL and .msh: gmsh reads the file, we take its nodes and 3-node triangles */
static PetscErrorCode ReadGmsh(Reading *r)
{
  size_t *tags = NULL, *elements = NULL, *of = NULL, n_tags = 0, n_x = 0, n_p = 0, n_elements = 0, n_of = 0, top = 0;
  double *x = NULL, *parametric = NULL;
  long   *number = NULL;
  int     error = 0, failed = 0, ignored;
  PetscErrorCode ierr = PETSC_SUCCESS;

  PetscFunctionBegin;
  gmshInitialize(0, NULL, 0, &error);
  PetscCheck(!error, PETSC_COMM_SELF, PETSC_ERR_LIB, "gmsh cannot be started");
  gmshOptionSetNumber("General.Terminal", 0, &ignored);
  gmshMerge(r->path, &error);
  failed = error;
  if (!failed) gmshModelMeshGetNodes(&tags, &n_tags, &x, &n_x, &parametric, &n_p, -1, -1, 0, 0, &error), failed |= error;
  if (!failed) gmshModelMeshGetElementsByType(2, &elements, &n_elements, &of, &n_of, -1, 0, 1, &error), failed |= error;
  gmshFinalize(&ignored);
  for (size_t i = 0; !failed && i < n_tags; i++) top = PetscMax(top, tags[i]);
  if (!failed && n_elements) {
    PetscCall(PetscMalloc1(top + 1, &number));
    for (size_t i = 0; i <= top; i++) number[i] = -1;
    for (size_t i = 0; i < n_tags && !ierr; i++) {
      number[tags[i]] = (long)r->n_nodes;
      ierr = AddNode(r, &x[3*i]);
    }
    for (size_t i = 0; i < n_elements && !ierr; i++) {
      long v[3];
      for (int k = 0; k < 3; k++) v[k] = of[3*i + (size_t)k] <= top ? number[of[3*i + (size_t)k]] : -1;
      ierr = AddPolygon(r, v[0], v[1], v[2]);
    }
    PetscCall(PetscFree(number));
  }
  gmshFree(tags);
  gmshFree(x);
  gmshFree(parametric);
  gmshFree(elements);
  gmshFree(of);
  if (failed) PetscFunctionReturn(Bad(r, "gmsh cannot read it"));
  PetscFunctionReturn(ierr);
}

static int CompareNodes(const void *a, const void *b)
{
  const double *const *p = (const double *const *)a, *const *q = (const double *const *)b;
  for (int k = 0; k < 3; k++) {
    if ((*p)[k] < (*q)[k]) return -1;
    if ((*p)[k] > (*q)[k]) return 1;
  }
  return *p < *q ? -1 : *p > *q;
}

/* Nodes at the same place become one (STL and some PLY repeat them per triangle), triangles that lost a corner go, nodes that no
   triangle uses go; then scale and translate. */
static PetscErrorCode Weld(Reading *r, PetscReal scale, const PetscReal translate[3], Surface *s)
{
  const double **sorted;
  PetscInt      *same, *number, n = 0;

  PetscFunctionBegin;
  if (!r->n_triangles) PetscFunctionReturn(Bad(r, "it has no triangles"));
  for (size_t i = 0; i < 3*r->n_triangles; i++) {
    if ((size_t)r->triangles[i] >= r->n_nodes) PetscFunctionReturn(Bad(r, "a triangle names a point that is not there"));
  }
  PetscCall(PetscMalloc3(r->n_nodes, &sorted, r->n_nodes, &same, r->n_nodes, &number));
  for (size_t i = 0; i < r->n_nodes; i++) {
    for (int k = 0; k < 3; k++) r->x[3*i + (size_t)k] += 0.0; // -0 and 0 are the same place
    sorted[i] = &r->x[3*i];
    number[i] = -1;
  }
  qsort(sorted, r->n_nodes, sizeof(*sorted), CompareNodes);
  for (size_t i = 0; i < r->n_nodes; i++) {
    const size_t me = (size_t)(sorted[i] - r->x)/3, before = i ? (size_t)(sorted[i - 1] - r->x)/3 : 0;
    same[me] = i && !memcmp(sorted[i], sorted[i - 1], 3*sizeof(double)) ? same[before] : (PetscInt)me;
  }
  PetscCall(PetscMalloc1(3*r->n_triangles, &s->triangles));
  PetscCall(PetscMalloc1(3*r->n_nodes, &s->x));
  s->n_triangles = 0;
  for (size_t t = 0; t < r->n_triangles; t++) {
    PetscInt v[3];
    for (int k = 0; k < 3; k++) v[k] = same[r->triangles[3*t + (size_t)k]];
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (int k = 0; k < 3; k++) {
      if (number[v[k]] < 0) {
        for (int d = 0; d < 3; d++) s->x[3*n + d] = r->x[3*v[k] + d]*scale + (translate ? translate[d] : 0.0);
        number[v[k]] = n++;
      }
      s->triangles[3*s->n_triangles + k] = number[v[k]];
    }
    s->n_triangles++;
  }
  s->n_nodes = n;
  PetscCall(PetscFree3(sorted, same, number));
  if (!s->n_triangles) PetscFunctionReturn(Bad(r, "it has no triangles"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscInt low, high, triangle, side;
} HalfEdge;

static int CompareEdges(const void *a, const void *b)
{
  const HalfEdge *p = (const HalfEdge *)a, *q = (const HalfEdge *)b;
  if (p->low != q->low) return p->low < q->low ? -1 : 1;
  if (p->high != q->high) return p->high < q->high ? -1 : 1;
  return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

/* neighbour across each side; every edge must have two triangles */
static PetscErrorCode Neighbours(const Reading *r, const Surface *s, PetscInt neighbour[])
{
  const PetscInt n = 3*s->n_triangles;
  HalfEdge      *edge;
  PetscErrorCode ierr = PETSC_SUCCESS;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &edge));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt a = s->triangles[i], b = s->triangles[3*(i/3) + (i + 1)%3];
    edge[i].low = PetscMin(a, b), edge[i].high = PetscMax(a, b), edge[i].triangle = i/3, edge[i].side = i%3;
  }
  qsort(edge, (size_t)n, sizeof(*edge), CompareEdges);
  for (PetscInt i = 0, j; i < n && !ierr; i = j) {
    for (j = i + 1; j < n && edge[j].low == edge[i].low && edge[j].high == edge[i].high;) j++;
    if (j - i == 2) {
      neighbour[3*edge[i].triangle + edge[i].side]         = edge[i + 1].triangle;
      neighbour[3*edge[i + 1].triangle + edge[i + 1].side] = edge[i].triangle;
      continue;
    }
    const PetscReal *p = &s->x[3*edge[i].low], *q = &s->x[3*edge[i].high];
    if (j - i == 1) ierr = InputError(r->key, "is not closed: the edge from (%g, %g, %g) to (%g, %g, %g) has one triangle\n  close the surface's holes; lengths are after scale and translate", (double)p[0], (double)p[1], (double)p[2], (double)q[0], (double)q[1], (double)q[2]);
    else ierr = InputError(r->key, "has an edge shared by %d triangles: from (%g, %g, %g) to (%g, %g, %g)\n  every edge of a closed surface has two", (int)(j - i), (double)p[0], (double)p[1], (double)p[2], (double)q[0], (double)q[1], (double)q[2]);
  }
  PetscCall(PetscFree(edge));
  PetscFunctionReturn(ierr);
}

/* orient each connected part alike (flood over neighbours); part[t] numbers the parts */
static PetscErrorCode Flood(const Reading *r, Surface *s, const PetscInt neighbour[], PetscInt part[], PetscInt *n_parts)
{
  PetscInt *stack, n_stack = 0;

  PetscFunctionBegin;
  *n_parts = 0;
  PetscCall(PetscMalloc1(s->n_triangles, &stack));
  for (PetscInt t = 0; t < s->n_triangles; t++) part[t] = -1;
  for (PetscInt first = 0; first < s->n_triangles; first++) {
    if (part[first] >= 0) continue;
    part[first]      = *n_parts;
    stack[n_stack++] = first;
    while (n_stack) {
      const PetscInt t = stack[--n_stack], *v = &s->triangles[3*t];
      for (int i = 0; i < 3; i++) {
        // neighbours are stored by the sides of the original triangles: find the one that has both ends of this side
        for (int k = 0; k < 3; k++) {
          const PetscInt o = neighbour[3*t + k], *w = &s->triangles[3*o];
          PetscInt       j = 0;
          while (j < 3 && !(w[j] == v[i] && w[(j + 1)%3] == v[(i + 1)%3]) && !(w[j] == v[(i + 1)%3] && w[(j + 1)%3] == v[i])) j++;
          if (j == 3) continue;
          const PetscBool against = (PetscBool)(w[j] == v[i]);
          if (part[o] < 0) {
            if (against) {
              const PetscInt swap = s->triangles[3*o + 1];
              s->triangles[3*o + 1] = s->triangles[3*o + 2];
              s->triangles[3*o + 2] = swap;
            }
            part[o]          = *n_parts;
            stack[n_stack++] = o;
          } else if (against && o != t) {
            PetscCall(PetscFree(stack));
            PetscFunctionReturn(Bad(r, "its triangles cannot be oriented: it has only one side"));
          }
        }
      }
    }
    (*n_parts)++;
  }
  PetscCall(PetscFree(stack));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Outward: positive volume for a part that lies in an even number of others, negative (a cavity) in an odd number. */
static PetscErrorCode Outward(const Reading *r, Surface *s, const PetscInt part[], PetscInt n_parts)
{
  double   *volume, all = 0.0, size = 0.0;
  PetscInt *first, *inside, *own, n_own;

  PetscFunctionBegin;
  PetscCall(PetscCalloc4(n_parts, &volume, n_parts, &first, n_parts, &inside, 3*s->n_triangles, &own));
  for (PetscInt t = s->n_triangles - 1; t >= 0; t--) {
    double c[3], a[3], b[3], d[3]; // about the surface's first node: no cancellation for a small body far off
    Sub3(&s->x[3*s->triangles[3*t]], s->x, a), Sub3(&s->x[3*s->triangles[3*t + 1]], s->x, b), Sub3(&s->x[3*s->triangles[3*t + 2]], s->x, d);
    Cross3(b, d, c);
    volume[part[t]] += Dot3(a, c)/6.0;
    first[part[t]] = t;
    size = PetscMax(size, Norm3(a));
  }
  for (PetscInt p = 0; p < n_parts; p++) all = PetscMax(all, fabs(volume[p]));
  if (!(all > 1e-12*size*size*size)) {
    PetscCall(PetscFree4(volume, first, inside, own));
    PetscFunctionReturn(Bad(r, "it encloses no volume"));
  }
  for (PetscInt p = 0; p < n_parts && n_parts > 1; p++) {
    n_own = 0;
    for (PetscInt t = 0; t < s->n_triangles; t++) {
      for (int k = 0; k < 3 && part[t] == p; k++) own[3*n_own + k] = s->triangles[3*t + k];
      n_own += part[t] == p;
    }
    for (PetscInt q = 0; q < n_parts; q++) {
      PetscReal winding;
      if (q == p) continue;
      PetscCall(SurfaceWinding(1, &s->x[3*s->triangles[3*first[q]]], s->x, n_own, own, &winding));
      inside[q] += PetscAbsReal(winding) > 0.5;
    }
  }
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    if ((volume[part[t]] < 0.0) == (inside[part[t]]%2 == 1)) continue;
    const PetscInt swap = s->triangles[3*t + 1];
    s->triangles[3*t + 1] = s->triangles[3*t + 2];
    s->triangles[3*t + 2] = swap;
  }
  PetscCall(PetscFree4(volume, first, inside, own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFile(Reading *r)
{
  static const struct {
    const char *end;
    PetscErrorCode (*read)(Reading *);
  } formats[] = {{".stl", ReadGmsh}, {".msh", ReadGmsh}, {".off", ReadOFF}, {".obj", ReadOBJ}, {".ply", ReadPLY}};
  const size_t length = strlen(r->path);

  PetscFunctionBegin;
  ByCall(ReadText(r));
  for (int i = 0; i < 5; i++) {
    PetscBool match = (PetscBool)(length > 4);
    for (size_t k = 0; k < 4 && match; k++) match = (PetscBool)(tolower((unsigned char)r->path[length - 4 + k]) == formats[i].end[k]);
    if (match) PetscFunctionReturn(formats[i].read(r));
  }
  PetscFunctionReturn(Bad(r, "its name ends in none of .stl .off .obj .ply .msh"));
}

PetscErrorCode SurfaceRead(const char key[], const char path[], PetscReal scale, const PetscReal translate[3], Surface *s)
{
  Reading        r = {key, path, NULL, 0, 0, NULL, NULL, 0, 0, 0, 0};
  PetscInt      *neighbour, *part, n_parts;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  ierr = ReadFile(&r);
  if (!ierr) ierr = Weld(&r, scale, translate, s);
  PetscCall(PetscFree(r.text));
  PetscCall(PetscFree(r.x));
  PetscCall(PetscFree(r.triangles));
  if (!ierr) {
    PetscCall(PetscMalloc2(3*s->n_triangles, &neighbour, s->n_triangles, &part));
    ierr = Neighbours(&r, s, neighbour);
    if (!ierr) ierr = Flood(&r, s, neighbour, part, &n_parts);
    if (!ierr) ierr = Outward(&r, s, part, n_parts);
    PetscCall(PetscFree2(neighbour, part));
  }
  if (ierr) PetscCall(SurfaceDestroy(s));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
