// Definitions of nurbs.hpp.
#pragma once

#include "cncplan/gcode/detail/nurbs.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE void Nurbs::begin(int order) {
  *this = Nurbs();
  order_ = order;
  open_ = true;
}

CNCPLAN_INLINE std::optional<BezierCurve> Nurbs::add_knot(double value) {
  knot_[at(knots_++)] = value;
  const int span = knots_ - order_;  // from its knot to the next
  if (span < order_ - 1 || span >= controls_ || !(knot(span) < knot(span + 1))) return std::nullopt;
  BezierCurve bezier;
  bezier.degree = order_ - 1;
  for (int i = 0; i <= bezier.degree; ++i) bezier.at(i) = blossom(span, i);
  return bezier;
}

CNCPLAN_INLINE SplineControl Nurbs::blossom(int span, int ends) const {
  const int degree = order_ - 1;
  std::array<SplineControl, static_cast<std::size_t>(max_nurbs_order)> points{};
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

}  // namespace cncplan::gcode
