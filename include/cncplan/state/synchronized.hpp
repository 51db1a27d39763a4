// Several axes from states to states: each as fast as it can, or all arriving at one instant.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/state/axis_motions.hpp"
#include "cncplan/state/motion.hpp"
#include "cncplan/state/move_options.hpp"
#include "cncplan/state/travel.hpp"

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

  Synchronizer(const States& from, const States& to, const Limits& limits)
      : from_(from), to_(to), limits_(limits) {}

  [[nodiscard]] Expected<Motions> solve(const BasicMoveOptions<S>& options) {
    if (const auto ok = validate(options); !ok) return tl::unexpected(ok.error());
    for (std::size_t i = 0; i < axes; ++i) {
      const BasicAxisState<S> from = from_.axis(i), to = to_.axis(i);
      if (const auto ok = validate(from, to, limits_[i]); !ok) return tl::unexpected(ok.error());
      found_[i] = motions_[i].emplace(from, to, limits_[i]).fastest();
    }
    if (options.synchronization == Synchronization::none)
      delay(options.minimum_duration);
    else
      together(options);
    for (std::size_t i = 0; i < axes; ++i)
      if (auto ok = within_travel(found_[i], limits_[i]); !ok) return tl::unexpected(ok.error());
    return found_;
  }

 private:
  void delay(S least) {
    for (std::size_t i = 0; i < axes; ++i)
      if (found_[i].duration() < least) found_[i] = motions_[i]->lasting(motions_[i]->duration_from(least));
  }

  // Each round an axis moves the instant to its own next one; there are no more of those than of crossings.
  void together(const BasicMoveOptions<S>& options) {
    constexpr int rounds = 8 * N;
    S duration = options.minimum_duration;
    for (const auto& motion : found_) duration = std::max(duration, motion.duration());
    std::array<typename BasicAxisMotions<S>::Range, axes> ranges{};
    bool all = false;
    for (int round = 0; round < rounds && !all; ++round) {
      all = true;
      for (std::size_t i = 0; i < axes; ++i) {
        if (duration == found_[i].duration()) continue;
        ranges[i] = motions_[i]->range(duration);
        if (ranges[i].possible) continue;
        const S next = motions_[i]->next_duration(duration);
        if (next == duration) continue;
        duration = next;
        all = false;
      }
    }
    if (options.synchronization == Synchronization::phase && in_phase(duration)) return;
    for (std::size_t i = 0; i < axes; ++i)
      if (duration != found_[i].duration()) found_[i] = motions_[i]->within(ranges[i]);
  }

  // All axes by one motion along the line, whose velocity is 1 where an axis of the largest distance has one
  // unit of velocity.
  [[nodiscard]] bool in_phase(S duration) {
    std::array<S, axes> way{};
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < axes; ++i) {
      way[i] = to_.position[i] - from_.position[i];
      if (std::abs(way[i]) > std::abs(way[farthest])) farthest = i;
    }
    if (way[farthest] == S(0)) return false;
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
      return false;
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
    if (!along) return false;
    BasicMotion<S> motion = along->fastest();
    const S rounding = S(64) * std::numeric_limits<S>::epsilon() * duration;
    if (motion.duration() > duration + rounding) return false;
    if (motion.duration() < duration - rounding) {
      if (along->duration_from(duration) != duration) return false;
      motion = along->lasting(duration);
    }
    for (std::size_t i = 0; i < axes; ++i) {
      found_[i] = BasicMotion<S>(from_.axis(i), to_.axis(i));
      for (const auto& phase : motion.phases())
        found_[i].append({phase.duration, share(i) * phase.acceleration, share(i) * phase.jerk});
    }
    return true;
  }

  States from_;
  States to_;
  Limits limits_;
  std::array<std::optional<BasicAxisMotions<S>>, axes> motions_{};
  Motions found_{};
};

}  // namespace detail

/// The motions of all axes. Errors: those of `axis_motions` and `within_travel`, and a minimum duration that
/// is negative or not finite. After a start beyond the limits, axes are in phase only if their return is.
template <std::floating_point S, int N>
[[nodiscard]] Expected<std::array<BasicMotion<S>, static_cast<std::size_t>(N)>> synchronized(
    const BasicAxisStates<S, N>& from, const BasicAxisStates<S, N>& to,
    const std::array<BasicAxisLimits<S>, static_cast<std::size_t>(N)>& limits,
    const BasicMoveOptions<S>& options = {}) {
  return detail::Synchronizer<S, N>(from, to, limits).solve(options);
}

}  // namespace cncplan::state
