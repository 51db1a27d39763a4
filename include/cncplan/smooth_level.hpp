// How closely smoothing comes to the fastest motion within the tolerance.
#pragma once

#include <cstdint>
#include <string_view>

namespace cncplan {

/// The higher the level, the shorter the motion and the more work it is to plan.
enum class SmoothLevel : std::uint8_t {
  exact,  ///< on the programmed path
  fast,   ///< corners and changes of curvature are rounded in closed form
  good,   ///< a curve within the tolerance and a speed along it: nearly the time of the best
  best    ///< the same, searched for until little is left to gain
};

/// "exact", "fast", "good" or "best".
[[nodiscard]] constexpr std::string_view to_text(SmoothLevel level) {
  switch (level) {
    case SmoothLevel::exact:
      return "exact";
    case SmoothLevel::fast:
      return "fast";
    case SmoothLevel::good:
      return "good";
    case SmoothLevel::best:
      return "best";
  }
  return {};
}

}  // namespace cncplan
