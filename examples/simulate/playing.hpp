// A program run by a player, with requests on the way: what it does then, as phases.
#pragma once

#include <vector>

#include "cncplan/cncplan.hpp"
#include "events.hpp"
#include "support/plan.hpp"

namespace simulate {

/// Runs the pieces with a tick each period; requests come at their exact times. It ends where the program
/// does, where it is stopped, or where it rests and nothing is to come. Throws `Failure` for what takes too
/// many ticks.
[[nodiscard]] support::Plan play(const std::vector<cncplan::plan::PlayedBlock>& pieces,
                                 const std::vector<Event>& events, double period);

}  // namespace simulate
