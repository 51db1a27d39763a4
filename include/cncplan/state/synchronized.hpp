// Several axes from states to states: each as fast as it can, or all arriving at one instant.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/state/detail/axis_motions.hpp"
#include "cncplan/state/detail/travel.hpp"
#include "cncplan/state/motion.hpp"
#include "cncplan/state/move_options.hpp"

namespace cncplan::state {

namespace detail {

/// What makes the motions of several axes.
template <std::floating_point S, int N>
class Synchronizer {
 public:
  static constexpr std::size_t axes = static_cast<std::size_t>(N);

  using States = BasicAxisStates<S, N>;
  using Limits = std::array<BasicAxisLimits<S>, axes>;
  using Motions = std::array<BasicMotion<S>, axes>;

  /// Of states and limits that are valid.
  Synchronizer(const States& from, const States& to, const Limits& limits, Motions& found)
      : Synchronizer(from, to, limits, found, std::make_index_sequence<axes>()) {}

  void make(const BasicMoveOptions<S>& options) {
    if (options.synchronization == Synchronization::none)
      apart(options.minimum_duration);
    else
      together(options);
  }

 private:
  template <std::size_t... i>
  Synchronizer(const States& from, const States& to, const Limits& limits, Motions& found,
               std::index_sequence<i...>)
      : from_(from),
        to_(to),
        limits_(limits),
        found_(found),
        motions_{BasicAxisMotions<S>(from.axis(i), to.axis(i), limits[i])...},
        first_{motions_[i].first()...} {}

  void apart(S least) {
    for (std::size_t i = 0; i < axes; ++i) {
      if (first_[i].duration < least)
        motions_[i].make(motions_[i].range(motions_[i].duration_from(least)), found_[i]);
      else
        motions_[i].make(first_[i], found_[i]);
    }
  }

  // Each round an axis moves the instant to its own next one; there are no more of those than of crossings.
  void together(const BasicMoveOptions<S>& options) {
    constexpr int rounds = 8 * N;
    S duration = options.minimum_duration;
    for (const auto& first : first_) duration = std::max(duration, first.duration);
    for (int round = 0; round < rounds; ++round) {
      S later = duration;
      for (std::size_t i = 0; i < axes; ++i) later = std::max(later, lasting(i, duration));
      if (later == duration) break;
      duration = later;
    }
    if (options.synchronization == Synchronization::phase) in_phase(duration);
  }

  // Makes the motion of one axis in a duration, or finds the next one that it can have.
  [[nodiscard]] S lasting(std::size_t i, S duration) {
    if (duration == first_[i].duration) {
      motions_[i].make(first_[i], found_[i]);
      return duration;
    }
    const auto range = motions_[i].range(duration);
    if (!range.possible)
      if (const S next = motions_[i].next_duration(duration); next != duration) return next;
    motions_[i].make(range, found_[i]);
    return duration;
  }

  // Where all axes can be driven in that duration by one motion along the line, that is made: its velocity is
  // 1 where an axis of the largest distance has one unit of velocity.
  void in_phase(S duration) {
    std::array<S, axes> way{};
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < axes; ++i) {
      way[i] = to_.position[i] - from_.position[i];
      if (std::abs(way[i]) > std::abs(way[farthest])) farthest = i;
    }
    if (way[farthest] == S(0)) return;
    const auto share = [&](std::size_t i) { return way[i] / way[farthest]; };
    const auto proportional = [&](const auto& row) {
      for (std::size_t i = 0; i < axes; ++i) {
        const S off = row[i] - share(i) * row[farthest];
        if (std::abs(off) > S(16) * std::numeric_limits<S>::epsilon() * std::abs(row[farthest])) return false;
      }
      return true;
    };
    if (!(proportional(from_.velocity) && proportional(from_.acceleration) && proportional(to_.velocity) &&
          proportional(to_.acceleration)))
      return;
    BasicAxisLimits<S> line{};
    for (std::size_t i = 0; i < axes; ++i) {
      const S size = std::abs(share(i));
      if (size == S(0)) continue;
      const BasicAxisLimits<S>& own = limits_[i];
      const bool same = share(i) > S(0);
      const auto lower = [&](S& least, S limit) { least = std::min(least, limit / size); };
      lower(line.velocity_up, same ? own.velocity_up : own.velocity_down);
      lower(line.velocity_down, same ? own.velocity_down : own.velocity_up);
      lower(line.acceleration_up, same ? own.acceleration_up : own.acceleration_down);
      lower(line.acceleration_down, same ? own.acceleration_down : own.acceleration_up);
      lower(line.jerk, own.jerk);
    }
    const auto along = axis_motions(from_.axis(farthest), to_.axis(farthest), line);
    if (!along) return;
    BasicMotion<S> motion = along->fastest();
    const S rounding = S(64) * std::numeric_limits<S>::epsilon() * duration;
    if (motion.duration() > duration + rounding) return;
    if (motion.duration() < duration - rounding) {
      if (along->duration_from(duration) != duration) return;
      motion = along->lasting(duration);
    }
    for (std::size_t i = 0; i < axes; ++i) {
      found_[i].reset(from_.axis(i), to_.axis(i));
      for (const auto& phase : motion.phases())
        found_[i].append(
            BasicJerkPhase<S>{phase.duration, share(i) * phase.acceleration, share(i) * phase.jerk});
    }
  }

  const States& from_;
  const States& to_;
  const Limits& limits_;
  Motions& found_;
  std::array<BasicAxisMotions<S>, axes> motions_;
  std::array<typename BasicAxisMotions<S>::Crossing, axes> first_;
};

}  // namespace detail

/// Makes the motions of all axes. Errors: those of `validate` and `within_travel`, and a minimum duration
/// that is negative or not finite. After a start beyond the limits, axes are in phase only if their return
/// is.
template <std::floating_point S, int N>
[[nodiscard]] Expected<void> make_synchronized(
    const BasicAxisStates<S, N>& from, const BasicAxisStates<S, N>& to,
    const std::array<BasicAxisLimits<S>, static_cast<std::size_t>(N)>& limits,
    const BasicMoveOptions<S>& options, std::array<BasicMotion<S>, static_cast<std::size_t>(N)>& motions) {
  if (auto ok = validate(options); !ok) return ok;
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (auto ok = validate(from.axis(i), to.axis(i), limits[i]); !ok) return ok;
  detail::Synchronizer<S, N>(from, to, limits, motions).make(options);
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (auto ok = within_travel(motions[i], limits[i]); !ok) return ok;
  return {};
}

}  // namespace cncplan::state
