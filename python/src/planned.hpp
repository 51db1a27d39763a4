// The types of one number of axes, and the steps from a program to a trajectory: each is compiled in a file
// of its own.
#pragma once

#include <string>
#include <vector>

#include "cncplan/block_builder.hpp"
#include "cncplan/program_error.hpp"
#include "cncplan/trajectory.hpp"
#include "cncplan_tools/report.hpp"
#include "trajectory.hpp"

namespace cncplan::python {

template <int N>
using ReadBlock = ProgramBlock<SizedMachine<N>>;
template <int N>
using Planned = Trajectory<SizedMachine<N>, ReadBlock<N>>;

/// The trajectory for Python.
template <int N>
[[nodiscard]] TrajectoryPointer any_trajectory(const AnyMachine& machine, Planned<N>&& trajectory);

/// What a report shows.
template <int N>
[[nodiscard]] tools::report::Report report_of(const Planned<N>& trajectory, const AnyMachine& machine,
                                              const tools::ReportText& text);

/// The options that read a program for a machine.
[[nodiscard]] inline PlanOptions with_dialect(PlanOptions options, const AnyMachine& machine) {
  options.dialect = machine.dialect;
  options.orientation = machine.file.map.orientation;
  return options;
}

/// A block as the library has it. Throws `Fault`.
template <int N>
[[nodiscard]] ReadBlock<N> block_of(const AnyBlock& block);

}  // namespace cncplan::python
