// Drivers of the levels `good` and `best` that the library `cncplan::compiled` has ready (set-up).
// They are included where they are used.
#pragma once

#include "cncplan/executor_levels.hpp"

/// Running blocks of a type at these levels, whatever the capacity of the executor.
#define CNCPLAN_RUN_LEVELS(PREFIX, MACHINE, BLOCK)          \
  PREFIX template class detail::LiveDriver<MACHINE, BLOCK>; \
  PREFIX template struct detail::ExecutorLevels<MACHINE, BLOCK>;

#ifdef CNCPLAN_COMPILED
namespace cncplan {

CNCPLAN_RUN_LEVELS(extern, Machine<3>, Block<3>)
CNCPLAN_RUN_LEVELS(extern, Machine<6>, Block<6>)

}  // namespace cncplan
#endif
