// Cutter compensation: the way of a tool's centre beside the programmed path (G40 to G42.1).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <variant>

#include "cncplan/core/error.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::gcode {

/// Most words and dwells between two motions under cutter compensation.
inline constexpr std::size_t max_held = 32;

/// Takes items in order and gives them on; motions with a `tool_radius` come out as those of the tool's
/// centre, one motion later. The rules are LinuxCNC's (Tool Compensation): the first motion ends beside its
/// end point, at right angles to it; around an outer corner the centre goes on an arc; at an inner one it
/// turns where the two ways beside the path meet; the first motion after G40 goes straight to its end.
///
///     if (auto ok = compensation.take(item, emit); !ok) return ok.error();
///     compensation.finish(emit);
class Compensation {
 public:
  /// Whether an item without a radius would come out as it is.
  [[nodiscard]] bool idle() const { return !last_ && !beside_ && !lost_; }

  /// Errors, at the motion: `below_limit` for a lead-in that is not longer than the radius, an arc that is
  /// not larger, and a motion that is too short beside an inner corner, each with what there is and what it
  /// takes; `above_limit` for more than `max_held` items between two motions. What is at fault is left out,
  /// and what comes behind it is only asked about itself.
  template <class Emit>
  Expected<void, Diagnostic> take(const Item& item, Emit&& emit) {
    const auto* motion = std::get_if<Motion>(&item);
    if (motion == nullptr) return hold(item, emit);
    if (motion->tool_radius == 0.0) {
      finish(emit);
      Motion next = *motion;
      if (beside_) put(next.start, *beside_, next);
      beside_.reset();
      lost_ = false;
      emit(Item(next));
      return {};
    }
    if (!is_arc(*motion) && plane_point(motion->start, *motion) == plane_point(motion->end, *motion) &&
        (last_ || lost_))
      return hold(item, emit);
    auto done = lead(*motion, emit);
    if (!done) forget();
    return done;
  }

  /// Gives on what is held: the program ends, or compensation does.
  template <class Emit>
  void finish(Emit&& emit) {
    if (last_) give_last(last_->end, emit);
  }

 private:
  using Point = std::complex<double>;  // of the plane

  /// A motion beside the path.
  struct Way {
    Motion motion;
    Point corner;         ///< the programmed end
    Point start;          ///< of the centre
    Point end;            ///< of the centre, if no inner corner follows
    Point start_tangent;  ///< of the programmed path, length 1
    Point end_tangent;
    Point center;     ///< of an arc
    double radius{};  ///< of an arc beside the path; 0 for lines
    double turn{};    ///< +1 counter-clockwise, -1 clockwise
  };

  static constexpr double tangent_within = 1e-6;  ///< rad: less of a corner is none
  static constexpr double nearly_tangent = 0.05;  ///< rad: ways that do not meet for roundings of the text
  static constexpr double back_within = 0.05;     ///< rad from half a turn: the path turns back (LinuxCNC)

  static bool is_arc(const Motion& motion) {
    return motion.kind == MotionKind::arc_center || motion.kind == MotionKind::arc_radius;
  }
  static Point plane_point(const Position& position, const Motion& motion) {
    const auto [first, second, third] = axes(motion.plane);
    return {position[static_cast<std::size_t>(first)], position[static_cast<std::size_t>(second)]};
  }
  static void put(Position& position, Point point, const Motion& motion) {
    const auto [first, second, third] = axes(motion.plane);
    position[static_cast<std::size_t>(first)] = point.real();
    position[static_cast<std::size_t>(second)] = point.imag();
  }
  static double cross(Point a, Point b) { return std::imag(std::conj(a) * b); }
  static double dot(Point a, Point b) { return std::real(std::conj(a) * b); }
  static Point left_of(Point direction) { return Point(0.0, 1.0) * direction; }

  static tl::unexpected<Diagnostic> refuse(const Motion& motion, std::string_view what, double value,
                                           double bound) {
    return tl::unexpected(Diagnostic{
        {ErrorCode::below_limit, what, value, bound}, motion.line, std::max(1, motion.column), {}});
  }

  template <class Emit>
  Expected<void, Diagnostic> hold(const Item& item, Emit& emit) {
    if (std::holds_alternative<Warning>(item)) {  // about the text: it waits for no motion
      emit(item);
      return {};
    }
    const auto* stop = std::get_if<Stop>(&item);
    if (stop != nullptr && (stop->code == 2 || stop->code == 30)) finish(emit);
    if (!last_) {
      emit(item);
      return {};
    }
    if (held_count_ == max_held)
      return tl::unexpected(Diagnostic{
          {ErrorCode::above_limit, "number of words between motions under G41, G42", max_held + 1, max_held},
          last_->motion.line,
          1,
          {}});
    held_[held_count_++] = item;
    return {};
  }

