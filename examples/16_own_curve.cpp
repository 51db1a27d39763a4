// A curve of one's own, written once as a template, between two lines: planned, joined and sampled like any
// other block. Expected: the tool leaves neither its limits nor the ellipse.
#include <algorithm>
#include <array>
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <numbers>
#include <vector>

using namespace cncplan;

// The upper half of an ellipse, from left to right.
struct Arch {
  using Scalar = double;
  using Vector = VectorN<double, 3>;

  double half_width = 20, height = 8;  // mm

  double parameter_end() const { return std::numbers::pi; }
  template <class T>  // a number, or one that carries derivatives or bounds
  std::array<T, 3> point(const T& u) const {
    using std::cos, std::sin;
    return {T(-half_width) * cos(u), T(height) * sin(u), T(0)};
  }
};

int main() {
  const auto arch = path::measured(Arch{});  // by its length
  if (!arch) return std::printf("%s\n", to_text(arch.error()).c_str()), 1;
  const std::vector<Block<3, path::Measured<Arch>>> blocks{
      {.path = path::Line<3>({-20, -10, 0}, {-20, 0, 0}), .feed = 30},
      {.path = *arch, .feed = 30},
      {.path = path::Line<3>({20, 0, 0}, {20, -10, 0}), .feed = 30}};
  const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const auto trajectory = plan_blocks(blocks, mill, {.tolerance = 0});  // the exact path
  if (!trajectory) return std::printf("%s\n", to_text(trajectory.error()).c_str()), 1;

  double off = 0, acceleration = 0, jerk = 0;
  for (const auto& point : trajectory->samples(0.001)) {
    if (point.block != 1) continue;
    off = std::max(off, std::abs(std::hypot(point.tool.x() / 20, point.tool.y() / 8) - 1));
    acceleration = std::max(acceleration, point.acceleration.norm());
    jerk = std::max(jerk, point.jerk.norm());
  }
  std::printf("an arch of %.6f mm; all in %.3f s\n", arch->length(), trajectory->duration());
  std::printf("off the ellipse: %.1e of its size; acceleration %.0f of 1000, jerk %.0f of 10000\n", off,
              acceleration, jerk);
  return off < 1e-12 && acceleration <= 1000 && jerk <= 10000 ? 0 : 1;
}
