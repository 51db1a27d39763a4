// What is asked of a move besides its target.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>

#include "cncplan/core/error.hpp"

namespace cncplan::state {

/// How axes go together.
enum class Synchronization : std::uint8_t {
  time,   ///< all arrive at the earliest instant that each of them can meet exactly
  phase,  ///< on a straight line where start and target lie on one and it costs no time, else as `time`
  none,   ///< each arrives as soon as it can
};

template <std::floating_point S>
struct BasicMoveOptions {
  Synchronization synchronization = Synchronization::time;
  S minimum_duration{};  ///< s, >= 0
};

using MoveOptions = BasicMoveOptions<double>;

/// Nothing if the duration is finite and not negative.
template <std::floating_point S>
[[nodiscard]] constexpr Expected<void> validate(const BasicMoveOptions<S>& options) {
  const S least = options.minimum_duration;
  if (!std::isfinite(least)) return refusal(ErrorCode::not_finite, "minimum duration", least);
  if (least < S(0)) return refusal(ErrorCode::negative, "minimum duration", least);
  return {};
}

}  // namespace cncplan::state
