/* Quadratic tetrahedra against an independent finite element code (DOLFINx 0.5.2 with PETSc 3.18.5, P2 elements, quadrature of degree 4)
   on the same vertices with straight edges. Prints a table.

   Beam: 1 x 0.1 x 0.1 m, clamped at x = 0, E 3 MPa, rho 1000 kg/m^3, body force 9810 N/m^3 in -z. Cook: 48 x 44/16 x 8 mm, clamped at
   x = 0, dead traction 6.25 MPa in y on x = 48 mm, mu 80.194 MPa, nu 0.499, sides free. The loads are integrated with the shape
   functions, as that code does. */
#include "tled/tled_implicit.h"
#include "unit/tled/body.h"

/* a constant load on a group, before SetUp */
static void AddLoad(TLED tled, const char group[], double body_force_z, double traction_y)
{
  TLEDLoadParams load;

  assert_petsc(KeysSetDefaults(TLEDLoadKeys, &load));
  AddName(&load.groups, group);
  load.body_force[2] = body_force_z;
  load.traction[1]   = traction_y;
  assert_petsc(TLEDAddLoad(tled, "load", &load));
}

static void Solve(TLED tled, double u[3], double x, double y, double z, double *energy)
{
  TLEDImplicit         implicit;
  TLEDImplicitParams  *p;
  const PetscReal     *at, *X;
  PetscInt             n;
  TLEDStats            stats;

  assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
  assert_petsc(TLEDImplicitGetParams(implicit, &p));
  p->tolerance = 1e-11;
  assert_petsc(TLEDImplicitSolveStatic(implicit, 0.0));
  assert_petsc(TLEDImplicitDestroy(&implicit));
  assert_petsc(TLEDGetPositions(tled, &at, NULL));
  assert_petsc(TLEDGetMesh(tled, NULL, NULL, &X));
  assert_petsc(TLEDGetStats(tled, &stats));
  n = NodeAt(tled, x, y, z);
  for (int k = 0; k < 3; k++) u[k] = at[3 * n + k] - X[3 * n + k];
  *energy = stats.strain;
}

/* The same discrete problem but for the quadrature: 14 points of degree 5 against theirs of degree 4. Degree 6 moves their own result on
   the next finer mesh by 7e-10 m and 3e-8 J. Four points differ visibly. */
static void Beam_BendsAsTheIndependentCodeSays(void **state)
{
  static const struct {
    int    material;
    double poisson, tip[3], energy;
  } beam[] = {
      {TLED_MATERIAL_NEO_HOOKEAN, 0.3, {-0.10569644949332496, 4.7867146247604976e-05, -0.42053229107652157}, 7.84175782818001},
      {TLED_MATERIAL_NEO_HOOKEAN, 0.45, {-0.10267040911691167, 4.033398895802594e-05, -0.4142409369273857}, 7.7058411362248584},
      {TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.3, {-0.10692294866062858, 5.226184891636547e-05, -0.4205581964906961}, 7.842809866776768},
      {TLED_MATERIAL_ST_VENANT_KIRCHHOFF, 0.45, {-0.10382819927560327, 6.945167607541742e-05, -0.41401433138183213}, 7.698896096888025}};

  /* by rule and law: 4 points are one of degree 2; the energy of St Venant and Kirchhoff is a quartic, which both codes integrate exactly */
  static const double allowed[2][2] = {{1e-3, 1e-3}, {1e-8, 1e-11}};

  (void)state;
  printf("material             nu    points  uz of the tip [m]  error     strain energy [J]  error\n");
  for (int i = 0; i < 8; i++) {
    const int   k = i / 2;
    TLEDParams *p;
    TLED        tled = NewBody("tests/meshes/beam_h1_order2.msh", &p);
    double      u[3], energy;

    AddName(&p->fixed, "clamp");
    p->element          = TLED_ELEMENT_T10;
    p->quadrature       = i % 2 ? TLED_QUADRATURE_14 : TLED_QUADRATURE_4;
    p->elastic.material = beam[k].material;
    p->elastic.poisson  = beam[k].poisson;
    AddLoad(tled, "solid", -9810.0, 0.0);
    assert_petsc(TLEDSetUp(tled));
    Solve(tled, u, 1.0, 0.05, 0.05, &energy);
    printf("%-19s  %.2f  %-6d  %-17.10f  %-8.1e  %-17.10f  %-8.1e\n", beam[k].material ? "st_venant_kirchhoff" : "neo_hookean",
           beam[k].poisson, i % 2 ? 14 : 4, u[2], fabs(u[2] / beam[k].tip[2] - 1), energy, fabs(energy / beam[k].energy - 1));
    for (int j = 0; j < 3; j++) assert_close(u[j], beam[k].tip[j], allowed[i % 2][beam[k].material], beam[k].tip[2]);
    assert_close(energy, beam[k].energy, allowed[i % 2][beam[k].material], beam[k].energy);
    assert_petsc(TLEDDestroy(&tled));
  }
}

