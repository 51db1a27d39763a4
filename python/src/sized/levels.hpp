// What drives an executor of SIZE axes at the levels good and best: defined by levels.cpp.
#pragma once

#include "cncplan/compiled/executor_levels.hpp"
#include "planner.hpp"

namespace cncplan {

CNCPLAN_RUN_LEVELS(extern, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)

}  // namespace cncplan
