// Flat artwork: what it goes along, and how far from the table's axis that runs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "cncplan/path/segment.hpp"
#include "cncplan/path/spline.hpp"

namespace cncplan::tire_mold {

/// What flat artwork goes along: lines, arcs and pieces of splines, mm.
template <std::floating_point S>
using BasicArtworkPath = path::BasicSegment<S, 3, path::BasicSpline<S, 3>>;
using ArtworkPath = BasicArtworkPath<double>;

/// The flat point at a parameter, X, Y and Z, of numbers, jets or intervals.
template <std::floating_point S, class T>
[[nodiscard]] std::array<T, 3> artwork_point(const BasicArtworkPath<S>& artwork, const T& u) {
  return artwork.visit([&](const auto& path) {
    if constexpr (requires { path.curve(); })
      return path.curve().point(u);
    else
      return path.point(u);
  });
}

/// hypot(x, y) along artwork.
template <std::floating_point S>
[[nodiscard]] S radius_at(const BasicArtworkPath<S>& segment, S u) {
  const BasicVector3<S> p = segment.position(u);
  return std::hypot(p.x(), p.y());
}

/// Smallest parameter > u at which the radius turns from falling to growing or back; parameter_end() if there
/// is none. The slope is looked at once in a line, sixteen times a turn on an arc, and at 64 places of a
/// spline's piece, whose radius turns round five times at most.
template <std::floating_point S>
[[nodiscard]] S next_radius_reversal(const BasicArtworkPath<S>& segment, S u) {
  const S end = segment.parameter_end();
  const auto slope = [&](S at) {
    const BasicVector3<S> p = segment.position(at);
    const BasicVector3<S> d = segment.derivative(at);
    return p.x() * d.x() + p.y() * d.y();
  };
  const S stride = segment.line() != nullptr  ? end
                   : segment.arc() != nullptr ? std::numbers::pi_v<S> / S(8)
                                              : end / S(64);
  S low = u;
  S before = slope(u);
  while (low < end) {
    S high = std::min(low + stride, end);
    const S after = slope(high);
    if (before == S(0)) before = after;
    if (before * after < S(0)) {
      for (int halving = 0; halving < std::numeric_limits<S>::digits; ++halving) {
        const S middle = low + (high - low) / S(2);
        (slope(middle) * after > S(0) ? high : low) = middle;
      }
      return high;
    }
    low = high;
  }
  return end;
}

/// The parameter in [low, high], between which the radius does not turn round, at which it passes `value`.
template <std::floating_point S>
[[nodiscard]] S radius_crossing(const BasicArtworkPath<S>& segment, S value, S low, S high) {
  const bool grows = radius_at(segment, high) > radius_at(segment, low);
  for (int halving = 0; halving < std::numeric_limits<S>::digits; ++halving) {
    const S middle = low + (high - low) / S(2);
    ((radius_at(segment, middle) < value) == grows ? low : high) = middle;
  }
  return high;
}

}  // namespace cncplan::tire_mold
