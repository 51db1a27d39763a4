// The junction policy that the command line asks for: any of the library's, or several at once.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>

#include "cncplan/cncplan.hpp"

namespace simulate {

/// The minimum of the policies that are set. A junction policy of our own: it has `speed_sq`, and that is all
/// it takes.
struct JunctionChoice {
  std::optional<cncplan::junction::PublishedTable> table;
  std::optional<cncplan::junction::ExactStop> stop;
  std::optional<cncplan::junction::TangentStep> tangent;
  std::optional<cncplan::junction::Deviation> deviation;
  std::optional<cncplan::junction::AccelerationStep> acceleration_step;

  [[nodiscard]] double speed_sq(const cncplan::junction::Geometry& junction) const {
    double lowest = std::numeric_limits<double>::infinity();
    const auto consider = [&](const auto& policy) {
      if (policy) lowest = std::min(lowest, policy->speed_sq(junction));
    };
    consider(table);
    consider(stop);
    consider(tangent);
    consider(deviation);
    consider(acceleration_step);
    return lowest;
  }
};

/// `table`, `table-absolute`, `stop`, `tangent=MM/S`, `deviation=MM`, `acceleration-step=MM/S^2`, joined by
/// `+`. Throws `Failure` for anything else.
[[nodiscard]] JunctionChoice junction_choice(std::string_view text);

}  // namespace simulate
