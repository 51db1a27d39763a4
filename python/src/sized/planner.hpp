// The planner for machines of AXES axes, at every level: defined by plan.cpp and smooth.cpp, or by
// cncplan::compiled.
#pragma once

#include "cncplan/compiled/plan_blocks.hpp"
#include "cncplan/plan/block_builder.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(extern, Machine<AXES>, ProgramBlock<Machine<AXES>>)
CNCPLAN_PLAN_LOOK_AHEAD(extern, Machine<AXES>, ProgramBlock<Machine<AXES>>)
CNCPLAN_PLAN_SMOOTH(extern, Machine<AXES>, ProgramBlock<Machine<AXES>>)

}  // namespace cncplan
