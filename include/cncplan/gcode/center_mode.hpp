// The distance mode for the centres of arcs in which an arc that has no circle would have one.
#pragma once

#include <cmath>
#include <cstddef>
#include <string_view>

#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::gcode {

/// Of an arc by its centre whose start and end are not as far from it: "G90.1" where they are, but for a
/// thousandth, when I J K are places; "G91.1" where they are when I J K count from the start; else empty.
[[nodiscard]] inline std::string_view center_mode(const Motion& motion) {
  const PlaneAxes a = axes(motion.plane);
  const auto radius = [&](const Position& place, const Vector3& center) {
    return std::hypot(place[static_cast<std::size_t>(a.first)] - center[a.first],
                      place[static_cast<std::size_t>(a.second)] - center[a.second]);
  };
  const auto fits = [&](const Vector3& center) {
    const double start = radius(motion.start, center), end = radius(motion.end, center);
    return start > 0.0 && std::abs(start - end) <= 1e-3 * start;
  };
  const Vector3 start(motion.start[0], motion.start[1], motion.start[2]);
  if (fits(motion.center - start)) return "G90.1";
  return fits(motion.center + start) ? "G91.1" : "";
}

}  // namespace cncplan::gcode
