// A quarter of a circle, from rest to rest within the limits: prints time, x and y at every millisecond.
#include <array>
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

int main() {
  const auto arc = path::arc_from_radius({0, 0, 0}, {5, 5, 0}, 5.0, Turn::clockwise, Plane::xy);
  if (!arc) return 1;

  const Machine<3> mill{.limits = {.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0}};
  const auto trajectory = plan_blocks(std::array{Block<3>{.path = *arc}}, mill);
  if (!trajectory) return 1;

  for (const auto& point : trajectory->samples(1e-3))
    std::printf("%.6f %.6f %.6f\n", point.time, point.position.x(), point.position.y());
}
