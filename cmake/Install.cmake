# `cmake --install`: the program, the library, the headers, and the package that find_package(maupertuis) finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/maupertuis)
install(TARGETS maupertuis EXPORT maupertuis_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/maupertuis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT maupertuis_targets FILE maupertuis-targets.cmake NAMESPACE maupertuis:: DESTINATION ${package_dir})
configure_package_config_file(cmake/maupertuis-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/maupertuis-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/maupertuis-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/maupertuis-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/maupertuis-config-version.cmake
  DESTINATION ${package_dir})

install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY models DESTINATION ${CMAKE_INSTALL_DATADIR}/maupertuis FILES_MATCHING PATTERN *.lag)
if(MAUPERTUIS_PROGRAM)
  install(TARGETS maup RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET maup_kernel_llvm)
  install(TARGETS maup_kernel_llvm LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/maupertuis)
endif()
