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
  std::vector<cncplan::Fallback> fallbacks;  ///< lines of the program
  double seconds = 0.0;                      ///< that planning took
};

/// Throws `Failure` for what cannot be planned.
template <class M>
[[nodiscard]] Plan plan(const Options& options, const support::Machine& file, const M& machine,
                        const Program<M>& program);

}  // namespace simulate
