/* check.h - what cmocka 1.1.5 lacks: doubles with a relative tolerance, and PETSc in a test's main. TOL_SCALE=0 makes every
   tolerance zero and so prints all residuals. */
#ifndef BY_CHECK_H
#define BY_CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>
#include <petscsys.h>

static inline double ToleranceScale(void)
{
  const char *s = getenv("TOL_SCALE");
  return s ? atof(s) : 1.0;
}

/* |a - b| <= tol * scale, tol relative to `scale` */
#define assert_close(a, b, tol, scale) \
  do { \
    const double a_ = (a), b_ = (b), t_ = (tol) * ToleranceScale(), s_ = fabs((double)(scale)); \
    if (!(fabs(a_ - b_) <= t_ * s_)) fail_msg("%s = %.15g, %s = %.15g: difference %.3g of %.3g allowed", #a, a_, #b, b_, fabs(a_ - b_), t_ * s_); \
  } while (0)
#define assert_petsc(...) assert_int_equal((int)(__VA_ARGS__), 0)

/* int main of a cmocka file: CHECK_MAIN(cmocka_unit_test(...), ...) */
#define CHECK_MAIN(...) \
  int main(int argc, char **argv) \
  { \
    const struct CMUnitTest tests[] = {__VA_ARGS__}; \
    if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1; \
    const int failed = cmocka_run_group_tests(tests, NULL, NULL); \
    return PetscFinalize() || failed ? 1 : 0; \
  }

#endif
