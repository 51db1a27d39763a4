// Parts of a program that are planned at another level of smoothing than was asked for, and why.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "cncplan/smooth_level.hpp"

namespace cncplan {

enum class FallbackReason : std::uint8_t {
  map,             ///< under a map a path straight in the joints, as a rapid, is left exact
  path,            ///< a path of a kind of its own has no enclosures
  tool_limits,     ///< the tool has a limit that is infinite
  axes,            ///< X Y Z are not the first axes
  backlash,        ///< backlash takes time
  other_axes,      ///< only rotary axes move
  no_motion,       ///< the search found no motion within tolerance and limits
  slow_motion,     ///< on the curve, at the slow motion with which the search for speeds begins
  travel,          ///< the smoothed path would leave the travel of an axis
  fast_is_faster,  ///< the level `fast` takes less time
  memory           ///< the memory gave out
};

/// Blocks of a trajectory from the first to the last, counted from 0, that have another level.
struct Fallback {
  std::size_t first{};
  std::size_t last{};
  SmoothLevel level{};
  FallbackReason reason{};

  friend bool operator==(const Fallback&, const Fallback&) = default;
};

/// A reason as a clause, as "backlash takes time".
[[nodiscard]] constexpr std::string_view to_text(FallbackReason reason) {
  switch (reason) {
    case FallbackReason::map:
      return "a path straight in the joints of a map has no smoothed one";
    case FallbackReason::path:
      return "a path of a kind of its own has no enclosures";
    case FallbackReason::tool_limits:
      return "the tool has a limit that is infinite";
    case FallbackReason::axes:
      return "X Y Z are not the first axes";
    case FallbackReason::backlash:
      return "backlash takes time";
    case FallbackReason::other_axes:
      return "axes move, but not X Y Z";
    case FallbackReason::no_motion:
      return "the search found no motion within tolerance and limits";
    case FallbackReason::slow_motion:
      return "the search found no speeds, and the slow motion that it begins with is driven";
    case FallbackReason::travel:
      return "the smoothed path would leave the travel of an axis";
    case FallbackReason::fast_is_faster:
      return "the level fast takes less time";
    case FallbackReason::memory:
      return "the memory gave out";
  }
  return {};
}

}  // namespace cncplan
