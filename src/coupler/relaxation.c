/* relaxation.c - Aitken's factor and interface quasi-Newton with an inverse Jacobian from least squares (relaxation.h). */
#include "relaxation.h"

#define FACTOR_LEAST 1e-3 /* of Aitken: a step that stands still tells nothing */
#define FACTOR_MOST  2.0

static PetscReal Dot(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0.0;

  for (PetscInt i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static PetscReal Norm(PetscInt n, const PetscReal a[]) { return PetscSqrtReal(Dot(n, a, a)); }

PetscErrorCode RelaxationCreate(int kind, PetscReal start, PetscInt reuse, PetscInt n, Relaxation **relaxation)
{
  Relaxation *r;

  PetscFunctionBegin;
  PetscCall(PetscNew(&r));
  r->kind   = kind;
  r->start  = start;
  r->factor = start;
  r->reuse  = reuse;
  r->n      = n;
  PetscCall(PetscCalloc2(n, &r->x, n, &r->residual));
  *relaxation = r;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RelaxationDestroy(Relaxation **relaxation)
{
  Relaxation *r = *relaxation;

  PetscFunctionBegin;
  if (!r) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < RELAXATION_COLUMNS; k++) PetscCall(PetscFree3(r->V[k], r->W[k], r->Q[k]));
  PetscCall(PetscFree2(r->x, r->residual));
  PetscCall(PetscFree(r));
  *relaxation = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* leave column k out for good */
static void DropColumn(Relaxation *r, PetscInt k)
{
  PetscReal *V = r->V[k], *W = r->W[k], *Q = r->Q[k];

  r->n_columns--;
  for (; k < r->n_columns; k++) {
    r->V[k]   = r->V[k + 1];
    r->W[k]   = r->W[k + 1];
    r->Q[k]   = r->Q[k + 1];
    r->age[k] = r->age[k + 1];
  }
  r->V[k] = V;
  r->W[k] = W;
  r->Q[k] = Q;
}

PetscErrorCode RelaxationBegin(Relaxation *r)
{
  PetscReal largest = 0.0;

  PetscFunctionBegin;
  r->count = 0;
  for (PetscInt k = 0; k < r->n_columns && !r->age[k]; k++) largest = PetscMax(largest, Norm(r->n, r->V[k]));
  for (PetscInt k = r->n_columns - 1; k >= 0; k--)
    if (!r->age[k] && Norm(r->n, r->V[k]) < RELAXATION_NOISE * largest) DropColumn(r, k);
  for (PetscInt k = 0; k < r->n_columns; k++) r->age[k]++;
  while (r->n_columns && r->age[r->n_columns - 1] > r->reuse) r->n_columns--;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RelaxationForget(Relaxation *r)
{
  PetscFunctionBegin;
  r->n_columns = r->count = 0;
  r->factor               = r->start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Aitken's factor of the secant through the last two residuals: w <- -w r_old . (r - r_old)/|r - r_old|^2. A step begins with the factor
   that the last one ended with, but not a larger one than `start`. */
static PetscReal AitkenFactor(Relaxation *r, const PetscReal residual[])
{
  PetscReal along = 0.0, change = 0.0;

  if (!r->count) return PetscMin(r->start, r->factor);
  for (PetscInt i = 0; i < r->n; i++) {
    const PetscReal d = residual[i] - r->residual[i];

    along += r->residual[i] * d;
    change += d * d;
  }
  if (!(change > 0.0)) return r->factor;
  return PetscMin(FACTOR_MOST, PetscMax(FACTOR_LEAST, -r->factor * along / change));
}

/* one more pair of differences in front: dr of the residual, dH = dr + dx */
static PetscErrorCode AddColumn(Relaxation *r, const PetscReal x[], const PetscReal residual[])
{
  const PetscInt last = PetscMin(r->n_columns, RELAXATION_COLUMNS - 1);
  PetscReal     *V = r->V[last], *W = r->W[last], *Q = r->Q[last];

  PetscFunctionBegin;
  if (!V) PetscCall(PetscMalloc3(r->n, &V, r->n, &W, r->n, &Q));
  for (PetscInt k = last; k > 0; k--) {
    r->V[k]   = r->V[k - 1];
    r->W[k]   = r->W[k - 1];
    r->Q[k]   = r->Q[k - 1];
    r->age[k] = r->age[k - 1];
  }
  for (PetscInt i = 0; i < r->n; i++) {
    V[i] = residual[i] - r->residual[i];
    W[i] = V[i] + x[i] - r->x[i];
  }
  r->V[0]      = V;
  r->W[0]      = W;
  r->Q[0]      = Q;
  r->age[0]    = 0;
  r->n_columns = last + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* V = Q R by Gram-Schmidt, twice, newest column first; columns that newer ones nearly span are dropped. R is upper triangular, by columns */
static void Orthogonalise(Relaxation *r, PetscReal R[][RELAXATION_COLUMNS])
{
  for (PetscInt k = 0; k < r->n_columns;) {
    PetscReal       *q    = r->Q[k], left;
    const PetscReal *v    = r->V[k];
    const PetscReal  size = Norm(r->n, v);

    for (PetscInt i = 0; i < r->n; i++) q[i] = v[i];
    for (PetscInt j = 0; j < k; j++) R[k][j] = 0.0;
    for (int round = 0; round < 2; round++) {
      for (PetscInt j = 0; j < k; j++) {
        const PetscReal part = Dot(r->n, r->Q[j], q);

        R[k][j] += part;
        for (PetscInt i = 0; i < r->n; i++) q[i] -= part * r->Q[j][i];
      }
    }
    left = Norm(r->n, q);
    if (!(left > RELAXATION_FILTER * size)) {
      DropColumn(r, k);
      continue;
    }
    R[k][k] = left;
    for (PetscInt i = 0; i < r->n; i++) q[i] /= left;
    k++;
  }
}

/* Interface quasi-Newton: with the differences V of residuals and W of H, c = argmin |V c + r| and x <- x + r + W c. What V does not span
   moves by the plain residual (by `start` times it a block under water took twice the evaluations: what does not move is not learnt); before
   anything is known, by `start` times it. */
static void QuasiNewton(Relaxation *r, PetscReal x[], const PetscReal residual[])
{
  PetscReal R[RELAXATION_COLUMNS][RELAXATION_COLUMNS], c[RELAXATION_COLUMNS];

  Orthogonalise(r, R);
  for (PetscInt k = r->n_columns - 1; k >= 0; k--) {
    c[k] = -Dot(r->n, r->Q[k], residual);
    for (PetscInt j = k + 1; j < r->n_columns; j++) c[k] -= R[j][k] * c[j];
    c[k] /= R[k][k];
  }
  for (PetscInt i = 0; i < r->n; i++) x[i] += r->n_columns ? residual[i] : r->start * residual[i];
  for (PetscInt k = 0; k < r->n_columns; k++)
    for (PetscInt i = 0; i < r->n; i++) x[i] += c[k] * r->W[k][i];
}

/* whether H is where it was, but for round-off: the fluid took the last pressure for the solution of this iterate too */
static PetscBool StandsStill(const Relaxation *r, const PetscReal x[], const PetscReal residual[])
{
  PetscReal change = 0.0, size = 0.0;

  for (PetscInt i = 0; i < r->n; i++) {
    const PetscReal H = x[i] + residual[i], d = H - (r->x[i] + r->residual[i]);

    change += d * d;
    size += H * H;
  }
  return (PetscBool)(change <= 1e-26 * size);
}

PetscErrorCode RelaxationNext(Relaxation *r, PetscReal x[], const PetscReal residual[])
{
  const PetscReal size = Norm(r->n, residual);

  PetscFunctionBegin;
  if (r->count && StandsStill(r, x, residual)) {
    for (PetscInt i = 0; i < r->n; i++) x[i] += residual[i];
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  // what other steps taught has led astray
  while (r->count == 1 && size > r->size && r->n_columns && r->age[r->n_columns - 1]) r->n_columns--;
  r->size = size;
  if (r->kind == RELAXATION_IQN_ILS && r->count) PetscCall(AddColumn(r, x, residual));
  if (r->kind == RELAXATION_AITKEN) r->factor = AitkenFactor(r, residual);
  PetscCall(PetscArraycpy(r->x, x, r->n));
  PetscCall(PetscArraycpy(r->residual, residual, r->n));
  r->count++;
  if (r->kind == RELAXATION_IQN_ILS) QuasiNewton(r, x, residual);
  else
    for (PetscInt i = 0; i < r->n; i++) x[i] += r->factor * residual[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RelaxationGetState(const Relaxation *r, PetscInt *n, PetscReal state[])
{
  PetscFunctionBegin;
  *n = 2 + r->n_columns * (1 + 2 * r->n);
  if (!state) PetscFunctionReturn(PETSC_SUCCESS);
  *state++ = r->factor;
  *state++ = (PetscReal)r->n_columns;
  for (PetscInt k = 0; k < r->n_columns; k++) {
    *state++ = (PetscReal)r->age[k];
    PetscCall(PetscArraycpy(state, r->V[k], r->n));
    PetscCall(PetscArraycpy(state + r->n, r->W[k], r->n));
    state += 2 * r->n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RelaxationSetState(Relaxation *r, PetscInt n, const PetscReal state[])
{
  const PetscReal *end = state + n;

  PetscFunctionBegin;
  r->factor    = *state++;
  r->n_columns = (PetscInt)*state++;
  PetscCheck(r->n_columns >= 0 && r->n_columns <= RELAXATION_COLUMNS && end - state == r->n_columns * (1 + 2 * r->n), PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ,
             "a state of %" PetscInt_FMT " numbers does not fit %" PetscInt_FMT " unknowns", n, r->n);
  for (PetscInt k = 0; k < r->n_columns; k++) {
    if (!r->V[k]) PetscCall(PetscMalloc3(r->n, &r->V[k], r->n, &r->W[k], r->n, &r->Q[k]));
    r->age[k] = (PetscInt)*state++;
    PetscCall(PetscArraycpy(r->V[k], state, r->n));
    PetscCall(PetscArraycpy(r->W[k], state + r->n, r->n));
    state += 2 * r->n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
