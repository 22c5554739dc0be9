/* array.c - lazy copies between host and device; each side is allocated when it is first asked for. */
#include "array.h"

#include <stdlib.h>
#include <string.h>

/* a cache line, and the widest vector register */
#define ALIGNMENT 64

#if defined(BYSSUS_HAVE_CUDA)
#include <cuda_runtime_api.h>

static PetscErrorCode CheckCUDA(cudaError_t status, const char what[])
{
  PetscFunctionBegin;
  PetscCheck(status == cudaSuccess, PETSC_COMM_SELF, PETSC_ERR_GPU, "%s: %s", what, cudaGetErrorString(status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DeviceAllocate(size_t bytes, void **p)
{
  PetscFunctionBegin;
  PetscCall(CheckCUDA(cudaMalloc(p, bytes), "cudaMalloc"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DeviceFree(void **p)
{
  PetscFunctionBegin;
  if (*p) PetscCall(CheckCUDA(cudaFree(*p), "cudaFree"));
  *p = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DeviceCopy(void *to, const void *from, size_t bytes)
{
  PetscFunctionBegin;
  /* unified addressing tells which side each pointer is on */
  if (bytes) PetscCall(CheckCUDA(cudaMemcpy(to, from, bytes, cudaMemcpyDefault), "cudaMemcpy"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
#else
static PetscErrorCode DeviceAllocate(size_t bytes, void **p)
{
  PetscFunctionBegin;
  (void)bytes;
  (void)p;
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_SUP, "this program was built without CUDA");
}

static PetscErrorCode DeviceFree(void **p)
{
  *p = NULL;
  return PETSC_SUCCESS;
}

static PetscErrorCode DeviceCopy(void *to, const void *from, size_t bytes)
{
  memcpy(to, from, bytes);
  return PETSC_SUCCESS;
}
#endif

static PetscErrorCode HostAllocate(size_t bytes, void **p)
{
  PetscFunctionBegin;
  *p = aligned_alloc(ALIGNMENT, (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
  PetscCheck(*p, PETSC_COMM_SELF, PETSC_ERR_MEM, "cannot allocate %zu bytes", bytes);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void HostFree(void **p)
{
  free(*p);
  *p = NULL;
}

PetscErrorCode ArrayCreate(size_t element, size_t n, Array *array)
{
  PetscFunctionBegin;
  PetscCheck(element > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "elements of zero bytes");
  PetscCheck(n <= SIZE_MAX / 2 / element, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%zu elements of %zu bytes", n, element);
  memset(array, 0, sizeof *array);
  array->element  = element;
  array->n        = n;
  array->capacity = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArrayResize(Array *array, size_t n, PetscBool keep)
{
  const size_t old = array->n * array->element, grown = array->capacity + array->capacity / 2;
  void        *moved = NULL;

  PetscFunctionBegin;
  PetscCheck(n <= SIZE_MAX / 2 / array->element, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%zu elements of %zu bytes", n,
             array->element);
  if (!keep) array->host_valid = array->device_valid = 0;
  if (n > array->capacity) {
    const size_t capacity = PetscMax(n, grown);

    if (array->host && array->host_valid) {
      PetscCall(HostAllocate(capacity * array->element, &moved));
      memcpy(moved, array->host, old);
    }
    HostFree(&array->host);
    array->host = moved;
    moved       = NULL;
    if (array->device && array->device_valid) {
      PetscCall(DeviceAllocate(capacity * array->element, &moved));
      PetscCall(DeviceCopy(moved, array->device, old));
    }
    PetscCall(DeviceFree(&array->device));
    array->device   = moved;
    array->capacity = capacity;
  }
  array->n = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArrayDestroy(Array *array)
{
  PetscFunctionBegin;
  HostFree(&array->host);
  PetscCall(DeviceFree(&array->device));
  memset(array, 0, sizeof *array);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AllocateHost(Array *array)
{
  PetscFunctionBegin;
  if (!array->host && array->capacity) PetscCall(HostAllocate(array->capacity * array->element, &array->host));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AllocateDevice(Array *array)
{
  PetscFunctionBegin;
  if (!array->device && array->capacity) PetscCall(DeviceAllocate(array->capacity * array->element, &array->device));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* make the copy on the host current when the device has the newer one */
static PetscErrorCode UpdateHost(Array *array)
{
  PetscFunctionBegin;
  PetscCall(AllocateHost(array));
  if (!array->host_valid && array->device_valid) PetscCall(DeviceCopy(array->host, array->device, array->n * array->element));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode UpdateDevice(Array *array)
{
  PetscFunctionBegin;
  PetscCall(AllocateDevice(array));
  if (!array->device_valid && array->host_valid) PetscCall(DeviceCopy(array->device, array->host, array->n * array->element));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckWritten(const Array *array)
{
  PetscFunctionBegin;
  PetscCheck(array->host_valid || array->device_valid || !array->n, PETSC_COMM_SELF, PETSC_ERR_ORDER,
             "array read before it was written");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArrayHostRead(Array *array, const void *p)
{
  PetscFunctionBegin;
  PetscCall(CheckWritten(array));
  PetscCall(UpdateHost(array));
  array->host_valid = 1;
  *(const void **)p = array->host;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArrayHostWrite(Array *array, void *p)
{
  PetscFunctionBegin;
  PetscCall(UpdateHost(array));
  array->host_valid   = 1;
  array->device_valid = 0;
  *(void **)p         = array->host;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArrayHostOverwrite(Array *array, void *p)
{
  PetscFunctionBegin;
  PetscCall(AllocateHost(array));
  array->host_valid   = 1;
  array->device_valid = 0;
  *(void **)p         = array->host;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArrayDeviceRead(Array *array, const void *p)
{
  PetscFunctionBegin;
  PetscCall(CheckWritten(array));
  PetscCall(UpdateDevice(array));
  array->device_valid = 1;
  *(const void **)p   = array->device;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArrayDeviceWrite(Array *array, void *p)
{
  PetscFunctionBegin;
  PetscCall(UpdateDevice(array));
  array->device_valid = 1;
  array->host_valid   = 0;
  *(void **)p         = array->device;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ArrayDeviceOverwrite(Array *array, void *p)
{
  PetscFunctionBegin;
  PetscCall(AllocateDevice(array));
  array->device_valid = 1;
  array->host_valid   = 0;
  *(void **)p         = array->device;
  PetscFunctionReturn(PETSC_SUCCESS);
}
