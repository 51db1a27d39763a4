// A step of one of a machine's motors.
#pragma once

#include <concepts>
#include <cstddef>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// One step of one motor. Motors are numbered in the order of the axes.
template <std::floating_point S>
struct BasicMotorEdge {
  S time{};  ///< s
  std::size_t motor{};
  int axis{};
  int direction{};  ///< +1 or -1

  friend bool operator==(const BasicMotorEdge&, const BasicMotorEdge&) = default;
};

using MotorEdge = BasicMotorEdge<double>;

}  // namespace cncplan
