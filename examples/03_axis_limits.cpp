// A mill whose axes differ, with a rotary one: each keeps its own limits and its travel. Expected: no share
// above 1.
#include <algorithm>
#include <array>
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cstddef>
#include <cstdio>
#include <numbers>

using namespace cncplan;

int main() {
  constexpr double degree = std::numbers::pi / 180;
  const Machine<4> mill{
      .axes = {{{.letter = 'X', .velocity = 50, .acceleration = 800, .jerk = 8000, .low = 0, .high = 300},
                {.letter = 'Y', .velocity = 40, .acceleration = 500, .jerk = 5000, .low = 0, .high = 200},
                {.letter = 'Z', .velocity = 10, .acceleration = 300, .jerk = 3000, .low = -50, .high = 50},
                {.letter = 'A',
                 .kind = AxisKind::rotary,
                 .velocity = 90 * degree,
                 .acceleration = 400 * degree,
                 .jerk = 4000 * degree}}},
      .limits = {.velocity = 45, .acceleration = 900, .jerk = 9000}};
  const auto trajectory = plan_text(
      "G21 G90 F2700\n"
      "G0 X20 Y20 Z5\n"
      "G1 Z-2 F600\n"
      "G2 X60 Y60 R40 A90 F2700 (the rotary axis goes along with the arc)\n"
      "G1 X100 A0\n"
      "G3 X60 Y20 Z2 I-20 J-20 P2 (a helix of two turns)\n"
      "G1 A45 F3600 (a rotary axis alone: degrees a minute)\n",
      mill, {.tolerance = 0.02});
  if (!trajectory) return std::printf("%s\n", to_text(trajectory.error()).c_str()), 1;

  std::array<std::array<double, 3>, 4> share{};  // of velocity, acceleration and jerk, axis by axis
  for (const auto& point : trajectory->samples(0.0005))
    for (std::size_t i = 0; i < share.size(); ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const Axis& limit = mill.axes[i];
      const std::array used{point.velocity[axis] / limit.velocity,
                            point.acceleration[axis] / limit.acceleration, point.jerk[axis] / limit.jerk};
      for (std::size_t k = 0; k < used.size(); ++k) share[i][k] = std::max(share[i][k], std::abs(used[k]));
    }
  bool kept = true;
  std::printf("axis  velocity  acceleration  jerk, as shares of the limits; %.3f s\n",
              trajectory->duration());
  for (std::size_t i = 0; i < share.size(); ++i) {
    std::printf("%c %13.4f %13.4f %5.4f\n", mill.axes[i].letter, share[i][0], share[i][1], share[i][2]);
    for (const double used : share[i]) kept = kept && used <= 1 + 1e-9;
  }
  return kept ? 0 : 1;
}
