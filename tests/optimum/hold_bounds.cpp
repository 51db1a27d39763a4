// How long holds take beside the least time that the limits of the tool allow along the driven curve, which a
// search finds for the state of each: a plan is driven by its executor, and held at random instants.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "optimum/hold_beside.hpp"
#include "support/random.hpp"

using namespace cncplan;

int main(int argc, char** argv) {
  CLI::App app("holds beside the least time that their states allow");
  std::string file;
  SmoothLevel level = SmoothLevel::good;
  std::size_t count = 1000;
  std::uint64_t seed = 1;
  double factor = 1.5;
  Limits limits{.velocity = 30, .acceleration = 1000, .jerk = 10000};
  int steps = 60;
  app.add_option("file", file, "the program")->required();
  app.add_option("--level", level)
      ->transform(CLI::CheckedTransformer(std::map<std::string, SmoothLevel>{
          {"fast", SmoothLevel::fast}, {"good", SmoothLevel::good}, {"best", SmoothLevel::best}}));
  app.add_option("--count", count, "holds")->capture_default_str();
  app.add_option("--seed", seed)->capture_default_str();
  app.add_option("--hold-factor", factor)->capture_default_str();
  app.add_option("--vmax", limits.velocity)->capture_default_str();
  app.add_option("--amax", limits.acceleration)->capture_default_str();
  app.add_option("--jmax", limits.jerk)->capture_default_str();
  app.add_option("--steps", steps, "of the search")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const Machine<3> mill{.limits = limits};
  const auto planned = plan_file(file, mill, {.level = level, .hold_factor = factor});
  if (!planned) return std::fprintf(stderr, "%s\n", to_text(planned.error()).c_str()), 2;
  TrajectoryExecutor executor(*planned, mill, {.hold_factor = factor});
  if (const auto error = executor.error()) return std::fprintf(stderr, "%s\n", to_text(*error).c_str()), 2;

  constexpr double period = 1e-4;  // what is told of a hold is longer by that at most
  test::Random random(seed);
  const double between = planned->duration() / static_cast<double>(count);
  std::vector<double> holds, ratios;
  double worst_at = 0, next = random.uniform(0, 2 * between);
  while (!executor.finished()) {
    const State clock = executor.clock();
    const bool steady = clock.velocity == 1 && clock.acceleration == 0;
    if (!(clock.position > next) || !steady || executor.rests()) {
      executor.tick(period);
      continue;
    }
    const auto [time, least] = test::hold_beside(executor, *planned, limits, period, steps);
    holds.push_back(time);
    if (least > 0) {
      const double ratio = (time - period) / least;
      if (ratios.empty() || ratio > *std::ranges::max_element(ratios)) worst_at = clock.position;
      ratios.push_back(ratio);
    }
    executor.resume();
    next = clock.position + random.uniform(0, 2 * between);
  }
  std::ranges::sort(holds);
  std::ranges::sort(ratios);
  if (ratios.empty()) return std::fprintf(stderr, "no holds\n"), 1;
  const auto at = [](const std::vector<double>& values, double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  std::printf(
      "seed %llu, %zu holds: median %.3f s, longest %.3f s; a search found the least of %zu of them\n",
      static_cast<unsigned long long>(seed), holds.size(), at(holds, 0.5), at(holds, 1), ratios.size());
  std::printf("times the least: median %.3f, 90 %% %.3f, 99 %% %.3f, worst %.3f at %.3f s of the plan\n",
              at(ratios, 0.5), at(ratios, 0.9), at(ratios, 0.99), at(ratios, 1), worst_at);
}
