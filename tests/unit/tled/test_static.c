/* The static solution of the discrete problem is the one that an independent finite element code finds on the same mesh: DOLFINx 0.5.2, P1
   elements, Newton to 1e-9; neo-Hookean and St Venant-Kirchhoff cantilever 1 x 0.1 x 0.1 m clamped at x = 0, E 3 MPa, rho 1000, g 9.81 in
   -z; meshes beam_h1 and h2 with 464 and 1740 elements (beam_h3: tests/convergence/test_tled_static.c). It took 34 or 35 Newton iterations in load steps. */
#include "unit/tled/body.h"
#include "tled/tled_implicit.h"

#define TOL 1e-8 /* both codes' Newton tolerance, relative to the displacement */

typedef struct {
  const char *mesh;
  int         material;
  double      poisson, tip[3], energy; /* tip centre [m], strain energy [J] */
} Reference;

static const Reference reference[] = {
    {"h1", TLED_MATERIAL_NEO_HOOKEAN, 0.30, {-0.04142484237735666, -0.0009972955093733896, -0.2709548025632535}, 5.317299312167156},
    {"h2", TLED_MATERIAL_NEO_HOOKEAN, 0.30, {-0.0699426402226059, -0.0012685459146781549, -0.345839747271417}, 6.569205761610543},
    {"h1", TLED_MATERIAL_NEO_HOOKEAN, 0.45, {-0.025593659167204127, -0.0013157307281949477, -0.21439682744396152}, 4.234257721621486},
    {"h2", TLED_MATERIAL_NEO_HOOKEAN, 0.45, {-0.05534705712489771, -0.0012381704338385233, -0.30795936798429296}, 5.8353545057149185},
    {"h1", TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.30, {-0.042361426579887194, -0.0007976745029058303, -0.27165781027625807}, 5.341168338410373},
    {"h2", TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.30, {-0.07122273038744788, -0.001185827296211843, -0.34663580534087773}, 6.5926365475208755},
    {"h1", TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.45, {-0.02631445146114603, -0.0011003582678427604, -0.21481358917485185}, 4.248196232583419},
    {"h2", TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.45, {-0.05665355438003953, -0.000987292178265426, -0.30909323228393804}, 5.867932346626014},
};

static void Solve(const Reference *ref)
{
  const PetscReal   g[3] = {0.0, 0.0, -9.81};
  TLEDParams       *p;
  char              path[64];
  TLED              tled;
  TLEDImplicit      implicit;
  TLEDImplicitStats it;
  TLEDStats         stats;
  const PetscReal  *x;
  Vec               u;
  PetscInt          tip;

  snprintf(path, sizeof path, "tests/meshes/beam_%s.msh", ref->mesh);
  tled = NewBody(path, &p);
  p->elastic.material = ref->material;
  p->elastic.poisson  = ref->poisson;
  AddName(&p->fixed, "clamp");
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
  assert_petsc(TLEDImplicitSetFromOptions(implicit));
  assert_petsc(TLEDImplicitSolveStatic(implicit, 0.0));
  assert_petsc(TLEDImplicitGetStats(implicit, &it));
  assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
  tip = NodeAt(tled, 1.0, 0.05, 0.05);
  assert_petsc(VecGetArrayRead(u, &x));
  assert_petsc(TLEDGetStats(tled, &stats));
  printf("%s material %d nu %.2f: tip off by %.1e, energy by %.1e of the other code's; %d load steps, %d taken back, %d Newton iterations, %d linear, residual %.1e, %.2f s\n",
         ref->mesh, ref->material, ref->poisson, fabs(x[3 * tip + 2] / ref->tip[2] - 1), fabs(stats.strain / ref->energy - 1),
         (int)it.load_steps, (int)it.cuts, (int)it.newton, (int)it.linear, it.residual, it.seconds);
  for (int k = 0; k < 3; k++) assert_close(x[3 * tip + k], ref->tip[k], TOL, ref->tip[2]);
  assert_close(stats.strain, ref->energy, TOL, ref->energy);
  assert_true(it.newton <= 34);
  assert_petsc(VecRestoreArrayRead(u, &x));
  assert_petsc(TLEDImplicitDestroy(&implicit));
  assert_petsc(TLEDDestroy(&tled));
}

static void Cantilever_IsTheOtherCodes(void **state)
{
  (void)state;
  for (size_t i = 0; i < sizeof reference / sizeof *reference; i++) Solve(&reference[i]);
}

CHECK_MAIN(cmocka_unit_test(Cantilever_IsTheOtherCodes))
