# All is compiled for size (-Oz), but for what runs at each step of a motion. What this emscripten turns off with -Oz
# stays off, so that the preset says -finline-hint-functions.
foreach(module kernel_packed kernel_dense kernel_series kernel_workspace kernel_straight_line
    integrator_dense_output integrator_taylor)
  get_target_property(type maup_${module} TYPE)
  if(type STREQUAL STATIC_LIBRARY)
    target_compile_options(maup_${module} PRIVATE -O2)
  endif()
endforeach()
