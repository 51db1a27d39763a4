// Arcs of a program by their radius, by their centre, or as straight lines, as is wanted of what is written.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <numbers>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"

namespace cncplan {

namespace detail {

/// The arc of a motion in X, Y and Z, which are its first axes.
[[nodiscard]] Expected<path::Arc> arc_of(const gcode::Motion& motion,
                                         const path::ArcTolerance<double>& tolerance);

/// Hands an arc to `take` in equal parts: copies of the motion that differ in start and end, the axes beyond
/// the third in proportion.
template <std::invocable<const gcode::Motion&> Take>
void in_parts(const gcode::Motion& motion, const path::Arc& arc, int parts, Take&& take) {
  gcode::Motion part = motion;
  part.extra_turns = 0;
  for (int i = 1; i <= parts; ++i, part.start = part.end) {
    const double share = static_cast<double>(i) / parts;
    for (std::size_t axis = 3; axis < part.end.size(); ++axis)
      part.end[axis] = motion.start[axis] + share * (motion.end[axis] - motion.start[axis]);
    const Vector3 place = arc.position(share * arc.parameter_end());
    for (std::size_t axis = 0; axis < 3; ++axis) part.end[axis] = place[static_cast<Eigen::Index>(axis)];
    if (i == parts) part.end = motion.end;
    take(part);
  }
}

}  // namespace detail

/// An arc by radius as the same arc by centre; any other motion as it is. Errors: those of
/// `path::arc_from_radius`.
[[nodiscard]] Expected<gcode::Motion> by_center(gcode::Motion motion,
                                                const path::ArcTolerance<double>& tolerance = {});

/// An arc by centre as the same arc by radius, where the radius says it: the centre that it gives lies within
/// `off` mm of the programmed one. Left as they are: full circles, spirals, arcs within 0.02 rad of half a
/// turn (there the centre moves by over a hundred times what the digits of R leave), and any other motion.
[[nodiscard]] gcode::Motion by_radius(const gcode::Motion& motion, double off = 1e-6,
                                      const path::ArcTolerance<double>& tolerance = {});

/// Hands an arc to `take` as arcs by radius: as it is where the radius says it, else cut into equal parts of
/// at most a third of a turn. Spirals, arcs under inverse-time feed (whose F belongs to the whole), arcs that
/// cannot be and other motions go as they are.
template <std::invocable<const gcode::Motion&> Take>
void split_by_radius(const gcode::Motion& motion, Take&& take, double off = 1e-6,
                     const path::ArcTolerance<double>& tolerance = {}) {
  const auto centered = by_center(motion, tolerance);
  if (!centered || centered->kind != gcode::MotionKind::arc_center) return take(motion);
  const gcode::Motion whole = by_radius(*centered, off, tolerance);
  if (whole.kind == gcode::MotionKind::arc_radius)
    return take(motion.kind == gcode::MotionKind::arc_radius ? motion : whole);
  const auto arc = detail::arc_of(*centered, tolerance);
  if (!arc || !arc->is_circular() || motion.feed_mode == gcode::FeedMode::inverse_time)
    return take(*centered);
  constexpr double third = 2.0 * std::numbers::pi / 3.0;
  const int parts = static_cast<int>(std::ceil(arc->parameter_end() / third - 1e-9));
  const auto [first, second, across] = axes(motion.plane);
  detail::in_parts(*centered, *arc, parts, [&, k = across](gcode::Motion part) {
    part.center[k] = part.start[static_cast<std::size_t>(k)];
    take(by_radius(part, off, tolerance));
  });
}

/// Hands an arc to `take` as straight lines (G01) that each turn by no more than `angle`, rad, > 0 (U09
/// section 3.2.2: one degree, `published::one_degree`), and as equal as that makes them; other motions go as
/// they are. A feed in inverse time, which is the whole arc's, is shared out; under G61.1 each line ends in a
/// stop. Errors: not_positive, and above_limit for more than 2^24 lines (angle); those of the arc.
template <std::invocable<const gcode::Motion&> Take>
[[nodiscard]] Expected<void> split_into_lines(const gcode::Motion& motion, double angle, Take&& take,
                                              const path::ArcTolerance<double>& tolerance = {}) {
  const bool is_arc =
      motion.kind == gcode::MotionKind::arc_radius || motion.kind == gcode::MotionKind::arc_center;
  if (!is_arc) {
    take(motion);
    return {};
  }
  if (!(angle > 0.0)) return refusal(ErrorCode::not_positive, "angle", angle);
  const auto arc = detail::arc_of(motion, tolerance);
  if (!arc) return tl::unexpected(arc.error());
  constexpr double most_lines = 1 << 24, rounding = 1e-12;  // a whole number of lines is one
  const double lines = std::ceil(arc->parameter_end() / angle * (1.0 - rounding));
  if (!(lines <= most_lines))
    return refusal(ErrorCode::above_limit, "angle", arc->parameter_end() / angle, most_lines);
  const int parts = std::max(1, static_cast<int>(lines));
  gcode::Motion line = motion;
  line.kind = gcode::MotionKind::line;
  line.center = Vector3::Zero();
  line.radius = 0.0;
  if (line.feed && motion.feed_mode == gcode::FeedMode::inverse_time) *line.feed *= parts;
  detail::in_parts(line, *arc, parts, take);
  return {};
}

}  // namespace cncplan

#ifndef CNCPLAN_COMPILED
#include "cncplan/arc_words-inl.hpp"
#endif
