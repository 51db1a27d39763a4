#include "cncplan/detail/executor/ramp_ahead.hpp"

#include <algorithm>
#include <vector>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

constexpr Limits limits{30.0, 1000.0, 10000.0};

}  // namespace

TEST_CASE("a ramp keeps the limits of every block that it touches, or there is none") {
  test::Random random;
  int ramps = 0, refused = 0;
  double excess = 0.0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<detail::MotionBlock> memory(32);
    detail::BasicPathAhead<double> path(memory);
    for (int b = 0; b < 20; ++b) {
      Limits of_block = limits;
      if (random.integer(0, 3) == 0)
        of_block = {random.uniform(10, 30), random.uniform(300, 1000), random.uniform(3000, 10000)};
      const double cap = random.integer(0, 2) == 0 ? random.uniform(0, 30) : 1e3;
      path.ring.push({{random.log_uniform(0.05, 5), cap, of_block, 0.0}, 30.0});
    }
    path.ring.take();
    const Limits& here = path.ring[0].segment_limits.limits;
    const double a = random.uniform(-1, 1) * here.acceleration;
    const double v = random.uniform(0, here.velocity) + (a < 0 ? a * a / (2 * here.jerk) : 0.0);
    const auto ramp = detail::ramp_ahead(path, {0, 0.0}, {0, v, a, 0}, random.uniform(0, 30));
    refused += ramp ? 0 : 1;
    if (!ramp) continue;
    ++ramps;
    detail::BasicPlace<double> at{0, 0.0};
    for (int k = 0; k <= 400; ++k) {
      const State state = ramp->at(ramp->duration() * k / 400);
      const auto before = at.block;
      at = path.advance({0, 0.0}, state.position);
      const Limits& there = path.ring[at.block].segment_limits.limits;
      const double allowed = std::max(there.velocity, at.block == 0 ? v : 0.0);
      excess = std::max({excess, state.velocity / allowed - 1,
                         std::abs(state.acceleration) / there.acceleration - 1,
                         std::abs(state.jerk) / there.jerk - 1});
      if (at.block == before) continue;
      const double cap = path.ring[at.block].segment_limits.entry;
      const double crossed = ramp->at(ramp->time_at(state.position - at.along)).velocity;
      excess = std::max(excess, (crossed - cap) / 30.0);
    }
  }
  CAPTURE(refused);
  CHECK(ramps > 500);
  CHECK(refused > 500);
  CHECK(excess < 1e-9);
}

TEST_CASE("a ramp that crests above both its speeds is held to a junction there") {
  std::vector<detail::MotionBlock> memory(4);
  detail::BasicPathAhead<double> path(memory);
  path.ring.push({{0.2, 0.0, limits, 0.0}, 30.0});
  path.ring.push({{5.0, 1e3, {10.3, 1000.0, 10000.0}, 0.0}, 30.0});
  path.ring.take();
  // 10 mm/s and rising: over 11 before it can come down to 10.2
  CHECK_FALSE(detail::ramp_ahead(path, {0, 0.0}, {0, 10.0, 150.0, 0}, 10.2));
}

TEST_CASE("a ramp that comes to rest on the way does not pass a junction that is passed at rest") {
  // braking, at rest but for rounding where the first block ends, and going on at once: near
  // cncplan_executor_soak
  // --seed 81004 --lines 4, sequence 2041
  const BasicLimits<float> same{2.35F, 142.71875F, 8667.50684F};
  const auto ramp_over = [&](float length, float cap, float speed) {
    std::vector<detail::BasicMotionBlock<float>> memory(4);
    detail::BasicPathAhead<float> path(memory);
    path.ring.push({{length, 1e3F, same, 0}, 2.35F});
    path.ring.push({{5, cap, same, 0}, 2.35F});
    path.ring.take();
    const BasicState<float> now{0, speed, -57.8127899F, 0};
    return detail::ramp_ahead<float>(path, {0, 0}, now, 2.19574857F).has_value();
  };
  int at_speed = 0, at_rest = 0;
  for (int i = -40; i <= 40; ++i)
    for (int k = -10; k <= 10; ++k) {
      const float length = 0.000428678701F * (1 + 1e-7F * static_cast<float>(i));
      const float speed = 0.192807347F * (1 + 1e-7F * static_cast<float>(k));
      at_speed += ramp_over(length, 1, speed) ? 1 : 0;
      at_rest += ramp_over(length, 0, speed) ? 1 : 0;
    }
  CHECK(at_speed == 81 * 21);
  CHECK(at_rest == 0);
}
