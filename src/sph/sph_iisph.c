/* sph_iisph.c - implicit incompressible SPH [Ihmsen et al., IEEE TVCG 20 (2014), doi:10.1109/TVCG.2013.105] on the system of sph_pressure.c:
   by projected Newton steps with conjugate residuals (sph_newton.c) or projected conjugate gradients (sph_mprgp.c; Dostal, Optimal Quadratic
   Programming Algorithms (2009) ch. 5), by plain ones where
   pressure may have either sign (sph_closed.c), by any KSP of PETSc (sph_ksp.c), or by the paper's relaxed Jacobi. */
#include "sph_impl.h"

static PetscErrorCode SolveGradients(SPH sph, const SPHOperator *op)
{
  PetscBool by_ksp;

  PetscFunctionBegin;
  SPHPrepare_Internal(sph, op->dt, 1.0);
  PetscCall(SPHFindNorm_Internal(sph, op));
  PetscCall(SPHWantsKSP_Internal(sph, &by_ksp));
  if (by_ksp) PetscCall(SPHSolveKSP_Internal(sph, op));
  else if (sph->params.free_surface && sph->params.bounded == SPH_BOUNDED_NEWTON) PetscCall(SPHSolveNewton_Internal(sph, op));
  else if (sph->params.free_surface) PetscCall(SPHSolveMPRGP_Internal(sph, op));
  else PetscCall(SPHSolveCG_Internal(sph, op));
  SPHStorePressure_Internal(sph);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Relaxed Jacobi of [IISPH sec. 3.2], omega = 1/2: p~ <- max(0, p~ + omega (b - A p~)/a_ii). Stops when the mean compression that
  would be left, mean max(0, b - A p~)/rho0, is below the tolerance, after at least two iterations.
*/
static PetscErrorCode SolveJacobi(SPH sph, const SPHOperator *op)
{
  const int       n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  const PetscReal omega = 0.5, dt2 = op->dt * op->dt;
  const PetscReal allowed = sph->params.tolerance * sph->params.density * (PetscReal)n;

  PetscFunctionBegin;
  SPHPrepare_Internal(sph, op->dt, 0.5);
  sph->converged = PETSC_FALSE;
  while (sph->iterations < sph->params.max_iterations) {
    PetscReal sum;

    PetscCall(SPHApply_Internal(sph, op, sph->y, sph->Adirection));
#pragma omp parallel for schedule(static)
    for (int c = 0; c < chunks; c++) {
      PetscReal left = 0.0;

      for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
        const PetscReal r = sph->rhs[i] - sph->Adirection[i];
        PetscReal       y = sph->y[i] + omega * r / dt2;

        if (sph->scale[i] > 0 && r > 0) left += r / sph->scale[i];
        if (sph->params.free_surface && y < 0) y = 0.0;
        sph->y[i] = y;
      }
      sph->partial[c * SPH_SUMS] = left;
    }
    SPHSumPartials(sph, 1, &sum);
    if (sph->iterations >= 2 && sum < allowed) {
      sph->converged = PETSC_TRUE;
      break;
    }
  }
  SPHStorePressure_Internal(sph);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHPackSolve_Internal(SPH sph)
{
  const SPHOperator op = {1.0, NULL, NULL, PETSC_FALSE};

  PetscFunctionBegin;
  SPHPrepare_Internal(sph, 1.0, 0.0);
  sph->iterations = 0;
  PetscCall(SPHFindNorm_Internal(sph, &op));
  PetscCall(SPHSolveMPRGP_Internal(sph, &op));
  SPHStorePressure_Internal(sph);
  ByCall(SPHCheckPressure_Internal(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SPHSolverOps SPHSolverIISPH       = {.name = "iisph", .tolerance = 1e-5, .relaxes = PETSC_TRUE, .responds = PETSC_TRUE, .Destroy = SPHDestroyKSP_Internal, .Solve = SolveGradients};
const SPHSolverOps SPHSolverIISPHJacobi = {.name = "iisph_jacobi", .tolerance = 1e-3, .responds = PETSC_TRUE, .Solve = SolveJacobi};
