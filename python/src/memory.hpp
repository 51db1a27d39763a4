// The memory of plans and arrays, which the machine has to have.
#pragma once

#include <cstddef>
#include <memory_resource>

namespace cncplan::python {

/// Bytes that may still be taken: what Linux says is available, without a sixteenth of all memory.
/// As many as there can be where it says nothing.
[[nodiscard]] std::size_t available_memory();

/// Keeps so many bytes more out of that: for tests.
void leave_memory(std::size_t bytes);

/// The heap, which throws std::bad_alloc where `available_memory` gives out. Linux itself hands out more than
/// there is, and ends the process that uses it.
[[nodiscard]] std::pmr::memory_resource* guarded_memory();

}  // namespace cncplan::python
