find_package(Eigen3 3.4 REQUIRED)
find_package(TBB REQUIRED)
file(WRITE ${PROJECT_BINARY_DIR}/empty.cpp "")
add_library(cagewright_precompiled OBJECT ${PROJECT_BINARY_DIR}/empty.cpp)
target_link_libraries(cagewright_precompiled PRIVATE cagewright_compiler Eigen3::Eigen TBB::tbb)
target_precompile_headers(cagewright_precompiled PRIVATE ${CAGEWRIGHT_PRECOMPILED})
set_target_properties(cagewright_precompiled PROPERTIES POSITION_INDEPENDENT_CODE ON)

# cagewright_add_module(NAME mesh HEADERS ... SOURCES ... USES core ... [LINKS Eigen3::Eigen]
#                       [PRIVATE_LINKS ...] [PACKAGES "Eigen3 3.4" ...] [PKGCONFIG eigen3 ...])
#
# One folder, one target: cagewright::NAME, built from src/NAME. HEADERS is the public surface, in
# include/cagewright/NAME, included and installed as <cagewright/NAME/header.h>; the headers in
# src/NAME are for this repository alone and included as "NAME/header.h". LINKS are libraries that
# the public headers need, PRIVATE_LINKS those that only the sources need. PACKAGES are what
# find_package() must find before somebody can link the installed module, PKGCONFIG the same for
# pkg-config; the modules of USES bring their own.
function(cagewright_add_module)
  cmake_parse_arguments(PARSE_ARGV 0 M "" "NAME"
    "HEADERS;SOURCES;USES;LINKS;PRIVATE_LINKS;PACKAGES;PKGCONFIG")
  set(kind STATIC)
  set(scope PUBLIC)
  if(NOT M_SOURCES)
    set(kind INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(cagewright_${M_NAME} ${kind} ${M_SOURCES})
  add_library(cagewright::${M_NAME} ALIAS cagewright_${M_NAME})
  list(TRANSFORM M_HEADERS PREPEND ${PROJECT_SOURCE_DIR}/include/cagewright/${M_NAME}/)
  target_sources(cagewright_${M_NAME} ${scope}
    FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${M_HEADERS})
  target_include_directories(cagewright_${M_NAME} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set_target_properties(cagewright_${M_NAME} PROPERTIES
    VERIFY_INTERFACE_HEADER_SETS ON EXPORT_NAME ${M_NAME} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(cagewright_${M_NAME} ${scope} cxx_std_20)
  set(uses ${M_USES})
  list(TRANSFORM uses PREPEND cagewright::)
  target_link_libraries(cagewright_${M_NAME} ${scope} ${uses} ${M_LINKS})
  if(M_SOURCES)
    target_link_libraries(cagewright_${M_NAME} PRIVATE $<BUILD_INTERFACE:cagewright_compiler> ${M_PRIVATE_LINKS})
    target_precompile_headers(cagewright_${M_NAME} REUSE_FROM cagewright_precompiled)
    # Read from a precompiled header, the compiler's own headers of vector instructions alarm g++.
    list(FILTER M_SOURCES INCLUDE REGEX "_simd\\.cpp$")
    set_source_files_properties(${M_SOURCES} PROPERTIES SKIP_PRECOMPILE_HEADERS ON
      COMPILE_DEFINITIONS "${CAGEWRIGHT_SIMD_DEFINITIONS}")
  endif()
  # An export of its own: who asks for one component meets no dependency of another (see Install.cmake).
  set_property(GLOBAL APPEND PROPERTY CAGEWRIGHT_MODULES ${M_NAME})
  foreach(what USES PACKAGES PKGCONFIG)
    set_property(GLOBAL PROPERTY CAGEWRIGHT_${M_NAME}_${what} "${M_${what}}")
  endforeach()
  if(CAGEWRIGHT_INSTALL)
    install(TARGETS cagewright_${M_NAME} EXPORT cagewright_${M_NAME}
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
      FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
    install(EXPORT cagewright_${M_NAME} NAMESPACE cagewright:: FILE cagewright-${M_NAME}.cmake
      DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cagewright COMPONENT development)
  endif()
endfunction()

# cagewright_add_tests(mesh FILES topology_test.cpp ... USES mesh ... [SLOW "Suite.Case*" ...]): one
# program per folder of tests, mesh_test, built from tests/mesh; each case is a test of its own for
# ctest, with the label mesh. Cases whose names match SLOW have the label mesh-slow: the runs with
# sanitizers leave them out.
function(cagewright_add_tests name)
  cmake_parse_arguments(PARSE_ARGV 1 T "" "" "FILES;USES;LINKS;SLOW")
  list(TRANSFORM T_USES PREPEND cagewright::)
  add_executable(${name}_test ${T_FILES})
  target_link_libraries(${name}_test PRIVATE
    cagewright_compiler cagewright_test_support ${T_USES} ${T_LINKS} GTest::gtest_main)
  if(NOT cagewright_app IN_LIST T_LINKS) # Qt asks for code of another kind
    target_precompile_headers(${name}_test REUSE_FROM cagewright_test_precompiled)
  endif()
  # Limits are for cases that hang, and long enough for a sanitizer build on a busy machine.
  set(common TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 600)
  list(JOIN T_SLOW ":" slow)
  if(slow)
    gtest_discover_tests(${name}_test ${common} TEST_FILTER "${slow}" TEST_LIST ${name}_slow_cases
      PROPERTIES LABELS ${name}-slow TIMEOUT 3600)
    gtest_discover_tests(${name}_test ${common} TEST_FILTER "-${slow}" PROPERTIES LABELS ${name} TIMEOUT 1800)
  else()
    gtest_discover_tests(${name}_test ${common} PROPERTIES LABELS ${name} TIMEOUT 1800)
  endif()
endfunction()
