// From the motions of a G-code program to blocks that can be planned.
#pragma once

#include <algorithm>
#include <concepts>

#include "cncplan/core/error.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/plan/block.hpp"

namespace cncplan::plan {

/// The first three axes of a position, X Y Z of a mill.
[[nodiscard]] inline Vector3 xyz(const gcode::Position& position) {
  return {position[0], position[1], position[2]};
}

/// The path of a motion in machine coordinates. Errors: those of the arcs; not_supported for a motion of axes
/// beyond the third, which has no place in space.
[[nodiscard]] inline Expected<path::Segment<3>> segment(const gcode::Motion& motion,
                                                        const path::ArcTolerance<double>& tolerance = {}) {
  for (std::size_t axis = 3; axis < motion.end.size(); ++axis)
    if (motion.end[axis] != motion.start[axis])
      return tl::unexpected(Error{ErrorCode::not_supported, "motion of an axis beyond the third",
                                  motion.end[axis], motion.start[axis]});
  const Vector3 offset = xyz(motion.offset);
  const Vector3 start = xyz(motion.start) + offset;
  const Vector3 end = xyz(motion.end) + offset;
  const auto widen = [](const path::Arc& arc) { return path::Segment<3>(arc); };
  switch (motion.kind) {
    case gcode::MotionKind::arc_radius:
      return path::arc_from_radius(start, end, motion.radius, motion.turn, motion.plane, tolerance,
                                   motion.extra_turns)
          .map(widen);
    case gcode::MotionKind::arc_center:
      return path::arc_from_center(start, end, motion.center + offset, motion.turn, motion.plane, tolerance,
                                   motion.extra_turns)
          .map(widen);
    default:
      return path::Segment<3>(path::Line<3>(start, end));
  }
}

/// The speed that a motion asks for along `length` mm: rapids run at the rapid rate, whatever `fastest` is;
/// feed moves at no more than `fastest`, and at that where there is no feed so far.
[[nodiscard]] inline double feed(const gcode::Motion& motion, double length, double fastest,
                                 double rapid_rate) {
  if (motion.kind == gcode::MotionKind::rapid) return rapid_rate;
  if (!motion.feed) return fastest;
  const double wanted =
      motion.feed_mode == gcode::FeedMode::inverse_time ? *motion.feed * length : *motion.feed;
  return std::min(wanted, fastest);
}

/// The block of a motion under limits along the path; the velocity limit is that of feed moves. Errors: those
/// of `segment` and of `validate`, and not_positive for the rapid rate (mm/s) or a feed of zero.
[[nodiscard]] inline Expected<Block> block(const gcode::Motion& motion, const Limits& limits,
                                           double rapid_rate,
                                           const path::ArcTolerance<double>& tolerance = {}) {
  if (!(rapid_rate > 0.0))
    return tl::unexpected(Error{ErrorCode::not_positive, "rapid rate", rapid_rate, 0.0});
  const auto way = segment(motion, tolerance);
  if (!way) return tl::unexpected(way.error());
  Block result{*way, limits, junction::Kind::line, motion.exact_stop, 0.0};
  if (way->length() > 0.0) result.limits.velocity = feed(motion, way->length(), limits.velocity, rapid_rate);
  if (const auto ok = validate(result.limits); !ok) return tl::unexpected(ok.error());
  if (motion.kind == gcode::MotionKind::rapid) result.kind = junction::Kind::rapid;
  if (way->arc() != nullptr) result.kind = junction::Kind::arc;
  return result;
}

}  // namespace cncplan::plan
