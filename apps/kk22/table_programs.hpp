// Programs of the kinds that KK22 machined, as blocks.
#pragma once

#include <array>
#include <vector>

#include "cncplan/block_builder.hpp"
#include "generate/programs.hpp"

namespace kk22 {

/// Of a program in X, Y and Z.
using MillBlock = cncplan::ProgramBlock<cncplan::Machine<3>>;

/// Made from a fixed seed; X and Y as seen from a table's centre.
[[nodiscard]] std::vector<MillBlock> blocks_of(cncplan::generate::Kind kind,
                                               const std::array<double, 2>& table_center);

}  // namespace kk22
