/* sph_mprgp.c - conjugate gradients for the bound-constrained pressure.

   Minimise 1/2 y A y - b y over y >= 0 (scaled as in sph_pressure.c) by modified proportioning with reduced gradient projections,
   MPRGP [Dostal & Schoeberl, Comput. Optim. Appl. 30 (2005) 23, algorithm 1]. With the gradient g = A y - b:
     phi  = g where y > 0                              free gradient
     beta = min(g, 0) where y = 0                      chopped gradient
     phi~ = min(y/alpha, phi)                          what a fixed step alpha < 2/|A| can use of phi
   A conjugate gradient step while it stays feasible; a step along beta when |beta|^2 > phi~ . phi, which frees particles that want
   pressure. Where a conjugate gradient step would leave y >= 0 it is taken in full and projected [Kruzik, Horak, Cermak, Pospisil &
   Pecha, Adv. Eng. Softw. 2020: "projected conjugate gradient step" in place of the expansion], and the search goes on along the
   conjugate direction as long as that still descends: 69 applications in the worst solve of still water instead of 187. If the energy
   did not fall, the plain expansion follows: a projected gradient step of length alpha, whose decrease is proven. */
#include <math.h>

#include "sph_impl.h"

typedef struct {
  PetscReal free, chopped; /* phi~ . phi and beta . beta            */
  PetscReal residual;      /* sum of |phi + beta| / S [kg/m^3]      */
  PetscReal count;         /* particles with pressure or wanting it */
  PetscReal overlap;       /* phi . A d                             */
} Measures;

/* y = max(0, y - step d), g -= step A d, exact while nothing is cut off, and what is then to be known of both; alpha is the fixed step */
static Measures Move(SPH sph, PetscReal step, PetscReal alpha)
{
  const int        n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal  per_alpha = 1.0 / alpha, *direction = sph->direction, *Adirection = sph->Adirection, *root = sph->root;
  PetscReal       *ys = sph->y, *gs = sph->residual, sums[5];
  Measures         m;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal *s = sph->partial + c * SPH_SUMS, s0 = 0, s1 = 0, s2 = 0, s3 = 0, s4 = 0;

#pragma omp simd reduction(+ : s0, s1, s2, s3, s4)
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal y = PetscMax(0.0, ys[i] - step * direction[i]), g = gs[i] - step * Adirection[i];
      const PetscReal free = y > 0 ? g : 0.0, chopped = y > 0 ? 0.0 : PetscMin(g, 0.0);

      ys[i] = y;
      gs[i] = g;
      s0 += PetscMin(y * per_alpha, free) * free;
      s1 += chopped * chopped;
      s2 += (PetscAbsReal(free) - chopped) * root[i];
      s3 += y > 0 || g < 0 ? 1.0 : 0.0;
      s4 += free * Adirection[i];
    }
    s[0] = s0;
    s[1] = s1;
    s[2] = s2;
    s[3] = s3;
    s[4] = s4;
  }
  SPHSumPartials(sph, 5, sums);
  m.free     = sums[0];
  m.chopped  = sums[1];
  m.residual = sums[2];
  m.count    = sums[3];
  m.overlap  = sums[4];
  return m;
}

/* direction = phi, or beta when `chopped` */
static void SetDirection(SPH sph, PetscBool chopped)
{
  const int n = (int)sph->n;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    const PetscReal g = sph->residual[i];
    sph->direction[i] = chopped ? (sph->y[i] > 0 ? 0.0 : PetscMin(g, 0.0)) : (sph->y[i] > 0 ? g : 0.0);
  }
}

/* g = A y - b */
static PetscErrorCode Gradient(SPH sph, const SPHOperator *op)
{
  const int n = (int)sph->n;

  PetscFunctionBegin;
  PetscCall(SPHApply_Internal(sph, op, sph->y, sph->residual));
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) sph->residual[i] -= sph->rhs[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sums[] = g . d, d . A d, d . d; returns the longest feasible step */
static PetscReal StepLengths(SPH sph, PetscReal sums[3])
{
  const int        n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal *ds = sph->direction, *Ads = sph->Adirection, *ys = sph->y, *gs = sph->residual;
  PetscReal        longest = PETSC_MAX_REAL;

#pragma omp parallel for schedule(static) reduction(min : longest)
  for (int c = 0; c < chunks; c++) {
    PetscReal *s = sph->partial + c * SPH_SUMS, s0 = 0, s1 = 0, s2 = 0, least = PETSC_MAX_REAL;

#pragma omp simd reduction(+ : s0, s1, s2) reduction(min : least)
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal d = ds[i], step = d > 0 ? ys[i] / d : PETSC_MAX_REAL;
      s0 += gs[i] * d;
      s1 += Ads[i] * d;
      s2 += d * d;
      least = step < least ? step : least;
    }
    s[0]    = s0;
    s[1]    = s1;
    s[2]    = s2;
    longest = PetscMin(longest, least);
  }
  SPHSumPartials(sph, 3, sums);
  return longest;
}

/* the projected gradient step y = max(0, y - alpha phi) */
static void Expand(SPH sph, PetscReal alpha)
{
  const int n = (int)sph->n;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++)
    if (sph->y[i] > 0) sph->y[i] = PetscMax(0.0, sph->y[i] - alpha * sph->residual[i]);
}

