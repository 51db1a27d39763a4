// Cycle time and set points of a G-code file: 01_plan_file PROGRAM
#include <cncplan/cncplan.hpp>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const cncplan::Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const auto trajectory = cncplan::plan_file(argv[1], mill);  // mm, s
  if (!trajectory) return std::fprintf(stderr, "%s\n", to_text(trajectory.error()).c_str()), 2;
  for (const auto& point : trajectory->samples(0.25))
    std::printf("%.3f s, line %d: %.4f %.4f %.4f\n", point.time, point.line, point.position[0],
                point.position[1], point.position[2]);
  std::printf("%.3f s, %.3f mm\n", trajectory->duration(), trajectory->length());
}
