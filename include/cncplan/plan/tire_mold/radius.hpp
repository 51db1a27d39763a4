// How far from the table's axis a segment runs: where that turns round, and where it passes a value.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "cncplan/path/segment.hpp"

namespace cncplan::plan {

/// hypot(x, y) along a segment.
template <std::floating_point S>
[[nodiscard]] S radius_at(const path::BasicSegment<S>& segment, S u) {
  const BasicVector3<S> p = segment.position(u);
  return std::hypot(p.x(), p.y());
}

/// Smallest parameter > u at which the radius turns from falling to growing or back; parameter_end() if there
/// is none. The slope is looked at once in a line, and sixteen times a turn on an arc.
template <std::floating_point S>
[[nodiscard]] S next_radius_turning(const path::BasicSegment<S>& segment, S u) {
  const S end = segment.parameter_end();
  const auto slope = [&](S at) {
    const BasicVector3<S> p = segment.position(at);
    const BasicVector3<S> d = segment.derivative(at);
    return p.x() * d.x() + p.y() * d.y();
  };
  const S stride = segment.arc() == nullptr ? end : std::numbers::pi_v<S> / S(8);
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
[[nodiscard]] S radius_crossing(const path::BasicSegment<S>& segment, S value, S low, S high) {
  const bool grows = radius_at(segment, high) > radius_at(segment, low);
  for (int halving = 0; halving < std::numeric_limits<S>::digits; ++halving) {
    const S middle = low + (high - low) / S(2);
    ((radius_at(segment, middle) < value) == grows ? low : high) = middle;
  }
  return high;
}

}  // namespace cncplan::plan
