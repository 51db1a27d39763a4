// Requests on blocks that are much shorter than the way to rest: they act at the next tick.
#include <vector>

#include "cncplan/plan/player/player.hpp"
#include "cncplan/profile/from_state.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

constexpr Limits limits{30.0, 1000.0, 10000.0};
constexpr double feed = 12.0, period = 1e-3;

// Runs blocks of 0.01 to 0.1 mm, looking ahead over 64 of them: coming to rest from 12 mm/s takes 0.42 mm.
class Run {
 public:
  Run() : player_({blocks_, ahead_, waypoints_, spare_}) {}

  plan::Played tick(double seconds = period) {
    while (player_.push(next_)) next_.caps.length = random_.log_uniform(0.01, 0.1);
    return player_.tick(seconds);
  }
  plan::Played tick(int count) {
    plan::Played now = tick();
    for (int i = 1; i < count; ++i) now = tick();
    return now;
  }
  plan::Player& operator*() { return player_; }

 private:
  test::Random random_;
  plan::PlayedBlock next_{.caps = {0.05, 1e3, limits, 0.0}, .feed = feed};
  std::vector<plan::PlayedBlock> blocks_{80};
  std::vector<plan::BlockCaps> ahead_{64};
  std::vector<plan::Waypoint> waypoints_{65}, spare_{65};
  plan::Player player_;
};

constexpr int first = 100, last = 500;  // ticks at which something is asked for; it is at full speed then

}  // namespace

TEST_CASE("a hold on short blocks comes to rest in the least time, whenever it comes", "[player]") {
  for (int at = 5; at < last; ++at) {
    CAPTURE(at);
    Run run;
    const plan::Played now = run.tick(at);
    const auto least = profile::stop({now.velocity, now.acceleration}, limits);
    REQUIRE(least);
    (*run).hold();
    double time = 0.0;
    constexpr double short_period = 1e-4;
    do time += short_period;
    while (!run.tick(short_period).at_rest && time < 1.0);
    CHECK(time == Approx(least->duration()).margin(1.1 * short_period));
  }
}

TEST_CASE("an override on short blocks changes the speed within a tick, up and down", "[player]") {
  for (const double share : {0.0, 0.3, 0.9, 1.2, 2.0})
    for (int at = first; at < last; ++at) {
      CAPTURE(share, at);
      Run run, calm;
      run.tick(at), calm.tick(at);
      (*run).feed_override(share);
      const double change = run.tick().velocity - calm.tick().velocity;
      CHECK(change * (share - 1.0) > 0.0);
      if (share > 0.0) CHECK(run.tick(200).velocity == Approx(share * feed));
    }
}

TEST_CASE("running back begins with braking within a tick on short blocks too", "[player]") {
  for (int at = first; at < last; at += 7) {
    CAPTURE(at);
    Run run, calm;
    run.tick(at), calm.tick(at);
    (*run).backwards(true);
    CHECK(run.tick().velocity < calm.tick().velocity);
  }
}
