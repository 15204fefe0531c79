# Debian packages, by CPack: the program, the application, the shared library, what one needs to build with it, the
# Python package, and the documentation. `./dev packages` makes them; tools/reference.py has made the manual pages and
# completions of the program's own table before.
find_program(CAGEWRIGHT_PYTHON3 python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT CAGEWRIGHT_INSTALL OR NOT CAGEWRIGHT_BUILD_CLI OR NOT CAGEWRIGHT_BUILD_C OR NOT CAGEWRIGHT_PYTHON3)
  return() # packages have all of it
endif()
# The project has no address yet. This one is nobody's by RFC 2606, and well formed: whoever publishes packages gives their
# own, -DCAGEWRIGHT_MAINTAINER="Name <address>".
set(CAGEWRIGHT_MAINTAINER "Cagewright developers <cagewright@no-address.invalid>" CACHE STRING "Of the Debian packages: name and address")
set(CAGEWRIGHT_DEBIAN_VERSION "${PROJECT_VERSION}-1" CACHE STRING "Of the Debian packages")
set(packaging ${PROJECT_SOURCE_DIR}/packaging)
set(made ${PROJECT_BINARY_DIR}/packaging)

# What is made of the table of options.
add_custom_command(OUTPUT ${made}/reference.md
  COMMAND ${CAGEWRIGHT_PYTHON3} ${PROJECT_SOURCE_DIR}/tools/reference.py $<TARGET_FILE:cagewright> --out ${made}
  DEPENDS cagewright ${PROJECT_SOURCE_DIR}/tools/reference.py)
add_custom_target(cagewright_reference DEPENDS ${made}/reference.md)

configure_file(${packaging}/changelog.in ${made}/changelog @ONLY)
configure_file(${packaging}/org.cagewright.Cagewright.metainfo.xml ${made}/org.cagewright.Cagewright.metainfo.xml @ONLY)
find_program(CAGEWRIGHT_GZIP gzip)
execute_process(COMMAND ${CAGEWRIGHT_GZIP} -9nkf ${made}/changelog)

# (None of this is part of a plain `cmake --install`, which serves any system.)
macro(package_file component destination)
  install(FILES ${ARGN} DESTINATION ${destination} COMPONENT ${component} EXCLUDE_FROM_ALL)
endmacro()
install(DIRECTORY ${made}/man1/ DESTINATION share/man/man1 COMPONENT program EXCLUDE_FROM_ALL FILES_MATCHING PATTERN "*.1.gz")
package_file(program share/bash-completion/completions ${made}/completions/cagewright)
package_file(program share/zsh/vendor-completions ${made}/completions/_cagewright)
package_file(program share/fish/vendor_completions.d ${made}/completions/cagewright.fish)
package_file(app share/applications ${packaging}/org.cagewright.Cagewright.desktop)
package_file(app share/metainfo ${made}/org.cagewright.Cagewright.metainfo.xml)
package_file(app share/icons/hicolor/scalable/apps ${packaging}/cagewright.svg)
package_file(app share/mime/packages ${packaging}/cagewright.xml)
execute_process(COMMAND ${CAGEWRIGHT_GZIP} -9nc ${packaging}/cagewright-app.1 OUTPUT_FILE ${made}/cagewright-app.1.gz)
package_file(app share/man/man1 ${made}/cagewright-app.1.gz)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/ DESTINATION share/doc/cagewright-doc/docs COMPONENT doc EXCLUDE_FROM_ALL)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION share/doc/cagewright-doc COMPONENT doc EXCLUDE_FROM_ALL
  PATTERN "__pycache__" EXCLUDE)
package_file(doc share/doc/cagewright-doc ${PROJECT_SOURCE_DIR}/README.md)
install(FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION share/doc/cagewright-doc RENAME NEWS.md COMPONENT doc EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cagewright)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "${CAGEWRIGHT_MAINTAINER}")
set(CPACK_PACKAGE_VENDOR "")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/deb)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_VERSION ${CAGEWRIGHT_DEBIAN_VERSION})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_COMPONENTS_ALL)
execute_process(COMMAND dpkg --print-architecture OUTPUT_VARIABLE architecture OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)

