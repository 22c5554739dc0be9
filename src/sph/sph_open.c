/* sph_open.c - inflow, outflow and sources: patches of a plane through which particles enter and leave.

   Upstream of an inlet, and behind the nozzle of a tap, lies a buffer one support long: particles in columns, one behind the other, whose
   velocity is prescribed (SPH_HELD). To the water they are a wall that comes along with it: they count in its density, and its pressure
   pushes on them (the row of a held particle drops out of the pressure equation, its velocity stays in the density rate). What passes the
   patch is water; at the far end of a column the next particle follows the last at the distance at which it brings its volume, so that the
   flow rate is the prescribed one to round-off, for as long as one likes.

   Downstream of an outlet without a velocity the pressure is given (SPH_GIVEN): 0, or that of still water up to `level`. In the pressure
   equation these particles give way like water, so that the flow is free to change; between steps they take the velocity that the water has
   before the outlet, so that they stay as dense as it is and hold the pressure. A support farther out they are held, so that nothing nearer
   misses a neighbour, and after another they are taken out. An outlet with a velocity is an inlet turned round: its particles are held.

   What a particle is follows from where it is: nothing but positions, counts and the next id needs to be saved. */
#include <math.h>
#include <stdlib.h>

#include "mat3.h"
#include "sph_open.h"

#define NORM_EVERY 512 /* particles that enter between two estimates of the norm, which cost a dozen operator applications each */

/* position of x in the frame of an opening: s along the flow, from the patch, and a, b across it, from its centre [m] */
static void Locate(SPH sph, const SPHOpening *o, const PetscReal x[3], PetscReal *s, PetscReal ab[2])
{
  PetscReal d[3];

  Sub3(x, o->center, d);
  for (int k = 0; k < 3; k++) { // the nearest periodic image
    const PetscReal period = sph->max[k] - sph->min[k];
    if ((sph->periodic >> k & 1) && !o->whole) d[k] -= period * rint(d[k] / period);
  }
  *s    = Dot3(d, o->n);
  ab[0] = Dot3(d, o->a);
  ab[1] = Dot3(d, o->b);
}

static PetscBool Within(const SPHOpening *o, const PetscReal ab[2])
{
  if (o->whole) return PETSC_TRUE;
  if (o->disc) return (PetscBool)(ab[0] * ab[0] + ab[1] * ab[1] <= PetscSqr(o->half[1]));
  return (PetscBool)(PetscAbsReal(ab[0]) <= o->half[0] && PetscAbsReal(ab[1]) <= o->half[1]);
}

/* the profile's value at a place of the patch; `scale` makes its mean over the columns one */
static PetscReal Profile(const SPHOpening *o, const PetscReal ab[2])
{
  const PetscReal xi = o->profile_axis < 0 ? sqrt(ab[0] * ab[0] + ab[1] * ab[1]) / o->half[0] : ab[o->profile_axis] / o->half[o->profile_axis];
  PetscReal       g[3];

  if (o->profile == SPH_PROFILE_PARABOLIC) return o->scale * PetscMax(0.0, 1.0 - xi * xi);
  if (o->profile == SPH_PROFILE_TABLE) {
    CourseAt(&o->table, o->profile_origin + ab[o->profile_axis], g);
    return PetscMax(0.0, g[0]);
  }
  return 1.0;
}

/* speed [m/s] along the flow at a place of the patch at time t; never backward */
static PetscReal Speed(const SPHOpening *o, const PetscReal ab[2], PetscReal t)
{
  PetscReal g[3];

  CourseAt(&o->course, t, g);
  return PetscMax(0.0, o->velocity * g[0]) * Profile(o, ab);
}

/* what a particle is at x: SPH_FREE, SPH_HELD or SPH_GIVEN, and by which opening */
static int KindAt(SPH sph, const PetscReal x[3], PetscInt *opening)
{
  for (PetscInt k = 0; k < sph->n_openings; k++) {
    const SPHOpening *o = &sph->opening[k];
    PetscReal         s, ab[2];

    Locate(sph, o, x, &s, ab);
    *opening = k;
    if (o->inlet && s < 0 && s >= -o->length - 2.0 * o->step && Within(o, ab)) return SPH_HELD;
    if (!o->inlet && s >= 0 && s <= 2.0 * o->length && Within(o, ab)) return o->velocity >= 0 || s > o->length ? SPH_HELD : SPH_GIVEN;
  }
  *opening = -1;
  return SPH_FREE;
}

