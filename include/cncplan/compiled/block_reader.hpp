// Readers of lines that the library `cncplan::compiled` has ready: included where that is used (set-up).
#pragma once

#include "cncplan/block_reader.hpp"

/// Reading lines as they come.
#define CNCPLAN_READ_BLOCKS(PREFIX, MACHINE) PREFIX template class BlockReader<MACHINE>;

#ifdef CNCPLAN_COMPILED
namespace cncplan {

CNCPLAN_READ_BLOCKS(extern, Machine<3>)
CNCPLAN_READ_BLOCKS(extern, Machine<6>)

}  // namespace cncplan
#endif
