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

}  // namespace cncplan
