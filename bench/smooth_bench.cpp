// Smoothing of the whole program within a tolerance: geometry and speed, reading excluded.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "ball.hpp"
#include "cncplan/detail/curve/smooth_run.hpp"
#include "cncplan/plan_program.hpp"

namespace {

using namespace cncplan;

// The blocks of the program as one run. An item is a block; `seconds` is the motion's duration.
void smooth_ball(benchmark::State& state, const detail::BasicSmoothOptions<double>& options) {
  const Limits& tool = bench::mill.limits;
  const auto program = read_text(bench::ball(), bench::mill);
  if (program.failed()) return state.SkipWithError("the program does not read");
  std::vector<detail::BasicBandBlock<double, 3>> blocks;
  for (const auto& block : program.blocks())
    if (block.path.length() > 0)
      blocks.push_back({block.path, block.rapid ? tool.velocity : std::min(block.feed, tool.velocity),
                        Vector3::Constant(0.01)});
  MotionLimits<3> limits;
  limits.tool = tool;
  double seconds = 0;
  for (auto _ : state) seconds = detail::smooth_run<double, 3>(blocks, limits, options).duration;
  state.counters["seconds"] = seconds;
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks.size()));
}
BENCHMARK_CAPTURE(smooth_ball, good, detail::good_smoothing<double>)
    ->Name("smooth/ball/good")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(smooth_ball, best, {})->Name("smooth/ball/best")->Unit(benchmark::kMillisecond);

}  // namespace
