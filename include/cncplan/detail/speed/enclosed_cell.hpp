// Speeds at which what a cell does not know of its third derivative hardly counts, and that its place allows.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/core/motion_limits.hpp"
#include "cncplan/detail/speed/speed_cell.hpp"

namespace cncplan::detail {

/// The cell of a path between two lengths, its third derivative enclosed.
template <EnclosedPath P>
[[nodiscard]] auto enclosed_cell(const P& path, typename P::Scalar from, typename P::Scalar to,
                                 typename P::Scalar feed) {
  using S = typename P::Scalar;
  constexpr int count = P::Vector::RowsAtCompileTime;
  const auto start = path.point_at(from);
  BasicSpeedCell<S, count> cell{to - from, feed, start.first, start.second};
  const auto along = path.enclosure(from, to);
  for (int i = 0; i < count; ++i) {
    const auto& third = along[static_cast<std::size_t>(i)].third;
    cell.spread[i] = (third.high - third.low) / S(2);
    cell.third[i] = third.low + cell.spread[i];
  }
  return cell;
}

/// The highest speed at which the spread takes a share of each limit at most; 0 where it is no number.
template <std::floating_point S, int N>
[[nodiscard]] S known_speed(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits,
                            S share) {
  if (!(cell.spread.minCoeff() >= S(0)) || cell.spread.hasNaN()) return S(0);
  const S h = cell.length;
  S speed = std::numeric_limits<S>::infinity();
  for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
    const S spread = std::sqrt(inner(cell.spread, cell.spread));
    if (!(spread > S(0))) return;
    speed = std::min({speed, std::cbrt(share * own.jerk / spread),
                      std::sqrt(share * own.acceleration / (spread * h)),
                      S(2) * share * own.velocity / (spread * h * h)});
  });
  return speed;
}

/// By which share velocity at the cell's feed may be higher between its ends and its middle than at them.
template <std::floating_point S, int N>
[[nodiscard]] S velocity_between(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits) {
  const S h = cell.length;
  const auto middle = cell.first_at(h / S(2)), end = cell.first_at(h);
  // Of the parabola: a point of it, where its tangents meet, and another point.
  const auto control = (cell.first + h / S(2) * cell.second).eval();
  S most = S(0);
  for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
    const auto size = [&](const auto& x) { return std::sqrt(inner(x, x)); };
    const S places = std::max({size(cell.first), size(middle), size(end)});
    const S bound = std::max({size(cell.first), size(control), size(end)}) + h * h / S(2) * size(cell.spread);
    most = std::max(most, (bound - places) * cell.feed / std::min(own.velocity, cell.feed));
  });
  return most;
}

/// About the highest speed that the feed and the limits allow at a cell's start.
template <std::floating_point S, int N>
[[nodiscard]] S place_speed(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits) {
  S speed = cell.feed;
  for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
    const S first = inner(cell.first, cell.first), second = inner(cell.second, cell.second),
            third = inner(cell.third, cell.third);
    if (first > S(0)) speed = std::min(speed, own.velocity / std::sqrt(first));
    if (second > S(0)) speed = std::min(speed, std::sqrt(own.acceleration / std::sqrt(second)));
    if (third > S(0)) speed = std::min(speed, std::cbrt(own.jerk / std::sqrt(third)));
  });
  return speed;
}

}  // namespace cncplan::detail
