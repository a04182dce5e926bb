# SPDX-License-Identifier: GPL-3.0-or-later
# Language level, warnings, sanitizers and compiler cache, the same for every target.
option(PHIZ_BUILD_TESTS "Build the tests" ON)
option(PHIZ_WERROR "Treat warnings as errors" ON)
option(PHIZ_UNITY "Compile sources in batches: half the time for all, more for one" ON)
option(PHIZ_SANITIZE "Build with AddressSanitizer and UndefinedBehaviorSanitizer" OFF)
# Binaries that hold IPOPT (EPL) are for measuring and must not be passed on: see benchmarks/README.md.
option(PHIZ_IPOPT "Compare with IPOPT where it is installed" ON)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
  set(CMAKE_C_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

add_library(phiz_flags INTERFACE)
target_compile_options(phiz_flags INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wno-unknown-pragmas)
if(PHIZ_UNITY)
  # In a batch the names of one file shadow those of another, and all of a file's own types look shared.
  target_compile_options(phiz_flags INTERFACE -Wno-shadow -Wshadow=local -Wno-subobject-linkage)
endif()
if(PHIZ_WERROR)
  target_compile_options(phiz_flags INTERFACE -Werror)
endif()
if(PHIZ_SANITIZE)
  # Checks of every pointer that is read double the time that Eigen takes to compile and find what AddressSanitizer does.
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
                      -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow)
  add_link_options(-fsanitize=address,undefined)
endif()
# GCC 12 reports false positives from inside inlined Eigen expressions at -O3, and for std::string operator+ (its bug 105651).
target_compile_options(phiz_flags INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict>)
