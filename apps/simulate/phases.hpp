// The motion along a program's cells as the options ask for it.
#pragma once

#include <memory_resource>

#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/detail/speed/motion_table.hpp"
#include "options.hpp"

namespace simulate {

/// What drives cells from end to end. Throws `Failure` for what cannot be planned.
[[nodiscard]] std::pmr::vector<cncplan::BasicPiecePhase<double>> phases_of(
    const Options& options, const cncplan::detail::BasicCells<double>& cells);

}  // namespace simulate
