# SPDX-License-Identifier: GPL-3.0-or-later
# phiz_unity(TARGET SOURCE ...): compiles the sources in batches, where PHIZ_UNITY asks for it. Kernels that are compiled
# once for each instruction set (Highway's foreach_target) stay alone, and what changes with every commit.
function(phiz_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${PHIZ_UNITY} UNITY_BUILD_BATCH_SIZE 6)
  list(FILTER ARGN INCLUDE REGEX "_kernel\\.cpp$|polar3\\.cpp$|version\\.cpp$")
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# phiz_library(NAME SOURCES ... DEPENDS ... PRIVATE ...): the folder's library phiz_NAME, alias phiz::NAME.
# DEPENDS are public (their headers appear in ours); PRIVATE ones stay inside the sources.
function(phiz_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  add_library(phiz_${name} STATIC ${ARG_SOURCES})
  add_library(phiz::${name} ALIAS phiz_${name})
  phiz_unity(phiz_${name} ${ARG_SOURCES})
  target_include_directories(phiz_${name} PUBLIC "${PROJECT_SOURCE_DIR}/src")
  target_link_libraries(phiz_${name} PUBLIC ${ARG_DEPENDS} PRIVATE $<BUILD_INTERFACE:phiz_flags> ${ARG_PRIVATE})
endfunction()

# phiz_test_program(NAME SOURCES ... LIBS ...): a GoogleTest executable test_NAME.
function(phiz_test_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(test_${name} ${ARG_SOURCES})
  phiz_unity(test_${name} ${ARG_SOURCES})
  target_link_libraries(test_${name} PRIVATE phiz_flags ${ARG_LIBS} GTest::gtest_main)
  target_include_directories(test_${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  add_dependencies(tests test_${name})
endfunction()

# phiz_test(NAME SOURCES ... LIBS ... [LABELS ...] [FIXTURES ...]): one whose tests are all known to CTest.
function(phiz_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS;LABELS;FIXTURES" ${ARGN})
  phiz_test_program(${name} SOURCES ${ARG_SOURCES} LIBS ${ARG_LIBS})
  set(prefix "")
  if(PHIZ_SANITIZE)
    set(prefix "sanitized.")
  endif()
  set(properties "")  # an empty value would be taken for the next name
  if(ARG_LABELS)
    list(APPEND properties LABELS ${ARG_LABELS})
  endif()
  if(ARG_FIXTURES)
    list(APPEND properties FIXTURES_REQUIRED ${ARG_FIXTURES})
  endif()
  gtest_discover_tests(test_${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX "${prefix}"
                       WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}" PROPERTIES ${properties})
endfunction()

# phiz_shared_test(NAME TEST SOURCES ... LIBS ...): one that is a single test TEST to CTest, in one process: its tests
# share what is dear to make, a head. Begun before others, as it takes long.
function(phiz_shared_test name test)
  phiz_test_program(${name} ${ARGN})
  add_test(NAME ${test} COMMAND test_${name} WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
  set_tests_properties(${test} PROPERTIES COST 100)
endfunction()
