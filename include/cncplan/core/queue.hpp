// A queue between two threads: one puts in, the other takes out, and neither ever waits.
#pragma once

#include "cncplan/core/compiler.hpp"

#include <array>
#include <atomic>
#include <bit>
#include <concepts>
#include <cstddef>
#include <utility>

namespace cncplan {

/// What a queue can hold.
template <class T>
concept QueueItem = std::movable<T> && std::default_initializable<T>;

/// Lock-free ring for one producer and one consumer, for blocks from the thread that plans to the one that
/// runs them, or requests. What was written before an item was pushed is seen by whoever takes it. No heap:
/// the room for `capacity` items, a power of two, is in the queue itself.
///
/// Each side owns one counter and reads the other's, only when its last look at it says full or empty; the
/// two sides' data lie on cache lines of their own.
template <QueueItem T, std::size_t capacity>
class Queue {
  static_assert(std::has_single_bit(capacity), "the capacity of a queue is a power of two");

 public:
  Queue() = default;
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  /// For the producer. False, and the item left as it was, when there is no room.
  template <class U>
    requires std::assignable_from<T&, U&&>
  bool push(U&& item) {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_seen_ == capacity) {
      head_seen_ = head_.load(std::memory_order_acquire);
      if (tail - head_seen_ == capacity) return false;
    }
    items_[tail % capacity] = std::forward<U>(item);
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// For the consumer: the oldest item, which stays; null when there is none.
  [[nodiscard]] T* front() {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_seen_) {
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head == tail_seen_) return nullptr;
    }
    return &items_[head % capacity];
  }
  /// For the consumer, only after `front` has shown an item: lets it go.
  void pop() { head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  /// How many there are, for either side: the other one may change it at any time.
  [[nodiscard]] std::size_t size() const {
    const std::size_t head = head_.load(std::memory_order_acquire);
    return tail_.load(std::memory_order_acquire) - head;
  }

 private:
  static constexpr std::size_t cache_line = 64;

  alignas(cache_line) std::atomic<std::size_t> tail_{0};  // pushed so far
  std::size_t head_seen_ = 0;
  alignas(cache_line) std::atomic<std::size_t> head_{0};  // taken so far
  std::size_t tail_seen_ = 0;
  alignas(cache_line) std::array<T, capacity> items_{};
};

}  // namespace cncplan
