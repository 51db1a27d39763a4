// Paths round the axis of a rotary table, cut so that the table's angle goes on without a jump (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>

#include "cncplan/core/error.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"
#include "cncplan/path/mapped.hpp"
#include "cncplan/path/part.hpp"

namespace cncplan {

/// The image of a part of a programmed path under a map whose `azimuth` follows the path round the table.
template <path::Map M, Path P>
using TablePath = path::Mapped<M, path::Part<P>>;

/// The least distance from the table's axis between two lengths, by golden-section search in eight parts.
template <Path P>
[[nodiscard]] typename P::Scalar least_radius(const P& path, typename P::Scalar from, typename P::Scalar to,
                                              const std::array<typename P::Scalar, 2>& center = {}) {
  using S = typename P::Scalar;
  const auto radius = [&](S s) {
    const auto point = path.position_at(s);
    return std::hypot(point.x() - center[0], point.y() - center[1]);
  };
  constexpr int parts = 8, rounds = 40;
  constexpr S golden = S(0.6180339887498949);
  S least = std::min(radius(from), radius(to));
  const S width = (to - from) / S(parts);
  for (int i = 0; i < parts; ++i) {
    S low = from + width * static_cast<S>(std::max(i - 1, 0)), high = from + width * static_cast<S>(i + 1);
    const S middle = radius(low + (high - low) / S(2));
    if (!(middle <= least + width)) continue;  // the radius changes by no more than the length
    for (int round = 0; round < rounds && high - low > S(1e-9) * (S(1) + least); ++round) {
      const S a = high - (high - low) * golden, b = low + (high - low) * golden;
      (radius(a) < radius(b) ? high : low) = radius(a) < radius(b) ? b : a;
    }
    least = std::min(least, radius(low + (high - low) / S(2)));
  }
  return least;
}

/// The angle, rad, at which a table begins that turns from `low` to `high`: that of the first point (x, y),
/// or as few whole turns from there as bring it within. How the program goes on is not known yet.
template <std::floating_point S>
[[nodiscard]] S first_table_angle(S x, S y, S low, S high) {
  const S angle = std::atan2(y, x);
  return angle + kinematics::turns_into(angle, angle, low, high);
}

/// Cuts a path into parts over which the table turns by one radian at most, and calls `add` with the image of
/// each. `table` is the angle at which the table stands, rad with whole turns; it is moved on. Error, with
/// nothing added: below_limit with the least radius, for a path that comes nearer to the axis than
/// `smallest_radius` mm.
template <path::Map M, Path P, std::invocable<const TablePath<M, P>&> Add>
[[nodiscard]] Expected<void> follow_table(const P& programmed, M map, typename P::Scalar smallest_radius,
                                          typename P::Scalar& table, Add&& add) {
  using S = typename P::Scalar;
  const S length = programmed.length();
  const auto [x, y] = map.center;
  const S least = least_radius(programmed, S(0), length, map.center);
  if (!(least >= smallest_radius))
    return tl::unexpected(Error{ErrorCode::below_limit, "radius", static_cast<double>(least),
                                static_cast<double>(smallest_radius)});
  for (S from = S(0); from < length;) {
    const auto start = programmed.position_at(from);
    const S radius = std::hypot(start.x() - x, start.y() - y);
    const S left = length - from, stride = radius / S(2);
    const S to = left <= stride ? length : from + (left < S(2) * stride ? left / S(2) : stride);
    const auto middle = programmed.position_at(from + (to - from) / S(2)), end = programmed.position_at(to);
    map.azimuth = kinematics::BasicAzimuth<S>(middle.x() - x, middle.y() - y, table);
    table = map.azimuth.of(end.x() - x, end.y() - y);
    add(TablePath<M, P>(map, path::Part<P>(programmed, from, to)));
    from = to;
  }
  return {};
}

}  // namespace cncplan
