// A count that one thread raises and another one reads.
#pragma once

#include <atomic>
#include <cstdint>

namespace cncplan::detail {

/// A count of 64 bits in two words of 32, so that processors without atomic words of 64 bits have it too.
/// What was written before it was stored is seen by whoever has loaded it; neither waits.
///
/// The words have one bit in common: the count's bits 0 to 31, and those from 31 on. Whoever reads a high
/// word that is older or newer than the low one has the count all the same while they lie less than 2^30
/// apart: it is the one with that low word that is next to the middle of what the high word leaves open.
class SharedCount {
 public:
  /// For the one thread that counts.
  void store(std::int64_t count) {
    const auto bits = static_cast<std::uint64_t>(count);
    high_.store(static_cast<std::uint32_t>(bits >> 31), std::memory_order_relaxed);
    low_.store(static_cast<std::uint32_t>(bits), std::memory_order_release);
  }
  /// For all.
  [[nodiscard]] std::int64_t load() const {
    const std::uint32_t low = low_.load(std::memory_order_acquire);
    const std::uint64_t middle =
        (std::uint64_t{high_.load(std::memory_order_relaxed)} << 31) + (std::uint64_t{1} << 30);
    return static_cast<std::int64_t>(middle) +
           static_cast<std::int32_t>(low - static_cast<std::uint32_t>(middle));
  }

 private:
  std::atomic<std::uint32_t> high_{0};
  std::atomic<std::uint32_t> low_{0};
};

}  // namespace cncplan::detail
