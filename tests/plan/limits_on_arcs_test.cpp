#include <algorithm>
#include <cmath>
#include <limits>

#include "cncplan/detail/speed/limits_along.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/profile/five_phase.hpp"
#include "cncplan/published/cap_speed.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Largest share of a limit, of vectors.
struct Worst {
  double acceleration{}, jerk{};
};

Limits draw(test::Random& random) {
  return {random.log_uniform(1, 500), random.log_uniform(10, 1e4), random.log_uniform(100, 1e6)};
}

// Limits along an arc of curvature k in a machine whose axes have none of their own.
template <std::floating_point S>
BasicLimits<S> along(S k, const BasicLimits<S>& whole, S length = std::numeric_limits<S>::infinity()) {
  BasicPathBounds<S, 3> bounds;
  bounds.tool = {S(1), S(0), k, k * k, S(0)};
  return detail::limits_along(bounds, BasicMachine<S, 3>{.limits = whole}, whole.velocity, whole.velocity,
                              length);
}

}  // namespace

TEST_CASE("what sharing leaves on the table") {
  test::Random random;
  double slowest = 1.0, least_jerk = 1.0;
  for (int draws = 0; draws < 100000; ++draws) {
    const Limits whole = draw(random);
    const double k = random.log_uniform(1e-4, 1e3);
    const Limits shared = along(k, whole);
    slowest = std::min(slowest, shared.velocity / published::cap_speed(k, 0, whole).velocity);
    least_jerk = std::min(least_jerk, shared.jerk / whole.jerk);
    REQUIRE(shared.acceleration > 0.0);
  }
  CHECK(slowest == Approx(std::cbrt(0.5)).margin(1e-12));  // 20.6 % slower where the jerk binds
  CHECK(least_jerk > 0.13);
  CHECK(least_jerk < 0.14);
}

// By every speed, acceleration and jerk of the region that such limits are for.
TEST_CASE("limits with ramps inside keep acceleration and jerk on every ramp within the bend, and use them") {
  test::Random random;
  int found = 0;
  double most = 0.0, least_gain = 1.0;
  for (int draws = 0; draws < 3000; ++draws) {
    INFO("seed " << test::seed() << ", draw " << draws);
    const Limits whole = draw(random);
    const double k = random.log_uniform(1e-3, 10), length = random.log_uniform(10, 300) / k;
    const bool spiral = draws % 3 == 2;
    BasicPathBounds<double, 3> bounds;
    bounds.tool = {1.0, spiral ? k * random.uniform(0, 0.3) : 0.0, k, k * k,
                   spiral ? k * k * random.uniform(0, 1) : 0.0};
    Machine<3> machine{.limits = whole};
    if (draws % 2 == 1) {
      machine.axes[1].acceleration = whole.acceleration * random.uniform(0.3, 1.5);
      machine.axes[1].jerk = whole.jerk * random.uniform(0.3, 1.5);
      bounds.first[1] = 1.0;
      bounds.second[1] = k;
      bounds.third[1] = k * k;
    }
    const auto machine_limits = detail::machine_limits(machine);
    const Limits box = detail::limits_along(bounds, machine_limits, whole.velocity, whole.velocity, length);
    const auto inside =
        detail::limits_with_ramps_inside(bounds, machine_limits, whole.velocity, whole.velocity, length, box);
    if (!inside) continue;
    ++found;
    const double velocity = inside->velocity, acceleration = inside->acceleration, jerk = inside->jerk;
    CHECK(length > 2.5 * velocity * std::max(std::sqrt(velocity / jerk), velocity / acceleration));
    least_gain = std::min(least_gain, detail::time_with_ramps(*inside, length, 1.0) /
                                          detail::time_with_ramps(box, length, 1.0));
    double worst = 0.0;
    for (int i = 0; i <= 500; ++i) {
      const double v = velocity * i / 500,
                   a = std::min(acceleration, std::sqrt(2 * jerk * std::max(velocity - v, 0.0)));
      const auto share = [&](const BasicToolBounds<double>& b, const Limits& limits) {
        const double along = b.first * a + b.second_along * v * v, across = b.second_across * v * v;
        const double jerk_along = b.first * jerk + 3 * b.second_along * v * a + b.third_along * v * v * v;
        const double jerk_across = 3 * b.second_across * v * a + b.third_across * v * v * v;
        return std::max(std::hypot(along, across) / limits.acceleration,
                        std::hypot(jerk_along, jerk_across) / limits.jerk);
      };
      worst = std::max(worst, share(bounds.tool, whole));
      if (draws % 2 == 1)
        worst = std::max(
            worst, share({1.0, k, 0.0, k * k, 0.0}, {0, machine.axes[1].acceleration, machine.axes[1].jerk}));
    }
    CHECK(worst <= 1 + 1e-9);
    most = std::max(most, worst);
  }
  CHECK(found > 300);
  CHECK(most > 0.98);
  CHECK(least_gain < 0.89);
}

