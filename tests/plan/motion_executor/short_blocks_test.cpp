// Requests on blocks that are much shorter than the way to rest: they act at the next tick.
#include <vector>

#include "cncplan/detail/executor/motion_executor.hpp"
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
  Run() : motion_executor_({blocks_, ahead_, junctions_, spare_}) {}

  detail::MotionSetPoint tick(double seconds = period) {
    while (motion_executor_.push(next_)) next_.segment_limits.length = random_.log_uniform(0.01, 0.1);
    return motion_executor_.tick(seconds);
  }
  detail::MotionSetPoint tick(int count) {
    detail::MotionSetPoint now = tick();
    for (int i = 1; i < count; ++i) now = tick();
    return now;
  }
  detail::MotionExecutor& operator*() { return motion_executor_; }

 private:
  test::Random random_;
  detail::MotionBlock next_{.segment_limits = {0.05, 1e3, limits, 0.0}, .feed = feed};
  std::vector<detail::MotionBlock> blocks_{80};
  std::vector<detail::SegmentLimits> ahead_{64};
  std::vector<detail::ConstrainedJunction> junctions_{65}, spare_{65};
  detail::MotionExecutor motion_executor_;
};

constexpr int first = 100, last = 500;  // ticks at which something is asked for; it is at full speed then

}  // namespace

TEST_CASE("a hold on short blocks comes to rest in the least time, whenever it comes", "[motion_executor]") {
  for (int at = 5; at < last; ++at) {
    CAPTURE(at);
    Run run;
    const detail::MotionSetPoint now = run.tick(at);
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

TEST_CASE("an override on short blocks changes the speed within a tick, up and down", "[motion_executor]") {
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

TEST_CASE("running back begins with braking within a tick on short blocks too", "[motion_executor]") {
  for (int at = first; at < last; at += 7) {
    CAPTURE(at);
    Run run, calm;
    run.tick(at), calm.tick(at);
    (*run).backwards(true);
    CHECK(run.tick().velocity < calm.tick().velocity);
  }
}
