/* tled_cuda.cu - the element loop on a GPU: one thread per element, then one per node. No formula here. */
#include "tled/tled_device.h"
#include "tled/tled_element.h"
#include <cuda_runtime.h>

#define LANES   8   /* TLED_LANES: elements side by side in the structures of arrays */
#define THREADS 128 /* per block: enough to hide memory latency with the registers that a tetrahedron takes */

static __global__ void ElementForces(const TLEDLaw *laws, const int *material, int n_lanes, const int *corner, const double *G,
                                     const double *V0, const double *fibre, const double *u, double *corner_force)
{
  const int l = blockIdx.x*blockDim.x + threadIdx.x, pack = l / LANES, lane = l % LANES;
  int       n[4];
  double    g[9], d[9], H[9], P[9], f[9], a[3] = {0.0, 0.0, 0.0};

  if (l >= n_lanes) return;
  for (int c = 0; c < 4; c++) n[c] = corner[(4*pack + c)*LANES + lane];
  for (int k = 0; k < 3 && fibre; k++) a[k] = fibre[(3*pack + k)*LANES + lane];
  for (int k = 0; k < 9; k++) g[k] = G[(9*pack + k)*LANES + lane];
  for (int c = 0; c < 3; c++) Sub3(&u[3*n[c + 1]], &u[3*n[0]], &d[3*c]);
  TLEDDisplacementGradient(d, g, H);
  const double jm1 = TLEDJacobianMinusOne(H);
  TLEDStress(&laws[material[pack]], a, H, TLEDLogJacobian(jm1), 1.0 / (1.0 + jm1), P);
  TLEDNodalForces(P, g, V0[l], f);
  for (int i = 0; i < 3; i++) corner_force[12*l + i] = -(f[i] + f[3 + i] + f[6 + i]);
  for (int k = 0; k < 9; k++) corner_force[12*l + 3 + k] = f[k];
}

static __global__ void GatherForces(int n_nodes, const int *offset, const int *list, const double *corner_force, double *f)
{
  const int a = blockIdx.x*blockDim.x + threadIdx.x;
  double    sum[3] = {0.0, 0.0, 0.0};

  if (a >= n_nodes) return;
  for (int k = offset[a]; k < offset[a + 1]; k++)
    for (int i = 0; i < 3; i++) sum[i] += corner_force[3*list[k] + i];
  for (int i = 0; i < 3; i++) f[3*a + i] = sum[i];
}

extern "C" int TLEDElementForces_CUDA(const TLEDLaw laws[], const int material[], int n_lanes, const int corner[],
                                      const double G[], const double V0[], const double fibre[], const double u[], double corner_force[])
{
  ElementForces<<<(n_lanes + THREADS - 1) / THREADS, THREADS>>>(laws, material, n_lanes, corner, G, V0, fibre, u, corner_force);
  return (int)cudaGetLastError();
}

extern "C" int TLEDGatherForces_CUDA(int n_nodes, const int offset[], const int list[], const double corner_force[], double f[])
{
  GatherForces<<<(n_nodes + THREADS - 1) / THREADS, THREADS>>>(n_nodes, offset, list, corner_force, f);
  const cudaError_t status = cudaGetLastError();
  return (int)(status == cudaSuccess ? cudaDeviceSynchronize() : status);
}