/* part of the plane `side` that is wall around x: an opening in a wall is a hole in it, with a rim as sharp as the kernel */
PetscReal SPHOpenSolid_Internal(SPH sph, int side, const PetscReal x[3])
{
  PetscReal solid = 1.0;

  for (PetscInt k = 0; k < sph->n_openings; k++) {
    const SPHOpening *o = &sph->opening[k];
    PetscReal         s, ab[2], hole = 1.0;

    if (o->side != side) continue;
    Locate(sph, o, x, &s, ab);
    if (o->disc) hole = 1.0 - SPHHalfSpace(sph->params.kernel, o->half[0] - sqrt(ab[0] * ab[0] + ab[1] * ab[1]), sph->h);
    for (int q = 0; q < 2 && !o->disc && !o->whole; q++)
      hole *= (1.0 - SPHHalfSpace(sph->params.kernel, o->half[q] - ab[q], sph->h)) * (1.0 - SPHHalfSpace(sph->params.kernel, o->half[q] + ab[q], sph->h));
    solid *= 1.0 - hole;
  }
  return solid;
}

/* after the particles are sorted: what each is */
void SPHOpenMark_Internal(SPH sph)
{
  const int n = (int)sph->n;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    PetscInt opening;

    sph->kind[i]      = (unsigned char)KindAt(sph, sph->x + 3 * i, &opening);
    sph->opened_by[i] = (signed char)opening;
  }
  sph->loops.held = sph->kind;
}

/* pressure [Pa] at x downstream of an outlet */
static PetscReal GivenPressure(SPH sph, const SPHOpening *o, const PetscReal x[3])
{
  const PetscReal g = Norm3(sph->gravity);

  if (!o->has_level || g == 0.0) return o->pressure;
  return o->pressure + PetscMax(0.0, sph->params.density * (g * o->level + Dot3(sph->gravity, x)));
}

typedef struct {
  PetscReal weight, velocity[3];
} Mean;

static void AddFree(SPH sph, int i, const PetscReal d[3], void *ctx)
{
  Mean           *m = (Mean *)ctx;
  const PetscReal w = SPHKernelW(sph->params.kernel, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), sph->h);

  if (sph->kind[i] != SPH_FREE) return;
  m->weight += w;
  for (int k = 0; k < 3; k++) m->velocity[k] += w * sph->v[3 * i + k];
}

/* v* beyond an outlet: the mean velocity of the water half a support before it, never inward; where there is none, the particle's own */
static void Continue(SPH sph, const SPHOpening *o, int i, PetscReal s, PetscReal dt)
{
  const PetscReal reach[3] = {sph->h, sph->h, sph->h};
  PetscReal      *v = sph->v_star + 3 * i, at[3], inward;
  Mean            m = {0, {0, 0, 0}};

  for (int k = 0; k < 3; k++) at[k] = sph->x[3 * i + k] - (s + 0.5 * sph->h) * o->n[k];
  SPHVisitBox_Internal(sph, at, reach, AddFree, &m);
  for (int k = 0; k < 3; k++) v[k] = m.weight > 0 ? m.velocity[k] / m.weight : sph->v[3 * i + k];
  inward = PetscMin(0.0, Dot3(v, o->n));
  for (int k = 0; k < 3; k++) v[k] += (sph->kind[i] == SPH_GIVEN && o->has_level ? dt * sph->gravity[k] : 0.0) - inward * o->n[k];
}

