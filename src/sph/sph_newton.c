/* sph_newton.c - projected Newton steps with conjugate residuals for the bound-constrained pressure.

   Minimise E(y) = 1/2 y A y - b y over y >= 0 (scaled as in sph_pressure.c). With the gradient g = A y - b
     held  = {y = 0 and g >= 0}                 pressure is zero and is not wanted
     A_ff d = -g_f                              on the rest, by conjugate residuals [Stiefel, Comment. Math. Helv. 29 (1955) 157], |g_f| least of all d in the Krylov space
     y = max(0, y + t d),  t = 1, 1/4, 1/16     the first that lowers E, else a projected gradient step: its decrease is proven
   [Bertsekas, SIAM J. Control Optim. 20 (1982) 221; with a full step the primal-dual active set iteration, Hintermueller, Ito & Kunisch, SIAM J. Optim. 13
   (2002) 865]. While the held set changes |g_f| is reduced tenfold at a time, then by what is missing. g of all particles follows along with d; only
   where a step was cut off is it summed afresh. Against MPRGP (sph_mprgp.c) a third fewer applications where water moves: what is measured, mean |g|, is what
   residuals in place of energies minimise, and particles leave and join the free set together (docs/verification/fluid.md). */
#include <math.h>

#include "sph_impl.h"

#define SPH_NEWTON_GAIN 0.1 /* of a solve while the held set changes */

/* what a gradient says about the solution it belongs to */
typedef struct {
  PetscReal residual; /* sum of |projected gradient| / S [kg/m^3] */
  PetscReal count;    /* particles with pressure or wanting it    */
  PetscReal energy;   /* E                                        */
} State;

static State Measure(SPH sph)
{
  const int        n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal *ys = sph->y, *gs = sph->residual, *root = sph->root, *rhs = sph->rhs;
  PetscReal        sums[3];
  State            s;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s0 = 0, s1 = 0, s2 = 0;

#pragma omp simd reduction(+ : s0, s1, s2)
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal y = ys[i], g = gs[i], projected = y > 0 ? g : PetscMin(g, 0.0);

      s0 += PetscAbsReal(projected) * root[i];
      s1 += y > 0 || g < 0 ? 1.0 : 0.0;
      s2 += 0.5 * y * (g - rhs[i]);
    }
    sph->partial[c * SPH_SUMS]     = s0;
    sph->partial[c * SPH_SUMS + 1] = s1;
    sph->partial[c * SPH_SUMS + 2] = s2;
  }
  SPHSumPartials(sph, 3, sums);
  s.residual = sums[0];
  s.count    = sums[1];
  s.energy   = sums[2];
  return s;
}

/* residual[] = A y - b and what it says */
static PetscErrorCode Gradient(SPH sph, const SPHOperator *op, State *s)
{
  const int n = (int)sph->n;

  PetscFunctionBegin;
  PetscCall(SPHApply_Internal(sph, op, sph->y, sph->residual));
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->residual[i] -= sph->rhs[i];
  *s = Measure(sph);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* free[] = 1 on particles that are not held, 0 on the others; returns how many changed */
static int Hold(SPH sph, PetscReal free[])
{
  const int n       = (int)sph->n;
  int       changed = 0;

#pragma omp parallel for schedule(static) reduction(+ : changed)
  for (int i = 0; i < n; i++) {
    const PetscReal now = sph->y[i] > 0 || sph->residual[i] < 0 ? 1.0 : 0.0;
    changed += now != free[i];
    free[i] = now;
  }
  return changed;
}

/* out = A (free g); returns g_f . A g_f */
static PetscErrorCode ApplyFree(SPH sph, const SPHOperator *op, const PetscReal free[], PetscReal out[], PetscReal *gAg)
{
  const int        n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal *gs = sph->residual;
  PetscReal       *masked = sph->p_tilde;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) masked[i] = free[i] * gs[i];
  PetscCall(SPHApply_Internal(sph, op, masked, out));
#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s0 = 0;
#pragma omp simd reduction(+ : s0)
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) s0 += free[i] * gs[i] * out[i];
    sph->partial[c * SPH_SUMS] = s0;
  }
  SPHSumPartials(sph, 1, gAg);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* d = free g + beta d, Ad = Ag + beta Ad; returns |Ad|^2 on free particles */
static PetscReal Turn(SPH sph, const PetscReal free[], const PetscReal Ag[], PetscReal beta)
{
  const int        n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal *gs = sph->residual;
  PetscReal       *ds = sph->direction, *Ads = sph->Adirection, sum;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s0 = 0;
#pragma omp simd reduction(+ : s0)
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal d = free[i] * gs[i] + beta * ds[i], Ad = Ag[i] + beta * Ads[i];
      ds[i]  = d;
      Ads[i] = Ad;
      s0 += free[i] * Ad * Ad;
    }
    sph->partial[c * SPH_SUMS] = s0;
  }
  SPHSumPartials(sph, 1, &sum);
  return sum;
}

