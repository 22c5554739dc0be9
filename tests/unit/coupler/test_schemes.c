/* A block of water hits a free elastic cube, a few steps with each scheme; which scheme a body gets. */
#include "check.h"
#include "coupler/coupler.h"

/* the scene with `keys` after it, built and set up */
static Coupler Build(const char keys[])
{
  const char *source = getenv("BYSSUS_SOURCE");
  char        mesh[PETSC_MAX_PATH_LEN];
  Coupler     c;

  assert_petsc(PetscOptionsClear(NULL));
  assert_petsc(PetscOptionsInsertString(NULL, "-domain_min -0.5,-0.5,-0.5 -domain_max 0.5,0.5,0.5 -sph_spacing 0.02 -sph_precision double -sph_fill block "
                                              "-sph_block_min -0.1,-0.05,-0.03 -sph_block_max -0.05,0.03,0.03 -sph_block_velocity 1.5,0.2,0.1 -bodies cube "
                                              "-cube_scale 0.08 -cube_translate -0.045,-0.045,-0.04 -cube_density 700 -cube_young 1e5 -cube_poisson 0.45"));
  assert_petsc(PetscSNPrintf(mesh, sizeof mesh, "%s/tests/meshes/cube_h1.msh", source));
  assert_petsc(PetscOptionsSetValue(NULL, "-cube_mesh", mesh));
  assert_petsc(PetscOptionsInsertString(NULL, keys));
  assert_petsc(CouplerCreate(PETSC_COMM_SELF, &c));
  assert_petsc(CouplerSetFromOptions(c));
  assert_petsc(CouplerSetUp(c));
  return c;
}

static void Run(Coupler c, int steps)
{
  PetscReal dt;

  for (int n = 0; n < steps; n++) assert_petsc(CouplerStep(c, 1e-3, &dt));
}

static void Scheme(const char keys[], const char expected[])
{
  Coupler     c = Build(keys);
  const char *name;

  assert_petsc(CouplerGetScheme(c, 0, &name));
  assert_string_equal(name, expected);
  assert_petsc(CouplerDestroy(&c));
}

/* method 5.3: what the water moves of the body, and whether the body can follow within a step */
static void the_scheme_goes_by_mass_and_stiffness(void **state)
{
  (void)state;
  Scheme("-cube_density 700", "iterated");
  Scheme("-cube_density 100000", "explicit");
  Scheme("-cube_density 700 -sph_solver pcisph", "iterated");
  Scheme("-cube_density 700 -coupler_scheme explicit", "explicit");
  Scheme("-cube_density 100000 -coupler_scheme mass", "mass");
  Scheme("-cube_density 700 -cube_young 1e14", "iterated"); // free: it moves as a whole, however stiff
  Scheme("-cube_density 700 -cube_young 1e4 -cube_fixed xmin,xmax,ymin,ymax,zmin,zmax", "explicit"); // held where it is wet
}

/* iterated to the end both sides have seen the same motion: round-off of the sum of products over some steps */
static void works_are_equal_when_iterated(void **state)
{
  static const char *const relaxations[] = {"-coupler_relaxation iqn_ils", "-coupler_relaxation aitken"};

  (void)state;
  for (int k = 0; k < 2; k++) {
    Coupler       c = Build("-coupler_scheme iterated -coupler_tolerance 1e-10 -coupler_iterations 50");
    CouplerLedger l;

    assert_petsc(PetscOptionsInsertString(NULL, relaxations[k]));
    Run(c, 10);
    assert_petsc(CouplerGetLedger(c, &l));
    assert_true(l.work_exchanged > 1e-5);
    assert_close(l.work_fluid, l.work_solid, 1e-8, l.work_exchanged);
    assert_true(l.interface_residual <= 1e-10);
    assert_petsc(CouplerDestroy(&c));
  }
}

/* what the water loses the cube gains, also with the contact force scaled and with forces that change over the substeps */
static void momentum_is_kept(void **state)
{
  static const char *const keys[] = {"-coupler_scheme mass", "-coupler_contact_coefficient 0.7", "-coupler_contact_coefficient 1.3 -coupler_scheme iterated",
                                     "-coupler_forces interpolated", "-coupler_scheme explicit -cube_density 100000 -coupler_forces interpolated"};

  (void)state;
  for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
    Coupler       c = Build(keys[k]);
    CouplerLedger before, after;

    assert_petsc(CouplerGetLedger(c, &before));
    Run(c, 8);
    assert_petsc(CouplerGetLedger(c, &after));
    assert_true(after.work_exchanged > 1e-6);
    for (int i = 0; i < 3; i++) {
      assert_close(after.momentum[i], before.momentum[i], 1e-12, before.momentum[0]);
      assert_close(after.angular[i], before.angular[i], 1e-12, before.angular[2]);
    }
    assert_petsc(CouplerDestroy(&c));
  }
}

/* forces that change over the substeps have the impulse of those that are held */
static void interpolated_forces_have_the_same_impulse(void **state)
{
  Coupler   c = Build("-coupler_forces interpolated -cube_young 1e7");
  TLED      tled;
  TLEDStats before, after;
  PetscReal force[3], dt;
  PetscInt  substeps;

  (void)state;
  assert_petsc(CouplerGetBody(c, 0, &tled, NULL));
  Run(c, 4);
  for (int n = 0; n < 4; n++) {
    assert_petsc(TLEDGetStats(tled, &before));
    assert_petsc(CouplerStep(c, 1e-3, &dt));
    assert_petsc(TLEDGetStats(tled, &after));
    assert_petsc(CouplerGetForce(c, 0, force));
    assert_petsc(TLEDGetSubsteps(tled, dt, &substeps));
    assert_true(substeps > 1);
    assert_true(fabs(force[0]) > 1e-3);
    // round-off of the momentum itself
    for (int i = 0; i < 3; i++) assert_close(after.momentum[i] - before.momentum[i], dt * force[i], 1e-12, after.momentum[0]);
  }
  assert_petsc(CouplerDestroy(&c));
}

CHECK_MAIN(cmocka_unit_test(the_scheme_goes_by_mass_and_stiffness), cmocka_unit_test(works_are_equal_when_iterated), cmocka_unit_test(momentum_is_kept),
           cmocka_unit_test(interpolated_forces_have_the_same_impulse))
