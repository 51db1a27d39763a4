// When each block runs and how fast: the spans of a plan seen block by block.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <span>

#include "cncplan/core/state.hpp"
#include "cncplan/plan/span.hpp"

namespace cncplan::plan {

/// One block of a plan.
template <std::floating_point S>
struct BasicBlockTiming {
  S start{};            ///< s from the start of the program
  S duration{};         ///< s, without a pause at its end
  S peak_velocity{};    ///< mm/s, the highest within it
  BasicState<S> entry;  ///< at its start; position: mm from the start of the span
  BasicState<S> exit;   ///< at its end, likewise

  friend bool operator==(const BasicBlockTiming&, const BasicBlockTiming&) = default;
};

using BlockTiming = BasicBlockTiming<double>;

/// Writes the timing of each block, in order.
template <std::floating_point S, std::output_iterator<BasicBlockTiming<S>> Out>
Out block_timings(std::span<const BasicSpan<S>> spans, std::span<const S> lengths, Out out) {
  S start = S(0);
  for (const BasicSpan<S>& span : spans) {
    const auto phases = span.profile.phases();
    S position = S(0);
    S time = S(0);
    BasicState<S> entry = span.profile.at(S(0));
    for (std::size_t i = span.first; i < span.first + span.count; ++i) {
      const bool last = i + 1 == span.first + span.count;
      position += lengths[i];
      const S until = last ? span.profile.duration() : span.profile.time_at(position);
      const BasicState<S> exit = span.profile.at(until);
      S peak = std::max(entry.velocity, exit.velocity);
      for (const auto& phase : phases)
        if (phase.time > time && phase.time < until) peak = std::max(peak, phase.velocity);
      *out++ = BasicBlockTiming<S>{start + time, until - time, peak, entry, exit};
      time = until;
      entry = exit;
    }
    start += span.profile.duration();
  }
  return out;
}

}  // namespace cncplan::plan
