// Axes from wherever they are to positions, states and velocities: what a controller does all day.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/state/motion.hpp"
#include "cncplan/state/move.hpp"
#include "cncplan/state/move_options.hpp"
#include "cncplan/state/reach_velocity.hpp"
#include "cncplan/state/synchronized.hpp"

namespace cncplan {

using state::BasicMoveOptions;
using state::MoveOptions;
using state::Synchronization;

/// What moves axes: a machine, or whatever has its axes with limits.
template <class M>
concept AxesMachine = requires(const M& machine) {
  requires std::floating_point<typename M::Scalar>;
  requires M::axis_count >= 1;
  { machine.axes[0] } -> std::convertible_to<const BasicAxis<typename M::Scalar>&>;
};

/// The limits of an axis, with those downwards that it leaves out.
template <std::floating_point S>
[[nodiscard]] constexpr BasicAxisLimits<S> motion_limits(const BasicAxis<S>& axis) {
  return {.velocity_up = axis.velocity,
          .velocity_down = axis.velocity_down == S(0) ? axis.velocity : axis.velocity_down,
          .acceleration_up = axis.acceleration,
          .acceleration_down = axis.acceleration_down == S(0) ? axis.acceleration : axis.acceleration_down,
          .jerk = axis.jerk,
          .low = axis.low,
          .high = axis.high};
}

/// The motions of N axes that start at one instant.
template <std::floating_point S, int N>
class BasicAxesMotion {
 public:
  using State = BasicAxisStates<S, N>;
  using Motions = std::array<state::BasicMotion<S>, static_cast<std::size_t>(N)>;

  constexpr BasicAxesMotion() = default;
  constexpr explicit BasicAxesMotion(const Motions& axes) : axes_(axes) {}

  /// Of the axis that moves longest.
  [[nodiscard]] constexpr S duration() const {
    S longest{};
    for (const auto& axis : axes_) longest = std::max(longest, axis.duration());
    return longest;
  }
  [[nodiscard]] constexpr const state::BasicMotion<S>& axis(std::size_t i) const { return axes_[i]; }
  /// To be made.
  [[nodiscard]] constexpr Motions& axes() { return axes_; }
  /// All axes at t; see `state::BasicMotion::at`.
  [[nodiscard]] constexpr State at(S t) const {
    State states;
    for (std::size_t i = 0; i < axes_.size(); ++i) states.set(i, axes_[i].at(t));
    return states;
  }

 private:
  Motions axes_{};
};

/// A motion with a clock: driven by `advance` from tick to tick, or asked at any time.
template <class Motion>
class Move : public Motion {
 public:
  using Scalar = std::remove_cvref_t<decltype(std::declval<const Motion&>().duration())>;

  constexpr Move() = default;
  constexpr explicit Move(const Motion& motion) : Motion(motion) {}

  constexpr void advance(Scalar seconds) { time_ += seconds; }
  [[nodiscard]] constexpr Scalar time() const { return time_; }
  [[nodiscard]] constexpr auto state() const { return this->at(time_); }
  [[nodiscard]] constexpr bool finished() const { return time_ >= this->duration(); }

