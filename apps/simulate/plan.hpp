// A program planned as the options say.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "cncplan/fallback.hpp"
#include "measures.hpp"
#include "options.hpp"
#include "planned.hpp"
#include "program_blocks.hpp"
#include "support/machine_file.hpp"

namespace simulate {

struct Plan {
  std::unique_ptr<Planned> motion;
  std::vector<std::size_t> motion_of;  ///< of the program, for each block
  /// Joints between motions that are slower than the feeds on both sides; nothing where they are not counted.
  std::optional<std::size_t> junctions_limited{};
  std::vector<OtherLevel> other_levels;  ///< in the order of the program
  double seconds = 0.0;                  ///< that planning took
};

/// Lines of the program that a trajectory has at another level of smoothing than was asked for.
template <class T>
[[nodiscard]] std::vector<OtherLevel> other_levels(const T& trajectory) {
  std::vector<OtherLevel> result;
  const auto blocks = trajectory.program();
  for (const cncplan::Fallback& part : trajectory.fallbacks())
    result.push_back(
        {blocks[part.first].line, blocks[part.last].line, to_text(part.level), to_text(part.reason)});
  return result;
}

/// Throws `Failure` for what cannot be planned.
template <class M>
[[nodiscard]] Plan plan(const Options& options, const support::Machine& file, const M& machine,
                        const Program<M>& program);

}  // namespace simulate
