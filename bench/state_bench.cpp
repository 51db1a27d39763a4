// Motions from any state to any state. An item is a move made, not sampled.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <vector>

#include "axis_move.hpp"

namespace {

using namespace cncplan;
using bench::AxisMove;
using bench::draw_axis_move;

void one_axis(benchmark::State& state, bool rest) {
  test::Random random;
  std::vector<AxisMove> moves(4096);
  for (AxisMove& move : moves) move = draw_axis_move(random, rest);
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
      const AxisMove move = draw_axis_move(random, false);
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
