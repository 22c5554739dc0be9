/* tled_device.h - the forces of all elements on a GPU: the passes of the CUDA loops (plain C, no PETSc) and the object that feeds
   them. Materials with a Prony series stay on the CPU. */
#ifndef BY_TLED_DEVICE_H
#define BY_TLED_DEVICE_H

#include "tled/tled_device_loops.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All pointers in `threads` are on the device; both return a CUDA status, 0 = done. */

/* start all threads of a pass, after those of the passes before it */
int TLEDPass_CUDA(const TLEDThreads *threads, int pass);
/* wait for the end of all passes */
int TLEDWait_CUDA(void);

#ifdef __cplusplus
}
#else

#include "tled/tled.h"

typedef struct _TLEDDevice *TLEDDevice;

/* runs all threads of a pass; 0 = done */
typedef int (*TLEDPassRun)(const TLEDThreads *threads, int pass);

/* Copy what the forces of `tled` (set up) need into arrays for the device.
   Errors: PETSC_ERR_SUP when a material has a Prony series */
BY_EXTERN PetscErrorCode TLEDDeviceCreate(TLED tled, TLEDDevice *device);
/* f(u) on the device; host arrays, n_nodes x 3. An inverted element is not looked for. PETSC_ERR_SUP without CUDA */
BY_EXTERN PetscErrorCode TLEDDeviceForces(TLEDDevice device, const PetscReal u[], PetscReal f[]);
/* the same passes over the same arrays on the host, run by `run`: whoever has no device checks the loops with it */
BY_EXTERN PetscErrorCode TLEDDeviceForcesOnHost(TLEDDevice device, TLEDPassRun run, const PetscReal u[], PetscReal f[]);
BY_EXTERN PetscErrorCode TLEDDeviceDestroy(TLEDDevice *device);
#endif

#endif
