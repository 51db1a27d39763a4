// The spindle, as far as a program tells of it: its speed makes feeds of feeds per revolution.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/detail/block.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/detail/rules.hpp"

namespace cncplan::gcode {

struct Spindle {
  int direction = 5;                      ///< M3, M4 or M5
  std::optional<double> speed{};          ///< S
  std::optional<double> surface_speed{};  ///< G96, mm per minute
  double fastest{};                       ///< revolutions per minute, under G96

  /// What a line says of it: S, M3 to M5, M19, G96 D and G97. From G96 to G97 S is the surface speed, m/min
  /// (feet per minute in inches), at D revolutions per minute at most. A line with $ is about another one,
  /// but for $0 and $-1 (all).
  void take(const Block& block, double millimetres_per_unit);

  /// Whether it turns as a line's motion needs it: at a speed for a feed per revolution, and the right way
  /// round for a tap.
  [[nodiscard]] Expected<void, Diagnostic> check(const Block& block, const Modal& modal, Code motion) const;

  /// mm/s of a feed per revolution. Under G96 it is the lowest of the motion, at the end that is farther from
  /// the axis (`radius`); none at the axis itself without D.
  [[nodiscard]] std::optional<double> feed(double per_revolution, double radius) const;

 private:
  static bool about_another(const Block& block) { return block.has('$') && block.number('$') > 0.0; }
  static int direction_of(const Block& block) {
    const int code = block.code(Group::spindle) / 10;
    return code == 19 ? 5 : code;  // M19 stops it
  }
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/spindle-inl.hpp"
#endif
