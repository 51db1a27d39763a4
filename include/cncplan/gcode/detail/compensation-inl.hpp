// Definitions of compensation.hpp.
#pragma once

#include "cncplan/gcode/detail/compensation.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE void Compensation::put(Position& position, Point point, const Motion& motion) {
  const auto [first, second, third] = axes(motion.plane);
  position[static_cast<std::size_t>(first)] = point.real();
  position[static_cast<std::size_t>(second)] = point.imag();
}

CNCPLAN_INLINE Expected<Compensation::Point, Diagnostic> Compensation::center_of(const Motion& motion,
                                                                                 Point start, Point end) {
  if (motion.kind == MotionKind::arc_center) {
    const auto [first, second, third] = axes(motion.plane);
    return Point(motion.center[first], motion.center[second]);
  }
  const Point chord = end - start;
  const double half = std::abs(chord) / 2.0;
  const double height_sq = motion.radius * motion.radius - half * half;
  if (half == 0.0 || height_sq < -1e-9 * half * half)
    return tl::unexpected(Diagnostic{
        {ErrorCode::chord_exceeds_diameter, "R", motion.radius, half}, motion.line, motion.column, {}});
  const double side = (motion.turn == Turn::counterclockwise) == (motion.radius > 0.0) ? 1.0 : -1.0;
  return start + chord / 2.0 + side * std::sqrt(std::max(0.0, height_sq)) * left_of(chord) / (2.0 * half);
}

CNCPLAN_INLINE Expected<Compensation::Way, Diagnostic> Compensation::beside(const Motion& motion) {
  Way way;
  way.motion = motion;
  const Point start = plane_point(motion.start, motion), end = plane_point(motion.end, motion);
  way.corner = end;
  if (is_arc(motion)) {
    const auto center = center_of(motion, start, end);
    if (!center) return tl::unexpected(center.error());
    way.center = *center;
    way.turn = sign(motion.turn);
    const double first = std::abs(start - way.center), radius = std::abs(end - way.center);
    const double least = std::min(first, radius);  // who plans it says whether they differ too much
    way.radius = radius - way.turn * motion.tool_radius;
    if (!(least > 0.0 && way.radius > 0.0))
      return refuse(motion, "radius of an arc under G41, G42", least, std::abs(motion.tool_radius));
    way.start_tangent = way.turn * left_of(start - way.center) / first;
    way.end_tangent = way.turn * left_of(end - way.center) / radius;
  } else {
    way.start_tangent = way.end_tangent = (end - start) / std::abs(end - start);
  }
  way.start = start + motion.tool_radius * left_of(way.start_tangent);
  way.end = end + motion.tool_radius * left_of(way.end_tangent);
  return way;
}

CNCPLAN_INLINE void Compensation::forget() {
  last_.reset();
  beside_.reset();
  held_count_ = 0;
  lost_ = true;
}

CNCPLAN_INLINE Expected<void, Diagnostic> Compensation::lead_in(Motion motion) {
  if (beside_) put(motion.start, *beside_, motion);
  beside_.reset();
  const Point start = plane_point(motion.start, motion);
  const double way = std::abs(plane_point(motion.end, motion) - start);
  if (!(way > std::abs(motion.tool_radius)))
    return refuse(motion, "length of the first motion under G41, G42", way, std::abs(motion.tool_radius));
  auto first = beside(motion);
  if (!first) return tl::unexpected(first.error());
  first->start = start;
  if (is_arc(motion)) {
    // |start - center| = |end - center| with the centre on the line from the end to the old one.
    const Point inward = (first->center - first->end) / std::abs(first->center - first->end);
    const Point back = start - first->end;
    const double along = 2.0 * dot(back, inward);
    if (std::abs(along) < 1e-9 * std::abs(back))
      return refuse(motion, "radius of the first arc under G41, G42", first->radius,
                    std::abs(motion.tool_radius));
    const double radius = std::norm(back) / along;
    first->center = first->end + radius * inward;
    first->radius = std::abs(radius);
  }
  last_ = *first;
  return {};
}

