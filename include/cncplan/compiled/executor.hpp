// Executors that the library `cncplan::compiled` has ready: included where that is used (set-up).
#pragma once

#include "cncplan/executor.hpp"

/// Running blocks of a type, whatever the capacity of the executor.
#define CNCPLAN_RUN_BLOCKS(PREFIX, MACHINE, BLOCK) PREFIX template class ExecutorCore<MACHINE, BLOCK>;

#ifdef CNCPLAN_COMPILED
namespace cncplan {

CNCPLAN_RUN_BLOCKS(extern, Machine<3>, Block<3>)
CNCPLAN_RUN_BLOCKS(extern, Machine<6>, Block<6>)

}  // namespace cncplan
#endif
