// What `mapped_motion` does, for the files that define it for one shape of maps each.
#pragma once

#include <utility>

#include "mapped_motion.hpp"
#include "maps/maps.hpp"
#include "planned_on.hpp"

namespace simulate {

template <class Map>
std::unique_ptr<Planned> mapped_motion(const support::Machine& file, MappedTrajectory<Map>&& trajectory) {
  using Machine = cncplan::MappedMachine<Map>;
  return std::make_unique<PlannedOn<Machine, cncplan::ProgramBlock<Machine>>>(file, std::move(trajectory));
}

}  // namespace simulate
