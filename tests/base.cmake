# tests of base
byssus_test(unit/scene/test_keys base)
byssus_test(unit/scene/test_scene base)
byssus_test(unit/scene/test_scene_errors base)
byssus_test(unit/scene/test_array base)
byssus_test(unit/scene/test_course base)

# the command line: src/main.c with the simulation of tests/cli/sample.c
add_executable(test.cli.sample cli/sample.c ${CMAKE_SOURCE_DIR}/src/main.c $<TARGET_OBJECTS:base>)
target_link_libraries(test.cli.sample PRIVATE byssus_flags)

# byssus_script(NAME PROGRAM): tests/cli/test_NAME.py with the path of PROGRAM in BYSSUS
function(byssus_script name program)
  add_test(NAME cli.${name} COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/cli/test_${name}.py)
  set_tests_properties(cli.${name} PROPERTIES LABELS cli TIMEOUT 300
    ENVIRONMENT "BYSSUS=$<TARGET_FILE:${program}>;BYSSUS_SOURCE=${CMAKE_SOURCE_DIR}")
endfunction()
byssus_script(statuses test.cli.sample)
byssus_script(layout byssus_program)
byssus_script(formulas byssus_program)
byssus_script(program byssus_program)
byssus_script(verify byssus_program)
byssus_script(bad_input byssus_program)
byssus_script(sweep byssus_program)
byssus_test(unit/scene/test_schema base sph tled proxy coupler)
byssus_test(fuzz/test_scene_mutations base)

# results on disk
byssus_test(unit/output/test_series base)
byssus_test(unit/output/test_checkpoint base)
byssus_test(unit/output/test_table base)
# output_script(NAME LABEL ENVIRONMENT...): unit/output/test_NAME.py
function(output_script name label)
  add_test(NAME ${label}.output.${name} COMMAND /usr/bin/python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/unit/output/test_${name}.py)
  set_tests_properties(${label}.output.${name} PROPERTIES LABELS ${label} TIMEOUT 600 ENVIRONMENT "BYSSUS_SOURCE=${CMAKE_SOURCE_DIR};${ARGN}")
endfunction()
output_script(results unit BYSSUS_SERIES=$<TARGET_FILE:test.unit.output.series>)
output_script(plot cli)
