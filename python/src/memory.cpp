#include "memory.hpp"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <limits>
#include <new>
#include <string>

namespace cncplan::python {

namespace {

std::atomic<std::size_t> left_over{0};

class GuardedMemory final : public std::pmr::memory_resource {
  // To ask for every piece would take long: once for so many bytes.
  static constexpr std::size_t step = std::size_t(64) << 20;

  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    if (bytes > step || untold_.fetch_add(bytes, std::memory_order_relaxed) > step) {
      untold_.store(0, std::memory_order_relaxed);
      if (available_memory() < std::max(bytes, step)) throw std::bad_alloc();
    }
    return heap_->allocate(bytes, alignment);
  }
  void do_deallocate(void* piece, std::size_t bytes, std::size_t alignment) override {
    heap_->deallocate(piece, bytes, alignment);
  }
  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override {
    return this == &other;
  }

  memory_resource* heap_ = std::pmr::new_delete_resource();
  std::atomic<std::size_t> untold_{0};
};

}  // namespace

std::size_t available_memory() {
  std::ifstream told("/proc/meminfo");
  std::string name, unit;
  std::size_t total = 0, available = std::numeric_limits<std::size_t>::max(), number = 0;
  while (told >> name >> number >> unit) {
    if (name == "MemTotal:") total = number * 1024;
    if (name == "MemAvailable:") available = number * 1024;
    if (name != "SwapFree:") continue;
    const std::size_t kept = total / 16 + left_over;
    available += number * 1024;
    return available > kept ? available - kept : 0;
  }
  return available;
}

void leave_memory(std::size_t bytes) { left_over = bytes; }

std::pmr::memory_resource* guarded_memory() {
  // Trajectories may be there longer than what is static.
  static GuardedMemory* const memory = new GuardedMemory;
  return memory;
}

}  // namespace cncplan::python
