/* sph_closed.c - plain conjugate gradients: pressure of either sign, for a domain without a free surface (-sph_free_surface false).
   The operator is not singular there: a uniform pressure moves the first layer at a wall, which answers with p_i G_i alone. */
#include <math.h>

#include "sph_impl.h"

/* sums[] = g . g, sum |g|/S [kg/m^3], particles that take part */
static void Residual(SPH sph, PetscReal sums[3])
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal *s = sph->partial + c * SPH_SUMS, s0 = 0, s1 = 0, s2 = 0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      if (sph->scale[i] == 0.0) continue;
      s0 += sph->residual[i] * sph->residual[i];
      s1 += PetscAbsReal(sph->residual[i]) / sph->scale[i];
      s2 += 1.0;
    }
    s[0] = s0;
    s[1] = s1;
    s[2] = s2;
  }
  SPHSumPartials(sph, 3, sums);
}

/* d . A d */
static PetscReal Curvature(SPH sph)
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  PetscReal sum;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s = 0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) s += sph->direction[i] * sph->Adirection[i];
    sph->partial[c * SPH_SUMS] = s;
  }
  SPHSumPartials(sph, 1, &sum);
  return sum;
}

PetscErrorCode SPHSolveCG_Internal(SPH sph, const SPHOperator *op)
{
  const int       n         = (int)sph->n;
  const PetscReal tolerance = sph->params.tolerance * sph->params.density;
  PetscReal       old       = 0.0;

  PetscFunctionBegin;
  sph->converged = PETSC_FALSE;
  PetscCall(SPHApply_Internal(sph, op, sph->y, sph->residual));
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    sph->residual[i] -= sph->rhs[i];
    sph->direction[i] = 0.0;
  }
  for (;;) {
    PetscReal sums[3], dAd;

    Residual(sph, sums);
    if (!(sums[1] > tolerance * sums[2])) {
      sph->converged = (PetscBool)isfinite(sums[1]);
      break;
    }
    if (sph->iterations >= sph->params.max_iterations) break;
    const PetscReal gamma = old > 0 ? sums[0] / old : 0.0;
    old                   = sums[0];
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++) sph->direction[i] = sph->residual[i] + gamma * sph->direction[i];
    PetscCall(SPHApply_Internal(sph, op, sph->direction, sph->Adirection));
    dAd = Curvature(sph);
    if (!(dAd > 0)) break;
    const PetscReal step = sums[0] / dAd;
#pragma omp parallel for schedule(static)
    for (int i = 0; i < n; i++) {
      sph->y[i] -= step * sph->direction[i];
      sph->residual[i] -= step * sph->Adirection[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