static TLED Beam(TLEDParams **p)
{
  const PetscReal g[3] = {0.0, 0.0, -9.81};
  TLED            tled = NewBody("tests/meshes/beam_h1_order2.msh", p);

  AddName(&(*p)->fixed, "clamp");
  (*p)->element = TLED_ELEMENT_T10;
  assert_petsc(TLEDSetGravity(tled, g));
  return tled;
}

/* Gravity acts on the lumped masses, so that a body in free fall is not strained. It bends the beam as the body force does, but for the
   load's distribution within an element. */
static void Gravity_BendsLikeTheBodyForce(void **state)
{
  TLEDParams *p;
  TLED        tled = Beam(&p);
  double      u[3], energy;

  (void)state;
  p->quadrature = TLED_QUADRATURE_14;
  assert_petsc(TLEDSetUp(tled));
  Solve(tled, u, 1.0, 0.05, 0.05, &energy);
  printf("gravity on lumped masses: uz of the tip %.10f m (%+.1e of the body force's), strain energy %.10f J (%+.1e)\n", u[2],
         u[2] / -0.42053229107652157 - 1, energy, energy / 7.84175782818001 - 1);
  assert_close(u[2], -0.42053229107652157, 2e-3, u[2]);
  assert_petsc(TLEDDestroy(&tled));
}

/* near incompressibility, a bending and shearing panel: the independent code's P2, which is stiff by 3 % on this coarse mesh */
static void Cook_BendsAsTheIndependentCodeSays(void **state)
{
  static const double corner[3] = {-0.007100841216531811, 0.008089695366027463, 4.782085547362896e-05}, W = 3.114728695417849;
  static const double allowed[2] = {2e-2, 1e-5}; /* 4 points soften; 14 of degree 5 against theirs of degree 4, lambda 500 mu */

  (void)state;
  for (int i = 0; i < 2; i++) {
    TLEDParams *p;
    TLED        tled = NewBody("tests/meshes/cook_h1_order2.msh", &p);
    double      u[3], energy;

    AddName(&p->fixed, "clamp");
    p->element         = TLED_ELEMENT_AUTO;
    p->quadrature      = i ? TLED_QUADRATURE_14 : TLED_QUADRATURE_4;
    p->elastic.poisson = 0.499;
    p->elastic.young   = 2 * 80.194e6 * 1.499;
    AddLoad(tled, "load", 0.0, 6.25e6);
    assert_petsc(TLEDSetUp(tled));
    Solve(tled, u, 0.048, 0.06, 0.0, &energy);
    printf("cook, nu 0.499, %d points: uy of the top corner %.9f mm, error %.1e (%.1f %% of the converged 8.3259), energy %.8f J, error %.1e\n",
           i ? 14 : 4, 1e3 * u[1], fabs(u[1] / corner[1] - 1), 100 * (u[1] / 0.008325899217964183 - 1), energy, fabs(energy / W - 1));
    for (int j = 0; j < 3; j++) assert_close(u[j], corner[j], allowed[i], corner[1]);
    assert_close(energy, W, allowed[i], W);
    assert_petsc(TLEDDestroy(&tled));
  }
}

