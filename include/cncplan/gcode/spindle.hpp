// The spindle, as far as a program tells of it: its speed makes feeds of feeds per revolution.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "cncplan/gcode/block.hpp"
#include "cncplan/gcode/modal.hpp"
#include "cncplan/gcode/rules.hpp"

namespace cncplan::gcode {

struct Spindle {
  int direction = 5;                      ///< M3, M4 or M5
  std::optional<double> speed{};          ///< S
  std::optional<double> surface_speed{};  ///< G96, mm per minute
  double fastest{};                       ///< revolutions per minute, under G96

  /// What a line says of it: S, M3 to M5, M19, G96 D and G97. From G96 to G97 S is the surface speed, m/min
  /// (feet per minute in inches), at D revolutions per minute at most. A line with $ is about another one,
  /// but for $0 and $-1 (all).
  void take(const Block& block, double millimetres_per_unit) {
    if (about_another(block)) return;
    if (block.has(Group::spindle)) direction = direction_of(block);
    const bool begins = block.code(Group::spindle_mode) == code(96);
    if (begins) fastest = block.has('D') ? block.number('D') : std::numeric_limits<double>::infinity();
    if (block.has(Group::spindle_mode) && !begins) surface_speed.reset();
    if (!block.has('S') || dwells_by_s(block)) return;
    speed = block.number('S');
    if (begins || surface_speed) surface_speed = *speed * (millimetres_per_unit != 1.0 ? 304.8 : 1000.0);
  }

  /// Whether it turns as a line's motion needs it: at a speed for a feed per revolution, and the right way
  /// round for a tap.
  [[nodiscard]] Expected<void, Diagnostic> check(const Block& block, const Modal& modal, Code motion) const {
    const bool feeds = motion != no_code && motion != code(0);
    const int column = detail::motion_column(block);
    const bool per_turn = (feeds && modal.feed_mode == FeedMode::per_revolution) || is_synchronised(motion);
    const bool says = block.has('S') && !dwells_by_s(block) && !about_another(block);
    if (per_turn && !((says ? block.number('S') : speed.value_or(0.0)) > 0.0))
      return detail::missing("S", column);
    const int turns = block.has(Group::spindle) && !about_another(block) ? direction_of(block) : direction;
    if (is_tap(motion) && turns == (motion == code(84) ? 4 : 3))
      return detail::conflict(Diagnostic{{{}, "G", motion / 10.0, 0.0}, 0, column}, "M", turns);
    return {};
  }

  /// mm/s of a feed per revolution. Under G96 it is the lowest of the motion, at the end that is farther from
  /// the axis (`radius`); none at the axis itself without D.
  [[nodiscard]] std::optional<double> feed(double per_revolution, double radius) const {
    double per_minute = speed.value_or(0.0);
    if (surface_speed) per_minute = std::min(fastest, *surface_speed / (2.0 * std::numbers::pi * radius));
    const double feed = per_revolution * per_minute / 60.0;
    return std::isfinite(feed) ? std::optional<double>(feed) : std::nullopt;
  }

 private:
  static bool about_another(const Block& block) { return block.has('$') && block.number('$') > 0.0; }
  static int direction_of(const Block& block) {
    const int code = block.code(Group::spindle) / 10;
    return code == 19 ? 5 : code;  // M19 stops it
  }
};

}  // namespace cncplan::gcode