/* v* of particles beyond openings, and what a given pressure does to its neighbours; the end of SPHPredict() but for the density rate */
PetscErrorCode SPHOpenPredict_Internal(SPH sph, PetscReal dt)
{
  const int       n        = (int)sph->n;
  const PetscReal to_tilde = 1.0 / PetscSqr(sph->params.density), t = sph->time + 0.5 * dt;

  PetscFunctionBegin;
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    PetscReal s, ab[2];

    sph->p_tilde[i] = 0.0;
    if (sph->kind[i] == SPH_FREE) continue;
    const SPHOpening *o = &sph->opening[sph->opened_by[i]];
    Locate(sph, o, sph->x + 3 * i, &s, ab);
    if (o->velocity < 0) {
      Continue(sph, o, i, s, dt);
      sph->p_tilde[i] = to_tilde * GivenPressure(sph, o, sph->x + 3 * i);
    } else {
      const PetscReal speed = sph->packing ? 0.0 : Speed(o, ab, t); // while water settles, nothing comes
      for (int k = 0; k < 3; k++) sph->v_star[3 * i + k] = speed * o->n[k];
    }
  }
  if (!sph->gives_pressure) PetscFunctionReturn(PETSC_SUCCESS);
  sph->table->SetPressure(&sph->loops, sph->p_tilde, NULL);
  sph->table->Acceleration(&sph->loops);
  sph->table->GetVector(&sph->loops, sph->accel);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < 3 * n; i++) sph->v_star[i] += dt * sph->accel[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* held particles keep their velocity whatever a solver does to the others; their pressure is not known */
void SPHOpenHold_Internal(SPH sph)
{
  const int n = (int)sph->n;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 3 && sph->kind[i] == SPH_HELD; k++) sph->accel[3 * i + k] = 0.0;
}

void SPHOpenPressure_Internal(SPH sph)
{
  const int n = (int)sph->n;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++)
    if (sph->kind[i] != SPH_FREE) sph->p[i] = 0.0;
}

/* take out what has gone past an outlet */
static void Remove(SPH sph)
{
  PetscInt m = 0;

  for (PetscInt i = 0; i < sph->n; i++) {
    PetscBool gone = PETSC_FALSE;

    for (PetscInt k = 0; k < sph->n_openings && !gone; k++) {
      SPHOpening *o = &sph->opening[k];
      PetscReal   s, ab[2];

      if (o->inlet) continue;
      Locate(sph, o, sph->x + 3 * i, &s, ab);
      gone = (PetscBool)(s > (o->velocity >= 0 ? 1.0 : 2.0) * o->length && Within(o, ab));
      if (gone) o->count++;
    }
    if (gone) continue;
    for (int k = 0; k < 3 && m < i; k++) {
      sph->x[3 * m + k] = sph->x[3 * i + k];
      sph->v[3 * m + k] = sph->v[3 * i + k];
    }
    sph->p[m]   = sph->p[i];
    sph->rho[m] = sph->rho[i];
    sph->id[m]  = sph->id[i];
    m++;
  }
  sph->n = m;
}

