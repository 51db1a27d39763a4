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

/// The machine with so many times the acceleration and jerk, of its tool and of each axis.
template <MachineModel M>
[[nodiscard]] constexpr M with_forces(M machine, typename M::Scalar times) {
  machine.limits.acceleration *= times;
  machine.limits.jerk *= times;
  for (auto& axis : machine.axes) {
    axis.acceleration *= times;
    axis.acceleration_down *= times;
    axis.jerk *= times;
  }
  return machine;
}

}  // namespace detail

/// The machine with so much less acceleration and jerk, of its tool and of each axis: a share in [0, 1). What
/// is planned for it leaves the clock of an executor of the machine itself something to hold with.
template <MachineModel M>
[[nodiscard]] constexpr M with_reserve(const M& machine, typename M::Scalar share) {
  return detail::with_forces(machine, 1 - share);
}

}  // namespace cncplan
