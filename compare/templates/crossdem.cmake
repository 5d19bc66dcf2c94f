# Made by `crossdem init-ci`; yours to change. In CMakeLists.txt, after enable_testing():
#   include(cmake/crossdem.cmake)
# Then `ctest -L crossdem` runs it.
find_program(CROSSDEM crossdem HINTS "${CMAKE_CURRENT_SOURCE_DIR}/{{ crossdem }}" NO_CACHE)
if(CROSSDEM)
{% if engine %}
  add_test(NAME crossdem.conform
           COMMAND "${CROSSDEM}" conform "{{ engine }}"{{ ' "' ~ case ~ '"' if case }} --tier "{{ tier }}"
                   --out "${CMAKE_CURRENT_BINARY_DIR}/crossdem"
           WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
  set_tests_properties(crossdem.conform PROPERTIES LABELS crossdem TIMEOUT 7200)
{% else %}
{% if not case %}
  get_filename_component(CROSSDEM_FOLDER "${CROSSDEM}" REALPATH)
  get_filename_component(CROSSDEM_FOLDER "${CROSSDEM_FOLDER}" DIRECTORY)
{% endif %}
  add_test(NAME crossdem.check
           COMMAND "${CROSSDEM}" check "{{ case or '${CROSSDEM_FOLDER}/' ~ reference_case }}" --tier "{{ tier }}"
                   --out "${CMAKE_CURRENT_BINARY_DIR}/crossdem"
           WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
  set_tests_properties(crossdem.check PROPERTIES LABELS crossdem TIMEOUT 7200)
{% endif %}
else()
  message(STATUS "crossdem is neither on the PATH nor in {{ crossdem }}: its test is left out")
endif()
