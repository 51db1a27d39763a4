// Limits below those of a machine.
#pragma once

#include <cmath>
#include <concepts>

#include "cncplan/machine.hpp"

namespace cncplan {

namespace detail {

/// Nothing, or the first that is out of its domain: a reserve in [0, 1), a hold factor of 0 or above 1.
template <std::floating_point S>
[[nodiscard]] Expected<void> valid_reserve(S reserve, S hold_factor) {
  if (!(reserve >= S(0) && reserve < S(1)))
    return refusal(std::isnan(reserve) ? ErrorCode::not_finite
                   : reserve < S(0)    ? ErrorCode::negative
                                       : ErrorCode::above_limit,
                   "reserve", reserve, reserve < S(0) ? S(0) : S(1));
  if (!std::isfinite(hold_factor)) return refusal(ErrorCode::not_finite, "hold factor", hold_factor);
  if (hold_factor != S(0) && !(hold_factor > S(1)))
    return refusal(ErrorCode::below_limit, "hold factor", hold_factor, S(1));
  return {};
}

}  // namespace detail

/// The machine with so much less acceleration and jerk, of its tool and of each axis: a share in [0, 1). What
/// is planned for it leaves the clock of an executor of the machine itself something to hold with.
template <MachineModel M>
[[nodiscard]] constexpr M with_reserve(M machine, typename M::Scalar share) {
  const auto lower = [&](auto& limits) {
    limits.acceleration *= 1 - share;
    limits.jerk *= 1 - share;
  };
  lower(machine.limits);
  for (auto& axis : machine.axes) {
    lower(axis);
    axis.acceleration_down *= 1 - share;
  }
  return machine;
}

}  // namespace cncplan
