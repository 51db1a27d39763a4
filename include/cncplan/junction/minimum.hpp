// Several junction policies at once: the lowest of their speeds.
#pragma once

#include <algorithm>
#include <limits>
#include <tuple>

#include "cncplan/junction/geometry.hpp"

namespace cncplan::junction {

/// The minimum of the policies it holds; no limit where it holds none.
template <class... Policies>
struct Minimum {
  std::tuple<Policies...> policies;

  template <std::floating_point S>
    requires(JunctionPolicy<Policies, S>&&...)
  [[nodiscard]] S speed_sq(const BasicGeometry<S>& junction) const {
    return std::apply(
        [&](const auto&... policy) {
          S lowest = std::numeric_limits<S>::infinity();
          ((lowest = std::min(lowest, policy.speed_sq(junction))), ...);
          return lowest;
        },
        policies);
  }
};

/// The minimum of the given policies.
template <class... Policies>
[[nodiscard]] constexpr Minimum<Policies...> minimum(const Policies&... policies) {
  return {{policies...}};
}

}  // namespace cncplan::junction
