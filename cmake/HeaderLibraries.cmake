# fmt, Boost, Eigen and nlohmann/json are headers that stand among those of this machine's C library, which a cross compiler must
# not read: a folder of links shows it these four alone.
set(folder ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${folder})
foreach(library fmt boost eigen3 nlohmann)
  if(NOT EXISTS /usr/include/${library})
    message(FATAL_ERROR "The headers of ${library} are not in /usr/include")
  endif()
  file(CREATE_LINK /usr/include/${library} ${folder}/${library} SYMBOLIC)
endforeach()
include_directories(SYSTEM ${folder})
add_library(fmt::fmt INTERFACE IMPORTED)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
