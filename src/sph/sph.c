/* sph.c - life of the fluid object: Create, Set..., SetFromOptions, SetUp, View, Destroy, and what is asked of its state. */
#include <math.h>
#include <petscviewer.h>
#include <stdlib.h>

#include "mat3.h"
#include "sph_impl.h"

PetscLogEvent       SPH_Neighbors, SPH_Contacts, SPH_Predict, SPH_Pressure, SPH_Apply, SPH_Forces, SPH_Advance;
static PetscClassId SPH_CLASSID = 0;

static PetscErrorCode Register(void)
{
  PetscFunctionBegin;
  if (SPH_CLASSID) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscClassIdRegister("SPH", &SPH_CLASSID));
  PetscCall(PetscLogEventRegister("SPHNeighbors", SPH_CLASSID, &SPH_Neighbors));
  PetscCall(PetscLogEventRegister("SPHContacts", SPH_CLASSID, &SPH_Contacts));
  PetscCall(PetscLogEventRegister("SPHPredict", SPH_CLASSID, &SPH_Predict));
  PetscCall(PetscLogEventRegister("SPHPressure", SPH_CLASSID, &SPH_Pressure));
  PetscCall(PetscLogEventRegister("SPHApply", SPH_CLASSID, &SPH_Apply));
  PetscCall(PetscLogEventRegister("SPHForces", SPH_CLASSID, &SPH_Forces));
  PetscCall(PetscLogEventRegister("SPHAdvance", SPH_CLASSID, &SPH_Advance));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHCreate - create an incompressible fluid without particles, with the defaults of SPHKeys[]

  Collective

  Input Parameter:
. comm - communicator (one rank)

  Output Parameter:
. sph - the fluid

