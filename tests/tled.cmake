# tests of tled
byssus_test(unit/tled/test_material)
byssus_test(unit/tled/test_force base tled)
byssus_test(unit/tled/test_prony base tled)
byssus_test(unit/tled/test_materials base tled)
byssus_test(unit/tled/test_static base tled)
byssus_test(unit/tled/test_time base tled)
byssus_test(unit/tled/test_critical base tled)
byssus_test(unit/tled/test_constraint base tled)
byssus_test(unit/tled/test_load base tled)
byssus_test(unit/tled/test_contact base tled)
byssus_test(unit/tled/test_mass base tled)
byssus_test(unit/tled/test_relax base tled)
byssus_test(unit/tled/test_breakdown base tled)
byssus_test(unit/tled/test_mesh base tled)
byssus_test(unit/tled/test_t10 base tled)
byssus_test(unit/tled/test_t10_body base tled)
byssus_test(unit/tled/test_device_loops base tled)

# in time, against another code; prints the table of docs/verification/solid.md
byssus_test(convergence/test_tled_reference base tled)
byssus_test(convergence/test_tled_calculix base tled)
byssus_test(convergence/test_tled_t10 base tled)

# the mesh maker, as a user calls it
add_test(NAME unit.tled.solid_from_surface COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/unit/tled/test_solid_from_surface.py)
set_tests_properties(unit.tled.solid_from_surface PROPERTIES LABELS unit TIMEOUT 300)

# the device's loops against the CPU's; 77 = no device here
byssus_test(backend/test_tled_cuda base tled)
set_tests_properties(backend.tled_cuda PROPERTIES LABELS "backend;cuda" SKIP_RETURN_CODE 77)

# the reader of meshes; what PETSc's reader loses when it gives up is not ours
byssus_test(fuzz/test_tled_mesh base tled)
set_property(TEST fuzz.tled_mesh APPEND PROPERTY ENVIRONMENT "ASAN_OPTIONS=detect_leaks=0")

# the implicit solver and natural frequencies; 77 = built without SLEPc
byssus_test(unit/tled/test_modes base tled)
set_tests_properties(unit.tled.modes PROPERTIES SKIP_RETURN_CODE 77)
byssus_test(convergence/test_tled_static base tled)
byssus_test(unit/tled/test_implicit base tled)
byssus_test(unit/tled/test_implicit_contact base tled)
byssus_test(unit/tled/test_implicit_energy base tled)
byssus_test(convergence/test_tled_dynamic base tled)

# on two processes
byssus_test(unit/tled/test_parallel base tled)
find_program(MPIRUN mpirun)
if(MPIRUN)
  add_test(NAME unit.tled.parallel_2 COMMAND ${MPIRUN} -n 2 --oversubscribe $<TARGET_FILE:test.unit.tled.parallel>)
  set_tests_properties(unit.tled.parallel_2 PROPERTIES LABELS unit TIMEOUT 600 PROCESSORS 2 ENVIRONMENT
    "BYSSUS_SOURCE=${CMAKE_SOURCE_DIR};OMP_NUM_THREADS=1;OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_btl_base_warn_component_unused=0")
endif()
# hard cases: each prints what it measured as lines `hard: case | quantity | measured | allowed`
byssus_test(hard/test_static base tled)
byssus_test(hard/test_motion base tled)
