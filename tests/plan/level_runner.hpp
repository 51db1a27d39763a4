// An executor at a higher level of smoothing, and how tests feed it.
#pragma once

#include <cstddef>
#include <memory>

#include "cncplan/executor_levels.hpp"
#include "plan/rows_program.hpp"
#include "support/small_mill.hpp"

namespace cncplan::test {

using Runner = Executor<Machine<3>, 64>;

/// With limits of axes, which jogs need.
inline Machine<3> with_axes() {
  Machine<3> machine = mill;
  for (auto& axis : machine.axes) axis.velocity = 50, axis.acceleration = 1000, axis.jerk = 10000;
  return machine;
}

inline std::unique_ptr<Runner> runner(LevelExecutorOptions options = {.level = SmoothLevel::good}) {
  return std::make_unique<Runner>(with_axes(), options);
}

template <class E>
void feed(E& executor, const MillBlocks& blocks, std::size_t& fed) {
  while (fed < blocks.size() && executor.push(blocks[fed]))
    if (++fed == blocks.size()) executor.end_of_program();
}

/// To the end, with as many blocks as it takes; s.
template <class E>
double run_to_end(E& executor, const MillBlocks& blocks, double most = 600) {
  std::size_t fed = 0;
  double time = 0;
  while (!executor.finished() && time < most) {
    feed(executor, blocks, fed);
    executor.tick(tick_time);
    time += tick_time;
  }
  return time;
}

}  // namespace cncplan::test
