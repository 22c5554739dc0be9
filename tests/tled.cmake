# tests of tled
byssus_test(unit/tled/test_material)
byssus_test(unit/tled/test_force base tled)
byssus_test(unit/tled/test_static base tled)
byssus_test(unit/tled/test_time base tled)
byssus_test(unit/tled/test_critical base tled)
byssus_test(unit/tled/test_mesh base tled)

# the mesh maker, as a user calls it
add_test(NAME unit.tled.solid_from_surface COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/unit/tled/test_solid_from_surface.py)
set_tests_properties(unit.tled.solid_from_surface PROPERTIES LABELS unit TIMEOUT 300)

# speed against error: not a test, built with `ninja bench_tled`
add_executable(bench_tled EXCLUDE_FROM_ALL ${CMAKE_SOURCE_DIR}/bench/bench_tled.c $<TARGET_OBJECTS:base> $<TARGET_OBJECTS:tled>)
target_link_libraries(bench_tled PRIVATE byssus_flags)
