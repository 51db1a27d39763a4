// All problems of a program at once, each with its place, and its time where there is none:
//   05_check_program PROGRAM
// Exit 0: no errors; 2: errors.
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "give a program\n"), 2;
  constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000},
                            .rapid_rate = 50};
  const auto program = read_file(argv[1], mill);  // blocks, words, problems; read_text is for text in memory
  for (const auto& problem : program.problems()) std::printf("%s\n", to_text(problem).c_str());
  if (program.failed()) return 2;
  const auto trajectory = plan_program(program, mill, {.level = SmoothLevel::good});  // a seventh of the work
  if (!trajectory) return std::fprintf(stderr, "%s\n", to_text(trajectory.error()).c_str()), 2;
  std::printf("%zu blocks, %.3f mm in %.3f s\n", program.blocks().size(), trajectory->length(),
              trajectory->duration());
}
