/* sph_settle.c - still water at the start of a run: where its particles come to rest, and the pressure that holds them. */
#include <math.h>

#include "mat3.h"
#include "sph_impl.h"

#define SETTLE_KEEP 0.95 /* part of the velocity that lasts a step */

/* velocities after a step (before it: v_alt), damped; none where they are prescribed. Returns the rms acceleration of the step over g */
static PetscReal Damp(SPH sph, PetscReal dt)
{
  const int n = (int)sph->n, chunks = (int)SPH_CHUNKS(n);
  PetscReal sum;

#pragma omp parallel for schedule(static)
  for (int c = 0; c < chunks; c++) {
    PetscReal s = 0.0;
    for (int i = SPH_FIRST(c); i < SPH_LAST(c, n); i++) {
      const PetscBool known = (PetscBool)(sph->kind && sph->kind[i] != SPH_FREE);
      for (int k = 0; k < 3; k++) {
        s += known ? 0.0 : PetscSqr((sph->v[3 * i + k] - sph->v_alt[3 * i + k]) / dt);
        sph->v[3 * i + k] *= known ? 0.0 : SETTLE_KEEP;
      }
    }
    sph->partial[c * SPH_SUMS] = s;
  }
  SPHSumPartials(sph, 1, &sum);
  return sqrt(sum / PetscMax(1, n)) / Norm3(sph->gravity);
}

/*@
  SPHSettle - bring water to rest where it stands: damped steps without time, after which its pressure is hydrostatic and nothing moves

  Input Parameters:
+ sph       - the fluid, packed
. tol       - rms acceleration over gravity at which it counts as settled
. max_steps - at most so many steps
. contacts  - called after each neighbour update; it must call SPHSetContacts() (NULL: no surfaces)
- ctx       - its context

  Output Parameter:
. rest - the rms acceleration that is left, over gravity; may be NULL

  Velocities are zero afterwards and pressures are those of the last step; time, step and all sums are as before. Water that cannot stay as it
  is, a column without a gate, gives way by about a support.

.seealso: SPHPack()
@*/
PetscErrorCode SPHSettle(SPH sph, PetscReal tol, PetscInt max_steps, PetscErrorCode (*contacts)(void *, SPH), void *ctx, PetscReal *rest)
{
  PetscReal internals[SPH_INTERNALS], target[3], left = PETSC_MAX_REAL;
  PetscInt  quiet = 0;

  PetscFunctionBegin;
  PetscCheck(sph->setup, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "SPHSetUp() comes first");
  if (rest) *rest = 0.0;
  if (Norm3(sph->gravity) == 0.0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SPHGetInternals(sph, internals));
  for (int k = 0; k < 3; k++) {
    target[k]                    = sph->params.mean_velocity[k];
    sph->params.mean_velocity[k] = 0.0;
  }
  PetscCall(PetscArrayzero(sph->v, 3 * sph->n));
  sph->packing = PETSC_TRUE;
  for (PetscInt step = 0; step < max_steps && quiet < 3; step++) {
    PetscReal dt;

    ByCall(SPHUpdateNeighbors(sph));
    if (contacts) ByCall(contacts(ctx, sph));
    PetscCall(SPHGetTimeStep(sph, &dt));
    ByCall(SPHPredict(sph, dt));
    ByCall(SPHSolvePressure(sph, dt, NULL, NULL));
    PetscCall(PetscArraycpy(sph->v_alt, sph->v, 3 * sph->n));
    ByCall(SPHKick(sph, dt));
    left = Damp(sph, dt);
    quiet = left < tol ? quiet + 1 : 0;
    ByCall(SPHDrift(sph, dt));
  }
  sph->packing = PETSC_FALSE;
  PetscCall(PetscArrayzero(sph->v, 3 * sph->n));
  internals[10] = sph->norm;
  PetscCall(SPHSetInternals(sph, internals));
  for (int k = 0; k < 3; k++) sph->params.mean_velocity[k] = target[k];
  if (rest) *rest = left;
  PetscFunctionReturn(PETSC_SUCCESS);
}
