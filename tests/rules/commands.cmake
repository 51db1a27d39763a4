# That the commands a page shows run as they stand: each ```sh block of PAGE, in a folder that has the project's examples
# and a program of one's own, part.ngc. Blocks that call tools/ are left out: these build, and call the tests.
#   cmake -DPAGE=docs/simulate.md -DROOT=. -DPROGRAMS=build/examples -DWORK=folder -P commands.cmake
cmake_minimum_required(VERSION 3.22)

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
file(CREATE_LINK ${ROOT}/examples ${WORK}/examples SYMBOLIC)
file(COPY_FILE ${ROOT}/examples/programs/pocket.ngc ${WORK}/part.ngc)
set(ENV{PATH} "${PROGRAMS}:$ENV{PATH}")

file(READ ${PAGE} rest)
set(count 0)
while(TRUE)
  string(FIND "${rest}" "\n```sh\n" start)
  if(start EQUAL -1)
    break()
  endif()
  math(EXPR start "${start} + 7")
  string(SUBSTRING "${rest}" ${start} -1 rest)
  string(FIND "${rest}" "\n```" end)
  string(SUBSTRING "${rest}" 0 ${end} block)
  if(NOT block MATCHES "(^|\n)tools/")
    execute_process(COMMAND sh -euc "${block}" WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result OUTPUT_QUIET
      ERROR_VARIABLE said)
    if(NOT result EQUAL 0)
      message(FATAL_ERROR "${PAGE} shows commands that end with ${result}:\n${block}\n${said}")
    endif()
    math(EXPR count "${count} + 1")
  endif()
endwhile()
message(STATUS "${PAGE}: ${count} blocks of commands run")
