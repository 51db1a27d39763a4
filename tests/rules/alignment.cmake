# That a program links with the compiled library where Eigen aligns vectors as there, and does not where it aligns them otherwise.
#   cmake -DCXX=g++ -DFLAGS=-I... -DLIBRARY=libcncplan.a -DWORK=folder -P alignment.cmake
file(MAKE_DIRECTORY ${WORK})
file(WRITE ${WORK}/main.cpp "#include <cncplan/core/compiled.hpp>\nint main() {}\n")
separate_arguments(FLAGS)
foreach(alignment 16 32)
  execute_process(COMMAND ${CXX} -std=c++20 ${FLAGS} -DCNCPLAN_COMPILED -DEIGEN_MAX_ALIGN_BYTES=${alignment} ${WORK}/main.cpp ${LIBRARY}
    -o ${WORK}/main RESULT_VARIABLE failed ERROR_VARIABLE said)
  if(alignment EQUAL 16 AND failed)
    message(FATAL_ERROR "${said}")
  elseif(alignment EQUAL 32 AND NOT said MATCHES "compiled_with_alignment<32>")
    message(FATAL_ERROR "vectors aligned to ${alignment} bytes link with a library that aligns them to 16: ${said}")
  endif()
endforeach()
