// A curve of one's own, by any parameter, as a path by its length.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/path_jets.hpp"
#include "cncplan/path/arc_length_table.hpp"

namespace cncplan::path {

/// A curve of N axes over u in [0, parameter_end()], written once as a template: `point(u)` is asked for with
/// numbers, with jets and with jets of intervals (core/jet.hpp lists the functions they have). `Vector` is
/// the Eigen column of its N axes.
template <class C>
concept Curve = requires(const C& curve, typename C::Scalar u, const BasicJet<typename C::Scalar>& jet,
                         const BasicJet<BasicInterval<typename C::Scalar>>& bounded) {
  requires std::floating_point<typename C::Scalar>;
  requires C::Vector::RowsAtCompileTime >= 1;
  { curve.parameter_end() } -> std::convertible_to<typename C::Scalar>;
  curve.point(u)[0];
  curve.point(jet)[0];
  curve.point(bounded)[0];
};

/// The point whose way counts as length: what a curve's `travelled(u)` says, X Y Z in mm, or other axes where
/// its `tool_rests()`; else its first three axes.
template <Curve C, class T>
[[nodiscard]] auto travelled(const C& curve, const T& u) {
  if constexpr (requires { curve.travelled(u); }) {
    return curve.travelled(u);
  } else {
    constexpr int space = std::min<int>(C::Vector::RowsAtCompileTime, 3);
    std::array<T, static_cast<std::size_t>(space)> result;
    const auto point = curve.point(u);
    std::copy_n(point.begin(), space, result.begin());
    return result;
  }
}

/// The speed by the parameter of the point that counts.
template <Curve C, class T>
[[nodiscard]] auto speed(const C& curve, const T& u) {
  T sum(0);
  for (const T& coordinate : travelled(curve, u)) sum = sum + square(coordinate.rate());
  return sqrt(sum);
}

/// The way of the point that counts, as quadrature needs it.
template <Curve C>
struct Travel {
  using Scalar = typename C::Scalar;
  using Vector = VectorN<Scalar, 1>;

  C curve;

  [[nodiscard]] Scalar parameter_end() const { return curve.parameter_end(); }
  [[nodiscard]] Vector derivative(Scalar u) const {
    return Vector(speed(curve, BasicJet<Scalar>(u, 1, 0, 0)).value);
  }
};

/// A curve by the length that `travelled` has come. The table of lengths has so many `Intervals`.
template <Curve C, int Intervals = 64>
class Measured {
 public:
  using Scalar = typename C::Scalar;
  using Vector = typename C::Vector;
  static constexpr int axis_count = Vector::RowsAtCompileTime;

  /// For a curve that is known to be smooth and never to stand still; `measured` asks.
  explicit Measured(const C& curve) : table_(Travel<C>{curve}) {}

  [[nodiscard]] const C& curve() const { return table_.curve().curve; }
  [[nodiscard]] Scalar length() const { return table_.length(); }
  [[nodiscard]] Scalar parameter_end() const { return table_.parameter_end(); }
  [[nodiscard]] Scalar parameter_at(Scalar s) const { return table_.parameter_at(s); }
  [[nodiscard]] Scalar length_at(Scalar u) const { return table_.length_at(u); }

  // By the curve's own parameter.
  [[nodiscard]] Vector position(Scalar u) const { return values(curve().point(u)); }
  [[nodiscard]] Vector derivative(Scalar u) const { return at(u).first; }
  [[nodiscard]] Vector second_derivative(Scalar u) const { return at(u).second; }
  [[nodiscard]] CurvePoint<Vector> at(Scalar u) const {
    const auto point = point_of(curve().point(BasicJet<Scalar>(u, Scalar(1), Scalar(0), Scalar(0))));
    return {point.position, point.first, point.second};
  }

  [[nodiscard]] Vector position_at(Scalar s) const { return position(parameter_at(s)); }
  [[nodiscard]] PathPoint<Vector> point_at(Scalar s) const {
    return point_of(curve().point(by_length(parameter_at(s))));
  }
  /// X Y Z of the point that counts, and their derivatives.
  [[nodiscard]] PathPoint<BasicVector3<Scalar>> tool_point_at(Scalar s) const {
    if constexpr (axis_count > 3)
      if (tool_rests()) return {.position = position_at(s).template head<3>()};
    const auto way = travelled(curve(), by_length(parameter_at(s)));
    std::array<BasicJet<Scalar>, 3> tool;
    std::copy_n(way.begin(), std::min(way.size(), tool.size()), tool.begin());
    return point_of(tool);
  }
  [[nodiscard]] auto enclosure(Scalar from, Scalar to) const {
    return curve().point(by_length(BasicInterval<Scalar>{parameter_at(from), parameter_at(to)}));
  }
  [[nodiscard]] BasicPathBounds<Scalar, axis_count> bounds(Scalar from, Scalar to) const {
    auto result = enclosed_bounds<parts>(*this, from, to);
    result.tool = tool_bounds(from, to);
    return result;
  }
  [[nodiscard]] BasicBox<Scalar, axis_count> box() const { return enclosed_box(*this); }