/* Gravity switched on: the first peak of the free end, 0.72443 m at 0.51342 s with consistent masses (fitted and extrapolated to dt = 0 by
   the independent code; here the largest sample). Lumped masses and four points may move both by 2e-3, ten times what refining the mesh
   does. Energy is kept. */
static void Release_PeaksWhereAndWhenItShould(void **state)
{
  TLEDParams      *p;
  TLED             tled = Beam(&p);
  const PetscReal *x;
  PetscReal        critical, peak = 0.0, time = 0.0, worst = 0.0;
  PetscInt         tip, n_all = 0;
  TLEDStats        s;

  (void)state;
  assert_petsc(TLEDSetUp(tled));
  tip = NodeAt(tled, 1.0, 0.05, 0.05);
  assert_petsc(TLEDGetCriticalStep(tled, &critical));
  for (int k = 1; k <= 600; k++) {
    PetscInt n;
    assert_petsc(TLEDAdvance(tled, 0.001, &n));
    assert_petsc(TLEDGetPositions(tled, &x, NULL));
    if (0.05 - x[3 * tip + 2] > peak) peak = 0.05 - x[3 * tip + 2], time = 0.001 * k;
    assert_petsc(TLEDGetStats(tled, &s));
    worst = fmax(worst, fabs(s.kinetic + s.strain + s.gravity_potential));
    n_all += n;
  }
  printf("release: critical step %.6e s, %d steps, peak %.6f m (reference 0.724432) at %.3f s (0.51342), energy error %.1e J\n",
         (double)critical, (int)n_all, (double)peak, (double)time, (double)worst);
  assert_close(peak, 0.7244323418889808, 2e-3, 0.7244);
  assert_close(time, 0.5134152377890416, 4e-3, 0.5134);
  assert_true(worst < 0.01);
  assert_petsc(TLEDDestroy(&tled));
}

/* Lowest frequencies: those of consistent masses [Hz], which lumped ones lower: bending (1 to 4) and stretching (6) a little, torsion (5)
   by 7 %, since the masses lie farther from the axis with one or two elements across. */
static void Modes_AreThoseOfTheBeam(void **state)
{
  static const double reference[6] = {0.8833298651555078, 0.883447998142793, 5.302905157459548, 5.305171580063405, 7.975577495127029,
                                      13.739137732697484};
  TLEDParams *p;
  TLED        tled;
  PetscBool   have;
  PetscReal   frequency[6], exact, found;

  (void)state;
  assert_petsc(TLEDHaveModes(&have));
  if (!have) skip();
  tled = Beam(&p);
  p->quadrature = TLED_QUADRATURE_14;
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDModes(PETSC_COMM_SELF, tled, 6, frequency, NULL));
  for (int i = 0; i < 6; i++) {
    printf("frequency %d: %.6f Hz (reference %.6f): %+.2e\n", i + 1, (double)frequency[i], reference[i], (double)(frequency[i] / reference[i] - 1));
    assert_close(frequency[i], reference[i], i == 4 ? 0.1 : 5e-3, reference[i]);
  }
  assert_petsc(TLEDExactCriticalStep(PETSC_COMM_SELF, tled, &exact));
  assert_petsc(TLEDGetCriticalStep(tled, &found));
  printf("critical step by power iteration %.6e s, by SLEPc %.6e s\n", (double)found, (double)exact);
  assert_close(found, exact, 0.02, exact); /* what power iteration is asked for */
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(Beam_BendsAsTheIndependentCodeSays), cmocka_unit_test(Gravity_BendsLikeTheBodyForce), cmocka_unit_test(Cook_BendsAsTheIndependentCodeSays),
           cmocka_unit_test(Release_PeaksWhereAndWhenItShould), cmocka_unit_test(Modes_AreThoseOfTheBeam))
