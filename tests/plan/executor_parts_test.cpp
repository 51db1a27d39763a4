// The parts that a tick is made of.
#include <memory>

#include "cncplan/executor_levels.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 60, .acceleration = 800, .jerk = 20000}};

using Runner = Executor<Machine<3>, 32>;

// One of the requests of a controller.
void ask(Runner& executor, int request, double share) {
  switch (request) {
    case 0:
      return executor.feed_hold();
    case 1:
    case 2:
      return executor.resume();
    case 3:
      return executor.feed_override(share);
    case 4:
      return executor.rapid_override(share);
    case 5:
      return executor.reverse(share < 0.4);
    case 6:
      return executor.single_step(share < 0.4);
    default:
      return executor.quick_stop();
  }
}

}  // namespace

TEST_CASE("who asks for the parts of ticks gets the same motion, bit for bit", "[executor]") {
  test::Random random;
  for (int sequence = 0; sequence < 200; ++sequence) {
    const auto lines = test::random_lines(random, random.integer(3, 40), {0, 0, 0}, 20, "");
    auto blocks = test::blocks_of(lines, mill);
    for (auto& block : blocks) block.word = {};  // words alone ask for parts
    const double period = random.log_uniform(1e-4, 0.1);
    CAPTURE(sequence, period, test::literal(lines));
    const LevelExecutorOptions options{.tolerance = random.coin() ? 0.0 : 0.02};
    const auto alone = std::make_unique<Runner>(mill, options),
               with_parts = std::make_unique<Runner>(mill, options);
    std::size_t pushed = 0;
    double parts = 0, moved = 0;
    for (int tick = 0; tick < 2000 && !alone->finished(); ++tick) {
      for (; pushed < blocks.size() && alone->push(blocks[pushed]); ++pushed)
        REQUIRE(with_parts->push(blocks[pushed]));
      if (pushed == blocks.size()) alone->end_of_program(), with_parts->end_of_program();
      if (random.integer(0, 9) == 0) {
        const int request = random.integer(0, 7);
        const double share = random.uniform(0.1, 1.5);
        ask(*alone, request, share), ask(*with_parts, request, share);
      } else if (alone->state() == ExecutorState::held || alone->state() == ExecutorState::stopped) {
        alone->resume(), with_parts->resume();
      }
      const auto one = alone->tick(period);
      const auto other = with_parts->tick(period, [&](const auto& part) { parts += part.length(); });
      CAPTURE(tick);
      REQUIRE(one.position == other.position);
      REQUIRE(one.velocity == other.velocity);
      moved += one.velocity.isZero() ? 0.0 : period;
    }
    CHECK(parts >= 0.5 * moved);
  }
}
