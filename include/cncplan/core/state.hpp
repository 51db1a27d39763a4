// The state of motion along a path at one instant.
#pragma once

#include "cncplan/core/compiler.hpp"

#include <concepts>

namespace cncplan {

/// Path length and its time derivatives.
template <std::floating_point S>
struct BasicState {
  S position{};      ///< mm along the path
  S velocity{};      ///< mm/s
  S acceleration{};  ///< mm/s^2
  S jerk{};          ///< mm/s^3; at the edge of two phases, the value just after it

  friend bool operator==(const BasicState&, const BasicState&) = default;
};

using State = BasicState<double>;

/// A motion whose own time is what a clock shows: `of` is its state where that is clock.position. The other
/// parts of the clock are its rate (1: real time) and how that changes, 1/s and 1/s^2.
template <std::floating_point S>
[[nodiscard]] constexpr BasicState<S> by_clock(const BasicState<S>& of, const BasicState<S>& clock) {
  const auto [position, v, a, j] = of;
  const auto [time, rate, change, second] = clock;
  return {position, v * rate, a * (rate * rate) + v * change,
          j * (rate * rate * rate) + S(3) * a * rate * change + v * second};
}

}  // namespace cncplan
