/* cube.h - a unit cube of six tetrahedra as a gmsh file, sound or with a fault. */
#ifndef BY_TEST_CUBE_H
#define BY_TEST_CUBE_H

#include "unit/tled/body.h"
#include <unistd.h>

/* a cube cut into six tetrahedra; `swap` 1 exchanges two corners of element 12, 2 of all; `flat` pulls node 6 to the floor */
static inline void WriteCube(const char path[], int version, int swap, int flat, const char extra[])
{
  static const int tets[6][4]   = {{1, 2, 3, 7}, {1, 3, 4, 7}, {1, 4, 8, 7}, {1, 8, 5, 7}, {1, 5, 6, 7}, {1, 6, 2, 7}};
  static const int bottom[2][3] = {{1, 3, 2}, {1, 4, 3}};
  FILE            *f            = fopen(path, "w");

  assert_non_null(f);
  fprintf(f, "$MeshFormat\n%s 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 7 \"floor\"\n3 9 \"solid\"\n$EndPhysicalNames\n",
          version == 22 ? "2.2" : "4.1");
  if (version == 41) fprintf(f, "$Entities\n0 0 1 1\n1 0 0 0 1 1 0 1 7 0\n1 0 0 0 1 1 1 1 9 1 1\n$EndEntities\n");
  fprintf(f, version == 22 ? "$Nodes\n8\n" : "$Nodes\n1 8 1 8\n3 1 0 8\n");
  for (int a = 1; a <= 8 && version == 41; a++) fprintf(f, "%d\n", a);
  for (int a = 0; a < 8; a++) {
    const int b = a % 4;
    if (version == 22) fprintf(f, "%d ", a + 1);
    fprintf(f, "%d %d %g\n", b == 1 || b == 2, b > 1, flat && a == 5 ? 0.0 : a > 3 ? 1.0 : 0.0);
  }
  fprintf(f, "$EndNodes\n$Elements\n%s", version == 22 ? "8\n" : "2 8 1 16\n2 1 2 2\n");
  for (int t = 0; t < 2; t++)
    fprintf(f, version == 22 ? "%d 2 2 7 1 %d %d %d\n" : "%d %d %d %d\n", t + 1, bottom[t][0], bottom[t][1], bottom[t][2]);
  if (version == 41) fprintf(f, "3 1 4 6\n");
  for (int t = 0; t < 6; t++) {
    const int s = swap && (t == 2 || swap == 2);
    fprintf(f, version == 22 ? "%d 4 2 9 1 %d %d %d %d\n" : "%d %d %d %d %d\n", t + 10, tets[t][s], tets[t][!s], tets[t][2],
            tets[t][3]);
  }
  fprintf(f, "$EndElements\n%s", extra ? extra : "");
  assert_int_equal(fclose(f), 0);
}

/* how WriteCube2() writes */
typedef struct {
  int    version; /* 22 or 41                                               */
  int    binary;  /* 1 = binary, 2 = binary with the other order of bytes   */
  double curved;  /* nodes of the edges are moved by up to that much        */
  int    n;       /* cells along an edge                                    */
} CubeFile;

/* whole numbers (of 4 or 8 bytes) and reals as the file's kind wants them */
static inline void PutBytes(FILE *f, const CubeFile *c, const void *value, size_t n)
{
  for (size_t i = 0; i < n; i++) fputc(((const unsigned char *)value)[c->binary == 2 ? n - 1 - i : i], f);
}
static inline void PutInt(FILE *f, const CubeFile *c, int bytes, long long value)
{
  const int word = (int)value;

  if (!c->binary) fprintf(f, "%lld ", value);
  else PutBytes(f, c, bytes == 4 ? (const void *)&word : (const void *)&value, (size_t)bytes);
}
static inline void PutInts(FILE *f, const CubeFile *c, int bytes, int n, const int values[])
{
  for (int i = 0; i < n; i++) PutInt(f, c, bytes, values[i]);
  if (!c->binary) fprintf(f, "\n");
}
static inline void PutReals(FILE *f, const CubeFile *c, int n, const double values[])
{
  for (int i = 0; i < n; i++) {
    if (!c->binary) fprintf(f, "%.17g ", values[i]);
    else PutBytes(f, c, &values[i], sizeof *values);
  }
  if (!c->binary) fprintf(f, "\n");
}

