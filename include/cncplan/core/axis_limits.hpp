// What one axis may do: limits that may differ between the directions.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <string_view>

#include "cncplan/core/error.hpp"

namespace cncplan {

/// Largest magnitudes, upwards and downwards: of the velocity, and of the acceleration (downwards: of a
/// velocity that falls). Infinite where not given.
template <std::floating_point S>
struct BasicAxisLimits {
  static constexpr S infinity = std::numeric_limits<S>::infinity();

  S velocity_up = infinity;
  S velocity_down = infinity;
  S acceleration_up = infinity;
  S acceleration_down = infinity;
  S jerk = infinity;
  S low = -infinity;  ///< lowest position
  S high = infinity;  ///< highest position

  friend constexpr bool operator==(const BasicAxisLimits&, const BasicAxisLimits&) = default;
};

using AxisLimits = BasicAxisLimits<double>;

/// Nothing if motion can be planned within them: all positive, the velocities finite, and the jerk or the
/// accelerations too, positions in order. Else the first that is not so.
template <std::floating_point S>
[[nodiscard]] constexpr Expected<void> validate(const BasicAxisLimits<S>& limits) {
  constexpr S infinity = BasicAxisLimits<S>::infinity;
  const auto positive = [](S value) { return value > S(0); };
  const bool jerk_limited = limits.jerk < infinity;
  if (positive(limits.velocity_up) && positive(limits.velocity_down) && positive(limits.acceleration_up) &&
      positive(limits.acceleration_down) && positive(limits.jerk) && limits.velocity_up < infinity &&
      limits.velocity_down < infinity && limits.low <= limits.high &&
      (jerk_limited || (limits.acceleration_up < infinity && limits.acceleration_down < infinity)))
    return {};
  const auto check = [](S value, bool finite, std::string_view field) -> Expected<void> {
    if (std::isnan(value) || (finite && value == BasicAxisLimits<S>::infinity))
      return refusal(ErrorCode::not_finite, field, value);
    if (!(value > S(0))) return refusal(ErrorCode::not_positive, field, value);
    return {};
  };
  for (const S value : {limits.velocity_up, limits.velocity_down})
    if (const auto ok = check(value, true, "velocity limit"); !ok) return ok;
  if (const auto ok = check(limits.jerk, false, "jerk limit"); !ok) return ok;
  for (const S value : {limits.acceleration_up, limits.acceleration_down})
    if (const auto ok = check(value, !jerk_limited, "acceleration limit"); !ok) return ok;
  return refusal(ErrorCode::below_limit, "high end of travel", limits.high, limits.low);
}

}  // namespace cncplan
