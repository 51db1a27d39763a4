// Which lines of a program have another level of smoothing than was asked for.
#pragma once

#include <cstddef>
#include <vector>

#include "cncplan/fallback.hpp"

namespace support {

/// The `fallbacks` of a trajectory, from line to line of the program in place of blocks.
template <class T>
[[nodiscard]] std::vector<cncplan::Fallback> fallback_lines(const T& trajectory) {
  const auto blocks = trajectory.program();
  std::vector<cncplan::Fallback> result;
  for (cncplan::Fallback part : trajectory.fallbacks()) {
    for (std::size_t* place : {&part.first, &part.last})
      *place = static_cast<std::size_t>(blocks[*place].line);
    result.push_back(part);
  }
  return result;
}

}  // namespace support
