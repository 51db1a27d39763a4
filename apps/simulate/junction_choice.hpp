// The junction policy that the command line asks for: any of the library's, or several at once.
#pragma once

#include <algorithm>
#include <limits>
#include <string_view>
#include <variant>
#include <vector>

#include "cncplan/junction/acceleration_step.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/junction/tangent_step.hpp"
#include "cncplan/published/junction_table.hpp"

namespace simulate {

using JunctionPolicy = std::variant<cncplan::published::JunctionTable, cncplan::junction::ExactStop,
                                    cncplan::junction::TangentStep, cncplan::junction::Deviation,
                                    cncplan::junction::AccelerationStep>;

/// The lowest of several policies. A junction policy of our own: it has `speed_sq`, and that is all it takes.
struct JunctionChoice {
  std::vector<JunctionPolicy> policies;

  [[nodiscard]] double speed_sq(const cncplan::junction::Geometry& junction) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const JunctionPolicy& policy : policies)
      lowest = std::min(lowest, std::visit([&](const auto& p) { return p.speed_sq(junction); }, policy));
    return lowest;
  }
};

/// `table`, `table-absolute`, `stop`, `tangent=MM/S`, `deviation=MM`, `acceleration-step=MM/S^2`, joined by
/// `+`. Throws `Failure` for anything else.
[[nodiscard]] JunctionChoice junction_choice(std::string_view text);

}  // namespace simulate
