// Step generation: exact crossing times along arcs, beside the pulse distributions in the literature, which
// have no times of their own. An item is an edge; of the distributions, a slot.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "cncplan/published/axis_timer.hpp"
#include "cncplan/published/pulse_distribution.hpp"
#include "cncplan/step/merge.hpp"

namespace {

using namespace cncplan;

// Quarters of circles of 5 to 50 mm from rest to rest at the paper's limits and 400 steps/mm, all axes merged
// into one stream: starting up and slowing down is an eighth to two thirds of each.
void exact(benchmark::State& state, double end_radius_excess) {
  struct Block {
    path::Arc arc;
    std::array<Phase, 7> phases;
  };
  std::vector<Block> blocks;
  for (const double radius : {5.0, 10.0, 20.0, 50.0}) {
    const auto arc = path::arc_from_center<double>({radius, 0, 0}, {0, radius + end_radius_excess, 0},
                                                   {0, 0, 0}, Turn::counterclockwise, Plane::xy);
    const auto profile =
        profile::seven_phase(arc->length(), {.start = 0.0, .end = 0.0},
                             Limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0});
    const auto table = profile->phases();
    Block block{*arc, {}};
    std::copy(table.begin(), table.end(), block.phases.begin());
    blocks.push_back(block);
  }
  const std::array steps_per_mm{400.0, 400.0, 400.0};
  std::int64_t edges = 0;
  for (auto _ : state) {
    for (const Block& block : blocks) {
      const auto x = step::count_at(block.arc.start().x() * steps_per_mm[0]);
      auto source = step::block_edges(block.arc, step::PhaseClock(block.phases), steps_per_mm,
                                      std::array{x, std::int64_t{0}, std::int64_t{0}});
      while (const auto edge = source.next()) {
        benchmark::DoNotOptimize(edge->time);
        ++edges;
      }
    }
  }
  state.SetItemsProcessed(edges);
}
BENCHMARK_CAPTURE(exact, circle, 0.0)->Name("step/exact");
// As programs have them: centres rounded to 1 um, so the radii at both ends differ.
BENCHMARK_CAPTURE(exact, spiral, 1e-3)->Name("step/exact/spiral");

// Nearly coprime: 4.1 million slots for 1013 steps by the LCM method, 2026 by the other.
constexpr std::array<std::int64_t, 3> counts{1009, 1013, 4};

template <template <std::size_t> class Distribution>
void distribute(benchmark::State& state) {
  std::int64_t slots = 0;
  const auto fresh = Distribution<3>::make(counts);
  for (auto _ : state) {
    auto words = *fresh;
    while (const auto word = words.next()) benchmark::DoNotOptimize(*word);
    slots += static_cast<std::int64_t>(words.slots());
  }
  state.SetItemsProcessed(slots);
}
BENCHMARK(distribute<published::LcmDistribution>)->Name("step/lcm");
BENCHMARK(distribute<published::LargestAxisDistribution>)->Name("step/largest_axis");

void timer(benchmark::State& state) {
  using Timer = published::AxisTimer<double>;
  std::int64_t edges = 0;
  const std::array timers{*Timer::make(0, 10.09, 100.0, 1.0), *Timer::make(1, 10.13, 100.0, 1.0),
                          *Timer::make(2, -10.19, 100.0, 1.0)};
  for (auto _ : state) {
    step::Merge<Timer, 3> source(timers);
    while (const auto edge = source.next()) {
      benchmark::DoNotOptimize(edge->time);
      ++edges;
    }
  }
  state.SetItemsProcessed(edges);
}
BENCHMARK(timer)->Name("step/timer");

}  // namespace
