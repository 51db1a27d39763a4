// What may stand in the way of a higher speed.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace cncplan::tools::report {

enum class LimitedBy : std::uint8_t {
  rest,           ///< it stands still
  feed,           ///< it is within 2 % of the programmed feed, or of the highest that the machine allows
  axis_velocity,  ///< a straight path, on which an axis is as fast as it may be
  curvature,      ///< a bend, which takes acceleration and jerk at constant speed
  acceleration,   ///< it speeds up with constant acceleration
  jerk,           ///< it speeds up with changing acceleration
  junction,       ///< it slows down towards the end of a block
  look_ahead,     ///< it slows down towards a lower feed or a bend, or is held below its feed
  tolerance,      ///< a bend that smoothing makes: it alone takes more than half of a limit
};

inline constexpr std::array<std::string_view, 9> limited_by_names{
    "rest", "feed",     "axis velocity", "curvature", "acceleration",
    "jerk", "junction", "look-ahead",    "tolerance"};

}  // namespace cncplan::tools::report
