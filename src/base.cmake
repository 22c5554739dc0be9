# byssus_module(NAME SOURCES...): an object library of one module
function(byssus_module name)
  add_library(${name} OBJECT ${ARGN})
  target_link_libraries(${name} PUBLIC byssus_flags)
  set(MODULES ${MODULES} ${name} PARENT_SCOPE)
endfunction()

byssus_module(base src/keys.c src/scene.c src/scene_yaml.c src/scene_check.c src/scene_keys.c src/array.c src/backend.c src/surface.c src/surface_read.c src/course.c src/motion.c
  src/output.c src/output_file.c src/output_series.c src/output_xdmf.c src/output_table.c src/output_progress.c src/plot.c src/checkpoint.c
  src/sweep.c src/sweep_grid.c src/sweep_jobs.c src/sweep_table.c)

# results and checkpoints name the program's version
set_source_files_properties(src/output_series.c src/checkpoint.c PROPERTIES COMPILE_DEFINITIONS BY_VERSION="${PROJECT_VERSION}")

# messages quote what the user wrote and may cut it short: truncation by snprintf is meant
set_source_files_properties(src/keys.c src/scene.c src/scene_yaml.c src/scene_check.c src/scene_keys.c src/course.c src/sweep_grid.c src/sweep_table.c PROPERTIES COMPILE_OPTIONS
  "-Wno-format-truncation;-Wno-restrict")

# what the program says about itself; a tree without git has no revision
execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} describe --always --dirty --exclude=* OUTPUT_VARIABLE BYSSUS_REVISION OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET RESULT_VARIABLE no_git)
if(no_git OR NOT BYSSUS_REVISION)
  set(BYSSUS_REVISION unknown)
endif()
set_source_files_properties(src/backend.c PROPERTIES COMPILE_DEFINITIONS
  "BYSSUS_VERSION=\"${PROJECT_VERSION}\";BYSSUS_REVISION=\"${BYSSUS_REVISION}\"")
set_source_files_properties(src/plot.c PROPERTIES COMPILE_DEFINITIONS "BYSSUS_PLOT_PATH=\"${CMAKE_SOURCE_DIR}/src/plot/plot.py\"")

if(BYSSUS_SANITIZE)
  add_library(keep_loaded OBJECT tests/keep_loaded.c)
  target_link_libraries(byssus_flags INTERFACE $<TARGET_OBJECTS:keep_loaded>)
  target_link_options(byssus_flags INTERFACE -Wl,--export-dynamic-symbol=dlclose)
endif()

# installed: the program, its plot program where main.c looks for it, the library and the public headers
function(byssus_install)
  include(GNUInstallDirs)
  install(TARGETS byssus ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/byssus FILES_MATCHING PATTERN "*.h" PATTERN "*_impl.h" EXCLUDE)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/src/plot/ DESTINATION ${CMAKE_INSTALL_DATADIR}/byssus FILES_MATCHING PATTERN "*.py")
  if(TARGET byssus_program)
    install(TARGETS byssus_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endfunction()
cmake_language(DEFER CALL byssus_install)
