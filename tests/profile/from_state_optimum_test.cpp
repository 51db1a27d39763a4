// `from_state` against a search: motions of up to four ramps of acceleration with holds of any height between
// them, drawn at random and refined by trial. None may be faster, and the search must come near, or it proves
// nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cncplan/profile/from_state.hpp"
#include "profile/state_case.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

using RandomMove = test::StateCase;

// Accelerations held, and for how long the first is; the other two holds follow from speed and length.
struct Choice {
  std::array<double, 3> held;
  double first_hold;
};

struct Motion {
  double position, velocity, acceleration, duration, lowest, highest;

  void advance(double time, double jerk) {
    const double last = acceleration + jerk * time;
    if (acceleration * last < 0.0) note(velocity - acceleration * acceleration / (2.0 * jerk));
    position += time * (velocity + time * (acceleration / 2.0 + time * jerk / 6.0));
    velocity += time * (acceleration + time * jerk / 2.0);
    acceleration = last;
    duration += time;
    note(velocity);
  }
  void note(double speed) {
    lowest = std::min(lowest, speed);
    highest = std::max(highest, speed);
  }
};

Motion drive(const RandomMove& move, const Choice& choice, double second_hold, double third_hold) {
  const double v = move.start.velocity;
  Motion motion{0.0, v, move.start.acceleration, 0.0, v, v};
  const std::array<double, 3> holds{choice.first_hold, second_hold, third_hold};
  const auto ramp_to = [&](double acceleration) {
    const double change = acceleration - motion.acceleration;
    motion.advance(std::abs(change) / move.limits.jerk, std::copysign(move.limits.jerk, change));
    motion.acceleration = acceleration;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    ramp_to(choice.held[i]);
    motion.advance(holds[i], 0.0);
  }
  ramp_to(0.0);
  return motion;
}

// Time of the motion with these holds that meets end speed and length within the limits; infinite if none.
double time_of(const RandomMove& move, const Choice& choice) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const auto [a1, a2, a3] = choice.held;
  if (a3 == 0.0) return none;
  const double lacking = move.end - drive(move, choice, 0.0, 0.0).velocity;
  const auto third = [&](double second) { return (lacking - choice.held[1] * second) / choice.held[2]; };
  // The distance is a quadratic function of the second hold.
  const auto distance = [&](double second) {
    return drive(move, choice, second, third(second)).position - move.length;
  };
  const double unit = move.length / move.limits.velocity;
  const double y0 = distance(0.0), y1 = distance(unit), y2 = distance(2.0 * unit);
  const double square = (y2 - 2.0 * y1 + y0) / 2.0, linear = y1 - y0 - square;
  const double discriminant = linear * linear - 4.0 * square * y0;
  if (!(discriminant >= 0.0)) return none;
  const double q = -(linear + std::copysign(std::sqrt(discriminant), linear)) / 2.0;
  double best = none;
  for (const double root : {q / square, y0 / q}) {
    const double second = root * unit;
    if (!(second >= 0.0 && third(second) >= 0.0 && std::isfinite(second))) continue;
    const Motion motion = drive(move, choice, second, third(second));
    const double slack = 1e-10 * move.limits.velocity;
    if (motion.lowest < -slack || motion.highest > move.limits.velocity + slack ||
        std::abs(motion.position - move.length) > 1e-9 * move.length)
      continue;
    best = std::min(best, motion.duration);
  }
  return best;
}

double searched(const RandomMove& move, test::Random& random) {
  const double a = move.limits.acceleration;
  const double longest = move.length / move.limits.velocity;
  const auto acceleration = [&] {
    switch (random.integer(0, 5)) {
      case 0:
        return a;
      case 1:
        return -a;
      case 2:
        return move.start.acceleration;
      default:
        return a * random.uniform(-1.0, 1.0);
    }
  };
  Choice best{};
  double time = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < 12000; ++trial) {
    const double spread = std::pow(10.0, -1.0 - 4.0 * (trial - 4000) / 8000.0);
    Choice choice{};
    if (trial < 4000 || !std::isfinite(time)) {
      choice.held = {acceleration(), random.coin() ? 0.0 : acceleration(), acceleration()};
      choice.first_hold = random.coin() ? 0.0 : longest * random.uniform(0.0, 2.0);
    } else {
      choice = best;
      for (double& held : choice.held)
        if (random.coin()) held = std::clamp(held + a * spread * random.uniform(-1.0, 1.0), -a, a);
      if (random.coin())
        choice.first_hold = std::max(choice.first_hold + longest * spread * random.uniform(-1.0, 1.0), 0.0);
    }
    const double found = time_of(move, choice);
    if (found < time) time = found, best = choice;
  }
  return time;
}

RandomMove draw_move(test::Random& random) {
  for (;;) {
    RandomMove move{};
    move.limits = {random.log_uniform(1.0, 100.0), random.log_uniform(10.0, 3000.0),
                   random.log_uniform(100.0, 1e5)};
    const double most =
        std::min(move.limits.acceleration, std::sqrt(move.limits.velocity * move.limits.jerk));
    move.start = {move.limits.velocity * random.uniform(0.0, 1.0), most * random.uniform(-1.0, 1.0)};
    const double settled = profile::settled_speed(move.start, move.limits);
    if (settled < 0.0 || settled > move.limits.velocity) continue;
    move.end = random.coin() ? 0.0 : move.limits.velocity * random.uniform(0.0, 1.0);
    const double scale = move.limits.velocity * (std::sqrt(move.limits.velocity / move.limits.jerk) +
                                                 move.limits.velocity / move.limits.acceleration);
    move.length = scale * random.log_uniform(1e-3, 3.0);
    if (profile::from_state(move.length, move.start, move.end, move.limits)) return move;
  }
}

}  // namespace

TEST_CASE("no motion that a search finds is faster than from_state's") {
  test::Random random;
  constexpr int moves = 150;
  int near = 0;
  double fastest = 2.0;
  RandomMove where{};
  for (int n = 0; n < moves; ++n) {
    const RandomMove move = draw_move(random);
    const auto profile = profile::from_state(move.length, move.start, move.end, move.limits);
    const double ratio = searched(move, random) / profile->duration();
    if (ratio < fastest) fastest = ratio, where = move;
    near += ratio < 1.005 ? 1 : 0;
  }
  INFO(where.literal() << ", near in " << near);
  CHECK(fastest > 1.0 - 1e-8);
  CHECK(near > moves * 8 / 10);
}
