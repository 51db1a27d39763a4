// Curves and machines' maps of a user's, for tests: as a program of one's own would have them.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "cncplan/core/jet.hpp"
#include "cncplan/core/vector.hpp"
#include "support/scara.hpp"

namespace cncplan::test {

/// Half an ellipse with half axes 20 and 8 mm, from (20, 0, 0) to (60, 0, 0).
struct Ellipse {
  using Scalar = double;
  using Vector = Vector3;
  double end = std::numbers::pi;
  [[nodiscard]] double parameter_end() const { return end; }
  template <class T>
  [[nodiscard]] std::array<T, 3> point(const T& u) const {
    using std::cos, std::sin;
    return {T(40) - T(20) * cos(u), T(8) * sin(u), T(0)};
  }
};

/// A curve in space whose speed by its parameter changes.
struct SpaceCurve {
  using Scalar = double;
  using Vector = Vector3;
  [[nodiscard]] static double parameter_end() { return 2.5; }
  template <class T>
  [[nodiscard]] std::array<T, 3> point(const T& u) const {
    using std::cos, std::exp, std::sin;
    return {T(30) * sin(u), T(12) * cos(u * T(2)) + u * u, T(5) * exp(u / T(2))};
  }
};

/// Radius (mm) and angle (rad) of a turning table; what counts is the way on the table.
struct OnTable {
  using Scalar = double;
  using Vector = VectorN<double, 2>;
  [[nodiscard]] static double parameter_end() { return 2.0; }
  template <class T>
  [[nodiscard]] std::array<T, 2> point(const T& u) const {
    using std::sin;
    return {T(20) + T(4) * sin(u), u + u * u / T(8)};
  }
  template <class T>
  [[nodiscard]] std::array<T, 3> travelled(const T& u) const {
    using std::cos, std::sin;
    const auto at = point(u);
    return {at[0] * cos(at[1]), at[0] * sin(at[1]), T(0)};
  }
};

/// Comes to a point and goes back on another branch: it has no tangent there.
struct Cusp {
  using Scalar = double;
  using Vector = VectorN<double, 2>;
  [[nodiscard]] static double parameter_end() { return 2.0; }
  template <class T>
  [[nodiscard]] std::array<T, 2> point(const T& u) const {
    const T x = u - T(0.99);
    return {x * x, x * x * x};
  }
};

struct Standing {
  using Scalar = double;
  using Vector = VectorN<double, 2>;
  [[nodiscard]] static double parameter_end() { return 1.0; }
  template <class T>
  [[nodiscard]] std::array<T, 2> point(const T&) const {
    return {T(1), T(2)};
  }
};

/// A table that turns under a slide: radius (mm), angle (rad), height (mm).
struct TurningTable {
  using Scalar = double;
  static constexpr int axis_count = 3;

  template <class T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    using std::atan2, std::hypot;
    const auto& [x, y, z] = point;
    return {hypot(x, y), atan2(y, x), z};
  }
  [[nodiscard]] static Vector3 tool(const Vector3& joints) {
    return {joints[0] * std::cos(joints[1]), joints[0] * std::sin(joints[1]), joints[2]};
  }
};

}  // namespace cncplan::test
