/* bench_bar.h - a bar of 1 x 0.1 x 0.1 m as a gmsh file: 10 m x m x m cubes of six tetrahedra each, of first or second order, held at x = 0. */
#ifndef BY_BENCH_BAR_H
#define BY_BENCH_BAR_H

#include "base.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* points are numbered on a lattice of twice the fineness for second order: `p` points to a cube's edge */
typedef struct {
  int m, p, nx, ny; /* nx, ny: points along x, and along y and z */
} Bar;

static int BarPoint(const Bar *b, int i, int j, int k) { return 1 + i + b->nx * (j + b->ny * k); }

static void BarPoints(const Bar *b, FILE *f)
{
  const double h = 0.1 / (b->m * b->p);

  fprintf(f, "$Nodes\n%d\n", b->nx * b->ny * b->ny);
  for (int k = 0; k < b->ny; k++)
    for (int j = 0; j < b->ny; j++)
      for (int i = 0; i < b->nx; i++) fprintf(f, "%d %.17g %.17g %.17g\n", BarPoint(b, i, j, k), h * i, h * j, h * k);
  fprintf(f, "$EndNodes\n");
}

/* six tetrahedra around the diagonal of a cube: corner 0, then one step along each axis in every order; c counts lattice points */
static void BarCube(const Bar *b, const int c[3], int *number, FILE *f)
{
  static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  static const int edge[6][2]  = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}}; /* gmsh's order of middle nodes */

  for (int t = 0; t < 6; t++) {
    int x[4][3];

    for (int a = 0; a < 4; a++)
      for (int d = 0; d < 3; d++) x[a][d] = a ? x[a - 1][d] : c[d];
    for (int a = 1; a < 4; a++)
      for (int s = a; s < 4; s++) x[s][order[t][a - 1]] += b->p;
    /* odd permutations are turned round */
    if (t > 2)
      for (int d = 0; d < 3; d++) {
        const int swap = x[1][d];
        x[1][d] = x[2][d];
        x[2][d] = swap;
      }
    fprintf(f, "%d %d 2 2 1", (*number)++, b->p == 1 ? 4 : 11);
    for (int a = 0; a < 4; a++) fprintf(f, " %d", BarPoint(b, x[a][0], x[a][1], x[a][2]));
    for (int e = 0; e < 6 && b->p == 2; e++) {
      const int *u = x[edge[e][0]], *v = x[edge[e][1]];
      fprintf(f, " %d", BarPoint(b, (u[0] + v[0]) / 2, (u[1] + v[1]) / 2, (u[2] + v[2]) / 2));
    }
    fprintf(f, "\n");
  }
}

/* the two triangles of a cube's side at x = 0, cut as its tetrahedra cut it */
static void BarSide(const Bar *b, int j, int k, int *number, FILE *f)
{
  for (int t = 0; t < 2; t++) {
    const int y[3] = {j, j + b->p, t ? j : j + b->p}, z[3] = {k, k + b->p, t ? k + b->p : k};

    fprintf(f, "%d %d 2 1 1", (*number)++, b->p == 1 ? 2 : 9);
    for (int a = 0; a < 3; a++) fprintf(f, " %d", BarPoint(b, 0, y[a], z[a]));
    for (int a = 0; a < 3 && b->p == 2; a++) fprintf(f, " %d", BarPoint(b, 0, (y[a] + y[(a + 1) % 3]) / 2, (z[a] + z[(a + 1) % 3]) / 2));
    fprintf(f, "\n");
  }
}

/* write the bar into a new temporary file, whose path is returned */
static PetscErrorCode BarWrite(int m, int order, char path[], size_t n)
{
  const Bar   b = {m, order, 10 * m * order + 1, m * order + 1};
  const char *folder = getenv("TMPDIR");
  int         number = 1, descriptor;
  FILE       *f;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(path, n, "%s/byssus_bar_XXXXXX.msh", folder ? folder : "/tmp"));
  descriptor = mkstemps(path, 4);
  f          = descriptor < 0 ? NULL : fdopen(descriptor, "w");
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s cannot be written", path);
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"clamp\"\n3 2 \"solid\"\n$EndPhysicalNames\n");
  BarPoints(&b, f);
  fprintf(f, "$Elements\n%d\n", 60 * m * m * m + 2 * m * m);
  for (int k = 0; k < m; k++)
    for (int j = 0; j < m; j++) BarSide(&b, j * order, k * order, &number, f);
  for (int k = 0; k < m; k++)
    for (int j = 0; j < m; j++)
      for (int i = 0; i < 10 * m; i++) {
        const int c[3] = {i * order, j * order, k * order};
        BarCube(&b, c, &number, f);
      }
  fprintf(f, "$EndElements\n");
  fclose(f);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void BarRemove(const char path[]) { (void)unlink(path); }

#endif
