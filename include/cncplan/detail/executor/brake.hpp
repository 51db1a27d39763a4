// The fastest way to rest where limits differ from place to place.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cncplan/detail/executor/running_profile.hpp"
#include "cncplan/detail/speed/segment_limits.hpp"

namespace cncplan::detail {

/// Brakes through zones of path, each with its own limits of acceleration and jerk, as hard as leaves a
/// way out: to release the brake at full jerk, such that the acceleration is within the limit of every
/// zone when it comes to it, and gone before the speed is.
///
///     acceleration  0 |\                         /
///                     | \              _________/     the second zone allows less, so the brake is
///                  -A |  \____________/               released before its border
///                           zone 1 | zone 2
///
/// A state with a way out is safe. From a safe state the brake is applied until the last instant that is
/// safe, which halving finds; then released, up to the border or to rest. What comes next depends on the
/// state alone, so each zone is worked out when it is entered.
template <std::floating_point S>
class BasicBrake {
 public:
  /// Of the segments only length and limits count, and of one with ramps inside the entry, which is its
  /// velocity. The first is what is left of the zone that the machine is in, and the last goes on for ever.
  explicit BasicBrake(std::span<const BasicSegmentLimits<S>> zones) : zones_(zones) {}

  /// Whether there is a way out of a state, to within rounding.
  [[nodiscard]] bool safe(const BasicState<S>& now) const {
    constexpr S rounding = std::max(S(1e-9), S(64) * exact);
    return -now.acceleration <= zones_[0].limits.acceleration * (S(1) + rounding) && safe(now, 0, rounding);
  }

  /// The motion from a safe state to the end of the first zone, or to rest.
  [[nodiscard]] BasicRunningProfile<S> profile(const BasicState<S>& from) const {
    const BasicLimits<S>& limits = zones_[0].limits;
    std::array<BasicPhase<S>, 3> phases{};
    std::size_t count = 0;
    BasicState<S> now{S(0), from.velocity, from.acceleration, S(0)};
    S time = S(0);
    const auto append = [&](BasicPhase<S> phase) {
      phase.time = time;
      time += phase.duration;
      now = phase.at(phase.duration);
      phases[count++] = phase;
    };
    for (const S jerk : {-limits.jerk, S(0)}) {
      const S lasts = jerk < S(0) ? (now.acceleration + limits.acceleration) / limits.jerk : infinity;
      if (!(lasts > S(0))) continue;
      Run harder = run(now, jerk, lasts, 0);
      const bool to_border = harder.ends == Ends::border;
      const bool whole = safe(harder.end(), to_border ? 1 : 0, exact);
      if (!whole) harder.phase.duration = last_safe(harder.phase);
      append(harder.phase);
      if (!whole) append(run(now, limits.jerk, -now.acceleration / limits.jerk, 0).phase);
      if (!whole || to_border) break;
    }
    return BasicRunningProfile<S>(std::span<const BasicPhase<S>>(phases.data(), count), now.position);
  }

 private:
  static constexpr S infinity = std::numeric_limits<S>::infinity();
  // But for rounding. What speed is missing at rest leaves the root of that in acceleration.
  static constexpr S exact = S(8) * std::numeric_limits<S>::epsilon();
  // A brake that is gone when the speed is but for this is gone: half the digits, as its last bit of speed
  // costs the root of that in acceleration.
  static constexpr S root_exact =
      S(1) / static_cast<S>(std::int64_t{1} << std::numeric_limits<S>::digits / 2);

  enum class Ends { in_time, at_rest, border };
  struct Run {
    BasicPhase<S> phase;
    Ends ends{};
    [[nodiscard]] BasicState<S> end() const { return phase.at(phase.duration); }
  };

  // A phase from a state, for so many seconds, but not beyond the zone that it is in and not backwards.
  // Positions count from the start of that zone.
  [[nodiscard]] Run run(const BasicState<S>& from, S jerk, S seconds, std::size_t zone) const {
    Run result{{S(0), seconds, from.position, from.velocity, from.acceleration, jerk}, Ends::in_time};
    const S square = from.acceleration * from.acceleration - S(2) * jerk * from.velocity;
    const S brakes = std::sqrt(std::max(square, S(0))) - from.acceleration;
    const bool stops = square > root_exact * from.acceleration * from.acceleration;
    if (stops && brakes > S(0) && S(2) * from.velocity < seconds * brakes) {
      result.phase.duration = S(2) * from.velocity / brakes;
      result.ends = Ends::at_rest;
    }
    if (zone + 1 < zones_.size() && result.end().position >= zones_[zone].length) {
      result.phase.duration = result.phase.tau_at(zones_[zone].length);
      result.ends = Ends::border;
    }
    return result;
  }

  // Whether the brake can be released from here on. A state that a run left at a border stands in the next
  // zone.
  [[nodiscard]] bool safe(BasicState<S> now, std::size_t zone, S rounding) const {
    for (;; ++zone) {
      const BasicLimits<S>& limits = zones_[zone].limits;
      if (zone > 0) {
        now.position = S(0);
        const BasicSegmentLimits<S>& own = zones_[zone];
        const S most = entry_acceleration<S>({own.entry, limits.acceleration, limits.jerk}, own.ramps_inside,
                                             now.velocity);
        if (-now.acceleration > most * (S(1) + rounding)) return false;
      }
      if (now.acceleration >= S(0)) return true;
      const S settled = now.velocity - now.acceleration * now.acceleration / (S(2) * limits.jerk);
      const Run release = run(now, limits.jerk, -now.acceleration / limits.jerk, zone);
      if (release.ends != Ends::border) return settled >= -rounding * (S(1) + now.velocity);
      now = release.end();
    }
  }

  // How long a phase in the first zone, whose end is not safe, can last.
  [[nodiscard]] S last_safe(const BasicPhase<S>& phase) const {
    S low = S(0);
    S high = phase.duration;
    for (int halving = 0; halving < std::numeric_limits<S>::digits; ++halving) {
      const S middle = low + (high - low) / S(2);
      if (!(middle > low && middle < high)) break;
      (safe(phase.at(middle), 0, exact) ? low : high) = middle;
    }
    return low;
  }

  std::span<const BasicSegmentLimits<S>> zones_;
};

}  // namespace cncplan::detail
