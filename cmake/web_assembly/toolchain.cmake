# The preset `wasm`: emscripten as Debian packages it (docs/design/web_assembly.md).
find_program(EMSCRIPTEN_CONFIG em-config REQUIRED)
execute_process(COMMAND ${EMSCRIPTEN_CONFIG} EMSCRIPTEN_ROOT OUTPUT_VARIABLE emscripten_root
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
include(${emscripten_root}/cmake/Modules/Platform/Emscripten.cmake)
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}/../other_machines)
set(CMAKE_CXX_FLAGS_INIT "-fwasm-exceptions -msimd128")
