// Arcs: making them, and the closed forms that the step backend calls for every edge.
#include <benchmark/benchmark.h>

#include <array>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"

namespace {

using namespace cncplan;
using namespace cncplan::path;

constexpr std::size_t count = 1024;

/// A half circle of radius 5 mm; with `mismatch` > 0 its end is off, as by rounded decimals, and it is a
/// spiral.
Arc half_circle(double mismatch) {
  return arc_from_center({0, 0, 0}, {10 + mismatch, 0, 0}, {5, 0, 0}, Turn::clockwise, Plane::xy).value();
}

/// Numbers that grow evenly between two bounds.
std::array<double, count> between(double low, double high) {
  std::array<double, count> values;
  for (std::size_t i = 0; i < count; ++i)
    values[i] = low + (high - low) * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
  return values;
}

/// Runs `f` over `count` numbers between the bounds.
template <class F>
void run(benchmark::State& state, double low, double high, F f) {
  const auto values = between(low, high);
  for (auto _ : state)
    for (const double value : values) benchmark::DoNotOptimize(f(value));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

void from_radius(benchmark::State& state) {
  run(state, 5.1, 50, [](double r) {
    return arc_from_radius({0, 0, 0}, {5, 5, 1}, r, Turn::clockwise, Plane::xy)->length();
  });
}
BENCHMARK(from_radius)->Name("path/arc_from_radius");

void from_center(benchmark::State& state) {
  run(state, 1e-5, 1e-3, [](double mismatch) { return half_circle(mismatch).length(); });
}
BENCHMARK(from_center)->Name("path/arc_from_center");

void crossing(benchmark::State& state, double mismatch) {
  const Arc arc = half_circle(mismatch);
  run(state, 0, 10, [&arc](double x) { return arc.crossing(0, x, 0, arc.parameter_end()); });
}
BENCHMARK_CAPTURE(crossing, circle, 0.0)->Name("path/crossing/circle");
BENCHMARK_CAPTURE(crossing, spiral, 5e-4)->Name("path/crossing/spiral");

void parameter_at(benchmark::State& state) {
  const Arc arc = half_circle(5e-4);
  run(state, 0, arc.length(), [&arc](double s) { return arc.parameter_at(s); });
}
BENCHMARK(parameter_at)->Name("path/parameter_at/spiral");

void bounds(benchmark::State& state) {
  const Arc arc = half_circle(0);
  run(state, 0, 1, [&arc](double) { return arc.box().high; });
}
BENCHMARK(bounds)->Name("path/bounds/circle");

}  // namespace
