/* Velocity fields at the start have no divergence, the amplitude and the vorticity that they are asked for. */
#include "fluid.h"
#include "sph/sph_field.h"

#define STEP 1e-5 /* [m] of central differences: their error is step^2 k^3 U/6 + 1e-16 U/step, below 1e-9 */

static void At(int which, double a, double b, double uv[2])
{
  if (which == 0) SPHFieldTaylorGreen(1.5, 0.4, a, b, uv);
  if (which == 1) SPHFieldRotation(2.5, a, b, uv);
  if (which == 2) SPHFieldShear(2.5, a, b, uv);
  if (which == 3) SPHFieldStrain(2.5, a, b, uv);
}

/* du/da + dv/db = 0; vorticity dv/da - du/db as the headers say */
static void fields_have_no_divergence(void **state)
{
  const double k = 2 * BY_PI / 0.4;

  (void)state;
  for (int which = 0; which < 4; which++) {
    for (int i = 0; i < 25; i++) {
      const double a = 0.37 * sin(1.7 * i), b = 0.41 * cos(2.9 * i);
      double       right[2], left[2], up[2], down[2];

      At(which, a + STEP, b, right);
      At(which, a - STEP, b, left);
      At(which, a, b + STEP, up);
      At(which, a, b - STEP, down);
      const double divergence = (right[0] - left[0] + up[1] - down[1]) / (2 * STEP);
      const double vorticity  = (right[1] - left[1] - up[0] + down[0]) / (2 * STEP);
      const double wanted[]   = {2 * 1.5 * k * sin(k * a) * sin(k * b), 5.0, -2.5, 0.0};

      assert_close(divergence, 0.0, 1e-7, 1.5 * k);
      assert_close(vorticity, wanted[which], 1e-7, 1.5 * k);
    }
  }
}

/* the largest speed of the vortices is the amplitude, and it is reached a quarter of a wavelength from a vortex's edge */
static void amplitude_of_vortices(void **state)
{
  double uv[2], largest = 0.0;

  (void)state;
  for (int i = 0; i < 40; i++) {
    for (int j = 0; j < 40; j++) {
      At(0, 0.4 * i / 40, 0.4 * j / 40, uv);
      largest = fmax(largest, hypot(uv[0], uv[1]));
    }
  }
  assert_close(largest, 1.5, 1e-12, 1.5);
  At(0, 0.1, 0.0, uv);
  assert_close(uv[0], 1.5, 1e-12, 1.5);
}

/* a particle that stands for another volume than spacing^3 weighs that much more */
static void volume_of_a_particle(void **state)
{
  PetscReal mass[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    SPH sph = NewFluid(0.1);

    AddLattice(sph, 6, 6, 6, 0.1, 0.0, NULL);
    if (k) assert_petsc(SPHSetParticleVolume(sph, 1.02e-3));
    assert_petsc(SPHSetUp(sph));
    assert_petsc(SPHGetMass(sph, &mass[k]));
    assert_petsc(SPHDestroy(&sph));
  }
  assert_close(mass[1], 1.02 * mass[0], 1e-14, mass[0]);
}

CHECK_MAIN(cmocka_unit_test(fields_have_no_divergence), cmocka_unit_test(amplitude_of_vortices), cmocka_unit_test(volume_of_a_particle))
