/* test_surface.c - reading triangle surfaces, winding numbers, distances. */
#include <time.h>
#include <unistd.h>
#include "check.h"
#include "surface.h"
#include "mat3.h"
#include "unit/proxy/shapes.h"

static char Folder[] = "/tmp/byssus_surface_XXXXXX";

static const char *Path(const char name[])
{
  static char path[256];
  snprintf(path, sizeof(path), "%s/%s", Folder, name);
  return path;
}
static void WriteText(const char name[], const char text[])
{
  FILE *f = fopen(Path(name), "wb");
  assert_non_null(f);
  fwrite(text, 1, strlen(text), f);
  fclose(f);
}

/* read a file, catching what is said to stderr */
static int Read(const char name[], Surface *s, char text[], size_t n_text)
{
  const double zero[3] = {0, 0, 0};
  FILE        *file  = tmpfile();
  const int    saved = dup(2);
  int          code;

  fflush(stderr);
  dup2(fileno(file), 2);
  code = (int)SurfaceRead("rock.surface", Path(name), 1.0, zero, s);
  fflush(stderr);
  dup2(saved, 2);
  close(saved);
  rewind(file);
  text[fread(text, 1, n_text - 1, file)] = 0;
  fclose(file);
  return code;
}
static void CheckRefused(const char name[], const char said[])
{
  Surface s;
  char    text[2000];
  assert_int_equal(Read(name, &s, text, sizeof(text)), (int)BY_ERR_INPUT);
  if (!strstr(text, said) || !strstr(text, "rock.surface")) fail_msg("%s: '%s' is not in: %s", name, said, text);
  assert_null(s.x);
}

/* volume of a surface that was read: positive = outward */
static double Volume(const Surface *s)
{
  double v = 0.0;
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    double c[3];
    Cross3(&s->x[3*s->triangles[3*t + 1]], &s->x[3*s->triangles[3*t + 2]], c);
    v += Dot3(&s->x[3*s->triangles[3*t]], c)/6.0;
  }
  return v;
}

