// The closed loop: a state is read off a profile, and motion planned again from there over what is left.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/from_state.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "profile/state_case.hpp"
#include "support/catch.hpp"
#include "support/profile_oracle.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

using test::Real;
using test::Travelled;

// The worst of one kind, and its case.
struct Largest {
  double value = 0;
  std::string where{};

  void grow(Real found, const std::string& text) {
    if (static_cast<double>(found) > value) value = static_cast<double>(found), where = text;
  }
};

struct Worst {
  // in epsilons of the highest speed: the start beside the state, the end speed, below zero, above the limit
  Largest start, end, below, above;
  Largest position;  // of the end, beyond what a speed within rounding takes, as a share of length and way to
                     // rest
  Largest steepness;  // above the acceleration limit, as a share
  Largest refused;
  int states = 0;
};

// The way to rest from a speed, at least: by its definition.
template <class S>
Real way_to_rest(S speed, const BasicLimits<S>& limits) {
  return test::ramp_distance(speed, 0, limits.acceleration, limits.jerk, true);
}

// Plans again from a state of a profile.
template <class S>
void again(const profile::BasicProfile<S>& p, S t, const BasicLimits<S>& limits, Worst& worst) {
  constexpr Real epsilon = std::numeric_limits<S>::epsilon();
  const auto s = p.at(t);
  const S left = p.length() - s.position;
  const profile::BasicStartState<S> state{s.velocity, s.acceleration};
  const std::string text = test::StateCase{
      left,
      {s.velocity, s.acceleration},
      p.end_velocity(),
      Limits{limits.velocity, limits.acceleration,
             limits.jerk}}.literal();
  const Real fastest = std::max<Real>(limits.velocity, p.peak().velocity);
  const auto examine = [&](const profile::BasicProfile<S>& q, Real length, Real end_speed) {
    const Travelled done = test::integrate({q.start_velocity(), q.start_acceleration()}, q);
    // What is left of the acceleration, by rounding, adds up over the time.
    const Real steepest = std::min<Real>(done.steepest, limits.acceleration);
    const Real unit = epsilon * (fastest + steepest * done.duration);
    worst.start.grow(std::abs(q.start_velocity() - static_cast<Real>(s.velocity)) / fastest / epsilon, text);
    worst.end.grow(std::abs(done.velocity - end_speed) / unit, text);
    worst.below.grow(-done.lowest / unit, text);
    worst.above.grow((done.highest - fastest) / unit, text);
    worst.steepness.grow(done.steepest / limits.acceleration - 1, text);
    const Real late = 4 * std::sqrt(epsilon * fastest / limits.jerk) +
                      16 * epsilon * steepest * done.duration * done.duration / fastest;
    const Real off = std::abs(done.position - length) - late * fastest;
    worst.position.grow(off / (length + way_to_rest(static_cast<S>(fastest), limits)), text);
  };
  ++worst.states;
  const auto stopped = profile::stop(state, limits);
  const auto planned = profile::from_state(left, state, p.end_velocity(), limits);
  if (!stopped || !planned) return worst.refused.grow(1, text + (stopped ? "" : ", stop"));
  examine(*stopped, stopped->length(), 0);
  examine(*planned, std::max<Real>(left, 0), p.end_velocity());
  CHECK(planned->length() == std::max(left, S(0)));
  CHECK(planned->at(planned->duration()).position == planned->length());
  CHECK(planned->at(planned->duration()).velocity == p.end_velocity());
}

// Over a grid, at random, where phases meet, and close to the end. Of profiles no longer than `longest` times
// the way to rest and the time to build up the acceleration: what the header promises.
template <class S>
void loop(const profile::BasicProfile<S>& p, const BasicLimits<S>& limits, double longest,
          test::Random& random, Worst& worst) {
  const S total = p.duration();
  if (p.length() > longest * way_to_rest(limits.velocity, limits)) return;
  if (total > longest * limits.acceleration / limits.jerk) return;
  constexpr int instants = 8;
  for (int i = 0; i < instants; ++i) {
    again(p, total * static_cast<S>(i) / static_cast<S>(instants), limits, worst);
    again(p, total * static_cast<S>(random.uniform(0.0, 1.0)), limits, worst);
    again(p, total - total * static_cast<S>(random.log_uniform(1e-16, 1.0)), limits, worst);
  }
  for (const auto& phase : p.phases())
    for (const S t : {std::nextafter(phase.time, S(0)), phase.time, std::nextafter(phase.time, total)})
      again(p, t, limits, worst);
  again(p, total, limits, worst);
}

template <class S>
void check(const Worst& worst) {
  constexpr double epsilon = std::numeric_limits<S>::epsilon();
  constexpr double share = std::max(1e-11, 64 * epsilon) + 8 * epsilon;
  const auto within = [](const char* what, const Largest& largest, double bound) {
    INFO(what << ": " << largest.where);
    CHECK(largest.value < bound);
  };
  CHECK(worst.states > 20000);
  within("refused", worst.refused, 1);
  within("start", worst.start, 17);
  within("end speed", worst.end, 17);
  within("below zero", worst.below, 17);
  within("above the speed limit", worst.above, 17);
  within("end", worst.position, share);
  within("above the acceleration limit", worst.steepness, share);
}