# package(component NAME name SECTION section SUMMARY words TEXT more words [ALL] [DEPENDS ...] [RECOMMENDS ...] [SUGGESTS ...])
function(package component)
  cmake_parse_arguments(PARSE_ARGV 1 P "ALL" "NAME;SECTION;SUMMARY;TEXT;DEPENDS;RECOMMENDS;SUGGESTS" "")
  string(TOUPPER ${component} key)
  package_file(${component} share/doc/${P_NAME} ${packaging}/copyright)
  install(FILES ${made}/changelog.gz DESTINATION share/doc/${P_NAME} RENAME changelog.Debian.gz
    COMPONENT ${component} EXCLUDE_FROM_ALL)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${P_NAME} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${P_SECTION} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${P_SUMMARY}\n${P_TEXT}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${P_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_RECOMMENDS "${P_RECOMMENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SUGGESTS "${P_SUGGESTS}" PARENT_SCOPE)
  if(P_ALL)
    set(CPACK_DEBIAN_${key}_PACKAGE_ARCHITECTURE all PARENT_SCOPE)
    set(CPACK_DEBIAN_${key}_PACKAGE_SHLIBDEPS OFF PARENT_SCOPE)
  else()
    set(CPACK_DEBIAN_${key}_PACKAGE_ARCHITECTURE ${architecture} PARENT_SCOPE)
  endif()
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
endfunction()

string(JOIN "\n" about
  "A cage is a coarse closed mesh round a 3D model: moving its vertices"
  "deforms the model. Cagewright makes cages by itself, proves that they are"
  "valid, binds models to them and deforms models.")
set(same "(= ${CAGEWRIGHT_DEBIAN_VERSION})")
package(program NAME cagewright SECTION graphics SUMMARY "build cages round 3D models and deform models with them"
  TEXT "${about}\nThis package has the command line program." RECOMMENDS "libegl1, libgl1-mesa-dri" SUGGESTS "cagewright-app, cagewright-doc")
if(CAGEWRIGHT_BUILD_APP)
  package(app NAME cagewright-app SECTION graphics SUMMARY "make cages round 3D models and pose models, in a window"
    TEXT "${about}\nThis package has the desktop application." DEPENDS "libqt6svg6, libgl1-mesa-dri | libgl1"
    RECOMMENDS "cagewright ${same}")
endif()
set(library libcagewright${PROJECT_VERSION_MAJOR})
package(library NAME ${library} SECTION libs SUMMARY "cages round 3D models: shared library with a C interface"
  TEXT "${about}\nThis package has the shared library, for C and for what can call C."
  RECOMMENDS "libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${packaging}/triggers) # ldconfig, once the library is there
package(development NAME libcagewright-dev SECTION libdevel SUMMARY "cages round 3D models: headers and libraries for C++ and C"
  TEXT "${about}\nThis package has the headers, the libraries for C++, and what CMake and\npkg-config need to find them."
  DEPENDS "${library} ${same}, libeigen3-dev, libtbb-dev, libhwy-dev, zlib1g-dev, libpng-dev, libepoxy-dev, libegl-dev, libgmp-dev, libmpfr-dev"
  SUGGESTS "cagewright-doc")
package(python3 NAME python3-cagewright SECTION python SUMMARY "cages round 3D models: Python package" ALL
  TEXT "${about}\nThis package has the Python package cagewright." DEPENDS "python3 (>= 3.9), python3-numpy, ${library} (>= ${PROJECT_VERSION})")
package(doc NAME cagewright-doc SECTION doc SUMMARY "cages round 3D models: documentation and examples" ALL
  TEXT "${about}\nThis package has the documentation and the examples.")
include(CPack)