/* the same box in each format, with triangles turned every other way; binary PLY in both byte orders */
static void Put(FILE *f, const void *value, size_t n, int swap)
{
  const unsigned char *b = (const unsigned char *)value;
  for (size_t i = 0; i < n; i++) fputc(b[swap ? n - 1 - i : i], f);
}
static void WriteShape(const Shape *s, const char name[], int format)
{
  FILE *f = fopen(Path(name), "wb");
  assert_non_null(f);
  if (format == 0) {
    fprintf(f, "OFF # a box\n%d %d 0\n", s->n_nodes, s->n_triangles);
    for (int i = 0; i < s->n_nodes; i++) fprintf(f, "%.17g %.17g %.17g\n", s->x[3*i], s->x[3*i + 1], s->x[3*i + 2]);
    for (int t = 0; t < s->n_triangles; t++) fprintf(f, "3 %d %d %d 0.5 0.5 1\n", s->triangles[3*t], s->triangles[3*t + (t%2 ? 1 : 2)], s->triangles[3*t + (t%2 ? 2 : 1)]);
  } else if (format == 1) {
    fprintf(f, "# a box\no box\n");
    for (int i = 0; i < s->n_nodes; i++) fprintf(f, "v %.17g %.17g %.17g\nvn 0 0 1\n", s->x[3*i], s->x[3*i + 1], s->x[3*i + 2]);
    for (int t = 0; t < s->n_triangles; t++) fprintf(f, "f %d/1/1 %d//1 -%d\n", s->triangles[3*t] + 1, s->triangles[3*t + 1] + 1, s->n_nodes - s->triangles[3*t + 2]);
  } else if (format == 2 || format == 3 || format == 4) {
    const int    swap = format == 4;
    const double zero = 0.0;
    fprintf(f, "ply\nformat %s 1.0\ncomment a box\nelement vertex %d\nproperty double x\nproperty double y\nproperty double z\nproperty double w\n", format == 2 ? "ascii" : format == 3 ? "binary_little_endian" : "binary_big_endian", s->n_nodes);
    fprintf(f, "element face %d\nproperty uchar flag\nproperty list uchar int vertex_indices\nend_header\n", s->n_triangles);
    for (int i = 0; i < s->n_nodes; i++) {
      if (format == 2) fprintf(f, "%.17g %.17g %.17g 0\n", s->x[3*i], s->x[3*i + 1], s->x[3*i + 2]);
      for (int k = 0; k < 3 && format > 2; k++) Put(f, &s->x[3*i + k], 8, swap);
      if (format > 2) Put(f, &zero, 8, swap);
    }
    for (int t = 0; t < s->n_triangles; t++) {
      if (format == 2) fprintf(f, "7 3 %d %d %d\n", s->triangles[3*t], s->triangles[3*t + 1], s->triangles[3*t + 2]);
      else {
        fputc(7, f), fputc(3, f);
        for (int k = 0; k < 3; k++) Put(f, &s->triangles[3*t + k], 4, swap);
      }
    }
  } else if (format == 5) {
    fprintf(f, "solid box\n");
    for (int t = 0; t < s->n_triangles; t++) {
      fprintf(f, "facet normal 0 0 0\nouter loop\n");
      for (int k = 0; k < 3; k++) fprintf(f, "vertex %.9g %.9g %.9g\n", s->x[3*s->triangles[3*t + k]], s->x[3*s->triangles[3*t + k] + 1], s->x[3*s->triangles[3*t + k] + 2]);
      fprintf(f, "endloop\nendfacet\n");
    }
    fprintf(f, "endsolid box\n");
  } else if (format == 6) {
    const uint32_t n = (uint32_t)s->n_triangles;
    const char     header[80] = "binary";
    fwrite(header, 1, 80, f);
    fwrite(&n, 4, 1, f);
    for (int t = 0; t < s->n_triangles; t++) {
      float          v[12] = {0};
      const uint16_t zero = 0;
      for (int k = 0; k < 9; k++) v[3 + k] = (float)s->x[3*s->triangles[3*t + k/3] + k%3];
      fwrite(v, 4, 12, f);
      fwrite(&zero, 2, 1, f);
    }
  } else {
    fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", s->n_nodes);
    for (int i = 0; i < s->n_nodes; i++) fprintf(f, "%d %.17g %.17g %.17g\n", i + 1, s->x[3*i], s->x[3*i + 1], s->x[3*i + 2]);
    fprintf(f, "$EndNodes\n$Elements\n%d\n", s->n_triangles);
    for (int t = 0; t < s->n_triangles; t++) fprintf(f, "%d 2 2 1 1 %d %d %d\n", t + 1, s->triangles[3*t] + 1, s->triangles[3*t + 1] + 1, s->triangles[3*t + 2] + 1);
    fprintf(f, "$EndElements\n");
  }
  fclose(f);
}

static void every_format_gives_the_same_closed_outward_surface(void **state)
{
  static const char *const names[] = {"box.off", "box.obj", "a.ply", "l.ply", "b.PLY", "ascii.stl", "binary.stl", "box.msh"};
  Shape                    box = ShapeBox(1, 0.5, 0.25, 4, 3, 2);
  (void)state;
  for (int format = 0; format < 8; format++) {
    Surface s;
    char    text[1000];
    WriteShape(&box, names[format], format);
    if (Read(names[format], &s, text, sizeof(text))) fail_msg("%s: %s", names[format], text);
    assert_int_equal(s.n_nodes, box.n_nodes);
    assert_int_equal(s.n_triangles, box.n_triangles);
    assert_close(Volume(&s), 1.0, 1e-6, 1.0); // single precision of STL
    assert_petsc(SurfaceDestroy(&s));
  }
  ShapeFree(&box);
}

