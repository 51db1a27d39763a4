// Long calls can be interrupted: they ask from time to time whether a signal has come (Ctrl-C).
#pragma once

#include <chrono>
#include <cstddef>
#include <memory_resource>

namespace cncplan::python {

class Interruption {
 public:
  /// Throws the exception that a signal's handler raises. Most calls look at the clock only.
  void poll() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return;
    last_ = now;
    ask();
  }

 private:
  static void ask();

  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Memory whose use is what asks: planning asks for some at every step of its work. Nothing in the library
/// catches what it throws, but for std::bad_alloc.
class InterruptibleMemory final : public std::pmr::memory_resource {
 public:
  /// Asks no more.
  void stop_asking() { asks_ = false; }

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    if (asks_) interruption_.poll();
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* place, std::size_t bytes, std::size_t alignment) override {
    std::pmr::new_delete_resource()->deallocate(place, bytes, alignment);
  }
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }

  Interruption interruption_;
  bool asks_ = true;
};

}  // namespace cncplan::python
