#include "cncplan/profile/stretch.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/profile_oracle.hpp"

using namespace cncplan;

namespace {

// All times that a middle speed gives, by trying many of them: each with two ramps that fit.
class MiddleSpeeds {
 public:
  MiddleSpeeds(const test::ProfileCase& move, double top) : move_(move), top_(top) {}

  // Whether the times of two neighbours enclose one that a speed between them gives; clear of rounding.
  [[nodiscard]] bool give(double duration) const {
    test::Real before = top_;
    for (int i = 1; i < count; ++i) {
      const test::Real speed = at(i);
      if (fits(speed) && fits(before) && time(speed) > duration * (1 + margin) &&
          time(before) < duration * (1 - margin)) {
        test::Real slow = speed, fast = before;
        for (int halving = 0; halving < 60; ++halving)
          (time((slow + fast) / 2) > duration ? slow : fast) = (slow + fast) / 2;
        if (fits(slow)) return true;
      }
      before = speed;
    }
    return false;
  }

  // The longest time below one.
  [[nodiscard]] double longest_below(double duration) const {
    test::Real longest = 0;
    for (int i = 1; i < count; ++i)
      if (fits(at(i)) && time(at(i)) < duration) longest = std::max(longest, time(at(i)));
    return static_cast<double>(longest);
  }

 private:
  static constexpr int count = 400;
  static constexpr test::Real margin = 1e-9L;

  // From the top down: evenly over twelve decades, or over the speeds.
  [[nodiscard]] test::Real at(int i) const {
    const test::Real share = static_cast<test::Real>(i) / count;
    return share < 0.5L ? top_ * (1 - share * 1.9L) : top_ * 0.05L * std::pow(10.0L, (0.5L - share) * 24);
  }
  [[nodiscard]] test::Real ramps(test::Real speed) const {
    const Limits& limits = move_.limits;
    return test::ramp_distance(move_.speeds.start, speed, limits.acceleration, limits.jerk, true) +
           test::ramp_distance(speed, move_.speeds.end, limits.acceleration, limits.jerk, true);
  }
  [[nodiscard]] bool fits(test::Real speed) const { return ramps(speed) < move_.length * (1 - margin); }
  [[nodiscard]] test::Real time(test::Real speed) const {
    const Limits& limits = move_.limits;
    const auto ramp = [&](test::Real from, test::Real to) {
      return 2 * test::ramp_distance(from, to, limits.acceleration, limits.jerk, true) / (from + to);
    };
    return ramp(move_.speeds.start, speed) + ramp(speed, move_.speeds.end) +
           (move_.length - ramps(speed)) / speed;
  }

  test::ProfileCase move_;
  test::Real top_;
};

}  // namespace

TEST_CASE("a stretched move takes the time it is given, within the limits") {
  test::Random random;
  double worst_time = 0.0;
  test::ProfileErrors worst;
  int solved = 0, refused = 0, near_rest = 0;
  for (int n = 0; n < 30000; ++n) {
    const test::ProfileCase c = test::draw(random);
    const auto fastest = profile::seven_phase(c.length, c.speeds, c.limits);
    if (!fastest) continue;
    const double duration = fastest->duration() * random.log_uniform(1.0, random.coin() ? 4.0 : 40.0);
    const auto p = profile::stretched(c.length, c.speeds, duration, c.limits);
    INFO(c.literal());
    if (!p) {
      REQUIRE(p.error().code == ErrorCode::above_limit);
      ++refused;
      const MiddleSpeeds middle(c, fastest->top_velocity());
      CAPTURE(duration, p.error().bound);
      REQUIRE_FALSE(middle.give(duration));
      REQUIRE(p.error().bound >= middle.longest_below(duration) * (1 - 1e-9));
      REQUIRE(profile::stretched(c.length, c.speeds, p.error().bound, c.limits));
      continue;
    }
    ++solved;
    near_rest += p->top_velocity() < std::min(c.speeds.start, c.speeds.end) / 3 ? 1 : 0;
    worst_time = std::max(worst_time, std::abs(p->duration() / duration - 1));
    const auto errors = test::examine(c, *p);
    // rounding of a speed lasts all the time, and may be large beside a middle speed
    const double reach = std::max(c.length, std::max(c.speeds.start, c.speeds.end) * duration);
    worst.end_position = std::max(worst.end_position, errors.end_position * c.length / reach);
    worst.end_speed = std::max(worst.end_speed, errors.end_speed);
    worst.acceleration_excess = std::max(worst.acceleration_excess, errors.acceleration_excess);
    worst.velocity_excess = std::max(worst.velocity_excess, errors.velocity_excess);
    worst.lowest_speed = std::max(worst.lowest_speed, errors.lowest_speed);
  }
  CHECK(solved > 10000);
  CHECK(refused > 100);
  CHECK(near_rest > 100);
  CHECK(worst_time < 1e-12);
  CHECK(worst.end_position < 16.0);
  CHECK(worst.end_speed < 16.0);
  CHECK(worst.acceleration_excess < 1e-12);
  CHECK(worst.velocity_excess < 1e-12);
  CHECK(worst.lowest_speed < 1e-12);
}

TEST_CASE("from rest to rest any longer time can be had") {
  const Limits limits{30.0, 1000.0, 10000.0};
  const auto fastest = profile::seven_phase(5.0, {0.0, 0.0}, limits);
  for (const double times : {1.0, 1.0001, 2.0, 100.0}) {
    const auto p = profile::stretched(5.0, {0.0, 0.0}, times * fastest->duration(), limits);
    REQUIRE(p);
    CHECK(p->duration() == Approx(times * fastest->duration()).epsilon(1e-12));
  }
}

TEST_CASE("where ramps near the end speeds are too long, it nearly comes to rest and cruises there") {
  const Limits limits{30.0, 1000.0, 10000.0};
  for (const double duration : {0.1, 0.1185, 0.1786, 1.0, 1000.0}) {
    const auto p = profile::stretched(1.85, {20.0, 20.0}, duration, limits);
    CAPTURE(duration);
    REQUIRE(p);
    CHECK(p->duration() == Approx(duration).epsilon(1e-12));
  }
  CHECK(profile::stretched(1.85, {20.0, 20.0}, 1.0, limits)->top_velocity() ==
        Approx(0.0706107).epsilon(1e-6));
  CHECK(profile::stretched(1.85, {20.0, 20.0}, 0.15, limits).error().bound == Approx(0.1185).epsilon(1e-3));
}

TEST_CASE("times out of reach are refused with the bound") {
  const Limits limits{30.0, 1000.0, 10000.0};
  const auto fastest = profile::seven_phase(5.0, {0.0, 0.0}, limits);
  const auto shorter = profile::stretched(5.0, {0.0, 0.0}, 0.5 * fastest->duration(), limits);
  CHECK(shorter.error() ==
        Error{ErrorCode::below_limit, "duration", 0.5 * fastest->duration(), fastest->duration()});
  const auto longer = profile::stretched(0.5, {20.0, 20.0}, 10.0, limits);  // cannot slow down that far
  REQUIRE_FALSE(longer);
  CHECK(longer.error().code == ErrorCode::above_limit);
  CHECK(profile::stretched(0.5, {20.0, 20.0}, longer.error().bound, limits));
}
