// Arcs of a program by their radius or by their centre, as is wanted of what is written (KK22 section 2).
#pragma once

#include <cmath>
#include <numbers>

#include "cncplan/core/error.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"

namespace cncplan::plan {

namespace detail {

/// The arc of a motion in X, Y and Z, which are its first axes.
[[nodiscard]] inline Expected<path::Arc> arc_of(const gcode::Motion& motion,
                                                const path::ArcTolerance<double>& tolerance) {
  const Vector3 start(motion.start[0], motion.start[1], motion.start[2]);
  const Vector3 end(motion.end[0], motion.end[1], motion.end[2]);
  if (motion.kind == gcode::MotionKind::arc_radius)
    return path::arc_from_radius<double>(start, end, motion.radius, motion.turn, motion.plane, tolerance,
                                         motion.extra_turns);
  return path::arc_from_center<double>(start, end, motion.center, motion.turn, motion.plane, tolerance,
                                       motion.extra_turns);
}

}  // namespace detail

/// An arc by radius as the same arc by centre; any other motion as it is. Errors: those of
/// `path::arc_from_radius`.
[[nodiscard]] inline Expected<gcode::Motion> by_center(gcode::Motion motion,
                                                       const path::ArcTolerance<double>& tolerance = {}) {
  if (motion.kind != gcode::MotionKind::arc_radius) return motion;
  const auto arc = detail::arc_of(motion, tolerance);
  if (!arc) return tl::unexpected(arc.error());
  motion.kind = gcode::MotionKind::arc_center;
  motion.center = arc->center();
  motion.radius = 0.0;
  return motion;
}

/// An arc by centre as the same arc by radius, where the radius says it: the centre that it gives lies within
/// `off` mm of the programmed one. Left as they are: full circles, spirals, arcs within 0.02 rad of half a
/// turn (there the centre moves by over a hundred times what the digits of R leave), and any other motion.
[[nodiscard]] inline gcode::Motion by_radius(const gcode::Motion& motion, double off = 1e-6,
                                             const path::ArcTolerance<double>& tolerance = {}) {
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

}  // namespace cncplan::plan
