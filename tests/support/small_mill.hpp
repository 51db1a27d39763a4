// An executor of a small mill, loaded with lines of a program and run to its end.
#pragma once

#include <string>
#include <vector>

#include "cncplan/executor.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"

namespace cncplan::test {

inline constexpr Machine<3> small_mill{
    .axes = {{{.letter = 'X', .velocity = 50, .acceleration = 1000, .jerk = 20000, .high = 100},
              {.letter = 'Y', .velocity = 50, .acceleration = 1000, .jerk = 20000},
              {.letter = 'Z', .velocity = 20, .acceleration = 300, .jerk = 5000}}},
    .limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
inline constexpr double tick_time = 1e-3;  // s
using SmallRunner = Executor<Machine<3>, 16>;
using Lines = std::vector<std::string>;

inline void load(SmallRunner& executor, const Lines& lines) {
  for (const auto& block : blocks_of(lines, small_mill)) REQUIRE(executor.push(block));
  executor.end_of_program();
}

// Ticks until it is over, or for so long; the last set point.
inline SetPoint<3> run(SmallRunner& executor, double seconds = 1e3) {
  SetPoint<3> point;
  for (int tick = 0; tick < seconds / tick_time && !executor.finished(); ++tick)
    point = executor.tick(tick_time);
  return point;
}

}  // namespace cncplan::test
