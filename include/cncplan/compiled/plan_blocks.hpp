// Planning of blocks that the library `cncplan::compiled` has ready: included where that is used (set-up).
#pragma once

#include "cncplan/plan_blocks.hpp"

/// Planning and asking a trajectory of blocks of a type, at every level.
#define CNCPLAN_PLAN_BLOCKS(PREFIX, MACHINE, BLOCK)                                           \
  PREFIX template class Trajectory<MACHINE, BLOCK>;                                           \
  PREFIX template class StepEdges<Trajectory<MACHINE, BLOCK>>;                                \
  PREFIX template Expected<Trajectory<MACHINE, BLOCK>, ProgramError> detail::plan_own_blocks( \
      std::pmr::vector<BLOCK>&&, const MACHINE&, const PlanOptions&);

/// Its parts: look-ahead, and curves.
#define CNCPLAN_PLAN_LOOK_AHEAD(PREFIX, MACHINE, BLOCK)                                          \
  PREFIX template Expected<Trajectory<MACHINE, BLOCK>, ProgramError> detail::plan_by_look_ahead( \
      std::pmr::vector<BLOCK>&&, const MACHINE&, const PlanOptions&, const Progress&);

#define CNCPLAN_PLAN_SMOOTH(PREFIX, MACHINE, BLOCK)            \
  PREFIX template class detail::SmoothPlanner<MACHINE, BLOCK>; \
  PREFIX template class SmoothStream<MACHINE, BLOCK>;

#ifdef CNCPLAN_COMPILED
namespace cncplan {

CNCPLAN_PLAN_BLOCKS(extern, Machine<3>, Block<3>)
CNCPLAN_PLAN_LOOK_AHEAD(extern, Machine<3>, Block<3>)
CNCPLAN_PLAN_SMOOTH(extern, Machine<3>, Block<3>)
CNCPLAN_PLAN_BLOCKS(extern, Machine<6>, Block<6>)
CNCPLAN_PLAN_LOOK_AHEAD(extern, Machine<6>, Block<6>)
CNCPLAN_PLAN_SMOOTH(extern, Machine<6>, Block<6>)

}  // namespace cncplan
#endif
