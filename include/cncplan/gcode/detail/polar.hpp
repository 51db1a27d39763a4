// Polar coordinates of the XY plane: @ is the distance from the origin, ^ the angle from X in degrees.
#pragma once

#include <array>
#include <cmath>

#include "cncplan/gcode/detail/block.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/work_coordinates.hpp"

namespace cncplan::gcode {

[[nodiscard]] inline bool names_polar(const Block& block) { return (block.letters() & polar_words) != 0; }

/// X and Y that the words lead to from `here`, mm of work coordinates. What no word names stays; in
/// increments the words are added to where `here` is. `here` is not the origin, unless both are named in
/// absolute distances.
[[nodiscard]] inline std::array<double, 2> polar_target(const Block& block, const Modal& modal,
                                                        const Position& here) {
  double radius = std::hypot(here[0], here[1]), angle = std::atan2(here[1], here[0]);
  if (modal.incremental) {
    if (block.has('@')) radius += block.number('@') * modal.millimetres_per_unit;
    if (block.has('^')) angle += block.number('^') * radians_per_degree;
  } else {
    if (block.has('@')) radius = block.number('@') * modal.millimetres_per_unit;
    if (block.has('^')) angle = block.number('^') * radians_per_degree;
  }
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace cncplan::gcode
