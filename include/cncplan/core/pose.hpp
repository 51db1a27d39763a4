// Where a tool is and which way it points.
#pragma once

#include "cncplan/core/vector.hpp"

namespace cncplan {

/// Tool tip and tool axis, in the coordinates of the workpiece.
template <std::floating_point S>
struct BasicPose {
  BasicVector3<S> position = BasicVector3<S>::Zero();    ///< of the tip, mm
  BasicVector3<S> direction = BasicVector3<S>::UnitZ();  ///< unit vector from the tip to the holder

  friend bool operator==(const BasicPose&, const BasicPose&) = default;
};

using Pose = BasicPose<double>;

}  // namespace cncplan
