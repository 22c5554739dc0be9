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

#endif
