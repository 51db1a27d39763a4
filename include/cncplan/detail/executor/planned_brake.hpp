// A brake along a trajectory that is proven when it is planned.
#pragma once

#include <concepts>

namespace cncplan::detail {

/// From the planned speed to rest. A hold that is asked for before its time has it at the latest.
template <std::floating_point S>
struct BasicPlannedBrake {
  S time{};      ///< s of the trajectory, when it begins; below 0 in the one before
  S duration{};  ///< s; 0 where the trajectory rests by itself
  S end{};       ///< s of the trajectory, where it comes to rest
  int level{};   ///< of the search for brakes, by which `TrajectoryClock` makes it again
};

}  // namespace cncplan::detail
