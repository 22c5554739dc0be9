/* sph_pbf.c - position-based fluids [Macklin & Mueller, ACM TOG 32 (2013) 104]. Not in this version: SPHSetUp() refuses it. */
#include "sph_impl.h"

const SPHSolverOps SPHSolverPBF = {.name = "pbf"};
