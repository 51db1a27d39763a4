// Sampling one motion, rest to rest at the paper's limits, every millisecond. An item is a sample; compare
// with floor/store_xyz, which fills the same buffer.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>

#include "buffer.hpp"
#include "cncplan/interpolate/exact.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_length_table.hpp"
#include "cncplan/path/b_spline.hpp"
#include "cncplan/path/bezier.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "cncplan/published/constant_speed.hpp"
#include "cncplan/published/stepped.hpp"

namespace {

using namespace cncplan;
using bench::buffer;
using bench::buffer_points;

// Lengths of some 122 mm: a little more than 4096 samples.
path::Arc turns(double rise) {
  return path::arc_from_center<double>({19.5, 0, 0}, {19.5, 0, rise}, {0, 0, 0}, Turn::counterclockwise,
                                       Plane::xy)
      .value();
}
path::Arc arc() { return turns(0.0); }
path::Arc helix() { return turns(10.0); }
path::Line<3> line() { return {{0, 0, 0}, {100, 70, 10}}; }

// Of about the same length.
const std::array<Vector3, 4> controls{Vector3(0, 0, 0), Vector3(20, 60, 0), Vector3(80, 60, 0),
                                      Vector3(100, 0, 0)};
path::Bezier<3> bezier() { return path::Bezier<3>(controls); }
const std::array<Vector3, 7> spline_controls{Vector3(-30, -20, 0), Vector3(0, 0, 0),   Vector3(20, 60, 0),
                                             Vector3(50, 75, 0),   Vector3(80, 60, 0), Vector3(100, 0, 0),
                                             Vector3(130, -20, 0)};
path::BSpline<3> b_spline() { return path::BSpline<3>(spline_controls); }

template <class P>
profile::Profile profile_of(const P& path) {
  return profile::seven_phase(path.length(), {.start = 0.0, .end = 0.0},
                              Limits{.velocity = 29.8, .acceleration = 1000.0, .jerk = 10000.0})
      .value();
}

// Positions alone, into the buffer.
template <auto make>
void batch(benchmark::State& state) {
  const path::Segment<3> path = make();
  const auto samples = interpolate::samples(path, profile_of(path), 1e-3);
  if (samples.size() < buffer_points) state.SkipWithError("the motion is too short");
  for (auto _ : state) {
    benchmark::DoNotOptimize(samples.positions(0, points(buffer())));
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * buffer_points);
}
BENCHMARK(batch<line>)->Name("sample/line/batch");
BENCHMARK(batch<arc>)->Name("sample/arc/batch");
BENCHMARK(batch<helix>)->Name("sample/helix/batch");

// Time, state along the path, position, velocity and acceleration, one sample after the other.
template <class Samples>
void take_all(benchmark::State& state, const Samples& samples) {
  std::int64_t count = 0;
  for (auto _ : state)
    for (const auto& sample : samples) {
      benchmark::DoNotOptimize(sample);
      ++count;
    }
  state.SetItemsProcessed(count);
}

template <auto make>
void stream(benchmark::State& state) {
  const auto path = make();
  take_all(state, interpolate::samples(path, profile_of(path), 1e-3));
}
BENCHMARK(stream<line>)->Name("sample/line/stream");
BENCHMARK(stream<arc>)->Name("sample/arc/stream");
BENCHMARK(stream<helix>)->Name("sample/helix/stream");

template <auto make>
void taylor(benchmark::State& state) {
  const auto path = make();
  take_all(state, published::taylor_samples(path, profile_of(path), 1e-3));
}
BENCHMARK(taylor<arc>)->Name("sample/arc/taylor");
BENCHMARK(taylor<bezier>)->Name("sample/bezier/taylor");
BENCHMARK(taylor<b_spline>)->Name("sample/b_spline/taylor");

// By length, with a table of lengths.
template <auto make>
void measured(benchmark::State& state) {
  const path::ArcLengthTable path(make());
  take_all(state, interpolate::samples(path, profile_of(path), 1e-3));
}
BENCHMARK(measured<bezier>)->Name("sample/bezier/stream");
BENCHMARK(measured<b_spline>)->Name("sample/b_spline/stream");

// Eq. 17: the same increment every period.
void constant(benchmark::State& state) {
  const path::Arc path = arc();
  take_all(state, interpolate::samples(path, published::constant_speed(path.length(), 29.8), 1e-3));
}
BENCHMARK(constant)->Name("sample/arc/constant");

}  // namespace
