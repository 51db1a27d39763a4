#include "cncplan/plan/player/plan_ahead.hpp"

#include <array>
#include <vector>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("a plan made bit by bit is the one made at once") {
  test::Random random;
  for (int i = 0; i < 200; ++i) {
    std::vector<plan::BlockCaps> blocks;
    for (int k = random.integer(1, 40); k > 0; --k) {
      const double weaker = random.coin() ? 1.0 : random.uniform(0.4, 1.0);
      blocks.push_back({random.log_uniform(0.01, 10.0),
                        random.uniform(0.0, 30.0),
                        {random.uniform(5.0, 30.0), 1000.0 * weaker, 10000.0 * weaker},
                        0.0});
    }
    std::vector<plan::Waypoint> bits(blocks.size() + 1), whole(blocks.size() + 1);
    const auto waypoints = [&](std::vector<plan::Waypoint>& room) {
      return std::span(room).first(
          plan::make_waypoints(std::span<const plan::BlockCaps>(blocks), 0.0, std::span(room)));
    };
    plan::WaypointPlanner<double> in_bits(waypoints(bits)), at_once(waypoints(whole));
    at_once.solve();
    int calls = 1;
    while (!in_bits.work(static_cast<std::size_t>(random.integer(1, 5))) && calls < 100'000) ++calls;
    CAPTURE(i, calls);
    for (std::size_t k = 0; k < bits.size(); ++k) {
      CHECK(bits[k].steady == whole[k].steady);
      CHECK(bits[k].speed == whole[k].speed);
      CHECK(bits[k].settled == whole[k].settled);
    }
  }
}

TEST_CASE("the next plan begins at the last steady waypoint that is settled, and not too early") {
  std::array<plan::Waypoint, 6> waypoints{};
  for (plan::Waypoint& waypoint : waypoints) {
    waypoint.gap = 3.0;
    waypoint.limits.velocity = 30.0;
    waypoint.steady = true;
  }
  waypoints[1].settled = waypoints[3].settled = true;
  waypoints[2].steady = false;
  const std::span<const plan::Waypoint> all(waypoints);
  const auto start = plan::waypoint_to_plan_from(all, 1, 0.05, 1.0, false);
  REQUIRE(start);
  CHECK(start->waypoint == 3);
  CHECK(start->time == Approx(0.05 + 6.0 / 30.0));
  CHECK_FALSE(plan::waypoint_to_plan_from(all, 1, 0.05, 0.2, false));  // it is 0.25 s away
  CHECK_FALSE(plan::waypoint_to_plan_from(all, 4, 0.05, 1.0, false));  // behind it nothing is settled
  CHECK(plan::waypoint_to_plan_from(all, 1, 0.05, 1.0, true)->waypoint == 5);
}