/* the head of a file, groups and (4.1) entities: surface 1 is the floor, volume 1 the solid */
static inline void PutHead(FILE *f, const CubeFile *c)
{
  static const double box[6] = {0, 0, 0, 1, 1, 1};
  const int           none = 0, surface[4] = {0, 0, 1, 1};

  fprintf(f, "$MeshFormat\n%s %d 8\n", c->version == 22 ? "2.2" : "4.1", c->binary != 0);
  if (c->binary) PutInt(f, c, 4, 1), fprintf(f, "\n");
  fprintf(f, "$EndMeshFormat\n$PhysicalNames\n2\n2 7 \"floor\"\n3 9 \"solid\"\n$EndPhysicalNames\n");
  if (c->version == 22) return;
  fprintf(f, "$Entities\n");
  PutInts(f, c, 8, 4, surface);
  for (int dim = 2; dim < 4; dim++) {
    const int group = dim == 2 ? 7 : 9, one = 1;
    PutInts(f, c, 4, 1, &one);
    PutReals(f, c, 6, box);
    PutInts(f, c, 8, 1, &one);
    PutInts(f, c, 4, 1, &group);
    PutInts(f, c, 8, 1, &none);
  }
  fprintf(f, "%s$EndEntities\n", c->binary ? "\n" : "");
}

/* head of a block of n elements (4.1), or of each element (2.2, but in a binary file of the block) */
static inline void PutElements(FILE *f, const CubeFile *c, int dim, int type, int n, int n_nodes, int first, const int nodes[][10])
{
  const int block41[3] = {dim, 1, type}, block22[3] = {type, n, 2};

  if (c->version == 41) PutInts(f, c, 4, 3, block41), PutInts(f, c, 8, 1, &n);
  else if (c->binary) PutInts(f, c, 4, 3, block22);
  for (int e = 0; e < n; e++) {
    const int head[5] = {first + e, type, 2, dim == 2 ? 7 : 9, 1}, tag[3] = {first + e, dim == 2 ? 7 : 9, 1};
    if (c->version == 22) PutInts(f, c, 4, c->binary ? 3 : 5, c->binary ? tag : head);
    else PutInts(f, c, 8, 1, head);
    PutInts(f, c, c->version == 22 ? 4 : 8, n_nodes, nodes[e]);
  }
}

/* A unit cube of n^3 cells, each cut as in WriteCube(), with quadratic tetrahedra: the nodes are a grid of twice as many cells. gmsh's
   order of the edges' nodes: 01 12 02 03 23 13. */
