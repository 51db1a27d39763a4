// A stretch of motion along a path with constant jerk: what planned profiles are made of.
#pragma once

#include <concepts>

#include "cncplan/core/monotone_cubic.hpp"
#include "cncplan/core/state.hpp"

namespace cncplan {

/// Constant jerk for `duration`, from the state at its start. Planned motion goes forward: velocity >= 0
/// throughout.
template <std::floating_point S>
struct BasicPhase {
  S time{};          ///< s, when the phase starts
  S duration{};      ///< s, >= 0; zero for a phase that a profile leaves out
  S position{};      ///< mm along the path, at the start
  S velocity{};      ///< mm/s, at the start
  S acceleration{};  ///< mm/s^2, at the start
  S jerk{};          ///< mm/s^3, throughout

  /// State `tau` seconds into the phase, tau in [0, duration].
  [[nodiscard]] constexpr BasicState<S> at(S tau) const {
    return {position + tau * (velocity + tau * (acceleration / S(2) + tau * (jerk / S(6)))),
            velocity + tau * (acceleration + tau * (jerk / S(2))), acceleration + tau * jerk, jerk};
  }

  /// The first `tau` at which a position is reached; 0 and `duration` for positions before and behind the
  /// phase. Exact to rounding; where the speed vanishes, to the time that one unit in the last place of the
  /// position takes.
  [[nodiscard]] S tau_at(S where) const {
    const BasicState<S> last = at(duration);
    if (last.velocity < velocity)
      return duration -
             MonotoneCubic<S>{last.velocity > S(0) ? last.velocity : S(0), -last.acceleration, jerk, duration}
                 .solve(last.position - where);
    return MonotoneCubic<S>{velocity, acceleration, jerk, duration}.solve(where - position);
  }

  friend bool operator==(const BasicPhase&, const BasicPhase&) = default;
};

using Phase = BasicPhase<double>;

}  // namespace cncplan
