/* sph_cuda.h - the pair loops on a GPU in single precision: raw pointers to device memory, no PETSc. Layouts are those of SPHLoops.
   Every function starts one kernel on the default stream and returns a CUDA status, 0 = done. */
#ifndef BY_SPH_CUDA_H
#define BY_SPH_CUDA_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  int        n;                 /* particles                                 */
  int        kernel, gradient_kernel; /* SPHKernelType of density, of gradients */
  double     h, mass;           /* [m], [kg]                                 */
  double     period[3];         /* [m], 0 = not periodic                     */
  const int *start, *count;     /* n                                         */
  const int *neighbour;         /* slots                                     */
  float     *gradient;          /* 3 per slot: m grad W_ij [kg/m^4]          */
} SPHDeviceList;

/* gradients of all pairs, density[i] = sum_j m W_ij with i itself; x: n x 3 [m] in double */
int SPHDensity_CUDA(const SPHDeviceList *list, const double x[], double density[]);

/* a[4 i] = -D^T p: p [n], G and a [4 per particle] */
int SPHAcceleration_CUDA(const SPHDeviceList *list, const float p[], const float G[], float a[]);

/* rate[i] = factor (D a)_i */
int SPHRate_CUDA(const SPHDeviceList *list, const float a[], const float G[], double factor, double rate[]);

#ifdef __cplusplus
}
#endif

#endif
