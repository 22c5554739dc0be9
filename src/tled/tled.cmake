# the solid: total Lagrangian explicit dynamics on tetrahedra
find_library(LAPACK_LIBRARY lapack REQUIRED) # PETSc's; the critical step calls syev
target_link_libraries(byssus_flags INTERFACE ${LAPACK_LIBRARY})
set(TLED_DEVICE "")
if(BYSSUS_HAVE_CUDA)
  set(TLED_DEVICE src/tled/tled_cuda.cu)
endif()
byssus_module(tled
  src/tled/tled.c src/tled/tled_keys.c src/tled/tled_gmsh.c src/tled/tled_mesh.c src/tled/tled_blocks.c
  src/tled/tled_materials.c src/tled/tled_field.c src/tled/tled_element.c src/tled/tled_openmp.c src/tled/tled_openmp_t10.c src/tled/tled_viscous.c
  src/tled/tled_energy.c src/tled/tled_mass.c src/tled/tled_breakdown.c src/tled/tled_relax.c src/tled/tled_critical.c src/tled/tled_time.c src/tled/tled_assembly.c src/tled/tled_tangent.c src/tled/tled_state.c
  src/tled/tled_constraint.c src/tled/tled_load.c src/tled/tled_contact.c
  src/tled/tled_device.c ${TLED_DEVICE})
# no floating-point status flags: comparisons vectorise; nothing is reordered
set_source_files_properties(src/tled/tled_openmp.c src/tled/tled_openmp_t10.c src/tled/tled_viscous.c PROPERTIES COMPILE_OPTIONS "-O3;-fno-math-errno;-fno-trapping-math")
# speed and error of the solid alone: cmake --build build --target bench.solid
add_executable(bench.solid EXCLUDE_FROM_ALL bench/bench_solid.c $<TARGET_OBJECTS:base> $<TARGET_OBJECTS:tled>)
target_link_libraries(bench.solid PRIVATE byssus_flags)
# the implicit solver
target_sources(tled PRIVATE src/tled/tled_implicit.c src/tled/tled_static.c src/tled/tled_newmark.c src/tled/tled_modes.c)
