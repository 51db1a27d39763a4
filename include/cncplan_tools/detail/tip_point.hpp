// The tip of the four-axis machine's tool, with its derivatives.
#pragma once

#include "cncplan/core/path_jets.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"

namespace cncplan::tools::report {

/// Where the tip is and goes while the axes R, Z, A, C go as `axes`.
[[nodiscard]] inline PathPoint<Vector3> tip_point(double tool_length,
                                                  const PathPoint<VectorN<double, 4>>& axes) {
  return point_of(kinematics::TireMold{.tool_length = tool_length}.tip(jets_of(axes)));
}

}  // namespace cncplan::tools::report
