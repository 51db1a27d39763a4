// The whole way: a G-code program read, planned with look-ahead, and sampled at every 10 ms.
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

int main() {
  const char* const program = R"(G21 G90 G17 F1200
G0 X10 Y5
G1 X40
G3 X45 Y10 R5 (tangent: passed without slowing down)
G1 Y30
G1 X10 (a corner)
M30
)";
  const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}, .rapid_rate = 50};
  const auto trajectory = plan_text(program, mill, {.tolerance = 0.01});
  if (!trajectory) return std::printf("%s\n", to_text(trajectory.error()).c_str()), 1;

  for (const auto& point : trajectory->samples(0.01))
    std::printf("line %d %8.3f s %9.4f %9.4f mm %8.3f mm/s\n", point.line, point.time, point.position[0],
                point.position[1], point.along.velocity);
  std::printf("%zu blocks, %.3f mm in %.3f s\n", trajectory->blocks().size(), trajectory->length(),
              trajectory->duration());
}
