/* Fixed-point problems x = H(x), H linear, whose plain iteration x <- H(x) diverges: an interface of light modes under water of r times their mass does
   H = -r x + b mode by mode (method 5.3). */
#include "check.h"
#include "coupler/relaxation.h"

#define N 40

/* ratio of mode k, smooth shapes most; modes are sines on N points */
static double Ratio(int k, double largest) { return largest / (1.0 + k); }

typedef struct {
  double largest;
  int    modes; /* the others do not answer */
} Problem;

static void H(const Problem *p, const double x[N], double out[N])
{
  for (int i = 0; i < N; i++) out[i] = 1.0 + 0.3 * sin(1.7 * i);
  for (int k = 0; k < p->modes; k++) {
    double part = 0.0;

    for (int i = 0; i < N; i++) part += sqrt(2.0 / (N + 1.0)) * sin(M_PI * (k + 1) * (i + 1) / (N + 1.0)) * x[i];
    for (int i = 0; i < N; i++) out[i] -= Ratio(k, p->largest) * part * sqrt(2.0 / (N + 1.0)) * sin(M_PI * (k + 1) * (i + 1) / (N + 1.0));
  }
}

static double Size(const double r[N])
{
  double sum = 0.0;

  for (int i = 0; i < N; i++) sum += r[i] * r[i];
  return sqrt(sum);
}

/* evaluations until |H(x) - x| < 1e-10, at most 200; x is where it ended */
static int Solve(Relaxation *relaxation, const Problem *p, double x[N])
{
  double out[N], residual[N];
  int    n = 0;

  for (int i = 0; i < N; i++) x[i] = 0.0;
  assert_petsc(RelaxationBegin(relaxation));
  while (n++ < 200) {
    H(p, x, out);
    for (int i = 0; i < N; i++) residual[i] = out[i] - x[i];
    if (Size(residual) < 1e-10) break;
    assert_petsc(RelaxationNext(relaxation, x, residual));
  }
  return n;
}

static void plain_iteration_diverges(void **state)
{
  const Problem p = {10.0, 6};
  double        x[N] = {0}, out[N];

  (void)state;
  for (int n = 0; n < 20; n++) {
    H(&p, x, out);
    for (int i = 0; i < N; i++) x[i] = out[i];
  }
  assert_true(Size(x) > 1e10);
}

static void aitken_finds_one_mode_at_once(void **state)
{
  const Problem p = {30.0, 1};
  Relaxation   *relaxation;
  double        x[N];

  (void)state;
  assert_petsc(RelaxationCreate(RELAXATION_AITKEN, 0.05, 0, N, &relaxation));
  // a linear problem in one mode is known after two residuals, but the others, which do not answer, then go by the same factor
  assert_true(Solve(relaxation, &p, x) < 200);
  assert_petsc(RelaxationDestroy(&relaxation));
}

static void quasi_newton_needs_an_evaluation_a_mode(void **state)
{
  Relaxation *relaxation;
  double      x[N];

  (void)state;
  for (int modes = 1; modes <= 8; modes++) {
    const Problem p = {100.0, modes};

    assert_petsc(RelaxationCreate(RELAXATION_IQN_ILS, 0.05, 0, N, &relaxation));
    // the Krylov space of H has a dimension a distinct ratio, and one for what does not answer
    assert_in_range(Solve(relaxation, &p, x), 2, modes + 4);
    assert_petsc(RelaxationDestroy(&relaxation));
  }
}

static void what_a_step_taught_serves_the_next(void **state)
{
  const Problem p = {4.0, 3}, near = {4.1, 3}; // near enough that the first step from what was learnt is one forward
  Relaxation   *relaxation;
  double        x[N];
  int           first, next;

  (void)state;
  assert_petsc(RelaxationCreate(RELAXATION_IQN_ILS, 0.05, 3, N, &relaxation));
  first = Solve(relaxation, &p, x);
  next  = Solve(relaxation, &near, x);
  assert_true(next < first);
  assert_petsc(RelaxationForget(relaxation));
  assert_int_equal(Solve(relaxation, &p, x), first);
  assert_petsc(RelaxationDestroy(&relaxation));
}

/* the fluid keeps its pressure when the new velocity is the old one within its tolerance: then H is the answer whatever was learnt before */
static void ends_where_H_stands_still(void **state)
{
  Relaxation *relaxation;

  (void)state;
  for (int kind = RELAXATION_IQN_ILS; kind <= RELAXATION_AITKEN; kind++) {
    const Problem p = {30.0, 6};
    double        x[N] = {0}, out[N], residual[N];

    assert_petsc(RelaxationCreate(kind, 0.05, 3, N, &relaxation));
    assert_petsc(RelaxationBegin(relaxation));
    for (int n = 0; n < 6; n++) {
      if (n < 5) H(&p, x, out); // H of the fifth is also that of the sixth
      for (int i = 0; i < N; i++) residual[i] = out[i] - x[i];
      assert_petsc(RelaxationNext(relaxation, x, residual));
    }
    for (int i = 0; i < N; i++) assert_close(x[i], out[i], 1e-12, 1.0);
    assert_petsc(RelaxationDestroy(&relaxation));
  }
}

static void a_restart_goes_on_with_the_same_bits(void **state)
{
  const Problem p = {30.0, 6}, next = {33.0, 6};

  (void)state;
  for (int kind = RELAXATION_IQN_ILS; kind <= RELAXATION_AITKEN; kind++) {
    Relaxation *one, *two;
    double      x[N], y[N], *numbers;
    PetscInt    n;

    assert_petsc(RelaxationCreate(kind, 0.05, 3, N, &one));
    assert_petsc(RelaxationCreate(kind, 0.05, 3, N, &two));
    Solve(one, &p, x);
    assert_petsc(RelaxationGetState(one, &n, NULL));
    assert_petsc(PetscMalloc1(n, &numbers));
    assert_petsc(RelaxationGetState(one, &n, numbers));
    assert_petsc(RelaxationSetState(two, n, numbers));
    assert_petsc(PetscFree(numbers));
    assert_int_equal(Solve(one, &next, x), Solve(two, &next, y));
    assert_memory_equal(x, y, sizeof x);
    assert_petsc(RelaxationDestroy(&one));
    assert_petsc(RelaxationDestroy(&two));
  }
}

CHECK_MAIN(cmocka_unit_test(plain_iteration_diverges), cmocka_unit_test(aitken_finds_one_mode_at_once), cmocka_unit_test(quasi_newton_needs_an_evaluation_a_mode),
           cmocka_unit_test(what_a_step_taught_serves_the_next), cmocka_unit_test(ends_where_H_stands_still), cmocka_unit_test(a_restart_goes_on_with_the_same_bits))
