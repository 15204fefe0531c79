# What find_package(cagewright) needs. The modules install themselves (see Module.cmake).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/cagewright)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/cagewrightConfig.cmake.in
  ${PROJECT_BINARY_DIR}/cagewrightConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cagewrightConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cagewrightConfig.cmake
              ${PROJECT_BINARY_DIR}/cagewrightConfigVersion.cmake DESTINATION ${package_dir})
install(EXPORT cagewright NAMESPACE cagewright:: FILE cagewrightTargets.cmake
  DESTINATION ${package_dir})
