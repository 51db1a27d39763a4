// A point that moves along a segment, with its derivatives.
#pragma once

#include <array>
#include <cmath>
#include <concepts>

#include "cncplan/core/jet.hpp"
#include "cncplan/path/segment.hpp"

namespace cncplan::plan {

/// X, Y, Z at parameter u, and their derivatives by it.
template <std::floating_point S>
[[nodiscard]] std::array<BasicJet<S>, 3> moving_point(const path::BasicSegment<S>& segment, S u) {
  const BasicVector3<S> p = segment.position(u);
  const BasicVector3<S> first = segment.derivative(u);
  const BasicVector3<S> second = segment.second_derivative(u);
  BasicVector3<S> third = BasicVector3<S>::Zero();
  if (const path::BasicArc<S>* arc = segment.arc()) {
    const S s = std::sin(u), c = std::cos(u);
    const S growth = arc->growth(), rho = S(1) + growth * u;
    third = (rho * s - S(3) * growth * c) * arc->radial() - (rho * c + S(3) * growth * s) * arc->tangential();
  }
  return {BasicJet<S>(p[0], first[0], second[0], third[0]), BasicJet<S>(p[1], first[1], second[1], third[1]),
          BasicJet<S>(p[2], first[2], second[2], third[2])};
}

template <std::floating_point S>
[[nodiscard]] std::array<S, 3> point_at(const path::BasicSegment<S>& segment, S u) {
  const BasicVector3<S> p = segment.position(u);
  return {p[0], p[1], p[2]};
}

}  // namespace cncplan::plan
