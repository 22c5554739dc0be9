/* sph_isph.c - projection with a compact Laplacian for closed flows and flows with tension. Not in this version: SPHSetUp() refuses it. */
#include "sph_impl.h"

const SPHSolverOps SPHSolverISPH = {.name = "isph"};
