// A program planned as the options say.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

#include "measures.hpp"
#include "options.hpp"
#include "planned.hpp"
#include "program_blocks.hpp"
#include "stopwatch.hpp"
#include "support/machine_file.hpp"

namespace simulate {

/// Its blocks are those of the program, or pieces of them.
struct Plan {
  std::unique_ptr<Planned> motion;
  std::vector<std::size_t> motion_of;  ///< of the program, for each block
  std::size_t junctions_limited = 0;  ///< joints between motions that are slower than the feeds on both sides
  std::vector<OtherLevel> other_levels;  ///< in the order of the program
  double seconds = 0.0;                  ///< that planning took
};

/// On the exact path, by the level `fast`, or with events. Throws `Failure` for what cannot be planned.
template <class M>
[[nodiscard]] Plan plan_blocks(const Options& options, const support::Machine& file, const M& machine,
                               const Program<M>& program);

/// By the level `good` or `best`. Throws `Failure` for what cannot be planned.
template <int N>
[[nodiscard]] Plan plan_pieces(const Options& options, const support::Machine& file, const Mill<N>& machine,
                               const Program<Mill<N>>& program);

/// By whichever of the two the options ask for.
template <class M>
[[nodiscard]] Plan plan(const Options& options, const support::Machine& file, const M& machine,
                        const Program<M>& program) {
  double seconds = 0.0;
  Plan result = [&] {
    const Stopwatch watch(seconds);
    if constexpr (std::is_same_v<M, Mill<3>> || std::is_same_v<M, Mill<6>>)
      if (options.tolerance > 0.0 && !options.events && options.smooth != Smooth::fast)
        return plan_pieces<M::axis_count>(options, file, machine, program);
    return plan_blocks(options, file, machine, program);
  }();
  result.seconds = seconds;
  return result;
}

}  // namespace simulate
