// A time of constant jerk, wherever it begins.
#pragma once

#include <concepts>

#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// Constant jerk for a time.
template <std::floating_point S>
struct BasicJerkPhase {
  S duration{};
  S acceleration{};  ///< at its start
  S jerk{};

  /// The state `t` seconds after one with which the phase begins; its acceleration is the phase's.
  [[nodiscard]] constexpr BasicAxisState<S> after(const BasicAxisState<S>& s, S t) const {
    return {s.position + t * (s.velocity + t * (acceleration / S(2) + t * (jerk / S(6)))),
            s.velocity + t * (acceleration + t * (jerk / S(2))), acceleration + t * jerk};
  }

  friend constexpr bool operator==(const BasicJerkPhase&, const BasicJerkPhase&) = default;
};

}  // namespace cncplan
