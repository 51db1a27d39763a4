// A curve of one's own for tests: the upper half of an ellipse, from left to right.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "cncplan/core/vector.hpp"

namespace cncplan::test {

struct HalfEllipse {
  using Scalar = double;
  using Vector = Vector3;

  double half_width{}, height{};  // mm

  double parameter_end() const { return std::numbers::pi; }
  template <class T>  // a number, or one that carries derivatives or bounds
  std::array<T, 3> point(const T& u) const {
    using std::cos, std::sin;
    return {T(-half_width) * cos(u), T(height) * sin(u), T(0)};
  }
};

}  // namespace cncplan::test
