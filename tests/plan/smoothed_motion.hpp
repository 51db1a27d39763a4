// What smoothed motion does, by differences of positions, and how far it is from the program, by brute force.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "cncplan/core/vector.hpp"
#include "cncplan/machine.hpp"

namespace cncplan::test {

/// The most of each limit that differences of positions show, as a share, and the jerk's in time.
struct Used {
  double velocity = 0, acceleration = 0, jerk = 0;
};

template <class T, int N>
Used used(const T& trajectory, const Machine<N>& machine, double period = 1e-4) {
  using V = VectorN<double, N>;
  Used most;
  std::array<V, 4> p;
  p.fill(V::Zero());
  int known = 0;
  const auto share = [&](const V& value, auto limit_of_axis, double of_tool) {
    double result = value.template head<3>().norm() / of_tool;
    for (int i = 0; i < N; ++i)
      result =
          std::max(result, std::abs(value[i]) / limit_of_axis(machine.axes[static_cast<std::size_t>(i)]));
    return result;
  };
  for (const auto& point : trajectory.samples(period)) {
    if (!(point.time < trajectory.duration())) break;
    p = {point.position, p[0], p[1], p[2]};
    if (++known < 4) continue;
    const V v = (p[0] - p[1]) / period, a = (p[0] - 2 * p[1] + p[2]) / (period * period),
            j = (p[0] - 3 * p[1] + 3 * p[2] - p[3]) / (period * period * period);
    most.velocity =
        std::max(most.velocity, share(
                                    v, [](const Axis& x) { return x.velocity; }, machine.limits.velocity));
    most.acceleration = std::max(
        most.acceleration, share(
                               a, [](const Axis& x) { return x.acceleration; }, machine.limits.acceleration));
    most.jerk = std::max(most.jerk, share(
                                        j, [](const Axis& x) { return x.jerk; }, machine.limits.jerk));
  }
  return most;
}

/// Points of a curve, joined by chords.
using Polyline = std::vector<Vector3>;

inline double distance(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 d = b - a;
  const double t = d.squaredNorm() > 0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

/// The largest distance of one curve's points from the other: every point against every piece.
inline double farthest(const Polyline& points, const Polyline& curve) {
  double most = 0;
  for (const Vector3& p : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < curve.size(); ++i)
      nearest = std::min(nearest, distance(p, curve[i], curve[i + 1]));
    most = std::max(most, nearest);
  }
  return most;
}

/// Of blocks: lines by their ends, what is bent by chords that are less than 5e-7 mm off.
template <class Blocks>
Polyline programmed(const Blocks& blocks) {
  Polyline result;
  for (const auto& block : blocks) {
    const double length = block.path.length(), bend = block.path.bounds(0, length).second.norm();
    const int parts = block.path.line() != nullptr
                          ? 1
                          : std::max(400, static_cast<int>(std::ceil(length * std::sqrt(bend / 4e-6))));
    for (int i = 0; i <= parts; ++i)
      result.push_back(block.path.position_at(length * i / parts).template head<3>());
  }
  return result;
}
/// Each piece by so many chords.
template <class T>
Polyline driven(const T& trajectory, int parts) {
  Polyline result;
  for (std::size_t p = 0; p < trajectory.piece_count(); ++p) {
    const auto path = trajectory.path(p);
    for (int i = 0; i <= parts; ++i)
      result.push_back(path.position_at(path.length() * i / parts).template head<3>());
  }
  return result;
}

}  // namespace cncplan::test
