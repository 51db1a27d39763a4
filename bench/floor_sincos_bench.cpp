// floor/sincos: the points of an arc by the compiler's own vector sine and cosine. Compiled with -ffast-math,
// alone.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>

#include "buffer.hpp"

namespace {

using cncplan::bench::buffer;
using cncplan::bench::buffer_points;

// Sine and cosine of 4096 angles, scaled by a radius and stored as x y z: an arc without any profile. An item
// is a point. Where the compiler has no vector libm this is the scalar one. Sine and cosine stand in loops of
// their own, over a block that stays in the first cache: g++ joins the two of one angle to a scalar call.
void sincos(benchmark::State& state) {
  constexpr int block = 64;
  auto& points = buffer();
  double step = 1e-3;
  for (auto _ : state) {
    benchmark::DoNotOptimize(step);
    for (int first = 0; first < buffer_points; first += block) {
      std::array<double, block> x;
      std::array<double, block> y;
      for (int i = 0; i < block; ++i) x[static_cast<std::size_t>(i)] = 5.0 * std::cos(step * (first + i));
      benchmark::DoNotOptimize(step);
      for (int i = 0; i < block; ++i) y[static_cast<std::size_t>(i)] = 5.0 * std::sin(step * (first + i));
      for (int i = 0; i < block; ++i)
        points.col(first + i) << x[static_cast<std::size_t>(i)], y[static_cast<std::size_t>(i)], step;
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * buffer_points);
}
BENCHMARK(sincos)->Name("floor/sincos");

}  // namespace
