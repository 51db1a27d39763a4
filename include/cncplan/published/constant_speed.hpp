// Travel without ramps: what the classical constant-increment interpolation assumes (KK22 Eq. 17).
#pragma once

#include <concepts>
#include <type_traits>

#include "cncplan/profile/profile.hpp"

namespace cncplan::published {

/// `length` mm at `speed` mm/s (> 0) from the first instant to the last: the speed jumps at both ends. Kept
/// for comparison.
template <std::floating_point S>
[[nodiscard]] constexpr profile::BasicProfile<S> constant_speed(S length, std::type_identity_t<S> speed) {
  return profile::BasicProfile<S>({.length = length,
                                   .start_velocity = speed,
                                   .start_acceleration = S(0),
                                   .top_velocity = speed,
                                   .end_velocity = speed,
                                   .cruise = length / speed,
                                   .up = {},
                                   .down = {}});
}

}  // namespace cncplan::published
