// Limits along a path under which the tool and each axis keep their own.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <type_traits>

#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/core/path_bounds.hpp"
#include "cncplan/detail/speed/shared_limits.hpp"
#include "cncplan/machine.hpp"

namespace cncplan::detail {

/// The limits of one axis, those towards smaller positions included.
template <std::floating_point S>
struct BasicLimitedAxis {
  int axis{};
  BasicLimits<S> limits;
};

/// The limits of a machine's tool, and of those of its axes that have any: made once for many paths.
template <std::floating_point S, int N>
struct BasicMachineLimits {
  BasicLimits<S> tool;
  FixedList<BasicLimitedAxis<S>, static_cast<std::size_t>(N)> axes;
};

/// Those of a machine.
template <MachineModel M>
[[nodiscard]] BasicMachineLimits<typename M::Scalar, M::axis_count> machine_limits(const M& machine) {
  BasicMachineLimits<typename M::Scalar, M::axis_count> result{machine.limits, {}};
  for (int i = 0; i < M::axis_count; ++i) {
    const auto& axis = machine.axes[static_cast<std::size_t>(i)];
    if (has_limits(axis))
      result.axes.push_back({i, {least_velocity(axis), least_acceleration(axis), axis.jerk}});
  }
  return result;
}

/// One thing that is limited, an axis or the tool, and the bounds of its path. An axis has nothing across.
template <std::floating_point S>
struct Limited {
  BasicToolBounds<S> bounds;
  BasicLimits<S> limits;

