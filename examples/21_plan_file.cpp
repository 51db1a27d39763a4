// Cycle time and set points of a G-code file on a mill whose axes differ: 21_plan_file PROGRAM
#include <cncplan/cncplan.hpp>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const cncplan::Machine<3> mill{
      .axes = {{{.letter = 'X', .velocity = 50, .acceleration = 800, .jerk = 8000, .low = -300, .high = 300},
                {.letter = 'Y', .velocity = 40, .acceleration = 500, .jerk = 5000, .low = -200, .high = 200},
                {.letter = 'Z', .velocity = 10, .acceleration = 300, .jerk = 3000, .low = -80, .high = 100}}},
      .limits = {.velocity = 45, .acceleration = 900, .jerk = 9000}};
  const auto trajectory = cncplan::plan_file(argv[1], mill, {.tolerance = 0.01});
  if (!trajectory) return std::fprintf(stderr, "%s\n", to_text(trajectory.error()).c_str()), 2;
  for (const auto& point : trajectory->samples(0.001))
    std::printf("%.3f %d %.6f %.6f %.6f\n", point.time, point.line, point.position[0], point.position[1],
                point.position[2]);
  std::printf("%.3f s, %.3f mm\n", trajectory->duration(), trajectory->length());
}