CNCPLAN_INLINE Motion Compensation::corner_motion(const Way& next, Point from, Point around) {
  Motion motion = next.motion;
  const double radius = motion.tool_radius;
  motion.end = motion.start;
  put(motion.start, from, motion);
  put(motion.end, next.start, motion);
  motion.tool_radius = 0.0;
  motion.exact_stop = false;
  motion.extra_turns = 0;
  if (motion.kind == MotionKind::rapid) return motion;
  if (motion.feed && motion.feed_mode == FeedMode::inverse_time) {  // at the speed of the motion behind it
    const double angle = std::abs(std::arg((next.start - around) / (from - around)));
    *motion.feed *= length(next) / (std::abs(radius) * angle);
  }
  const auto [first, second, third] = axes(motion.plane);
  motion.kind = MotionKind::arc_center;
  motion.turn = radius > 0.0 ? Turn::clockwise : Turn::counterclockwise;
  motion.center = Vector3(motion.start[0], motion.start[1], motion.start[2]);
  motion.center[first] = around.real();
  motion.center[second] = around.imag();
  return motion;
}

CNCPLAN_INLINE Expected<Compensation::Point, Diagnostic> Compensation::meet(const Way& last, const Way& next,
                                                                            bool nearly_one) {
  std::array<std::optional<Point>, 2> places;
  if (last.turn == 0.0 && next.turn == 0.0) {
    const double along =
        cross(next.end - last.end, next.start_tangent) / cross(last.end_tangent, next.start_tangent);
    places[0] = last.end + along * last.end_tangent;
  } else if (last.turn == 0.0) {
    places = line_and_circle(last.end, last.end_tangent, next);
  } else if (next.turn == 0.0) {
    places = line_and_circle(next.start, next.start_tangent, last);
  } else {
    places = two_circles(last, next);
  }
  std::optional<Point> best;
  double least = std::numeric_limits<double>::infinity(), lost_before{}, lost_after{};
  for (const auto& place : places) {
    if (!place) continue;
    const double before = way_between(last, *place, last.end), after = way_between(next, next.start, *place);
    if (before < 0.0 || after < 0.0 || before + after >= least) continue;
    best = place;
    least = before + after;
    lost_before = before;
    lost_after = after;
  }
  const double radius = std::abs(next.motion.tool_radius);
  if (!best && nearly_one) return (last.end + next.start) / 2.0;
  if (!best) return refuse(next.motion, "room for the tool in an inner corner", 0.0, radius);
  if (const double before = length(last); lost_before > before)
    return refuse(last.motion, "length before an inner corner", before, lost_before);
  if (const double after = length(next); lost_after > after)
    return refuse(next.motion, "length behind an inner corner", after, lost_after);
  return *best;
}

CNCPLAN_INLINE std::array<std::optional<Compensation::Point>, 2> Compensation::line_and_circle(
    Point on, Point direction, const Way& arc) {
  const double along = dot(arc.center - on, direction);
  const double aside = cross(direction, arc.center - on);
  const double half_sq = arc.radius * arc.radius - aside * aside;
  if (half_sq < 0.0) return {};
  const double half = std::sqrt(half_sq);
  return {on + (along - half) * direction, on + (along + half) * direction};
}

CNCPLAN_INLINE std::array<std::optional<Compensation::Point>, 2> Compensation::two_circles(const Way& a,
                                                                                           const Way& b) {
  const Point between = b.center - a.center;
  const double distance = std::abs(between);
  if (distance == 0.0) return {};
  const double along = (distance * distance + a.radius * a.radius - b.radius * b.radius) / (2.0 * distance);
  const double half_sq = a.radius * a.radius - along * along;
  if (half_sq < 0.0) return {};
  const Point axis = between / distance;
  const Point aside = std::sqrt(half_sq) * left_of(axis);
  return {a.center + along * axis + aside, a.center + along * axis - aside};
}

CNCPLAN_INLINE double Compensation::way_between(const Way& way, Point from, Point to) {
  if (way.turn == 0.0) return dot(to - from, way.end_tangent);
  const double angle = way.turn * std::arg((to - way.center) / (from - way.center));
  return way.radius * angle;
}

CNCPLAN_INLINE double Compensation::length(const Way& way) {
  if (way.turn == 0.0) return dot(way.end - way.start, way.end_tangent);
  const double angle = way.turn * std::arg((way.end - way.center) / (way.start - way.center));
  // Of a whole circle both ends are one place but for rounding.
  constexpr double rounding = 1e-9, whole = 2.0 * std::numbers::pi;
  return way.radius * ((angle > rounding ? angle : angle + whole) + whole * way.motion.extra_turns);
}

}  // namespace cncplan::gcode
