// The types of one number of axes, and the steps from a program to a trajectory: each is compiled in a file
// of its own.
#pragma once

#include <memory>
#include <memory_resource>
#include <string>
#include <vector>

#include "cncplan/plan/block_builder.hpp"
#include "cncplan/plan/program_error.hpp"
#include "cncplan/plan/smooth_level.hpp"
#include "cncplan/plan/trajectory.hpp"
#include "interruption.hpp"
#include "trajectory.hpp"

namespace cncplan::python {

template <int N>
using ReadBlock = ProgramBlock<Machine<N>>;
/// A block of any level: where the plan is exact or fast, each stands for itself.
template <int N>
using PlannedBlock = plan::SmoothBlockOf<ReadBlock<N>>;
template <int N>
using Planned = Trajectory<Machine<N>, PlannedBlock<N>>;
template <int N>
using PlannedOrError = Expected<Planned<N>, ProgramError>;

/// The levels exact (tolerance 0) and fast.
template <int N>
[[nodiscard]] PlannedOrError<N> plan_fast(std::vector<ReadBlock<N>>&& blocks, const Machine<N>& machine,
                                          const PlanOptions& options, std::pmr::memory_resource* memory);
/// The levels good and best.
template <int N>
[[nodiscard]] PlannedOrError<N> plan_at(SmoothLevel level, const std::vector<ReadBlock<N>>& blocks,
                                        const Machine<N>& machine, const PlanOptions& options,
                                        std::pmr::memory_resource* memory);

template <int N>
[[nodiscard]] PlannedOrError<N> plan(Level level, std::vector<ReadBlock<N>>&& blocks,
                                     const Machine<N>& machine, PlanOptions options,
                                     std::pmr::memory_resource* memory) {
  if (level == Level::exact) options.tolerance = 0;
  if (level == Level::exact || level == Level::fast)
    return plan_fast<N>(std::move(blocks), machine, options, memory);
  return plan_at<N>(level == Level::good ? SmoothLevel::good : SmoothLevel::best, blocks, machine, options,
                    memory);
}

/// The trajectory for Python, with the memory that it lies in.
template <int N>
[[nodiscard]] TrajectoryPointer any_trajectory(std::unique_ptr<InterruptibleMemory> memory,
                                               Planned<N>&& trajectory);

/// The options that read a program for a machine.
[[nodiscard]] inline PlanOptions with_dialect(PlanOptions options, const AnyMachine& machine) {
  options.dialect = machine.dialect;
  return options;
}

/// A block as the library has it. Throws `Fault`.
template <int N>
[[nodiscard]] ReadBlock<N> block_of(const AnyBlock& block);

}  // namespace cncplan::python
