/* sph_keys.c - the keys of the section `sph:` */
#include "sph.h"

static const char *const Solvers[]    = {"auto", "iisph", "iisph_jacobi", "isph", "dfsph", "pcisph", "pbf", "wcsph", NULL};
static const char *const Kernels[]    = {"cubic_spline", "wendland_c2", "poly6", "spiky", NULL};
static const char *const Gradients[]  = {"same", "cubic_spline", "wendland_c2", "poly6", "spiky", NULL};
static const char *const Norms[]      = {"auto", "mean", "largest", NULL};
static const char *const Viscous[]    = {"morris", "monaghan", NULL};
static const char *const Bounded[]    = {"newton", "mprgp", NULL};
static const char *const Stepping[]   = {"auto", "explicit", "implicit", NULL};
static const char *const Precisions[] = {"single", "double", NULL};

#define FIELD(f) offsetof(SPHParams, f)

const Key SPHKeys[] = {
  {"spacing", KEY_REAL, FIELD(spacing), "m", "", 0, 1e3, KEY_LO_OPEN | KEY_REQUIRED, NULL, "initial distance between fluid particles"},
  {"density", KEY_REAL, FIELD(density), "kg/m^3", "1000", 0, 1e6, KEY_LO_OPEN, NULL, "rest density of the fluid"},
  {"viscosity", KEY_REAL, FIELD(viscosity), "Pa s", "0", 0, 1e6, 0, NULL, "dynamic viscosity; 0 = inviscid, walls slip"},
  {"support", KEY_REAL, FIELD(support), "1", "2", 1.5, 3, 0, NULL, "support radius of the kernel over spacing"},
  {"tolerance", KEY_REAL, FIELD(tolerance), "1", "0", 0, 0.1, 0, NULL, "mean residual of the pressure solve over density (iisph_jacobi: mean compression); 0 = 1e-5, with iisph_jacobi 1e-3, pcisph 1e-2, dfsph 1e-4, pbf 1e-3"},
  {"tolerance_norm", KEY_CHOICE, FIELD(tolerance_norm), "", "auto", 0, 0, 0, Norms, "compression that tolerance bounds with pcisph, dfsph, pbf; auto = largest with pcisph, else mean"},
  {"gamma", KEY_REAL, FIELD(gamma), "1", "7", 1, 10, 0, NULL, "wcsph: exponent of the equation of state; 1 = plain, p = c^2 (rho - rho0)"},
  {"sound_speed", KEY_REAL, FIELD(sound_speed), "m/s", "0", 0, 1e4, 0, NULL,
   "wcsph: speed of sound; 0 = 10 sqrt(v^2 + 2 g H), v the largest initial speed, H from the highest water to the domain's floor"},
  {"stiffness", KEY_REAL, FIELD(stiffness), "m^2/s^2", "0", 0, 1e8, 0, NULL, "wcsph: k of p = k (rho - rho0), the square of the speed of sound; 0 = from sound_speed"},
  {"artificial_viscosity", KEY_REAL, FIELD(artificial_viscosity), "1", "0.02", 0, 2, 0, NULL, "wcsph: alpha of Monaghan's artificial viscosity"},
  {"divergence_tolerance", KEY_REAL, FIELD(divergence_tolerance), "1", "1e-3", 1e-12, 0.1, 0, NULL, "mean compression in one step by the velocity that the divergence solve of dfsph leaves"},
  {"max_iterations", KEY_INT, FIELD(max_iterations), "1", "200", 1, 100000, 0, NULL, "operator applications in one pressure solve"},
  {"cfl", KEY_REAL, FIELD(cfl), "1", "0.4", 0, 1, KEY_LO_OPEN, NULL, "largest path of a particle in one step over spacing"},
  {"time_step", KEY_REAL, FIELD(time_step), "s", "0", 0, 1e3, 0, NULL, "fixed time step; 0 = adaptive"},
  {"max_time_step", KEY_REAL, FIELD(max_time_step), "s", "0", 0, 1e3, 0, NULL, "upper bound of the adaptive time step; 0 = none"},
  {"relax_time", KEY_REAL, FIELD(relax_time), "s", "0", 0, 1e3, 0, NULL,
   "time in which a density error is corrected; 0 = 0.5 h/max(sqrt(g h), mean velocity) with iisph, one step with iisph_jacobi"},
  {"wall_factor", KEY_REAL, FIELD(wall_factor), "1", "0", 0, 2, 0, NULL, "scales the volume of planar walls; 0 = calibrated"},
  {"noise_damping", KEY_REAL, FIELD(noise_damping), "1", "3", 0, 10, 0, NULL, "rate at which the shortest waves of particle noise decay, over sqrt(g/h); 0 = no filter"},
  {"shifting", KEY_REAL, FIELD(shifting), "1", "-1", -1, 20, 0, NULL, "strength of particle shifting, which spreads particles evenly where they are deformed; 0 = none, -1 = 4 with isph, else none"},
  {"pbf_iterations", KEY_INT, FIELD(pbf_iterations), "1", "0", 0, 100000, 0, NULL, "iterations of pbf in every step; 0 = until the tolerance is met"},
  {"pbf_warm_start", KEY_REAL, FIELD(pbf_warm_start), "1", "0.5", 0, 1, 0, NULL, "part of the last pressure that pbf starts from; its paper: 0"},
  {"pbf_relaxation", KEY_REAL, FIELD(pbf_relaxation), "1", "1", 0, 1e3, 0, NULL, "relaxation epsilon of pbf over the sum of squared gradients in a full lattice"},
  {"artificial_pressure", KEY_REAL, FIELD(artificial_pressure), "1", "0", 0, 10, 0, NULL, "strength k of pbf's artificial pressure over that of a density twice too high"},
  {"artificial_pressure_distance", KEY_REAL, FIELD(artificial_pressure_distance), "1", "0.2", 0, 1, KEY_HI_OPEN, NULL, "distance of the pair at which it is k, over the support"},
  {"artificial_pressure_exponent", KEY_REAL, FIELD(artificial_pressure_exponent), "1", "4", 0, 20, 0, NULL, "exponent n of it"},
  {"xsph", KEY_REAL, FIELD(xsph), "1", "0", 0, 1, 0, NULL, "part of the difference to its neighbours' mean velocity that a particle loses in a step (XSPH; 0.01 with pbf in its paper)"},
  {"vorticity_confinement", KEY_REAL, FIELD(vorticity_confinement), "m/s", "0", 0, 1e3, 0, NULL, "force of vorticity confinement per mass and vorticity"},
  {"mean_velocity", KEY_VEC3, FIELD(mean_velocity), "m/s", "0, 0, 0", -1e3, 1e3, 0, NULL, "mean velocity kept by a body force; a zero component is left alone"},
  {"free_surface", KEY_BOOL, FIELD(free_surface), "", "true", 0, 0, 0, NULL, "no negative pressure; false for a domain full of fluid"},
  {"solver", KEY_CHOICE, FIELD(solver), "", "auto", 0, 0, 0, Solvers, "pressure solver; auto = iisph with a free surface, isph without"},
  {"bounded", KEY_CHOICE, FIELD(bounded), "", "newton", 0, 0, 0, Bounded, "how iisph keeps pressure from becoming negative: projected Newton steps with conjugate residuals, or projected conjugate gradients"},
  {"kernel", KEY_CHOICE, FIELD(kernel), "", "cubic_spline", 0, 0, 0, Kernels, "smoothing kernel"},
  {"gradient_kernel", KEY_CHOICE, FIELD(gradient_kernel), "", "same", 0, 0, 0, Gradients, "kernel of all gradients, where it is not that of density (Mueller 2003: poly6 with spiky)"},
  {"viscous_form", KEY_CHOICE, FIELD(viscous_form), "", "morris", 0, 0, 0, Viscous, "form of viscosity: morris is the more accurate at walls, monaghan keeps angular momentum"},
  {"viscosity_solver", KEY_CHOICE, FIELD(viscosity_solver), "", "auto", 0, 0, 0, Stepping,
   "implicit: conjugate gradients, any step is stable; auto = implicit where the explicit one would halve the step or is not stable"},
  {"precision", KEY_CHOICE, FIELD(precision), "", "single", 0, 0, 0, Precisions, "of the pair loops; positions and velocities are kept in double"},
  {"settle", KEY_BOOL, FIELD(settle), "", "false", 0, 0, 0, NULL, "before the run, bring water that can stay where it is to rest: particles in place, pressure hydrostatic"},
  {"inflow", KEY_NAMES, FIELD(inflow), "", "", 0, 0, 0, NULL, "names of openings through which water enters, each a section sph.<name>"},
  {"outflow", KEY_NAMES, FIELD(outflow), "", "", 0, 0, 0, NULL, "names of openings through which water leaves, each a section sph.<name>"},
  {"sources", KEY_NAMES, FIELD(sources), "", "", 0, 0, 0, NULL, "names of taps in the domain, each a section sph.<name>"},
  {"fill", KEY_NAMES, FIELD(fill), "", "", 0, 0, 0, NULL, "names of the blocks of fluid, each a section sph.<name>"},
  KEY_END};
