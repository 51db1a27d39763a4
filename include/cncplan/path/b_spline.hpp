// Uniform B-splines of any degree by their basis matrix (K17 Eqs. 3.40-3.47).
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/path/detail/quadrature.hpp"

namespace cncplan::path {

/// The basis matrix of degree n, times n!: rows are falling powers of t, columns the control points (K17 Eq.
/// 3.46),
///   n! m_ij = C(n,i) sum_{k=j..n} (n-k)^i (-1)^(k-j) C(n+1, k-j),   0^0 = 1.
/// Whole numbers, exact up to degree 12.
template <int Degree>
  requires(Degree >= 1 && Degree <= 12)
[[nodiscard]] constexpr auto b_spline_matrix() {
  constexpr auto binomial = [](std::int64_t n, std::int64_t k) {
    std::int64_t result = 1;
    for (std::int64_t i = 1; i <= k; ++i) result = result * (n - k + i) / i;
    return result;
  };
  constexpr auto power = [](std::int64_t base, std::int64_t exponent) {
    std::int64_t result = 1;
    for (; exponent > 0; --exponent) result *= base;
    return result;
  };
  constexpr auto size = static_cast<std::size_t>(Degree + 1);
  std::array<std::array<std::int64_t, size>, size> matrix{};
  for (int i = 0; i <= Degree; ++i)
    for (int j = 0; j <= Degree; ++j) {
      std::int64_t sum = 0;
      for (int k = j; k <= Degree; ++k)
        sum += power(Degree - k, i) * ((k - j) % 2 == 0 ? 1 : -1) * binomial(Degree + 1, k - j);
      matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = binomial(Degree, i) * sum;
    }
  return matrix;
}

/// The weights of the Degree + 1 control points of one piece, and their derivatives by t, at t in [0, 1].
template <std::floating_point S, int Degree>
struct BSplineWeights {
  using Weights = std::array<S, static_cast<std::size_t>(Degree + 1)>;

  Weights position{};
  Weights first{};
  Weights second{};

  explicit BSplineWeights(S t) {
    static constexpr auto matrix = b_spline_matrix<Degree>();
    constexpr S scale = [] {
      S product = S(1);
      for (int i = 2; i <= Degree; ++i) product *= static_cast<S>(i);
      return S(1) / product;
    }();
    for (std::size_t j = 0; j <= Degree; ++j) {
      S value = S(0), slope = S(0), half_bend = S(0);  // Horner's scheme for a polynomial and its derivatives
      for (std::size_t i = 0; i <= Degree; ++i) {
        half_bend = half_bend * t + slope;
        slope = slope * t + value;
        value = value * t + static_cast<S>(matrix[i][j]);
      }
      position[j] = scale * value;
      first[j] = scale * slope;
      second[j] = 2 * scale * half_bend;
    }
  }
};

/// Pieces between uniform knots, one for every Degree + 1 consecutive control points; the parameter u in
/// [0, pieces] is the number of the piece plus t. Derivatives are continuous up to the (Degree - 1)-th. It
/// does not go through its control points; its ends are position(0) and position(parameter_end()). The points
/// belong to the caller.
template <std::floating_point S, int Degree>
class BasicBSpline {
 public:
  using Scalar = S;
  using Vector = BasicVector3<S>;

  static constexpr std::size_t fewest_controls = Degree + 1;

  /// The curve, or `below_limit` for less than `fewest_controls`.
  [[nodiscard]] static Expected<BasicBSpline> make(std::span<const Vector> controls) {
    if (controls.size() >= fewest_controls) return BasicBSpline(controls);
    return tl::unexpected(Error{ErrorCode::below_limit, "number of control points",
                                static_cast<double>(controls.size()), static_cast<double>(fewest_controls)});
  }

  /// For controls that are known to be `fewest_controls` or more; `make` asks.
  explicit BasicBSpline(std::span<const Vector> controls) : controls_(controls) {
    constexpr int panels_per_piece = 16;
    for (std::size_t i = 0; i < pieces(); ++i)
      length_ += arc_length(*this, static_cast<S>(i), static_cast<S>(i + 1), panels_per_piece);
  }

  /// A container that ends with the expression cannot lend its points.
  template <std::convertible_to<std::span<const Vector>> Container>
    requires(!std::ranges::enable_borrowed_range<Container>)
  explicit BasicBSpline(const Container&&) = delete;
  template <std::convertible_to<std::span<const Vector>> Container>
    requires(!std::ranges::enable_borrowed_range<Container>)
  static void make(const Container&&) = delete;

  [[nodiscard]] std::span<const Vector> controls() const { return controls_; }
  [[nodiscard]] std::size_t pieces() const { return controls_.size() - Degree; }
  [[nodiscard]] S length() const { return length_; }  ///< mm; by quadrature, see the test for its error
  [[nodiscard]] S parameter_end() const { return static_cast<S>(pieces()); }

  /// Outside [0, parameter_end()] the nearer end.
  [[nodiscard]] Vector position(S u) const { return at(u).position; }
  [[nodiscard]] Vector derivative(S u) const { return at(u).first; }
  [[nodiscard]] Vector second_derivative(S u) const { return at(u).second; }

  /// Position and both derivatives for one evaluation.
  [[nodiscard]] CurvePoint<Vector> at(S u) const {
    u = std::clamp(u, S(0), parameter_end());
    const std::size_t piece = std::min(static_cast<std::size_t>(u), pieces() - 1);
    const BSplineWeights<S, Degree> weights(u - static_cast<S>(piece));
    CurvePoint<Vector> point{Vector::Zero(), Vector::Zero(), Vector::Zero()};
    for (std::size_t j = 0; j <= Degree; ++j) {
      const Vector& control = controls_[piece + j];
      point.position += weights.position[j] * control;
      point.first += weights.first[j] * control;
      point.second += weights.second[j] * control;
    }
    return point;
  }

 private:
  std::span<const Vector> controls_;
  S length_{};
};

template <int Degree>
using BSpline = BasicBSpline<double, Degree>;

}  // namespace cncplan::path