  /// The centre of an arc that has a radius: of the two, the one that the signs of R and turn say.
  static Expected<Point, Diagnostic> center_of(const Motion& motion, Point start, Point end) {
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

  /// The way beside a motion.
  static Expected<Way, Diagnostic> beside(const Motion& motion) {
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

  template <class Emit>
  Expected<void, Diagnostic> lead(const Motion& motion, Emit& emit) {
    if (!last_ && !lost_) return lead_in(motion);
    const auto next = beside(motion);
    if (!next) return tl::unexpected(next.error());
    if (!lost_) return join(*next, emit);
    last_ = *next;
    lost_ = false;
    return {};
  }

  /// The way ends here for what was wrong with it.
  void forget() {
    last_.reset();
    beside_.reset();
    held_count_ = 0;
    lost_ = true;
  }

  /// From where the tool is to beside the end; an arc keeps its tangent there.
  Expected<void, Diagnostic> lead_in(Motion motion) {
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

  /// From the last way to the next, which becomes the last.
  template <class Emit>
  Expected<void, Diagnostic> join(Way next, Emit& emit) {
    const double radius = next.motion.tool_radius;
    const double corner = std::atan2(cross(last_->end_tangent, next.start_tangent),
                                     dot(last_->end_tangent, next.start_tangent));
    const bool back = std::abs(corner) > std::numbers::pi - back_within;
    const bool outer = back ? radius * (bend(*last_) + bend(next)) >= 0.0 : (corner < 0.0) == (radius > 0.0);
    if (std::abs(corner) < tangent_within) {
      next.start = last_->end;
      give_last(last_->end, emit);
    } else if (outer) {
      const Point from = last_->end, around = last_->corner;
      give_last(from, emit);
      emit(Item(corner_motion(next, from, around)));
    } else {
      const auto meeting = meet(*last_, next, std::abs(corner) < nearly_tangent);
      if (!meeting) return tl::unexpected(meeting.error());
      next.start = *meeting;
      give_last(*meeting, emit);
    }
    last_ = next;
    return {};
  }

  /// Signed curvature beside the path: where the path turns back, it says on which side the two ways meet.
  static double bend(const Way& way) { return way.turn == 0.0 ? 0.0 : way.turn / way.radius; }

  /// Around an outer corner; a rapid has no arcs, and cuts it.
  static Motion corner_motion(const Way& next, Point from, Point around) {
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

  /// Where two ways meet at an inner corner: of the places that their lines and circles have in common the
  /// one that shortens them least, if both ways are that long. Where the ways go on in nearly one direction
  /// and have none in common, it is between their ends.
  static Expected<Point, Diagnostic> meet(const Way& last, const Way& next, bool nearly_one) {
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
      const double before = way_between(last, *place, last.end),
                   after = way_between(next, next.start, *place);
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

  static std::array<std::optional<Point>, 2> line_and_circle(Point on, Point direction, const Way& arc) {
    const double along = dot(arc.center - on, direction);
    const double aside = cross(direction, arc.center - on);
    const double half_sq = arc.radius * arc.radius - aside * aside;
    if (half_sq < 0.0) return {};
    const double half = std::sqrt(half_sq);
    return {on + (along - half) * direction, on + (along + half) * direction};
  }

  static std::array<std::optional<Point>, 2> two_circles(const Way& a, const Way& b) {
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

  /// mm along a way from one place on it to another, less than half a turn away.
  static double way_between(const Way& way, Point from, Point to) {
    if (way.turn == 0.0) return dot(to - from, way.end_tangent);
    const double angle = way.turn * std::arg((to - way.center) / (from - way.center));
    return way.radius * angle;
  }

  /// mm of the whole way. A lead-in counts along its end, as what it loses there does.
  static double length(const Way& way) {
    if (way.turn == 0.0) return dot(way.end - way.start, way.end_tangent);
    const double angle = way.turn * std::arg((way.end - way.center) / (way.start - way.center));
    const double whole = 2.0 * std::numbers::pi;
    return way.radius * ((angle > 0.0 ? angle : angle + whole) + whole * way.motion.extra_turns);
  }

  /// The last motion ends at a place; what was held comes behind it.
  template <class Emit>
  void give_last(Point end, Emit& emit) {
    Motion motion = last_->motion;
    put(motion.start, last_->start, motion);
    put(motion.end, end, motion);
    motion.tool_radius = 0.0;
    if (is_arc(motion)) {
      const auto [first, second, third] = axes(motion.plane);
      motion.kind = MotionKind::arc_center;
      motion.center = Vector3(motion.start[0], motion.start[1], motion.start[2]);
      motion.center[first] = last_->center.real();
      motion.center[second] = last_->center.imag();
    }
    emit(Item(motion));
    for (std::size_t i = 0; i < held_count_; ++i) {
      if (auto* held = std::get_if<Motion>(&held_[i])) {  // beside the plane
        put(held->start, end, *held);
        put(held->end, end, *held);
        held->tool_radius = 0.0;
      }
      emit(held_[i]);
    }
    held_count_ = 0;
    last_.reset();
    beside_ = end;
  }

  std::optional<Way> last_;
  std::optional<Point> beside_;  ///< where the centre is, if that is not where the program is
  bool lost_{};                  ///< under compensation, behind a motion in error
  std::array<Item, max_held> held_{};
  std::size_t held_count_{};
};

}  // namespace cncplan::gcode
