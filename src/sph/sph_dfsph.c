/* sph_dfsph.c - divergence-free SPH [Bender & Koschier, IEEE TVCG 23 (2017)]. Not in this version: SPHSetUp() refuses it. */
#include "sph_impl.h"

const SPHSolverOps SPHSolverDFSPH = {.name = "dfsph"};
