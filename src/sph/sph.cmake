# sources of src/sph
set(SPH_DEVICE "")
if(BYSSUS_HAVE_CUDA)
  set(SPH_DEVICE src/sph/sph_cuda.cu)
endif()
byssus_module(sph
  src/sph/sph_motion.c
  src/sph/sph.c src/sph/sph_arrays.c src/sph/sph_keys.c src/sph/sph_neighbors.c src/sph/sph_walls.c src/sph/sph_sums.c src/sph/sph_time.c src/sph/sph_stop.c
  src/sph/sph_viscosity.c src/sph/sph_smooth.c src/sph/sph_pressure.c src/sph/sph_iisph.c src/sph/sph_newton.c src/sph/sph_mprgp.c src/sph/sph_closed.c src/sph/sph_isph.c src/sph/sph_shift.c src/sph/sph_dfsph.c src/sph/sph_pcisph.c
  src/sph/sph_pbf.c src/sph/sph_wcsph.c src/sph/sph_ksp.c src/sph/sph_gauge.c src/sph/sph_patch.c src/sph/sph_state.c src/sph/sph_settle.c src/sph/sph_open.c src/sph/sph_open_setup.c
  src/sph/sph_openmp_single.c src/sph/sph_openmp_double.c ${SPH_DEVICE})
# no floating-point status flags: square roots and selections vectorise; nothing is reordered
set_source_files_properties(src/sph/sph_openmp_single.c src/sph/sph_openmp_double.c src/sph/sph_mprgp.c src/sph/sph_newton.c PROPERTIES COMPILE_OPTIONS "-O3;-fno-math-errno;-fno-trapping-math")
# speed and error of the fluid alone: cmake --build build --target bench.sph
add_executable(bench.sph EXCLUDE_FROM_ALL bench/bench_sph.c $<TARGET_OBJECTS:base> $<TARGET_OBJECTS:sph>)
target_link_libraries(bench.sph PRIVATE byssus_flags)
# the pressure system by every method, from the same states: cmake --build build --target bench.krylov
add_executable(bench.krylov EXCLUDE_FROM_ALL bench/bench_krylov.c $<TARGET_OBJECTS:base> $<TARGET_OBJECTS:sph>)
target_link_libraries(bench.krylov PRIVATE byssus_flags)
