// Exact stop (G61): every junction at rest.
#pragma once

#include "cncplan/junction/geometry.hpp"

namespace cncplan::junction {

/// The policy that stops at every junction.
struct ExactStop {
  template <std::floating_point S>
  [[nodiscard]] constexpr S speed_sq(const BasicGeometry<S>&) const {
    return S(0);
  }
};

}  // namespace cncplan::junction
