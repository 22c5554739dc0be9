/* tled_cuda.cu - the passes of the element loops on a GPU: one thread per element, node or average. No formula here. */
#include "tled/tled_device.h"
#include <cuda_runtime.h>

#define THREADS 128 /* per block: enough to hide memory latency with the registers that a tetrahedron takes */

/* a kernel of its own for each pass, with the registers that this pass needs */
template <int pass> static __global__ void Pass(const __grid_constant__ TLEDThreads threads)
{
  const int k = blockIdx.x*blockDim.x + threadIdx.x;

  if (k < TLEDPassSize(&threads, pass)) TLEDThread(&threads, pass, k);
}

template <int pass> static int Launch(const TLEDThreads &threads)
{
  Pass<pass><<<(TLEDPassSize(&threads, pass) + THREADS - 1) / THREADS, THREADS>>>(threads);
  return (int)cudaGetLastError();
}

extern "C" int TLEDPass_CUDA(const TLEDThreads *threads, int pass)
{
  switch (pass) {
  case TLED_PASS_FORCES_T4: return Launch<TLED_PASS_FORCES_T4>(*threads);
  case TLED_PASS_VOLUMES: return Launch<TLED_PASS_VOLUMES>(*threads);
  case TLED_PASS_MEAN_VOLUME: return Launch<TLED_PASS_MEAN_VOLUME>(*threads);
  case TLED_PASS_PRESSURES: return Launch<TLED_PASS_PRESSURES>(*threads);
  case TLED_PASS_MEAN_PRESSURE: return Launch<TLED_PASS_MEAN_PRESSURE>(*threads);
  case TLED_PASS_FORCES_ANP: return Launch<TLED_PASS_FORCES_ANP>(*threads);
  case TLED_PASS_FORCES_T10: return Launch<TLED_PASS_FORCES_T10>(*threads);
  case TLED_PASS_GATHER: return Launch<TLED_PASS_GATHER>(*threads);
  default: return (int)cudaErrorInvalidValue;
  }
}

extern "C" int TLEDWait_CUDA(void) { return (int)cudaDeviceSynchronize(); }
