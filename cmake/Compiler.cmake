# One INTERFACE target that our own targets link privately. Nothing here reaches
# a project that merely uses the library.
set(CAGEWRIGHT_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined")
# Plain scalar code, SSE4, AVX2 and AVX-512 (or those of another architecture): what lies between them
# would only make the program larger. With sanitizers, which are slow to compile, one is enough.
set(CAGEWRIGHT_SIMD_DEFINITIONS "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_AVX3_DL)" CACHE STRING
  "Definitions that choose the instructions that Highway compiles for")
option(CAGEWRIGHT_WERROR "Treat our own warnings as errors" OFF)

if(PROJECT_IS_TOP_LEVEL) # a parent project has its own
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release or RelWithDebInfo" FORCE)
  endif()
  find_program(CAGEWRIGHT_CCACHE ccache)
  if(CAGEWRIGHT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    # What ccache needs to know of precompiled headers.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros
      ${CAGEWRIGHT_CCACHE})
  endif()
endif()

add_library(cagewright_compiler INTERFACE)
target_compile_features(cagewright_compiler INTERFACE cxx_std_20)
target_include_directories(cagewright_compiler INTERFACE ${PROJECT_SOURCE_DIR}/src) # headers that are not installed
target_compile_options(cagewright_compiler INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
  -ffp-contract=off  # the same bits on every compiler, as the definitions below
  $<$<BOOL:${CAGEWRIGHT_WERROR}>:-Werror>)
# With -O3, g++ 12 takes strings that are moved or joined for out of bounds (GCC bug 105651 and its
# kin), now in this file, now in that; -O2 and other compilers look after the real ones.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_BUILD_TYPE STREQUAL Release AND
   CMAKE_CXX_FLAGS_RELEASE MATCHES "-O3")
  target_compile_options(cagewright_compiler INTERFACE
    -Wno-array-bounds -Wno-stringop-overread -Wno-stringop-overflow)
endif()
# Eigen sums in the order of the packets that a compiler and a processor suggest. Without packets it
# has one order. What is aligned stays so: our objects and those of a program that has packets agree.
# (Only fixed sizes of 3, which have no alignment, cross the public headers.)
target_compile_definitions(cagewright_compiler INTERFACE
  EIGEN_DONT_VECTORIZE EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MAX_STATIC_ALIGN_BYTES=16)
# 32-bit x86 would otherwise round to 80 bits first.
if(CMAKE_SIZEOF_VOID_P EQUAL 4 AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86|i.86|AMD64")
  target_compile_options(cagewright_compiler INTERFACE -msse2 -mfpmath=sse)
endif()
if(CAGEWRIGHT_SANITIZE)
  target_compile_options(cagewright_compiler INTERFACE
    -fsanitize=${CAGEWRIGHT_SANITIZE} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(cagewright_compiler INTERFACE -fsanitize=${CAGEWRIGHT_SANITIZE})
endif()

# Two thirds of the time of compiling is reading Eigen, TBB and the standard library: they are read
# once for all modules, and once, with GoogleTest, for all tests (see Module.cmake, tests/).
set(CAGEWRIGHT_PRECOMPILED <Eigen/Core> <Eigen/Geometry> <tbb/blocked_range.h> <tbb/parallel_for.h>
  <algorithm> <array> <cmath> <functional> <limits> <map> <memory> <optional> <span> <string>
  <string_view> <utility> <variant> <vector>)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(cagewright_compiler INTERFACE -fpch-preprocess) # for ccache
elseif(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
  target_compile_options(cagewright_compiler INTERFACE "SHELL:-Xclang -fno-pch-timestamp") # likewise
endif()
