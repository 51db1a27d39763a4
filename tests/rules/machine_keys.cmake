# That docs/machine-file.md has every key of a machine file that shows all of them.
#   cmake -DPAGE=docs/machine-file.md -DFILE=examples/machines/mill3.toml -P machine_keys.cmake
cmake_minimum_required(VERSION 3.22)

file(READ ${PAGE} page)
file(STRINGS ${FILE} lines REGEX "^([a-z_]+ =|\\[)")
set(count 0)
foreach(line IN LISTS lines)
  string(REGEX MATCH "^([a-z_0-9]+|.*[a-z])" key "${line}")
  if(NOT page MATCHES "`[[]*${CMAKE_MATCH_1}[^a-z_]")
    message(SEND_ERROR "${PAGE} does not have ${CMAKE_MATCH_1}")
  endif()
  math(EXPR count "${count} + 1")
endforeach()
if(count LESS 20)
  message(SEND_ERROR "only ${count} keys were found in ${FILE}")
endif()
message(STATUS "${PAGE}: ${count} keys, all there")
