# What makes a mistake in memory hard to exploit, and binaries that do not tell where they were built. What it costs in
# hot loops is told by scripts/instructions, with and without it.
option(MAUPERTUIS_HARDENING
  "Stack protector, fortified C functions, position-independent program, relocations bound at once" ON)
include(CheckPIESupported)
check_pie_supported()  # CMAKE_POSITION_INDEPENDENT_CODE is then said to the linker as well

# What modules and programs are compiled with; tests, which are compiled without optimization, are not.
add_library(maup_hardening INTERFACE)
if(MAUPERTUIS_HARDENING AND NOT MAUPERTUIS_SANITIZE AND NOT MAUPERTUIS_FUZZ)
  target_compile_options(maup_hardening INTERFACE -fstack-protector-strong
    # Fortified functions need optimization; some compilers define the macro by themselves.
    $<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE$<SEMICOLON>-D_FORTIFY_SOURCE=2>)
  target_link_options(maup_hardening INTERFACE -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
endif()

# __FILE__ and debug information name files from the top of the sources.
if(MAUPERTUIS_HARDENING)
  target_compile_options(maup_flags INTERFACE -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
endif()
