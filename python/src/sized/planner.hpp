// The planner for machines of the number SIZE of `SizedMachine`, at every level: defined by plan_blocks.cpp,
// look_ahead.cpp and smooth.cpp, by cncplan::compiled, or by cncplan_maps.
#pragma once

#include "cncplan/block_builder.hpp"
#include "cncplan/compiled/plan_blocks.hpp"

#if SIZE < 0
#include "maps/maps.hpp"
#else

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(extern, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)
CNCPLAN_PLAN_LOOK_AHEAD(extern, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)
CNCPLAN_PLAN_SMOOTH(extern, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)

}  // namespace cncplan

#endif
