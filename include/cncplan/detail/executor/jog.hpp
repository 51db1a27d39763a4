// Axes that are moved by hand, while no program moves them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "cncplan/core/path_point.hpp"
#include "cncplan/detail/executor/tool_jog.hpp"
#include "cncplan/jog_speed.hpp"
#include "cncplan/move_to.hpp"
#include "cncplan/reserve.hpp"
#include "cncplan/tool.hpp"

namespace cncplan {

namespace detail {

/// A machine's axes in a motion of their own, each within its limits, from one request to the next; behind a
/// map also the tool's.
template <MachineModel M>
class Jog {
 public:
  using Scalar = typename M::Scalar;
  using States = BasicAxisStates<Scalar, M::axis_count>;
  using Vector = VectorN<Scalar, M::axis_count>;
  using Speed = BasicJogSpeed<Scalar, M::axis_count>;
  using Coordinates = VectorN<Scalar, program_coordinates<M>>;

  explicit Jog(const M& machine) : tool_(machine) {}

  /// Begins to come to velocities, from where the axes are and as they move; from rest at `place` where they
  /// are at rest, and behind a rest that they come to with more than their limits. Errors: those of
  /// `reach_velocity`.
  Expected<void> to_velocities(const Vector& place, const Vector& velocities, const M& machine) {
    const States from = start(place);
    return go_on(reach_velocity(from, row(velocities), axes_of(machine, from, velocities)));
  }
  /// Begins to go to positions. Errors: those of `validate` for the speed, and of `move_to`; not_supported
  /// for a speed of the tool under a map, where joints move.
  Expected<void> to_positions(const Vector& place, const Vector& positions, const M& machine,
                              const Speed& speed = {}) {
    if (auto ok = validate(speed); !ok) return ok;
    if (MappedModel<M> && std::isfinite(speed.tool))
      return refusal(ErrorCode::not_supported, "speed of the tool in a jog of joints", speed.tool);
    const States from = start(place);
    const auto together = std::isfinite(speed.tool) ? Synchronization::phase : Synchronization::time;
    if (auto ok = go_on(move_to(from, row(positions),
                                slowed(machine, from, positions - vector(from.position), speed),
                                {.synchronization = together}));
        !ok)
      return ok;
    target_ = positions;
    return {};
  }
  /// The tool begins to go straight to a point in the program's coordinates, or comes to rest first and goes
  /// then; joints that move come to rest. Errors: those of `validate` for the speed, and of `ToolJog::line`.
  Expected<void> tool_to(const Vector& place, const Coordinates& point, const M& machine,
                         const Speed& speed) requires ToolJogModel<M> {
    if (auto ok = validate(speed); !ok) return ok;
    if (!moves_) {
      const auto done = tool_.to(machine, place, point, speed);
      if (done) forget_next();
      return done;
    }
    const Expected<Moved> rest = brakes_ > Scalar(0) ? move_
                                                     : reach_velocity(move_.state(), typename States::Row{},
                                                                      axes_of(machine, move_.state()));
    if (!rest) return tl::unexpected(rest.error());
    const auto line = tool_.line(machine, vector(end_of(*rest)), point, speed);
    if (!line) return tl::unexpected(line.error());
    follow(*rest, std::max(brakes_, Scalar(1)));
    forget_next();
    tool_.wait_with(*line);
    return {};
  }
  /// What is behind it: where the tool is and goes, and which block the axes are on.
  [[nodiscard]] ToolJog<M>& tool() { return tool_; }
  [[nodiscard]] const ToolJog<M>& tool() const { return tool_; }
  /// Where it goes, while it goes to positions.
  [[nodiscard]] std::optional<Vector> target() const { return moves_ || next_ ? target_ : std::nullopt; }
  /// Begins to come to rest with so many times the limits of acceleration and jerk, where it does not brake
  /// as hard already.
  void to_rest(const M& machine, Scalar share) {
    tool_.to_rest(share);
    forget_next();
    if (!moves_ || share <= brakes_) return;
    const Axes stronger = axes_of(with_forces(machine, share), move_.state());
    if (const auto rest = reach_velocity(move_.state(), typename States::Row{}, stronger))
      follow(*rest, share);
  }

  [[nodiscard]] bool moves() const { return moves_ || next_ || tool_.moves() || tool_.waits(); }

  /// The axes `seconds` from now, only while they move. Jerks are those from then on.
  [[nodiscard]] AxisMotion<Vector> at(Scalar seconds) const {
    if (tool_.drives()) return tool_.at(seconds);
    const Scalar time = move_.time() + seconds;
    const States states = move_.at(time);
    AxisMotion<Vector> result{vector(states.position), vector(states.velocity), vector(states.acceleration),
                              Vector::Zero()};
    for (std::size_t i = 0; i < states.position.size(); ++i)
      result.jerk[static_cast<Eigen::Index>(i)] = move_.axis(i).jerk_at(time);
    return result;
  }

