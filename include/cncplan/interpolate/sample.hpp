// One sample of motion: the time, the state along the path and the point in space.
#pragma once

#include <concepts>

#include "cncplan/core/state.hpp"

namespace cncplan::interpolate {

/// Where the motion is at one time, along the path and in space.
template <std::floating_point S, class Vector>
struct BasicSample {
  S time{};             ///< s
  BasicState<S> along;  ///< path length, speed, acceleration, jerk
  Vector position;      ///< mm
  Vector velocity;      ///< mm/s
  Vector acceleration;  ///< mm/s^2

  friend bool operator==(const BasicSample&, const BasicSample&) = default;
};

}  // namespace cncplan::interpolate
