// A trajectory of a machine behind a map as a planned program.
#pragma once

#include <memory>

#include "cncplan/block_builder.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/trajectory.hpp"
#include "planned.hpp"
#include "support/machine_file.hpp"

namespace simulate {

template <class Map>
using MappedTrajectory =
    cncplan::Trajectory<cncplan::MappedMachine<Map>, cncplan::ProgramBlock<cncplan::MappedMachine<Map>>>;

/// `file` outlives it. Each shape of maps has a file of its own, as it takes long to compile.
template <class Map>
[[nodiscard]] std::unique_ptr<Planned> mapped_motion(const support::Machine& file,
                                                     MappedTrajectory<Map>&& trajectory);

}  // namespace simulate
