// What planned spans do, found by integrating their phases in long double and cutting them at the blocks.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "cncplan/detail/speed/segment_limits.hpp"
#include "cncplan/detail/speed/span.hpp"

namespace cncplan::test {

/// Worst of one plan. Excesses are relative to the limit they break; jumps between spans relative to the
/// limits of the blocks there.
struct PlanErrors {
  double cap{};           ///< speed at a junction above its cap
  double velocity{};      ///< speed within a block above its feed
  double acceleration{};  ///< above the limit of the block
  double jerk{};          ///< above the limit of the block
  double length{};        ///< of a span against its blocks, relative
  double speed_jump{};    ///< between spans
  double rest{};          ///< speed at the two ends, mm/s
  double backward{};      ///< speed below zero, relative
  int misplaced{};  ///< spans that do not begin where the last one ended; pauses that are not the blocks'

  void worst_of(const PlanErrors& other) {
    for (auto member :
         {&PlanErrors::cap, &PlanErrors::velocity, &PlanErrors::acceleration, &PlanErrors::jerk,
          &PlanErrors::length, &PlanErrors::speed_jump, &PlanErrors::rest, &PlanErrors::backward})
      this->*member = std::max(this->*member, other.*member);
    misplaced += other.misplaced;
  }
  [[nodiscard]] double worst() const {
    return std::max({cap, velocity, acceleration, jerk, length, speed_jump, rest, backward, 1.0 * misplaced});
  }
};

/// Constant jerk in long double.
struct ExactPhase {
  long double position, velocity, acceleration, jerk;

  [[nodiscard]] ExactPhase at(long double t) const {
    return {position + t * (velocity + t * (acceleration / 2 + t * jerk / 6)),
            velocity + t * (acceleration + t * jerk / 2), acceleration + t * jerk, jerk};
  }
};

namespace oracle {

// One span: cuts its phases where blocks meet and looks at both ends of each cut, and at tops within.
template <std::floating_point S>
void examine_span(std::span<const detail::BasicSegmentLimits<S>> blocks, const detail::BasicSpan<S>& span,
                  PlanErrors& errors) {
  const auto grow = [](double& worst, long double value) {
    worst = std::max(worst, static_cast<double>(value));
  };
  const auto phases = span.profile.phases();
  long double length = 0;
  for (std::size_t i = span.first; i < span.first + span.count; ++i) length += blocks[i].length;
  if (length > 0) grow(errors.length, std::abs(span.profile.length() / length - 1));
  // A place is known to rounding of the span's length; what the speed may change over that is allowed.
  const long double place = 8 * std::numeric_limits<S>::epsilon() * (length + 1e-3L);

  std::size_t block = span.first;
  long double block_end = blocks[block].length;
  const auto check = [&](const ExactPhase& x, S jerk) {
    const BasicLimits<S>& limits = blocks[block].limits;
    const long double slack = std::min(limits.acceleration * place / std::max(x.velocity, 1e-12L), 1e-3L);
    grow(errors.velocity, (x.velocity - slack) / limits.velocity - 1);
    grow(errors.backward, -(x.velocity + slack) / limits.velocity);
    grow(errors.acceleration, std::abs(x.acceleration) / limits.acceleration - 1);
    grow(errors.jerk, std::abs(static_cast<long double>(jerk)) / limits.jerk - 1);
  };
  ExactPhase x{0, span.profile.start_velocity(), span.profile.start_acceleration(), 0};
  grow(errors.cap, span.profile.start_velocity() - blocks[block].entry);
  for (const auto& phase : phases) {
    if (phase.duration == S(0)) continue;
    x.jerk = phase.jerk;
    long double left = phase.duration;
    for (;;) {
      const bool last = block + 1 == span.first + span.count;
      const bool cut = !last && x.at(left).position > block_end;
      long double until = left;
      if (cut) {
        long double low = 0, high = left;
        for (int halving = 0; halving < 70; ++halving) {
          const long double middle = (low + high) / 2;
          (x.at(middle).position < block_end ? low : high) = middle;
        }
        until = high;
      }
      check(x, phase.jerk);
      const long double top = x.jerk != 0 ? -x.acceleration / x.jerk : 0;
      if (top > 0 && top < until) check(x.at(top), phase.jerk);
      x = x.at(until);
      check(x, phase.jerk);
      left -= until;
      if (!cut) break;
      ++block;
      block_end += blocks[block].length;
      const long double slack =
          std::min(blocks[block].limits.acceleration * place / std::max(x.velocity, 1e-12L), 1e-3L);
      if (std::isfinite(blocks[block].entry))
        grow(errors.cap, (x.velocity - slack) / std::max<long double>(blocks[block].entry, 1e-9L) - 1);
    }
  }
  if (length > 0) grow(errors.length, std::abs(x.position / length - 1));
  grow(errors.speed_jump, std::abs(x.velocity - span.profile.end_velocity()) / blocks[block].limits.velocity);
  grow(errors.acceleration, std::abs(x.acceleration) / blocks[block].limits.acceleration - 1);
  grow(errors.speed_jump, std::abs(x.acceleration) / blocks[block].limits.acceleration);
}

}  // namespace oracle

/// Everything a plan must keep. That the acceleration is zero between spans is part of `speed_jump`.
template <std::floating_point S>
PlanErrors examine_plan(std::span<const detail::BasicSegmentLimits<S>> blocks,
                        const std::vector<detail::BasicSpan<S>>& spans) {
  PlanErrors errors;
  std::size_t next = 0;
  S speed = S(0);
  double pauses = 0.0, expected = 0.0;
  for (const auto& block : blocks) expected += block.pause;
  for (const auto& span : spans) {
    if (span.first != next) ++errors.misplaced;
    const double jump = std::abs(static_cast<double>(span.profile.start_velocity() - speed));
    if (span.count == 0) {
      errors.speed_jump = std::max(errors.speed_jump, jump);
      pauses += span.profile.duration();
      continue;
    }
    errors.speed_jump = std::max(errors.speed_jump, jump / blocks[next].limits.velocity);
    oracle::examine_span(blocks, span, errors);
    speed = span.profile.end_velocity();
    next += span.count;
  }
  if (next != blocks.size() || std::abs(pauses - expected) > 1e-6 * expected) ++errors.misplaced;
  errors.rest = std::abs(static_cast<double>(speed));
  return errors;
}

template <std::floating_point S>
double duration(const std::vector<detail::BasicSpan<S>>& spans) {
  long double sum = 0;
  for (const auto& span : spans) sum += span.profile.duration();
  return static_cast<double>(sum);
}

}  // namespace cncplan::test
