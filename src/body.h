/* body.h - marks for formulas that compile for CPU and GPU alike: C11 that is also C++17, no PETSc here. */
#ifndef BY_BODY_H
#define BY_BODY_H

#include <math.h>

#ifdef __CUDACC__
  #define BY_HD static __host__ __device__ inline
#else
  #define BY_HD static inline
#endif

#if defined(__cplusplus)
  #define BY_RESTRICT __restrict__
#else
  #define BY_RESTRICT restrict
#endif

#define BY_PI 3.14159265358979323846

#endif
