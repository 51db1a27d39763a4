// Rational cubic Bezier curves: what the splines and NURBS of a program are made of, piece by piece.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

#include "cncplan/core/compiler.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/interval.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/path/measured.hpp"

namespace cncplan::path {

namespace detail {

/// 3 c1 u (1-u)^2 + 3 c2 u^2 (1-u) + c3 u^3, whose control at u = 0 is 0.
template <std::floating_point S>
class Cubic {
 public:
  Cubic(S c1, S c2, S c3) : a1_(3 * c1), a2_(3 * c2 - 6 * c1), a3_(c3 - 3 * c2 + 3 * c1) {}

  /// At a number, an interval, or a jet of either. On an interval: Taylor's polynomial about its middle,
  /// which is exact for a cubic, so that the excess is small.
  template <class T>
  [[nodiscard]] T at(const T& u) const {
    if constexpr (requires { u.third; }) {
      return u.through(at(u.value), first(u.value), second(u.value), third());
    } else if constexpr (requires { u.low; }) {
      const auto [middle, off] = around(u);
      return T(at(middle)) + T(first(middle)) * off + T(second(middle) / S(2)) * square(off) +
             T(a3_) * off * square(off);
    } else {
      return ((a3_ * u + a2_) * u + a1_) * u;
    }
  }

 private:
  template <class T>
  [[nodiscard]] T first(const T& u) const {
    if constexpr (requires { u.low; }) {
      const auto [middle, off] = around(u);
      return T(first(middle)) + T(second(middle)) * off + T(third() / S(2)) * square(off);
    } else {
      return (3 * a3_ * u + 2 * a2_) * u + a1_;
    }
  }
  template <class T>
  [[nodiscard]] T second(const T& u) const {
    return T(third()) * u + T(2 * a2_);
  }
  [[nodiscard]] S third() const { return 6 * a3_; }

  struct Around {
    S middle;
    BasicInterval<S> off;
  };
  static Around around(const BasicInterval<S>& u) {
    const S middle = (u.low + u.high) / S(2);
    return {middle, {u.low - middle, u.high - middle}};
  }

  S a1_, a2_, a3_;
};

}  // namespace detail

/// The sum of w_i B_i(u) P_i over the sum of w_i B_i(u), B_i the cubic Bernstein polynomials, u in [0, 1]
/// (Piegl and Tiller, The NURBS Book, Eq. 1.14). The weights at the ends are 1, which any positive weights
/// become by another parameter. See `Curve`.
template <std::floating_point S, int N>
class BasicRationalCubic {
 public:
  using Scalar = S;
  using Vector = VectorN<S, N>;
  using Controls = std::array<Vector, 4>;
  static constexpr int enclosed_parts =
      12;  ///< of an interval, to bound it: a quarter of a piece within a tenth

  /// Of the two inner controls the weights are > 0.
  explicit BasicRationalCubic(const Controls& controls, S second_weight = S(1), S third_weight = S(1))
      : controls_(controls), weights_{second_weight, third_weight} {
    if constexpr (N > 3)
      tool_rests_ = std::all_of(controls.begin() + 1, controls.end(), [&](const Vector& control) {
        return control.template head<3>() == controls[0].template head<3>();
      });
  }

  [[nodiscard]] const Controls& controls() const { return controls_; }
  [[nodiscard]] const std::array<S, 2>& weights() const { return weights_; }
  [[nodiscard]] S parameter_end() const { return S(1); }

  /// Both ends bit for bit the first and the last control.
  template <class T>
  [[nodiscard]] std::array<T, static_cast<std::size_t>(N)> point(const T& u) const {
    std::array<T, static_cast<std::size_t>(N)> result;
    const auto& [start, second, third, end] = controls_;
    const auto [w1, w2] = weights_;
    const bool rational = w1 != S(1) || w2 != S(1);
    const T divisor = rational ? T(S(1)) / (T(S(1)) + detail::Cubic<S>(w1 - 1, w2 - 1, S(0)).at(u)) : T(S(1));
    for (int i = 0; i < N; ++i) {
      const T above =
          detail::Cubic<S>(w1 * (second[i] - start[i]), w2 * (third[i] - start[i]), end[i] - start[i]).at(u);
      result[static_cast<std::size_t>(i)] = T(start[i]) + (rational ? above * divisor : above);
    }
    if constexpr (std::same_as<T, S>)
      if (u == S(1)) std::copy_n(end.data(), N, result.begin());
    return result;
  }

  /// Whether X Y Z stay where they are.
  [[nodiscard]] bool tool_rests() const { return tool_rests_; }
  /// The way that counts as length: that of X Y Z, and where they rest that of the other coordinates.
  template <class T>
  [[nodiscard]] auto travelled(const T& u) const requires(N > 3) {
    constexpr std::size_t others = static_cast<std::size_t>(N) - 3;
    std::array<T, std::max<std::size_t>(3, others)> result{};
    const auto at = point(u);
    if (tool_rests_)
      std::copy_n(at.begin() + 3, others, result.begin());
    else
      std::copy_n(at.begin(), 3, result.begin());
    return result;
  }

  friend bool operator==(const BasicRationalCubic&, const BasicRationalCubic&) = default;

 private:
  Controls controls_;
  std::array<S, 2> weights_;
  bool tool_rests_{};
};

template <int N>
using RationalCubic = BasicRationalCubic<double, N>;

/// One piece of a spline as a path by its length, small enough to be part of every block.
template <std::floating_point S, int N>
using BasicSpline = Measured<BasicRationalCubic<S, N>, 8>;

template <int N>
using Spline = BasicSpline<double, N>;

/// Whether the controls lie on their chord, in order: the curve is a straight line then.
template <std::floating_point S, int N>
[[nodiscard]] bool is_straight(const BasicRationalCubic<S, N>& curve) {
  const auto& [start, second, third, end] = curve.controls();
  const VectorN<S, N> chord = end - start;
  const S length_sq = chord.squaredNorm();
  const S rounding = S(64) * std::numeric_limits<S>::epsilon();
  const auto off = [&, from = start](const VectorN<S, N>& point) {
    const VectorN<S, N> way = point - from;
    return (way - chord * (way.dot(chord) / length_sq)).norm();
  };
  const S within = rounding * (std::sqrt(length_sq) + start.norm());
  const S one = (second - start).dot(chord), two = (third - start).dot(chord);
  const S slack = within * std::sqrt(length_sq);
  return length_sq > S(0) && off(second) <= within && off(third) <= within && one >= -slack &&
         one <= two + slack && two <= length_sq + slack;
}

/// The curve as a path. Errors: those of `measured`; not_positive, with the length of a first or last leg of
/// the controls that has none: the curve has no tangent there by its parameter.
template <std::floating_point S, int N>
[[nodiscard]] Expected<BasicSpline<S, N>> spline(const BasicRationalCubic<S, N>& curve) {
  const auto& [start, second, third, end] = curve.controls();
  const S least = S(16) * std::numeric_limits<S>::epsilon() * (start.norm() + end.norm());
  for (const S leg : {(second - start).norm(), (end - third).norm()})
    if (!(leg > least)) return refusal(ErrorCode::not_positive, "first or last leg of a spline", leg, least);
  return measured<8>(curve);
}

}  // namespace cncplan::path
