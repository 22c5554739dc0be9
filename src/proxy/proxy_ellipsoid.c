/* proxy_ellipsoid.c - volumes of ellipsoid proxies (method 4.3). */
#include "proxy/proxy_impl.h"
#include "proxy/proxy_grid.h"

/* V_b = factor / sum_k W_b(x_k - x_b), k over the proxies of the body, itself included: Psi_b/rho0 of [Akinci12] eq. 4 with the
   ellipsoid of proxy b. */
PetscErrorCode ProxyEllipsoidVolumes(int kernel, double h, double factor, PetscInt n, ProxyPoint points[])
{
  PointGrid  grid;
  PetscReal *x;
  double     reach = h;

  PetscFunctionBegin;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(3*n, &x));
  for (PetscInt i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++) x[3*i + k] = points[i].x[k];
    reach = PetscMax(reach, PetscMax(points[i].radius[0], points[i].radius[1]));
  }
  PetscCall(PointGridCreate(n, x, reach, n, &grid));
  for (PetscInt i = n - 1; i >= 0; i--) PointGridAdd(&grid, i, &x[3*i]);
#pragma omp parallel for schedule(dynamic, 64)
  for (PetscInt i = 0; i < n; i++) {
    PetscInt at[3];
    double   sum = 0.0;
    PointGridIndex(&grid, &x[3*i], at);
    for (PetscInt z = PetscMax(0, at[2] - 1); z <= PetscMin(grid.dims[2] - 1, at[2] + 1); z++) {
      for (PetscInt y = PetscMax(0, at[1] - 1); y <= PetscMin(grid.dims[1] - 1, at[1] + 1); y++) {
        for (PetscInt w = PetscMax(0, at[0] - 1); w <= PetscMin(grid.dims[0] - 1, at[0] + 1); w++) {
          for (PetscInt j = grid.head[(z*grid.dims[1] + y)*grid.dims[0] + w]; j >= 0; j = grid.next[j]) {
            double r[3];
            Sub3(&x[3*j], &x[3*i], r);
            sum += ProxyEllipsoidW(kernel, kernel, h, &points[i], r, NULL);
          }
        }
      }
    }
    points[i].weight = factor/sum;
  }
  PetscCall(PointGridDestroy(&grid));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
