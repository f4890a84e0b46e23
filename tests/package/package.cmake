# cmake -P: packages of the build, quickly compressed, and a look at them.
file(REMOVE_RECURSE ${WORK_DIR})
foreach(command
    "${CPACK};--config;${BUILD_DIR}/CPackConfig.cmake;-B;${WORK_DIR};-D;CPACK_DEBIAN_COMPRESSION_TYPE=gzip"
    "${CHECK};${WORK_DIR}")
  execute_process(COMMAND ${command} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${command} failed:\n${output}")
  endif()
endforeach()
message("${output}")