  friend bool operator==(const Measured& a, const Measured& b) requires std::equality_comparable<C> {
    return a.curve() == b.curve();
  }

 private:
  // Into how many parts bounds cut an interval: the curve may want more.
  static constexpr int parts = [] {
    if constexpr (requires { C::enclosed_parts; })
      return static_cast<int>(C::enclosed_parts);
    else
      return 4;
  }();

  // Where the way of other axes counts.
  [[nodiscard]] bool tool_rests() const {
    if constexpr (axis_count > 3 && requires(const C& c) { c.tool_rests(); })
      return curve().tool_rests();
    else
      return false;
  }

  static Vector values(const std::array<Scalar, static_cast<std::size_t>(axis_count)>& point) {
    return Eigen::Map<const Vector>(point.data());
  }

  // The parameter with its derivatives by the length: a number, or an interval.
  template <class T>
  [[nodiscard]] BasicJet<T> by_length(const T& u) const {
    const BasicJet<T> rate = BasicJet<T>(T(1)) / speed(curve(), BasicJet<T>(u, T(1), T(0), T(0)));
    return {u, rate.value, rate.first * rate.value,
            (rate.second * rate.value + rate.first * rate.first) * rate.value};
  }

  // Of a unit-speed curve: the part of r''' along r' is the square of the curvature, the rest lies across.
  [[nodiscard]] BasicToolBounds<Scalar> tool_bounds(Scalar from, Scalar to) const {
    if (tool_rests()) return {};
    const Scalar width = (to - from) / Scalar(parts);
    BasicToolBounds<Scalar> result{.first = Scalar(1)};
    for (int part = 0; part < parts; ++part) {
      const Scalar start = from + width * static_cast<Scalar>(part);
      const BasicInterval<Scalar> u{parameter_at(start), parameter_at(start + width)};
      Scalar middle_sq{}, second_sq{}, third_sq{};
      for (const auto& x : travelled(curve(), by_length(parameter_at(start + width / Scalar(2)))))
        middle_sq += x.second * x.second;
      for (const auto& x : travelled(curve(), by_length(u))) {
        second_sq += x.second.largest() * x.second.largest();
        third_sq += x.third.largest() * x.third.largest();
      }
      const Scalar third = std::sqrt(third_sq), middle = std::sqrt(middle_sq), half = width / Scalar(2);
      const Scalar second = cncplan::detail::grown(middle, half, third, std::sqrt(second_sq));
      const Scalar least = std::max(middle - half * third, Scalar(0));
      const Scalar across_sq = third_sq - least * least * least * least;
      result = result.joined(
          {Scalar(1), Scalar(0), second, second * second, std::sqrt(std::max(across_sq, Scalar(0)))});
    }
    return result;
  }

  ArcLengthTable<Travel<C>, Intervals> table_;
};

/// The curve as a path. Errors: not_positive for a parameter range that is empty; not_finite for a curve that
/// is not smooth or stands still somewhere, with the parameter at which it was found; unreachable where its
/// length cannot be measured to 1e-9 of itself in that many intervals, with the part that is uncertain.
template <int Intervals = 64, Curve C>
[[nodiscard]] Expected<Measured<C, Intervals>> measured(const C& curve) {
  using S = typename C::Scalar;
  const S end = curve.parameter_end();
  const auto refuse = [](ErrorCode code, S value, S bound) {
    return refusal(code, "parameter of a curve", value, bound);
  };
  if (!(end > S(0)) || !std::isfinite(end)) return refuse(ErrorCode::not_positive, end, S(0));
  const Travel<C> travel{curve};
  S uncertain = S(0), whole = S(0);
  for (int i = 0; i < Intervals; ++i) {
    const S from = end * static_cast<S>(i) / S(Intervals), to = end * static_cast<S>(i + 1) / S(Intervals);
    const S once = arc_length(travel, from, to), twice = arc_length(travel, from, to, 2);
    if (!std::isfinite(once) || !std::isfinite(twice) || !(twice > S(0)))
      return refuse(ErrorCode::not_finite, from, end);
    uncertain += std::abs(once - twice);
    whole += twice;
  }
  constexpr S tolerance = std::max(S(1e-9), S(1e3) * std::numeric_limits<S>::epsilon());
  if (uncertain > tolerance * whole) return refuse(ErrorCode::unreachable, uncertain, tolerance * whole);
  return Measured<C, Intervals>(curve);
}

}  // namespace cncplan::path
