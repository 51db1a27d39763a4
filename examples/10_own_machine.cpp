// A machine of one's own: a SCARA arm of two links. Its inverse is written once, for numbers and for jets;
// the library then plans a line within the limits of both elbows and the slide.
#include <array>
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

struct Scara {
  using Scalar = double;
  static constexpr std::size_t joint_count = 3;  // shoulder, elbow (rad), slide (mm)

  double upper = 200, fore = 150;  // mm

  // The elbow bent to the left. Evaluated with jets it gives the joints' speeds, accelerations and jerks.
  template <NumberOver<double> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    using std::atan2, std::sqrt;
    const auto& [x, y, z] = point;
    const T cosine = (x * x + y * y - T(upper * upper + fore * fore)) / T(2 * upper * fore);
    const T sine = sqrt(T(1) - cosine * cosine);
    return {atan2(y, x) - atan2(T(fore) * sine, T(upper) + T(fore) * cosine), atan2(sine, cosine), z};
  }

  // How far it is to where the elbow is straight, or folded: there the map ends.
  [[nodiscard]] double reach(const std::array<double, 3>& point) const {
    const double distance = std::hypot(point[0], point[1]);
    return std::min(upper + fore - distance, distance - (upper - fore));
  }

  [[nodiscard]] Vector3 tip(const Vector3& q) const {
    return {upper * std::cos(q[0]) + fore * std::cos(q[0] + q[1]),
            upper * std::sin(q[0]) + fore * std::sin(q[0] + q[1]), q[2]};
  }
};
static_assert(Chart<Scara>);

int main() {
  const Scara machine;
  const BasicJointLimits<double, 3> limits{
      .velocity = {2, 3, 100}, .acceleration = {10, 15, 500}, .jerk = {100, 150, 5000}};
  const path::Line<3> line({250, -180, 0}, {180, 200, 10});

  plan::JointCourse course{plan::OneChart(machine)};
  if (!course.append(line, 150.0)) return 1;  // mm/s, where the joints allow
  const auto plan = plan::whole_plan(course.blocks(), limits, 0.001);
  if (!plan) return 1;

  std::printf("%8s %10s %10s %10s %18s\n", "s", "shoulder", "elbow", "slide", "tip off the line");
  plan::Cursor cursor(plan->spans, plan->lengths);
  double worst = 0;
  for (int k = 0; k <= 10; ++k) {
    const double time = plan->duration * k / 10;
    const plan::Place place = cursor.at(time);
    const auto& path = course.blocks()[place.block].path;
    const Vector3 q = path.position(path.parameter_at(place.along));
    const Vector3 gap = machine.tip(q) - line.start();
    const double off = (gap - line.start_tangent().dot(gap) * line.start_tangent()).norm();
    std::printf("%8.4f %10.6f %10.6f %10.6f %18.1e\n", time, q[0], q[1], q[2], off);
    worst = std::max(worst, off);
  }
  return worst < 1e-9 ? 0 : 1;
}
