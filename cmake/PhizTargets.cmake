# SPDX-License-Identifier: GPL-3.0-or-later
# phiz_library(NAME SOURCES ... DEPENDS ... PRIVATE ...): the folder's library phiz_NAME, alias phiz::NAME.
# DEPENDS are public (their headers appear in ours); PRIVATE ones stay inside the sources.
function(phiz_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  add_library(phiz_${name} STATIC ${ARG_SOURCES})
  add_library(phiz::${name} ALIAS phiz_${name})
  target_include_directories(phiz_${name} PUBLIC "${PROJECT_SOURCE_DIR}/src")
  target_link_libraries(phiz_${name} PUBLIC ${ARG_DEPENDS} PRIVATE $<BUILD_INTERFACE:phiz_flags> ${ARG_PRIVATE})
endfunction()

# phiz_test(NAME SOURCES ... LIBS ... [LABELS ...]): one GoogleTest executable test_NAME, every test known to CTest.
function(phiz_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS;LABELS" ${ARGN})
  add_executable(test_${name} ${ARG_SOURCES})
  target_link_libraries(test_${name} PRIVATE phiz_flags ${ARG_LIBS} GTest::gtest_main)
  target_include_directories(test_${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  add_dependencies(tests test_${name})
  set(prefix "")
  if(PHIZ_SANITIZE)
    set(prefix "sanitized.")
  endif()
  gtest_discover_tests(test_${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX "${prefix}"
                       PROPERTIES LABELS "${ARG_LABELS}" WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
endfunction()
