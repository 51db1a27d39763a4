// What the machine can do at best: the yardsticks that the library's figures are held against, in the same
// run.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>

#include "buffer.hpp"

namespace {

using cncplan::bench::buffer;
using cncplan::bench::buffer_points;

// The price of memory alone: writing x y z of every point in the buffer, of values that cost nothing to make.
// An item is a point. What an arc's batch is compared with.
void store_xyz(benchmark::State& state) {
  auto& points = buffer();
  double value = 0.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(value += 1.0);
    points.colwise() = Eigen::Vector3d(value, value + 1.0, value + 2.0);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * buffer_points);
}
BENCHMARK(store_xyz)->Name("floor/store_xyz");

// An arc at constant feed by turning the radius vector, four multiplications a point: cheap, but each point
// waits for the one before it, and the error grows with every step. An item is a point.
void rotation(benchmark::State& state) {
  auto& points = buffer();
  double step = 1e-3;
  for (auto _ : state) {
    benchmark::DoNotOptimize(step);
    const double cosine = std::cos(step);
    const double sine = std::sin(step);
    double x = 5.0;
    double y = 0.0;
    for (int i = 0; i < buffer_points; ++i) {
      points.col(i) << x, y, step;
      const double turned = x * cosine - y * sine;
      y = x * sine + y * cosine;
      x = turned;
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * buffer_points);
}
BENCHMARK(rotation)->Name("floor/rotation");

// One root at a time, each independent of the last, as a profile's closed form asks for them. An item is a
// root.
template <double (*root)(double)>
void roots(benchmark::State& state) {
  std::array<double, 256> radicands{};
  for (std::size_t i = 0; i < radicands.size(); ++i) radicands[i] = 0.01 + 0.37 * static_cast<double>(i);
  for (auto _ : state) {
    for (double radicand : radicands) {
      benchmark::DoNotOptimize(radicand);
      benchmark::DoNotOptimize(root(radicand));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(radicands.size()));
}
double square_root(double x) { return std::sqrt(x); }
double cube_root(double x) { return std::cbrt(x); }
BENCHMARK(roots<square_root>)->Name("floor/sqrt");
BENCHMARK(roots<cube_root>)->Name("floor/cbrt");

}  // namespace
