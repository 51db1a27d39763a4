// Memory for containers in a buffer of the caller's (set-up).
#pragma once

#include "cncplan/core/compiler.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <memory_resource>
#include <new>
#include <span>

namespace cncplan {

/// Gives out a buffer in pieces, each from the first gap that is long enough, and takes them back: so plans
/// can be made without the heap. Where no gap is long enough, it throws std::bad_alloc. Alignments are 64 at
/// most. Sizes are rounded up to 64 bytes; a call takes time in proportion to the number of gaps. Not for two
/// threads at once.
class FixedMemory : public std::pmr::memory_resource {
 public:
  /// The buffer is to stay.
  explicit FixedMemory(std::span<std::byte> buffer) {
    void* start = buffer.data();
    std::size_t size = buffer.size();
    if (std::align(unit, unit, start, size) == nullptr) return;
    start_ = static_cast<std::byte*>(start);
    first_ = new (start_) Gap{size / unit * unit, nullptr};
  }
  FixedMemory(const FixedMemory&) = delete;
  FixedMemory& operator=(const FixedMemory&) = delete;

  /// Bytes of the buffer that have been used: a buffer of that size, aligned to 64, would have done.
  [[nodiscard]] std::size_t most_used() const { return most_used_; }

 private:
  static constexpr std::size_t unit = 64;

  // In the gap itself. In order of address, and no two touch.
  struct Gap {
    std::size_t size;
    Gap* next;

    [[nodiscard]] std::byte* begin() { return reinterpret_cast<std::byte*>(this); }
    [[nodiscard]] std::byte* end() { return begin() + size; }
  };

  // As so many bytes are taken from the buffer; 0 where that is more than can be counted.
  [[nodiscard]] static std::size_t rounded(std::size_t bytes) {
    return (std::max(bytes, std::size_t{1}) + (unit - 1)) / unit * unit;
  }

  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    const std::size_t size = rounded(bytes);
    if (alignment > unit || size < bytes) throw std::bad_alloc();
    Gap** link = &first_;
    while (*link != nullptr && (*link)->size < size) link = &(*link)->next;
    Gap* const gap = *link;
    if (gap == nullptr) throw std::bad_alloc();
    std::byte* const memory = gap->begin();
    *link = gap->size > size ? new (memory + size) Gap{gap->size - size, gap->next} : gap->next;
    most_used_ = std::max(most_used_, static_cast<std::size_t>(memory - start_) + size);
    return memory;
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t) override {
    Gap* before = nullptr;
    Gap* behind = first_;
    while (behind != nullptr && std::less<void*>{}(behind, memory)) {
      before = behind;
      behind = behind->next;
    }
    Gap* const gap = new (memory) Gap{rounded(bytes), behind};
    if (behind != nullptr && gap->end() == behind->begin()) {
      gap->size += behind->size;
      gap->next = behind->next;
    }
    if (before == nullptr) {
      first_ = gap;
    } else if (before->end() == gap->begin()) {
      before->size += gap->size;
      before->next = gap->next;
    } else {
      before->next = gap;
    }
  }
  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override {
    return this == &other;
  }

  std::byte* start_ = nullptr;
  Gap* first_ = nullptr;
  std::size_t most_used_ = 0;
};

}  // namespace cncplan