 private:
  Scalar time_{};
};

template <std::floating_point S>
using BasicAxisMove = Move<state::BasicMotion<S>>;
template <std::floating_point S, int N>
using BasicAxesMove = Move<BasicAxesMotion<S, N>>;

namespace detail {

template <AxesMachine M>
using StatesOf = BasicAxisStates<typename M::Scalar, M::axis_count>;
template <AxesMachine M>
using MoveOf = BasicAxesMove<typename M::Scalar, M::axis_count>;
template <AxesMachine M>
using OptionsOf = BasicMoveOptions<typename M::Scalar>;

template <AxesMachine M>
[[nodiscard]] constexpr auto limits_of_axes(const M& machine) {
  std::array<BasicAxisLimits<typename M::Scalar>, static_cast<std::size_t>(M::axis_count)> limits{};
  for (std::size_t i = 0; i < limits.size(); ++i) limits[i] = cncplan::motion_limits(machine.axes[i]);
  return limits;
}

template <class Result, class Motions>
[[nodiscard]] Expected<Move<Result>> as_move(const Expected<Motions>& motions) {
  if (!motions) return tl::unexpected(motions.error());
  return Move<Result>(Result(*motions));
}

}  // namespace detail

/// The fastest motion of a machine's axes from one state to another, each axis in its own limits of velocity,
/// acceleration and jerk, together as the options say. The limits of the tool do not act here. A start beyond
/// the limits returns to them as fast as possible; a target in motion is met with its velocity and
/// acceleration. Errors name what is wrong: a limit, a number that is not finite, a target beyond the limits
/// or the travel, a start that cannot be stopped in the travel (with the position at which it would stop).
template <AxesMachine M, std::same_as<detail::StatesOf<M>> Target>
[[nodiscard]] Expected<detail::MoveOf<M>> move_to(const detail::StatesOf<M>& from, const Target& to,
                                                  const M& machine,
                                                  const detail::OptionsOf<M>& options = {}) {
  Expected<detail::MoveOf<M>> move;
  if (const auto ok = state::make_synchronized<typename M::Scalar, M::axis_count>(
          from, to, detail::limits_of_axes(machine), options, move->axes());
      !ok)
    move = tl::unexpected(ok.error());
  return move;
}

/// The same to positions at rest.
template <AxesMachine M>
[[nodiscard]] Expected<detail::MoveOf<M>> move_to(const detail::StatesOf<M>& from,
                                                  const typename detail::StatesOf<M>::Row& to,
                                                  const M& machine,
                                                  const detail::OptionsOf<M>& options = {}) {
  return move_to(from, detail::StatesOf<M>{.position = to}, machine, options);
}

/// Of one axis, in plain numbers.
template <std::floating_point S>
[[nodiscard]] Expected<BasicAxisMove<S>> move_to(
    const BasicAxisState<S>& from, const std::type_identity_t<BasicAxisState<S>>& to,
    const std::type_identity_t<BasicAxis<S>>& axis,
    const std::type_identity_t<BasicMoveOptions<S>>& options = {}) {
  Expected<BasicAxisMove<S>> move;
  if (const auto ok = state::make_move<S>(from, to, motion_limits(axis), options, *move); !ok)
    move = tl::unexpected(ok.error());
  return move;
}
template <std::floating_point S>
[[nodiscard]] Expected<BasicAxisMove<S>> move_to(
    const BasicAxisState<S>& from, std::type_identity_t<S> to, const std::type_identity_t<BasicAxis<S>>& axis,
    const std::type_identity_t<BasicMoveOptions<S>>& options = {}) {
  return move_to(from, BasicAxisState<S>{to, S(0), S(0)}, axis, options);
}

/// The fastest motion of a machine's axes to velocities, which they keep until they are told otherwise or
/// come to rest at the end of their travel; to zero, the fastest stop. Options and errors as of `move_to`.
template <AxesMachine M>
[[nodiscard]] Expected<detail::MoveOf<M>> reach_velocity(const detail::StatesOf<M>& from,
                                                         const typename detail::StatesOf<M>::Row& velocities,
                                                         const M& machine,
                                                         const detail::OptionsOf<M>& options = {}) {
  return detail::as_move<BasicAxesMotion<typename M::Scalar, M::axis_count>>(
      state::reach_velocities<typename M::Scalar, M::axis_count>(from, velocities,
                                                                 detail::limits_of_axes(machine), options));
}

/// Of one axis, in plain numbers.
template <std::floating_point S>
[[nodiscard]] Expected<BasicAxisMove<S>> reach_velocity(
    const BasicAxisState<S>& from, std::type_identity_t<S> velocity,
    const std::type_identity_t<BasicAxis<S>>& axis,
    const std::type_identity_t<BasicMoveOptions<S>>& options = {}) {
  BasicAxisStates<S, 1> start;
  start.set(0, from);
  const auto motions = state::reach_velocities<S, 1>(start, {velocity}, {motion_limits(axis)}, options);
  if (!motions) return tl::unexpected(motions.error());
  return BasicAxisMove<S>(motions->front());
}

}  // namespace cncplan
