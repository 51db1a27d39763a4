// A machine of one's own: a SCARA arm of two links. Its inverse is written once, for numbers and for jets;
// the library then plans a line within the limits of both elbows and the slide, and says how close they came.
#include <array>
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <iterator>
#include <vector>

using namespace cncplan;

struct Scara {
  using Scalar = double;
  using Joints = Vector3;  // shoulder, elbow (rad), slide (mm)

  double upper = 200, fore = 150;  // mm
  BasicJointLimits<double, 3> limits{
      .velocity = {2, 3, 100}, .acceleration = {10, 15, 500}, .jerk = {100, 150, 5000}};

  [[nodiscard]] Pose forward(const Joints& q) const {
    return {{upper * std::cos(q[0]) + fore * std::cos(q[0] + q[1]),
             upper * std::sin(q[0]) + fore * std::sin(q[0] + q[1]), q[2]},
            Vector3::UnitZ()};
  }

  // The elbow bent to the left. For numbers and for jets alike.
  template <NumberOver<double> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    using std::atan2, std::sqrt;
    const auto& [x, y, z] = point;
    const T cosine = (x * x + y * y - T(upper * upper + fore * fore)) / T(2 * upper * fore);
    const T sine = sqrt(T(1) - cosine * cosine);
    return {atan2(y, x) - atan2(T(fore) * sine, T(upper) + T(fore) * cosine), atan2(sine, cosine), z};
  }

  [[nodiscard]] Expected<Joints> inverse(const Pose& pose) const {
    const double distance = std::hypot(pose.position.x(), pose.position.y());
    if (!(distance < upper + fore && distance > upper - fore))
      return tl::unexpected(Error{ErrorCode::unreachable, "distance", distance, upper + fore});
    const auto q = joints(std::array{pose.position.x(), pose.position.y(), pose.position.z()});
    return Joints(q[0], q[1], q[2]);
  }

  [[nodiscard]] Eigen::Matrix<double, 6, 3> jacobian(const Joints& q) const {
    const Vector3 p = forward(q).position;
    const double bent = q[0] + q[1];
    Eigen::Matrix<double, 6, 3> result = Eigen::Matrix<double, 6, 3>::Zero();
    result.topRows<3>() << -p.y(), -fore * std::sin(bent), 0, p.x(), fore * std::cos(bent), 0, 0, 0, 1;
    return result;
  }

  [[nodiscard]] BasicJointLimits<double, 3> joint_limits() const { return limits; }
};
static_assert(Kinematics<Scara>);

// What the planner asks of a machine: joints along any path, and over what length they change their ways.
struct ScaraChart {
  using Scalar = double;
  static constexpr std::size_t joint_count = 3;
  static constexpr bool keeps_length = true;

  Scara machine;

  [[nodiscard]] double reach(const std::array<double, 3>& point) const {
    const double distance = std::hypot(point[0], point[1]);
    return std::min(machine.upper + machine.fore - distance, distance - (machine.upper - machine.fore));
  }
  template <NumberOver<double> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    return machine.joints(point);
  }
  template <NumberOver<double> T>
  [[nodiscard]] std::array<T, 3> measured(const std::array<T, 3>& point) const {
    return point;
  }
};
static_assert(Chart<ScaraChart>);

int main() {
  const Scara machine;
  const path::Segment line = path::Line({250, -180, 0}, {180, 200, 10});
  std::vector<plan::MappedBlock<ScaraChart>> blocks;
  double table = 0;  // there is none
  plan::cut(plan::Stretch<ScaraChart>{line, {machine}, 0, line.length(), false}, 5.0, table,
            [&](const auto& path) {
              blocks.push_back({path, 150.0});
            });

  std::vector<plan::BlockCaps> caps;
  plan::joint_caps(std::span<const plan::MappedBlock<ScaraChart>>(blocks), machine.limits, 0.001,
                   std::back_inserter(caps));
  std::vector<plan::Gate> gates(caps.size() + 1);
  std::vector<plan::Span> spans;
  const auto law = [](const Limits& limits) { return profile::seven_phase_solver(limits); };
  if (!plan::plan_spans(std::span<const plan::BlockCaps>(caps), law, std::span(gates),
                        std::back_inserter(spans)))
    return 1;

  std::vector<double> lengths;
  double duration = 0;
  for (const auto& block : caps) lengths.push_back(block.length);
  for (const auto& span : spans) duration += span.profile.duration();
  std::printf("%zu pieces, %.3f s\n     t      shoulder   elbow      slide      tip off the line\n",
              blocks.size(), duration);
  plan::Cursor cursor(spans, lengths);
  double worst = 0;
  for (int k = 0; k <= 10; ++k) {
    const double time = duration * k / 10;
    const auto place = cursor.at(time);
    const auto& path = blocks[place.block].path;
    const Vector3 q = path.position(path.parameter_at(place.along));
    const Vector3 gap = machine.forward(q).position - line.start();
    const Vector3 along = line.start_tangent();
    const double off = (gap - along * along.dot(gap)).norm();
    worst = std::max(worst, off);
    std::printf("%8.4f %10.6f %10.6f %10.6f %10.1e\n", time, q[0], q[1], q[2], off);
  }
  return worst < 1e-9 ? 0 : 1;
}