/* y -= step d, g -= step A d; sums[] = sum of |g|/S over free particles, how many of them became negative */
static void Move(SPH sph, const PetscReal free[], PetscReal step, PetscReal sums[2])
{
  const int        n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal *ds = sph->direction, *Ads = sph->Adirection, *root = sph->root;
  PetscReal       *ys = sph->y, *gs = sph->residual;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s0 = 0, s1 = 0;
#pragma omp simd reduction(+ : s0, s1)
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal y = ys[i] - step * ds[i], g = gs[i] - step * Ads[i];
      ys[i] = y;
      gs[i] = g;
      s0 += free[i] * PetscAbsReal(g) * root[i];
      s1 += y < 0 ? 1.0 : 0.0;
    }
    sph->partial[c * SPH_SUMS]     = s0;
    sph->partial[c * SPH_SUMS + 1] = s1;
  }
  SPHSumPartials(sph, 2, sums);
}

/* y and g from conjugate residuals until sum |g_f|/S is below `enough`; how many y are negative */
static PetscErrorCode ConjugateResiduals(SPH sph, const SPHOperator *op, const PetscReal free[], PetscReal Ag[], PetscReal enough, PetscReal *negative)
{
  PetscReal gAg, old = 0.0, beta = 0.0, sums[2];

  PetscFunctionBegin;
  *negative = 0.0;
  PetscCall(PetscArrayzero(sph->direction, sph->n));
  PetscCall(PetscArrayzero(sph->Adirection, sph->n));
  do {
    PetscCall(ApplyFree(sph, op, free, Ag, &gAg));
    if (!(gAg > 0)) break; // no curvature left
    beta                = old > 0 ? gAg / old : 0.0;
    old                 = gAg;
    const PetscReal Ad2 = Turn(sph, free, Ag, beta);
    if (!(Ad2 > 0)) break;
    Move(sph, free, gAg / Ad2, sums);
    *negative = sums[1];
  } while (sums[0] > enough && sph->iterations < sph->params.max_iterations);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = max(0, from + t (y - from)) with d = y - from taken beforehand */
static void Project(SPH sph, const PetscReal from[], PetscReal t, const PetscReal d[])
{
  const int n = (int)sph->n;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->y[i] = PetscMax(0.0, from[i] + t * d[i]);
}

/* y was cut off: to a point between `from` and it of lower energy, and its gradient */
static PetscErrorCode Descend(SPH sph, const SPHOperator *op, const PetscReal from[], PetscReal before, State *s)
{
  const int       n     = (int)sph->n;
  const PetscReal slack = 1e-7 * PetscAbsReal(before); // single precision knows E no better
  PetscReal      *d     = sph->direction;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) d[i] = sph->y[i] - from[i];
  for (PetscReal t = 1.0; t > 0.05; t *= 0.25) {
    Project(sph, from, t, d);
    PetscCall(Gradient(sph, op, s));
    if (s->energy <= before + slack) PetscFunctionReturn(PETSC_SUCCESS);
  }
  Project(sph, from, 0.0, d);
  PetscCall(Gradient(sph, op, s));
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) d[i] = sph->residual[i];
  Project(sph, from, -1.0 / (sph->norm * op->dt * op->dt), d);
  PetscCall(Gradient(sph, op, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHSolveNewton_Internal(SPH sph, const SPHOperator *op)
{
  const PetscReal tolerance = sph->params.tolerance * sph->params.density;
  PetscReal      *free = sph->accel, *from = sph->accel + sph->n, *Ag = sph->accel + 2 * sph->n, negative;
  State           s;

  PetscFunctionBegin;
  sph->converged = PETSC_FALSE;
  PetscCall(Gradient(sph, op, &s));
  for (PetscInt k = 0;; k++) {
    if (!(s.residual > tolerance * s.count)) {
      sph->converged = (PetscBool)isfinite(s.residual);
      break;
    }
    if (sph->iterations >= sph->params.max_iterations) break;
    const PetscReal before = s.energy, enough = 0.9 * tolerance * s.count;
    const PetscBool settled = (PetscBool)(Hold(sph, free) == 0 && k > 0);

    PetscCall(PetscArraycpy(from, sph->y, sph->n));
    PetscCall(ConjugateResiduals(sph, op, free, Ag, settled ? enough : PetscMax(enough, SPH_NEWTON_GAIN * s.residual), &negative));
    if (negative > 0) PetscCall(Descend(sph, op, from, before, &s));
    else s = Measure(sph);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
