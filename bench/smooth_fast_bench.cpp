// Smoothing of the whole program by kernel sums, and its speed; reading excluded.
#include <benchmark/benchmark.h>

#include "ball.hpp"
#include "cncplan/plan_program.hpp"

namespace {

using namespace cncplan;

// An item is a block; `seconds` is the motion's duration.
void smooth_ball_fast(benchmark::State& state) {
  const PlanOptions options{.tolerance = 0.01, .level = SmoothLevel::fast};
  const auto program = read_text(bench::ball(), bench::mill, options);
  if (program.failed()) return state.SkipWithError("the program does not read");
  double seconds = 0;
  for (auto _ : state) {
    const auto planned = plan_blocks(program.blocks(), bench::mill, options);
    if (!planned) return state.SkipWithError("the program has no plan");
    seconds = planned->duration();
  }
  state.counters["seconds"] = seconds;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(program.blocks().size()));
}
BENCHMARK(smooth_ball_fast)->Name("smooth/ball/fast")->Unit(benchmark::kMillisecond);

// The same without the speed: which junctions, and how large their kernels are.
void smooth_ball_sizes(benchmark::State& state) {
  const PlanOptions options{.tolerance = 0.01, .level = SmoothLevel::fast};
  const auto program = read_text(bench::ball(), bench::mill, options);
  if (program.failed()) return state.SkipWithError("the program does not read");
  const std::span<const bench::Block> blocks(program.blocks());
  for (auto _ : state)
    benchmark::DoNotOptimize(
        detail::smoothing(blocks, bench::mill, detail::smoothing_rules<double>(options)));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks.size()));
}
BENCHMARK(smooth_ball_sizes)->Name("smooth/ball/sizes")->Unit(benchmark::kMillisecond);

}  // namespace
