# fmt, Boost, Eigen, nlohmann/json and CLI11 are headers that stand among those of this machine's C library, which a
# compiler for another machine must not read: a folder of links shows it these alone.
set(headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
function(maup_show_headers)
  foreach(library IN LISTS ARGN)
    if(NOT EXISTS /usr/include/${library})
      message(FATAL_ERROR "The headers of ${library} are not in /usr/include: scripts/packages build")
    endif()
    file(CREATE_LINK /usr/include/${library} ${headers}/${library} SYMBOLIC)
  endforeach()
endfunction()
maup_show_headers(fmt boost eigen3 nlohmann)
include_directories(SYSTEM ${headers})
