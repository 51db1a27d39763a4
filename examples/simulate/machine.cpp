#include "machine.hpp"

#include <algorithm>
#include <cmath>

namespace simulate {

using namespace cncplan;

Limits limits_along(const Machine& machine, const plan::Block& block) {
  Limits limits = block.limits;
  const bool curved = block.segment.arc() != nullptr;
  // On an arc both the acceleration along the path and the one across it stay below this; at right angles to
  // each other, they add up to the axis' limit at most.
  const double shared = curved ? std::sqrt(2.0) : 1.0;
  const auto box = block.segment.box();
  for (int i = 0; i < static_cast<int>(machine.axes.size()); ++i) {
    const double share = curved ? 1.0 : std::abs(block.segment.start_tangent()[i]);
    if (box.low[i] == box.high[i] || share == 0.0) continue;
    const Limits& axis = machine.axes[static_cast<std::size_t>(i)].limits;
    limits.velocity = std::min(limits.velocity, axis.velocity / share);
    limits.acceleration = std::min(limits.acceleration, axis.acceleration / (share * shared));
    limits.jerk = std::min(limits.jerk, axis.jerk / share);
  }
  return limits;
}

}  // namespace simulate
