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

/* (omega dt)^2 of the body's softest motion, by Rayleigh's quotient of its shape under a uniform load on the wetted surface, along the axis in which it is
   softest: z K z/(z M z), z = (M + tau^2 K)^-1 f with tau far longer than dt. A body that nothing holds moves as a whole: 0. */
static PetscErrorCode Stiffness(Coupler c, CouplerSurface *s, PetscReal dt, PetscReal *stiffness)
{
  const PetscInt  *triangles;
  const PetscReal *x, *v, *mass;
  PetscInt         n;
  Vec              z, Kz;

  PetscFunctionBegin;
  *stiffness = PETSC_MAX_REAL;
  PetscCall(CouplerResponseSetUp(c, s, 1e2 * dt));
  PetscCall(TLEDGetSurface(s->tled, PETSC_TRUE, &n, &triangles));
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  PetscCall(TLEDGetMass(s->tled, &mass));
  PetscCall(VecDuplicate(s->response.solution, &z));
  PetscCall(VecDuplicate(z, &Kz));
  for (int axis = 0; axis < 3; axis++) {
    PetscReal    kinetic = 0.0, *f = s->answer;
    PetscScalar  elastic;

    PetscCall(PetscArrayzero(f, 3 * s->n_nodes));
    for (PetscInt t = 0; t < n; t++) {
      double a[3], b[3], ab[3];

      Sub3(&x[3 * triangles[3 * t + 1]], &x[3 * triangles[3 * t]], a);
      Sub3(&x[3 * triangles[3 * t + 2]], &x[3 * triangles[3 * t]], b);
      Cross3(a, b, ab);
      for (int k = 0; k < 3; k++) f[3 * triangles[3 * t + k] + axis] += Norm3(ab) / 6.0;
    }
    PetscCall(CouplerResponseSolve(s, f, f));
    PetscCall(VecCopy(s->response.solution, z));
    PetscCall(MatMult(s->response.tangent, z, Kz));
    PetscCall(VecDot(z, Kz, &elastic));
    for (PetscInt i = 0; i < 3 * s->n_nodes; i++) kinetic += mass[i / 3] * f[i] * f[i];
    if (kinetic > 0.0) *stiffness = PetscMin(*stiffness, PetscMax(0.0, elastic) / kinetic * dt * dt);
  }
  PetscCall(VecDestroy(&z));
  PetscCall(VecDestroy(&Kz));
  s->response.dt = 0.0; // made for another step
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Scheme of every body; those of c->params.scheme when the scene names one.

   Over a step the water answers a change dv of the wall's velocity with a force -m_w dv/dt, and the body a force F with dt/2 F/(M (1 + beta (omega dt)^2)),
   beta = 1/4 (scheme_mass.c). The exchange, one after the other, shrinks errors by m_w/M over that bracket: where this is below 0.2 `explicit` is
   enough (method 5.3), for heavy bodies and for those too stiff to follow within a step. All others get `iterated`, with the response where the
   pressure solver takes it: one solve where the response is right, as `mass`, two where it is not, and those begin from the right pressure. Measured
   (docs/verification/coupling.md) it holds where one pass of `mass` does not, water a hundred times the body, for a tenth more time. */
PetscErrorCode CouplerSelectSchemes(Coupler c)
{
  const PetscReal enough = 0.2;
  const char     *solver;
  PetscReal       dt;

  PetscFunctionBegin;
  PetscCall(SPHGetSolver(c->sph, &solver, &c->responds));
  if (c->params.scheme == COUPLER_SCHEME_MASS && c->n_bodies > 0 && !c->responds) PetscFunctionReturn(InputError("coupler.scheme", "mass needs a pressure solver that takes the bodies' response: sph.solver %s does not, iisph does; iterated needs nothing of it", solver));
  PetscCall(SPHGetTimeStep(c->sph, &dt));
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface *s = &c->surface[k];

    s->scheme    = (CouplerScheme)c->params.scheme;
    s->stiffness = -1.0;
    if (!s->proxy) continue;
    PetscCall(AddedMassRatio(s, c->rest_density, &s->water));
    if (c->params.scheme != COUPLER_SCHEME_AUTO) continue;
    s->scheme = COUPLER_SCHEME_EXPLICIT;
    if (s->water < enough) continue;
    PetscCall(Stiffness(c, s, dt, &s->stiffness));
    if (s->water < enough * (1.0 + c->params.response_beta * s->stiffness)) continue;
    s->scheme = COUPLER_SCHEME_ITERATED;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *const scheme_names[] = {"auto", "explicit", "iterated", "mass"};

PetscErrorCode CouplerGetScheme(Coupler c, PetscInt k, const char *name[])
{
  PetscFunctionBegin;
  *name = c->surface[k].proxy && c->surface[k].tled ? scheme_names[c->surface[k].scheme] : "none";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one line a body: its scheme and why */
PetscErrorCode CouplerViewSchemes(Coupler c, PetscViewer viewer)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n_bodies && c->sph; k++) {
    const CouplerSurface *s = &c->surface[k];

    if (!s->proxy) {
      PetscCall(PetscViewerASCIIPrintf(viewer, "%s: dry\n", s->name));
      continue;
    }
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s: scheme %s (water moved about %.3g times the body's mass", s->name, scheme_names[s->scheme], (double)s->water));
    if (s->stiffness >= 0.0) PetscCall(PetscViewerASCIIPrintf(viewer, ", omega dt of its softest motion about %.2g", (double)PetscSqrtReal(s->stiffness)));
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s)\n", c->params.scheme == COUPLER_SCHEME_AUTO ? "" : "; named in the scene"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *CouplerSchemeName(Coupler c)
{
  CouplerScheme most = COUPLER_SCHEME_AUTO;

  for (PetscInt k = 0; k < c->n_bodies; k++)
    if (c->surface[k].proxy) most = PetscMax(most, c->surface[k].scheme);
  return most == COUPLER_SCHEME_AUTO ? "none" : scheme_names[most];
}