static inline void WriteCube2(const char path[], const CubeFile *c)
{
  static const int path_of[6][2] = {{1, 3}, {2, 3}, {2, 6}, {4, 6}, {4, 5}, {1, 5}}; /* vertices 0, *, *, 7 of a cell: bits x, y, z */
  static const int edge[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}};
  const int        n = c->n, m = 2 * n + 1, n_nodes = m * m * m;
  int(*cells)[10] = malloc(6 * (size_t)(n * n * n) * sizeof *cells), (*faces)[10] = malloc(2 * (size_t)(n * n) * sizeof *faces);
  int  *numbers = malloc((size_t)n_nodes * sizeof *numbers), n_cells = 0, n_faces = 0;
  FILE *f = fopen(path, "wb");

  assert_non_null(f);
  for (int k = 0; k < 6 * n * n * n; k++) {
    const int cell = k / 6, origin[3] = {cell % n, cell / n % n, cell / n / n}, *via = path_of[k % 6];
    /* the two middle vertices are exchanged where the path is an odd permutation of x, y, z */
    const int corner[4] = {0, via[k % 2], via[1 - k % 2], 7};
    int       at[4][3];
    for (int a = 0; a < 4; a++)
      for (int i = 0; i < 3; i++) at[a][i] = 2 * (origin[i] + (corner[a] >> i & 1));
    for (int a = 0; a < 10; a++) {
      const int *v = a < 4 ? at[a] : at[edge[a - 4][0]], *w = a < 4 ? at[a] : at[edge[a - 4][1]];
      cells[n_cells][a] = 1 + (v[0] + w[0]) / 2 + m * ((v[1] + w[1]) / 2 + m * ((v[2] + w[2]) / 2));
    }
    n_cells++;
  }
  for (int k = 0; k < 2 * n * n; k++) { /* (0, 0), (1, 1), and (1, 0) or (0, 1) of a cell of the floor */
    const int cell = k / 2, x = 2 * (cell % n), y = 2 * (cell / n), at[3][2] = {{x, y}, {x + 2, y + 2}, {x + 2 * (k % 2), y + 2 * (1 - k % 2)}};
    for (int a = 0; a < 6; a++) {
      const int *v = at[a % 3], *w = a < 3 ? v : at[(a + 1) % 3];
      faces[n_faces][a] = 1 + (v[0] + w[0]) / 2 + m * ((v[1] + w[1]) / 2);
    }
    n_faces++;
  }
  const int head[4] = {1, n_nodes, 1, n_nodes}, block[3] = {3, 1, 0}, elements[4] = {2, n_faces + n_cells, 1, n_faces + n_cells};
  PutHead(f, c);
  fprintf(f, "$Nodes\n");
  for (int a = 0; a < n_nodes; a++) numbers[a] = a + 1;
  if (c->version == 22) fprintf(f, "%d\n", n_nodes);
  else PutInts(f, c, 8, 4, head), PutInts(f, c, 4, 3, block), PutInts(f, c, 8, 1, &n_nodes), PutInts(f, c, 8, n_nodes, numbers);
  for (int a = 0; a < n_nodes; a++) {
    const int at[3] = {a % m, a / m % m, a / m / m}, middle = at[0] % 2 || at[1] % 2 || at[2] % 2;
    double    x[3];
    for (int i = 0; i < 3; i++) x[i] = 0.5 * at[i] / n + (middle ? c->curved * sin(1.0 + 7.3 * a * a + 3.0 * i) : 0.0);
    if (c->version == 22) PutInt(f, c, 4, numbers[a]);
    PutReals(f, c, 3, x);
  }
  fprintf(f, "%s$EndNodes\n$Elements\n", c->binary ? "\n" : "");
  if (c->version == 22) fprintf(f, "%d\n", elements[1]);
  else PutInts(f, c, 8, 4, elements);
  PutElements(f, c, 2, 9, n_faces, 6, 1, faces);
  PutElements(f, c, 3, 11, n_cells, 10, n_faces + 1, cells);
  fprintf(f, "%s$EndElements\n", c->binary ? "\n" : "");
  assert_int_equal(fclose(f), 0);
  free(cells);
  free(faces);
  free(numbers);
}

/* a file of this test and of no other that runs beside it */
static inline char *Path(const char name[])
{
  static char path[256];
  snprintf(path, sizeof path, "/tmp/byssus_test_%d_%s", (int)getpid(), name);
  return path;
}

static inline TLED Body(const char path[], TLEDParams **p)
{
  TLED tled = NewBody("", p);
  snprintf((*p)->mesh, sizeof(*p)->mesh, "%s", path);
  return tled;
}

/* SetUp must refuse, and say all the words (NULL ends) on stderr */
static inline void Refused(TLED tled, const char *const words[])
{
  FILE *log = tmpfile();
  char  text[4096];
  int   old = dup(2);

  fflush(stderr);
  dup2(fileno(log), 2);
  const PetscErrorCode ierr = TLEDSetUp(tled);
  fflush(stderr);
  dup2(old, 2);
  close(old);
  rewind(log);
  text[fread(text, 1, sizeof text - 1, log)] = 0;
  fclose(log);
  assert_int_equal((int)ierr, (int)BY_ERR_INPUT);
  for (int i = 0; words[i]; i++)
    if (!strstr(text, words[i])) fail_msg("\"%s\" is missing from the message:\n%s", words[i], text);
  if (strstr(text, "PETSC ERROR")) fail_msg("a traceback:\n%s", text);
  assert_petsc(TLEDDestroy(&tled)); /* half-built */
}

#define REFUSED(tled, ...) Refused(tled, (const char *const[]){__VA_ARGS__, NULL})

#endif
