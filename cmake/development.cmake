# What only the project's own builds use: the warnings, a build type when none was asked for, and the compile commands
# for editors and clang-tidy.
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

add_library(cncplan_development INTERFACE)
target_link_libraries(cncplan_development INTERFACE cncplan::cncplan)
target_compile_options(cncplan_development INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)
