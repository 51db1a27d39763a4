// The motion along a program's cells as the options ask for it.
#pragma once

#include <memory_resource>
#include <vector>

#include "cncplan/detail/executor/motion_set_point.hpp"
#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/detail/speed/motion_table.hpp"
#include "events.hpp"
#include "options.hpp"

namespace simulate {

/// What drives cells from end to end. Throws `Failure` for what cannot be planned.
[[nodiscard]] std::pmr::vector<cncplan::BasicPiecePhase<double>> phases_of(
    const Options& options, const cncplan::detail::BasicCells<double>& cells);
/// The program played: nothing is known of the events before they come, but how far the feed goes. `blocks`:
/// the cells as a motion executor takes them. Throws `Failure` for what does not end.
[[nodiscard]] std::pmr::vector<cncplan::BasicPiecePhase<double>> simulated(
    const Options& options, const cncplan::detail::BasicCells<double>& cells,
    const std::vector<cncplan::detail::MotionBlock>& blocks, const std::vector<Event>& events);

}  // namespace simulate
