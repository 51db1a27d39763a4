// A plan asked at any time, in any order: binary search over its spans and blocks.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/plan/cursor.hpp"
#include "cncplan/plan/span.hpp"

namespace cncplan::plan {

/// Where a span begins.
template <std::floating_point S>
struct BasicSpanStart {
  S time{};    ///< s from the start of the program
  S length{};  ///< mm from the start of the program
};

using SpanStart = BasicSpanStart<double>;

/// Random access in O(log blocks). The room for the tables is the caller's: one entry a span, one a block.
template <std::floating_point S>
class BasicTimeline {
 public:
  using Scalar = S;

  /// Fills the tables, once. There is at least one span.
  BasicTimeline(std::span<const BasicSpan<S>> spans, std::span<const S> lengths,
                std::span<BasicSpanStart<S>> span_starts, std::span<S> block_starts)
      : spans_(spans), lengths_(lengths), span_starts_(span_starts), block_starts_(block_starts) {
    S time = S(0);
    S origin = S(0);
    for (std::size_t i = 0; i < spans.size(); ++i) {
      span_starts[i] = {time, origin};
      time += spans[i].profile.duration();
      origin += spans[i].profile.length();
      S within = S(0);
      for (std::size_t block = spans[i].first; block < spans[i].first + spans[i].count; ++block) {
        block_starts[block] = within;
        within += lengths[block];
      }
    }
    duration_ = time;
  }

  [[nodiscard]] S duration() const { return duration_; }

  /// The place at time t: what a cursor that walked there would give. Before the start, the start; after the
  /// end, the end.
  [[nodiscard]] BasicPlace<S> at(S t) const {
    const auto later = [](S time, const BasicSpanStart<S>& start) { return time < start.time; };
    const auto behind = std::upper_bound(span_starts_.begin() + 1, span_starts_.end(), t, later);
    const auto index = static_cast<std::size_t>(behind - span_starts_.begin()) - 1;
    const BasicSpan<S>& span = spans_[index];
    BasicState<S> state = span.profile.at(std::max(t - span_starts_[index].time, S(0)));
    const S within = state.position;
    state.position += span_starts_[index].length;
    if (span.count == 0) {
      const std::size_t block = span.first > 0 ? span.first - 1 : 0;
      return {block, lengths_[block], state};
    }
    const auto first = block_starts_.begin() + static_cast<std::ptrdiff_t>(span.first);
    const auto found = std::upper_bound(first + 1, first + static_cast<std::ptrdiff_t>(span.count), within);
    const auto block = static_cast<std::size_t>(found - block_starts_.begin()) - 1;
    const bool at_end = !(t < duration_);
    if (at_end) return {span.first + span.count - 1, lengths_[span.first + span.count - 1], state};
    return {block, std::min(within - block_starts_[block], lengths_[block]), state};
  }

 private:
  std::span<const BasicSpan<S>> spans_;
  std::span<const S> lengths_;
  std::span<const BasicSpanStart<S>> span_starts_;
  std::span<const S> block_starts_;
  S duration_{};
};

using Timeline = BasicTimeline<double>;

}  // namespace cncplan::plan
