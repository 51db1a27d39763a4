// Values of the axes of any machine.
#pragma once

#include <Eigen/Core>

#include "cncplan/gcode/motion.hpp"

namespace simulate {

/// One value for each axis; without heap.
using PerAxis = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, cncplan::gcode::max_axes, 1>;

}  // namespace simulate
