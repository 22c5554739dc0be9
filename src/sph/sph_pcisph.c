/* sph_pcisph.c - predictive-corrective incompressible SPH [Solenthaler & Pajarola, ACM TOG 28 (2009) 40]. Not in this version: SPHSetUp() refuses it. */
#include "sph_impl.h"

const SPHSolverOps SPHSolverPCISPH = {.name = "pcisph"};
