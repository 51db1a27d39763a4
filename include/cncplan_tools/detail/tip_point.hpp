// The tip of the four-axis machine's tool, with its derivatives.
#pragma once

#include <array>

#include "cncplan/core/jet.hpp"
#include "cncplan/core/path_point.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"

namespace cncplan::tools::report {

/// Where the tip is and goes while the axes R, Z, A, C go as `axes`.
[[nodiscard]] inline PathPoint<Vector3> tip_point(double tool_length,
                                                  const PathPoint<VectorN<double, 4>>& axes) {
  std::array<Jet, 4> q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    q[i] = {axes.position[k], axes.first[k], axes.second[k], axes.third[k]};
  }
  const auto tip = kinematics::TireMold{.tool_length = tool_length}.tip(q);
  PathPoint<Vector3> point;
  for (std::size_t i = 0; i < tip.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    point.position[k] = tip[i].value;
    point.first[k] = tip[i].first;
    point.second[k] = tip[i].second;
    point.third[k] = tip[i].third;
  }
  return point;
}

}  // namespace cncplan::tools::report
