/* sph_openmp_single.c - the OpenMP loops in single precision */
#define SPH_REAL  float
#define SPH_TABLE SPHLoopsOpenMPSingle
#define SPH_LABEL "openmp single"
#include "sph_openmp_loops.h"
