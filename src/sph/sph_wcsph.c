/* sph_wcsph.c - weakly compressible SPH: pressure is a stiff function of density (sph_eos.h), so that nothing is solved and sound limits the
   step [Monaghan, J. Comput. Phys. 110 (1994) 399; Becker & Teschner, SCA 2007; gamma 1: Mueller, Charypar & Gross, SCA 2003].

   Density is the sum over pairs and walls, as for every solver here, and p~ = p/rho0^2 for p/rho^2: the error is that of the compression, and
   momentum, planes and proxies get exactly what the fluid loses. With a free surface p >= 0, since the sum has no partners there.
   Pressure depends on positions alone: walls that answer within the step have nothing to answer to (method 5.3), so the coupler's scheme
   is explicit; light bodies are refused there. */
#include <math.h>

#include "mat3.h"
#include "sph_eos.h"
#include "sph_impl.h"

#define MOST_DENSE 3.0 /* times rest density: Tait's pressure is there 2,300 times that of a tenth more than rest */

/* v0 and H of SPHSoundSpeed(): H from the highest particle down to the lowest corner of the domain, or to the lowest particle without one */
static void FindScales(SPH sph, PetscReal *v0, PetscReal *H)
{
  const PetscReal g = Norm3(sph->gravity);
  PetscReal       top = -PETSC_MAX_REAL, bottom = PETSC_MAX_REAL, speed2 = 0.0;

  for (PetscInt i = 0; i < sph->n; i++) {
    const PetscReal height = g > 0 ? -Dot3(sph->x + 3 * i, sph->gravity) / g : 0.0;

    top    = PetscMax(top, height);
    bottom = PetscMin(bottom, height);
    speed2 = PetscMax(speed2, Dot3(sph->v + 3 * i, sph->v + 3 * i));
  }
  for (int c = 0; c < 8 && sph->has_domain && g > 0; c++) {
    const PetscReal corner[3] = {c & 1 ? sph->max[0] : sph->min[0], c & 2 ? sph->max[1] : sph->min[1], c & 4 ? sph->max[2] : sph->min[2]};
    bottom                    = PetscMin(bottom, -Dot3(corner, sph->gravity) / g);
  }
  *v0 = PetscMax(sqrt(speed2), Norm3(sph->params.mean_velocity));
  *H  = PetscMax(0.0, top - bottom);
}

static PetscErrorCode SetUp(SPH sph)
{
  const SPHParams *par = &sph->params;
  PetscReal        v0, H;

  PetscFunctionBegin;
  if (par->stiffness > 0 && par->sound_speed > 0) PetscFunctionReturn(InputError("sph.stiffness", "is the square of sph.sound_speed: give one of them"));
  sph->sound_speed = par->stiffness > 0 ? sqrt(par->stiffness) : par->sound_speed;
  if (sph->sound_speed == 0.0) {
    FindScales(sph, &v0, &H);
    sph->sound_speed = SPHSoundSpeed(10.0, v0, Norm3(sph->gravity), H);
  }
  if (sph->sound_speed == 0.0) sph->sound_speed = 10.0; // nothing moves and nothing falls: any speed is as good
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LimitStep(SPH sph, PetscReal *dt)
{
  PetscFunctionBegin;
  *dt = PetscMin(*dt, SPHAcousticStep(sph->params.cfl, sph->params.artificial_viscosity, sph->sound_speed, sph->h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Predict(SPH sph, PetscReal dt)
{
  const PetscReal alpha = sph->params.artificial_viscosity;

  PetscFunctionBegin;
  if (alpha == 0.0) PetscFunctionReturn(PETSC_SUCCESS);
  sph->table->SetVelocity(&sph->loops, sph->v);
  sph->table->Artificial(&sph->loops, dt * SPHArtificialViscosity(alpha, sph->sound_speed, sph->h, sph->params.density), sph->v_star);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve(SPH sph, const SPHOperator *op)
{
  const int       n    = (int)sph->n;
  const PetscReal rho0 = sph->params.density, gamma = sph->params.gamma;
  int             bad  = n;

  PetscFunctionBegin;
  (void)op;
#pragma omp parallel for schedule(static) reduction(min : bad)
  for (int i = 0; i < n; i++) {
    const PetscReal p = SPHTait(sph->rho[i], rho0, sph->sound_speed, gamma);
    sph->p[i]         = sph->params.free_surface && p < 0 ? 0.0 : p;
    if (gamma > 1 && sph->rho[i] > MOST_DENSE * rho0 && i < bad) bad = i;
  }
  if (bad < n) {
    const PetscReal *x = sph->x + 3 * bad;
    PetscCall(PetscSNPrintf(sph->breakdown, sizeof(sph->breakdown),
                            "step %d, pressure: fluid particle %d at (%g, %g, %g) m is compressed to %.3g times rest density, where the state equation of wcsph explodes: start without compression or take a higher sph.sound_speed",
                            (int)sph->step, (int)sph->id[bad], (double)x[0], (double)x[1], (double)x[2], (double)(sph->rho[bad] / rho0)));
    PetscFunctionReturn(BY_ERR_BREAKDOWN);
  }
  sph->converged = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SPHSolverOps SPHSolverWCSPH = {.name = "wcsph", .tolerance = 1e-5, .ignores_rate = PETSC_TRUE, .SetUp = SetUp, .LimitStep = LimitStep, .Predict = Predict, .Solve = Solve};
