# What file managers read: the type of .lag files, their icon, and what opens them.
set(desktop_folder ${PROJECT_BINARY_DIR}/packaging)
file(RELATIVE_PATH bin_from_here /${CMAKE_INSTALL_LIBEXECDIR}/maupertuis /${CMAKE_INSTALL_BINDIR})
configure_file(packaging/show_model ${desktop_folder}/show_model @ONLY)
configure_file(packaging/maupertuis.desktop.in ${desktop_folder}/maupertuis.desktop @ONLY)

set(icons ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable)
install(PROGRAMS ${desktop_folder}/show_model DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/maupertuis COMPONENT runtime)
install(FILES ${desktop_folder}/maupertuis.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT runtime)
install(FILES packaging/maupertuis.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT runtime)
install(FILES packaging/maupertuis.svg DESTINATION ${icons}/apps COMPONENT runtime)
install(FILES packaging/text-x-maupertuis.svg DESTINATION ${icons}/mimetypes COMPONENT runtime)
