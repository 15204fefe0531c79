# One INTERFACE target that our own targets link privately. Nothing here reaches
# a project that merely uses the library.
set(CAGEWRIGHT_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined")
option(CAGEWRIGHT_WERROR "Treat our own warnings as errors" OFF)

if(PROJECT_IS_TOP_LEVEL) # a parent project has its own
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release or RelWithDebInfo" FORCE)
  endif()
  find_program(CAGEWRIGHT_CCACHE ccache)
  if(CAGEWRIGHT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CAGEWRIGHT_CCACHE})
  endif()
endif()

add_library(cagewright_compiler INTERFACE)
target_compile_features(cagewright_compiler INTERFACE cxx_std_20)
target_include_directories(cagewright_compiler INTERFACE ${PROJECT_SOURCE_DIR}/src) # headers that are not installed
target_compile_options(cagewright_compiler INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
  -ffp-contract=off  # the same bits on every compiler, as the definitions below
  $<$<BOOL:${CAGEWRIGHT_WERROR}>:-Werror>)
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
