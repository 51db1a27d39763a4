// Parts of a program that are planned at another level of smoothing than was asked for, and why.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace cncplan {

/// How a part of a program is planned in place of the levels `good` and `best`.
enum class FallbackLevel : std::uint8_t {
  exact,  ///< on the exact path
  fast,   ///< as `plan_blocks` does
  slow    ///< on a curve within the tolerance, at the slow motion with which a search for speeds begins
};

enum class FallbackReason : std::uint8_t {
  map,             ///< there is no level for machines behind a map
  tool_limits,     ///< the tool has a limit that is infinite
  axes,            ///< X Y Z are not the first axes
  backlash,        ///< backlash takes time
  other_axes,      ///< only rotary axes move
  no_motion,       ///< the search found no motion within tolerance and limits
  travel,          ///< the smoothed path would leave the travel of an axis
  fast_is_faster,  ///< the level `fast` takes less time
  memory           ///< the memory gave out
};

/// Blocks of a trajectory from the first to the last, counted from 0, that have another level.
struct Fallback {
  std::size_t first{};
  std::size_t last{};
  FallbackLevel level{};
  FallbackReason reason{};

  friend bool operator==(const Fallback&, const Fallback&) = default;
};

/// "exact", "fast" or "slow".
[[nodiscard]] constexpr std::string_view name(FallbackLevel level) {
  switch (level) {
    case FallbackLevel::exact:
      return "exact";
    case FallbackLevel::fast:
      return "fast";
    case FallbackLevel::slow:
      return "slow";
  }
  return {};
}

/// A reason as a clause, as "backlash takes time".
[[nodiscard]] constexpr std::string_view text(FallbackReason reason) {
  switch (reason) {
    case FallbackReason::map:
      return "a map has no smoothed paths";
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
