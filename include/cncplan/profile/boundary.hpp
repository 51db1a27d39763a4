// The speeds at the two ends of a path.
#pragma once

#include <concepts>

namespace cncplan::profile {

/// mm/s, >= 0. The acceleration is zero at both ends.
template <std::floating_point S>
struct BasicBoundarySpeeds {
  S start{};
  S end{};

  friend bool operator==(const BasicBoundarySpeeds&, const BasicBoundarySpeeds&) = default;
};

using BoundarySpeeds = BasicBoundarySpeeds<double>;

}  // namespace cncplan::profile
