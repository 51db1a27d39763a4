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
  double dwell_unit{};              ///< s that one of the P of G4 is
  bool retract_to_r{};              ///< G99 at the start, else G98
  double peck_clearance{};          ///< mm, of G73 and G83
  bool incremental_center{};        ///< G91.1 at the start, else G90.1
  bool lenient{};                   ///< reads what LinuxCNC refuses (`Dialect::lenient`)
  std::array<int, 6> m_words{};     ///< M words of its own, which pass through; 0 for none
  std::array<double, 3> g_words{};  ///< the same of G
};

/// LinuxCNC and grbl count dwells in seconds, Fanuc, Marlin and Mach3 in milliseconds; Mach3 can be set to
/// seconds, and to absolute centres. Peck clearances are LinuxCNC's where the control has a parameter of its
/// own for it. M words: grbl's parking; Fanuc's spindle orientation, rigid tapping and gears; Marlin's
/// motors, fan and waiting. G words: Fanuc's look-ahead (G05 P10000, G05.1 Q1, G08 P1), where LinuxCNC has
/// splines and radii.
inline constexpr std::array controls{
    Control{"linuxcnc", 1.0, true, 0.254, true, false, {}, {}},
    Control{"grbl", 1.0, false, 0.254, true, true, {56}, {}},
    Control{"fanuc", 1e-3, false, 0.254, true, true, {19, 29, 41, 42, 43, 44}, {5.0, 5.1, 8.0}},
    Control{"marlin", 1e-3, false, 0.254, true, true, {17, 18, 84, 106, 107, 400}, {}},
    Control{"mach3", 1e-3, false, 0.254, true, true, {}, {}},
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
  dialect.incremental_center = control.incremental_center;
  dialect.lenient = control.lenient;
  for (const int number : control.m_words)
    if (number != 0) dialect.pass_through.push_back({'M', static_cast<double>(number)});
  for (const double number : control.g_words)
    if (number != 0.0) dialect.pass_through.push_back({'G', number});
  return dialect;
}

}  // namespace cncplan::gcode
