// The tool behind a map, moved by hand straight in the program's coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "cncplan/core/in_space.hpp"
#include "cncplan/core/path_point.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/detail/curve/mapped_paths.hpp"
#include "cncplan/detail/speed/limits_along.hpp"
#include "cncplan/jog_speed.hpp"
#include "cncplan/move_to.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/path/mapped.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

/// Machines whose tool can be jogged in coordinates that are not those of the axes: the map's inverse says
/// where it is.
template <class M>
concept ToolJogModel = MappedModel<M> && path::InvertibleMap<MapOf<M>>;

/// A part of `Jog`. Of other machines it never drives anything.
template <MachineModel M>
class ToolJog {
 public:
  using S = typename M::Scalar;
  using Vector = VectorN<S, M::axis_count>;

  explicit ToolJog(const M&) {}
  [[nodiscard]] static BasicVector3<S> tool(const M& machine, const Vector& position,
                                            const std::array<int, 3>& axes) {
    return tool_of_axes(machine, position, axes);
  }
  [[nodiscard]] static constexpr bool drives() { return false; }
  [[nodiscard]] static constexpr bool moves() { return false; }
  [[nodiscard]] static constexpr bool waits() { return false; }
  [[nodiscard]] static AxisMotion<Vector> at(S) { return {}; }
  static void advance(S) {}
  static void begin_next() {}
  static void forget_next() {}
  [[nodiscard]] static constexpr S brakes() { return S(0); }
  [[nodiscard]] static Vector end() { return Vector::Zero(); }
  static void to_rest(S) {}
  static void clear() {}
};

/// Straight lines in coordinates, one behind the other: along each a move of one axis, its length, within
/// limits that hold all along the line (`limits_along`, of its proven bounds). Another target is met without
/// a stop where it lies straight on and limits allow; else the tool comes to rest on its line first.
template <ToolJogModel M>
class ToolJog<M> {
 public:
  using S = typename M::Scalar;
  using Vector = VectorN<S, M::axis_count>;
  using Map = path::BlockMap<MapOf<M>>;
  using Coordinates = VectorN<S, path::coordinate_count<Map>>;
  using Speed = BasicJogSpeed<S, M::axis_count>;

  /// A line with the move along it.
  struct Straight {
    path::Mapped<Map, path::BasicLine<S, path::coordinate_count<Map>>> path;
    BasicAxis<S> axis;  // its length, with the limits along it
    BasicAxisMove<S> move;
  };

  explicit ToolJog(const M& machine) : map_(block_map(machine, std::nullopt)) {}

  /// The axes are on a block: lines are straight in its coordinates. At first in those of a switchable map
  /// that is off.
  template <class P>
  void stand_on(const P& path) {
    if constexpr (requires { path.visit([](const auto&) {}); })
      path.visit([this](const auto& inside) { this->stand_on(inside); });
    else if constexpr (requires(Map & map) { map = path.map(); })
      map_ = path.map();
  }
  /// X Y Z of the tip in the part, the axes at a position.
  [[nodiscard]] BasicVector3<S> tool(const M&, const Vector& position, const std::array<int, 3>&) const {
    const auto point = [&] {
      if constexpr (path::switchable<MapOf<M>>)
        return coordinates_at(map_.map, position);
      else
        return coordinates_at(map_, position);
    }();
    return in_space(point, path::coordinates_in_space<Map>);
  }
  /// The coordinates in which lines are straight, the axes at a position.
  [[nodiscard]] Coordinates coordinates(const Vector& position) const {
    return coordinates_at(map_, position);
  }

