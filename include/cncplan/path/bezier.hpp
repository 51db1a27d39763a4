// Bezier curves of any degree (K17 Eqs. 3.34-3.39).
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>

#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/path/detail/quadrature.hpp"

namespace cncplan::path {

/// P(u) = sum_i C(N,i) (1-u)^(N-i) u^i P_i for u in [0, 1], evaluated by repeated linear interpolation (de
/// Casteljau), which passes the points that give both derivatives on its way.
template <std::floating_point S, int Degree>
  requires(Degree >= 2)
class BasicBezier {
 public:
  using Scalar = S;
  using Vector = BasicVector3<S>;
  using Controls = std::array<Vector, static_cast<std::size_t>(Degree + 1)>;

  explicit BasicBezier(const Controls& controls) : controls_(controls) {
    constexpr int panels = 64;
    length_ = arc_length(*this, S(0), S(1), panels);
  }

  [[nodiscard]] const Controls& controls() const { return controls_; }
  [[nodiscard]] S length() const { return length_; }  ///< mm; by quadrature, see the test for its error
  [[nodiscard]] S parameter_end() const { return S(1); }

  /// Both ends bit for bit the first and the last control point; outside [0, 1] the nearer end.
  [[nodiscard]] Vector position(S u) const { return at(u).position; }
  [[nodiscard]] Vector derivative(S u) const { return at(u).first; }
  [[nodiscard]] Vector second_derivative(S u) const { return at(u).second; }

  /// Position and both derivatives for one evaluation.
  [[nodiscard]] CurvePoint<Vector> at(S u) const {
    u = std::clamp(u, S(0), S(1));
    const S v = S(1) - u;
    Controls p = controls_;
    for (std::size_t left = p.size() - 1; left > 2; --left)
      for (std::size_t i = 0; i < left; ++i) p[i] = v * p[i] + u * p[i + 1];
    const Vector before = v * p[0] + u * p[1];
    const Vector behind = v * p[1] + u * p[2];
    return {v * before + u * behind, S(Degree) * (behind - before),
            S(Degree * (Degree - 1)) * (p[0] - 2 * p[1] + p[2])};
  }

  friend bool operator==(const BasicBezier& a, const BasicBezier& b) { return a.controls_ == b.controls_; }

 private:
  Controls controls_;
  S length_{};
};

template <int Degree>
using Bezier = BasicBezier<double, Degree>;

}  // namespace cncplan::path
