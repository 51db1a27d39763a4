// Definitions of arc_words.hpp.
#pragma once

#include <cmath>
#include <numbers>

#include "cncplan/arc_words.hpp"

namespace cncplan {

CNCPLAN_INLINE Expected<path::Arc> detail::arc_of(const gcode::Motion& motion,
                                                  const path::ArcTolerance<double>& tolerance) {
  const Vector3 start(motion.start[0], motion.start[1], motion.start[2]);
  const Vector3 end(motion.end[0], motion.end[1], motion.end[2]);
  if (motion.kind == gcode::MotionKind::arc_radius)
    return path::arc_from_radius<double>(start, end, motion.radius, motion.turn, motion.plane, tolerance,
                                         motion.extra_turns);
  return path::arc_from_center<double>(start, end, motion.center, motion.turn, motion.plane, tolerance,
                                       motion.extra_turns);
}

CNCPLAN_INLINE Expected<gcode::Motion> by_center(gcode::Motion motion,
                                                 const path::ArcTolerance<double>& tolerance) {
  if (motion.kind != gcode::MotionKind::arc_radius) return motion;
  const auto arc = detail::arc_of(motion, tolerance);
  if (!arc) return tl::unexpected(arc.error());
  motion.kind = gcode::MotionKind::arc_center;
  motion.center = arc->center();
  motion.radius = 0.0;
  return motion;
}

CNCPLAN_INLINE gcode::Motion by_radius(const gcode::Motion& motion, double off,
                                       const path::ArcTolerance<double>& tolerance) {
  if (motion.kind != gcode::MotionKind::arc_center) return motion;
  const auto arc = detail::arc_of(motion, tolerance);
  if (!arc || !arc->is_circular()) return motion;
  const double sweep = std::abs(arc->sweep()) - 2.0 * std::numbers::pi * motion.extra_turns;
  if (std::abs(sweep - std::numbers::pi) < 0.02) return motion;
  gcode::Motion result = motion;
  result.kind = gcode::MotionKind::arc_radius;
  result.radius = sweep > std::numbers::pi ? -arc->start_radius() : arc->start_radius();
  result.center = Vector3::Zero();
  const auto read = detail::arc_of(result, tolerance);
  const auto [first, second, third] = axes(motion.plane);
  const auto apart = [&](int axis) { return read->center()(axis) - motion.center(axis); };
  return read && std::hypot(apart(first), apart(second)) <= off ? result : motion;
}

}  // namespace cncplan
