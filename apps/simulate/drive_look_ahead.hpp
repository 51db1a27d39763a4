// A program driven live on the exact path or at the level fast, with requests on the way.
#pragma once

#include <span>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/program_error.hpp"
#include "events.hpp"
#include "machine.hpp"
#include "options.hpp"
#include "phases.hpp"

namespace simulate {

/// A program's blocks, as they are programmed and as they are driven within the tolerance.
template <class M>
struct DrivenBlocks {
  std::span<const BlockOf<M>> programmed, driven;
};

/// Runs blocks by an executor, with a tick each period: nothing is known of the events before they come,
/// which is at their exact times, but how far the feed goes. It ends where the program does, where it is
/// stopped, or where it rests and nothing is to come. Errors: those of a block that cannot be planned. Throws
/// `Failure` for what does not end. Defined for each kind of machine beside its `live_machines`.
template <class M>
[[nodiscard]] cncplan::Expected<Phases, cncplan::ProgramError> drive_look_ahead(
    const Options& options, const M& machine, const DrivenBlocks<M>& blocks,
    const std::vector<Event>& events);

}  // namespace simulate
