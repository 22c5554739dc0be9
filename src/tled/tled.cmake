# the solid: total Lagrangian explicit dynamics on tetrahedra
find_library(LAPACK_LIBRARY lapack REQUIRED) # PETSc's; the critical step calls syev
target_link_libraries(byssus_flags INTERFACE ${LAPACK_LIBRARY})
byssus_module(tled src/tled/tled.c src/tled/tled_keys.c src/tled/tled_gmsh.c src/tled/tled_mesh.c src/tled/tled_blocks.c
              src/tled/tled_openmp.c src/tled/tled_energy.c src/tled/tled_critical.c src/tled/tled_time.c src/tled/tled_tangent.c
              src/tled/tled_state.c)
