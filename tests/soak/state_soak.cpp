// Random motions of one axis from any state to any state, integrated in long double and held against brute
// force over switching patterns; prints the worst of each error with the case that caused it. Exit 1 if a
// bound is broken.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "cncplan/state/detail/axis_motions.hpp"
#include "soak/worst.hpp"
#include "state/axis_case.hpp"
#include "state/switching_oracle.hpp"

namespace {

using namespace cncplan;

struct Errors {
  double target = 0, limits = 0, slower = 0, searched = 0, lasting_target = 0, lasting_limits = 0,
         lasting_time = 0;
};

int soak(std::uint64_t seed, std::uint64_t count, std::uint64_t every) {
  test::Worst<Errors, test::AxisCase> all[] = {
      {"end of the fastest (relative)", &Errors::target, 1e-11},
      {"limits of the fastest (relative)", &Errors::limits, 1e-12},
      {"slower than brute force (relative)", &Errors::slower, 1e-9},
      // Near a target that jerk alone leads to, time grows with the cube root of what the position misses: a
      // rounding of that is much more of the time.
      {"slower than the whole search", &Errors::searched, 1e-9},
      {"end of a longer one (relative)", &Errors::lasting_target, 1e-11},
      {"limits of a longer one", &Errors::lasting_limits, 1e-11},
      {"duration of a longer one", &Errors::lasting_time, 1e-12}};
  test::Random random(seed);
  std::uint64_t refused = 0, compared = 0, found = 0;
  for (std::uint64_t n = 0; n < count; ++n) {
    const bool compare = n % every == 0;
    const test::AxisCase c = test::draw_axis_case(random, !compare && random.integer(0, 4) == 0);
    const auto motions = state::axis_motions(c.from, c.to, c.limits);
    if (!motions) {
      if (refused++ == 0) std::printf("refused: %s\n", c.literal().c_str());
      continue;
    }
    Errors errors;
    const auto motion = motions->fastest();
    const auto fastest = test::examine(c, motion);
    errors.target = fastest.target(), errors.limits = fastest.limits();
    // the same motion, by the way that looks at every piece of both curves
    const double first = motions->next_duration(0);
    errors.searched = std::max((motion.duration() - first - 1e-12) / (first + 1e-12), 0.0);
    if (compare) {
      const test::Real best = test::SwitchingOracle(c).fastest();
      ++compared;
      if (std::isfinite(best)) {
        const test::Real late = motion.duration() - best - 1e-12L;
        errors.slower = std::max(static_cast<double>(late / (best + 1e-12L)), 0.0);
        if (best <= motion.duration() * (1 + 1e-9L) + 1e-12L) ++found;
      }
    }
    const double least = motion.duration() * random.log_uniform(1.0, 10.0);
    if (least > 1e-12) {
      const double duration = motions->duration_from(least);
      const auto longer = motions->lasting(duration);
      const auto examined = test::examine(c, longer);
      errors.lasting_target = examined.target(), errors.lasting_limits = examined.limits();
      errors.lasting_time = std::abs(longer.duration() / duration - 1);
    }
    for (auto& worst : all) worst.take(errors, c);
  }
  const auto print = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  std::printf(
      "seed %llu: %llu states, %llu refused, %llu held against brute force, which found %llu of them\n",
      print(seed), print(count), print(refused), print(compared), print(found));
  const auto literal = [](const test::AxisCase& c) { return c.literal(); };
  const bool held = test::report(std::span<const test::Worst<Errors, test::AxisCase>>(all), literal);
  return held && refused == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("random motions from state to state against brute force");
  std::uint64_t seed = test::seed();
  double count = 1e6;
  std::uint64_t every = 1000;
  app.add_option("--seed", seed, "of the random numbers")->capture_default_str();
  app.add_option("--count", count, "how many states")->capture_default_str();
  app.add_option("--every", every, "one of so many is held against brute force")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return soak(seed, static_cast<std::uint64_t>(count), every);
}
