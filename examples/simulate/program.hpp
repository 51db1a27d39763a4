// A G-code file as blocks that can be planned, with what the outputs say of each motion.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "machine.hpp"
#include "options.hpp"
#include "problems.hpp"

namespace simulate {

using cncplan::kinematics::TireMoldRow;

/// What a motion was in the text.
struct Origin {
  int line{};
  int column{};
  cncplan::Plane plane{};
  cncplan::Vector3 offset;  ///< machine = work + offset
  double feed{};            ///< mm/s as programmed; of a rapid the rapid rate
  double length{};          ///< mm along the path
};

/// There is always a block: a program without motion is one of length zero. Of a machine with a rotary table,
/// machine coordinates are those of the table, its axis at X0 Y0.
struct Program {
  std::string file;
  std::vector<cncplan::plan::Block> blocks;  ///< where rows are, straight between their ends
  std::vector<TireMoldRow> rows;             ///< of the four-axis machine, one a block; else none
  std::vector<Origin> origins;               ///< one a block
  std::size_t lines = 0;
  std::size_t warnings = 0;

  /// FILE:LINE:COLUMN of a block.
  [[nodiscard]] std::string place(std::size_t block) const;
};

/// Reads a program; warnings go to standard error. Text that is not understood and motions that cannot be
/// made or leave the machine's travel are problems: the program cannot be run where there is one. Throws
/// `Failure` for a file that cannot be read.
[[nodiscard]] Program read_program(const Options& options, const Machine& machine, Problems& problems);

}  // namespace simulate
