// Definitions of spindle.hpp.
#pragma once

#include "cncplan/gcode/detail/spindle.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE void Spindle::take(const Block& block, double millimetres_per_unit) {
  if (about_another(block)) return;
  if (block.has(Group::spindle)) direction = direction_of(block);
  const bool begins = block.code(Group::spindle_mode) == code(96);
  if (begins) fastest = block.has('D') ? block.number('D') : std::numeric_limits<double>::infinity();
  if (block.has(Group::spindle_mode) && !begins) surface_speed.reset();
  if (!block.has('S') || dwells_by_s(block)) return;
  speed = block.number('S');
  if (begins || surface_speed) surface_speed = *speed * (millimetres_per_unit != 1.0 ? 304.8 : 1000.0);
}

CNCPLAN_INLINE Expected<void, Diagnostic> Spindle::check(const Block& block, const Modal& modal,
                                                         Code motion) const {
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

CNCPLAN_INLINE std::optional<double> Spindle::feed(double per_revolution, double radius) const {
  double per_minute = speed.value_or(0.0);
  if (surface_speed) per_minute = std::min(fastest, *surface_speed / (2.0 * std::numbers::pi * radius));
  const double feed = per_revolution * per_minute / 60.0;
  return std::isfinite(feed) ? std::optional<double>(feed) : std::nullopt;
}

}  // namespace cncplan::gcode