  [[nodiscard]] bool bends() const {
    return bounds.second_along > S(0) || bounds.second_across > S(0) || bounds.third_along > S(0) ||
           bounds.third_across > S(0);
  }
};

/// The tool, and the axes that have a limit.
template <std::floating_point S, int N>
[[nodiscard]] FixedList<Limited<S>, static_cast<std::size_t>(N) + 1> limited(
    const BasicMachineLimits<S, N>& machine, const BasicPathBounds<S, N>& bounds, S tool_speed) {
  FixedList<Limited<S>, static_cast<std::size_t>(N) + 1> rows;
  rows.push_back({bounds.tool, {tool_speed, machine.tool.acceleration, machine.tool.jerk}});
  for (const auto& [i, limits] : machine.axes)
    rows.push_back({{bounds.first[i], bounds.second[i], S(0), bounds.third[i], S(0)}, limits});
  return rows;
}

/// The highest speed at which the bends take these shares of the limits of acceleration and jerk.
template <std::floating_point S>
[[nodiscard]] S speed_of(const Limited<S>& row, S speed, S acceleration_share, S jerk_share) {
  const auto& [b, limits] = row;
  if (b.first > S(0)) speed = std::min(speed, limits.velocity / b.first);
  if (!row.bends()) return speed;
  const S second = std::hypot(b.second_along, b.second_across);
  if (second > S(0)) speed = std::min(speed, std::sqrt(acceleration_share * limits.acceleration / second));
  const S third = b.third_along + b.third_across;
  if (third > S(0)) speed = std::min(speed, std::cbrt(jerk_share * limits.jerk / third));
  return speed;
}

/// What a vector of length `limit` has left beside so much across; 0 where that is all there is. (No number
/// would pass unseen through a minimum.)
template <std::floating_point S>
[[nodiscard]] S left_beside(S across, S limit) {
  return std::sqrt(std::max((limit - across) * (limit + across), S(0)));
}

/// The acceleration along the path that a speed leaves, 0 or below where it leaves none. By the acceleration
/// limit A, (f a + p v^2)^2 + (q v^2)^2 <= A^2. By the jerk limit J, where the path bends: a ramp at jerk j
/// up to speed v peaks at no more than sqrt(j v), so no more acceleration than that is of use; with j = a^2 /
/// v, (f a^2/v + 3 p v a + t v^3)^2 + (3 q v a + w v^3)^2 <= J^2, whose left side is convex and grows with a:
/// Newton's method from above. What it leaves above the root only lowers the jerk that is chosen from it; so
/// does a square that is too large or too small for a number, of a jerk beyond 1e19 or below 1e-19 as a
/// float.
template <std::floating_point S>
[[nodiscard]] S acceleration_of(const Limited<S>& row, S v) {
  const auto& [b, limits] = row;
  if (!row.bends())
    return b.first > S(0) ? limits.acceleration / b.first : std::numeric_limits<S>::infinity();
  const S v2 = v * v, v3 = v2 * v;
  S a = std::numeric_limits<S>::infinity();
  if (b.first > S(0) && std::isfinite(limits.acceleration)) {
    const S across = b.second_across * v2;
    a = (left_beside(across, limits.acceleration) - b.second_along * v2) / b.first;
  }
  if (!std::isfinite(limits.jerk) || !(v > S(0))) return a;
  const S along_slope = S(3) * b.second_along * v, across_slope = S(3) * b.second_across * v;
  const S along_rest = b.third_along * v3, across_rest = b.third_across * v3;
  const S left = std::max(left_beside(across_rest, limits.jerk) - along_rest, S(0));
  if (!(b.first > S(0))) {
    const S slope = along_slope + across_slope;
    return slope > S(0) ? std::min(a, left / slope) : a;
  }
  constexpr int rounds = 6;
  constexpr S last = S(1) + S(1e-5);  // one more step leaves its square
  const S square = b.first / v;
  S root = std::sqrt(left / square);
  for (int round = 0; round < rounds; ++round) {
    const S along = (square * root + along_slope) * root + along_rest;
    const S across = across_slope * root + across_rest;
    const S jerk = std::sqrt(along * along + across * across);
    const S slope = along * (S(2) * square * root + along_slope) + across * across_slope;
    if (!(jerk > limits.jerk) || !(slope > S(0))) break;
    root = std::max(root - (jerk - limits.jerk) * jerk / slope, S(0));
    if (jerk < last * limits.jerk) break;
  }
  return std::min(a, root);
}

/// The jerk along the path that a speed and an acceleration leave.
template <std::floating_point S>
[[nodiscard]] S jerk_of(const Limited<S>& row, S v, S a) {
  const auto& [b, limits] = row;
  if (!(b.first > S(0)) || !std::isfinite(limits.jerk)) return std::numeric_limits<S>::infinity();
  if (!row.bends()) return limits.jerk / b.first;
  const S along = S(3) * b.second_along * v * a + b.third_along * v * v * v;
  const S across = S(3) * b.second_across * v * a + b.third_across * v * v * v;
  return (left_beside(across, limits.jerk) - along) / b.first;
}

/// Seconds over a length from rest to rest, each ramp counted `ramps` times; its peak is lower than the
/// velocity where the length is too short for so many. Infinite where nothing is left to change speed with.
template <std::floating_point S>
[[nodiscard]] S time_with_ramps(const BasicLimits<S>& limits, S length, S ramps) {
  const auto& [v, a, j] = limits;
  if (!(v > S(0) && a > S(0) && j > S(0))) return std::numeric_limits<S>::infinity();
  const S share = length / ramps;
  const S by_jerk = std::cbrt(share * share * j / S(4));  // share = 2 v sqrt(v / j)
  const S rise = a / j;
  const S by_acceleration = (std::sqrt(rise * rise + S(4) * share / a) - rise) * a / S(2);
  const S top = std::min(v, by_jerk > a * rise ? by_acceleration : by_jerk);
  const S ramp = top > a * rise ? top / a + rise : S(2) * std::sqrt(top / j);
  return length / top + ramps * ramp;
}

/// Whether no derivative but the first is there.
template <std::floating_point S, int N>
[[nodiscard]] bool straight(const BasicPathBounds<S, N>& bounds) {
  const auto& t = bounds.tool;
  return t.second_along == S(0) && t.second_across == S(0) && t.third_along == S(0) &&
         t.third_across == S(0) && (bounds.second.array() == S(0)).all() &&
         (bounds.third.array() == S(0)).all();
}

// What bends take of the limits at the speed from which a better one is looked for; found by trying, on
// programs of arcs, of short lines and of both. A lower share makes bends slower and ramps shorter.
template <std::floating_point S>
inline constexpr S share_of_acceleration = S(0.8);
template <std::floating_point S>
inline constexpr S share_of_jerk = S(0.5);
template <std::floating_point S>
inline constexpr S share_of_jerk_on_short_blocks = S(0.3);
// A block is short up to this share of the room for a ramp.
template <std::floating_point S>
inline constexpr S short_block = S(0.4);

/// Limits along any other.
template <std::floating_point S, int N>
[[nodiscard]] BasicLimits<S> limits_on_bends(const BasicPathBounds<S, N>& bounds,
                                             const BasicMachineLimits<S, N>& machine, S speed, S tool_speed,
                                             S length) {
  using Row = Limited<S>;
  const auto rows = limited(machine, bounds, tool_speed);
  const auto fastest = [&](S acceleration_share, S jerk_share) {
    S v = speed;
    for (const Row& row : rows) v = speed_of(row, v, acceleration_share, jerk_share);
    return v;
  };
  const auto acceleration_at = [&](S v) {
    S a = std::numeric_limits<S>::infinity();
    for (const Row& row : rows) a = std::min(a, acceleration_of(row, v));
    return a;
  };
  const auto at = [&](S v, S a) {
    BasicLimits<S> limits{v, a, std::numeric_limits<S>::infinity()};
    for (const Row& row : rows) limits.jerk = std::min(limits.jerk, jerk_of(row, v, a));
    return limits;
  };
  const S least = fastest(share_of_acceleration<S>, share_of_jerk<S>);
  BasicLimits<S> best = at(least, acceleration_at(least));
  const bool bends = std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.bends(); });
  if (!bends || !std::isfinite(length) || !std::isfinite(best.jerk)) return best;
  const S rise = (fastest(S(1), S(1)) - least) / S(4);
  const int speeds = rise > S(1e-3) * least ? 4 : 0;  // that are higher
  // Ramps go on over the blocks next to a short one, and a lower speed on it leaves them more.
  const S room = room_for_ramp(best);
  const bool is_short = length < short_block<S> * room;
  const S low = is_short ? fastest(share_of_acceleration<S>, share_of_jerk_on_short_blocks<S>) : least;
  const int first = low < (S(1) - S(1e-3)) * least ? -1 : 0;
  length = std::max(length, S(2) * room);
  const S alone = time_with_ramps(best, length, S(1));
  S shortest = time_with_ramps(best, length, S(2));
  for (int i = first; i <= speeds; ++i) {
    const S v = i < 0 ? low : least + static_cast<S>(i) * rise;
    const S most = acceleration_at(v);
    for (int part = 0; part < 4; part += i < 0 ? 2 : 1) {  // two of four at the low speed: most of the gain
      const BasicLimits<S> other = at(v, (S(1) - S(0.15) * static_cast<S>(part)) * most);
      const S takes = time_with_ramps(other, length, S(2));
      if (!(takes < shortest && time_with_ramps(other, length, S(1)) <= alone)) continue;
      shortest = takes;
      best = other;
    }
  }
  return best;
}

