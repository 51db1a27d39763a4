// A cursor through planned motion: where it is at times that do not decrease.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cncplan/core/state.hpp"
#include "cncplan/interpolate/travel.hpp"
#include "cncplan/plan/span.hpp"

namespace cncplan::plan {

/// A place in planned motion.
template <std::floating_point S>
struct BasicPlace {
  std::size_t block{};  ///< the block it lies in; during a pause the one before, at rest at its end
  S along{};            ///< mm from the block's start
  BasicState<S> state;  ///< position: mm from the start of the program

  friend bool operator==(const BasicPlace&, const BasicPlace&) = default;
};

using Place = BasicPlace<double>;

/// Walks spans and blocks in step with time: no search, no heap. Spans and block lengths belong to the
/// caller.
template <std::floating_point S>
class BasicCursor {
 public:
  using Scalar = S;

  BasicCursor(std::span<const BasicSpan<S>> spans, std::span<const S> lengths)
      : spans_(spans), lengths_(lengths) {
    if (!spans_.empty()) enter(0);
  }

  /// Start time of the current span.
  [[nodiscard]] S span_start() const { return start_; }

  /// The place at time t, for t that do not decrease; after the end, the end.
  [[nodiscard]] BasicPlace<S> at(S t) {
    if (spans_.empty()) return {};
    while (span_ + 1 < spans_.size() && t - start_ >= duration_) {
      start_ += duration_;
      origin_ += spans_[span_].profile.length();
      enter(span_ + 1);
    }
    const profile::BasicProfile<S>& profile = spans_[span_].profile;
    const S tau = t - start_;
    const std::size_t end = spans_[span_].first + spans_[span_].count;
    BasicState<S> state{profile.length(), profile.end_velocity(), S(0), S(0)};
    if (!(tau < duration_)) {  // at the very end of it all, whatever the sum of the lengths rounds to
      while (block_ + 1 < end) block_start_ += lengths_[block_++];
      state.position += origin_;
      return {block_, lengths_[block_], state};
    }
    while (phase_ + 1 < phases_.size() &&
           (tau >= phases_[phase_ + 1].time || phases_[phase_].duration == S(0)))
      ++phase_;
    state = phases_[phase_].at(std::max(tau - phases_[phase_].time, S(0)));
    while (block_ + 1 < end && state.position >= block_start_ + lengths_[block_])
      block_start_ += lengths_[block_++];
    const S along = spans_[span_].count == 0 ? lengths_[block_]
                                             : std::min(state.position - block_start_, lengths_[block_]);
    state.position += origin_;
    return {block_, along, state};
  }

  /// Distances from the block's start at the instants first, first + 1, ... times the period, for as long as
  /// phase and block stay the same: at least one, at most as many as `out` has room for. Returns the block
  /// and how many. Instants do not decrease from call to call.
  struct Run {
    std::size_t block{};
    std::size_t count{};
  };
  Run run(S period, std::int64_t first, std::span<S> out) {
    const BasicPlace<S> here = at(static_cast<S>(first) * period);
    out.front() = here.along;
    const S tau = static_cast<S>(first) * period - start_;
    if (spans_[span_].count == 0 || !(tau < duration_)) return {here.block, 1};
    const S until = phase_ + 1 < phases_.size() ? std::min(phases_[phase_ + 1].time, duration_) : duration_;
    const S by_time = (until - tau) / period;
    const S by_length = (lengths_[block_] - here.along) /
                        (std::max(here.state.velocity, std::numeric_limits<S>::min()) * period);
    const S most = std::min({by_time, by_length, static_cast<S>(out.size() - 1)});
    auto count = static_cast<std::size_t>(most) + 1;
    const auto in_phase = [&](std::size_t i) {
      return static_cast<S>(first + static_cast<std::int64_t>(i)) * period - start_ < until;
    };
    while (count > 1 && !in_phase(count - 1)) --count;
    interpolate::positions_in_phase(phases_[phase_], start_, block_start_, period, first, out.first(count));
    while (count > 1 && out[count - 1] >= lengths_[block_]) --count;
    return {here.block, count};
  }

 private:
  void enter(std::size_t span) {
    span_ = span;
    const BasicSpan<S>& entered = spans_[span];
    phases_ = entered.profile.phases();
    duration_ = entered.profile.duration();
    phase_ = 0;
    block_ = entered.count == 0 && entered.first > 0 ? entered.first - 1 : entered.first;
    block_start_ = S(0);
  }

  std::span<const BasicSpan<S>> spans_;
  std::span<const S> lengths_;
  std::array<BasicPhase<S>, profile::BasicProfile<S>::phase_count> phases_{};
  std::size_t span_ = 0;
  std::size_t phase_ = 0;
  std::size_t block_ = 0;
  S start_{};        // s, of the span
  S duration_{};     // s, of the span
  S origin_{};       // mm, of the span
  S block_start_{};  // mm from the span's start
};

using Cursor = BasicCursor<double>;

}  // namespace cncplan::plan
