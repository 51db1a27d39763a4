// Profiles solved one after another: rest to rest, between random end speeds, and with the acceleration limit
// binding.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"

namespace {

using namespace cncplan;

struct Task {
  double length;
  profile::BoundarySpeeds speeds;
};

constexpr Limits usual{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
constexpr Limits bound{.velocity = 30.0, .acceleration = 200.0, .jerk = 10000.0};

// Lengths log-uniform in [0.01, 100] mm, end speeds uniform in [0, fastest]; only what both laws can drive.
std::vector<Task> tasks(const Limits& limits, double fastest) {
  std::mt19937_64 engine(20221);
  std::uniform_real_distribution<double> exponent(-2.0, 2.0);
  std::uniform_real_distribution<double> speed(0.0, 1.0);
  std::vector<Task> result;
  while (result.size() < 4096) {
    const Task task{std::pow(10.0, exponent(engine)), {fastest * speed(engine), fastest * speed(engine)}};
    if (profile::five_phase(task.length, task.speeds, limits) &&
        profile::seven_phase(task.length, task.speeds, limits))
      result.push_back(task);
  }
  return result;
}

void solve(benchmark::State& state, const profile::Solver& solver, const std::vector<Task>& work) {
  for (auto _ : state)
    for (const Task& task : work) {
      auto profile = solver(task.length, task.speeds);
      benchmark::DoNotOptimize(profile);
    }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(work.size()));
}

BENCHMARK_CAPTURE(solve, , profile::five_phase_solver(usual), tasks(usual, 0.0))
    ->Name("profile/five_phase/rest_to_rest");
BENCHMARK_CAPTURE(solve, , profile::five_phase_solver(usual), tasks(usual, 30.0))
    ->Name("profile/five_phase/random");
BENCHMARK_CAPTURE(solve, , profile::five_phase_solver(bound), tasks(bound, 30.0))
    ->Name("profile/five_phase/accel_bound");
BENCHMARK_CAPTURE(solve, , profile::seven_phase_solver(usual), tasks(usual, 0.0))
    ->Name("profile/seven_phase/rest_to_rest");
BENCHMARK_CAPTURE(solve, , profile::seven_phase_solver(usual), tasks(usual, 30.0))
    ->Name("profile/seven_phase/random");
BENCHMARK_CAPTURE(solve, , profile::seven_phase_solver(bound), tasks(bound, 30.0))
    ->Name("profile/seven_phase/accel_bound");

}  // namespace
