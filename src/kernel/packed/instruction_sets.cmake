# The engine, compiled for the instruction sets that it knows; the processor decides at run time. Multiplications and
# additions may be fused there: the reference rules are the ones that are the same everywhere.
set(engines ${CMAKE_CURRENT_LIST_DIR})
# A build under sanitizers waits for the compiler, not for the engine.
set(hot "$<$<CONFIG:Release,RelWithDebInfo>:-O3>;-fno-tree-loop-distribute-patterns;-ffp-contract=fast;-Wno-psabi")
# A vector of 512 bits is no type of any interface, so that its passing does not matter (-Wno-psabi).
set_source_files_properties(${engines}/engine_baseline.cpp PROPERTIES COMPILE_OPTIONS "-ffp-contract=fast;-Wno-psabi")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  set_source_files_properties(${engines}/engine_avx2.cpp PROPERTIES COMPILE_OPTIONS "${hot};-march=x86-64-v3")
  set_source_files_properties(${engines}/engine_avx512.cpp PROPERTIES COMPILE_OPTIONS
    "${hot};-march=x86-64-v4;-mprefer-vector-width=512")
  set_source_files_properties(${engines}/engine.cpp PROPERTIES COMPILE_DEFINITIONS MAUPERTUIS_X86_64)
else()
  set_source_files_properties(${engines}/engine_avx2.cpp ${engines}/engine_avx512.cpp PROPERTIES HEADER_FILE_ONLY ON)
endif()
