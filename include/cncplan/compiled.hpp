// What the library `cncplan::compiled` has ready, for `double`: declared here, and defined in src/ (set-up).
#pragma once

#include <string>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/plan/block_reader.hpp"
#include "cncplan/plan/executor.hpp"
#include "cncplan/plan/plan_blocks.hpp"
#include "cncplan/plan/plan_program.hpp"
#include "cncplan/plan/trajectory_executor.hpp"

// Each list declares instances with `extern` for PREFIX, and defines them with nothing for it.

/// Planning and asking a trajectory of blocks of a type, at every level.
#define CNCPLAN_PLAN_BLOCKS(PREFIX, MACHINE, BLOCK)                                         \
  PREFIX template class Trajectory<MACHINE, BLOCK>;                                         \
  PREFIX template class StepEdges<Trajectory<MACHINE, BLOCK>>;                              \
  PREFIX template Expected<Trajectory<MACHINE, BLOCK>, ProgramError> plan::plan_own_blocks( \
      std::pmr::vector<BLOCK>&&, const MACHINE&, const PlanOptions&);

/// Its parts: look-ahead, and curves.
#define CNCPLAN_PLAN_LOOK_AHEAD(PREFIX, MACHINE, BLOCK)                                        \
  PREFIX template Expected<Trajectory<MACHINE, BLOCK>, ProgramError> plan::plan_by_look_ahead( \
      std::pmr::vector<BLOCK>&&, const MACHINE&, const PlanOptions&);
#define CNCPLAN_PLAN_SMOOTH(PREFIX, MACHINE, BLOCK)          \
  PREFIX template class plan::SmoothPlanner<MACHINE, BLOCK>; \
  PREFIX template class SmoothStream<MACHINE, BLOCK>;

/// Running blocks of a type, whatever the capacity of the executor.
#define CNCPLAN_RUN_BLOCKS(PREFIX, MACHINE, BLOCK) PREFIX template class plan::ExecutorCore<MACHINE, BLOCK>;

/// Reading and planning programs.
#define CNCPLAN_PLAN_PROGRAM(PREFIX, MACHINE)                                                         \
  PREFIX template class BlockReader<MACHINE>;                                                         \
  PREFIX template Program<MACHINE> read_text(std::string_view, const MACHINE&, const PlanOptions&);   \
  PREFIX template Program<MACHINE> read_file(const std::string&, const MACHINE&, const PlanOptions&); \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_program(    \
      const Program<MACHINE>&, const MACHINE&, const PlanOptions&);                                   \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_program(    \
      Program<MACHINE>&&, const MACHINE&, const PlanOptions&);                                        \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_text(       \
      std::string_view, const MACHINE&, const PlanOptions&);                                          \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_file(       \
      const std::string&, const MACHINE&, const PlanOptions&);

/// All of these for a machine and the blocks of its programs.
#define CNCPLAN_MACHINE(PREFIX, MACHINE)                          \
  CNCPLAN_PLAN_BLOCKS(PREFIX, MACHINE, ProgramBlock<MACHINE>)     \
  CNCPLAN_PLAN_LOOK_AHEAD(PREFIX, MACHINE, ProgramBlock<MACHINE>) \
  CNCPLAN_PLAN_SMOOTH(PREFIX, MACHINE, ProgramBlock<MACHINE>)     \
  CNCPLAN_RUN_BLOCKS(PREFIX, MACHINE, ProgramBlock<MACHINE>)      \
  CNCPLAN_PLAN_PROGRAM(PREFIX, MACHINE)

#ifdef CNCPLAN_COMPILED
namespace cncplan {

CNCPLAN_MACHINE(extern, Machine<3>)
CNCPLAN_MACHINE(extern, Machine<6>)

}  // namespace cncplan
#endif
