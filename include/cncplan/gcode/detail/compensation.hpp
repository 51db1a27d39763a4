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

#include "cncplan/core/compiled.hpp"
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
  static void put(Position& position, Point point, const Motion& motion);
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
  static Expected<Point, Diagnostic> center_of(const Motion& motion, Point start, Point end);

  /// The way beside a motion.
  static Expected<Way, Diagnostic> beside(const Motion& motion);

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
  void forget();

  /// From where the tool is to beside the end; an arc keeps its tangent there.
  Expected<void, Diagnostic> lead_in(Motion motion);

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
  static Motion corner_motion(const Way& next, Point from, Point around);

  /// Where two ways meet at an inner corner: of the places that their lines and circles have in common the
  /// one that shortens them least, if both ways are that long. Where the ways go on in nearly one direction
  /// and have none in common, it is between their ends.
  static Expected<Point, Diagnostic> meet(const Way& last, const Way& next, bool nearly_one);

  static std::array<std::optional<Point>, 2> line_and_circle(Point on, Point direction, const Way& arc);

  static std::array<std::optional<Point>, 2> two_circles(const Way& a, const Way& b);

  /// mm along a way from one place on it to another, less than half a turn away.
  static double way_between(const Way& way, Point from, Point to);

  /// mm of the whole way. A lead-in counts along its end, as what it loses there does.
  static double length(const Way& way);

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

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/compensation-inl.hpp"
#endif
