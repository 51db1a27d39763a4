// Programs of the kinds that KK22 machined, as blocks.
#pragma once

#include <vector>

#include "cncplan/block_builder.hpp"
#include "generate/programs.hpp"

namespace kk22 {

/// Of a program in X, Y and Z.
using MillBlock = cncplan::ProgramBlock<cncplan::Machine<3>>;

/// Made from a fixed seed.
[[nodiscard]] std::vector<MillBlock> blocks_of(cncplan::generate::Kind kind);

}  // namespace kk22
