// A junction policy of one's own: a corner is passed the slower the sharper it is. Compares how long a
// program takes with those of the library.
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <vector>

using namespace cncplan;

// Half of the feed where the path turns by 90 degrees, nothing where it turns back.
struct ByAngle {
  [[nodiscard]] double speed_sq(const junction::Geometry& junction) const {
    const double cosine = junction.before.tangent.dot(junction.after.tangent);
    const double speed = junction.limits.velocity * (1.0 + cosine) / 2.0;
    return speed * speed;
  }
};
static_assert(JunctionPolicy<ByAngle>);

template <class Policy>
void print(const char* name, const std::vector<Block<3>>& blocks, const Policy& policy) {
  const Machine<3> mill{.limits = {.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0}};
  if (const auto trajectory = plan_blocks(blocks, mill, policy))
    std::printf("%-24s %8.4f s\n", name, trajectory->duration());
}

int main() {
  std::vector<Block<3>> blocks;
  for (int i = 0; i < 24; ++i) {  // a zigzag whose corners get sharper
    const double x = 8.0 * i, y = i * (i % 2 == 0 ? 1.0 : -1.0);
    const double next = (i + 1) * (i % 2 == 0 ? -1.0 : 1.0);
    blocks.push_back({.path = path::Line<3>({x, y, 0}, {x + 8.0, next, 0})});
  }
  print("exact stop", blocks, junction::ExactStop{});
  print("by angle", blocks, ByAngle{});
  print("deviation of 0.01 mm", blocks, junction::Deviation{0.01});
  print("the lower of both", blocks, junction::minimum(ByAngle{}, junction::Deviation{0.01}));
}
