# maup_instruction_sets(<directory below src>): its files *_avx2.cpp and *_avx512.cpp are compiled with these
# instructions, which their callers ask the processor for. Elsewhere, or with a compiler that lacks them, these files
# are empty.
include(CheckCXXCompilerFlag)
set(avx2_flags -mavx2 -mfma)
set(avx512_flags ${avx2_flags} -mavx512f -mavx512dq -mavx512vl)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  check_cxx_compiler_flag("-mavx2 -mfma" COMPILES_AVX2)
  check_cxx_compiler_flag("-mavx2 -mfma -mavx512f -mavx512dq -mavx512vl" COMPILES_AVX512)
endif()

function(maup_instruction_sets directory)
  foreach(set baseline avx2 avx512)
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${directory}/*_${set}.cpp)
    string(TOUPPER COMPILES_${set} compiles)
    set(flags "$<$<CONFIG:Release,RelWithDebInfo>:-O3>")  # a build under sanitizers waits for the compiler
    if(${compiles})
      list(APPEND flags ${${set}_flags})
    endif()
    set_source_files_properties(${sources} PROPERTIES COMPILE_OPTIONS "${flags}")
  endforeach()
endfunction()
