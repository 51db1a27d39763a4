# That the files a page links to are there.   cmake -DPAGE=README.md -P links.cmake
cmake_minimum_required(VERSION 3.22)

get_filename_component(folder ${PAGE} DIRECTORY)
file(READ ${PAGE} text)
string(REPLACE ";" "," text "${text}")
string(REPLACE "](" "@(" text "${text}")  # brackets would join the list's elements
string(REGEX REPLACE "[][]" "" text "${text}")
string(REGEX MATCHALL "@\\([^)#]+" links "${text}")
foreach(link IN LISTS links)
  string(SUBSTRING "${link}" 2 -1 link)
  if(NOT link MATCHES "^https?:" AND NOT EXISTS "${folder}/${link}")
    message(FATAL_ERROR "${PAGE} links to a file that is not there: ${link}")
  endif()
endforeach()
list(LENGTH links count)
message(STATUS "${PAGE}: ${count} links, all there")