TEST_CASE("over a known length limits are shared so that it takes less time, and never more") {
  const auto rest_to_rest = [](const Limits& l, double length) {
    const auto ramp = [&](double v) {
      return v * l.jerk >= l.acceleration * l.acceleration ? v / l.acceleration + l.acceleration / l.jerk
                                                           : 2.0 * std::sqrt(v / l.jerk);
    };
    double low = 0.0, high = l.velocity;
    if (high * ramp(high) <= length) return length / high + ramp(high);
    for (int i = 0; i < 60; ++i) {
      const double v = (low + high) / 2.0;
      (v * ramp(v) <= length ? low : high) = v;
    }
    return 2.0 * ramp(low);
  };
  const Limits kk22{30, 1000, 10000};
  const auto gain = [&](double radius, double turns) {
    const double length = 2.0 * 3.141592653589793 * radius * turns;
    return 1.0 - rest_to_rest(along(1.0 / radius, kk22, length), length) /
                     rest_to_rest(along(1.0 / radius, kk22), length);
  };
  CHECK(gain(1, 1) > 0.05);
  CHECK(gain(1, 10) > 0.09);
  CHECK(gain(1, 40) > 0.14);
  test::Random random;
  for (int draws = 0; draws < 2000; ++draws) {
    const double radius = random.log_uniform(0.1, 100), turns = random.log_uniform(0.05, 100);
    INFO(radius << ' ' << turns);
    CHECK(gain(radius, turns) >= -1e-12);
  }
}

TEST_CASE("a single arc keeps its limits as vectors, which its profile alone does not") {
  // the quarter circle of the first example, differenced twice and thrice over 0.1 ms
  const auto arc = path::arc_from_radius({0, 0, 0}, {5, 5, 0}, 5.0, Turn::clockwise, Plane::xy);
  REQUIRE(arc);
  const Limits limits{30.0, 1000.0, 10000.0};
  const auto worst = [&](const Limits& shared) {
    const auto profile = profile::five_phase(arc->length(), {0.0, 0.0}, shared);
    constexpr double h = 1e-4;
    Worst sums;
    const auto at = [&](double t) { return arc->position(arc->parameter_at(profile->at(t).position)); };
    for (double t = 2.0 * h; t < profile->duration() - 2.0 * h; t += h) {
      const Vector3 a = (at(t + h) - 2.0 * at(t) + at(t - h)) / (h * h);
      const Vector3 j =
          (at(t + 1.5 * h) - 3.0 * at(t + 0.5 * h) + 3.0 * at(t - 0.5 * h) - at(t - 1.5 * h)) / (h * h * h);
      sums.acceleration = std::max(sums.acceleration, a.norm() / limits.acceleration);
      sums.jerk = std::max(sums.jerk, j.norm() / limits.jerk);
    }
    return sums;
  };
  CHECK(worst(limits).jerk > 1.1);
  const Worst kept = worst(detail::limits_along(arc->bounds(0, arc->length()), Machine<3>{.limits = limits},
                                                30.0, 30.0, arc->length()));
  CHECK(kept.acceleration <= 1.0);
  CHECK(kept.jerk < 1.001);
  CHECK(kept.jerk > 0.5);
}

TEST_CASE("limits that are not there stay so on a bend") {
  const Limits no_jerk = along(0.1, Limits{30, 1000, infinity});
  CHECK(no_jerk.jerk == infinity);
  CHECK(std::hypot(no_jerk.acceleration, 90.0) == Approx(1000.0).epsilon(1e-14));
  const Limits no_acceleration = along(0.1, Limits{30, infinity, 10000});
  CHECK(std::isfinite(no_acceleration.acceleration));
  const auto [v, a, j] = no_acceleration;
  CHECK(std::hypot(-j - v * v * v * 0.01, 3 * v * a * 0.1) <= 10000 * (1 + 1e-12));
}

TEST_CASE("limits on a bend in float are those of double") {
  const auto narrow = along(2.0f, BasicLimits<float>{30.0f, 1000.0f, 10000.0f});
  const auto wide = along(2.0, Limits{30, 1000, 10000});
  CHECK(narrow.velocity == Approx(wide.velocity).epsilon(1e-6));
  CHECK(narrow.acceleration == Approx(wide.acceleration).epsilon(1e-5));
  CHECK(narrow.jerk == Approx(wide.jerk).epsilon(1e-5));
}
