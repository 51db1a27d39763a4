// A list with room for a fixed number of items, all of it inside.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// Up to `room` items in order; no heap.
template <std::copyable T, std::size_t room>
class FixedList {
 public:
  using value_type = T;

  /// False, and nothing done, when there is no room.
  constexpr bool push_back(const T& item) {
    if (full()) return false;
    items_[size_++] = item;
    return true;
  }
  /// Only where it is not empty.
  constexpr void pop_back() { --size_; }
  constexpr void clear() { size_ = 0; }

  [[nodiscard]] constexpr std::size_t size() const { return size_; }
  [[nodiscard]] constexpr bool empty() const { return size_ == 0; }
  [[nodiscard]] constexpr bool full() const { return size_ == room; }
  [[nodiscard]] static constexpr std::size_t capacity() { return room; }
  [[nodiscard]] constexpr const T& operator[](std::size_t i) const { return items_[i]; }
  [[nodiscard]] constexpr const T* begin() const { return items_.data(); }
  [[nodiscard]] constexpr const T* end() const { return items_.data() + size_; }

 private:
  std::array<T, room> items_{};
  std::size_t size_ = 0;
};

}  // namespace cncplan
