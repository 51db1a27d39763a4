// No G-code: blocks made by hand, planned, and asked where the tool is at any time, in any order.
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <vector>

using namespace cncplan;

int main() {
  const auto arc = path::arc_from_radius({20, 0, 0}, {25, 5, 0}, 5.0, Turn::counterclockwise, Plane::xy);
  if (!arc) return std::printf("%s\n", to_text(arc.error()).c_str()), 1;
  const std::vector<Block<3>> blocks{
      {.path = path::Line<3>({0, 0, 0}, {20, 0, 0}), .feed = 30},
      {.path = *arc, .feed = 20},
      {.path = path::Line<3>({25, 5, 0}, {25, 30, 0}), .feed = 30, .pause = 0.5}};
  const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const auto trajectory = plan_blocks(blocks, mill);
  if (!trajectory) return std::printf("%s\n", to_text(trajectory.error()).c_str()), 1;

  for (double t = trajectory->duration(); t > 0; t -= 0.2) {
    const auto point = trajectory->at(t);
    std::printf("%6.3f s: block %zu, %8.4f %8.4f mm, %7.3f mm/s\n", t, point.block, point.position[0],
                point.position[1], point.along.velocity);
  }
  for (const BlockMotion& block : trajectory->blocks())
    std::printf("block %zu: %.3f s from %.3f s, %.2f %.2f %.2f mm/s at its start, at most, at its end\n",
                block.block, block.duration, block.start, block.entry, block.peak, block.exit);
}
