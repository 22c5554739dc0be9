/* array.h - an array on host and device that knows which copy is valid; the only caller of cudaMalloc and cudaMemcpy.
   Without CUDA only the host side exists and nothing is paid for the other. */
#ifndef BY_ARRAY_H
#define BY_ARRAY_H

#include "base.h"

typedef struct {
  size_t n, element;              /* number of elements, bytes of one                      */
  size_t capacity;                /* elements allocated (grows by half, never shrinks)     */
  void  *host, *device;           /* 64-byte aligned host memory; device memory or NULL    */
  int    host_valid, device_valid;
} Array;

BY_EXTERN PetscErrorCode ArrayCreate(size_t element, size_t n, Array *array);
/* contents are kept up to min(old, new) when `keep`, else undefined */
BY_EXTERN PetscErrorCode ArrayResize(Array *array, size_t n, PetscBool keep);
BY_EXTERN PetscErrorCode ArrayDestroy(Array *array);
/* access: Read makes the copy valid; Write makes it valid and the other stale; Overwrite skips the copy */
BY_EXTERN PetscErrorCode ArrayHostRead(Array *array, const void *p);      /* p: address of a const pointer */
BY_EXTERN PetscErrorCode ArrayHostWrite(Array *array, void *p);           /* p: address of a pointer       */
BY_EXTERN PetscErrorCode ArrayHostOverwrite(Array *array, void *p);
BY_EXTERN PetscErrorCode ArrayDeviceRead(Array *array, const void *p);
BY_EXTERN PetscErrorCode ArrayDeviceWrite(Array *array, void *p);
BY_EXTERN PetscErrorCode ArrayDeviceOverwrite(Array *array, void *p);

#endif
