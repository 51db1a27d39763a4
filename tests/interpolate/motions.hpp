// Motions for the tests of sampling, and the same worked out apart from the library, in long double.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "support/random.hpp"

namespace cncplan::test {

template <class S>
BasicLimits<S> paper_limits() {
  return {S(30), S(1000), S(10000)};
}

template <class S, class P>
profile::BasicProfile<S> rest_to_rest(const P& path) {
  return profile::seven_phase<S>(path.length(), {S(0), S(0)}, paper_limits<S>()).value();
}

/// A line, a circle, a helix and a spiral of random size, place and plane.
template <class S>
std::vector<path::BasicSegment<S>> random_segments(Random& random) {
  using V = BasicVector3<S>;
  const auto number = [&](double low, double high) { return static_cast<S>(random.uniform(low, high)); };
  const V start(number(-50, 50), number(-50, 50), number(-50, 50));
  std::vector<path::BasicSegment<S>> result;
  result.push_back(path::BasicLine<S>(start, V(number(-50, 50), number(-50, 50), number(-50, 50))));
  for (const double rise : {0.0, 3.0})
    for (const double growth : {0.0, 1e-3}) {
      const Plane plane =
          std::array{Plane::xy, Plane::zx, Plane::yz}[static_cast<std::size_t>(random.integer(0, 2))];
      const PlaneAxes a = axes(plane);
      const S radius = static_cast<S>(random.log_uniform(0.5, 100));
      const S from = number(-3, 3);
      const S to = from + number(0.3, 6);
      const auto around = [&](S angle, S r, S height) {
        V v = V::Zero();
        v[a.first] = r * std::cos(angle);
        v[a.second] = r * std::sin(angle);
        v[a.third] = height;
        return v;
      };
      const V end = start - around(from, radius, S(0)) +
                    around(to, radius * static_cast<S>(1 + growth), static_cast<S>(rise));
      const auto arc =
          path::arc_from_center<S>(start, end, start - around(from, radius, S(0)),
                                   random.coin() ? Turn::clockwise : Turn::counterclockwise, plane);
      if (arc) result.push_back(*arc);
    }
  return result;
}

/// The length travelled at t by a profile's phases.
template <class F>
long double travelled(const F& profile, long double t) {
  long double s = 0;
  for (const auto& phase : profile.phases()) {
    if (phase.duration == 0 || t < phase.time) continue;
    const long double tau = t - phase.time;
    s = phase.position +
        tau * (phase.velocity + tau * (phase.acceleration / 2.0L + tau * (phase.jerk / 6.0L)));
  }
  return s;
}

/// A circle or helix about the third axis of XY, counter-clockwise from (radius, 0, 0).
inline Eigen::Matrix<long double, 3, 1> helix_point(long double radius, long double rise_per_radian,
                                                    long double s) {
  const long double u = s / std::sqrt(radius * radius + rise_per_radian * rise_per_radian);
  return {radius * std::cos(u), radius * std::sin(u), rise_per_radian * u};
}

}  // namespace cncplan::test
