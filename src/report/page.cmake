# The page's style sheet and scripts stay files of their own kind; here they become strings of the module.
set(page ${CMAKE_CURRENT_LIST_DIR}/page)
file(READ ${page}/style.css STYLE)
file(READ ${page}/page.js PAGE_SCRIPT)
file(READ ${page}/scene.js SCENE_SCRIPT)
file(READ ${page}/painter.js PAINTER_SCRIPT)
file(READ ${page}/animation.js ANIMATION_SCRIPT)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  ${page}/style.css ${page}/page.js ${page}/scene.js ${page}/painter.js ${page}/animation.js)
configure_file(${page}/page.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/report_page.cpp @ONLY)
target_sources(maup_report PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/report_page.cpp)
