# Builds the consumer with nothing but pkg-config and a compiler's command line, in C++20 and in the newest standard that
# the compiler knows, and runs it.   cmake -DCXX=g++ -DPREFIX=installed -DWORK=folder -P pkg_config.cmake
file(MAKE_DIRECTORY ${WORK})
file(GLOB folder ${PREFIX}/*/pkgconfig)
set(ENV{PKG_CONFIG_PATH} ${folder})
execute_process(COMMAND pkg-config --cflags --libs cncplan OUTPUT_VARIABLE flags
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
foreach(standard c++26 c++2c c++23 c++2b)
  execute_process(COMMAND ${CXX} -std=${standard} -fsyntax-only -x c++ /dev/null RESULT_VARIABLE unknown OUTPUT_QUIET ERROR_QUIET)
  if(NOT unknown)
    set(newest ${standard})
    break()
  endif()
endforeach()
foreach(standard c++20 ${newest})
  message(STATUS "${CXX} -std=${standard} ${flags}")
  execute_process(COMMAND ${CXX} -std=${standard} ${CMAKE_CURRENT_LIST_DIR}/main.cpp ${CMAKE_CURRENT_LIST_DIR}/other.cpp
    ${flags} -o ${WORK}/consumer-${standard} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${WORK}/consumer-${standard} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
