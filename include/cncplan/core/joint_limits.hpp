// Limits of a machine's own axes.
#pragma once

#include <limits>
#include <string_view>

#include "cncplan/core/error.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan {

/// What each joint may do; mm for linear joints, rad for rotary ones. Infinite where there is no limit.
template <std::floating_point S, int N>
struct BasicJointLimits {
  using Vector = VectorN<S, N>;

  static Vector none() { return Vector::Constant(std::numeric_limits<S>::infinity()); }

  Vector velocity = none();      ///< per s, > 0
  Vector acceleration = none();  ///< per s^2, > 0
  Vector jerk = none();          ///< per s^3, > 0
  Vector low = -none();          ///< lowest position
  Vector high = none();          ///< highest position

  friend bool operator==(const BasicJointLimits&, const BasicJointLimits&) = default;
};

/// The joints themselves if each lies within its travel, else an error with the name of the first that does
/// not.
template <std::floating_point S, int N>
[[nodiscard]] Expected<VectorN<S, N>> within_travel(const VectorN<S, N>& joints,
                                                    const BasicJointLimits<S, N>& limits,
                                                    const std::string_view (&names)[N]) {
  for (int i = 0; i < N; ++i) {
    if (joints[i] >= limits.low[i] && joints[i] <= limits.high[i]) continue;
    const bool below = joints[i] < limits.low[i];
    const ErrorCode code = below ? ErrorCode::below_limit : ErrorCode::above_limit;
    return refusal(code, names[i], joints[i], below ? limits.low[i] : limits.high[i]);
  }
  return joints;
}

}  // namespace cncplan
