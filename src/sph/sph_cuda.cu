/* sph_cuda.cu - the pair loops on a GPU: one thread gathers one particle's neighbours in the order of its list, so that there are no
   atomics and every run gives the same bits. The formulas are those of sph_pair.h. */
#define SPH_REAL float
#include "sph_cuda.h"

#include "sph_pair.h"

#define THREADS 128 /* per block: enough blocks for a few thousand particles, and registers to spare */

static __global__ void Density(SPHDeviceList l, const double *x, double *density)
{
  const int i = blockIdx.x * blockDim.x + threadIdx.x;

  if (i >= l.n) return;
  const float h = (float)l.h, mass = (float)l.mass;
  double      sum = (double)SPHPairDensity(l.kernel, mass, 0.0f, h);

  for (int k = l.start[i]; k < l.start[i] + l.count[i]; k++) {
    const int j = l.neighbour[k];
    float     d[3], r2 = 0.0f;

    for (int a = 0; a < 3; a++) {
      double dx = x[3*i + a] - x[3*j + a];
      if (l.period[a] > 0.0) dx -= l.period[a] * rint(dx / l.period[a]);
      d[a] = (float)dx;
      r2 += d[a] * d[a];
    }
    const float r = sqrtf(r2), f = SPHPairGradient(l.gradient_kernel, mass, r, h);
    for (int a = 0; a < 3; a++) l.gradient[3 * (size_t)k + a] = f * d[a];
    sum += (double)SPHPairDensity(l.kernel, mass, r, h);
  }
  density[i] = sum;
}

static __global__ void Acceleration(SPHDeviceList l, const float *p, const float *G, float *a)
{
  const int i = blockIdx.x * blockDim.x + threadIdx.x;

  if (i >= l.n) return;
  const float pi = p[i];
  float       sum[3] = {0.0f, 0.0f, 0.0f};

  for (int k = l.start[i]; k < l.start[i] + l.count[i]; k++) {
    const float s = SPHPairPressure(pi, p[l.neighbour[k]]);
    for (int c = 0; c < 3; c++) sum[c] += s * l.gradient[3 * (size_t)k + c];
  }
  for (int c = 0; c < 3; c++) a[4 * (size_t)i + c] = -sum[c] - pi * G[4 * (size_t)i + c];
  a[4 * (size_t)i + 3] = 0.0f;
}

static __global__ void Rate(SPHDeviceList l, const float *a, const float *G, double factor, double *rate)
{
  const int   i = blockIdx.x * blockDim.x + threadIdx.x;
  const float none[3] = {0.0f, 0.0f, 0.0f};

  if (i >= l.n) return;
  const float *ai  = a + 4 * (size_t)i;
  float        sum = SPHPairRate(ai, none, G + 4 * (size_t)i); // the wall at rest

  for (int k = l.start[i]; k < l.start[i] + l.count[i]; k++) sum += SPHPairRate(ai, a + 4 * (size_t)l.neighbour[k], l.gradient + 3 * (size_t)k);
  rate[i] = factor * (double)sum;
}

static int Blocks(int n) { return (n + THREADS - 1) / THREADS; }

extern "C" int SPHDensity_CUDA(const SPHDeviceList *list, const double x[], double density[])
{
  Density<<<Blocks(list->n), THREADS>>>(*list, x, density);
  return (int)cudaGetLastError();
}

extern "C" int SPHAcceleration_CUDA(const SPHDeviceList *list, const float p[], const float G[], float a[])
{
  Acceleration<<<Blocks(list->n), THREADS>>>(*list, p, G, a);
  return (int)cudaGetLastError();
}

extern "C" int SPHRate_CUDA(const SPHDeviceList *list, const float a[], const float G[], double factor, double rate[])
{
  Rate<<<Blocks(list->n), THREADS>>>(*list, a, G, factor, rate);
  return (int)cudaGetLastError();
}