  /// A line from rest, the joints at `place`, and the fastest move along it. Errors: not_finite for a target
  /// that is no number; discontinuous, with the axis, where the map's formula has other joints at that place
  /// (as another elbow), or a joint jumps on the way; those of `within_travel`; unreachable, with the axis,
  /// where the way leads through a singular place; those of `move_to` where there are no limits.
  [[nodiscard]] Expected<Straight> line(const M& machine, const Vector& place, const Coordinates& target,
                                        const Speed& speed) const {
    return line(machine, coordinates(place), place, target, speed, {});
  }
  /// Begins to go to a target from rest at `place`; or, where it moves, straight on or behind a rest.
  Expected<void> to(const M& machine, const Vector& place, const Coordinates& target, const Speed& speed) {
    if (!moves()) {
      const auto planned = line(machine, place, target, speed);
      if (!planned) return tl::unexpected(planned.error());
      clear();
      now_ = *planned;
      return {};
    }
    if (go_on(machine, target, speed)) return {};
    const BasicAxisMove<S> rest = brakes_ > S(0) ? now_->move : to_rest_with(S(1));
    const auto planned = line(machine, now_->path.position_at(rest.end().position), target, speed);
    if (!planned) return tl::unexpected(planned.error());
    now_->move = rest;
    brakes_ = std::max(brakes_, S(1));
    next_ = *planned;
    return {};
  }
  /// A line that begins once the axes, which something else moves, are at rest.
  void wait_with(const Straight& line) { next_ = line; }
  void begin_next() {
    if (!next_) return;
    now_ = next_;
    next_.reset();
    brakes_ = S(0);
  }
  void forget_next() { next_.reset(); }
  /// With so many times the limits it comes to rest; 0: it does not.
  [[nodiscard]] S brakes() const { return brakes_; }
  /// The axes where it comes to rest, while it drives.
  [[nodiscard]] Vector end() const { return now_->path.position_at(now_->move.end().position); }
  /// Where it goes to, while it does.
  [[nodiscard]] std::optional<Coordinates> target() const {
    if (next_) return next_->path.programmed().end();
    return moves() && brakes_ == S(0) ? std::optional<Coordinates>(now_->path.programmed().end())
                                      : std::nullopt;
  }
  /// Begins to come to rest on its line with so many times the limits of acceleration and jerk, where it does
  /// not brake as hard already, and to stay there.
  void to_rest(S share) {
    next_.reset();
    if (!moves() || share <= brakes_) return;
    now_->move = to_rest_with(share);
    brakes_ = share;
  }
  void clear() {
    now_.reset();
    next_.reset();
    brakes_ = S(0);
  }

  /// Whether the axes are on its line, and whether they move there.
  [[nodiscard]] bool drives() const { return now_.has_value(); }
  [[nodiscard]] bool moves() const { return drives() && !now_->move.finished(); }
  /// Whether a line is to begin.
  [[nodiscard]] bool waits() const { return next_.has_value(); }
  /// The axes `seconds` from now, while it drives.
  [[nodiscard]] AxisMotion<Vector> at(S seconds) const {
    const auto& [path, axis, move] = *now_;
    const S time = move.time() + seconds;
    const BasicAxisState<S> along = move.at(time);
    const S s = std::clamp(along.position, S(0), path.length());
    return motion(path.point_at(s), BasicState<S>{s, along.velocity, along.acceleration, move.jerk_at(time)});
  }
  void advance(S seconds) { now_->move.advance(seconds); }

 private:
  static constexpr int cells = 16;  // of a line, whose bounds are found one by one

  [[nodiscard]] static BasicMachineLimits<S, M::axis_count> slowed(const M& machine, const Speed& speed) {
    BasicMachineLimits<S, M::axis_count> result{machine.limits, {}};
    for (int i = 0; i < M::axis_count; ++i) {
      const auto& axis = machine.axes[static_cast<std::size_t>(i)];
      result.axes.push_back(
          {i, {std::min(least_velocity(axis), speed.axes[i]), least_acceleration(axis), axis.jerk}});
    }
    return result;
  }

