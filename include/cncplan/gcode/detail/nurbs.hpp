// A NURBS, cut at its knots into the rational Bezier curves that it is made of.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/compiler.hpp"
#include "cncplan/gcode/detail/spline_pieces.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::gcode {

/// A NURBS of any length whose controls and knots come one by one; a curve comes out as soon as all knots
/// that it depends on are there. Knots do not descend.
class Nurbs {
 public:
  /// `order`: 2 to `max_nurbs_order`.
  void begin(int order);
  void end() { open_ = false; }

  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] int order() const { return order_; }
  /// Before the first curve, as long as it makes no difference to the knots that have come.
  void set_order(int order) { order_ = order; }
  [[nodiscard]] int controls() const { return controls_; }
  [[nodiscard]] int knots() const { return knots_; }
  [[nodiscard]] double last_knot() const { return knots_ > 0 ? knot(knots_ - 1) : 0.0; }
  /// Whether the last knot has come as often as the order says: the end of what is clamped there.
  [[nodiscard]] bool clamped() const { return knots_ > order_ && knot(knots_ - 1) == knot(knots_ - order_); }

  void add(const SplineControl& control) { control_[at(controls_++)] = control; }

  /// Takes the next knot; the curve that it completes, between two different knots.
  std::optional<BezierCurve> add_knot(double value);

 private:
  static constexpr int kept = 2 * max_nurbs_order;  // of controls and knots

  static std::size_t at(int index) { return static_cast<std::size_t>(index % kept); }
  [[nodiscard]] double knot(int index) const { return knot_[at(index)]; }

  /// The polar form at a span's start degree - ends times, and at its end `ends` times: its Bezier control
  /// (de Boor's algorithm with a parameter for each step).
  [[nodiscard]] SplineControl blossom(int span, int ends) const;

  std::array<SplineControl, kept> control_{};
  std::array<double, kept> knot_{};
  int controls_ = 0;
  int knots_ = 0;
  int order_ = 3;
  bool open_ = false;
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/nurbs-inl.hpp"
#endif
