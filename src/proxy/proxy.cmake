# sources of src/proxy
byssus_module(proxy
  src/proxy/proxy.c src/proxy/proxy_keys.c src/proxy/proxy_fluid.c
  src/proxy/proxy_surface.c src/proxy/proxy_curvature.c src/proxy/proxy_grid.c src/proxy/proxy_sample.c
  src/proxy/proxy_density.c src/proxy/proxy_place.c src/proxy/proxy_mask.c src/proxy/proxy_wall.c src/proxy/proxy_patch.c src/proxy/proxy_ellipsoid.c src/proxy/proxy_contacts.c src/proxy/proxy_spread.c src/proxy/proxy_transfer.c)

# the readers of src/surface.h belong to base
target_sources(base PRIVATE ${CMAKE_SOURCE_DIR}/src/surface_read.c)
# accuracy of samplings and kernels without a fluid: cmake --build build --target bench.proxy
add_executable(bench.proxy EXCLUDE_FROM_ALL bench/bench_proxy.c $<TARGET_OBJECTS:base> $<TARGET_OBJECTS:sph> $<TARGET_OBJECTS:proxy>)
target_link_libraries(bench.proxy PRIVATE byssus_flags)

# what proxies cost a step: cmake --build build --target bench.contacts
add_executable(bench.contacts EXCLUDE_FROM_ALL bench/bench_contacts.c $<TARGET_OBJECTS:base> $<TARGET_OBJECTS:sph> $<TARGET_OBJECTS:proxy>)
target_link_libraries(bench.contacts PRIVATE byssus_flags)
