/* scheme_select.c - which coupling scheme each body needs (method 5.3), unless the scene names one. */
#include "coupler_impl.h"
#include "mat3.h"

/* Ratio r of the water's mass that a body must move to its own (method 5.3), from the slenderness of the body: a plate of area
   A/2 on each side and thickness t = 2V/A moves about rho L with L = sqrt(A/2). */
static PetscErrorCode AddedMassRatio(CouplerSurface *s, PetscReal rest_density, PetscReal *ratio)
{
  PetscInt         n;
  const PetscInt  *triangles;
  const PetscReal *x, *v;
  TLEDStats        stats;
  const PetscReal *mass;
  PetscReal        area = 0.0, total = 0.0;

  PetscFunctionBegin;
  PetscCall(TLEDGetSurface(s->tled, PETSC_FALSE, &n, &triangles));
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  PetscCall(TLEDGetStats(s->tled, &stats));
  PetscCall(TLEDGetMass(s->tled, &mass));
  for (PetscInt a = 0; a < s->n_nodes; a++) total += mass[a];
  for (PetscInt t = 0; t < n; t++) {
    double a[3], b[3], ab[3];

    Sub3(&x[3 * triangles[3 * t + 1]], &x[3 * triangles[3 * t]], a);
    Sub3(&x[3 * triangles[3 * t + 2]], &x[3 * triangles[3 * t]], b);
    Cross3(a, b, ab);
    area += 0.5 * Norm3(ab);
  }
  *ratio = rest_density * PetscSqrtReal(0.5 * area) / (total * 2.0 * stats.volume / (stats.volume_reference * area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* scheme of every body; those of c->params.scheme when the scene names one */
PetscErrorCode CouplerSelectSchemes(Coupler c)
{
  const char *solver;
  PetscBool   responds;

  PetscFunctionBegin;
  PetscCall(SPHGetSolver(c->sph, &solver, &responds));
  c->responds = responds;
  if (c->params.scheme == COUPLER_SCHEME_MASS && c->n_bodies > 0 && !responds) PetscFunctionReturn(InputError("coupler.scheme", "mass needs a pressure solver that takes the bodies' response: sph.solver %s does not, iisph does; iterated needs nothing of it", solver));
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];
    PetscReal       r = 0.0;

    s->scheme = (CouplerScheme)c->params.scheme;
    if (!s->proxy || c->params.scheme != COUPLER_SCHEME_AUTO) continue;
    PetscCall(AddedMassRatio(s, c->rest_density, &r));
    PetscCall(PetscInfo(c, "%s: added-mass ratio about %g\n", s->name, (double)r));
    s->scheme = r < 0.2 ? COUPLER_SCHEME_EXPLICIT : responds ? COUPLER_SCHEME_MASS : COUPLER_SCHEME_ITERATED;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *CouplerSchemeName(Coupler c)
{
  static const char *const names[] = {"none", "explicit", "iterated", "mass"};
  int                      most    = 0;

  for (PetscInt k = 0; k < c->n_bodies; k++)
    if (c->surface[k].proxy) most = PetscMax(most, (int)c->surface[k].scheme);
  return names[most];
}
