/* sph_motion.c - what moves by prescription: planar walls, and the whole tank (sph_frame.h). The fluid's own clock tells where they are. A step
   sees a wall's mean velocity over it, so that the wall ends exactly where its course says. */
#include <math.h>

#include "sph_impl.h"

/* [dx] Nearer than this no two walls close on water: two layers stand 0.2 dx off their walls and 0.9 dx from each other. Measured: water pressed out
   between two plates keeps its energy balance within 3 % down to 1.4 dx, at 1.2 dx its layers have no place and it is shot out. */
#define SPH_CLOSED_GAP 1.5

/* put planes and gravity where they are at the fluid's time */
void SPHPlace_Internal(SPH sph)
{
  RigidMotion at;

  for (int k = 0; k < 6; k++) {
    sph->plane[k] = k % 2 ? sph->max[k / 2] : sph->min[k / 2];
    if (!sph->motion[k]) continue;
    MotionAt(sph->motion[k], sph->time, &at);
    sph->plane[k] += at.shift[k / 2];
  }
  for (int k = 0; k < 3; k++) sph->gravity_now[k] = sph->gravity[k];
  if (!sph->frame) return;
  MotionAt(sph->frame, sph->time, &at);
  for (int k = 0; k < 9; k++) at.turn[k] += k % 4 ? 0.0 : 1.0;
  SPHTurnBack(at.turn, sph->gravity, sph->gravity_now);
}

/*@
  SPHSetSlip - planes along which a viscous fluid slips freely

  Input Parameters:
+ sph   - the fluid
- walls - bits of SPHSetDomain()
@*/
PetscErrorCode SPHSetSlip(SPH sph, unsigned walls)
{
  PetscFunctionBegin;
  sph->slip = walls & 63;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHSetWallMotion - let planar walls move by a translation

  Input Parameters:
+ sph    - the fluid, its domain set
. walls  - bits of SPHSetDomain()
- motion - borrowed until SPHDestroy(); without rotation. NULL: at rest

  Motion along the normal moves the plane; motion in the plane drags a viscous fluid that does not slip.

.seealso: SPHSetSlip(), SPHSetFrame()
@*/
PetscErrorCode SPHSetWallMotion(SPH sph, unsigned walls, const Motion *motion)
{
  PetscFunctionBegin;
  PetscCheck(sph->has_domain, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "SPHSetDomain() comes first");
  PetscCheck(!motion || motion->angle == 0.0, PetscObjectComm((PetscObject)sph), PETSC_ERR_ARG_WRONG, "planes do not turn");
  for (int k = 0; k < 6; k++)
    if (walls >> k & 1) sph->motion[k] = motion;
  SPHPlace_Internal(sph);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHSetFrame - let the whole domain move as a rigid body: positions, velocities and forces are those seen from it

  Input Parameters:
+ sph    - the fluid
- motion - borrowed until SPHDestroy(); NULL: at rest. Gravity is that of the laboratory.

.seealso: SPHSetWallMotion(), SPHStats
@*/
PetscErrorCode SPHSetFrame(SPH sph, const Motion *motion)
{
  PetscFunctionBegin;
  sph->frame = motion;
  SPHPlace_Internal(sph);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mean velocities of the planes over the step */
void SPHMovePlanes_Internal(SPH sph, PetscReal dt)
{
  for (int k = 0; k < 6; k++) {
    RigidMotion now, after;

    for (int a = 0; a < 3; a++) sph->plane_velocity[3 * k + a] = 0.0;
    if (!sph->motion[k]) continue;
    MotionAt(sph->motion[k], sph->time, &now);
    MotionAt(sph->motion[k], sph->time + dt, &after);
    for (int a = 0; a < 3; a++) sph->plane_velocity[3 * k + a] = (after.shift[a] - now.shift[a]) / dt;
  }
}

/* speed of the fastest plane at the fluid's time [m/s]; sideways motion counts where it drags */
PetscReal SPHFastestPlane_Internal(SPH sph)
{
  PetscReal fastest = 0.0;

  for (int k = 0; k < 6; k++) {
    RigidMotion    at;
    const unsigned drags = sph->params.viscosity > 0 && !(sph->slip >> k & 1);

    if (!sph->motion[k] || !(sph->walls >> k & 1)) continue;
    MotionAt(sph->motion[k], sph->time, &at);
    fastest = PetscMax(fastest, drags ? Norm3(at.speed) : PetscAbsReal(at.speed[k / 2]));
  }
  return fastest;
}

/* largest acceleration of a corner of the tank at the fluid's time [m/s^2] */
PetscReal SPHFrameAcceleration_Internal(SPH sph)
{
  PetscReal   largest = 0.0, corner[3], a[3];
  RigidMotion at;

  if (!sph->frame) return 0.0;
  MotionAt(sph->frame, sph->time, &at);
  for (int c = 0; c < 8; c++) {
    for (int k = 0; k < 3; k++) corner[k] = c >> k & 1 ? sph->max[k] : sph->min[k];
    RigidMotionOf(&at, corner, MOTION_ACCELERATION, a);
    largest = PetscMax(largest, Norm3(a));
  }
  return largest;
}

/* v* = v and what the tank's motion gives, gravity aside; a gets gravity at the end of the step. The kicks stay for the work they do. */
void SPHFramePredict_Internal(SPH sph, PetscReal dt, PetscReal gravity[3])
{
  const int       n           = (int)sph->n;
  const PetscReal dt_before   = sph->dt_last > 0 ? sph->dt_last : dt;
  const PetscReal instant[3]  = {sph->time - dt_before, sph->time, sph->time + dt};
  RigidMotion     at[3];
  PetscReal       shift[3][3];
  SPHFrame        frame;

  for (int m = 0; m < 3; m++) {
    MotionAt(sph->frame, instant[m], &at[m]);
    for (int k = 0; k < 9; k++) at[m].turn[k] += k % 4 ? 0.0 : 1.0;
    for (int k = 0; k < 3; k++) shift[m][k] = at[m].shift[k];
  }
  SPHFrameAt(at[0].turn, at[1].turn, at[2].turn, (const double(*)[3])shift, at[1].point, sph->gravity, dt_before, dt, &frame);
  for (int k = 0; k < 3; k++) gravity[k] = frame.gravity[k];
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; i++) {
    SPHFrameKick(&frame, sph->x + 3 * i, sph->v + 3 * i, sph->frame_kick + 3 * i);
    for (int k = 0; k < 3; k++) sph->v_star[3 * i + k] = sph->v[3 * i + k] + sph->frame_kick[3 * i + k];
  }
}

/* half of the kicks' work, at the velocities of now: once before and once after the velocities change */
void SPHFrameWork_Internal(SPH sph)
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  PetscReal work;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s = 0.0;
    for (int i = 3 * SPH_FIRST(c); i < 3 * SPH_LAST(c, n); i++) s += sph->frame_kick[i] * sph->v[i];
    sph->partial[c * SPH_SUMS] = s;
  }
  SPHSumPartials(sph, 1, &work);
  sph->frame_work += 0.5 * sph->mass * work;
}

