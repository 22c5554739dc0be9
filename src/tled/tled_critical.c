/* tled_critical.c - the critical time step 2/omega_max, by an accelerated power iteration on M^-1 K. */
#include "tled/tled_impl.h"
#include <petscblaslapack.h>

#define CHANGE 1e-4 /* of omega^2 in one step, at which the iteration has settled */
#define N_CALM 3    /* that many calm steps in a row                              */

/* (x, y) with the masses (n_nodes); held directions have zeros */
static PetscReal MassDot(TLED tled, const PetscReal mass[], const PetscReal x[], const PetscReal y[])
{
  PetscReal sum = 0.0;

  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++)
    sum += mass[a] * (x[3 * a] * y[3 * a] + x[3 * a + 1] * y[3 * a + 1] + x[3 * a + 2] * y[3 * a + 2]);
  return sum;
}

static void Axpy(PetscInt n, PetscReal c, const PetscReal x[], PetscReal y[])
{
  for (PetscInt k = 0; k < n; k++) y[k] += c * x[k];
}

/* y = M^-1 K(u) x by a central difference of the forces, exact tangent to about ten digits: the step moves no node by more than
   1e-6 of the element size */
static PetscErrorCode ApplyTangent(TLED tled, const PetscReal mass[], const PetscReal u[], const PetscReal x[], PetscReal y[])
{
  const PetscInt n   = 3 * tled->mesh.n_nodes;
  PetscReal      top = 0.0, eps;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; k++) top = PetscMax(top, PetscAbsReal(x[k]));
  eps = 1e-6 * PetscPowReal(tled->volume / (PetscReal)tled->mesh.n_tets, 1.0 / 3.0) / top;
  for (PetscInt k = 0; k < n; k++) tled->probe[k] = u[k] + eps * x[k];
  ByCall(TLEDForces_Private(tled, tled->probe, y));
  for (PetscInt k = 0; k < n; k++) tled->probe[k] = u[k] - eps * x[k];
  ByCall(TLEDForces_Private(tled, tled->probe, tled->trial));
  for (PetscInt k = 0; k < n; k++) y[k] = (y[k] - tled->trial[k]) / (2.0 * eps * mass[k / 3]);
  PetscCall(TLEDProject_Private(tled, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a start vector with a part of every mode: the same numbers on every machine (a linear congruential sequence) */
static PetscErrorCode StartVector(TLED tled, PetscReal x[])
{
  unsigned seed = 12345u;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3 * tled->mesh.n_nodes; k++) {
    seed = 1664525u * seed + 1013904223u;
    x[k] = (PetscReal)(seed >> 8) / 16777216.0 - 0.5;
  }
  PetscCall(TLEDProject_Private(tled, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Make w[k] mass-orthonormal to w[0..k-1], its image aw[k] along with it; returns 0 when nothing is left. */
static PetscBool Orthonormalise(TLED tled, const PetscReal mass[], PetscInt k, PetscReal *w[], PetscReal *aw[])
{
  const PetscInt  n      = 3 * tled->mesh.n_nodes;
  const PetscReal before = MassDot(tled, mass, w[k], w[k]);
  PetscReal       norm   = before;

  if (!(before > 0.0)) return PETSC_FALSE;
  for (PetscInt pass = 0; pass < 2; pass++) {
    for (PetscInt j = 0; j < k; j++) {
      const PetscReal c = MassDot(tled, mass, w[j], w[k]);
      Axpy(n, -c, w[j], w[k]);
      if (aw[k]) Axpy(n, -c, aw[j], aw[k]);
    }
    norm = MassDot(tled, mass, w[k], w[k]);
    if (!(norm > 1e-20 * before)) return PETSC_FALSE;
  }
  norm = 1.0 / PetscSqrtReal(norm);
  for (PetscInt i = 0; i < n; i++) w[k][i] *= norm;
  for (PetscInt i = 0; i < n && aw[k]; i++) aw[k][i] *= norm;
  return PETSC_TRUE;
}

/* largest eigenvalue and its vector c of the m x m symmetric matrix (w_i, A w_j) */
static PetscErrorCode RayleighRitz(TLED tled, const PetscReal mass[], PetscInt m, PetscReal *w[], PetscReal *aw[], PetscReal *top,
                                   PetscReal c[3])
{
  PetscScalar  B[9], values[3], work[16];
  PetscBLASInt n = (PetscBLASInt)m, n_work = 16, info;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j <= i; j++) B[m * i + j] = B[m * j + i] = MassDot(tled, mass, w[i], aw[j]);
  LAPACKsyev_("V", "U", &n, B, &n, values, work, &n_work, &info);
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK syev failed with info %d", (int)info);
  *top = values[m - 1];
  for (PetscInt i = 0; i < m; i++) c[i] = B[m * (m - 1) + i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDHighestMode_Private - largest eigenvalue omega^2 of M^-1 K at displacement u, and its mode

  Input Parameters:
+ tled    - set up
. mass    - M, n_nodes [kg], not necessarily the body's own
. u       - displacement [m], n_nodes x 3
- n_steps - at most that many steps

  Input/Output Parameter:
. mode - start vector, zero for none; the mode, of unit mass norm, n_nodes x 3

  Output Parameter:
. top - omega^2 [1/s^2], 0 when no node is free

  The power iteration x <- M^-1 K x with the best combination of x, the new direction and the last one in each step (locally optimal
  gradient method): the estimate of omega rises to omega_max with the square root of the iterations that the plain method takes.
  Ended when omega^2 grows by less than 1e-4 in three steps running.

  Errors: BY_ERR_BREAKDOWN, not reported, when an element of u is inverted

  Reference: A. V. Knyazev, SIAM J. Sci. Comput. 23 (2001) 517, doi:10.1137/S1064827500366124, algorithm 4.1 with one vector
  Tests: tests/unit/tled/test_critical.c
*/
PetscErrorCode TLEDHighestMode_Private(TLED tled, const PetscReal mass[], const PetscReal u[], PetscInt n_steps, PetscReal mode[],
                                       PetscReal *top)
{
  const PetscInt n = 3 * tled->mesh.n_nodes;
  PetscReal     *k = tled->krylov, *w[3] = {mode, k, k + n}, *aw[3] = {k + 2 * n, k + 3 * n, k + 4 * n}, *none[3] = {NULL, NULL, NULL};
  PetscReal      last, c[3];
  PetscInt       calm = 0, m = 1;

  PetscFunctionBegin;
  *top = 0.0;
  if (!Orthonormalise(tled, mass, 0, w, none)) {
    PetscCall(StartVector(tled, w[0]));
    if (!Orthonormalise(tled, mass, 0, w, none)) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscLogEventBegin(TLED_EVENT_CRITICAL, tled, 0, 0, 0));
  ByCall(ApplyTangent(tled, mass, u, w[0], aw[0]));
  *top = MassDot(tled, mass, w[0], aw[0]);
  for (PetscInt step = 0; step < n_steps && calm < N_CALM; step++) {
    /* residual as the new direction; it goes into slot 1, the last direction lives in slot 2 */
    for (PetscInt i = 0; i < n; i++) w[1][i] = aw[0][i] - *top * w[0][i];
    if (!Orthonormalise(tled, mass, 1, w, none)) break;
    ByCall(ApplyTangent(tled, mass, u, w[1], aw[1]));
    if (m == 3 && !Orthonormalise(tled, mass, 2, w, aw)) m = 2;
    last = *top;
    PetscCall(RayleighRitz(tled, mass, PetscMax(m, 2), w, aw, top, c));
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal p = c[1] * w[1][i] + (m == 3 ? c[2] * w[2][i] : 0.0), ap = c[1] * aw[1][i] + (m == 3 ? c[2] * aw[2][i] : 0.0);
      w[0][i] = c[0] * w[0][i] + p, aw[0][i] = c[0] * aw[0][i] + ap;
      w[2][i] = p, aw[2][i] = ap;
    }
    m    = 3;
    calm = *top - last < CHANGE * *top ? calm + 1 : 0;
  }
  PetscCall(PetscLogEventEnd(TLED_EVENT_CRITICAL, tled, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 2/omega_max [s] of the body at displacement u, from the mode of the last call; PETSC_MAX_REAL when no node is free. Errors as above. */
PetscErrorCode TLEDCriticalStep_Private(TLED tled, const PetscReal u[], PetscInt n_steps, PetscReal *dt)
{
  PetscReal top;

  PetscFunctionBegin;
  ByCall(TLEDHighestMode_Private(tled, tled->mass, u, n_steps, tled->mode, &top));
  *dt = top > 0.0 ? 2.0 / PetscSqrtReal(top) : PETSC_MAX_REAL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
