// The tool and the axes of a report at one place of the path.
#pragma once

#include <Eigen/Core>

#include "cncplan/core/path_point.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::tools::report {

/// Tool X, Y, Z (machine coordinates, mm), then axes (mm or degrees).
using Channels = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 + gcode::max_axes, 1>;
using ChannelPoint = PathPoint<Channels>;

}  // namespace cncplan::tools::report
