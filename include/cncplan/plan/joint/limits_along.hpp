// Speed caps in machine space: what the limits of the joints leave for motion along the path.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/joint_limits.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/plan/joint/path.hpp"

namespace cncplan::plan {

/// Upper bounds of the magnitudes of a path's joint rates, everywhere on it. Between five evenly spaced
/// places a derivative departs from the nearer one by at most an eighth of the length times the next
/// derivative; for the third, the largest difference between neighbours stands for that.
template <JointPath P>
[[nodiscard]] auto rate_bounds(const P& path) {
  using S = typename P::Scalar;
  using Vector = typename P::Vector;
  using Rates = BasicJointRates<S, Vector::RowsAtCompileTime>;
  constexpr int intervals = 4;
  const S reach = path.length() / S(2 * intervals);
  Rates bounds;
  Vector before = Vector::Zero(), change = before;
  for (int i = 0; i <= intervals; ++i) {
    const Rates here = path.rates(path.parameter_end() * static_cast<S>(i) / static_cast<S>(intervals));
    bounds.first = bounds.first.cwiseMax(here.first.cwiseAbs());
    bounds.second = bounds.second.cwiseMax(here.second.cwiseAbs());
    bounds.third = bounds.third.cwiseMax(here.third.cwiseAbs());
    if (i > 0) change = change.cwiseMax((here.third - before).cwiseAbs());
    before = here.third;
  }
  bounds.third += change;
  bounds.second += reach * bounds.third;
  bounds.first += reach * bounds.second;
  return bounds;
}

/// Limits along the path under which no joint breaks its own, whatever acceleration and jerk within them the
/// profile uses at whatever speed: the bends of the joints' path get at most half of each joint's
/// acceleration and a quarter of its jerk, the term that joins speed and acceleration another quarter, and
/// changes of speed the rest. No faster than `feed`.
template <std::floating_point S, int N>
[[nodiscard]] BasicLimits<S> limits_along(const BasicJointRates<S, N>& bounds,
                                          const BasicJointLimits<S, N>& joints, S feed) {
  BasicLimits<S> limits{feed, std::numeric_limits<S>::infinity(), std::numeric_limits<S>::infinity()};
  for (int i = 0; i < N; ++i) {
    if (bounds.first[i] > S(0))
      limits.velocity = std::min(limits.velocity, joints.velocity[i] / bounds.first[i]);
    if (bounds.second[i] > S(0))
      limits.velocity =
          std::min(limits.velocity, std::sqrt(joints.acceleration[i] / (S(2) * bounds.second[i])));
    if (bounds.third[i] > S(0))
      limits.velocity = std::min(limits.velocity, std::cbrt(joints.jerk[i] / (S(4) * bounds.third[i])));
  }
  const S v = limits.velocity;
  for (int i = 0; i < N; ++i) {
    if (bounds.first[i] > S(0))
      limits.acceleration = std::min(limits.acceleration,
                                     (joints.acceleration[i] - bounds.second[i] * v * v) / bounds.first[i]);
    if (bounds.second[i] > S(0))
      limits.acceleration = std::min(limits.acceleration, joints.jerk[i] / (S(12) * bounds.second[i] * v));
  }
  for (int i = 0; i < N; ++i) {
    if (!(bounds.first[i] > S(0)) || !std::isfinite(joints.jerk[i])) continue;
    S used = bounds.third[i] * v * v * v;
    if (bounds.second[i] > S(0)) used += S(3) * bounds.second[i] * v * limits.acceleration;
    limits.jerk = std::min(limits.jerk, (joints.jerk[i] - used) / bounds.first[i]);
  }
  return limits;
}

/// The highest speed at which the motion may pass from one path to the next where they do not join smoothly.
/// A jump of a joint's velocity counts as spread over `corner_time` seconds, or over the time that the
/// shorter of both paths takes, `length` mm, if that is less: so many short paths in a row are a curve. So
/// spread, and with the bends of both paths, it keeps to the joint's acceleration limit; a jump of its
/// acceleration keeps to its jerk limit. With a corner time of zero every such place is a stop. Infinite
/// where the joints' rates agree to rounding.
template <std::floating_point S, int N>
[[nodiscard]] S corner_speed(const BasicJointRates<S, N>& before, const BasicJointRates<S, N>& after,
                             const BasicJointLimits<S, N>& joints, S corner_time, S length) {
  const S rounding = std::sqrt(std::numeric_limits<S>::epsilon());
  const S size = std::max(before.first.cwiseAbs().maxCoeff(), after.first.cwiseAbs().maxCoeff());
  const S bends = std::max(before.second.cwiseAbs().maxCoeff(), after.second.cwiseAbs().maxCoeff());
  S speed = std::numeric_limits<S>::infinity();
  for (int i = 0; i < N; ++i) {
    const S jump = std::abs(after.first[i] - before.first[i]);
    const S bend = std::max(std::abs(before.second[i]), std::abs(after.second[i]));
    const S limit = joints.acceleration[i];
    if (jump > rounding * size && std::isfinite(limit)) {
      // jump v / corner_time + bend v^2 = limit, and jump v^2 / length + bend v^2 = limit
      const S by_time = jump / corner_time;
      const S root = std::sqrt(by_time * by_time + S(4) * limit * bend);
      speed = std::min({speed, corner_time > S(0) ? S(2) * limit / (by_time + root) : S(0),
                        std::sqrt(limit / (jump / length + bend))});
    }
    const S bending = std::abs(after.second[i] - before.second[i]);
    if (bending > rounding * (bends + size))
      speed = std::min({speed, std::sqrt(joints.jerk[i] * corner_time / bending),
                        std::cbrt(joints.jerk[i] * length / bending)});
  }
  return speed;
}

}  // namespace cncplan::plan
