# That compilers which cannot give right results are refused with a sentence, whatever header of core/ comes first.
#   cmake -DCXX=g++ "-DFLAGS=-I..." -DINCLUDE=include -P compiler.cmake
cmake_minimum_required(VERSION 3.22)
separate_arguments(flags UNIX_COMMAND "${FLAGS}")
file(GLOB_RECURSE headers RELATIVE ${INCLUDE} ${INCLUDE}/cncplan/core/*.hpp)

function(compile header options result said)
  execute_process(COMMAND ${CXX} -x c++ -std=c++20 ${options} -fsyntax-only -Wfatal-errors ${flags} ${INCLUDE}/${header}
    RESULT_VARIABLE failed ERROR_VARIABLE text OUTPUT_QUIET)
  set(${result} ${failed} PARENT_SCOPE)
  set(${said} "${text}" PARENT_SCOPE)
endfunction()

function(refused header option sentence)
  compile(${header} ${option} failed said)
  if(NOT failed OR NOT said MATCHES "${sentence}")
    message(SEND_ERROR "${header} with ${option} is not refused")
  endif()
endfunction()

foreach(header IN LISTS headers)
  refused(${header} -ffast-math "needs exact arithmetic")
endforeach()
refused(cncplan/cncplan.hpp -std=c++17 "needs C[+][+]20")
refused(cncplan/core/error.hpp -ffinite-math-only "needs exact arithmetic")
compile(cncplan/core/error.hpp "-O2" failed said)
if(failed)
  message(SEND_ERROR "what is right is refused:\n${said}")
endif()
