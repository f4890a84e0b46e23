# What machine_code/llvm links: LLVM 19 and SLEEF. A build without one of them has no compiled kernels and is whole
# otherwise.
option(MAUPERTUIS_LLVM "Build the module of compiled kernels, if LLVM 19 and SLEEF are installed" ON)
set(llvm_libraries "")
find_program(LLVM19_CONFIG NAMES llvm-config-19 llvm-config PATHS /usr/lib/llvm-19/bin)
find_library(SLEEF_LIBRARY sleef)
set(llvm_version "")
if(LLVM19_CONFIG)
  execute_process(COMMAND ${LLVM19_CONFIG} --version OUTPUT_VARIABLE llvm_version
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()

# Of LLVM's archives only what x86-64 needs: the module opens ten times as fast as with the shared library of all
# targets (docs/design/compiled_kernels.md). The shared one where archives are missing.
function(find_llvm_libraries)
  execute_process(COMMAND ${LLVM19_CONFIG} --includedir OUTPUT_VARIABLE include OUTPUT_STRIP_TRAILING_WHITESPACE)
  execute_process(COMMAND ${LLVM19_CONFIG} --link-static --libfiles x86codegen x86asmparser x86 scalaropts asmprinter
    OUTPUT_VARIABLE archives OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  find_library(LLVM19_LIBRARY NAMES LLVM-19 PATHS /usr/lib/llvm-19/lib)
  find_library(ZLIB_FOR_LLVM z)
  find_library(ZSTD_FOR_LLVM zstd)
  separate_arguments(archives)
  if(archives AND NOT failed AND ZLIB_FOR_LLVM AND ZSTD_FOR_LLVM)
    set(libraries ${archives} ${ZLIB_FOR_LLVM} ${ZSTD_FOR_LLVM})
  elseif(LLVM19_LIBRARY)
    message(STATUS
      "LLVM's archives, zlib or zstd are not here: compiled kernels take LLVM's shared library, which opens slowly")
    set(libraries ${LLVM19_LIBRARY})
  endif()
  set(LLVM19_INCLUDE_DIR ${include} PARENT_SCOPE)
  set(llvm_libraries ${libraries} PARENT_SCOPE)
endfunction()

if(NOT MAUPERTUIS_LLVM)
  message(STATUS "maup is built without compiled kernels, as asked for")
elseif(llvm_version MATCHES "^19" AND SLEEF_LIBRARY)
  find_llvm_libraries()
endif()
if(MAUPERTUIS_LLVM AND NOT llvm_libraries)
  message(STATUS "LLVM 19 or SLEEF is not here: maup is built without compiled kernels")
endif()

# The two sides of the border share types; the tag tells whether they are of one build.
file(GLOB border CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/src/kernel/program/*.hpp ${PROJECT_SOURCE_DIR}/src/kernel/packed/*.hpp
  ${PROJECT_SOURCE_DIR}/src/kernel/lanes/*.hpp ${PROJECT_SOURCE_DIR}/src/machine_code/*.hpp
  ${PROJECT_SOURCE_DIR}/src/kernel/straight_line/*.hpp
  ${PROJECT_SOURCE_DIR}/include/maupertuis/expression.hpp ${PROJECT_SOURCE_DIR}/include/maupertuis/functions.hpp)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${border})
set(border_text "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${MAUPERTUIS_SANITIZE}")
foreach(header IN LISTS border)
  file(SHA256 ${header} digest)
  string(APPEND border_text ${digest})
endforeach()
string(SHA256 border_digest "${border_text}")
string(SUBSTRING ${border_digest} 0 16 border_digest)
set(MAUPERTUIS_BUILD_TAG "${PROJECT_VERSION}-${border_digest}")
