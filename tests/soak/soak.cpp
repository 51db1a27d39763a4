// Random profiles over the whole domain, each checked against oracles that share nothing with the solver;
// prints the worst of each error with the case that caused it. Exit 1 if a bound is broken.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "support/profile_oracle.hpp"

namespace {

using namespace cncplan;

struct Quantity {
  const char* name;
  double test::ProfileErrors::*member;
  double bound;
  double worst = -1.0;
  test::ProfileCase where{};
  bool seven = false;
};

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t seed = test::seed();
  std::uint64_t count = 1'000'000;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view option = argv[i];
    if (option == "--seed")
      seed = std::strtoull(argv[i + 1], nullptr, 10);
    else if (option == "--count")
      count = static_cast<std::uint64_t>(std::strtod(argv[i + 1], nullptr));
    else
      return std::fprintf(stderr, "usage: soak [--seed N] [--count N]\n"), 2;
  }

  using E = test::ProfileErrors;
  Quantity quantities[] = {{"end position (eps)", &E::end_position, 4.0},
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
      for (Quantity& q : quantities)
        if (!(errors.*q.member <= q.worst)) q = {q.name, q.member, q.bound, errors.*q.member, c, seven};
    }
  }

  bool held = true;
  std::printf("seed %llu, %llu draws, %llu profiles\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(solved));
  for (const Quantity& q : quantities) {
    const bool within = q.worst <= q.bound;
    held = held && within;
    std::printf("%-20s worst %-10.3g bound %-8.3g %s  %s %s\n", q.name, q.worst, q.bound,
                within ? "ok " : "BROKEN", q.seven ? "seven" : "five", q.where.literal().c_str());
  }
  return held ? 0 : 1;
}
