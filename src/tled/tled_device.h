/* tled_device.h - the T4 forces on a GPU: what the CUDA loops take (plain C, no PETSc) and the object that feeds them. */
#ifndef BY_TLED_DEVICE_H
#define BY_TLED_DEVICE_H

#include "tled/tled_material.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All pointers are on the device; each call returns a CUDA status, 0 = done. Lanes are those of TLEDBlocks, padding included. */

/* Forces of the elements, of the law material[lane / 8] with its fibres (NULL: no law has any), on their corners: corner_force[12 lane + 3 a + i] [N] at displacement u [m], n_nodes x 3. */
int TLEDElementForces_CUDA(const TLEDLaw laws[], const int material[], int n_lanes, const int corner[], const double G[],
                           const double V0[], const double fibre[], const double u[], double corner_force[]);

/* f[3 a + i] = sum of the corners list[offset[a]] ... list[offset[a+1] - 1] of node a, in that order: no atomics. Waits for the end. */
int TLEDGatherForces_CUDA(int n_nodes, const int offset[], const int list[], const double corner_force[], double f[]);

#ifdef __cplusplus
}
#else

#include "tled/tled.h"

typedef struct _TLEDDevice *TLEDDevice;

/* copy what the forces of `tled` (set up, element t4) need to the device; PETSC_ERR_SUP without CUDA */
BY_EXTERN PetscErrorCode TLEDDeviceCreate(TLED tled, TLEDDevice *device);
/* f(u) on the device; host arrays, n_nodes x 3 */
BY_EXTERN PetscErrorCode TLEDDeviceForces(TLEDDevice device, const PetscReal u[], PetscReal f[]);
BY_EXTERN PetscErrorCode TLEDDeviceDestroy(TLEDDevice *device);
#endif

#endif
