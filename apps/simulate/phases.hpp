// The motion along a program's cells as the options ask for it.
#pragma once

#include <memory_resource>

#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/detail/speed/motion_table.hpp"
#include "options.hpp"

namespace simulate {

using Phases = std::pmr::vector<cncplan::BasicPiecePhase<double>>;

/// What drives cells from end to end. Throws `Failure` for what cannot be planned.
[[nodiscard]] Phases phases_of(const Options& options, const cncplan::detail::BasicCells<double>& cells);

}  // namespace simulate
