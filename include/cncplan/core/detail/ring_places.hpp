// Where things that are numbered one after another lie in a ring.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cncplan/core/compiler.hpp"

namespace cncplan::detail {

/// The places of numbers in memory for `size` of them, without a division, which would take longer than all
/// else in a tick.
class RingPlaces {
 public:
  explicit RingPlaces(std::size_t size) : size_(static_cast<std::int64_t>(size)) {}

  [[nodiscard]] std::int64_t size() const { return size_; }
  /// Numbers begin anew, at the start of the memory.
  void restart(std::int64_t number) { first_ = number; }
  /// Numbers before this one are not asked for any more. It rises by no more than `size` at a time.
  void advance(std::int64_t oldest) {
    if (oldest - first_ >= size_) first_ += size_;
  }
  /// The place of a number from the oldest on, one of `size` that follow each other.
  [[nodiscard]] std::size_t operator()(std::int64_t number) const {
    const std::int64_t place = number - first_;
    return static_cast<std::size_t>(place < size_ ? place : place - size_);
  }

 private:
  std::int64_t size_;
  std::int64_t first_ = 0;  // the last number at the start of the memory that is not above the oldest
};

}  // namespace cncplan::detail
