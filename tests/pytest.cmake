# crossdem_add_pytests(LABEL SECONDS [LABEL...]): every test_*.py of this folder as one CTest test, against this build's
# solver.
function(crossdem_add_pytests label timeout_s)
  file(GLOB test_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/test_*.py)
  set(labels ${label} ${ARGN})
  foreach(test_file IN LISTS test_files)
    get_filename_component(stem ${test_file} NAME_WE)
    set(test_name ${label}.${stem})
    add_test(NAME ${test_name}
             COMMAND /usr/bin/python3 -m pytest -q -p no:cacheprovider ${test_file}
             WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${test_name} PROPERTIES
      LABELS "${labels}"
      TIMEOUT ${timeout_s}
      ENVIRONMENT "PYTHONPATH=${PROJECT_SOURCE_DIR};PYTHONDONTWRITEBYTECODE=1;CROSSDEM_SOLVER=$<TARGET_FILE:crossdem-solver>")
  endforeach()
endfunction()