/// The jerk along a path within which the jerk of what is limited stays, at speeds v and accelerations a with
/// v + a^2 / (2 j) <= V and |a| <= A: with x = v / V, v a is at most V sqrt(j V) x sqrt(2 (1 - x)), which is
/// highest at 2/3. From there on to V, the highest of v a and of v^3 in each of eight parts are taken
/// together.
template <std::floating_point S>
[[nodiscard]] S jerk_with_ramps_inside(const Limited<S>& row, S v, S a) {
  const BasicToolBounds<S>& b = row.bounds;
  const BasicLimits<S>& limits = row.limits;
  if (!std::isfinite(limits.jerk) || !row.bends()) return jerk_of(row, v, a);
  if (!(b.first > S(0))) return S(0);
  struct Part {
    S product, speed;
  };
  constexpr int count = 9;
  std::array<Part, static_cast<std::size_t>(count)> parts;
  for (int i = 0; i < count; ++i) {
    const S from =
        i == 0 ? S(2) / S(3) : S(1) - S((count - i) * (count - i)) / S(3 * (count - 1) * (count - 1));
    const S to =
        i == 0 ? from : S(1) - S((count - i - 1) * (count - i - 1)) / S(3 * (count - 1) * (count - 1));
    parts[static_cast<std::size_t>(i)] = {from * std::sqrt(S(2) * (S(1) - from)), to};
  }
  const auto keeps = [&](S j) {
    const S ramp = std::sqrt(j * v);
    for (const auto& [product, speed] : parts) {
      const S at = speed * v, cube = at * at * at;
      const S turn = S(3) * std::min(product * v * ramp, at * a);
      const S along = b.first * j + b.second_along * turn + b.third_along * cube;
      const S across = b.second_across * turn + b.third_across * cube;
      if (along * along + across * across > limits.jerk * limits.jerk) return false;
    }
    return true;
  };
  S low = S(0), high = limits.jerk / b.first;
  constexpr int halvings = 14;
  for (int i = 0; i < halvings; ++i) {
    const S middle = low + (high - low) / S(2);
    (keeps(middle) ? low : high) = middle;
  }
  return low;
}

