// A cursor through planned motion: where it is at times that do not decrease.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/state.hpp"
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
    BasicState<S> state{profile.length(), profile.end_velocity(), S(0), S(0)};
    if (tau < duration_) {
      while (phase_ + 1 < phases_.size() &&
             (tau >= phases_[phase_ + 1].time || phases_[phase_].duration == S(0)))
        ++phase_;
      state = phases_[phase_].at(std::max(tau - phases_[phase_].time, S(0)));
    }
    const std::size_t end = spans_[span_].first + spans_[span_].count;
    while (block_ + 1 < end && state.position >= block_start_ + lengths_[block_])
      block_start_ += lengths_[block_++];
    const S along = spans_[span_].count == 0 ? lengths_[block_]
                                             : std::min(state.position - block_start_, lengths_[block_]);
    state.position += origin_;
    return {block_, along, state};
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
