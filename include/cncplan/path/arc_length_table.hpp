// Any curve made a path: the parameter at a travelled length, by a table and a corrector.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/curve_point.hpp"
#include "cncplan/path/detail/quadrature.hpp"

namespace cncplan::path {

/// A curve, by value, with a table of the lengths at `Intervals` + 1 parameters, evenly spaced. Lengths are
/// the quadrature's (`arc_length`, one panel an interval), and `parameter_at` is their inverse to rounding,
/// so that samples keep the planned feed whatever the curve's own parametrisation. On curves whose
/// derivatives jump (B-splines at knots), `Intervals` should be a multiple of their pieces.
template <DifferentiableCurve C, int Intervals = 64>
  requires(Intervals >= 1)
class ArcLengthTable {
 public:
  using Scalar = typename C::Scalar;
  using Vector = typename C::Vector;

  explicit ArcLengthTable(const C& curve) : curve_(curve) {
    for (std::size_t i = 0; i < Intervals; ++i)
      lengths_[i + 1] = lengths_[i] + arc_length(curve_, parameter(i), parameter(i + 1));
  }

  [[nodiscard]] const C& curve() const { return curve_; }
  [[nodiscard]] Scalar length() const { return lengths_.back(); }
  [[nodiscard]] Scalar parameter_end() const { return curve_.parameter_end(); }
  [[nodiscard]] Vector position(Scalar u) const { return curve_.position(u); }
  [[nodiscard]] Vector derivative(Scalar u) const { return curve_.derivative(u); }
  [[nodiscard]] Vector second_derivative(Scalar u) const { return curve_.second_derivative(u); }
  [[nodiscard]] CurvePoint<Vector> at(Scalar u) const {
    if constexpr (requires { curve_.at(u); }) {
      return curve_.at(u);
    } else {
      return {position(u), derivative(u), second_derivative(u)};
    }
  }

  /// Length from the start to u; outside [0, parameter_end()] that of the nearer end.
  [[nodiscard]] Scalar length_at(Scalar u) const {
    if (!(u > Scalar(0))) return Scalar(0);
    if (!(u < parameter_end())) return length();
    const auto i =
        static_cast<std::size_t>(std::min(u / parameter_end() * Scalar(Intervals), Scalar(Intervals - 1)));
    return lengths_[i] + arc_length(curve_, parameter(i), u);
  }

  /// The parameter at which length s has been travelled; outside [0, length()] the nearer end. Newton's
  /// method from the interval's chord, kept within the interval: two or three steps on a smooth curve; where
  /// the curve starts from rest (|r'| = 0) the step is halved until it is near, hence the bound.
  [[nodiscard]] Scalar parameter_at(Scalar s) const {
    if (!(s > Scalar(0))) return Scalar(0);
    if (!(s < length())) return parameter_end();
    const auto above = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, s);
    const auto i = static_cast<std::size_t>(above - lengths_.begin()) - 1;
    const Scalar low = parameter(i);
    const Scalar high = parameter(i + 1);
    constexpr int most_steps = 40;
    const Scalar tolerance = std::numeric_limits<Scalar>::epsilon() * length();
    Scalar u = low + (high - low) * (s - lengths_[i]) / (lengths_[i + 1] - lengths_[i]);
    for (int step = 0; step < most_steps; ++step) {
      const Scalar error = s - (lengths_[i] + arc_length(curve_, low, u));
      const Scalar speed = curve_.derivative(u).norm();
      if (!(speed > Scalar(0))) break;
      u = std::clamp(u + error / speed, low, high);
      if (std::abs(error) <= tolerance) break;
    }
    return u;
  }

 private:
  [[nodiscard]] Scalar parameter(std::size_t i) const {
    return i == Intervals ? curve_.parameter_end()
                          : curve_.parameter_end() * (static_cast<Scalar>(i) / Scalar(Intervals));
  }

  C curve_;
  std::array<Scalar, static_cast<std::size_t>(Intervals + 1)> lengths_{};
};

}  // namespace cncplan::path
