/* The solid against CalculiX 2.20 on the same mesh: linear (C3D4) and quadratic tetrahedra with four integration points (C3D10), three laws.

   Cantilever 1 x 0.1 x 0.1 m clamped at x = 0, E 3 MPa, nu 0.3, rho 1000 kg/m^3, under its weight (9.81 m/s^2): *STATIC with NLGEOM to a residual
   of 1e-10. *ELASTIC with NLGEOM is St Venant-Kirchhoff; *HYPERELASTIC, NEO HOOKE with C10 = mu/2, D1 = 2/kappa and MOONEY-RIVLIN with C10 = 0.3 mu,
   C01 = 0.2 mu are the isochoric laws with kappa/2 (J - 1)^2. Printed with seven digits: displacement of the corner (1, 0.1, 0.1). */
#include "tled/tled_implicit.h"
#include "unit/tled/body.h"

typedef struct {
  const char *name, *mesh;
  int         element, material;
  double      u[3]; /* [m] */
} Row;

static const Row rows[] = {
    {"C3D4 St Venant-Kirchhoff", "tests/meshes/beam_h1.msh", TLED_ELEMENT_T4, TLED_MATERIAL_ST_VENANT_KIRCHHOFF, {-2.482509e-2, -8.931844e-4, -2.747346e-1}},
    {"C3D4 neo-Hookean", "tests/meshes/beam_h1.msh", TLED_ELEMENT_T4, TLED_MATERIAL_NEO_HOOKEAN_ISO, {-2.392244e-2, -1.101055e-3, -2.742959e-1}},
    {"C3D4 Mooney-Rivlin", "tests/meshes/beam_h1.msh", TLED_ELEMENT_T4, TLED_MATERIAL_MOONEY_RIVLIN, {-2.387914e-2, -1.103260e-3, -2.744250e-1}},
    {"C3D10 St Venant-Kirchhoff", "tests/meshes/beam_h1_order2.msh", TLED_ELEMENT_T10, TLED_MATERIAL_ST_VENANT_KIRCHHOFF, {-7.967888e-2, 4.730047e-5, -4.286839e-1}},
    {"C3D10 neo-Hookean", "tests/meshes/beam_h1_order2.msh", TLED_ELEMENT_T10, TLED_MATERIAL_NEO_HOOKEAN_ISO, {-7.847803e-2, 4.315079e-5, -4.290275e-1}},
    {"C3D10 Mooney-Rivlin", "tests/meshes/beam_h1_order2.msh", TLED_ELEMENT_T10, TLED_MATERIAL_MOONEY_RIVLIN, {-7.854414e-2, 4.403515e-5, -4.295266e-1}},
};

static void Displacement_IsThatOfCalculiX(void **state)
{
  const PetscReal      mu     = 3e6 / 2.6;
  const TLEDLoadParams weight = {.groups = {1, {"solid"}}, .body_force = {0.0, 0.0, -9810.0}}; /* integrated as CalculiX does */

  (void)state;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const Row       *row = &rows[i];
    TLEDParams      *p;
    TLED             tled = NewBody(row->mesh, &p);
    TLEDImplicit     implicit;
    const PetscReal *u;
    Vec              U;
    double           worst = 0.0;

    p->element          = row->element;
    p->elastic.material = row->material;
    if (row->material == TLED_MATERIAL_MOONEY_RIVLIN) p->elastic.young = 0.0, p->elastic.c10 = 0.3 * mu, p->elastic.c01 = 0.2 * mu;
    AddName(&p->fixed, "clamp");
    assert_petsc(TLEDAddLoad(tled, "weight", &weight));
    assert_petsc(TLEDSetUp(tled));
    assert_petsc(TLEDImplicitCreate(PETSC_COMM_SELF, tled, &implicit));
    assert_petsc(TLEDImplicitSolveStatic(implicit, 1.0));
    assert_petsc(TLEDGetVectors(tled, &U, NULL, NULL));
    assert_petsc(VecGetArrayRead(U, &u));
    const PetscInt tip = NodeAt(tled, 1.0, 0.1, 0.1);
    for (int k = 0; k < 3; k++) worst = fmax(worst, fabs(u[3 * tip + k] - row->u[k]));
    printf("calculix: %s | %.9g %.9g %.9g | largest difference %.1e m\n", row->name, u[3 * tip], u[3 * tip + 1], u[3 * tip + 2], worst);
    assert_petsc(VecRestoreArrayRead(U, &u));
    assert_true(worst < 6e-8); /* half of the last digit printed, 5e-8 */
    assert_petsc(TLEDImplicitDestroy(&implicit));
    assert_petsc(TLEDDestroy(&tled));
  }
}

CHECK_MAIN(cmocka_unit_test(Displacement_IsThatOfCalculiX))
