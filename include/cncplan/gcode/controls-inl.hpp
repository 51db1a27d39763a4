// Definitions of controls.hpp.
#pragma once

#include "cncplan/gcode/controls.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Dialect with(Dialect dialect, const Control& control) {
  dialect.dwell_unit = control.dwell_unit;
  dialect.retract_to_r = control.retract_to_r;
  dialect.peck_clearance = control.peck_clearance;
  dialect.incremental_center = control.incremental_center;
  dialect.lenient = control.lenient;
  dialect.user_codes = control.user_codes;
  dialect.bare_m_codes = control.bare_m_codes;
  dialect.g70_units = control.g70_units;
  for (const double number : control.g_words)
    if (number != 0.0) dialect.pass_through.push_back({'G', number});
  for (const std::int16_t number : control.m_words)
    dialect.pass_through.push_back({'M', static_cast<double>(number), control.m_takes});
  for (const std::int16_t number : control.m_texts)
    dialect.pass_through.push_back({'M', static_cast<double>(number), Letters{0}, true});
  return dialect;
}

}  // namespace cncplan::gcode
