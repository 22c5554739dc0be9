# runs of the whole program: byssus_run_test(LABEL NAME): tests/<LABEL>/test_<NAME>.py
function(byssus_run_test label name)
  add_test(NAME ${label}.${name} COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/${label}/test_${name}.py)
  set_tests_properties(${label}.${name} PROPERTIES LABELS ${label} TIMEOUT 900
    ENVIRONMENT "BYSSUS=$<TARGET_FILE:byssus_program>;BYSSUS_SOURCE=${CMAKE_SOURCE_DIR}")
endfunction()

byssus_run_test(conservation free_body)
byssus_run_test(conservation impulse)
byssus_run_test(conservation resume)
byssus_run_test(conservation breakdown)
byssus_run_test(coupled fill)
byssus_run_test(coupled fields)
byssus_run_test(coupled floor)
byssus_run_test(coupled held_ball)
byssus_run_test(coupled moving)
byssus_run_test(coupled standing)
byssus_run_test(coupled floating_ball)
byssus_run_test(regression examples)
