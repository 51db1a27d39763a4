// What the library `cncplan::compiled` has ready, for `double`: declared here, and defined in src/ (set-up).
#pragma once

#include <filesystem>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/plan/block_reader.hpp"
#include "cncplan/plan/executor.hpp"
#include "cncplan/plan/plan_blocks.hpp"
#include "cncplan/plan/plan_program.hpp"
#include "cncplan/plan/smooth_blocks.hpp"
#include "cncplan/plan/trajectory_executor.hpp"

// Each list declares instances with `extern` for PREFIX, and defines them with nothing for it.

/// Planning and asking a trajectory of blocks of a type.
#define CNCPLAN_PLAN_BLOCKS(PREFIX, MACHINE, BLOCK)                                         \
  PREFIX template class Trajectory<MACHINE, BLOCK>;                                         \
  PREFIX template class StepEdges<Trajectory<MACHINE, BLOCK>>;                              \
  PREFIX template Expected<Trajectory<MACHINE, BLOCK>, ProgramError> plan::plan_own_blocks( \
      std::pmr::vector<BLOCK>&&, const MACHINE&, const PlanOptions&);

/// The same at the levels good and best.
#define CNCPLAN_PLAN_SMOOTH(PREFIX, MACHINE, BLOCK)                      \
  PREFIX template class plan::SmoothPlanner<MACHINE, BLOCK>;             \
  PREFIX template class SmoothStream<MACHINE, BLOCK>;                    \
  PREFIX template class Trajectory<MACHINE, plan::SmoothBlockOf<BLOCK>>; \
  PREFIX template class StepEdges<Trajectory<MACHINE, plan::SmoothBlockOf<BLOCK>>>;

/// Running blocks of a type, whatever the capacity of the executor.
#define CNCPLAN_RUN_BLOCKS(PREFIX, MACHINE, BLOCK) PREFIX template class plan::ExecutorCore<MACHINE, BLOCK>;

/// Reading and planning programs.
#define CNCPLAN_PLAN_PROGRAM(PREFIX, MACHINE)                                                       \
  PREFIX template class BlockReader<MACHINE>;                                                       \
  PREFIX template Program<MACHINE> read_text(std::string_view, const MACHINE&, const PlanOptions&); \
  PREFIX template Program<MACHINE> read_file(const std::filesystem::path&, const MACHINE&,          \
                                             const PlanOptions&);                                   \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_program(  \
      const Program<MACHINE>&, const MACHINE&, const PlanOptions&);                                 \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_program(  \
      Program<MACHINE>&&, const MACHINE&, const PlanOptions&);                                      \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_text(     \
      std::string_view, const MACHINE&, const PlanOptions&);                                        \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_file(     \
      const std::filesystem::path&, const MACHINE&, const PlanOptions&);

#ifdef CNCPLAN_COMPILED
namespace cncplan {

CNCPLAN_PLAN_BLOCKS(extern, Machine<3>, ProgramBlock<Machine<3>>)
CNCPLAN_PLAN_BLOCKS(extern, Machine<3>, Block<3>)
CNCPLAN_RUN_BLOCKS(extern, Machine<3>, ProgramBlock<Machine<3>>)
CNCPLAN_RUN_BLOCKS(extern, Machine<3>, Block<3>)
CNCPLAN_PLAN_SMOOTH(extern, Machine<3>, ProgramBlock<Machine<3>>)
CNCPLAN_PLAN_SMOOTH(extern, Machine<3>, Block<3>)
CNCPLAN_PLAN_PROGRAM(extern, Machine<3>)

}  // namespace cncplan
#endif
