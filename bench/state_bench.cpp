// Motions from any state to any state. An item is a move made, not sampled.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cncplan/plan/move_to.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;

struct AxisMove {
  AxisState from, to;
  Axis axis;
};

// Limits of a mill's axes, and states in all of them: velocity and acceleration at both ends, within limits.
AxisMove draw(test::Random& random, bool rest) {
  AxisMove move{};
  Axis& axis = move.axis;
  axis.velocity = random.log_uniform(10, 500);
  axis.acceleration = axis.velocity * random.uniform(3, 20);
  axis.jerk = axis.acceleration * random.uniform(5, 100);
  move.to.position = (random.coin() ? 1 : -1) * random.log_uniform(0.01, 500);
  if (rest) return move;
  const auto state = [&](AxisState& state, double sign) {
    double settled{};
    do {
      state.velocity = axis.velocity * random.uniform(-1, 1);
      state.acceleration = axis.acceleration * random.uniform(-1, 1);
      settled = state.velocity + sign * state.acceleration * std::abs(state.acceleration) / (2 * axis.jerk);
    } while (std::abs(settled) > axis.velocity);
  };
  state(move.from, 1);
  state(move.to, -1);
  return move;
}

void one_axis(benchmark::State& state, bool rest) {
  test::Random random;
  std::vector<AxisMove> moves(4096);
  for (AxisMove& move : moves) move = draw(random, rest);
  std::size_t i = 0;
  for (auto _ : state) {
    const AxisMove& move = moves[i++ % moves.size()];
    benchmark::DoNotOptimize(move_to(move.from, move.to, move.axis));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(one_axis, random, false)->Name("state/one_axis/random");
BENCHMARK_CAPTURE(one_axis, rest_to_rest, true)->Name("state/one_axis/rest_to_rest");

void three_axes(benchmark::State& state) {
  struct Case {
    AxisStates<3> from, to;
    Machine<3> machine;
  };
  test::Random random;
  std::vector<Case> cases(1024);
  for (Case& c : cases)
    for (std::size_t i = 0; i < 3; ++i) {
      const AxisMove move = draw(random, false);
      c.from.set(i, move.from), c.to.set(i, move.to);
      c.machine.axes[i] = move.axis;
    }
  std::size_t i = 0;
  for (auto _ : state) {
    const Case& c = cases[i++ % cases.size()];
    benchmark::DoNotOptimize(move_to(c.from, c.to, c.machine));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(three_axes)->Name("state/three_axes/synchronised");

}  // namespace
