// How high an override of the feed may be, at every level of smoothing.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>

#include "cncplan/trajectory_executor.hpp"
#include "plan/level_runner.hpp"
#include "plan/rows_program.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Machine<3> fast_machine() {
  Machine<3> machine = with_axes();
  machine.limits.velocity = 80;
  for (auto& axis : machine.axes) axis.velocity = 80;
  return machine;
}

// The highest speed to the end.
template <class E>
double top_speed(E& executor, const MillBlocks& blocks) {
  std::size_t fed = 0;
  double most = 0;
  for (int tick = 0; tick < 60'000 && !executor.finished(); ++tick) {
    feed(executor, blocks, fed);
    most = std::max(most, executor.tick(period).velocity.norm());
  }
  CHECK(executor.finished());
  return most;
}

}  // namespace

TEST_CASE("executor overrides: a share of the feed is cut at the highest, at every door",
          "[executor-overrides]") {
  const Machine<3> machine = fast_machine();
  const MillBlocks blocks = blocks_of("F600\nG1 X200\nX400 Y1\n", machine);
  const auto planned = plan_blocks(blocks, machine, {.level = SmoothLevel::good, .hold_factor = 2});
  REQUIRE(planned);
  for (const double most : {1.0, 1.5, 2.0, 5.0}) {
    for (const double asked : {9.0, infinity}) {
      CAPTURE(most, asked);
      for (const SmoothLevel level :
           {SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best}) {
        CAPTURE(level);
        const auto executor =
            std::make_unique<Runner>(machine, LevelExecutorOptions{.level = level, .most_override = most});
        executor->feed_override(asked);
        CHECK(top_speed(*executor, blocks) == Approx(10 * most).epsilon(1e-3));
      }
      TrajectoryExecutor<Machine<3>, MillBlock> executor(*planned, machine, {.most_override = most});
      executor.feed_override(asked);
      CHECK(top_speed(executor, {}) == Approx(10 * most).epsilon(1e-3));
    }
  }
}

TEST_CASE("executor overrides: options out of their domain are refused", "[executor-overrides]") {
  const auto refuses = [](const LevelExecutorOptions& options, const std::string& field, ErrorCode code) {
    CAPTURE(field);
    Runner executor(mill, options);
    REQUIRE(executor.error());
    CHECK(executor.error()->error().field == field);
    CHECK(executor.error()->error().code == code);
    CHECK(executor.tick(period).velocity.norm() == 0);
  };
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good}) {
    refuses({.level = level, .most_override = 0.9}, "highest override", ErrorCode::below_limit);
    refuses({.level = level, .most_override = no_number}, "highest override", ErrorCode::not_finite);
    refuses({.level = level, .most_override = infinity}, "highest override", ErrorCode::not_finite);
  }
  const auto planned = plan_blocks(blocks_of("F600\nG1 X10\n"), mill, {.level = SmoothLevel::good});
  REQUIRE(planned);
  const TrajectoryExecutor<Machine<3>, MillBlock> executor(*planned, mill, {.most_override = 0.5});
  CHECK(executor.error());
}
