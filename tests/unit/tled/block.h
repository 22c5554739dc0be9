/* block.h - a box of tetrahedra as a gmsh file: cells of six tetrahedra, linear or quadratic, with slivers on request. */
#ifndef BY_TEST_BLOCK_H
#define BY_TEST_BLOCK_H

#include "unit/tled/body.h"
#include <unistd.h>

/* What the box is. The surface groups are xmin, xmax, ymin, ymax, zmin, zmax; the volume groups `lower` (the first n_lower layers of
   cells along x) and `upper`. */
typedef struct {
  int    n[3];     /* cells                                                                             */
  double size[3];  /* [m]; the box begins at the origin                                                 */
  int    order;    /* 1, or 2: nodes at the middles of edges                                            */
  int    n_lower;  /* layers of the group lower, 0: all of them                                         */
  double sliver;   /* dihedral angle [deg] of flat tetrahedra between the cells below and above the middle plane in z, which cut their
                      common squares along different diagonals; 0 = none                              */
  double cap;      /* one tetrahedron in the middle is cut into four by a point so near one of its faces that the flat one has this
                      dihedral angle [deg]; 0 = none                                                  */
  double bend;     /* nodes of edges in the half near x = 0 of a box of order 2 are moved by up to this [m]; 0 = none */
} Block;

#define BLOCK_NODES 40000
#define BLOCK_TETS 40000

typedef struct {
  int    n_nodes, n_tets, n_triangles;
  double X[3 * BLOCK_NODES];
  int    tet[BLOCK_TETS][11], triangle[BLOCK_TETS][7]; /* nodes, then the number of the group */
  int    mid[BLOCK_NODES][64][2], n_mid[BLOCK_NODES];  /* (other end, middle) of the edges from a node */
} BlockMesh;

static inline double BlockVolume(const BlockMesh *m, const int t[4])
{
  double d[9];

  for (int a = 0; a < 3; a++)
    for (int k = 0; k < 3; k++) d[3 * a + k] = m->X[3 * t[a + 1] + k] - m->X[3 * t[0] + k];
  return (d[0] * (d[4] * d[8] - d[5] * d[7]) - d[1] * (d[3] * d[8] - d[5] * d[6]) + d[2] * (d[3] * d[7] - d[4] * d[6])) / 6.0;
}

static inline void BlockAddTet(BlockMesh *m, int a, int b, int c, int d, int group)
{
  int *t = m->tet[m->n_tets++];

  assert_true(m->n_tets < BLOCK_TETS);
  t[0] = a, t[1] = b, t[2] = c, t[3] = d, t[10] = group;
  if (BlockVolume(m, t) < 0.0) t[1] = a, t[0] = b;
}

/* node of grid place (i, j, k); above the plane of slivers the places of that plane are the same nodes */
static inline int BlockNode(const Block *b, int i, int j, int k) { return i + (b->n[0] + 1) * (j + (b->n[1] + 1) * k); }

/* six tetrahedra around the diagonal of a cell, mirrored from cell to cell, so that faces match; above the plane of slivers mirrored
   once more */
static inline void BlockAddCell(const Block *b, BlockMesh *m, int i, int j, int k)
{
  static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const int        above       = b->sliver > 0.0 && k >= b->n[2] / 2;
  const int        mirror[3] = {(i + above) % 2, j % 2, (k + above) % 2}, group = b->n_lower && i >= b->n_lower ? 8 : 7;

  for (int p = 0; p < 6; p++) {
    int at[3] = {mirror[0], mirror[1], mirror[2]}, node[4];
    for (int s = 0; s < 4; s++) {
      node[s] = BlockNode(b, i + at[0], j + at[1], k + at[2]);
      if (s < 3) at[order[p][s]] = 1 - at[order[p][s]];
    }
    BlockAddTet(m, node[0], node[1], node[2], node[3], group);
  }
}

/* a triangle on each side of the box where a face of a tetrahedron lies in it */
static inline void BlockAddSides(const Block *b, BlockMesh *m)
{
  static const int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

  for (int e = 0; e < m->n_tets; e++) {
    for (int f = 0; f < 4; f++) {
      for (int side = 0; side < 6; side++) {
        const int    axis = side / 2;
        const double at   = side % 2 ? b->size[axis] : 0.0;
        int          on   = 0;
        for (int a = 0; a < 3; a++) on += fabs(m->X[3 * m->tet[e][face[f][a]] + axis] - at) < 1e-12 * b->size[axis];
        if (on < 3) continue;
        for (int a = 0; a < 3; a++) m->triangle[m->n_triangles][a] = m->tet[e][face[f][a]];
        m->triangle[m->n_triangles++][6] = side + 1;
      }
    }
  }
}

