/* Courses: values at known times, derivatives against differences, tables and what is wrong with them. */
#include "check.h"
#include "course.h"
#include <string.h>
#include <unistd.h>

static const char table_path[] = "test_course.csv";

static void WriteTable(const char text[])
{
  FILE *file = fopen(table_path, "w");

  assert_non_null(file);
  fputs(text, file);
  assert_int_equal(fclose(file), 0);
}

static Course Make(int kind, double start, double duration, double frequency, double phase)
{
  CourseParams p = {.kind = kind, .start = start, .duration = duration, .frequency = frequency, .phase = phase};
  Course       c;

  if (kind == COURSE_TABLE) snprintf(p.table, sizeof p.table, "%s", table_path);
  assert_petsc(CourseCreate("block.plate", &p, &c));
  return c;
}

static double At(const Course *c, double t)
{
  double g[3];

  CourseAt(c, t, g);
  return g[0];
}

static void Values_AreThoseOfTheFormulas(void **state)
{
  Course c;

  (void)state;
  c = Make(COURSE_CONSTANT, 1.0, 0.0, 0.0, 0.0);
  assert_true(At(&c, 0.0) == 1.0 && At(&c, 5.0) == 1.0);
  c = Make(COURSE_LINEAR, 1.0, 2.0, 0.0, 0.0);
  assert_true(At(&c, 0.5) == 0.0 && At(&c, 2.0) == 0.5 && At(&c, 5.0) == 2.0);
  c = Make(COURSE_QUADRATIC, 1.0, 2.0, 0.0, 0.0);
  assert_true(At(&c, 0.5) == 0.0 && At(&c, 2.0) == 0.25 && At(&c, 5.0) == 4.0);
  c = Make(COURSE_RAMP, 1.0, 2.0, 0.0, 0.0);
  assert_true(At(&c, 0.5) == 0.0 && At(&c, 3.0) == 1.0 && At(&c, 9.0) == 1.0);
  assert_close(At(&c, 2.0), 0.5, 1e-15, 1.0);
  c = Make(COURSE_SINE, 0.5, 0.0, 2.0, 30.0);
  assert_close(At(&c, 0.5), 0.5, 1e-15, 1.0);
  assert_close(At(&c, 0.1), 0.5, 1e-15, 1.0);
  assert_close(At(&c, 0.5 + 1.0 / 24.0), sin(PETSC_PI / 3.0), 1e-14, 1.0);
  WriteTable("time, value\n0, 1 # here it starts\n\n1; 3\n3 -1\n");
  c = Make(COURSE_TABLE, 10.0, 0.0, 0.0, 0.0);
  assert_int_equal(c.n, 3);
  assert_true(At(&c, 0.0) == 1.0 && At(&c, 10.5) == 2.0 && At(&c, 12.0) == 1.0 && At(&c, 20.0) == -1.0);
  assert_petsc(CourseDestroy(&c));
  unlink(table_path);
}

/* derivatives by central differences of step 1e-4 of the course's own time: h^2 g'''/6 */
static void Derivatives_AreThoseOfTheValues(void **state)
{
  (void)state;
  WriteTable("0,1\n1,3\n3,-1\n");
  for (int kind = COURSE_CONSTANT; kind <= COURSE_TABLE; kind++) {
    for (int fade = 0; fade < 2; fade++) {
      Course c = Make(kind, 0.25, kind == COURSE_SINE ? fade * 2.0 : 2.0, 1.5, 20.0);
      for (double t = 0.11; t < 4.0; t += 0.137) {
        const double h = 1e-4;
        double       g[3], low[3], high[3];
        CourseAt(&c, t, g), CourseAt(&c, t - h, low), CourseAt(&c, t + h, high);
        if (kind == COURSE_TABLE && fabs(high[1] - low[1]) > 0.0) continue; /* a corner */
        assert_close((high[0] - low[0]) / (2.0 * h), g[1], 1e-5, 10.0);
        assert_close((high[1] - low[1]) / (2.0 * h), g[2], 1e-5, 100.0);
      }
      assert_petsc(CourseDestroy(&c));
    }
  }
  unlink(table_path);
}

/* speed and acceleration of a ramp vanish at its ends, so that nothing is struck */
static void Ramp_BeginsAndEndsGently(void **state)
{
  Course c = Make(COURSE_RAMP, 0.0, 3.0, 0.0, 0.0);
  double g[3];

  (void)state;
  for (int end = 0; end < 2; end++) {
    CourseAt(&c, end ? 3.0 - 1e-9 : 1e-9, g);
    assert_close(g[1], 0.0, 1e-12, 1.0);
    assert_close(g[2], 0.0, 1e-8, 1.0);
  }
}

static void WrongCourses_AreRefused(void **state)
{
  static const char *const tables[] = {"0, 1\n1\n", "0, 1\n0, 2\n", "0, 1\n1, 2\n0.5, 2\n", "time, value\n", "0, x\n", "a, b\nc, d\n", "0,1,2\n", "0, inf\n"};
  CourseParams             p        = {.kind = COURSE_RAMP};
  Course                   c;

  (void)state;
  assert_int_equal((int)CourseCreate("block.plate", &p, &c), (int)BY_ERR_INPUT);
  p.kind = COURSE_LINEAR;
  assert_int_equal((int)CourseCreate("block.plate", &p, &c), (int)BY_ERR_INPUT);
  p.kind = COURSE_SINE;
  assert_int_equal((int)CourseCreate("block.plate", &p, &c), (int)BY_ERR_INPUT);
  p.kind = COURSE_TABLE;
  assert_int_equal((int)CourseCreate("block.plate", &p, &c), (int)BY_ERR_INPUT);
  snprintf(p.table, sizeof p.table, "no_such_file.csv");
  assert_int_equal((int)CourseCreate("block.plate", &p, &c), (int)BY_ERR_INPUT);
  snprintf(p.table, sizeof p.table, "%s", table_path);
  for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++) {
    WriteTable(tables[i]);
    assert_int_equal((int)CourseCreate("block.plate", &p, &c), (int)BY_ERR_INPUT);
    assert_petsc(CourseDestroy(&c));
  }
  p.kind = COURSE_CONSTANT;
  assert_int_equal((int)CourseCreate("block.plate", &p, &c), (int)BY_ERR_INPUT);
  unlink(table_path);
}

CHECK_MAIN(cmocka_unit_test(Values_AreThoseOfTheFormulas), cmocka_unit_test(Derivatives_AreThoseOfTheValues),
           cmocka_unit_test(Ramp_BeginsAndEndsGently), cmocka_unit_test(WrongCourses_AreRefused))
