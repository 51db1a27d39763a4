# The rules of the folders, checked on the text of every header.   cmake -DINCLUDE=include -P includes.cmake
#   - A part (core/, gcode/, path/, ...) includes the standard library, Eigen, tl::expected, core/, itself and its own instances
#     (compiled/FOLDER.hpp). What joins the parts includes all: the headers at the top, detail/, published/, tire_mold/, compiled/.
#   - detail/curve/ and detail/speed/ know of what joins the parts only the machine, its blocks, its tool and the levels of smoothing.
#   - The umbrella, cncplan.hpp, lags behind nothing: it includes every public header, but definitions (NAME-inl.hpp), which
#     NAME.hpp includes where the library is not compiled. What is in a detail/ folder is included by some other header.
#   - A header has #pragma once, and a first line that says what it holds. If that line says "(set-up)", the header is for
#     code that runs before the machine moves, and may use the heap; all others may not even include what needs it.
#   - No file is longer than 600 lines.
cmake_minimum_required(VERSION 3.22)

set(needs_heap deque filesystem forward_list fstream future iomanip ios iostream istream list map memory
  memory_resource mutex ostream queue regex set shared_mutex sstream stack stdexcept streambuf string thread unordered_map
  unordered_set vector)

get_filename_component(INCLUDE ${INCLUDE} ABSOLUTE)
file(GLOB_RECURSE headers RELATIVE ${INCLUDE} ${INCLUDE}/cncplan/*.hpp ${INCLUDE}/cncplan_tools/*.hpp)
set(found FALSE)
macro(complain text)
  message(NOTICE "include/${header}: ${text}")
  set(found TRUE)
endmacro()

set(joins "^(|detail|published|tire_mold|compiled)$")  # the folders that put parts together
set(values "^cncplan/(block|fallback|machine|motion_limits|smooth_level|tool)\\.hpp$")

foreach(header IN LISTS headers)
  file(READ ${INCLUDE}/${header} text)
  string(REGEX MATCH "^cncplan/(([^/]+)/)?" folder ${header})
  set(folder "${CMAKE_MATCH_2}")
  string(REGEX MATCH "^[^\n]*" first_line "${text}")
  string(REGEX MATCHALL "\n" line_ends "${text}")
  list(LENGTH line_ends lines)

  if(NOT first_line MATCHES "^// .+")
    complain("its first line is not a comment that says what it holds")
  endif()
  if(NOT text MATCHES "\n#pragma once\n")
    complain("has no #pragma once")
  endif()
  if(lines GREATER 600)
    complain("has ${lines} lines, more than 600")
  endif()

  if(header MATCHES "^cncplan_tools/")
    continue()  # around the library: it may use the heap, and stands in no umbrella
  endif()

  if(text MATCHES "std::function<" AND NOT first_line MATCHES "\\(set-up\\)")
    complain("has a std::function, but its first line does not say (set-up)")
  endif()

  string(REGEX MATCHALL "#[ \t]*include[ \t]*[<\"][^>\"]+" includes "${text}")
  foreach(include IN LISTS includes)
    string(REGEX MATCH "([<\"])(.+)$" all "${include}")
    set(kind "${CMAKE_MATCH_1}")
    set(target "${CMAKE_MATCH_2}")
    if(kind STREQUAL "\"")
      string(REGEX MATCH "^cncplan/(([^/]+)/)?" all ${target})
      set(other "${CMAKE_MATCH_2}")
      if(NOT target IN_LIST headers OR target MATCHES "^cncplan_tools/")
        complain("includes \"${target}\", which is no header of the library")
      elseif(NOT folder MATCHES ${joins} AND NOT other MATCHES "^(core|${folder})$" AND NOT target STREQUAL "cncplan/compiled/${folder}.hpp")
        complain("${folder}/ includes \"${target}\": a part includes core/, itself and its own instances only")
      elseif(header MATCHES "^cncplan/detail/(curve|speed)/" AND NOT target MATCHES ${values}
          AND (other STREQUAL "" OR target MATCHES "^cncplan/detail/(plan|executor)/"))
        complain("includes \"${target}\": curve/ and speed/ know nothing of what is planned or run by them")
      endif()
      if(header STREQUAL "cncplan/cncplan.hpp")
        list(APPEND umbrella ${target})
      endif()
      list(APPEND included ${target})
    elseif(NOT target MATCHES "^([a-z_]+|Eigen/[A-Z][A-Za-z]+|tl/expected\\.hpp)$")
      complain("includes <${target}>: only the standard library, Eigen and tl::expected are allowed")
    elseif(target IN_LIST needs_heap AND NOT first_line MATCHES "\\(set-up\\)")
      complain("includes <${target}>, but its first line does not say (set-up)")
    endif()
  endforeach()
endforeach()

set(missing ${headers})
list(FILTER missing EXCLUDE REGEX "-inl\\.hpp$|^cncplan_tools/")
set(unused ${missing})
list(FILTER missing EXCLUDE REGEX "/detail/")
list(REMOVE_ITEM missing cncplan/cncplan.hpp ${umbrella})
foreach(header IN LISTS missing)
  complain("is not included by cncplan.hpp: tools/umbrella writes it anew")
endforeach()
list(FILTER unused INCLUDE REGEX "/detail/")
list(REMOVE_ITEM unused ${included})
foreach(header IN LISTS unused)
  complain("is included by no header: it is no part of the library")
endforeach()

if(found OR NOT headers)
  message(FATAL_ERROR "A rule of the folders is broken")
endif()
list(LENGTH headers count)
message(STATUS "${count} headers keep the rules of the folders")
