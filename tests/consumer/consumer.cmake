# cmake -P: install to a prefix of its own, configure and build the project in outside/, run it.
function(step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed:\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
step("Installation" ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
step("Configuration of a project that uses the package" ${CMAKE_COMMAND} -S ${OUTSIDE} -B ${WORK_DIR}/build
     -G ${GENERATOR}
     -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_BUILD_TYPE=Debug
     -D HEADERS=${HEADERS})
step("Its build" ${CMAKE_COMMAND} --build ${WORK_DIR}/build)
step("Its run" ${WORK_DIR}/build/outside)
find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  file(GLOB folder ${WORK_DIR}/prefix/lib*/pkgconfig ${WORK_DIR}/prefix/lib*/*/pkgconfig)
  set(ENV{PKG_CONFIG_PATH} ${folder})
  step("Its build by pkg-config" sh -c
       "${CXX} -o '${WORK_DIR}/by_pkg_config' '${OUTSIDE}/main.cpp' $(${PKG_CONFIG} --cflags --libs maupertuis)")
  step("Its run" ${WORK_DIR}/by_pkg_config)
endif()
if(EXISTS ${WORK_DIR}/prefix/bin/maup)
  step("The installed program" ${WORK_DIR}/prefix/bin/maup --version)
endif()
