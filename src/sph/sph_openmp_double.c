/* sph_openmp_double.c - the OpenMP loops in double precision */
#define SPH_REAL  double
#define SPH_TABLE SPHLoopsOpenMPDouble
#define SPH_LABEL "openmp double"
#include "sph_openmp_loops.h"
