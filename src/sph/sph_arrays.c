/* sph_arrays.c - every array that has a place for each particle: made once, they grow together when the fluid does. */
#include "sph_impl.h"

/* room for sph->capacity elements in an array, those beyond `used` zero */
static PetscErrorCode Resize(SPH sph, SPHArray *a, PetscInt used)
{
  PetscFunctionBegin;
  PetscCall(PetscRealloc(a->bytes * (size_t)sph->capacity, a->array));
  PetscCall(PetscMemzero((char *)*a->array + a->bytes * (size_t)used, a->bytes * (size_t)(sph->capacity - used)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  SPHAddArray_Internal - make an array with `bytes` for each particle, zero; it grows with the fluid and is freed with it

  field: address of the pointer in the fluid's struct (or its solver's data). Two such pointers may change places.
*/
PetscErrorCode SPHAddArray_Internal(SPH sph, void *field, size_t bytes)
{
  SPHArray *a = &sph->array[sph->n_arrays];

  PetscFunctionBegin;
  PetscCheck(sph->n_arrays < SPH_ARRAYS_MAX, PETSC_COMM_SELF, PETSC_ERR_PLIB, "more than %d arrays of particles", SPH_ARRAYS_MAX);
  a->array  = (void **)field;
  a->bytes  = bytes;
  *a->array = NULL;
  sph->n_arrays++;
  if (sph->capacity) PetscCall(Resize(sph, a, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* room for n particles, by half more than now when it does not suffice; what the arrays hold stays */
PetscErrorCode SPHReserve_Internal(SPH sph, PetscInt n)
{
  const PetscInt old = sph->capacity;

  PetscFunctionBegin;
  if (n <= old) PetscFunctionReturn(PETSC_SUCCESS);
  sph->capacity = old ? PetscMax(n, old + old / 2) : n;
  for (PetscInt k = 0; k < sph->n_arrays; k++) PetscCall(Resize(sph, &sph->array[k], old));
  PetscCall(PetscRealloc(sizeof(PetscReal) * SPH_SUMS * (size_t)SPH_CHUNKS(sph->capacity), &sph->partial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHFreeArrays_Internal(SPH sph)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < sph->n_arrays; k++) PetscCall(PetscFree(*sph->array[k].array));
  PetscCall(PetscFree(sph->partial));
  sph->n_arrays = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
