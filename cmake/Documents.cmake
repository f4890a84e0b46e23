# What the program says of itself, in the forms that shells and `man` read: build/share. None of it is written by hand.
set(documents_folder ${PROJECT_BINARY_DIR}/share)
set(documents ${documents_folder}/bash/maup ${documents_folder}/zsh/_maup
  ${documents_folder}/fish/maup.fish ${documents_folder}/maup.1)
file(MAKE_DIRECTORY ${documents_folder}/bash ${documents_folder}/zsh ${documents_folder}/fish)
find_program(GZIP_PROGRAM gzip)
set(manual_page ${documents_folder}/maup.1)
set(compress_manual "")
if(GZIP_PROGRAM)
  set(manual_page ${documents_folder}/maup.1.gz)
  set(compress_manual COMMAND ${GZIP_PROGRAM} -9nkf ${documents_folder}/maup.1)
endif()
add_custom_command(OUTPUT ${documents} ${manual_page} DEPENDS maup VERBATIM COMMENT "Completions and manual page"
  COMMAND maup completions bash > ${documents_folder}/bash/maup
  COMMAND maup completions zsh > ${documents_folder}/zsh/_maup
  COMMAND maup completions fish > ${documents_folder}/fish/maup.fish
  COMMAND maup manual > ${documents_folder}/maup.1
  ${compress_manual})
add_custom_target(documents ALL DEPENDS ${documents} ${manual_page})

set(MAUPERTUIS_ZSH_FOLDER ${CMAKE_INSTALL_DATADIR}/zsh/site-functions CACHE STRING
  "Where zsh finds completions (Debian's packages: share/zsh/vendor-completions)")
install(FILES ${documents_folder}/bash/maup DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  COMPONENT runtime)
install(FILES ${documents_folder}/zsh/_maup DESTINATION ${MAUPERTUIS_ZSH_FOLDER} COMPONENT runtime)
install(FILES ${documents_folder}/fish/maup.fish
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT runtime)
install(FILES ${manual_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
