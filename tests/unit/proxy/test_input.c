/* test_input.c - surfaces that cannot be used are refused with the place named. */
#include <unistd.h>
#include "unit/proxy/fixture.h"

/* what ProxySetUp says to stderr about a surface, and its code */
static int SetUpMessage(const char name[], const Shape *s, char text[], size_t n_text)
{
  const ProxyFluid fluid = FixtureFluid();
  FILE            *file  = tmpfile();
  const int        saved = dup(2);
  Proxy            p;
  int              code;

  assert_petsc(ProxyCreate(PETSC_COMM_SELF, name, &p));
  assert_petsc(ProxySetSurface(p, s->n_nodes, s->x, s->n_triangles, s->triangles));
  assert_petsc(ProxySetFluidScale(p, &fluid));
  fflush(stderr);
  dup2(fileno(file), 2);
  code = (int)ProxySetUp(p);
  fflush(stderr);
  dup2(saved, 2);
  close(saved);
  rewind(file);
  text[fread(text, 1, n_text - 1, file)] = 0;
  fclose(file);
  assert_petsc(ProxyDestroy(&p));
  return code;
}

static void three_triangles_at_an_edge_are_refused(void **state)
{
  Shape s = ShapePlate(1, 1, 1, 1, 0), more = ShapeAllocate(5, 3);
  char  text[1000];
  (void)state;
  memcpy(more.x, s.x, 12*sizeof(double));
  memcpy(more.triangles, s.triangles, 6*sizeof(int));
  more.n_nodes = 4, more.n_triangles = 2;
  ShapeNode(&more, 0, 0, 1);
  ShapeTriangle(&more, 0, 3, 4);
  assert_int_equal(SetUpMessage("flap", &more, text, sizeof(text)), (int)BY_ERR_INPUT);
  assert_non_null(strstr(text, "flap.mesh"));
  assert_non_null(strstr(text, "three triangles"));
  assert_non_null(strstr(text, "(-1, -1, 0)"));
  assert_non_null(strstr(text, "(1, 1, 0)"));
  ShapeFree(&s);
  ShapeFree(&more);
}

static void triangles_without_area_are_refused(void **state)
{
  Shape s = ShapePlate(1, 1, 2, 2, 0);
  char  text[1000];
  (void)state;
  for (int k = 0; k < 3; k++) s.x[3*4 + k] = 0.5*(s.x[k] + s.x[3*8 + k]);
  for (int k = 0; k < 3; k++) s.x[3*1 + k] = 0.5*(s.x[k] + s.x[3*4 + k]); // node 1 on the line from 0 to 4
  assert_petsc(PetscOptionsSetValue(NULL, "-rock_surface", "rock.stl"));
  assert_int_equal(SetUpMessage("rock", &s, text, sizeof(text)), (int)BY_ERR_INPUT);
  assert_petsc(PetscOptionsClearValue(NULL, "-rock_surface"));
  assert_non_null(strstr(text, "rock.surface")); // an obstacle's key
  assert_non_null(strstr(text, "without area"));
  ShapeFree(&s);
}

static void neighbours_of_opposite_orientation_are_refused(void **state)
{
  Shape     s = ShapePlate(1, 1, 2, 2, 0);
  const int swap = s.triangles[1];
  char      text[1000];
  (void)state;
  s.triangles[1] = s.triangles[2], s.triangles[2] = swap;
  assert_int_equal(SetUpMessage("flap", &s, text, sizeof(text)), (int)BY_ERR_INPUT);
  assert_non_null(strstr(text, "oriented"));
  ShapeFree(&s);
}

CHECK_MAIN(cmocka_unit_test(three_triangles_at_an_edge_are_refused), cmocka_unit_test(triangles_without_area_are_refused),
           cmocka_unit_test(neighbours_of_opposite_orientation_are_refused))
