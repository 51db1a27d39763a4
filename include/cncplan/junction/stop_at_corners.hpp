// Exact path (G61): corners at rest, smooth junctions without a limit of its own.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "cncplan/junction/geometry.hpp"

namespace cncplan::junction {

/// The policy that stops where the direction turns by more than an angle and passes where it does not: what
/// G61 means on the path (LinuxCNC: exact path mode). With `minimum`, another policy decides about the smooth
/// junctions. The turn is measured by the difference of the unit tangents, which is 2 sin(turn / 2).
template <std::floating_point S>
struct BasicStopAtCorners {
  S turn = std::numbers::pi_v<S> / S(1800);  ///< rad, in [0, pi]; 0.1 degree

  [[nodiscard]] S speed_sq(const BasicGeometry<S>& junction) const {
    const S step = (junction.after.tangent - junction.before.tangent).norm() / S(2);
    return step > std::sin(turn / S(2)) ? S(0) : std::numeric_limits<S>::infinity();
  }
};

using StopAtCorners = BasicStopAtCorners<double>;

}  // namespace cncplan::junction
