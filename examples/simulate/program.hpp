// A G-code file as blocks that can be planned, with what the outputs say of each motion.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "machine.hpp"

namespace simulate {

/// What a motion was in the text.
struct Origin {
  int line{};
  cncplan::Plane plane{};
  cncplan::Vector3 offset;  ///< machine = work + offset
  double feed{};            ///< mm/s as programmed; of a rapid the rapid rate
};

/// There is always a block: a program without motion is one of length zero.
struct Program {
  std::vector<cncplan::plan::Block> blocks;
  std::vector<Origin> origins;  ///< one a block
  std::size_t lines = 0;
  std::size_t warnings = 0;
};

/// Reads a program; warnings go to standard error. Throws `Failure` for a file that cannot be read, for text
/// that is not understood, and for motions that cannot be made or leave the machine's travel.
[[nodiscard]] Program read_program(const std::string& file, const Machine& machine,
                                   const cncplan::Limits& limits);

}  // namespace simulate
