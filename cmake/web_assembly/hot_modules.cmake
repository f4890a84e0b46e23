# All is compiled for size (-Oz), but for what runs at each step of a motion. What this emscripten turns off with -Oz
# stays off, so that the preset says -finline-hint-functions.
foreach(module linear_algebra kernel_packed kernel_dense kernel_series kernel_workspace kernel_straight_line
    kernel_lanes
    kernel_disks kernel_sparse kernel_reference kernel_function integrator_dense_output integrator_taylor
    integrator_point
    integrator_variational integrator_ensemble)
  get_target_property(type maup_${module} TYPE)
  if(type STREQUAL STATIC_LIBRARY)
    target_compile_options(maup_${module} PRIVATE -O2)
  endif()
endforeach()

# What answers once, and is much text, is not inlined at all.
foreach(module syntax units system equations_degenerate certificate trajectory analysis_invariants
    analysis_hamiltonian analysis_linearization analysis_action verification study language_services
    comparison plot picture drawing report studio)
  get_target_property(type maup_${module} TYPE)
  if(type STREQUAL STATIC_LIBRARY)
    target_compile_options(maup_${module} PRIVATE -fno-inline-functions)
  endif()
endforeach()
