// Proof that code keeps off the heap: every allocation of this program is counted, those of Eigen and of C
// included.
#pragma once

#include <concepts>
#include <cstddef>
#include <utility>

namespace cncplan::test {

/// How often this thread has asked for memory so far: operator new, malloc, calloc, realloc, aligned_alloc
/// and posix_memalign as called from this program's own code.
[[nodiscard]] std::size_t heap_allocations() noexcept;

/// How often it does so while `run` runs. CHECK(heap_allocations_of([&] { result = plan(block); }) == 0);
template <std::invocable F>
[[nodiscard]] std::size_t heap_allocations_of(F&& run) {
  const std::size_t before = heap_allocations();
  std::forward<F>(run)();
  return heap_allocations() - before;
}

}  // namespace cncplan::test
