// A machine whose axes are not the program's coordinates: a SCARA arm of two links and a slide. Its map is
// written once, for numbers and for numbers with derivatives or bounds; the library plans within the limits
// of the joints. Expected: the tip stays on the programmed line.
#include <algorithm>
#include <array>
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

struct Scara {
  using Scalar = double;
  static constexpr int axis_count = 3;  // shoulder, elbow (rad), slide (mm)

  double upper = 200, fore = 150;  // mm

  // The elbow bent to the left.
  template <class T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    using std::atan2, std::sqrt;
    const auto& [x, y, z] = point;
    const T cosine = (x * x + y * y - T(upper * upper + fore * fore)) / T(2 * upper * fore);
    const T sine = sqrt(T(1) - cosine * cosine);
    return {atan2(y, x) - atan2(T(fore) * sine, T(upper) + T(fore) * cosine), atan2(sine, cosine), z};
  }

  [[nodiscard]] Vector3 tip(const Vector3& q) const {
    return {upper * std::cos(q[0]) + fore * std::cos(q[0] + q[1]),
            upper * std::sin(q[0]) + fore * std::sin(q[0] + q[1]), q[2]};
  }
};

int main() {
  const MappedMachine<Scara> arm{
      .map = {},
      .axes = {{{.letter = 'J', .kind = AxisKind::rotary, .velocity = 2, .acceleration = 10, .jerk = 100},
                {.letter = 'K', .kind = AxisKind::rotary, .velocity = 3, .acceleration = 15, .jerk = 150},
                {.letter = 'Z', .velocity = 100, .acceleration = 500, .jerk = 5000}}},
      .limits = {.velocity = 150, .acceleration = 2000, .jerk = 40000}};
  const auto trajectory = plan_text("G1 X180 Y200 Z10 F9000", arm, {.start = {250, -180, 0}});
  if (!trajectory) return std::printf("%s\n", to_text(trajectory.error()).c_str()), 1;

  const Vector3 start(250, -180, 0), way = (Vector3(180, 200, 10) - start).normalized();
  double worst = 0;
  std::printf("%8s %10s %10s %10s %18s\n", "s", "shoulder", "elbow", "slide", "tip off the line");
  for (const auto& point : trajectory->samples(trajectory->duration() / 10)) {
    const Vector3 gap = arm.map.tip(point.position) - start;
    const double off = (gap - way.dot(gap) * way).norm();
    std::printf("%8.4f %10.6f %10.6f %10.6f %18.1e\n", point.time, point.position[0], point.position[1],
                point.position[2], off);
    worst = std::max(worst, off);
  }
  return worst < 1e-9 ? 0 : 1;
}
