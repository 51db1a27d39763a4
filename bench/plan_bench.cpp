// Planning whole programs, and all of the way from a program's text to its samples.
#include <benchmark/benchmark.h>

#include <iterator>
#include <span>
#include <vector>

#include "ball.hpp"
#include "buffer.hpp"
#include "cncplan/detail/speed/span_planner.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/profile/laws.hpp"
#include "plan/random_program.hpp"

namespace {

using namespace cncplan;
using bench::ball;

using Spans = std::vector<detail::Span>;

std::vector<bench::Block> ball_blocks(benchmark::State& state) {
  std::vector<bench::Block> blocks;
  if (!bench::read_blocks(ball(), blocks)) state.SkipWithError("the program does not read");
  return blocks;
}

auto cells_of(const std::vector<bench::Block>& blocks) {
  return detail::make_cells(std::span(blocks), bench::mill, bench::junction_rules);
}

// Looks ahead over all cells.
bool look_ahead(const detail::BasicCells<double>& cells, std::vector<detail::ConstrainedJunction>& junctions,
                Spans& spans) {
  spans.clear();
  junctions.resize(cells.segment_limits.size() + 1);
  return detail::plan_spans(std::span<const detail::SegmentLimits>(cells.segment_limits),
                            profile::SevenPhase{}, std::span(junctions), std::back_inserter(spans))
      .has_value();
}

// Cells and spans over blocks in memory. An item is a block.
void plan_ball(benchmark::State& state) {
  const auto blocks = ball_blocks(state);
  std::vector<detail::ConstrainedJunction> junctions;
  Spans spans;
  for (auto _ : state) {
    const auto cells = cells_of(blocks);
    if (!cells || !look_ahead(*cells, junctions, spans)) state.SkipWithError("the program has no plan");
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks.size()));
}
BENCHMARK(plan_ball)->Name("plan/ball")->Unit(benchmark::kMillisecond);

// The first half of it: junctions, travel, and limits along cells. An item is a block.
void plan_ball_cells(benchmark::State& state) {
  const auto blocks = ball_blocks(state);
  for (auto _ : state) benchmark::DoNotOptimize(cells_of(blocks));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks.size()));
}
BENCHMARK(plan_ball_cells)->Name("plan/ball/cells")->Unit(benchmark::kMillisecond);

// The second half: spans over cells in memory. An item is a block.
void plan_ball_look_ahead(benchmark::State& state) {
  const auto blocks = ball_blocks(state);
  const auto cells = cells_of(blocks);
  std::vector<detail::ConstrainedJunction> junctions;
  Spans spans;
  for (auto _ : state)
    if (!cells || !look_ahead(*cells, junctions, spans)) state.SkipWithError("the program has no plan");
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks.size()));
}
BENCHMARK(plan_ball_look_ahead)->Name("plan/ball/look_ahead")->Unit(benchmark::kMillisecond);

// Programs whose caps, feeds and limits change all the time. An item is a block.
void plan_random(benchmark::State& state) {
  test::Random random(1);
  std::vector<std::vector<detail::SegmentLimits>> programs;
  std::int64_t blocks = 0;
  for (int i = 0; i < 100; ++i) {
    programs.push_back(test::random_program(random, test::LimitSpread::wide, 4000));
    blocks += static_cast<std::int64_t>(programs.back().size());
  }
  std::vector<detail::ConstrainedJunction> junctions(4001);
  std::vector<detail::Span> spans;
  for (auto _ : state)
    for (const auto& program : programs) {
      spans.clear();
      const auto planned =
          detail::plan_spans(std::span<const detail::SegmentLimits>(program), profile::SevenPhase{},
                             std::span(junctions), std::back_inserter(spans));
      if (!planned) state.SkipWithError("a program has no plan");
    }
  state.SetItemsProcessed(state.iterations() * blocks);
}
BENCHMARK(plan_random)->Name("plan/random")->Unit(benchmark::kMillisecond);

// Text to positions at every millisecond, on one core. An item is a sample; `times_real_time` is how often
// faster than the machine would move it is.
void pipeline_ball(benchmark::State& state) {
  std::int64_t samples = 0;
  for (auto _ : state) {
    const auto trajectory = plan_text(ball(), bench::mill, {.tolerance = 0});
    if (!trajectory) return state.SkipWithError("the program has no plan");
    Eigen::Index written = 0;
    for (std::int64_t first = 0; first == 0 || written == bench::buffer_points; first += written) {
      written = trajectory->positions(1e-3, first, points(bench::buffer()));
      samples += written;
      benchmark::ClobberMemory();
    }
  }
  state.SetItemsProcessed(samples);
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(samples) * 1e-3, benchmark::Counter::kIsRate);
}
BENCHMARK(pipeline_ball)->Name("pipeline/ball")->Unit(benchmark::kMillisecond);

}  // namespace
