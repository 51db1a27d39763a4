// How the clock of a trajectory changes its rate: by time, or as a brake of the axes along their path has it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "cncplan/core/phase.hpp"
#include "cncplan/core/state.hpp"
#include "cncplan/detail/executor/trajectory_chain.hpp"
#include "cncplan/state/motion.hpp"

namespace cncplan::detail {

/// The phases of a chain by the length of their path, as if they were driven at 1 mm/s. They are asked for in
/// their order.
template <MachineModel M, BlockModel B>
class PhasesByLength {
 public:
  using S = typename M::Scalar;
  using Chain = TrajectoryChain<M, B>;

  PhasesByLength() = default;
  /// From one of them on, which begins at so many mm.
  PhasesByLength(const Chain& chain, std::size_t index, S start)
      : chain_(&chain), index_(index), start_(start) {}

  [[nodiscard]] BasicPhase<S> phase(std::size_t index) {
    for (; index_ < index; ++index_) start_ += length();
    return {start_, length(), chain_->phase(index_).position, S(1), S(0), S(0)};
  }
  [[nodiscard]] typename Chain::DrivenPath path(std::size_t index) const { return chain_->path(index); }

  /// Goes on to the one that a length lies in, or to the last; which one that is, and where it begins.
  std::size_t go_to(S length_there) {
    for (S own = length(); index_ < chain_->last_phase() && !(length_there < start_ + own); own = length()) {
      start_ += own;
      ++index_;
    }
    return index_;
  }
  [[nodiscard]] S start() const { return start_; }
  [[nodiscard]] std::size_t index() const { return index_; }

 private:
  [[nodiscard]] S length() const {
    const BasicPhase<S> phase = chain_->phase(index_);
    return std::max(phase.at(phase.duration).position - phase.position, S(0));
  }

  const Chain* chain_ = nullptr;
  std::size_t index_{};
  S start_{};  // mm
};

/// A change of the rate of a clock that shows the time of a chain. By time, its motion is that of the clock.
/// Along the path, its motion is that of the axes, mm, and the clock shows when the chain is where they are:
/// a brake that need not slow all that is planned in the same measure, so it is sooner at rest.
template <MachineModel M, BlockModel B>
class ClockRamp {
 public:
  using S = typename M::Scalar;
  using Chain = TrajectoryChain<M, B>;
  using Motion = state::BasicMotion<S, 48>;

  ClockRamp() = default;
  explicit ClockRamp(const state::BasicMotion<S>& by_time) : motion_(by_time) {}
  /// From mm behind the start of a phase on.
  ClockRamp(const Motion& brake, std::size_t phase) : motion_(brake), along_path_(true), phase_(phase) {}

  [[nodiscard]] const Motion& motion() const { return motion_; }
  [[nodiscard]] S duration() const { return motion_.duration(); }
  /// Whether the axes come to rest with it, and then stay.
  [[nodiscard]] bool ends_at_rest() const { return motion_.end().velocity == S(0); }
  [[nodiscard]] bool runs_back() const {
    return motion_.start().velocity < S(0) || motion_.end().velocity < S(0);
  }

  /// The clock, some seconds after it began.
  [[nodiscard]] BasicState<S> at(const Chain& chain, S elapsed) const {
    const BasicState<S> own = motion_at(elapsed);
    if (!along_path_) return own;
    PhasesByLength<M, B> phases(chain, phase_, start_);
    const BasicPhase<S> planned = chain.phase(phases.go_to(own.position));
    const S tau = std::clamp(planned.tau_at(planned.position + (own.position - phases.start())), S(0),
                             planned.duration);
    return clock_of(own, planned.at(tau), planned.time + tau);
  }
  /// Seconds from its start to where the clock shows a time that it comes to; none if it does not.
  [[nodiscard]] std::optional<S> time_to(const Chain& chain, S shown) const {
    const BasicAxisState<S>& end = motion_.end();
    S place = shown;
    if (along_path_) {
      const std::size_t index = chain.phase_at(shown);
      PhasesByLength<M, B> phases(chain, phase_, start_);
      if (index < phase_ || index > PhasesByLength<M, B>(phases).go_to(end.position)) return std::nullopt;
      const BasicPhase<S> planned = chain.phase(index);
      const S within = std::clamp(shown - planned.time, S(0), planned.duration);
      place = phases.phase(index).time + (planned.at(within).position - planned.position);
    }
    if (runs_back() ? place >= end.position : place <= end.position)
      if (const auto at = motion_.time_at(place)) return *at;
    if (along_path_ || end.velocity == S(0)) return std::nullopt;
    return duration() + (place - end.position) / end.velocity;
  }

  /// The same way at a share of all its speeds, above 0: it keeps the limits that it kept, if that is at
  /// most 1.
  [[nodiscard]] ClockRamp at_share(S share) const {
    const S square = share * share;
    const auto slowed = [&](const BasicAxisState<S>& state) {
      return BasicAxisState<S>{state.position, share * state.velocity, square * state.acceleration};
    };
    Motion motion(slowed(motion_.start()), slowed(motion_.end()));
    for (const auto& phase : motion_.phases())
      motion.append({phase.duration / share, square * phase.acceleration, square * share * phase.jerk});
    ClockRamp result = *this;
    result.motion_ = motion;
    return result;
  }

  /// It is not asked for times before some seconds any more; whether that changes it.
  bool go_on(const Chain& chain, S elapsed) {
    if (!along_path_) return false;
    PhasesByLength<M, B> phases(chain, phase_, start_);
    phase_ = phases.go_to(motion_.at(elapsed).position);
    start_ = phases.start();
    return true;
  }

  /// The clock that shows a time at which the planned motion is at the place of the axes.
  [[nodiscard]] static BasicState<S> clock_of(const BasicState<S>& axes, const BasicState<S>& planned,
                                              S shown) {
    const S speed = planned.velocity;
    if (!(speed > S(0))) return {shown, S(0), S(0), S(0)};
    const S rate = axes.velocity / speed;
    const S change = (axes.acceleration - planned.acceleration * rate * rate) / speed;
    return {shown, rate, change,
            (axes.jerk - planned.jerk * rate * rate * rate - S(3) * planned.acceleration * rate * change) /
                speed};
  }

 private:
  [[nodiscard]] BasicState<S> motion_at(S elapsed) const {
    const BasicAxisState<S> now = motion_.at(elapsed);
    return {now.position, now.velocity, now.acceleration, motion_.jerk_at(elapsed)};
  }

  Motion motion_;
  bool along_path_ = false;
  std::size_t phase_{};  // in which it is, and the mm at which that begins
  S start_{};
};

}  // namespace cncplan::detail
