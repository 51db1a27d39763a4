// All motions of one axis from a state to a state: the fastest, and those of a given duration.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <string_view>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/detail/transfer.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/state/detail/mean.hpp"
#include "cncplan/state/motion.hpp"

namespace cncplan::state {

/// A start, a target and limits, made ready to be solved. Made by `axis_motions`.
template <std::floating_point S>
class BasicAxisMotions {
 public:
  using Scalar = S;
  using State = BasicAxisState<S>;
  using Motion = BasicMotion<S>;

  BasicAxisMotions(const State& from, const State& to, const BasicAxisLimits<S>& limits)
      : from_(from), to_(to), transfer_(from, to, limits) {}

  /// The fastest motion, and when it ends. There always is one: from any state to rest, from there to rest
  /// elsewhere, and on to the target.
  using Crossing = typename BasicTransfer<S>::Crossing;
  [[nodiscard]] Crossing first() const { return transfer_.first(); }
  void make(const Crossing& crossing, Motion& motion) const {
    motion.reset(from_, to_);
    append(crossing.extremal, crossing.sign, motion);
  }
  [[nodiscard]] Motion fastest() const {
    Motion motion;
    make(first(), motion);
    return motion;
  }

  /// The shortest possible duration that is not below `least`.
  [[nodiscard]] S duration_from(S least) const {
    return range(least).possible ? least : next_duration(least);
  }
  /// The same of a duration that is not possible.
  [[nodiscard]] S next_duration(S least) const { return transfer_.first_from(least).duration; }

  /// The extremes of a duration.
  using Range = typename BasicTransfer<S>::Range;
  [[nodiscard]] Range range(S duration) const { return transfer_.lasting(duration); }

  /// The motion of a duration. If that is possible (see `duration_from`), it ends at the target: the mean of
  /// the two that get farthest, weighted so that it does.
  void make(const Range& range, Motion& motion) const {
    motion.reset(from_, to_);
    if (range.share == S(1)) return append(range.up, S(1), motion);
    if (range.share == S(0)) return append(range.down, S(-1), motion);
    const auto queue = [](const auto&... phases) { return BasicPhaseQueue<S>(phases...); };
    append_mean(transfer_.with_phases(range.up, S(1), queue), transfer_.with_phases(range.down, S(-1), queue),
                range.share, motion);
  }
  [[nodiscard]] Motion lasting(S duration) const {
    Motion motion;
    make(range(duration), motion);
    return motion;
  }

 private:
  void append(const BasicExtremal<S>& extremal, S sign, Motion& motion) const {
    transfer_.with_phases(extremal, sign, [&](const auto&... phases) { motion.append(phases...); });
  }

  State from_;
  State to_;
  BasicTransfer<S> transfer_;
};

/// Nothing if there are motions from a state to a target. Else what is wrong: limits that allow none, numbers
/// that are not finite, a target beyond the limits, or one whose acceleration comes from a velocity beyond.
template <std::floating_point S>
[[nodiscard]] Expected<void> validate(const BasicAxisState<S>& from, const BasicAxisState<S>& to,
                                      const BasicAxisLimits<S>& limits) {
  if (const auto ok = validate(limits); !ok) return ok;
  const S sum = from.position + from.velocity + from.acceleration;
  if (!std::isfinite(sum)) return refusal(ErrorCode::not_finite, "start", sum);
  const S end = to.position + to.velocity + to.acceleration;
  if (!std::isfinite(end)) return refusal(ErrorCode::not_finite, "target", end);
  if (to.acceleration <= limits.acceleration_up && to.acceleration >= -limits.acceleration_down &&
      settles_within(to.velocity, -to.acceleration, limits))
    return {};
  const S before = settled_velocity(BasicAxisState<S>{S(0), to.velocity, -to.acceleration}, limits.jerk);
  constexpr S room = S(1) + S(16) * std::numeric_limits<S>::epsilon();
  const auto within = [&](S value, S down, S up, std::string_view field) -> Expected<void> {
    if (value > up * room) return refusal(ErrorCode::above_limit, field, value, up);
    if (value < -down * room) return refusal(ErrorCode::below_limit, field, value, -down);
    return {};
  };
  if (const auto ok =
          within(to.acceleration, limits.acceleration_down, limits.acceleration_up, "target acceleration");
      !ok)
    return ok;
  if (const auto ok = within(to.velocity, limits.velocity_down, limits.velocity_up, "target velocity"); !ok)
    return ok;
  return within(before, limits.velocity_down, limits.velocity_up, "target acceleration");
}

/// The motions from a state to a target. Errors: see `validate`.
template <std::floating_point S>
[[nodiscard]] Expected<BasicAxisMotions<S>> axis_motions(const BasicAxisState<S>& from,
                                                         const BasicAxisState<S>& to,
                                                         const BasicAxisLimits<S>& limits) {
  if (const auto ok = validate(from, to, limits); !ok) return tl::unexpected(ok.error());
  return BasicAxisMotions<S>(from, to, limits);
}

}  // namespace cncplan::state
