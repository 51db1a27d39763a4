# What only the project's own builds use: warnings, a build type where none was asked for, compile commands for editors and
# clang-tidy, and what is left out where its packages are missing.
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

# Warnings are errors by CMAKE_COMPILE_WARNING_AS_ERROR: the presets and tools/ set it.
add_library(cncplan_warnings INTERFACE)
target_compile_options(cncplan_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
target_link_libraries(cncplan_compiled PRIVATE $<BUILD_INTERFACE:cncplan_warnings>)
# g++ 12 warns of what a variant copies whole
target_compile_options(cncplan_compiled PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
# Its headers, parsed once for all that is compiled into it.
target_precompile_headers(cncplan_compiled PRIVATE <cncplan/compiled.hpp>)
target_precompile_headers(cncplan_maps REUSE_FROM cncplan_compiled)
# Who takes the compiled library, as most of the tree does, and who takes the headers alone.
add_library(cncplan_development INTERFACE)
target_link_libraries(cncplan_development INTERFACE cncplan_warnings cncplan::compiled)
add_library(cncplan_header_only INTERFACE)
target_link_libraries(cncplan_header_only INTERFACE cncplan_warnings cncplan::cncplan)

# Programs and examples take the compiled library, and parse its headers once for all.
function(cncplan_precompiled_headers)
  if(NOT TARGET cncplan_program_precompiled)
    set(empty ${PROJECT_BINARY_DIR}/program_precompiled.cpp)
    file(CONFIGURE OUTPUT ${empty} CONTENT "")
    add_library(cncplan_program_precompiled OBJECT ${empty})
    target_link_libraries(cncplan_program_precompiled PRIVATE cncplan_development)
    target_precompile_headers(cncplan_program_precompiled PRIVATE <cncplan/cncplan.hpp>)
  endif()
  foreach(target IN LISTS ARGN)
    target_precompile_headers(${target} REUSE_FROM cncplan_program_precompiled)
  endforeach()
endfunction()

# Turns an option off where a package is missing, and says so: cncplan_needs(OPTION package...)
macro(cncplan_needs option)
  foreach(package ${ARGN})
    if(${option})
      find_package(${package} QUIET)
      if(NOT ${package}_FOUND)
        message(STATUS "${option} is off: ${package} is not installed (tools/setup installs all that is needed)")
        set(${option} OFF)
      endif()
    endif()
  endforeach()
endmacro()
cncplan_needs(CNCPLAN_TESTS Catch2 CLI11)
cncplan_needs(CNCPLAN_BENCH benchmark)