  // From `start` on, the joints at `place` there, and along it from a state.
  [[nodiscard]] Expected<Straight> line(const M& machine, const Coordinates& start, const Vector& place,
                                        const Coordinates& target, const Speed& speed,
                                        const BasicAxisState<S>& from) const {
    for (const S number : target)
      if (!std::isfinite(number)) return refusal(ErrorCode::not_finite, "target of a jog", number);
    constexpr auto space = path::coordinates_in_space<Map>;
    const S tool = (in_space(target, space) - in_space(start, space)).norm();
    const path::BasicLine<S, path::coordinate_count<Map>> straight(
        start, target, tool > S(0) ? tool : (target - start).norm(), tool);
    auto path = mapped_path(machine, map_, straight, std::optional<Vector>(place));
    if (!path) return tl::unexpected(path.error());
    if (auto ok = joined(std::optional<Vector>(place), path->position_at(S(0)), machine); !ok)
      return tl::unexpected(ok.error());
    if (auto ok = within_travel(*path, machine, travel_and(place, machine)); !ok)
      return tl::unexpected(ok.error());
    const S length = path->length();
    BasicAxis<S> axis{.velocity = S(1), .acceleration = S(1), .jerk = S(1), .low = S(0), .high = length};
    if (length > S(0)) {
      const auto bounds = bounds_from(*path, from.position);
      for (int i = 0; i < M::axis_count; ++i)
        if (!std::isfinite(bounds.first[i]) || !std::isfinite(bounds.second[i]) ||
            !std::isfinite(bounds.third[i]))
          return tl::unexpected(axis_error(machine.axes[static_cast<std::size_t>(i)], ErrorCode::unreachable,
                                           path->position_at(length)[i], place[i]));
      const S most = tool > S(0) ? std::min(machine.limits.velocity, speed.tool) : BasicAxis<S>::infinity;
      const BasicLimits<S> limits = limits_along(bounds, slowed(machine, speed), most, most);
      axis.velocity = limits.velocity;
      axis.acceleration = limits.acceleration;
      axis.jerk = limits.jerk;
    }
    const auto move = move_to(from, length, axis);
    if (!move) return tl::unexpected(move.error());
    return Straight{*path, axis, *move};
  }

  // Of all that is ahead of a length: parts are looked at one by one, as bounds of a short one are tighter.
  template <class P>
  [[nodiscard]] static BasicPathBounds<S, M::axis_count> bounds_from(const P& path, S from) {
    const S width = (path.length() - from) / static_cast<S>(cells);
    auto most = path.bounds(from, from + width);
    for (int i = 1; i < cells; ++i)
      most = most.joined(path.bounds(from + static_cast<S>(i) * width,
                                     i + 1 < cells ? from + static_cast<S>(i + 1) * width : path.length()));
    return most;
  }

  // Whether a target lies straight on, and the line to it allows the speed and the acceleration of now: if
  // so it goes there.
  bool go_on(const M& machine, const Coordinates& target, const Speed& speed) {
    const auto& line_now = now_->path.programmed();
    const BasicAxisState<S> state = now_->move.state();
    const Coordinates& direction = line_now.direction();
    const S further = (target - line_now.start()).dot(direction) / direction.squaredNorm();
    const S beside = (target - line_now.start() - further * direction).template lpNorm<Eigen::Infinity>();
    constexpr S rounding = S(64) * std::numeric_limits<S>::epsilon();
    if (!(further > state.position &&
          beside <= rounding * (S(1) + target.template lpNorm<Eigen::Infinity>())))
      return false;
    const auto planned = line(machine, line_now.start(), now_->path.position_at(S(0)), target, speed, state);
    if (!planned) return false;
    const BasicAxis<S>& limits = planned->axis;
    const S rise = std::max(state.acceleration, S(0));
    if (!(std::abs(state.acceleration) <= limits.acceleration &&
          state.velocity + rise * rise / (S(2) * limits.jerk) <= limits.velocity))
      return false;
    now_ = *planned;
    next_.reset();
    brakes_ = S(0);
    return true;
  }

  // The fastest move to rest on the line.
  [[nodiscard]] BasicAxisMove<S> to_rest_with(S share) const {
    const BasicAxis<S> stronger{.velocity = now_->axis.velocity,
                                .acceleration = share * now_->axis.acceleration,
                                .jerk = share * now_->axis.jerk};
    const auto rest = reach_velocity(now_->move.state(), S(0), stronger);
    return rest ? *rest : now_->move;
  }

  Map map_;
  std::optional<Straight> now_, next_;
  S brakes_{};  // share of the limits with which it comes to rest; 0: it does not
};

}  // namespace cncplan::detail