static void scale_and_translation_are_applied(void **state)
{
  const double shift[3] = {1, 2, 3};
  Shape        box = ShapeBox(1, 1, 1, 1, 1, 1);
  Surface      s;
  double       lo[3] = {9, 9, 9}, hi[3] = {-9, -9, -9};
  (void)state;
  WriteShape(&box, "unit.off", 0);
  assert_petsc(SurfaceRead("rock.surface", Path("unit.off"), 0.5, shift, &s));
  for (PetscInt i = 0; i < s.n_nodes; i++) {
    for (int k = 0; k < 3; k++) lo[k] = fmin(lo[k], s.x[3*i + k]), hi[k] = fmax(hi[k], s.x[3*i + k]);
  }
  for (int k = 0; k < 3; k++) {
    assert_close(lo[k], shift[k] - 0.5, 1e-15, 1.0);
    assert_close(hi[k], shift[k] + 0.5, 1e-15, 1.0);
  }
  assert_petsc(SurfaceDestroy(&s));
  ShapeFree(&box);
}

/* a shell: the inner box is a cavity, whichever way its triangles were written */
static void cavities_point_inward(void **state)
{
  Shape   a = ShapeBox(1, 1, 1, 2, 2, 2), b = ShapeBox(0.5, 0.5, 0.5, 2, 2, 2), both = ShapeAllocate(a.n_nodes + b.n_nodes, a.n_triangles + b.n_triangles);
  Surface s;
  char    text[1000];
  (void)state;
  memcpy(both.x, a.x, 3*sizeof(double)*(size_t)a.n_nodes);
  memcpy(both.x + 3*a.n_nodes, b.x, 3*sizeof(double)*(size_t)b.n_nodes);
  memcpy(both.triangles, a.triangles, 3*sizeof(int)*(size_t)a.n_triangles);
  for (int i = 0; i < 3*b.n_triangles; i++) both.triangles[3*a.n_triangles + i] = b.triangles[i] + a.n_nodes;
  both.n_nodes = a.n_nodes + b.n_nodes, both.n_triangles = a.n_triangles + b.n_triangles;
  WriteShape(&both, "shell.off", 0);
  assert_int_equal(Read("shell.off", &s, text, sizeof(text)), 0);
  assert_close(Volume(&s), 8.0 - 1.0, 1e-13, 8.0);
  assert_petsc(SurfaceDestroy(&s));
  ShapeFree(&a);
  ShapeFree(&b);
  ShapeFree(&both);
}

