// SPDX-License-Identifier: GPL-2.0-or-later
// What the ini and the module's parameters say (set-up).
#pragma once

#include <array>

#include "coordinates.hpp"

namespace cncplan::linuxcnc {

/// The text of the module's parameters as they stand in the ini's TPMOD line; null or empty: not given.
struct Parameters {
  const char* jerk{};              ///< of each linear axis without MAX_JERK; machine units/s^3
  const char* rotary_jerk{};       ///< the same for rotary axes
  const char* tolerance{};         ///< of G64 without P, machine units
  const char* rotary_tolerance{};  ///< machine units
  const char* level{};             ///< of smoothing: fast or good
};

/// Of smoothing.
enum class Level : unsigned char {
  fast,  ///< planned in the servo thread
  good   ///< planned in a thread beside it
};

struct Settings {
  Units units{};
  std::array<bool, coordinate_count> used{};       ///< by [TRAJ]COORDINATES
  std::array<double, coordinate_count> jerk{};     ///< mm/s^3, rad/s^3
  double tool_velocity{};                          ///< mm/s; infinity: as the axes can
  double tool_jerk{};                              ///< mm/s^3; the same
  double tolerance = 0.01;                         ///< mm
  double rotary_tolerance = 8.726646259971648e-4;  ///< rad
  Level level = Level::fast;
};

/// Reads the ini that INI_FILE_NAME names. What is wrong is printed; false then.
[[nodiscard]] bool read_settings(const Parameters& parameters, Settings& settings);

/// How many of X Y Z A B C U V W have to be planned: 3, 6 or 9.
[[nodiscard]] int planned_coordinates(const Settings& settings);

}  // namespace cncplan::linuxcnc