template <class S>
BasicLimits<S> draw_limits(test::Random& random) {
  return {static_cast<S>(random.log_uniform(0.1, 1e3)), static_cast<S>(random.log_uniform(10.0, 1e5)),
          static_cast<S>(random.log_uniform(100.0, 1e8))};
}

// Stops, moves from rest to rest and between speeds, by both laws, up to `longest` ways to rest.
template <class S>
void random_loops(int profiles, double longest, Worst& worst) {
  test::Random random;
  for (int n = 0; n < profiles; ++n) {
    const BasicLimits<S> limits = draw_limits<S>(random);
    const auto speed = [&] {
      return random.integer(0, 4) == 0 ? limits.velocity
                                       : limits.velocity * static_cast<S>(random.log_uniform(1e-3, 1.0));
    };
    const S most = std::min(limits.acceleration, std::sqrt(limits.velocity * limits.jerk));
    const profile::BasicStartState<S> start{
        speed(), random.coin() ? S(0) : most * static_cast<S>(random.uniform(-1.0, 1.0))};
    const S settled = profile::settled_speed(start, limits);
    if (const auto p = profile::stop(start, limits); p && settled <= limits.velocity)
      loop(*p, limits, longest, random, worst);
    const S length = static_cast<S>(way_to_rest(limits.velocity, limits) * random.log_uniform(1e-3, longest));
    const profile::BasicBoundarySpeeds<S> rest{}, speeds{speed(), speed()}, down{speed(), S(0)};
    for (const auto& ends : {rest, speeds, down}) {
      if (const auto p = profile::five_phase(length, ends, limits)) loop(*p, limits, longest, random, worst);
      if (const auto p = profile::seven_phase(length, ends, limits)) loop(*p, limits, longest, random, worst);
    }
    // just long enough
    const S direct =
        static_cast<S>(test::ramp_distance(speeds.start, speeds.end, limits.acceleration, limits.jerk, true) *
                       1.0000000001L);
    if (const auto p = profile::seven_phase(direct, speeds, limits)) loop(*p, limits, longest, random, worst);
    if (settled <= limits.velocity)
      if (const auto p = profile::from_state(length, start, speeds.end, limits))
        loop(*p, limits, longest, random, worst);
  }
}

}  // namespace

TEST_CASE("planning goes on from every state of a profile: usual limits, by the millisecond") {
  const Limits limits{30.0, 1000.0, 10000.0};
  test::Random random;
  Worst worst;
  const auto by_the_millisecond = [&](const profile::Profile& p) {
    loop(p, limits, 1e4, random, worst);
    for (int i = 0; i * 1e-3 < p.duration(); ++i) again(p, i * 1e-3, limits, worst);
  };
  by_the_millisecond(*profile::stop({20.0, 300.0}, limits));
  for (int v = 1; v <= 30; ++v) by_the_millisecond(*profile::stop({v * 1.0, 0.0}, limits));
  for (double length = 0.01; length < 40.0; length *= 1.3) {
    by_the_millisecond(*profile::five_phase(length, {0.0, 0.0}, limits));
    by_the_millisecond(*profile::seven_phase(length, {0.0, 0.0}, limits));
  }
  check<double>(worst);
}

TEST_CASE("planning goes on from every state of a profile: random profiles") {
  Worst worst;
  random_loops<double>(test::cases(1500), 1e4, worst);
  check<double>(worst);
}

TEST_CASE("planning goes on from every state of a profile: in float") {
  Worst worst;
  random_loops<float>(test::cases(1500), 10.0, worst);
  check<float>(worst);
}

TEST_CASE("planning goes on from every state of a profile: without a limit of acceleration, or of jerk") {
  constexpr double none = std::numeric_limits<double>::infinity();
  for (const Limits& limits : {Limits{30.0, none, 10000.0}, Limits{30.0, 1000.0, none}})
    for (const profile::BoundarySpeeds speeds : {profile::BoundarySpeeds{0.0, 0.0}, {20.0, 7.0}, {0.3, 30.0}})
      for (double length = 0.7; length < 40.0; length *= 1.3) {
        const auto p = profile::seven_phase(length, speeds, limits);
        if (!p) continue;
        for (int i = 0; i <= 1000; ++i) {
          const State s = p->at(p->duration() * i / 1000);
          const double left = p->length() - s.position;
          const test::StateCase c{left, {s.velocity, s.acceleration}, speeds.end, limits};
          INFO(c.literal());
          REQUIRE(profile::stop(c.start, limits));
          const auto q = profile::from_state(left, c.start, speeds.end, limits);
          REQUIRE(q);
          REQUIRE(std::isfinite(q->at(q->duration() / 2).position));
        }
      }
}

TEST_CASE("a length shorter than the way to rest by rounding is enough, by more is refused") {
  const Limits limits{30.0, 1000.0, 10000.0};
  const profile::StartState start{20.0, 300.0};
  const double way = profile::stop(start, limits)->length();
  const auto p = profile::from_state(std::nextafter(way, 0.0), start, 0.0, limits);
  REQUIRE(p);
  CHECK(p->length() == std::nextafter(way, 0.0));
  CHECK_FALSE(profile::from_state(way * (1 - 1e-9), start, 0.0, limits));
}
