// The fastest motion of six joints along a curve of one's own, each within its limits of velocity,
// acceleration and jerk: no program, no machine, only the law of speed. Expected: some joint is always near a
// limit, none above.
#include <algorithm>
#include <array>
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cstddef>
#include <cstdio>

using namespace cncplan;

// Joints of a robot that swings from one pose to another, rad.
struct Swing {
  using Scalar = double;
  using Vector = VectorN<double, 6>;

  double parameter_end() const { return 2; }
  template <class T>  // a number, or one that carries derivatives or bounds
  std::array<T, 6> point(const T& u) const {
    using std::cos, std::sin;
    return {u, T(0.6) * sin(u), T(0.8) * cos(T(1.5) * u), u, T(0.5) * cos(T(2) * u), T(0.3) * sin(T(3) * u)};
  }
};

int main() {
  const auto path = path::measured(Swing{});  // by its length in the space of the joints
  if (!path) return std::printf("%s\n", to_text(path.error()).c_str()), 1;
  MotionLimits<6> limits;  // rad/s, rad/s^2, rad/s^3
  limits.axes = {{{2, 8, 60}, {2, 8, 60}, {2, 8, 60}, {3, 20, 200}, {3, 20, 200}, {4, 30, 300}}};
  const auto motion = time_optimal(*path, limits);
  if (!motion) return std::printf("%s\n", to_text(motion.error()).c_str()), 1;

  double most = 0, least = 1;  // the largest share of a limit that is used, over time
  for (double time = 0; time < motion->duration(); time += 0.001) {
    const auto [s, velocity, acceleration, jerk] = motion->at(time);
    const auto q = path->point_at(s);
    const auto joint_velocity = (velocity * q.first).eval();
    const auto joint_acceleration = (velocity * velocity * q.second + acceleration * q.first).eval();
    const auto joint_jerk =
        (std::pow(velocity, 3) * q.third + 3 * velocity * acceleration * q.second + jerk * q.first).eval();
    double share = 0;
    for (std::size_t i = 0; i < limits.axes.size(); ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      share = std::max({share, std::abs(joint_velocity[joint]) / limits.axes[i].velocity,
                        std::abs(joint_acceleration[joint]) / limits.axes[i].acceleration,
                        std::abs(joint_jerk[joint]) / limits.axes[i].jerk});
    }
    most = std::max(most, share);
    least = std::min(least, share);
  }
  std::printf("%.3f rad in %.3f s, %zu phases\n", path->length(), motion->duration(),
              motion->phases().size());
  std::printf("of its limit the nearest joint uses %.2f to %.4f\n", least, most);
  return most <= 1 ? 0 : 1;
}
