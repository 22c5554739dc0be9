/* coupler_ledger.c - energies, work at the interface, momentum, errors, penetrations (method 5.4). */
#include "coupler_impl.h"

/* Water particles inside a body or obstacle, by winding number of its whole closed boundary. After a breakdown within a step bodies are ahead of the
   water: nothing can be said then. */
static PetscErrorCode CountPenetrations(Coupler c, PetscInt *n_inside)
{
  PetscInt         n;
  const PetscReal *x, *v, *p, *rho;
  const PetscInt  *id;
  PetscReal       *winding;

  PetscFunctionBegin;
  *n_inside = 0;
  if (!c->sph || !c->n_surfaces || c->within_step) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SPHGetSize(c->sph, &n));
  PetscCall(SPHGetState(c->sph, &x, &v, &p, &rho, &id));
  PetscCall(PetscMalloc1(n, &winding));
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    CouplerSurface  *s           = &c->surface[k];
    PetscInt         n_triangles = s->n_triangles;
    const PetscInt  *triangles   = s->triangles;
    const PetscReal *nodes       = s->x, *velocity;

    if (s->tled) {
      PetscCall(TLEDGetSurface(s->tled, PETSC_FALSE, &n_triangles, &triangles));
      PetscCall(TLEDGetPositions(s->tled, &nodes, &velocity));
    }
    PetscCall(SurfaceWinding(n, x, nodes, n_triangles, triangles, winding));
    for (PetscInt i = 0; i < n; i++) *n_inside += winding[i] > 0.5;
  }
  PetscCall(PetscFree(winding));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* energies, works and momentum of fluid and bodies; loads: work of loads and supports on the bodies [J] */
static PetscErrorCode AddEnergies(Coupler c, CouplerLedger *l, PetscReal *loads)
{
  PetscFunctionBegin;
  *loads = 0.0;
  if (c->sph) {
    SPHStats f;

    PetscCall(SPHGetStats(c->sph, &f));
    l->iterations         = f.iterations;
    l->fluid_kinetic      = f.kinetic;
    l->fluid_potential    = f.potential;
    l->fluid_viscous_loss = f.viscous_loss;
    l->compression_mean   = f.compression_mean;
    l->compression_max    = f.compression_max;
    l->speed_max          = f.speed_max;
    l->speed_rms          = f.speed_rms;
    l->work_motion        = f.wall_work + f.frame_work;
    l->fluid_particles    = f.particles;
    PetscCall(SPHGetVolumes(c->sph, &l->fluid_entered, &l->fluid_left));
    for (int i = 0; i < 3; i++) {
      l->momentum[i] = f.momentum[i];
      l->angular[i]  = f.angular[i];
    }
  }
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    CouplerSurface *s = &c->surface[k];
    TLEDStats       b;

    l->proxies += c->contacts[k].n_proxies;
    l->work_fluid += s->work_fluid;
    l->work_solid += s->work_solid;
    l->work_exchanged += s->work_exchanged;
    if (s->moves) l->work_motion -= s->work_fluid;
    if (!s->tled) continue;
    PetscCall(TLEDGetStats(s->tled, &b));
    l->substeps = PetscMax(l->substeps, s->substeps);
    l->solid_kinetic += b.kinetic;
    l->solid_strain += b.strain;
    l->solid_potential += b.gravity_potential;
    l->solid_damping_loss += b.damping_loss;
    l->solid_volume += b.volume;
    l->solid_contact_energy += b.contact_energy;
    l->solid_external_work += b.external_work;
    *loads += b.external_work - s->work_force;
    for (int i = 0; i < 3; i++) {
      l->momentum[i] += b.momentum[i];
      l->angular[i] += b.angular[i];
    }
  }
  l->energy = l->fluid_kinetic + l->fluid_potential + l->solid_kinetic + l->solid_strain + l->solid_potential + l->solid_contact_energy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* energy [J] of fluid and bodies, less what works and losses have made of it: constant but for the errors of the method. Water that comes and goes through openings
   has no entry, nor has the force that holds a mean velocity. */
static PetscReal Balance(const CouplerLedger *l, PetscReal loads)
{
  return l->energy + l->fluid_viscous_loss + l->solid_damping_loss - l->work_motion - loads;
}

PetscErrorCode CouplerGetBalance(Coupler c, PetscReal *balance)
{
  CouplerLedger l = {0};
  PetscReal     loads;

  PetscFunctionBegin;
  PetscCall(AddEnergies(c, &l, &loads));
  *balance = Balance(&l, loads);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerGetLedger - the books of fluid, bodies and interface at the current time

  Collective

  Input Parameter:
. coupler - after CouplerSetUp()

  Output Parameter:
. ledger - energies [J], momentum [kg m/s], angular momentum about the origin [kg m^2/s], relative compressions, counts

.seealso: CouplerStep()
@*/
PetscErrorCode CouplerGetLedger(Coupler c, CouplerLedger *l)
{
  PetscReal loads;

  PetscFunctionBegin;
  *l      = (CouplerLedger){0};
  l->time = c->time;
  l->dt   = c->dt;
  l->step = c->step;
  l->solves             = c->solves;
  l->interface_residual = c->mismatch;
  PetscCall(AddEnergies(c, l, &loads));
  l->energy_error = c->step ? Balance(l, loads) - c->balance_start : 0.0;
  PetscCall(CountPenetrations(c, &l->penetrations));
  PetscFunctionReturn(PETSC_SUCCESS);
}
