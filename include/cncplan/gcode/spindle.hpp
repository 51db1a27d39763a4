// The spindle, as far as a program tells of it: its speed makes feeds of feeds per revolution.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "cncplan/gcode/block.hpp"
#include "cncplan/gcode/modal.hpp"

namespace cncplan::gcode {

struct Spindle {
  int direction = 5;                    ///< M3, M4 or M5
  std::optional<double> speed{};        ///< S
  std::optional<double> surface_speed;  ///< G96, mm per minute
  double fastest{};                     ///< revolutions per minute, under G96

  /// G96 D S: the surface speed S, m/min (feet per minute in inches), at D revolutions per minute at most;
  /// G97: S is revolutions per minute.
  void select_mode(const Block& block, double millimetres_per_unit) {
    surface_speed.reset();
    if (block.code(Group::spindle_mode) == code(97)) return;
    surface_speed = block.number('S') * (millimetres_per_unit != 1.0 ? 304.8 : 1000.0);
    fastest = block.has('D') ? block.number('D') : std::numeric_limits<double>::infinity();
  }

  /// mm/s of a feed per revolution. Under G96 it is the lowest of the motion, at the end that is farther from
  /// the axis (`radius`); none at the axis itself without D.
  [[nodiscard]] std::optional<double> feed(double per_revolution, double radius) const {
    double per_minute = speed.value_or(0.0);
    if (surface_speed) per_minute = std::min(fastest, *surface_speed / (2.0 * std::numbers::pi * radius));
    const double feed = per_revolution * per_minute / 60.0;
    return std::isfinite(feed) ? std::optional<double>(feed) : std::nullopt;
  }
};

}  // namespace cncplan::gcode
