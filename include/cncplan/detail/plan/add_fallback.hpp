// Lists the blocks that have another level of smoothing than was asked for.
#pragma once

#include <cstddef>

#include "cncplan/fallback.hpp"

namespace cncplan::detail {

/// Adds a block, which comes behind those that are listed, or is the last one: it stays as it is then. Blocks
/// one behind the other with the same level and reason are one entry.
template <class List>
void add_fallback(List& list, std::size_t block, SmoothLevel level, FallbackReason reason) {
  if (!list.empty() && list.back().last == block) return;
  if (!list.empty() && list.back().last + 1 == block && list.back().level == level &&
      list.back().reason == reason)
    list.back().last = block;
  else
    list.push_back({block, block, level, reason});
}

}  // namespace cncplan::detail
