// What an executor is doing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

enum class ExecutorState : std::uint8_t {
  moving,    ///< along the program's path
  holding,   ///< the same, on the way to a rest that was asked for
  held,      ///< at rest as asked, until it is resumed
  dwelling,  ///< at rest for a time of the program (G4)
  stopped,   ///< at rest at M0, M1 or M60, until it is resumed
  jogging,   ///< by a jog, or back to the path
  away,      ///< at rest beside the path, behind a jog, or before the way to it after `restart`
  waiting,   ///< at rest for want of blocks
  fault,     ///< at rest before a block that cannot be planned: `error` says why
  finished,  ///< the program is over, or was stopped
};

[[nodiscard]] constexpr std::string_view to_text(ExecutorState state) {
  constexpr std::array<std::string_view, 10> names{"moving",  "holding", "held",    "dwelling", "stopped",
                                                   "jogging", "away",    "waiting", "fault",    "finished"};
  const auto number = static_cast<std::size_t>(state);
  return number < names.size() ? names[number] : "unknown";
}

}  // namespace cncplan
