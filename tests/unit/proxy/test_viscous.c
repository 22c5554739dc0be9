/* test_viscous.c - pressure and friction of a viscous fluid on a body: what its nodes get is what the fluid lost, in force and in moment (method 5.1). */
#include "unit/proxy/fixture.h"
#include "unit/sph/fluid.h"

#define DX 0.01

/* a block of fluid that streams and turns, a ball of radius 3 dx at `center` left out of it */
static SPH Stream(int solver, const double center[3])
{
  const PetscReal lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1};
  SPH             sph = NewFluid(DX);
  SPHParams      *par;
  unsigned long   seed = 3;

  assert_petsc(SPHGetParams(sph, &par));
  par->viscosity        = 2.0;
  par->viscous_form     = SPH_VISCOUS_MONAGHAN; // along the line between two particles: it keeps their angular momentum
  par->viscosity_solver = solver;
  assert_petsc(SPHSetDomain(sph, lo, hi, 0, 0));
  for (int i = 0; i < 10*10*10; i++) {
    double x[3], r[3], v[3];
    for (int k = 0, m = i; k < 3; k++, m /= 10) x[k] = (m%10 + 0.1*FixtureRandom(&seed))*DX;
    Sub3(x, center, r);
    v[0] = 0.7 - 9.0*r[1], v[1] = 0.2 + 9.0*r[0], v[2] = -0.3 + 4.0*r[0];
    if (Norm3(r) > 3.2*DX) assert_petsc(SPHAddParticles(sph, 1, x, v));
  }
  assert_petsc(SPHSetUp(sph));
  return sph;
}

/* linear and angular momentum [kg m/s], [kg m^2/s] of the fluid */
static void Momentum(SPH sph, double p[6])
{
  SPHStats stats;
  assert_petsc(SPHGetStats(sph, &stats));
  for (int k = 0; k < 3; k++) p[k] = stats.momentum[k], p[3 + k] = stats.angular[k];
}

/* one step against a ball of n_split^2 triangles a face: friction must be there, and nodal forces must be the reaction to all */
static void Check(int solver, int n_split, double tol)
{
  const double center[3] = {0.047, 0.045, 0.044}, dt = 2e-4;
  Shape        s = ShapeSphere(3.0*DX, n_split);
  SPH          sph = Stream(solver, center);
  SPHContacts  contacts;
  Proxy        proxy;
  double       before[6], after[6], got[6] = {0}, size = 0.0, along = 0.0, *nodal = (double *)calloc(3*(size_t)s.n_nodes, sizeof(double));
  const PetscReal *x, *normal;
  PetscInt     n;

  for (int i = 0; i < 3*s.n_nodes; i++) s.x[i] += center[i%3];
  assert_petsc(ProxyCreate(PETSC_COMM_SELF, "body", &proxy));
  assert_petsc(ProxySetSurface(proxy, s.n_nodes, s.x, s.n_triangles, s.triangles));
  assert_petsc(ProxySetFluid(proxy, sph));
  assert_petsc(ProxySetUp(proxy));
  assert_petsc(SPHUpdateNeighbors(sph));
  Momentum(sph, before);
  assert_petsc(ProxyUpdate(proxy, s.x, NULL));
  assert_petsc(ProxyGetContacts(proxy, &contacts));
  assert_petsc(SPHSetContacts(sph, 1, &contacts));
  assert_petsc(SPHPredict(sph, dt));
  assert_petsc(SPHSolvePressure(sph, dt, NULL, NULL));
  assert_petsc(SPHGetForces(sph));
  assert_petsc(SPHAdvance(sph, dt));
  Momentum(sph, after);
  assert_petsc(ProxyTransfer(proxy, contacts.force, contacts.moment, nodal));
  for (int a = 0; a < s.n_nodes; a++) {
    double m[3];
    Cross3(&s.x[3*a], &nodal[3*a], m);
    for (int k = 0; k < 3; k++) got[k] += nodal[3*a + k], got[3 + k] += m[k], size += fabs(nodal[3*a + k]);
  }
  for (int k = 0; k < 3; k++) {
    assert_close(dt*got[k], before[k] - after[k], tol, dt*size);
    assert_close(dt*got[3 + k], before[3 + k] - after[3 + k], tol, 0.1*dt*size);
  }
  // the turning fluid drags the surface along: most of the moment about the ball's axis is friction, pressure points through the centre
  assert_petsc(ProxyGetPoints(proxy, &n, &x, &normal, NULL, NULL));
  for (PetscInt b = 0; b < n; b++) {
    double r[3], m[3];
    Sub3(&x[3*b], center, r);
    Cross3(r, &contacts.force[3*b], m);
    along += m[2];
  }
  assert_true(along > 1e-3*size*3.0*DX);
  free(nodal);
  assert_petsc(ProxyDestroy(&proxy));
  assert_petsc(SPHDestroy(&sph));
  ShapeFree(&s);
}

/* round-off of the sums; the implicit step is solved to its own tolerance, but its friction is taken from the same velocities */
static void nodes_get_what_the_fluid_lost(void **state)
{
  (void)state;
  Check(SPH_VISCOSITY_EXPLICIT, 12, 1e-12);
  Check(SPH_VISCOSITY_EXPLICIT, 3, 1e-12);
  Check(SPH_VISCOSITY_IMPLICIT, 12, 1e-12);
}

CHECK_MAIN(cmocka_unit_test(nodes_get_what_the_fluid_lost))
