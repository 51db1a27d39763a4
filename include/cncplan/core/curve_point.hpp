// A curve at one parameter: where it is and how it goes on.
#pragma once

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// What `at(u)` of a path gives in one evaluation; otherwise position(u), derivative(u),
/// second_derivative(u).
template <class Vector>
struct CurvePoint {
  Vector position;  ///< mm
  Vector first;     ///< derivative by the parameter
  Vector second;    ///< second derivative by the parameter
};

/// Position and derivatives of a `ParametricPath` at u: in one evaluation where the path offers it.
template <class P>
[[nodiscard]] CurvePoint<typename P::Vector> curve_point(const P& path, typename P::Scalar u) {
  if constexpr (requires { path.at(u); }) {
    return path.at(u);
  } else {
    return {path.position(u), path.derivative(u), path.second_derivative(u)};
  }
}

}  // namespace cncplan