/// Limits along a bend, of such a length, that hold for ramps which begin and end within it (`ramps_inside`
/// of `BasicSegmentLimits`); nothing where it has no room for them, or is faster with `others`.
template <std::floating_point S, int N>
[[nodiscard]] std::optional<BasicLimits<S>> limits_with_ramps_inside(const BasicPathBounds<S, N>& bounds,
                                                                     const BasicMachineLimits<S, N>& machine,
                                                                     S speed, S tool_speed, S length,
                                                                     const BasicLimits<S>& others) {
  if (straight(bounds) || !std::isfinite(others.jerk)) return {};
  const auto rows = limited(machine, bounds, tool_speed);
  constexpr S worth_it = S(0.98);
  S shortest = worth_it * time_with_ramps(others, length, S(1));
  std::optional<BasicLimits<S>> best;
  for (const S share : {S(0.35), S(0.5), S(0.65), S(0.8)}) {
    BasicLimits<S> limits{speed, std::numeric_limits<S>::infinity(), std::numeric_limits<S>::infinity()};
    for (const auto& row : rows)
      limits.velocity = speed_of(row, limits.velocity, share_of_acceleration<S>, share);
    for (const auto& row : rows) {
      const S across = row.bounds.second_across * limits.velocity * limits.velocity;
      const S along = row.bounds.second_along * limits.velocity * limits.velocity;
      if (row.bounds.first > S(0) && std::isfinite(row.limits.acceleration))
        limits.acceleration = std::min(
            limits.acceleration, (left_beside(across, row.limits.acceleration) - along) / row.bounds.first);
    }
    for (const auto& row : rows)
      limits.jerk = std::min(limits.jerk, jerk_with_ramps_inside(row, limits.velocity, limits.acceleration));
    const S takes = time_with_ramps(limits, length, S(1));
    if (!(takes < shortest) || !(length > S(2.5) * room_for_ramp(limits))) continue;
    shortest = takes;
    best = limits;
  }
  return best;
}

/// Limits along a straight path: the least of all, each by the rate of what it limits.
template <std::floating_point S, int N>
[[nodiscard]] inline BasicLimits<S> limits_straight(const BasicPathBounds<S, N>& bounds,
                                                    const BasicMachineLimits<S, N>& machine, S speed,
                                                    S tool_speed) {
  S velocity = speed, acceleration = std::numeric_limits<S>::infinity(), jerk = acceleration;
  const auto lower = [&](S rate, S most, const BasicLimits<S>& own) {
    if (!(rate > S(0))) return;
    velocity = std::min(velocity, most / rate);
    acceleration = std::min(acceleration, own.acceleration / rate);
    jerk = std::min(jerk, own.jerk / rate);
  };
  lower(bounds.tool.first, tool_speed, machine.tool);
  for (const auto& [i, own] : machine.axes) lower(bounds.first[i], own.velocity, own);
  return {velocity, acceleration, jerk};
}

/// Limits along the path, no faster than `speed`, such that for every speed, acceleration and jerk within
/// them the tool's vectors and each axis stay within the machine's limits (`tool_speed` stands for the
/// velocity of the tool): |q'| v, |q''| v^2 + |q'| a and |q'''| v^3 + 3 |q''| v a + |q'| j grow with v, a and
/// j, so it is enough that they hold for the limits themselves (core/path_point.hpp has the formula).
///
/// A higher speed on a bend leaves less to change speed with. The bends may take 0.8 of the acceleration and
/// half of the jerk; over a known `length` another speed, or a lower acceleration with a higher jerk, is
/// taken where that saves time.
template <std::floating_point S, int N>
[[nodiscard]] BasicLimits<S> limits_along(
    const BasicPathBounds<S, N>& bounds, const BasicMachineLimits<S, N>& machine,
    std::type_identity_t<S> speed, std::type_identity_t<S> tool_speed,
    std::type_identity_t<S> length = std::numeric_limits<S>::infinity()) {
  return straight(bounds) ? limits_straight(bounds, machine, speed, tool_speed)
                          : limits_on_bends(bounds, machine, speed, tool_speed, length);
}
template <MachineModel M>
[[nodiscard]] BasicLimits<typename M::Scalar> limits_along(
    const BasicPathBounds<typename M::Scalar, M::axis_count>& bounds, const M& machine,
    typename M::Scalar speed, typename M::Scalar tool_speed,
    typename M::Scalar length = std::numeric_limits<typename M::Scalar>::infinity()) {
  return limits_along(bounds, machine_limits(machine), speed, tool_speed, length);
}

}  // namespace cncplan::detail
