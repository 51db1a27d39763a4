// The splines of a program, as the rational cubic Bezier pieces that they are made of.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "cncplan/core/compiler.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::gcode {

/// Highest order of a NURBS: one more than the degree of its pieces.
inline constexpr int max_nurbs_order = 4;

/// One piece, with the weights 1 at both ends.
struct SplinePiece {
  std::array<SplineControl, 4> controls{};
};

namespace detail {

/// Between two controls in homogeneous coordinates: (1 - t) a + t b; at 0 and 1 they themselves, bit for bit.
[[nodiscard]] inline SplineControl between(const SplineControl& a, const SplineControl& b, double t) {
  if (t == 0.0) return a;
  if (t == 1.0) return b;
  const double of_a = (1.0 - t) * a.weight, of_b = t * b.weight, weight = of_a + of_b;
  return {(of_a * a.first + of_b * b.first) / weight, (of_a * a.second + of_b * b.second) / weight, weight};
}

/// A Bezier curve of degree 1 to 3 as a cubic (Piegl and Tiller, The NURBS Book, Eq. 5.36), with the weights
/// 1 at its ends: the weights w_i become w_i c^i / w_0, which is another parameter on the same curve.
[[nodiscard]] inline SplinePiece as_cubic(std::array<SplineControl, 4> controls, int degree) {
  for (int from = degree; from < 3; ++from)
    for (int i = from + 1; i > 0; --i) {
      const auto at = static_cast<std::size_t>(i);
      const SplineControl last = controls[std::min(at, static_cast<std::size_t>(from))];
      controls[at] = between(last, controls[at - 1], static_cast<double>(i) / (from + 1));
    }
  const double start = controls[0].weight, end = controls[3].weight, scale = std::cbrt(start / end);
  constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
  double factor = 1.0 / start;
  for (SplineControl& control : controls) {
    control.weight *= factor;
    if (std::abs(control.weight - 1.0) <= rounding) control.weight = 1.0;
    factor *= scale;
  }
  controls[3].weight = 1.0;
  return {controls};
}

/// Whether a piece's legs (the derivative's controls) or weights differ much: its speed by the parameter is
/// uneven then, and its length is hard to measure. With these bounds eight Gauss panels measure it to 1e-9.
[[nodiscard]] inline bool is_uneven(const SplinePiece& piece) {
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

/// Both halves of a piece, by de Casteljau's algorithm.
[[nodiscard]] inline std::array<SplinePiece, 2> halves(const SplinePiece& piece) {
  std::array<SplineControl, 4> points = piece.controls, low = points, high = points;
  for (std::size_t step = 1; step < 4; ++step) {
    for (std::size_t i = 0; i < 4 - step; ++i) points[i] = between(points[i], points[i + 1], 0.5);
    low[step] = points[0];
    high[3 - step] = points[3 - step];
  }
  return {as_cubic(low, 3), as_cubic(high, 3)};
}

}  // namespace detail

/// Pieces, cut in halves until each is even or has been cut `most_cuts` times (next to a cusp), in order.
class EvenPieces {
 public:
  static constexpr int most_cuts = 12;
  static constexpr int most_waiting = max_nurbs_order;

  [[nodiscard]] bool empty() const { return count_ == 0; }
  void clear() { count_ = 0; }
  /// What comes next, before all that waits; up to `most_waiting` pieces may wait.
  void put_first(const SplinePiece& piece) { put(piece, 0); }
  /// The next; not where it is empty.
  [[nodiscard]] SplinePiece next() {
    for (;;) {
      const auto [piece, cuts] = waiting_[--count_];
      if (cuts >= most_cuts || !detail::is_uneven(piece)) return piece;
      const auto [low, high] = detail::halves(piece);
      put(high, cuts + 1);
      put(low, cuts + 1);
    }
  }

 private:
  struct Waiting {
    SplinePiece piece;
    int cuts{};
  };
  void put(const SplinePiece& piece, int cuts) {
    if (count_ < waiting_.size()) waiting_[count_++] = {piece, cuts};
  }

  std::array<Waiting, static_cast<std::size_t>(most_waiting + most_cuts)> waiting_{};
  std::size_t count_ = 0;
};

/// A NURBS of any length whose controls and knots come one by one; a piece comes out as soon as all knots
/// that it depends on are there. Knots do not descend.
class Nurbs {
 public:
  /// `order`: 2 to `max_nurbs_order`.
  void begin(int order) {
    *this = Nurbs();
    order_ = order;
    open_ = true;
  }
  void end() { open_ = false; }

  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] int order() const { return order_; }
  /// Before the first piece, as long as it makes no difference to the knots that have come.
  void set_order(int order) { order_ = order; }
  [[nodiscard]] int controls() const { return controls_; }
  [[nodiscard]] int knots() const { return knots_; }
  [[nodiscard]] double last_knot() const { return knots_ > 0 ? knot(knots_ - 1) : 0.0; }
  /// Whether the last knot has come as often as the order says: the end of what is clamped there.
  [[nodiscard]] bool clamped() const { return knots_ > order_ && knot(knots_ - 1) == knot(knots_ - order_); }

  void add(const SplineControl& control) { control_[at(controls_++)] = control; }

  /// Takes the next knot; the piece that it completes, between two different knots.
  std::optional<SplinePiece> add_knot(double value) {
    knot_[at(knots_++)] = value;
    const int span = knots_ - order_;  // from its knot to the next
    if (span < order_ - 1 || span >= controls_ || !(knot(span) < knot(span + 1))) return std::nullopt;
    const int degree = order_ - 1;
    std::array<SplineControl, 4> bezier{};
    for (int i = 0; i <= degree; ++i) bezier[static_cast<std::size_t>(i)] = blossom(span, i);
    return detail::as_cubic(bezier, degree);
  }

 private:
  static constexpr int kept = 8;  // of controls and knots: 2 orders

  static std::size_t at(int index) { return static_cast<std::size_t>(index % kept); }
  [[nodiscard]] double knot(int index) const { return knot_[at(index)]; }

  /// The polar form at a span's start degree - ends times, and at its end `ends` times: its Bezier control
  /// (de Boor's algorithm with a parameter for each step).
  [[nodiscard]] SplineControl blossom(int span, int ends) const {
    const int degree = order_ - 1;
    std::array<SplineControl, 4> points{};
    for (int i = 0; i <= degree; ++i) points[static_cast<std::size_t>(i)] = control_[at(span - degree + i)];
    for (int step = 1; step <= degree; ++step) {
      const double u = step <= ends ? knot(span + 1) : knot(span);
      for (int i = degree; i >= step; --i) {
        const double low = knot(span - degree + i), high = knot(span + 1 + i - step);
        auto& point = points[static_cast<std::size_t>(i)];
        point = detail::between(points[static_cast<std::size_t>(i - 1)], point, (u - low) / (high - low));
      }
    }
    return points[static_cast<std::size_t>(degree)];
  }

  std::array<SplineControl, kept> control_{};
  std::array<double, kept> knot_{};
  int controls_ = 0;
  int knots_ = 0;
  int order_ = 3;
  bool open_ = false;
};

}  // namespace cncplan::gcode