/* 1/2 y A y - b y = 1/2 y (g - b) */
static PetscReal Energy(SPH sph)
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  PetscReal energy;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s = 0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) s += 0.5 * sph->y[i] * (sph->residual[i] - sph->rhs[i]);
    sph->partial[c * SPH_SUMS] = s;
  }
  SPHSumPartials(sph, 1, &energy);
  return energy;
}

/* d = phi - gamma d where y > 0; with gamma = phi . A d / d . A d conjugate to the last direction. d = phi when that hardly descends */
static void Conjugate(SPH sph, PetscReal gamma)
{
  const int        n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal *ys = sph->y, *gs = sph->residual;
  PetscReal       *ds = sph->direction, sums[2];

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal *s = sph->partial + c * SPH_SUMS, s0 = 0, s1 = 0;

#pragma omp simd reduction(+ : s0, s1)
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscReal phi = ys[i] > 0 ? gs[i] : 0.0, d = ys[i] > 0 ? phi - gamma * ds[i] : 0.0;
      ds[i] = d;
      s0 += d * phi;
      s1 += phi * phi;
    }
    s[0] = s0;
    s[1] = s1;
  }
  SPHSumPartials(sph, 2, sums);
  if (sums[0] < 0.1 * sums[1]) SetDirection(sph, PETSC_FALSE);
}

/* Largest eigenvalue over dt^2 by power iteration, once: it hardly changes, and MPRGP raises it when it meets a larger quotient */
PetscErrorCode SPHFindNorm_Internal(SPH sph, const SPHOperator *op)
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);

  PetscFunctionBegin;
  if (sph->norm > 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 12; k++) {
    PetscReal sums[2];

    PetscCall(SPHApply_Internal(sph, op, sph->mode, sph->Adirection));
#pragma omp parallel for schedule(static)
    for (int c = 0; c < chunks; c++) {
      PetscReal s0 = 0, s1 = 0;
      for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
        s0 += sph->mode[i] * sph->mode[i];
        s1 += sph->Adirection[i] * sph->Adirection[i];
      }
      sph->partial[c * SPH_SUMS]     = s0;
      sph->partial[c * SPH_SUMS + 1] = s1;
    }
    SPHSumPartials(sph, 2, sums);
    if (!(sums[0] > 0 && sums[1] > 0)) break;
    sph->norm              = sqrt(sums[1] / sums[0]) / (op->dt * op->dt);
    const PetscReal factor = 1.0 / sqrt(sums[1]);
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++) sph->mode[i] = factor * sph->Adirection[i] + 1e-12;
  }
  sph->norm       = PetscMax(sph->norm, 1.0); // the diagonal of what is scaled: drops that touch nothing yet have no norm of their own
  sph->iterations = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* after a step that may have been cut off: the gradient afresh, and on along the conjugate direction if the energy fell, else the plain
   expansion */
static PetscErrorCode Project(SPH sph, const SPHOperator *op, PetscReal before, PetscReal dAd, PetscReal alpha, Measures *m)
{
  PetscFunctionBegin;
  PetscCall(Gradient(sph, op));
  if (Energy(sph) < before) {
    *m = Move(sph, 0.0, alpha);
    Conjugate(sph, m->overlap / dAd);
  } else {
    Expand(sph, alpha);
    PetscCall(Gradient(sph, op));
    *m = Move(sph, 0.0, alpha);
    SetDirection(sph, PETSC_FALSE);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHSolveMPRGP_Internal(SPH sph, const SPHOperator *op)
{
  const PetscReal dt2 = op->dt * op->dt, tolerance = sph->params.tolerance * sph->params.density;
  PetscReal       alpha = 1.7 / (sph->norm * dt2); // a power iteration comes from below: a tenth more is safe, 2/|A| is the limit
  Measures        m;

  PetscFunctionBegin;
  sph->converged = PETSC_FALSE;
  PetscCall(Gradient(sph, op));
  m = Move(sph, 0.0, alpha);
  SetDirection(sph, PETSC_FALSE);
  for (;;) {
    const PetscBool up = (PetscBool)(m.chopped > m.free);
    PetscReal       sums[3], longest, step;

    if (!(m.residual > tolerance * m.count)) {
      sph->converged = (PetscBool)isfinite(m.residual);
      break;
    }
    if (sph->iterations >= sph->params.max_iterations) break;
    if (up) SetDirection(sph, PETSC_TRUE);
    PetscCall(SPHApply_Internal(sph, op, sph->direction, sph->Adirection));
    longest = StepLengths(sph, sums);
    if (!(sums[1] > 0)) break; // no curvature: nothing to gain along this direction

    // the quotient of any direction bounds the norm from below
    sph->norm = PetscMax(sph->norm, sums[1] / sums[2] / dt2);
    alpha     = 1.7 / (sph->norm * dt2);
    step      = sums[0] / sums[1];
    if (!up && step > longest) {
      const PetscReal before = Energy(sph);
      (void)Move(sph, step, alpha);
      PetscCall(Project(sph, op, before, sums[1], alpha, &m));
    } else {
      m = Move(sph, step, alpha);
      if (up) SetDirection(sph, PETSC_FALSE);
      else Conjugate(sph, m.overlap / sums[1]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
