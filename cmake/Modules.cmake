# One static library a directory of src/, linking only what the layering table allows (src/CMakeLists.txt).

add_library(maup_flags INTERFACE)
target_compile_options(maup_flags INTERFACE
  -Wall -Wextra -Wpedantic
  -ffp-contract=off        # results must not depend on where the compiler fuses
  -fno-math-errno)
if(MAUPERTUIS_SANITIZE)
  target_compile_options(maup_flags INTERFACE
    -fsanitize=${MAUPERTUIS_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
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

# maup_module(<directory below src> LINKS <module>...): the library maup_<directory with _ for />.
function(maup_module directory)
  cmake_parse_arguments(ARG "" "" "LINKS;PRIVATE_LINKS" ${ARGN})
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
  target_link_libraries(maup_${name} PUBLIC ${links} PRIVATE maup_options fmt::fmt ${ARG_PRIVATE_LINKS})
  target_include_directories(maup_${name} INTERFACE ${PROJECT_SOURCE_DIR}/include)
  set_property(GLOBAL APPEND PROPERTY MAUP_MODULES maup_${name})
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
