// Random profiles over the whole domain, each checked against oracles that share nothing with the solver;
// prints the worst of each error with the case that caused it. Exit 1 if a bound is broken.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "soak/worst.hpp"
#include "support/profile_oracle.hpp"

namespace {

using namespace cncplan;

struct Case {
  test::ProfileCase move{};
  bool seven{};
};

int soak(std::uint64_t seed, std::uint64_t count) {
  using E = test::ProfileErrors;
  test::Worst<E, Case> all[] = {{"end position (eps)", &E::end_position, 4.0},
                                {"end speed (eps)", &E::end_speed, 4.0},
                                {"end acceleration", &E::end_acceleration, 1e-12},
                                {"continuity (eps)", &E::continuity, 8.0},
                                {"velocity excess", &E::velocity_excess, 1e-12},
                                {"acceleration excess", &E::acceleration_excess, 1e-12},
                                {"jerk excess", &E::jerk_excess, 1e-12},
                                {"speed below zero", &E::lowest_speed, 1e-12},
                                {"time over optimum", &E::time_loss, 1e-12}};
  test::Random random(seed);
  std::uint64_t solved = 0;
  for (std::uint64_t draw = 0; draw < count; ++draw) {
    const test::ProfileCase c = test::draw(random);
    for (const bool seven : {false, true}) {
      const auto profile = seven ? profile::seven_phase(c.length, c.speeds, c.limits)
                                 : profile::five_phase(c.length, c.speeds, c.limits);
      const test::Real direct =
          test::ramp_distance(c.speeds.start, c.speeds.end, c.limits.acceleration, c.limits.jerk, seven);
      const bool feasible = direct <= c.length;
      if (!profile) {
        if (!feasible) continue;
        std::printf("refused a feasible case: %s\n", c.literal().c_str());
        return 1;
      }
      if (direct > static_cast<test::Real>(c.length) * (1 + 1e-15L)) {
        std::printf("accepted an infeasible case: %s\n", c.literal().c_str());
        return 1;
      }
      ++solved;
      auto errors = test::examine(c, *profile);
      if (feasible) errors.time_loss = std::abs(test::time_loss(c, *profile, seven));
      for (auto& worst : all) worst.take(errors, {c, seven});
    }
  }

  std::printf("seed %llu, %llu draws, %llu profiles\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(solved));
  const auto literal = [](const Case& c) { return (c.seven ? "seven " : "five ") + c.move.literal(); };
  return test::report(std::span<const test::Worst<E, Case>>(all), literal) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("random profiles against independent oracles");
  std::uint64_t seed = test::seed();
  double count = 1e6;
  app.add_option("--seed", seed, "of the random numbers")->capture_default_str();
  app.add_option("--count", count, "how many draws; each is solved with five and with seven phases")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return soak(seed, static_cast<std::uint64_t>(count));
}