.seealso: SPHGetParams(), SPHSetDomain(), SPHAddParticles(), SPHSetUp(), SPHDestroy()
@*/
PetscErrorCode SPHCreate(MPI_Comm comm, SPH *sph)
{
  SPH s;

  PetscFunctionBegin;
  PetscCall(Register());
  PetscCall(PetscHeaderCreate(s, SPH_CLASSID, "SPH", "incompressible fluid of smoothed particles", "SPH", comm, SPHDestroy, SPHView));
  PetscCall(KeysSetDefaults(SPHKeys, &s->params));
  s->converged = PETSC_TRUE;
  PetscCall(SPHAddArray_Internal(s, &s->x, 3 * sizeof(PetscReal)));
  PetscCall(SPHAddArray_Internal(s, &s->v, 3 * sizeof(PetscReal)));
  *sph         = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* lends the parameters; what is written before SPHSetUp() is used, later writes have no effect that is promised */
PetscErrorCode SPHGetParams(SPH sph, SPHParams **params)
{
  PetscFunctionBegin;
  *params = &sph->params;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* overwrite the parameters with the options -sph_* */
PetscErrorCode SPHSetFromOptions(SPH sph)
{
  PetscFunctionBegin;
  PetscCall(KeysSetFromOptions(SPHKeys, "sph_", &sph->params));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHSetDomain - the box of the flow, which of its sides are walls, and which axes are periodic

  Input Parameters:
+ sph      - the fluid
. min, max - corners [m]
. walls    - bit 2k: wall at min of axis k; bit 2k+1: wall at max; other sides are open
- periodic - bit k: axis k is periodic
@*/
PetscErrorCode SPHSetDomain(SPH sph, const PetscReal min[3], const PetscReal max[3], unsigned walls, unsigned periodic)
{
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    if (!(max[k] > min[k])) PetscFunctionReturn(InputError("domain.max", "must be larger than domain.min along every axis"));
    if ((periodic >> k & 1) && (walls >> (2 * k) & 3)) PetscFunctionReturn(InputError("domain.periodic", "an axis is periodic or has walls, not both"));
    sph->min[k] = min[k];
    sph->max[k] = max[k];
  }
  sph->has_domain = PETSC_TRUE;
  sph->walls      = walls & 63;
  sph->periodic   = periodic & 7;
  SPHPlace_Internal(sph);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHSetGravity(SPH sph, const PetscReal g[3])
{
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) sph->gravity[k] = g[k];
  SPHPlace_Internal(sph);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHAddParticles - add fluid particles, each of the mass SPHGetMass(); ids continue from those already there

  Input Parameters:
+ sph - the fluid, before SPHSetUp()
. n   - how many
. x   - positions [m], n x 3
- v   - velocities [m/s], n x 3, or NULL for rest
@*/
PetscErrorCode SPHAddParticles(SPH sph, PetscInt n, const PetscReal x[], const PetscReal v[])
{
  const PetscInt old = sph->n, total = sph->n + n;

  PetscFunctionBegin;
  PetscCheck(!sph->setup, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "particles are added before SPHSetUp()");
  PetscCall(SPHReserve_Internal(sph, total));
  for (PetscInt i = 0; i < 3 * n; i++) {
    sph->x[3 * old + i] = x[i];
    sph->v[3 * old + i] = v ? v[i] : 0.0;
  }
  sph->n = total;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHSetParticleVolume(SPH sph, PetscReal volume)
{
  PetscFunctionBegin;
  PetscCheck(!sph->setup, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "the volume of a particle is set before SPHSetUp()");
  sph->particle_volume = volume;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sums of W and of |grad W|^2 over the points of a full cubic lattice of spacing dx around one of them */
static void LatticeSums(int kernel, int gradient_kernel, PetscReal dx, PetscReal h, PetscReal *W, PetscReal *grad2)
{
  const int n = (int)ceil(h / dx);

  *W = *grad2 = 0.0;
  for (int k = -n; k <= n; k++)
    for (int j = -n; j <= n; j++)
      for (int i = -n; i <= n; i++) {
        const PetscReal r = dx * sqrt((double)(i * i + j * j + k * k));
        *W += SPHKernelW(kernel, r, h);
        *grad2 += PetscSqr(r * SPHKernelF(gradient_kernel, r, h));
      }
}

/* sum over a full cubic lattice of the pairs' weights of the viscous operator, largest direction, for nu = 1 [1/m^2] */
static PetscReal ViscousNorm(const SPHParams *par, int kernel, PetscReal h, PetscReal mass)
{
  const PetscReal dx = par->spacing;
  const int       n = (int)ceil(h / dx);
  PetscReal       sum = 0.0;

  for (int k = -n; k <= n; k++)
    for (int j = -n; j <= n; j++)
      for (int i = -n; i <= n; i++) {
        const PetscReal r2 = dx * dx * (double)(i * i + j * j + k * k), f = SPHPairGradient(kernel, mass, sqrt(r2), h);

        if (r2 == 0.0 || f == 0.0) continue;
        if (par->viscous_form == SPH_VISCOUS_MONAGHAN) sum -= SPHPairViscosityMonaghan(1.0 / par->density, 1.0 / f, r2, h) * PetscSqr(f * dx * k);
        else sum -= SPHPairViscosityMorris(1.0 / par->density, f * r2, r2, h);
      }
  return sum;
}

/* value of a table at support 1.5, 1.75, ... 3 dx, linear between its entries */
static PetscReal AtSupport(const PetscReal table[7], PetscReal support)
{
  const PetscReal at = PetscMin(5.999, PetscMax(0.0, 4.0 * (support - 1.5)));
  const int       k  = (int)at;

  return table[k] + (at - k) * (table[k + 1] - table[k]);
}

/* Part of the viscosity that the discrete Laplacian gives for a slow shear wave, summed over the points of a cubic lattice displaced
   at random by up to 0.2 dx along each axis, the disorder of settled flow. Dividing by it gives Poiseuille flow its own viscosity
   (tests/unit/sph/test_viscosity.c). */
static PetscReal ViscosityPart(int form, int kernel, PetscReal support)
{
  static const PetscReal part[2][SPH_N_KERNELS][7] = {
    {{0.768, 0.911, 0.960, 0.953, 0.954, 0.969, 0.968}, {0.692, 0.854, 0.933, 0.947, 0.942, 0.949, 0.957}, {0.912, 1.013, 1.001, 0.949, 0.954, 0.983, 0.977}, {0.720, 0.856, 0.913, 0.915, 0.924, 0.944, 0.949}},
    {{0.361, 0.598, 0.783, 0.860, 0.895, 0.928, 0.946}, {0.273, 0.506, 0.711, 0.826, 0.872, 0.898, 0.920}, {0.494, 0.798, 0.952, 0.947, 0.937, 0.959, 0.966}, {0.334, 0.563, 0.739, 0.812, 0.849, 0.886, 0.906}}
  };

  return AtSupport(part[form][kernel], support);
}

static PetscErrorCode AllocateState(SPH sph)
{
  SPHLoops    *l = &sph->loops;
  const size_t real = (size_t)sph->table->real_size, one = sizeof(PetscReal);
  // of the state: these change places with their copies when particles are sorted
  PetscReal **const vectors[] = {&sph->x_alt, &sph->v_alt, &sph->v_star, &sph->accel, &sph->G_planes, &sph->G};
  PetscReal **const scalars[] = {&sph->p, &sph->p_alt, &sph->rho, &sph->rho_pairs, &sph->open, &sph->open_surfaces, &sph->rate, &sph->wall_rate, &sph->rhs, &sph->root,
                                 &sph->scale, &sph->y, &sph->residual, &sph->direction, &sph->Adirection, &sph->p_tilde, &sph->response, &sph->mode};

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(vectors) / sizeof(vectors[0]); k++) PetscCall(SPHAddArray_Internal(sph, vectors[k], 3 * one));
  for (size_t k = 0; k < sizeof(scalars) / sizeof(scalars[0]); k++) PetscCall(SPHAddArray_Internal(sph, scalars[k], one));
  PetscCall(SPHAddArray_Internal(sph, &sph->id, sizeof(PetscInt)));
  PetscCall(SPHAddArray_Internal(sph, &sph->id_alt, sizeof(PetscInt)));
  PetscCall(SPHAddArray_Internal(sph, &sph->order, sizeof(PetscInt)));
  if (sph->params.vorticity_confinement > 0) PetscCall(SPHAddArray_Internal(sph, &sph->confine, 6 * one));
  if (sph->params.viscosity > 0) {
    PetscCall(SPHAddArray_Internal(sph, &sph->friction_planes, one));
    PetscCall(SPHAddArray_Internal(sph, &sph->volume, one));
    PetscCall(SPHAddArray_Internal(sph, &sph->push, 3 * one));
    PetscCall(SPHAddArray_Internal(sph, &sph->v_viscous, 3 * one));
  }
  if (sph->frame) PetscCall(SPHAddArray_Internal(sph, &sph->frame_kick, 3 * one));

  // the neighbour list is allocated when it is first built
  PetscCall(SPHAddArray_Internal(sph, &l->cell, sizeof(int)));
  PetscCall(SPHAddArray_Internal(sph, &l->start, sizeof(int)));
  PetscCall(SPHAddArray_Internal(sph, &l->count, sizeof(int)));
  PetscCall(SPHAddArray_Internal(sph, &l->near_x, 3 * real));
  PetscCall(SPHAddArray_Internal(sph, &l->pressure, real));
  PetscCall(SPHAddArray_Internal(sph, &l->vector, 4 * real));
  PetscCall(SPHAddArray_Internal(sph, &l->wall, 4 * real));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHSetUp - check the parameters, derive mass, support and wall factor, allocate every array

  Errors:
  BY_ERR_INPUT for what the user can mend: no particles, a periodic axis shorter than twice the support, a particle outside

.seealso: SPHPack(), SPHUpdateNeighbors()
@*/
PetscErrorCode SPHSetUp(SPH sph)
{
  const SPHParams *par = &sph->params;
  const PetscReal  g   = Norm3(sph->gravity);
  PetscReal        W, grad2;

  PetscFunctionBegin;
  if (sph->setup) PetscFunctionReturn(PETSC_SUCCESS);
  if (!(par->spacing > 0)) PetscFunctionReturn(InputError("sph.spacing", "must be a finite number > 0 [m]"));
  ByCall(SPHOpenFromOptions_Internal(sph));
  if (sph->n == 0 && !sph->n_openings) PetscFunctionReturn(InputError("sph.fill", "there is no fluid: no particle is in the blocks of fluid"));
  sph->h = par->support * par->spacing;
  for (int k = 0; k < 3; k++) {
    if ((sph->periodic >> k & 1) && sph->max[k] - sph->min[k] < 2.0 * sph->h) {
      PetscFunctionReturn(InputError("domain.periodic", "a periodic axis must be at least two supports (%g m) long", (double)(2.0 * sph->h)));
    }
  }
  sph->method = SPHFindSolver_Internal(par);
  if (!sph->method->Solve) PetscFunctionReturn(InputError("sph.solver", "%s is not in this version", sph->method->name));
  if (sph->params.tolerance == 0.0) sph->params.tolerance = sph->method->tolerance;
  sph->gradient_kernel = SPHGradientKernel(par);
  sph->flow_speed      = PetscMax(Norm3(par->mean_velocity), SPHOpenSpeed_Internal(sph));
  LatticeSums(par->kernel, sph->gradient_kernel, par->spacing, sph->h, &W, &grad2);
  sph->mass        = par->density / W;
  if (sph->particle_volume > 0) sph->mass *= sph->particle_volume / PetscPowReal(par->spacing, 3);
  sph->wall_factor = par->wall_factor > 0 ? par->wall_factor : SPHWallFactor(par->kernel, par->support);
  sph->mu_pairs    = par->viscosity / ViscosityPart(par->viscous_form, sph->gradient_kernel, par->support);
  sph->viscous_norm = ViscousNorm(par, sph->gradient_kernel, sph->h, sph->mass) / ViscosityPart(par->viscous_form, sph->gradient_kernel, par->support);
  sph->relax_time  = par->relax_time;
  if (sph->relax_time == 0.0 && sph->method->relaxes) {
    const PetscReal speed = PetscMax(sqrt(g * sph->h), sph->flow_speed);
    sph->relax_time       = speed > 0 ? 0.5 * sph->h / speed : -1.0;
  }
  sph->wall_flux   = sph->surface_part = 1.0;
  sph->shifting    = PetscMax(0.0, par->shifting);
  sph->prototype   = grad2 * sph->mass * sph->mass;
  sph->filter_norm = SPHFilterNorm(sph->prototype);
  sph->filter_rate = par->noise_damping * PetscMax(sqrt(g / sph->h), sph->flow_speed / sph->h);

  sph->table          = par->precision == SPH_PRECISION_DOUBLE ? &SPHLoopsOpenMPDouble : &SPHLoopsOpenMPSingle;
  sph->loops.n        = (int)sph->n;
  sph->loops.kernel   = par->kernel;
  sph->loops.gradient_kernel = sph->gradient_kernel;
  sph->loops.h        = sph->h;
  sph->loops.mass     = sph->mass;
  sph->loops.rho0     = par->density;
  sph->loops.capacity = 0;
  PetscCall(AllocateState(sph));
  for (PetscInt i = 0; i < sph->n; i++) {
    sph->id[i]   = i;
    sph->rho[i]  = par->density;
    sph->mode[i] = 1.0 + 0.5 * sin(12.9898 * (double)i); // any start that no symmetry makes orthogonal
  }
  sph->next_id = sph->n;
  PetscCall(SPHOpenSetUp_Internal(sph));
  ByCall(SPHCheckState_Internal(sph, "at the start"));
  if (sph->method->SetUp) ByCall(sph->method->SetUp(sph));
  sph->setup = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* print every parameter with its unit, and what was derived from them */
PetscErrorCode SPHView(SPH sph, PetscViewer viewer)
{
  PetscFunctionBegin;
  if (!viewer) PetscCall(PetscViewerASCIIGetStdout(PetscObjectComm((PetscObject)sph), &viewer));
  PetscCall(PetscObjectPrintClassNamePrefixType((PetscObject)sph, viewer));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscCall(KeysView(SPHKeys, &sph->params, viewer));
  if (sph->setup) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "particles: %d of %g kg, support %g m\n", (int)sph->n, (double)sph->mass, (double)sph->h));
    PetscCall(PetscViewerASCIIPrintf(viewer, "solver in use: %s\n", sph->method->name));
    if (sph->sound_speed > 0) PetscCall(PetscViewerASCIIPrintf(viewer, "speed of sound in use: %g m/s\n", (double)sph->sound_speed));
    PetscCall(PetscViewerASCIIPrintf(viewer, "wall factor in use: %g, density relaxation time in use: %g s\n", (double)sph->wall_factor, (double)sph->relax_time));
    PetscCall(PetscViewerASCIIPrintf(viewer, "loops: %s\n", sph->table->name));
  }
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHDestroy(SPH *sph)
{
  SPH s = *sph;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  if (--((PetscObject)s)->refct > 0) {
    *sph = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SPHFreeArrays_Internal(s));
  PetscCall(SPHOpenDestroy_Internal(s));
  if (s->method && s->method->Destroy) PetscCall(s->method->Destroy(s));
  PetscCall(SPHCompactDestroy_Internal(s));
  PetscCall(PetscFree(s->loops.grid.start));
  free(s->loops.neighbour);
  free(s->loops.gradient);
  free(s->loops.viscous);
  for (PetscInt k = 0; k < s->surfaces_allocated; k++) {
    PetscCall(PetscFree2(s->surfaces[k].union_factor, s->surfaces[k].friction));
    PetscCall(PetscFree(s->surfaces[k].velocity));
  }
  PetscCall(SPHViscousDestroy_Internal(s));
  PetscCall(PetscFree(s->surfaces));
  PetscCall(PetscFree(s->patches));
  PetscCall(PetscHeaderDestroy(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHGetSize(SPH sph, PetscInt *n)
{
  PetscFunctionBegin;
  *n = sph->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* lends the state in the current order; any pointer may be NULL */
PetscErrorCode SPHGetState(SPH sph, const PetscReal *x[], const PetscReal *v[], const PetscReal *p[], const PetscReal *rho[], const PetscInt *id[])
{
  PetscFunctionBegin;
  if (x) *x = sph->x;
  if (v) *v = sph->v;
  if (p) *p = sph->p;
  if (rho) *rho = sph->rho;
  if (id) *id = sph->id;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the solver that sph.solver means for this fluid, after SPHSetUp(); either pointer may be NULL */
PetscErrorCode SPHGetSolver(SPH sph, const char *name[], PetscBool *responds)
{
  const SPHSolverOps *ops = sph->method ? sph->method : SPHFindSolver_Internal(&sph->params);

  PetscFunctionBegin;
  if (name) *name = ops->name;
  if (responds) *responds = ops->responds;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHGetMass(SPH sph, PetscReal *particle_mass)
{
  PetscFunctionBegin;
  *particle_mass = sph->mass;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHGetSupport(SPH sph, PetscReal *h)
{
  PetscFunctionBegin;
  *h = sph->setup ? sph->h : sph->params.support * sph->params.spacing;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHGetDomain(SPH sph, PetscReal min[3], PetscReal max[3], unsigned *walls, unsigned *periodic)
{
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    min[k] = sph->min[k];
    max[k] = sph->max[k];
  }
  *walls    = sph->walls;
  *periodic = sph->periodic;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what went wrong when a step returned BY_ERR_BREAKDOWN: step, particle, position, quantity */
PetscErrorCode SPHGetBreakdown(SPH sph, const char **message)
{
  PetscFunctionBegin;
  *message = sph->breakdown;
  PetscFunctionReturn(PETSC_SUCCESS);
}