/* walls that close on each other end the run where nothing fits between them */
static PetscErrorCode CheckGaps(SPH sph)
{
  static const char axis[] = "xyz";

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    const PetscReal gap = sph->plane[2 * k + 1] - sph->plane[2 * k], least = SPH_CLOSED_GAP * sph->params.spacing;

    if ((sph->walls >> (2 * k) & 3) != 3 || !(sph->motion[2 * k] || sph->motion[2 * k + 1]) || gap >= least) continue;
    PetscCall(PetscSNPrintf(sph->breakdown, sizeof(sph->breakdown), "step %d: the walls %cmin and %cmax have closed to %g m, less than %g spacings: no two layers of particles fit between them\n"
                            "end the motion earlier, or take a smaller sph.spacing", (int)sph->step, axis[k], axis[k], (double)gap, SPH_CLOSED_GAP));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the clock goes on, before positions do; gravity that turns does work on the potential energy as it is seen from the tank */
PetscErrorCode SPHTick_Internal(SPH sph, PetscReal dt)
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  PetscReal before[3], sums[3];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) before[k] = sph->gravity_now[k];
  sph->time += dt;
  SPHPlace_Internal(sph);
  ByCall(CheckGaps(sph));
  if (!sph->frame) PetscFunctionReturn(PETSC_SUCCESS);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s[3] = {0, 0, 0};
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++)
      for (int k = 0; k < 3; k++) s[k] += sph->x[3 * i + k];
    for (int k = 0; k < 3; k++) sph->partial[c * SPH_SUMS + k] = s[k];
  }
  SPHSumPartials(sph, 3, sums);
  for (int k = 0; k < 3; k++) sph->frame_work -= sph->mass * (sph->gravity_now[k] - before[k]) * sums[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}