static inline int BlockMiddle(BlockMesh *m, int a, int b)
{
  const int low = a < b ? a : b, high = a < b ? b : a;

  for (int k = 0; k < m->n_mid[low]; k++)
    if (m->mid[low][k][0] == high) return m->mid[low][k][1];
  assert_true(m->n_mid[low] < 64 && m->n_nodes < BLOCK_NODES);
  for (int k = 0; k < 3; k++) m->X[3 * m->n_nodes + k] = 0.5 * (m->X[3 * a + k] + m->X[3 * b + k]);
  m->mid[low][m->n_mid[low]][0]   = high;
  m->mid[low][m->n_mid[low]++][1] = m->n_nodes;
  return m->n_nodes++;
}

/* middle nodes in gmsh's order */
static inline void BlockRaiseOrder(BlockMesh *m)
{
  static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};

  for (int e = 0; e < m->n_tets; e++)
    for (int k = 0; k < 6; k++) m->tet[e][4 + k] = BlockMiddle(m, m->tet[e][edge[k][0]], m->tet[e][edge[k][1]]);
  for (int t = 0; t < m->n_triangles; t++)
    for (int k = 0; k < 3; k++) m->triangle[t][3 + k] = BlockMiddle(m, m->triangle[t][edge[k][0]], m->triangle[t][edge[k][1]]);
}

/* cut the tetrahedron in the middle of the list into four; the new point stands so near its first face that this angle comes out */
static inline void BlockCap(BlockMesh *m, double angle)
{
  int       *t = m->tet[m->n_tets / 2], old[4] = {t[0], t[1], t[2], t[3]}, group = t[10], p = m->n_nodes++;
  double     side[3], area, d[3][3], n[3], height;
  const int *f = &old[1];

  for (int a = 0; a < 3; a++) {
    for (int k = 0; k < 3; k++) d[a][k] = m->X[3 * f[(a + 1) % 3] + k] - m->X[3 * f[a] + k];
    side[a] = sqrt(d[a][0] * d[a][0] + d[a][1] * d[a][1] + d[a][2] * d[a][2]);
  }
  for (int k = 0; k < 3; k++) n[k] = d[0][(k + 1) % 3] * d[1][(k + 2) % 3] - d[0][(k + 2) % 3] * d[1][(k + 1) % 3];
  area   = 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  height = 2.0 * area / (side[0] + side[1] + side[2]) * tan(angle * 3.14159265358979323846 / 180.0); /* over the incentre */
  for (int k = 0; k < 3; k++) {
    m->X[3 * p + k] = 0.0;
    for (int a = 0; a < 3; a++) m->X[3 * p + k] += side[(a + 1) % 3] * m->X[3 * f[a] + k] / (side[0] + side[1] + side[2]);
  }
  {
    double toward = 0.0;
    for (int k = 0; k < 3; k++) toward += n[k] * (m->X[3 * old[0] + k] - m->X[3 * p + k]);
    for (int k = 0; k < 3; k++) m->X[3 * p + k] += height * n[k] / (2.0 * area) * (toward > 0.0 ? 1.0 : -1.0);
  }
  t[0] = p;
  if (BlockVolume(m, t) < 0.0) t[1] = old[2], t[2] = old[1];
  for (int a = 1; a < 4; a++) BlockAddTet(m, old[0], p, old[1 + a % 3], old[1 + (a + 1) % 3], group);
}

static inline void BlockBuild(const Block *b, BlockMesh *m)
{
  const int middle = b->n[2] / 2;

  m->n_nodes = (b->n[0] + 1) * (b->n[1] + 1) * (b->n[2] + 1);
  assert_true(m->n_nodes < BLOCK_NODES);
  for (int k = 0; k <= b->n[2]; k++)
    for (int j = 0; j <= b->n[1]; j++)
      for (int i = 0; i <= b->n[0]; i++) {
        const int at[3] = {i, j, k};
        for (int c = 0; c < 3; c++) m->X[3 * BlockNode(b, i, j, k) + c] = b->size[c] * at[c] / b->n[c];
        /* the flat tetrahedron over a square of side s has its corners s/4 tan(angle)... above and below the plane */
        if (b->sliver > 0.0 && k == middle) {
          const double lift = 0.25 * b->size[0] / b->n[0] * tan(b->sliver * 3.14159265358979323846 / 180.0);
          m->X[3 * BlockNode(b, i, j, k) + 2] += ((i + j) % 2 ? 1.0 : -1.0) * lift;
        }
      }
  for (int k = 0; k < b->n[2]; k++)
    for (int j = 0; j < b->n[1]; j++)
      for (int i = 0; i < b->n[0]; i++) BlockAddCell(b, m, i, j, k);
  for (int j = 0; j < b->n[1] && b->sliver > 0.0; j++)
    for (int i = 0; i < b->n[0]; i++)
      BlockAddTet(m, BlockNode(b, i, j, middle), BlockNode(b, i + 1, j, middle), BlockNode(b, i + 1, j + 1, middle),
                  BlockNode(b, i, j + 1, middle), b->n_lower && i >= b->n_lower ? 8 : 7);
  if (b->cap > 0.0) BlockCap(m, b->cap);
  BlockAddSides(b, m);
  const int n_vertices = m->n_nodes;
  if (b->order == 2) BlockRaiseOrder(m);
  for (int a = n_vertices; a < m->n_nodes; a++) {
    const int moves = m->X[3 * a] < 0.499 * b->size[0];
    for (int k = 0; k < 3 && moves; k++) m->X[3 * a + k] += b->bend * sin(1.0 + 7.3 * a * a + 3.0 * k);
  }
}

