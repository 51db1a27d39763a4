// Room in a vector before it is filled, so that what fills it cannot fail (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory_resource>
#include <vector>

namespace cncplan::detail {

/// Makes room for more items. It grows as a vector does that is pushed to.
template <class T>
void make_room(std::pmr::vector<T>& items, std::size_t more) {
  const std::size_t needed = items.size() + more;
  if (items.capacity() < needed) items.reserve(std::max(needed, 2 * items.capacity()));
}

}  // namespace cncplan::detail
