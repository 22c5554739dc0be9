# tests of sph
byssus_test(unit/sph/test_kernel base sph)
byssus_test(unit/sph/test_density base sph)
byssus_test(unit/sph/test_pressure base sph)
byssus_test(unit/sph/test_pbf base sph)
byssus_test(unit/sph/test_ksp base sph)
byssus_test(unit/sph/test_solvers base sph)
byssus_test(unit/sph/test_dfsph base sph)
byssus_test(unit/sph/test_motion base sph)
byssus_test(unit/sph/test_contacts base sph)
byssus_test(unit/sph/test_moving base sph)
byssus_test(unit/sph/test_threads base sph)
byssus_test(unit/sph/test_viscosity base sph)
byssus_test(unit/sph/test_gauge base sph)
byssus_test(unit/sph/test_closed base sph)
byssus_test(unit/sph/test_field base sph)
byssus_test(unit/sph/test_open base sph)
byssus_test(unit/sph/test_settle base sph)

# the device's loops against the CPU's; 77 = no device here
byssus_test(backend/test_sph_cuda base sph)
set_tests_properties(backend.sph_cuda PROPERTIES LABELS "backend;cuda" SKIP_RETURN_CODE 77)

# a minute: still water against rho g z; prints the table of docs/verification/fluid-slice.md
byssus_test(convergence/test_still_water base sph)

# hard cases with every solver: each prints what became of it as lines `hard fluid: case | solver | outcome | figures | seconds | within`
byssus_test(hard/test_fluid base sph)
# (isph, for closed flows, clumps what starts at a tenth of its density: it is in the report alone)
foreach(solver iisph_jacobi dfsph pcisph pbf wcsph)
  add_test(NAME hard.fluid.${solver} COMMAND test.hard.fluid -solver ${solver})
  set_tests_properties(hard.fluid.${solver} PROPERTIES LABELS hard TIMEOUT 600 ENVIRONMENT "OMPI_MCA_btl_base_warn_component_unused=0")
endforeach()