/* write the box to `path` in gmsh's format 2.2 */
static inline void WriteBlock(const char path[], const Block *b)
{
  static const char *const side[6] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  BlockMesh               *m       = calloc(1, sizeof *m);
  FILE                    *f       = fopen(path, "w");
  const int                n_tri = b->order == 2 ? 6 : 3, n_tet = b->order == 2 ? 10 : 4;

  assert_true(m && f);
  BlockBuild(b, m);
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n", b->n_lower ? 8 : 7);
  for (int s = 0; s < 6; s++) fprintf(f, "2 %d \"%s\"\n", s + 1, side[s]);
  fprintf(f, "3 7 \"lower\"\n");
  if (b->n_lower) fprintf(f, "3 8 \"upper\"\n");
  fprintf(f, "$EndPhysicalNames\n$Nodes\n%d\n", m->n_nodes);
  for (int a = 0; a < m->n_nodes; a++) fprintf(f, "%d %.17g %.17g %.17g\n", a + 1, m->X[3 * a], m->X[3 * a + 1], m->X[3 * a + 2]);
  fprintf(f, "$EndNodes\n$Elements\n%d\n", m->n_triangles + m->n_tets);
  for (int t = 0; t < m->n_triangles; t++) {
    fprintf(f, "%d %d 2 %d %d", t + 1, b->order == 2 ? 9 : 2, m->triangle[t][6], m->triangle[t][6]);
    for (int a = 0; a < n_tri; a++) fprintf(f, " %d", m->triangle[t][a] + 1);
    fprintf(f, "\n");
  }
  for (int e = 0; e < m->n_tets; e++) {
    fprintf(f, "%d %d 2 %d %d", m->n_triangles + e + 1, b->order == 2 ? 11 : 4, m->tet[e][10], m->tet[e][10]);
    for (int a = 0; a < n_tet; a++) fprintf(f, " %d", m->tet[e][a] + 1);
    fprintf(f, "\n");
  }
  fprintf(f, "$EndElements\n");
  assert_int_equal(fclose(f), 0);
  free(m);
}

/* smallest dihedral angle of a tetrahedron with corners X (4 x 3) [deg] */
static inline double SmallestAngle(const double X[12])
{
  double n[4][3], least = 180.0;

  for (int f = 0; f < 4; f++) {
    const double *p = &X[3 * ((f + 1) % 4)], *q = &X[3 * ((f + 2) % 4)], *r = &X[3 * ((f + 3) % 4)], *o = &X[3 * f];
    double        a[3], b[3], out = 0.0, size = 0.0;
    for (int k = 0; k < 3; k++) a[k] = q[k] - p[k], b[k] = r[k] - p[k];
    for (int k = 0; k < 3; k++) n[f][k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    for (int k = 0; k < 3; k++) out += n[f][k] * (p[k] - o[k]), size += n[f][k] * n[f][k];
    for (int k = 0; k < 3; k++) n[f][k] *= (out > 0.0 ? 1.0 : -1.0) / sqrt(size);
  }
  for (int f = 0; f < 4; f++)
    for (int g = 0; g < f; g++) {
      const double c = -(n[f][0] * n[g][0] + n[f][1] * n[g][1] + n[f][2] * n[g][2]);
      least          = fmin(least, 180.0 / 3.14159265358979323846 * acos(fmax(-1.0, fmin(1.0, c))));
    }
  return least;
}

/* smallest dihedral angle of a body's mesh [deg] */
static inline double SmallestAngleOf(TLED tled)
{
  const PetscInt  *tets;
  const PetscReal *X;
  PetscInt         n_tets, n_corners;
  double           least = 180.0, x[12];

  assert_petsc(TLEDGetSize(tled, NULL, &n_tets));
  assert_petsc(TLEDGetMesh(tled, &n_corners, &tets, &X));
  for (PetscInt e = 0; e < n_tets; e++) {
    for (int k = 0; k < 12; k++) x[k] = X[3 * tets[n_corners * e + k / 3] + k % 3];
    least = fmin(least, SmallestAngle(x));
  }
  return least;
}

/* a body of a box, of the reference beam's material; the file is removed after TLEDSetUp by RemoveBlock() */
static inline TLED NewBlock(const Block *b, TLEDParams **p)
{
  TLED tled = NewBody("", p);

  snprintf((*p)->mesh, sizeof(*p)->mesh, "/tmp/byssus-block-%ld-XXXXXX", (long)getpid());
  assert_true(mkstemp((*p)->mesh) >= 0);
  strcat((*p)->mesh, ".msh");
  WriteBlock((*p)->mesh, b);
  return tled;
}

static inline void RemoveBlock(TLEDParams *p)
{
  unlink(p->mesh);
  p->mesh[strlen(p->mesh) - 4] = 0;
  unlink(p->mesh);
}

#endif
