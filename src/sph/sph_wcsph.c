/* sph_wcsph.c - weakly compressible SPH [Monaghan 1994; Becker & Teschner 2007]. Not in this version: SPHSetUp() refuses it. */
#include "sph_impl.h"

const SPHSolverOps SPHSolverWCSPH = {.name = "wcsph"};
