# `cmake --install`: the program, the library, the headers, and the package that find_package(maupertuis) finds. Each
# part belongs to one of the packages of cmake/Package.cmake: runtime, llvm, dev.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/maupertuis)
install(TARGETS maupertuis EXPORT maupertuis_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/maupertuis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
install(EXPORT maupertuis_targets FILE maupertuis-targets.cmake NAMESPACE maupertuis::
  DESTINATION ${package_dir} COMPONENT dev)
configure_package_config_file(cmake/maupertuis-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/maupertuis-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/maupertuis-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/maupertuis-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/maupertuis-config-version.cmake
  DESTINATION ${package_dir} COMPONENT dev)

# For builds without CMake: pkg-config --cflags --libs maupertuis.
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" prefix_from_pkgconfig ${prefix_from_pkgconfig})
get_property(private_libraries GLOBAL PROPERTY MAUP_LIBRARIES)
list(REMOVE_DUPLICATES private_libraries)
list(TRANSFORM private_libraries REPLACE "^Threads::Threads$" "-pthread")
list(TRANSFORM private_libraries REPLACE "^([^/-].*)$" "-l\\1")
list(JOIN private_libraries " " private_libraries)
configure_file(cmake/maupertuis.pc.in maupertuis.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/maupertuis.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

# Packages have these as Debian wants them.
install(FILES LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT sources)
install(FILES README.md ARCHITECTURE.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
install(DIRECTORY docs/manual docs/theory docs/design DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT runtime)
install(DIRECTORY models DESTINATION ${CMAKE_INSTALL_DATADIR}/maupertuis COMPONENT runtime FILES_MATCHING PATTERN *.lag)
if(MAUPERTUIS_PROGRAM)
  install(TARGETS maup RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  if(TARGET maup-studio)
    install(TARGETS maup-studio RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT studio)
    install(DIRECTORY ${CMAKE_BINARY_DIR}/studio/ DESTINATION ${CMAKE_INSTALL_DATADIR}/maupertuis/studio
      COMPONENT studio OPTIONAL PATTERN "page.*" EXCLUDE)
  endif()
  include(cmake/Documents.cmake)
  include(cmake/Desktop.cmake)
endif()
if(TARGET maup_machine_code_llvm)
  install(TARGETS maup_machine_code_llvm LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/maupertuis COMPONENT llvm)
endif()
if(MAUPERTUIS_PROGRAM AND PROJECT_IS_TOP_LEVEL)
  include(cmake/Package.cmake)
endif()
