// Definitions of spline_pieces.hpp.
#pragma once

#include "cncplan/gcode/detail/spline_pieces.hpp"

namespace cncplan::gcode {

namespace detail {

CNCPLAN_INLINE SplineControl between(const SplineControl& a, const SplineControl& b, double t) {
  if (t == 0.0) return a;
  if (t == 1.0) return b;
  const double of_a = (1.0 - t) * a.weight, of_b = t * b.weight, weight = of_a + of_b;
  return {(of_a * a.first + of_b * b.first) / weight, (of_a * a.second + of_b * b.second) / weight, weight};
}

CNCPLAN_INLINE void elevate(BezierCurve& curve) {
  const int degree = ++curve.degree;
  for (int i = degree; i > 0; --i) {
    const SplineControl last = curve.at(std::min(i, degree - 1));
    curve.at(i) = between(last, curve.at(i - 1), static_cast<double>(i) / degree);
  }
}

CNCPLAN_INLINE std::array<BezierCurve, 2> halves(const BezierCurve& curve) {
  BezierCurve points = curve, low = curve, high = curve;
  for (int step = 1; step <= curve.degree; ++step) {
    const int last = curve.degree - step;
    for (int i = 0; i <= last; ++i) points.at(i) = between(points.at(i), points.at(i + 1), 0.5);
    low.at(step) = points.at(0);
    high.at(last) = points.at(last);
  }
  return {low, high};
}

CNCPLAN_INLINE BezierCurve hermite_cubic(const BezierCurve& curve) {
  const double part = curve.degree / 3.0;  // of the curve's own first and last leg
  const auto leg = [part](const SplineControl& end, const SplineControl& next) {
    const double weight = end.weight + part * (next.weight - end.weight), way = part * next.weight / weight;
    return SplineControl{end.first + way * (next.first - end.first),
                         end.second + way * (next.second - end.second), weight};
  };
  const SplineControl &start = curve.at(0), &end = curve.at(curve.degree);
  return {{start, leg(start, curve.at(1)), leg(end, curve.at(curve.degree - 1)), end}, 3};
}

CNCPLAN_INLINE double reach(std::span<const SplineControl> controls) {
  double farthest = 0.0;
  for (const SplineControl& control : controls)
    farthest = std::max(farthest, apart(controls.front(), control));
  return farthest;
}

CNCPLAN_INLINE double distance_bound(const BezierCurve& curve, BezierCurve cubic) {
  const SplineControl &start = curve.at(0), &end = curve.at(curve.degree);
  const SplineControl middle{(start.first + end.first) / 2.0, (start.second + end.second) / 2.0, 1.0};
  double far = 0.0, off = 0.0, off_weight = 0.0, least_weight = start.weight;
  for (const SplineControl& control : cubic.used()) {
    if (!(control.weight > 0.0)) return std::numeric_limits<double>::infinity();
    far = std::max(far, apart(middle, control));
  }
  while (cubic.degree < curve.degree) elevate(cubic);
  for (int i = 0; i <= curve.degree; ++i) {
    const SplineControl &a = curve.at(i), &b = cubic.at(i);
    const auto difference = [&](double SplineControl::*coordinate) {
      return a.weight * (a.*coordinate - middle.*coordinate) -
             b.weight * (b.*coordinate - middle.*coordinate);
    };
    off = std::max(off, std::hypot(difference(&SplineControl::first), difference(&SplineControl::second)));
    off_weight = std::max(off_weight, std::abs(a.weight - b.weight));
    least_weight = std::min(least_weight, a.weight);
  }
  const double share = 1.0 - std::ldexp(2.0 * (curve.degree + 1), -curve.degree);
  return share * (off + far * off_weight) / least_weight;
}

CNCPLAN_INLINE SplinePiece normalized(const BezierCurve& cubic) {
  SplinePiece piece{{cubic.at(0), cubic.at(1), cubic.at(2), cubic.at(3)}};
  const double start = cubic.at(0).weight, end = cubic.at(3).weight, scale = std::cbrt(start / end);
  constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
  double factor = 1.0 / start;
  for (SplineControl& control : piece.controls) {
    control.weight *= factor;
    if (std::abs(control.weight - 1.0) <= rounding) control.weight = 1.0;
    factor *= scale;
  }
  piece.controls[3].weight = 1.0;
  return piece;
}

CNCPLAN_INLINE SplinePiece parabola(SplineControl start, SplineControl middle, SplineControl end) {
  start.weight = middle.weight = end.weight = 1.0;
  BezierCurve curve{{start, middle, end}, 2};
  elevate(curve);
  return normalized(curve);
}

CNCPLAN_INLINE bool is_uneven(const SplinePiece& piece) {
  constexpr double most_off = 0.8, most_weight = 2.0;
  const auto& c = piece.controls;
  const double first = (c[3].first - c[0].first) / 3.0, second = (c[3].second - c[0].second) / 3.0;
  const double mean = std::hypot(first, second);
  for (std::size_t i = 0; i < 3; ++i)
    if (std::hypot(c[i + 1].first - c[i].first - first, c[i + 1].second - c[i].second - second) >
        most_off * mean)
      return true;
  for (const double weight : {c[1].weight, c[2].weight})
    if (weight > most_weight || weight < 1.0 / most_weight) return true;
  return false;
}

CNCPLAN_INLINE std::optional<SplinePiece> without_still_end(const SplinePiece& piece, double within) {
  constexpr double no_length = 1e-10;  // mm
  const auto& [start, one, two, end] = piece.controls;
  const bool still_start = apart(start, one) <= no_length, still_end = apart(two, end) <= no_length;
  if (!still_start && !still_end) return std::nullopt;
  const double first = end.first - start.first, second = end.second - start.second;
  const double chord = std::hypot(first, second);
  if (still_start && still_end) return straight({{start, one, two, end}, 3});
  const SplineControl& corner = still_start ? two : one;
  const double off = std::abs((corner.first - start.first) * second - (corner.second - start.second) * first);
  const SplinePiece result = parabola(start, corner, end);
  if (!(off <= within * chord) || is_uneven(result)) return std::nullopt;
  return result;
}

}  // namespace detail

CNCPLAN_INLINE SplinePiece SplinePieces::next() {
  constexpr double half = spline_accuracy / 2.0;  // there are two reasons to leave the curve
  for (;;) {
    auto [curve, cuts] = waiting_[--count_];
    while (curve.degree < 3) detail::elevate(curve);
    const BezierCurve cubic = curve.degree == 3 ? curve : detail::hermite_cubic(curve);
    if (curve.degree == 3 || detail::distance_bound(curve, cubic) <= half) {
      const SplinePiece piece = detail::normalized(cubic);
      if (const auto other = detail::without_still_end(piece, half)) return *other;
      if (!detail::is_uneven(piece)) return piece;
    }
    if (cuts >= most_cuts || detail::reach(curve.used()) <= half) return detail::straight(curve);
    const auto [low, high] = detail::halves(curve);
    put(high, cuts + 1);
    put(low, cuts + 1);
  }
}

}  // namespace cncplan::gcode
