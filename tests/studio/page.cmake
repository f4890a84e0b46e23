# The page in a real Chromium over the server, and, where the core was built as WebAssembly, from a static folder. npm,
# node and Chromium are needed: without them the tests fail, they are never skipped.
add_test(NAME studio_page_build COMMAND ${PROJECT_SOURCE_DIR}/scripts/studio)
# It holds the two places that the page needs: where it freed one alone, ctest would give that to a shorter test, and so
# each that gets free after it, and the page would come last, beside nothing.
set_tests_properties(studio_page_build PROPERTIES LABELS studio TIMEOUT 300 FIXTURES_SETUP studio_page PROCESSORS 2)
set(page ${PROJECT_SOURCE_DIR}/tests/studio/page/run.mjs)
add_test(NAME studio_page COMMAND node ${page} server ${PROJECT_BINARY_DIR}/bin/maup ${PROJECT_SOURCE_DIR}/build/studio)
set_tests_properties(studio_page PROPERTIES LABELS studio TIMEOUT 1500
  FIXTURES_REQUIRED studio_page RESOURCE_LOCK browser PROCESSORS 2 COST 450)  # two browsers
if(EXISTS ${PROJECT_SOURCE_DIR}/build-wasm/bin/maup_worker.js)
  add_test(NAME studio_page_static COMMAND node ${page} static ${PROJECT_SOURCE_DIR}/build/studio_static)
  set_tests_properties(studio_page_static PROPERTIES LABELS studio TIMEOUT 1500
    FIXTURES_REQUIRED studio_page RESOURCE_LOCK browser PROCESSORS 2 COST 450)  # two browsers
endif()
