# Debian packages, made by cpack (scripts/package): maupertuis with the program, maupertuis-llvm with the module that
# makes machine code, maupertuis-studio with the server and the page of the studio, libmaupertuis-dev with what other
# programs are built with.
set(MAUPERTUIS_MAINTAINER "The Maupertuis developers <maintainers@maupertuis.invalid>"
  CACHE STRING "Who answers for the packages")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR Maupertuis)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${MAUPERTUIS_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
# Each package has a summary of its own, the first line of its description; the project's would stand above it.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(package_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# package(<component> <name> <section> DEPENDS … RECOMMENDS … SUMMARY … DESCRIPTION …). CMake would cut a description at
# a semicolon.
macro(package component name section)
  cmake_parse_arguments(ARG "" "DEPENDS;RECOMMENDS;SUGGESTS;SUMMARY;DESCRIPTION" "" ${ARGN})
  string(TOUPPER ${component} COMPONENT)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_DEPENDS "${ARG_DEPENDS}")
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_RECOMMENDS "${ARG_RECOMMENDS}")
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_SUGGESTS "${ARG_SUGGESTS}")
  set(CPACK_DEBIAN_${COMPONENT}_DESCRIPTION "${ARG_SUMMARY}\n${ARG_DESCRIPTION}")
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${name})
  install(FILES packaging/copyright DESTINATION ${folder} COMPONENT ${component})
  string(TIMESTAMP package_date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH where it is set
  set(package_name ${name})
  configure_file(packaging/changelog.in ${PROJECT_BINARY_DIR}/packaging/${name}.changelog @ONLY)
  # Compressed when it is installed: what was configured is then read, and not what was configured once.
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder}\")
    execute_process(COMMAND ${GZIP_PROGRAM} -9nc \"${PROJECT_SOURCE_DIR}/CHANGELOG.md\"
      OUTPUT_FILE \"\${folder}/changelog.gz\" COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${GZIP_PROGRAM} -9nc \"${PROJECT_BINARY_DIR}/packaging/${name}.changelog\"
      OUTPUT_FILE \"\${folder}/changelog.Debian.gz\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT ${component})
endmacro()

if(GZIP_PROGRAM)
  package(runtime maupertuis science
    RECOMMENDS "maupertuis-llvm (= ${package_version}), librsvg2-2"  # the latter is opened by name, for PNG and PDF
    SUGGESTS "ffmpeg, xdg-utils, libmaupertuis-dev (= ${package_version})"
    SUMMARY "Lagrangian mechanics from a text model"
    DESCRIPTION "Write where the masses are, and maup derives the equations of motion,
certifies them by independent routes, and runs them to the last digits of
double precision. It finds equilibria and modes, conserved quantities,
periodic motions and paths of stationary action, and writes a whole study
on one page.")
  if(TARGET maup_machine_code_llvm)
    package(llvm maupertuis-llvm science
      DEPENDS "maupertuis (= ${package_version}), libsleef3"
      SUMMARY "machine code for the motions of maupertuis"
      DESCRIPTION "The module with which maup compiles the equations of a model for this
processor. Long runs and ensembles are several times as fast with it, and
give the same results up to rounding.")
  endif()
  if(TARGET maup-studio AND EXISTS ${CMAKE_BINARY_DIR}/studio/index.html)
    package(studio maupertuis-studio science
      DEPENDS "maupertuis (= ${package_version})" RECOMMENDS "maupertuis-llvm (= ${package_version}), xdg-utils"
      SUMMARY "Lagrangian mechanics in the browser"
      DESCRIPTION "The page that \`maup studio\` shows: write a model and see its equations,
its motion, its conserved quantities at once. Drag it, change its values, step
through its derivation in a lecture. It is served at 127.0.0.1 alone.")
  endif()
  package(dev libmaupertuis-dev libdevel
    DEPENDS "libfmt-dev, liblapack-dev, libblas-dev" RECOMMENDS "maupertuis-llvm (= ${package_version})"
    SUMMARY "Lagrangian mechanics from a text model - library"
    DESCRIPTION "The headers, the static library and the CMake package with which programs
derive, certify and run the motion of mechanical systems as maup does.")
  include(CPack)
endif()
