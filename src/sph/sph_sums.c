/* sph_sums.c - sums over particles that are the same for every number of threads. */
#include "sph_impl.h"

/* Add up what a pass over the particles left in partial[chunk x SPH_SUMS], chunk by chunk in order. */
void SPHSumPartials(SPH sph, int n_sums, PetscReal sums[])
{
  const int chunks = (int)SPH_CHUNKS(sph->n);

  for (int k = 0; k < n_sums; k++) sums[k] = 0.0;
  for (int c = 0; c < chunks; c++)
    for (int k = 0; k < n_sums; k++) sums[k] += sph->partial[c * SPH_SUMS + k];
}
