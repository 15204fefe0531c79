# What find_package(cagewright) and pkg-config need. The modules install themselves (see Module.cmake).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/cagewright)
get_property(modules GLOBAL PROPERTY CAGEWRIGHT_MODULES)

# One target for everything, in this tree as in the installed package.
add_library(cagewright_everything INTERFACE)
add_library(cagewright::cagewright ALIAS cagewright_everything)

set(CAGEWRIGHT_MODULE_TABLE "")
set(libraries "")
set(requirements "")
foreach(module IN LISTS modules)
  target_link_libraries(cagewright_everything INTERFACE cagewright::${module})
  foreach(what USES PACKAGES)
    get_property(value GLOBAL PROPERTY CAGEWRIGHT_${module}_${what})
    string(TOLOWER ${what} key)
    string(APPEND CAGEWRIGHT_MODULE_TABLE "set(_cagewright_${module}_${key} \"${value}\")\n")
  endforeach()
  get_target_property(kind cagewright_${module} TYPE)
  if(kind STREQUAL STATIC_LIBRARY)
    list(PREPEND libraries -lcagewright_${module}) # who uses comes before what is used
  endif()
  get_property(value GLOBAL PROPERTY CAGEWRIGHT_${module}_PKGCONFIG)
  list(APPEND requirements ${value})
endforeach()
list(REMOVE_DUPLICATES requirements)
string(JOIN " " CAGEWRIGHT_PC_LIBRARIES ${libraries})
string(JOIN ", " CAGEWRIGHT_PC_REQUIRES ${requirements})

if(NOT CAGEWRIGHT_INSTALL)
  return()
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/cagewrightConfig.cmake.in
  ${PROJECT_BINARY_DIR}/cagewrightConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cagewrightConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
configure_file(${PROJECT_SOURCE_DIR}/cmake/cagewright.pc.in ${PROJECT_BINARY_DIR}/cagewright.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/cagewrightConfig.cmake
              ${PROJECT_BINARY_DIR}/cagewrightConfigVersion.cmake DESTINATION ${package_dir} COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/cagewright.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/include/cagewright/cagewright.h
              ${PROJECT_BINARY_DIR}/include/cagewright/version.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cagewright COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/LICENSES DESTINATION ${CMAKE_INSTALL_DOCDIR})
