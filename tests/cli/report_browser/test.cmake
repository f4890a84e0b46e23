# The report in a real headless Chromium. Node and Chromium are needed: without them the test fails, it is never
# skipped.
find_program(NODE_PROGRAM NAMES node nodejs)
if(NOT NODE_PROGRAM)
  set(NODE_PROGRAM node)
endif()
add_executable(report_browser_page ${PROJECT_SOURCE_DIR}/tests/cli/report_browser/page.cpp)
target_link_libraries(report_browser_page PRIVATE maup_report maup_options fmt::fmt)
add_test(NAME report_browser
  COMMAND ${NODE_PROGRAM} ${PROJECT_SOURCE_DIR}/tests/cli/report_browser/browser.mjs $<TARGET_FILE:report_browser_page>)
set_tests_properties(report_browser PROPERTIES LABELS cli TIMEOUT 180)
# The camera of the page and that of the library.
add_test(NAME drawing_script
  COMMAND ${NODE_PROGRAM} ${PROJECT_SOURCE_DIR}/tests/cli/report_browser/scene.mjs
    $<TARGET_FILE:report_browser_page> ${PROJECT_SOURCE_DIR}/src/report/page/scene.js)
set_tests_properties(drawing_script PROPERTIES LABELS cli TIMEOUT 60)
