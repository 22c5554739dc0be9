/* kernels and half-space volumes against integrals and differences (method 1, 2, 6) */
#include "check.h"
#include "sph/sph_kernel.h"

static const double H = 0.7;

static void KernelIntegratesToOne(void **state)
{
  (void)state;
  for (int kernel = 0; kernel < SPH_N_KERNELS; kernel++) {
    const int n   = 4000;
    double    sum = 0.0;

    for (int i = 0; i < n; i++) {
      const double r = (i + 0.5) * H / n;
      sum += 4.0 * BY_PI * r * r * SPHKernelW(kernel, r, H) * H / n;
    }
    assert_close(sum, 1.0, 1e-6, 1.0); // midpoint rule, (1/n)^2
    assert_true(SPHKernelW(kernel, H, H) == 0.0 && SPHKernelF(kernel, 1.01 * H, H) == 0.0);
  }
}

static void GradientIsTheDifference(void **state)
{
  const double e = 1e-5;

  (void)state;
  for (int kernel = 0; kernel < SPH_N_KERNELS; kernel++)
    for (double r = 0.03; r < H; r += 0.041) assert_close(r * SPHKernelF(kernel, r, H), (SPHKernelW(kernel, r + e, H) - SPHKernelW(kernel, r - e, H)) / (2 * e), 1e-7, 1.0 / (H * H * H * H));
}

/* volume of the kernel beyond a plane: shells of radius r, the part 1/2 (1 - d/r) of each */
static double Beyond(int kernel, double d)
{
  const int n   = 20000;
  double    sum = 0.0;

  for (int i = 0; i < n; i++) {
    const double r = (i + 0.5) * H / n;
    double       c = 1.0 - d / r;
    c              = c < 0 ? 0 : c > 2 ? 2 : c;
    sum += 2.0 * BY_PI * r * r * c * SPHKernelW(kernel, r, H) * H / n;
  }
  return sum;
}

static void HalfSpaceIsTheVolumeBeyond(void **state)
{
  const double e = 1e-5;

  (void)state;
  for (int kernel = 0; kernel < SPH_N_KERNELS; kernel++) {
    for (double d = -0.69; d < 0.75; d += 0.0573) {
      assert_close(SPHHalfSpace(kernel, d, H), Beyond(kernel, d), 1e-6, 1.0); // midpoint rule
      assert_close(SPHHalfSpaceSlope(kernel, d, H), (SPHHalfSpace(kernel, d + e, H) - SPHHalfSpace(kernel, d - e, H)) / (2 * e), 1e-8, 1.0 / H);
      assert_close(SPHHalfSpace(kernel, -d, H), 1.0 - SPHHalfSpace(kernel, d, H), 1e-14, 1.0);
    }
  }
}

static void DistanceInvertsTheHalfSpace(void **state)
{
  (void)state;
  for (int kernel = 0; kernel < SPH_N_KERNELS; kernel++)
    for (double q = 0.01; q < 0.9; q += 0.037) assert_close(SPHHalfSpaceDistance(kernel, SPHHalfSpace(kernel, q, 1.0)), q, 1e-6, 1.0); // its bracket
}

CHECK_MAIN(cmocka_unit_test(KernelIntegratesToOne), cmocka_unit_test(GradientIsTheDifference), cmocka_unit_test(HalfSpaceIsTheVolumeBeyond),
           cmocka_unit_test(DistanceInvertsTheHalfSpace))
