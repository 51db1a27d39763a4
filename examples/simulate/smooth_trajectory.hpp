// The plan of a program by the level `good` or `best`.
#pragma once

#include "cncplan/core/error.hpp"
#include "cncplan/plan/program_error.hpp"
#include "cncplan/plan/smooth_level.hpp"
#include "cncplan/plan/trajectory.hpp"
#include "options.hpp"
#include "program_blocks.hpp"

namespace simulate {

/// A mill's blocks and pieces of them.
template <int N>
using Pieces = cncplan::Trajectory<Mill<N>, cncplan::plan::SmoothBlockOf<BlockOf<Mill<N>>>>;

/// Apart from what is made of it, for it takes long to compile.
template <int N>
[[nodiscard]] cncplan::Expected<Pieces<N>, cncplan::ProgramError> smooth_trajectory(
    const Options& options, const Mill<N>& machine, const Program<Mill<N>>& program);

}  // namespace simulate
