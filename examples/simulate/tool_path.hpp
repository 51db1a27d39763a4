// Where a program goes in space.
#pragma once

#include "cncplan/path/segment.hpp"
#include "cncplan/path/spline.hpp"

namespace simulate {

using ToolPath = cncplan::path::Segment<3, cncplan::path::Spline<3>>;

}  // namespace simulate
