// U09's two ways to spread the pulses of several axes over slots of equal time, as published.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>

#include "cncplan/core/error.hpp"

namespace cncplan::published {

/// One slot's output: bit i is set when axis i has a pulse, bit N + i while the axes are enabled. U09's port
/// image of three axes is xd = 1, yd = 2, zd = 4, xa = 8, ya = 16, za = 32.
using PulseWord = std::uint32_t;

/// Step counts as magnitudes; their signs are the direction signals' affair.
template <std::size_t N>
[[nodiscard]] constexpr std::array<std::uint64_t, N> magnitudes(const std::array<std::int64_t, N>& counts) {
  std::array<std::uint64_t, N> result{};
  for (std::size_t i = 0; i < N; ++i)
    result[i] = counts[i] < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(counts[i])
                              : static_cast<std::uint64_t>(counts[i]);
  return result;
}

/// Enable bits of N axes.
template <std::size_t N>
  requires(N > 0 && N <= 16)
inline constexpr PulseWord enabled_word = ((PulseWord{1} << N) - 1) << N;

/// Levels of each driver's other inputs (U09 section 4: enable, clock, cw/ccw and half/full of every driver).
template <std::size_t N>
struct DriverInputs {
  std::array<bool, N> enabled{};
  std::array<bool, N> half_steps{};
};

/// What a parallel port puts out in a slot, for all inputs of N drivers: clock in bits 0 to N-1 and enable in
/// bits N to 2N-1, as U09 prints them; then cw/ccw (set where the count is negative) and half/full (set for
/// half steps), whose bits it does not print. A driver that is not enabled has no clock.
template <std::size_t N>
  requires(N > 0 && N <= 8)
[[nodiscard]] constexpr std::uint32_t port_word(PulseWord pulses, const std::array<std::int64_t, N>& counts,
                                                const DriverInputs<N>& inputs) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const auto put = [&](bool level, std::size_t group) {
      word |= static_cast<std::uint32_t>(level) << (group * N + i);
    };
    put(inputs.enabled[i] && ((pulses >> i) & 1U) != 0, 0);
    put(inputs.enabled[i], 1);
    put(counts[i] < 0, 2);
    put(inputs.half_steps[i], 3);
  }
  return word;
}

/// Slots that the LCM method needs: the least common multiple of the counts, axes at rest left out; 0 if all
/// rest. An error where that does not fit 64 bits (its value is the product, as a floating-point number).
template <std::size_t N>
[[nodiscard]] constexpr Expected<std::uint64_t> lcm_slots(const std::array<std::int64_t, N>& counts) {
  constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t slots = 0;
  for (const std::uint64_t count : magnitudes(counts)) {
    if (count == 0) continue;
    const std::uint64_t factor = slots == 0 ? 1 : slots / std::gcd(slots, count);
    if (factor > largest / count)
      return tl::unexpected(Error{ErrorCode::above_limit, "least common multiple",
                                  static_cast<double>(factor) * static_cast<double>(count),
                                  static_cast<double>(largest)});
    slots = factor * count;
  }
  return slots;
}

/// U09 section 4, "EKOK": an axis with count n pulses every slots/n slots, from slot 1 on.
template <std::size_t N>
class LcmDistribution {
 public:
  [[nodiscard]] static constexpr Expected<LcmDistribution> make(const std::array<std::int64_t, N>& counts) {
    return lcm_slots(counts).map(
        [&](std::uint64_t slots) { return LcmDistribution(magnitudes(counts), slots); });
  }

  [[nodiscard]] constexpr std::uint64_t slots() const { return slots_; }

  /// The next slot's word, none behind the last.
  [[nodiscard]] constexpr std::optional<PulseWord> next() {
    if (slot_ == slots_) return std::nullopt;
    ++slot_;
    PulseWord word = enabled_word<N>;
    for (std::size_t i = 0; i < N; ++i) {
      const bool pulse = --wait_[i] == 0;
      word |= static_cast<PulseWord>(pulse) << i;
      wait_[i] = pulse ? interval_[i] : wait_[i];
    }
    return word;
  }

 private:
  constexpr LcmDistribution(const std::array<std::uint64_t, N>& counts, std::uint64_t slots) : slots_(slots) {
    for (std::size_t i = 0; i < N; ++i) {
      interval_[i] = counts[i] == 0 ? 0 : slots / counts[i];
      wait_[i] = counts[i] == 0 ? 0 : 1;  // counting down from 0 never gets back to it
    }
  }

  std::uint64_t slots_;
  std::uint64_t slot_ = 0;
  std::array<std::uint64_t, N> interval_{};
  std::array<std::uint64_t, N> wait_{};
};

/// U09 section 4, "EBMH": twice as many slots as the largest count. Axes with that count pulse in every other
/// slot, from slot 1 on; each other in slot 1, and when its accumulator, growing by its count in every slot
/// after that, exceeds the number of slots, which is then subtracted. That makes exactly its count.
template <std::size_t N>
class LargestAxisDistribution {
 public:
  /// An error where twice the largest count does not fit 63 bits.
  [[nodiscard]] static constexpr Expected<LargestAxisDistribution> make(
      const std::array<std::int64_t, N>& counts) {
    constexpr std::uint64_t bound = std::uint64_t{1} << 61;
    const auto sizes = magnitudes(counts);
    const std::uint64_t largest = *std::max_element(sizes.begin(), sizes.end());
    if (largest > bound)
      return tl::unexpected(Error{ErrorCode::above_limit, "step count", static_cast<double>(largest),
                                  static_cast<double>(bound)});
    return LargestAxisDistribution(sizes, 2 * largest);
  }

  [[nodiscard]] constexpr std::uint64_t slots() const { return slots_; }

  /// The next slot's word, none behind the last.
  [[nodiscard]] constexpr std::optional<PulseWord> next() {
    if (slot_ == slots_) return std::nullopt;
    PulseWord word = enabled_word<N>;
    for (std::size_t i = 0; i < N; ++i) {
      const bool largest = 2 * counts_[i] == slots_;
      const bool pulse = sum_[i] > slots_ || (largest && sum_[i] == slots_);
      word |= static_cast<PulseWord>(pulse) << i;
      sum_[i] += counts_[i] - (pulse ? slots_ : 0);
    }
    if (slot_++ == 0) sum_ = counts_;
    return word;
  }

 private:
  // In slot 1 every axis that moves pulses; the sums begin with slot 2.
  constexpr LargestAxisDistribution(const std::array<std::uint64_t, N>& counts, std::uint64_t slots)
      : counts_(counts), slots_(slots) {
    for (std::size_t i = 0; i < N; ++i) sum_[i] = counts[i] == 0 ? 0 : slots + 1;
  }

  std::array<std::uint64_t, N> counts_;
  std::uint64_t slots_;
  std::uint64_t slot_ = 0;
  std::array<std::uint64_t, N> sum_{};
};

}  // namespace cncplan::published
