// Executors with a policy of one's own for junctions that are left exact.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "cncplan/executor.hpp"
#include "cncplan/junction/exact_stop.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"

using namespace cncplan;

namespace {

constexpr Machine<3> square{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

// mm/s
struct SameSpeed {
  double speed{};
  [[nodiscard]] double speed_sq(const junction::Geometry&) const { return speed * speed; }
};

struct HalfOfFeed {
  [[nodiscard]] double speed_sq(const junction::Geometry& junction) const {
    return junction.limits.velocity * junction.limits.velocity / 4;
  }
};

struct Run {
  double seconds{};                        ///< until it rests at the end
  std::array<double, 4> slowest, fastest;  ///< mm/s, of each block within 1e-3 mm of its start
};

// Around a square of 1 mm, in ticks of 10 us.
template <class Policy>
Run around(const Policy& policy, double override_share, const std::string& feed = "F1800") {
  constexpr double tick = 1e-5, near = 1e-3;
  using Runner = Executor<Machine<3>, 8>;
  const auto executor = std::make_unique<Runner>(square, policy, Runner::Options{.tolerance = 0});
  executor->feed_override(override_share);
  for (const auto& block : test::blocks_of({feed, "G1 X1", "Y1", "X0", "Y0"}, square, {.tolerance = 0}))
    REQUIRE(executor->push(block));
  executor->end_of_program();
  Run run;
  run.slowest.fill(1e9);
  run.fastest.fill(0);
  while (!executor->finished()) {
    const auto point = executor->tick(tick);
    if (point.along.velocity > 0) run.seconds = point.time;
    const auto block = static_cast<std::size_t>(point.along.position);  // each is 1 mm long
    if (block == 0 || block > 3 || point.along.position - static_cast<double>(block) > near) continue;
    run.slowest[block] = std::min(run.slowest[block], point.along.velocity);
    run.fastest[block] = std::max(run.fastest[block], point.along.velocity);
  }
  CHECK_FALSE(executor->error());
  return run;
}

}  // namespace

TEST_CASE("an executor stops at every corner where its policy says so", "[executor]") {
  const junction::ExactStop stop;
  // From rest to rest over 1 mm at the jerk alone: four phases of (d / 2 J)^(1/3).
  CHECK(around(stop, 1).seconds == Approx(4 * 4 * std::cbrt(1 / 20000.0)).epsilon(1e-4));
}

TEST_CASE("an executor passes corners at the speed that its policy says, at an override above 1 too",
          "[executor]") {
  for (const double share : {1.0, 2.0}) {
    CAPTURE(share);
    const SameSpeed policy{5};
    const Run run = around(policy, share);
    for (std::size_t corner = 1; corner <= 3; ++corner) {
      CAPTURE(corner);
      CHECK(run.slowest[corner] == Approx(5).epsilon(1e-3));
      CHECK(run.fastest[corner] < 5.1);
    }
  }
}

TEST_CASE("a policy of an executor sees the programmed feeds at an override above 1 too", "[executor]") {
  const HalfOfFeed policy;
  for (const double share : {1.0, 2.0}) {
    CAPTURE(share);
    const Run run = around(policy, share, "F300");
    for (std::size_t corner = 1; corner <= 3; ++corner)
      CHECK(run.slowest[corner] == Approx(2.5).epsilon(1e-3));
  }
}
