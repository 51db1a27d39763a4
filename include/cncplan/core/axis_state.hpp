// Where an axis is and how it moves, and the same of several axes.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// One axis at one instant; mm and s of a linear axis, rad and s of a rotary one.
template <std::floating_point S>
struct BasicAxisState {
  S position{};
  S velocity{};
  S acceleration{};

  friend constexpr bool operator==(const BasicAxisState&, const BasicAxisState&) = default;
};

using AxisState = BasicAxisState<double>;

/// N axes at one instant.
template <std::floating_point S, int N>
struct BasicAxisStates {
  using Row = std::array<S, static_cast<std::size_t>(N)>;

  Row position{};
  Row velocity{};
  Row acceleration{};

  [[nodiscard]] constexpr BasicAxisState<S> axis(std::size_t i) const {
    return {position[i], velocity[i], acceleration[i]};
  }
  constexpr void set(std::size_t i, const BasicAxisState<S>& state) {
    position[i] = state.position, velocity[i] = state.velocity, acceleration[i] = state.acceleration;
  }

  friend constexpr bool operator==(const BasicAxisStates&, const BasicAxisStates&) = default;
};

template <int N>
using AxisStates = BasicAxisStates<double, N>;

}  // namespace cncplan
