// Results whose drop is a wrong part: each statement that drops one is a warning of the compiler. Not to be
// compiled but by dropped.cmake.
#include <cncplan/cncplan.hpp>

using namespace cncplan;

void drop(Executor<Machine<3>, 16>& executor, BlockReader<Machine<3>>& reader) {
  executor.push({});                                        // dropped
  executor.restart(0, {0, 0, 0});                           // dropped
  executor.jog({1, 0, 0});                                  // dropped
  executor.jog_to({1, 0, 0});                               // dropped
  executor.return_to_path();                                // dropped
  executor.error();                                         // dropped
  reader.read_line("G1 X1 F100");                           // dropped
  reader.end_of_program();                                  // dropped
  plan_file("part.ngc", Machine<3>{}, {.tolerance = 0});    // dropped
  plan_text("G1 X1 F100", Machine<3>{}, {.tolerance = 0});  // dropped
  read_file("part.ngc", Machine<3>{});                      // dropped
  read_text("G1 X1 F100", Machine<3>{});                    // dropped
}
