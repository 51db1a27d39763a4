// The parameters that LinuxCNC sets by itself, as far as a planner knows them (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/reader.hpp"

namespace cncplan::gcode {

namespace detail {

/// The order of axes in LinuxCNC's parameters.
inline constexpr std::string_view parameter_axes = "XYZABCUVW";

/// A coordinate in degrees, or in units of so many millimetres. 0 of an axis that is not there.
[[nodiscard]] double coordinate(const Reader& reader, const Position& place, std::size_t which, double unit);

[[nodiscard]] inline bool any(const Position& position) {
  return std::any_of(position.begin(), position.end(), [](double x) { return x != 0.0; });
}

/// 540 for G54 to 590, 591 to 593 for G59.3.
[[nodiscard]] inline double coordinate_system_code(std::size_t system) {
  const auto number = static_cast<double>(system);
  return system < 6 ? 540.0 + 10.0 * number : 585.0 + number;
}

struct MachineName {
  std::string_view name;
  double (*value)(const Reader&);
};

/// Names of LinuxCNC's "predefined named parameters" and their values; coordinates are apart.
inline constexpr std::array machine_names{
    MachineName{"_vmajor", [](const Reader&) { return 2.9; }},
    MachineName{"_vminor", [](const Reader&) { return 0.0; }},
    MachineName{"_motion_mode",
                [](const Reader& r) { return r.modal().motion < 0 ? 800.0 : r.modal().motion * 1.0; }},
    MachineName{"_plane",
                [](const Reader& r) {
                  return r.modal().plane == Plane::xy ? 170.0 : r.modal().plane == Plane::yz ? 190.0 : 180.0;
                }},
    MachineName{"_ccomp", [](const Reader& r) { return r.modal().compensation * 1.0; }},
    MachineName{"_metric", [](const Reader& r) { return r.modal().millimetres_per_unit == 1.0 ? 1.0 : 0.0; }},
    MachineName{"_imperial",
                [](const Reader& r) { return r.modal().millimetres_per_unit == 1.0 ? 0.0 : 1.0; }},
    MachineName{"_absolute", [](const Reader& r) { return r.modal().incremental ? 0.0 : 1.0; }},
    MachineName{"_incremental", [](const Reader& r) { return r.modal().incremental ? 1.0 : 0.0; }},
    MachineName{"_inverse_time",
                [](const Reader& r) { return r.modal().feed_mode == FeedMode::inverse_time ? 1.0 : 0.0; }},
    MachineName{"_units_per_minute",
                [](const Reader& r) { return r.modal().feed_mode == FeedMode::per_minute ? 1.0 : 0.0; }},
    MachineName{"_units_per_rev",
                [](const Reader& r) { return r.modal().feed_mode == FeedMode::per_revolution ? 1.0 : 0.0; }},
    MachineName{"_coord_system", [](const Reader& r) { return coordinate_system_code(r.place().system()); }},
    MachineName{"_tool_offset", [](const Reader& r) { return any(r.place().tool()) ? 1.0 : 0.0; }},
    MachineName{"_retract_r_plane", [](const Reader& r) { return r.modal().retract_to_r ? 1.0 : 0.0; }},
    MachineName{"_retract_old_z", [](const Reader& r) { return r.modal().retract_to_r ? 0.0 : 1.0; }},
    MachineName{"_spindle_rpm_mode", [](const Reader& r) { return r.spindle().surface_speed ? 0.0 : 1.0; }},
    MachineName{"_spindle_css_mode", [](const Reader& r) { return r.spindle().surface_speed ? 1.0 : 0.0; }},
    MachineName{"_ijk_absolute_mode",
                [](const Reader& r) { return r.modal().incremental_center ? 0.0 : 1.0; }},
    MachineName{"_lathe_diameter_mode", [](const Reader& r) { return r.modal().diameter ? 1.0 : 0.0; }},
    MachineName{"_lathe_radius_mode", [](const Reader& r) { return r.modal().diameter ? 0.0 : 1.0; }},
    MachineName{"_spindle_on", [](const Reader& r) { return r.spindle().direction == 5 ? 0.0 : 1.0; }},
    MachineName{"_mist", [](const Reader& r) { return r.modal().mist ? 1.0 : 0.0; }},
    MachineName{"_flood", [](const Reader& r) { return r.modal().flood ? 1.0 : 0.0; }},
    MachineName{"_spindle_cw", [](const Reader& r) { return r.spindle().direction == 3 ? 1.0 : 0.0; }},
    MachineName{
        "_feed",
        [](const Reader& r) {
          const Modal& modal = r.modal();
          const double unit = modal.feed_mode == FeedMode::inverse_time ? 1.0 : modal.millimetres_per_unit;
          return modal.feed.value_or(0.0) / unit * (modal.feed_mode == FeedMode::per_revolution ? 1.0 : 60.0);
        }},
    MachineName{"_rpm", [](const Reader& r) { return r.spindle().speed.value_or(0.0); }},
    MachineName{"_current_tool", [](const Reader& r) { return static_cast<double>(r.loaded_tool()); }},
    MachineName{"_selected_tool", [](const Reader& r) { return static_cast<double>(r.selected_tool()); }},
    MachineName{"_task", [](const Reader&) { return 0.0; }},  // nothing runs yet
    MachineName{"_remap_level", [](const Reader&) { return 0.0; }},
};

}  // namespace detail

/// The value of #number, where the machine sets it: coordinates of the axes X Y Z A B C U V W. Places are in
/// the units of the program; what the machine keeps, homes, offsets and tools, is in its own, mm. Planning
/// has no probe: the last probing motion counts as one with contact at its end.
[[nodiscard]] std::optional<double> machine_parameter(const Reader& reader, int number);

/// The value of #<name>, lower case and without blanks, where the machine sets it.
[[nodiscard]] std::optional<double> machine_parameter(const Reader& reader, std::string_view name);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/language/machine_parameters-inl.hpp"
#endif