/* one particle more, at (s, a, b) of an inlet */
static PetscErrorCode Create(SPH sph, SPHOpening *o, PetscReal s, const PetscReal ab[2])
{
  const PetscReal speed = Speed(o, ab, sph->time);
  const PetscInt  i     = sph->n;

  PetscFunctionBegin;
  PetscCall(SPHReserve_Internal(sph, sph->n + 1));
  for (int k = 0; k < 3; k++) {
    PetscReal x = o->center[k] + s * o->n[k] + ab[0] * o->a[k] + ab[1] * o->b[k];

    if (sph->periodic >> k & 1) x -= (sph->max[k] - sph->min[k]) * floor((x - sph->min[k]) / (sph->max[k] - sph->min[k]));
    sph->x[3 * i + k] = x;
    sph->v[3 * i + k] = speed * o->n[k];
  }
  sph->p[i]   = 0.0;
  sph->rho[i] = sph->params.density;
  sph->id[i]  = sph->next_id++;
  sph->n++;
  o->count++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* fill the columns of an inlet up to the end of its buffer, a place after the last particle of each */
static PetscErrorCode Fill(SPH sph, SPHOpening *o)
{
  const PetscReal volume = o->step * o->cell[0] * o->cell[1];
  const PetscInt  n      = sph->n;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < o->n_columns; c++) o->last[c] = 0.5 * o->step;
  for (PetscInt i = 0; i < n; i++) {
    PetscReal s, ab[2];

    Locate(sph, o, sph->x + 3 * i, &s, ab);
    if (s >= 0 || s < -o->length - 2.0 * o->step || !Within(o, ab)) continue;
    const PetscInt at[2] = {(PetscInt)PetscMin(o->cells[0] - 1, PetscMax(0, floor(ab[0] / o->cell[0] + 0.5 * o->cells[0]))),
                            (PetscInt)PetscMin(o->cells[1] - 1, PetscMax(0, floor(ab[1] / o->cell[1] + 0.5 * o->cells[1])))};
    const PetscInt c = o->column_of[at[0] + o->cells[0] * at[1]];
    if (c >= 0) o->last[c] = PetscMin(o->last[c], s);
  }
  for (PetscInt c = 0; c < o->n_columns; c++) {
    while (o->last[c] - o->step >= -o->length && (o->volume <= 0 || (o->count + 1) * volume <= o->volume * (1.0 + 1e-9))) {
      o->last[c] -= o->step;
      PetscCall(Create(sph, o, o->last[c], o->column + 2 * c));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* at the start: water before an outlet is mirrored to behind it */
PetscErrorCode SPHOpenMirror_Internal(SPH sph)
{
  const PetscInt n = sph->n;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < sph->n_openings; k++) {
    SPHOpening *o = &sph->opening[k];

    for (PetscInt i = 0; i < n && !o->inlet; i++) {
      PetscReal s, ab[2];

      Locate(sph, o, sph->x + 3 * i, &s, ab);
      if (s > 0 || s < -(o->velocity >= 0 ? 1.0 : 2.0) * o->length || !Within(o, ab)) continue;
      PetscCall(SPHReserve_Internal(sph, sph->n + 1));
      for (int q = 0; q < 3; q++) {
        sph->x[3 * sph->n + q] = sph->x[3 * i + q] - 2.0 * s * o->n[q];
        sph->v[3 * sph->n + q] = sph->v[3 * i + q];
      }
      sph->p[sph->n]    = 0.0;
      sph->rho[sph->n]  = sph->params.density;
      sph->id[sph->n++] = sph->next_id++;
      o->count--; // has not gone through
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* particles leave and enter: the state between two steps, before it is sorted */
PetscErrorCode SPHExchange_Internal(SPH sph)
{
  const PetscInt before = sph->next_id;

  PetscFunctionBegin;
  Remove(sph);
  for (PetscInt k = 0; k < sph->n_openings; k++)
    if (sph->opening[k].inlet) PetscCall(Fill(sph, &sph->opening[k]));
  sph->loops.n = (int)sph->n;
  if (before / NORM_EVERY != sph->next_id / NORM_EVERY) { // the operator's norm was found on another cloud
    sph->norm = 0.0;
    for (PetscInt i = 0; i < sph->n; i++) sph->mode[i] = 1.0 + 0.5 * sin(12.9898 * (double)i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ SPHGetVolumes - volume [m^3] that has come in and gone out through openings since the start; buffers beyond them are outside @*/
PetscErrorCode SPHGetVolumes(SPH sph, PetscReal *entered, PetscReal *left)
{
  const PetscReal volume = SPHParticleVolume_Internal(sph);

  PetscFunctionBegin;
  *entered = *left = 0.0;
  for (PetscInt k = 0; k < sph->n_openings; k++) *(sph->opening[k].inlet ? entered : left) += volume * sph->opening[k].count;
  for (PetscInt i = 0; i < sph->n && sph->n_openings; i++) {
    PetscInt k;

    if (KindAt(sph, sph->x + 3 * i, &k) == SPH_FREE) continue;
    if (sph->opening[k].inlet) *entered -= volume;
    else *left += volume;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHGetFlows - what passed each opening, for a restart that gives the same bits

  Output Parameters:
+ n     - 0 without openings, else 1 + their number
- state - n numbers, or NULL to ask for n alone: the next id, particles made or taken out by each
@*/
PetscErrorCode SPHGetFlows(SPH sph, PetscInt *n, PetscReal state[])
{
  PetscFunctionBegin;
  *n = sph->n_openings ? 1 + sph->n_openings : 0;
  if (!state || !*n) PetscFunctionReturn(PETSC_SUCCESS);
  state[0] = (PetscReal)sph->next_id;
  for (PetscInt k = 0; k < sph->n_openings; k++) state[1 + k] = sph->opening[k].count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHSetFlows(SPH sph, PetscInt n, const PetscReal state[])
{
  PetscFunctionBegin;
  PetscCheck(n == 1 + sph->n_openings, PetscObjectComm((PetscObject)sph), PETSC_ERR_ARG_SIZ, "%d numbers for %d openings", (int)n, (int)sph->n_openings);
  sph->next_id = PetscMax(sph->next_id, (PetscInt)state[0]);
  for (PetscInt k = 0; k < sph->n_openings; k++) sph->opening[k].count = state[1 + k];
  PetscFunctionReturn(PETSC_SUCCESS);
}
