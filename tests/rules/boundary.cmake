# That what users read and copy names nothing of the library's detail/ folders: the examples, the README, and code on pages.
#   cmake -DSOURCE=. -P boundary.cmake
cmake_minimum_required(VERSION 3.22)
file(GLOB files RELATIVE ${SOURCE} ${SOURCE}/examples/*.cpp ${SOURCE}/examples/papers/*.cpp ${SOURCE}/python/examples/*.py ${SOURCE}/README.md
  ${SOURCE}/docs/*.md ${SOURCE}/tests/rules/components/*.cpp ${SOURCE}/tests/rules/consumer/*.cpp)
set(found FALSE)
foreach(file IN LISTS files)
  file(STRINGS ${SOURCE}/${file} lines)
  foreach(line IN LISTS lines)
    if(line MATCHES "detail::|#include.*/detail/")
      message(NOTICE "${file}: ${line}")
      set(found TRUE)
    endif()
  endforeach()
endforeach()
if(found OR NOT files)
  message(FATAL_ERROR "What is in detail/ is not for users")
endif()
