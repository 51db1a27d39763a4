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

}  // namespace cncplan
