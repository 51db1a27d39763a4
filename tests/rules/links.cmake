# That the files a page links to, or names with a folder between backquotes, are there.
#   cmake -DPAGE=README.md -DROOT=. -P links.cmake
cmake_minimum_required(VERSION 3.22)

get_filename_component(folder ${PAGE} DIRECTORY)
file(READ ${PAGE} text)
string(REPLACE ";" "," text "${text}")
string(REGEX REPLACE "\n```[^`]*\n```" "" text "${text}")  # code has brackets of its own
string(REPLACE "](" "@(" text "${text}")  # brackets would join the list's elements
string(REGEX REPLACE "[][]" "" text "${text}")
string(REGEX MATCHALL "@\\([^)#]+" links "${text}")
foreach(link IN LISTS links)
  string(SUBSTRING "${link}" 2 -1 link)
  if(NOT link MATCHES "^https?:" AND NOT EXISTS "${folder}/${link}")
    message(FATAL_ERROR "${PAGE} links to a file that is not there: ${link}")
  endif()
endforeach()

string(REGEX MATCHALL "`[a-z0-9_]+/[a-z0-9_/]+[.][a-z]+`" names "${text}")
foreach(name IN LISTS names)
  string(REPLACE "`" "" name "${name}")
  string(REGEX MATCH "^[^/]+" folder ${name})
  foreach(place ${ROOT} ${ROOT}/include/cncplan)
    if(EXISTS ${place}/${folder} AND NOT EXISTS ${place}/${name})  # elsewhere it is another project's
      message(FATAL_ERROR "${PAGE} names a file that is not there: ${name}")
    endif()
  endforeach()
endforeach()
list(LENGTH links link_count)
list(LENGTH names name_count)
message(STATUS "${PAGE}: ${link_count} links and ${name_count} names of files, all there")