  /// Moves on; whether the axes have come to rest.
  bool advance(Scalar seconds) {
    if (!moves_ && !tool_.moves()) {
      tool_.begin_next();
      if (next_) follow(*next_, Scalar(0));
      next_.reset();
    }
    if (tool_.drives()) {
      tool_.advance(seconds);
      return !moves();
    }
    move_.advance(seconds);
    const States states = move_.state();
    moves_ = !move_.finished() || states.velocity != typename States::Row{} ||
             states.acceleration != typename States::Row{};
    return !moves();
  }

 private:
  using Moved = BasicAxesMove<Scalar, M::axis_count>;

  // Axes with other limits than the machine's.
  struct Axes {
    using Scalar = typename M::Scalar;
    static constexpr int axis_count = M::axis_count;
    decltype(M::axes) axes;
  };

  // Its axes. One that stands still, and is asked for no way or velocity, needs no limits, and is within any.
  // One of the tool that lacks limits without which it cannot be moved has its share of the tool's: all three
  // together keep them. Under a map the tool's limits say nothing of a joint's.
  [[nodiscard]] static Axes axes_of(const M& machine, const States& from,
                                    const Vector& asked = Vector::Zero()) {
    Axes result{machine.axes};
    for (std::size_t i = 0; i < result.axes.size(); ++i)
      if (from.velocity[i] == Scalar(0) && from.acceleration[i] == Scalar(0) &&
          asked[static_cast<Eigen::Index>(i)] == Scalar(0))
        result.axes[i] = {.velocity = 1, .acceleration = 1, .jerk = 1};
    if (MappedModel<M>) return result;
    constexpr Scalar share = Scalar(0.57735026918962576);  // 1 / sqrt(3)
    for (const int i : tool_axes(machine)) {
      if (i < 0) continue;
      auto& axis = result.axes[static_cast<std::size_t>(i)];
      if (!std::isfinite(axis.velocity)) axis.velocity = share * machine.limits.velocity;
      if (std::isfinite(axis.acceleration) || std::isfinite(axis.jerk)) continue;
      axis.acceleration = share * machine.limits.acceleration;
      axis.jerk = share * machine.limits.jerk;
    }
    return result;
  }
  // The same on a way that is no faster than a speed.
  [[nodiscard]] static Axes slowed(const M& machine, const States& from, const Vector& way,
                                   const Speed& speed) {
    Axes result = axes_of(machine, from, way);
    const std::array<int, 3> tool = tool_axes(machine);
    const Scalar length = in_space(way, tool).norm();
    for (int i = 0; i < M::axis_count; ++i) {
      Scalar most = speed.axes[i];
      if (way[i] != Scalar(0) && std::find(tool.begin(), tool.end(), i) != tool.end())
        most = std::min(most, speed.tool * (std::abs(way[i]) / length));
      auto& axis = result.axes[static_cast<std::size_t>(i)];
      axis.velocity = std::min(axis.velocity, most);
      axis.velocity_down = std::min(axis.velocity_down, most);
    }
    return result;
  }

  static typename States::Row row(const Vector& vector) {
    typename States::Row result;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = vector[static_cast<Eigen::Index>(i)];
    return result;
  }
  static Vector vector(const typename States::Row& row) { return Eigen::Map<const Vector>(row.data()); }

  [[nodiscard]] static typename States::Row end_of(const Moved& move) {
    return move.at(move.duration()).position;
  }

  // Whether they come to rest with more than their limits.
  [[nodiscard]] bool brakes_hard() const {
    return (moves_ && brakes_ > Scalar(1)) || (tool_.moves() && tool_.brakes() > Scalar(1));
  }
  // From where they go on when something is asked for.
  [[nodiscard]] States start(const Vector& place) const {
    if (brakes_hard()) return {.position = moves_ ? end_of(move_) : row(tool_.end())};
    if (tool_.moves()) {
      const AxisMotion<Vector> axes = tool_.at(Scalar(0));
      return {row(axes.position), row(axes.velocity), row(axes.acceleration)};
    }
    return moves_ ? move_.state() : States{.position = row(place)};
  }
  // By a move from there.
  Expected<void> go_on(const Expected<Moved>& move) {
    if (!move) return tl::unexpected(move.error());
    forget_next();
    if (brakes_hard()) {
      tool_.forget_next();
      next_ = *move;
    } else {
      follow(*move, Scalar(0));
    }
    return {};
  }
  void follow(const Moved& move, Scalar brakes) {
    move_ = move;
    moves_ = true;
    tool_.clear();
    brakes_ = brakes;
  }
  void forget_next() {
    next_.reset();
    target_.reset();
  }

  [[no_unique_address]] ToolJog<M> tool_;
  Moved move_{};
  bool moves_ = false;
  std::optional<Moved> next_;  // behind a rest
  std::optional<Vector> target_;
  Scalar brakes_{};  // share of the limits with which it comes to rest; 0: it does not
};

}  // namespace detail

}  // namespace cncplan