static void bad_files_are_refused_with_the_reason(void **state)
{
  Shape box = ShapeBox(1, 1, 1, 2, 2, 2);
  (void)state;
  CheckRefused("missing.off", "No such file");
  CheckRefused("", "not an ordinary file"); // the folder
  WriteText("text.xyz", "0 0 0\n");
  CheckRefused("text.xyz", ".stl .off .obj .ply .msh");
  WriteText("empty.off", "");
  CheckRefused("empty.off", "starts with the word OFF");
  WriteText("short.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n");
  CheckRefused("short.off", "ends before all points");
  WriteText("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  CheckRefused("index.off", "a point that is not there");
  WriteText("nan.obj", "v 0 0 nan\n");
  CheckRefused("nan.obj", "finite");
  WriteText("none.obj", "v 0 0 0\n");
  CheckRefused("none.obj", "no triangles");
  WriteText("header.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
  CheckRefused("header.ply", "header has no end");
  WriteText("bad.stl", "hello\n");
  CheckRefused("bad.stl", "rock.surface");
  box.n_triangles--;
  WriteShape(&box, "open.off", 0);
  CheckRefused("open.off", "is not closed: the edge from");
  ShapeTriangle(&box, box.triangles[0], box.triangles[1], box.triangles[3*20]);
  WriteShape(&box, "three.off", 0);
  CheckRefused("three.off", "edge");
  ShapeFree(&box);
}

/* the tree's far field against every solid angle; inside 1, outside 0 */
static void winding_numbers_are_right_to_a_hundredth(void **state)
{
  Shape    s = ShapeTorus(2, 0.8, 60, 30);
  enum { N = 3000 };
  double  *x = (double *)malloc(3*N*sizeof(double)), *w = (double *)malloc(N*sizeof(double)), most = 0.0;
  unsigned long seed = 1;
  (void)state;
  for (int i = 0; i < 3*N; i++) {
    seed = seed*6364136223846793005UL + 1442695040888963407UL;
    x[i] = 6.0*((double)(seed >> 33)/2147483648.0 - 0.5);
    if (i%3 == 2) x[i] *= 0.25;
  }
  assert_petsc(SurfaceWinding(N, x, s.x, s.n_triangles, s.triangles, w));
  for (int i = 0; i < N; i++) {
    const double ring = sqrt(x[3*i]*x[3*i] + x[3*i + 1]*x[3*i + 1]) - 2.0, d = sqrt(ring*ring + x[3*i + 2]*x[3*i + 2]) - 0.8;
    if (fabs(d) < 0.01) continue; // facets
    most = fmax(most, fabs(w[i] - (d < 0.0)));
  }
  assert_true(most < 0.01); // the dipoles' error
  free(x);
  free(w);
  ShapeFree(&s);
}

static void distance_is_exact_within_reach(void **state)
{
  Shape    s = ShapeBox(1, 0.7, 0.4, 9, 7, 5);
  enum { N = 3000 };
  double  *x = (double *)malloc(3*N*sizeof(double)), *d = (double *)malloc(N*sizeof(double));
  unsigned long seed = 2;
  const double half[3] = {1, 0.7, 0.4};
  (void)state;
  for (int i = 0; i < 3*N; i++) {
    seed = seed*6364136223846793005UL + 1442695040888963407UL;
    x[i] = 4.0*((double)(seed >> 33)/2147483648.0 - 0.5);
  }
  assert_petsc(SurfaceDistance(N, x, s.x, s.n_triangles, s.triangles, 0.6, d));
  for (int i = 0; i < N; i++) {
    double out = 0.0, in = 1e9;
    for (int k = 0; k < 3; k++) {
      const double e = fabs(x[3*i + k]) - half[k];
      if (e > 0.0) out += e*e;
      in = fmin(in, -e);
    }
    const double exact = out > 0.0 ? sqrt(out) : in;
    if (exact < 0.6) assert_close(d[i], exact, 1e-14, 1.0);
    else assert_true(d[i] > 0.6 - 1e-12);
  }
  free(x);
  free(d);
  ShapeFree(&s);
}

/* 25,000 points against 5,000 triangles: what carving a scene costs */
static void carving_is_cheap(void **state)
{
  Shape        s = ShapeSphere(1.0, 16);
  enum { N = 25000 };
  double      *x = (double *)malloc(3*N*sizeof(double)), *w = (double *)malloc(N*sizeof(double));
  (void)state;
  for (int i = 0; i < N; i++) x[3*i] = (i%30)/15.0 - 1.0, x[3*i + 1] = (i/30%30)/15.0 - 1.0, x[3*i + 2] = (i/900)/15.0 - 1.0;
  const clock_t begin = clock();
  assert_petsc(SurfaceWinding(N, x, s.x, s.n_triangles, s.triangles, w));
  assert_petsc(SurfaceDistance(N, x, s.x, s.n_triangles, s.triangles, 0.1, w));
  const double seconds = (double)(clock() - begin)/CLOCKS_PER_SEC; // of all threads together
  print_message("  winding and distance of %d points, %d triangles: %.3f s of CPU\n", N, s.n_triangles, seconds);
  assert_true(seconds < 3.0); // a tenth of it on an idle machine; sanitizers slow it down
  free(x);
  free(w);
  ShapeFree(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_format_gives_the_same_closed_outward_surface), cmocka_unit_test(scale_and_translation_are_applied),
    cmocka_unit_test(cavities_point_inward), cmocka_unit_test(bad_files_are_refused_with_the_reason),
    cmocka_unit_test(winding_numbers_are_right_to_a_hundredth), cmocka_unit_test(distance_is_exact_within_reach), cmocka_unit_test(carving_is_cheap),
  };
  char remove[300];

  if (!mkdtemp(Folder) || PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  snprintf(remove, sizeof(remove), "rm -r '%s'", Folder);
  if (system(remove)) return 1;
  return PetscFinalize() || failed ? 1 : 0;
}
