# tests of sph
byssus_test(unit/sph/test_kernel base sph)
byssus_test(unit/sph/test_density base sph)
byssus_test(unit/sph/test_pressure base sph)
byssus_test(unit/sph/test_motion base sph)
byssus_test(unit/sph/test_contacts base sph)
byssus_test(unit/sph/test_threads base sph)
byssus_test(unit/sph/test_viscosity base sph)
