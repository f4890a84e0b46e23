# One static library a directory of src/, linking only what the layering table allows (src/CMakeLists.txt).

add_library(maup_flags INTERFACE)
target_compile_options(maup_flags INTERFACE
  -Wall -Wextra -Wpedantic
  -Werror=switch-enum      # a new kind of node breaks the build of every switch that does not name it
  -Werror=switch -Werror=narrowing
  -ffp-contract=off        # results must not depend on where the compiler fuses
  -fno-math-errno)
# Where there is room, GCC collects its garbage from half a gigabyte on only: a twelfth of its time.
cmake_host_system_information(RESULT memory_in_megabytes QUERY TOTAL_PHYSICAL_MEMORY)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND memory_in_megabytes GREATER 6000)
  target_compile_options(maup_flags INTERFACE "SHELL:--param ggc-min-heapsize=524288")
endif()
if(MAUPERTUIS_SANITIZE)
  target_compile_options(maup_flags INTERFACE
    -fsanitize=${MAUPERTUIS_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    # A pointer to no object ends with a signal or is seen by AddressSanitizer without these checks too; they are half
    # of the time that the compiler takes.
    -fno-sanitize=null,alignment,vptr,object-size,pointer-overflow
    -Wno-maybe-uninitialized)  # these checks hide from the compiler what is set; the other build has this warning
  target_link_options(maup_flags INTERFACE -fsanitize=${MAUPERTUIS_SANITIZE})
endif()

if(MAUPERTUIS_FUZZ)
  # Coverage of the whole library, not of the fuzz target alone, leads the fuzzer.
  target_compile_options(maup_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# What modules and their tests see; programs (apps/) see include/ alone.
add_library(maup_options INTERFACE)
target_link_libraries(maup_options INTERFACE maup_flags)
target_include_directories(maup_options INTERFACE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)

# The batch that divides `count` sources evenly, about as large as the one wanted: 21 sources are one object, not one
# and a second that compiles all headers again for a single source.
function(maup_even_batch count wanted variable)
  math(EXPR objects "(2 * ${count} + ${wanted}) / (2 * ${wanted})")  # the nearest number of them
  if(objects EQUAL 0)
    set(objects 1)
  endif()
  math(EXPR batch "(${count} + ${objects} - 1) / ${objects}")
  set(${variable} ${batch} PARENT_SCOPE)
endfunction()

# Compiles the sources of a target several at a time (a unity build): most of a small file's time goes into its headers.
# ALONE: sources whose file-local names are those of others, or which are slow to compile themselves. Sources with
# options of their own are left alone by CMake.
# TOGETHER: sources that are one object, since they share what takes long; the others of such a module are batched as
# everywhere.
option(MAUPERTUIS_UNITY "Compile several sources at a time" ON)
function(maup_compile_together target folder batch)
  if(NOT MAUPERTUIS_UNITY)
    return()
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # The sources that are compiled together are taken for headers.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  cmake_parse_arguments(ARG "" "" "ALONE;TOGETHER" ${ARGN})
  list(TRANSFORM ARG_ALONE PREPEND ${folder}/)
  list(TRANSFORM ARG_TOGETHER PREPEND ${folder}/)
  get_target_property(others ${target} SOURCES)
  if(ARG_ALONE OR ARG_TOGETHER)
    list(REMOVE_ITEM others ${ARG_TOGETHER} ${ARG_ALONE})
  endif()
  list(LENGTH others count)
  maup_even_batch(${count} ${batch} batch)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
  if(ARG_ALONE)
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  if(ARG_TOGETHER)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
    set_source_files_properties(${ARG_TOGETHER} PROPERTIES UNITY_GROUP together)
    set(number 0)
    foreach(source IN LISTS others)
      math(EXPR group "${number} / ${batch}")
      math(EXPR number "${number} + 1")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
    endforeach()
  endif()
endfunction()

# maup_module(<directory below src> LINKS <module>... [COLD] [CHECKED] [ALONE <source>...] [TOGETHER <source>...] [BATCH
# <sources at a time>]): the library maup_<directory with _ for />. COLD: nothing in it computes for long; it is
# compiled with less optimization, in three quarters of the time. CHECKED: all its memory is that of containers, which
# look at every index in every build; sanitizers look at the rest (tests/CMakeLists.txt).
function(maup_module directory)
  cmake_parse_arguments(ARG "COLD;CHECKED" "BATCH" "LINKS;PRIVATE_LINKS;ALONE;TOGETHER" ${ARGN})
  if(NOT ARG_BATCH)
    set(ARG_BATCH 20)
  endif()
  string(REPLACE "/" "_" name ${directory})
  set(links "")
  foreach(link IN LISTS ARG_LINKS)
    string(REPLACE "/" "_" link_name ${link})
    list(APPEND links maup_${link_name})
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${directory}/*.cpp)
  if(NOT sources)  # a module of headers alone
    add_library(maup_${name} INTERFACE)
    target_link_libraries(maup_${name} INTERFACE ${links})
    return()
  endif()
  add_library(maup_${name} STATIC ${sources})
  target_link_libraries(maup_${name} PUBLIC ${links} PRIVATE maup_options maup_hardening fmt::fmt ${ARG_PRIVATE_LINKS})
  maup_compile_together(maup_${name} ${PROJECT_SOURCE_DIR}/src/${directory} ${ARG_BATCH}
    ALONE ${ARG_ALONE} TOGETHER ${ARG_TOGETHER})
  if(ARG_COLD AND NOT EMSCRIPTEN)  # there all is compiled to be small
    target_compile_options(maup_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  if(ARG_CHECKED)
    target_compile_definitions(maup_${name} PRIVATE _GLIBCXX_ASSERTIONS)
    set_property(GLOBAL APPEND PROPERTY MAUP_CHECKED ${directory})
  endif()
  target_include_directories(maup_${name} INTERFACE ${PROJECT_SOURCE_DIR}/include)
  set_property(GLOBAL APPEND PROPERTY MAUP_MODULES maup_${name})
endfunction()

# What the program has to know of the module machine_code/llvm: its file, where it is installed, and the build it
# belongs to.
function(maup_describe_llvm_module)
  include(GNUInstallDirs)
  file(RELATIVE_PATH from_program /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR}/maupertuis)
  set_property(SOURCE ${PROJECT_SOURCE_DIR}/src/machine_code/backend.cpp PROPERTY COMPILE_DEFINITIONS
    "MAUPERTUIS_BUILD_TAG=\"${MAUPERTUIS_BUILD_TAG}\""
    "MAUPERTUIS_LLVM_FILE=\"libmaup_machine_code_llvm.so\""
    "MAUPERTUIS_MODULE_FROM_PROGRAM=\"${from_program}\""
    "MAUPERTUIS_MODULE_FOLDER=\"${CMAKE_INSTALL_FULL_LIBDIR}/maupertuis\"")
  target_link_libraries(maup_machine_code PRIVATE ${CMAKE_DL_LIBS})
  set_property(GLOBAL APPEND PROPERTY MAUP_LIBRARIES ${CMAKE_DL_LIBS})
endfunction()

# maup_plugin(<directory below src> LINKS <module>... PRIVATE_LINKS <library>...): a shared object that the program
# opens at run time, lib/maupertuis/libmaup_<name>.so; nothing where its libraries are not installed.
function(maup_plugin directory)
  cmake_parse_arguments(ARG "" "" "LINKS;PRIVATE_LINKS;ALONE" ${ARGN})
  if(NOT ARG_PRIVATE_LINKS)
    return()
  endif()
  string(REPLACE "/" "_" name ${directory})
  string(REPLACE "/" "_" links "${ARG_LINKS}")
  list(TRANSFORM links PREPEND maup_)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${directory}/*.cpp)
  add_library(maup_${name} MODULE ${sources})
  target_link_libraries(maup_${name} PRIVATE ${links} maup_options maup_hardening ${ARG_PRIVATE_LINKS})
  maup_compile_together(maup_${name} ${PROJECT_SOURCE_DIR}/src/${directory} 20 ALONE ${ARG_ALONE})
  target_include_directories(maup_${name} SYSTEM PRIVATE ${LLVM19_INCLUDE_DIR})
  target_compile_definitions(maup_${name} PRIVATE MAUPERTUIS_BUILD_TAG="${MAUPERTUIS_BUILD_TAG}")
  set_target_properties(maup_${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/maupertuis
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  if(MAUPERTUIS_SANITIZE)
    # The archives of its libraries are not instrumented either.
    target_compile_options(maup_${name} PRIVATE -fno-sanitize=all)
  endif()
  target_link_options(maup_${name} PRIVATE -Wl,--exclude-libs,ALL -Wl,--gc-sections)
endfunction()

# maup_library(): all modules as one archive, the target that programs link: maupertuis::maupertuis.
function(maup_library)
  get_property(modules GLOBAL PROPERTY MAUP_MODULES)
  set(objects "")
  foreach(module IN LISTS modules)
    list(APPEND objects $<TARGET_OBJECTS:${module}>)
  endforeach()
  add_library(maupertuis STATIC ${objects})
  add_library(maupertuis::maupertuis ALIAS maupertuis)
  set_target_properties(maupertuis PROPERTIES LINKER_LANGUAGE CXX)
  target_compile_features(maupertuis INTERFACE cxx_std_20)
  get_property(libraries GLOBAL PROPERTY MAUP_LIBRARIES)  # of the system, that modules were found to need
  target_link_libraries(maupertuis PRIVATE fmt::fmt ${libraries})
  target_include_directories(maupertuis INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
endfunction()
