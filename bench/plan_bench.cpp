// Planning whole programs, and all of the way from a program's text to its samples.
#include <benchmark/benchmark.h>

#include <iterator>
#include <string>
#include <vector>

#include "ball.hpp"
#include "buffer.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/plan/laws.hpp"
#include "cncplan/plan/sampler.hpp"
#include "cncplan/plan/span_planner.hpp"
#include "cncplan/plan/stream_planner.hpp"
#include "plan/random_program.hpp"

namespace {

using namespace cncplan;
using bench::ball;

// Everything between text and samples; cleared and filled again, so that only the first round asks for
// memory.
struct Job {
  std::vector<plan::Block> blocks;
  std::vector<plan::BlockCaps> caps;
  std::vector<double> lengths;
  std::vector<plan::Gate> gates;
  std::vector<plan::Span> spans;

  bool read(const std::string& text) { return bench::read_blocks(text, blocks); }

  bool plan() {
    caps.clear();
    lengths.clear();
    spans.clear();
    const junction::Deviation deviation{0.01};
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      caps.push_back(i == 0 ? plan::caps_from_rest(blocks[i], plan::ShareLimits{})
                            : plan::caps(blocks[i - 1], blocks[i], deviation, plan::ShareLimits{}));
      lengths.push_back(caps.back().length);
    }
    gates.resize(blocks.size() + 1);
    return plan::plan_spans(std::span<const plan::BlockCaps>(caps), plan::SevenPhase{}, std::span(gates),
                            std::back_inserter(spans))
        .has_value();
  }

  // The same blocks one by one through a window.
  bool stream(std::size_t window) {
    std::vector<plan::BlockCaps> ahead(window);
    std::vector<plan::Gate> first(window + 1), second(window + 1);
    spans.clear();
    plan::StreamPlanner<double> planner({ahead, first, second});
    const junction::Deviation deviation{0.01};
    const auto out = std::back_inserter(spans);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const auto block = i == 0 ? plan::caps_from_rest(blocks[i], plan::ShareLimits{})
                                : plan::caps(blocks[i - 1], blocks[i], deviation, plan::ShareLimits{});
      if (!planner.push(block, out)) return false;
    }
    return planner.finish(out).has_value();
  }

  std::int64_t sample() {
    plan::Sampler sampler(blocks, spans, lengths, 1e-3);
    std::int64_t count = 0;
    while (const Eigen::Index written = sampler.positions(points(bench::buffer()))) {
      count += written;
      benchmark::ClobberMemory();
    }
    return count;
  }
};

// Caps and spans over blocks in memory. An item is a block.
void plan_ball(benchmark::State& state) {
  Job job;
  if (!job.read(ball())) state.SkipWithError("the program does not read");
  for (auto _ : state)
    if (!job.plan()) state.SkipWithError("the program has no plan");
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(job.blocks.size()));
}
BENCHMARK(plan_ball)->Name("plan/ball")->Unit(benchmark::kMillisecond);

// The same, block by block through windows of different sizes. An item is a block.
void plan_ball_stream(benchmark::State& state, std::size_t window) {
  Job job;
  if (!job.read(ball())) state.SkipWithError("the program does not read");
  for (auto _ : state)
    if (!job.stream(window)) state.SkipWithError("the program has no plan");
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(job.blocks.size()));
}
BENCHMARK_CAPTURE(plan_ball_stream, , 256)->Name("plan/ball/stream")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan_ball_stream, , 16)->Name("plan/ball/stream/16")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan_ball_stream, , 4096)->Name("plan/ball/stream/4096")->Unit(benchmark::kMillisecond);

// Programs whose caps, feeds and limits change all the time. An item is a block.
void plan_random(benchmark::State& state) {
  test::Random random(1);
  std::vector<std::vector<plan::BlockCaps>> programs;
  std::int64_t blocks = 0;
  for (int i = 0; i < 100; ++i) {
    programs.push_back(test::random_program(random, test::LimitSpread::wide, 4000));
    blocks += static_cast<std::int64_t>(programs.back().size());
  }
  std::vector<plan::Gate> gates(4001);
  std::vector<plan::Span> spans;
  for (auto _ : state)
    for (const auto& program : programs) {
      spans.clear();
      const auto planned = plan::plan_spans(std::span<const plan::BlockCaps>(program), plan::SevenPhase{},
                                            std::span(gates), std::back_inserter(spans));
      if (!planned) state.SkipWithError("a program has no plan");
    }
  state.SetItemsProcessed(state.iterations() * blocks);
}
BENCHMARK(plan_random)->Name("plan/random")->Unit(benchmark::kMillisecond);

// Text to positions at every millisecond, on one core. An item is a sample; `times_real_time` is how often
// faster than the machine would move it is.
void pipeline_ball(benchmark::State& state) {
  Job job;
  std::int64_t samples = 0;
  for (auto _ : state) {
    if (!job.read(ball()) || !job.plan()) state.SkipWithError("the program has no plan");
    samples += job.sample();
  }
  state.SetItemsProcessed(samples);
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(samples) * 1e-3, benchmark::Counter::kIsRate);
}
BENCHMARK(pipeline_ball)->Name("pipeline/ball")->Unit(benchmark::kMillisecond);

}  // namespace
