// What controls mean differently by the same words, as data (set-up).
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "cncplan/gcode/dialect.hpp"

namespace cncplan::gcode {

/// Where a control differs from LinuxCNC.
struct Control {
  std::string_view name;
  double dwell_unit{};    ///< s that one of the P of G4 is
  bool retract_to_r{};    ///< G99 at the start, else G98
  double peck_clearance;  ///< mm, of G73 and G83
};

/// LinuxCNC 2.9 and grbl count dwells in seconds, Fanuc and Marlin in milliseconds. Peck clearances are
/// LinuxCNC's where the control has a parameter of its own for it.
inline constexpr std::array controls{
    Control{"linuxcnc", 1.0, true, 0.254},
    Control{"grbl", 1.0, false, 0.254},
    Control{"fanuc", 1e-3, false, 0.254},
    Control{"marlin", 1e-3, false, 0.254},
};

/// The control of a name; none for one that is not known.
[[nodiscard]] constexpr std::optional<Control> find_control(std::string_view name) {
  for (const Control& control : controls)
    if (control.name == name) return control;
  return std::nullopt;
}

/// The dialect as the control has it.
[[nodiscard]] inline Dialect with(Dialect dialect, const Control& control) {
  dialect.dwell_unit = control.dwell_unit;
  dialect.retract_to_r = control.retract_to_r;
  dialect.peck_clearance = control.peck_clearance;
  return dialect;
}

}  // namespace cncplan::gcode
