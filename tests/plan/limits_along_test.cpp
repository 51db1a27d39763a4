#include "cncplan/detail/speed/limits_along.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/line.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr int axis_count = 3;
using Bounds = BasicPathBounds<double, axis_count>;
using Mill = Machine<axis_count>;

// Zero now and then, as where an axis stands still.
double rate(test::Random& random, double low, double high) {
  return random.integer(0, 4) == 0 ? 0.0 : random.log_uniform(low, high);
}

Bounds draw_bounds(test::Random& random) {
  Bounds b;
  const bool straight = random.integer(0, 5) == 0;
  for (int i = 0; i < axis_count; ++i) {
    b.first[i] = rate(random, 1e-3, 10);
    if (straight) continue;
    b.second[i] = rate(random, 1e-5, 10);
    b.third[i] = rate(random, 1e-6, 100);
  }
  b.tool.first = random.integer(0, 4) == 0 ? 0.0 : random.coin() ? 1.0 : random.log_uniform(0.1, 3);
  if (straight || b.tool.first == 0.0) return b;
  b.tool.second_along = random.coin() ? 0.0 : random.log_uniform(1e-5, 1);
  b.tool.second_across = rate(random, 1e-5, 10);
  b.tool.third_along = rate(random, 1e-8, 10);
  b.tool.third_across = rate(random, 1e-8, 10);
  return b;
}

// All three limits, or one of acceleration and jerk.
template <class Limited>
void draw_limits(test::Random& random, Limited& of) {
  const int kind = random.integer(0, 5);
  of.velocity = random.log_uniform(1, 500);
  of.acceleration = kind == 0 ? infinity : random.log_uniform(10, 1e4);
  of.jerk = kind == 1 ? infinity : random.log_uniform(100, 1e6);
}

Mill draw_mill(test::Random& random) {
  Mill machine;
  draw_limits(random, machine.limits);
  for (Axis& axis : machine.axes) {
    draw_limits(random, axis);
    if (random.coin()) axis.velocity_down = axis.velocity * random.uniform(0.2, 2);
    if (random.coin()) axis.acceleration_down = axis.acceleration * random.uniform(0.2, 2);
  }
  return machine;
}

std::string describe(const Bounds& b, const Mill& machine) {
  std::ostringstream text;
  text.precision(17);
  text << "bounds first " << b.first.transpose() << ", second " << b.second.transpose() << ", third "
       << b.third.transpose() << ", tool " << b.tool.first << ' ' << b.tool.second_along << ' '
       << b.tool.second_across << ' ' << b.tool.third_along << ' ' << b.tool.third_across << ", limits "
       << machine.limits.velocity << ' ' << machine.limits.acceleration << ' ' << machine.limits.jerk;
  for (const Axis& axis : machine.axes)
    text << ", axis " << axis.velocity << ' ' << axis.acceleration << ' ' << axis.jerk << " down "
         << axis.velocity_down << ' ' << axis.acceleration_down;
  return text.str();
}

// A vector with so much along a direction and so much across it; across has two directions of its own.
struct Space {
  long double along, side, up;
  [[nodiscard]] long double norm() const { return std::sqrt(along * along + side * side + up * up); }
};

// Largest share of any limit that a state uses, where the path's derivatives are as large as the bounds say
// and lie as `random` says: brute force over what the bounds allow.
struct Shares {
  long double velocity = 0, acceleration = 0, jerk = 0;
};
Shares shares(test::Random& random, const Bounds& b, const Mill& machine, long double tool_speed,
              long double v, long double a, long double j, bool worst) {
  Shares s;
  const auto part = [&] { return worst ? (random.coin() ? 1.0L : -1.0L) : random.uniform(-1, 1); };
  const auto use = [](long double value, long double limit) { return std::abs(value) / limit; };
  for (int i = 0; i < axis_count; ++i) {
    const Axis& axis = machine.axes[static_cast<std::size_t>(i)];
    const long double q1 = b.first[i] * part(), q2 = b.second[i] * part(), q3 = b.third[i] * part();
    const long double down = axis.velocity_down > 0 ? axis.velocity_down : axis.velocity;
    const long double braking = axis.acceleration_down > 0 ? axis.acceleration_down : axis.acceleration;
    const long double speed = q1 * v, change = q2 * v * v + q1 * a;
    s.velocity = std::max(s.velocity, use(speed, speed < 0 ? down : axis.velocity));
    s.acceleration = std::max(s.acceleration, use(change, change < 0 ? braking : axis.acceleration));
    s.jerk = std::max(s.jerk, use(q3 * v * v * v + 3 * q2 * v * a + q1 * j, axis.jerk));
  }
  const long double turn = random.uniform(0, 2 * std::numbers::pi),
                    other = worst ? turn : random.uniform(0, 7);
  const long double r1 = b.tool.first * part();
  const Space r2{b.tool.second_along * part(), b.tool.second_across * std::cos(turn),
                 b.tool.second_across * std::sin(turn)};
  const Space r3{b.tool.third_along * part(), b.tool.third_across * std::cos(other),
                 b.tool.third_across * std::sin(other)};
  const long double v2 = v * v, v3 = v2 * v;
  s.velocity = std::max(s.velocity, use(r1 * v, tool_speed));
  s.acceleration = std::max(
      s.acceleration,
      use(Space{r2.along * v2 + r1 * a, r2.side * v2, r2.up * v2}.norm(), machine.limits.acceleration));
  s.jerk = std::max(s.jerk, use(Space{r3.along * v3 + 3 * r2.along * v * a + r1 * j,
                                      r3.side * v3 + 3 * r2.side * v * a, r3.up * v3 + 3 * r2.up * v * a}
                                    .norm(),
                                machine.limits.jerk));
  return s;
}

}  // namespace

TEST_CASE("no state within the limits along a path exceeds a limit of the tool or of an axis") {
  test::Random random;
  for (int draws = 0; draws < 5000; ++draws) {
    const Bounds bounds = draw_bounds(random);
    const Mill machine = draw_mill(random);
    const double speed = random.log_uniform(0.1, 1000);
    const double tool_speed = machine.limits.velocity * random.uniform(0.5, 2);
    const double length = random.coin() ? infinity : random.log_uniform(1e-3, 1e3);
    const Limits along = detail::limits_along(bounds, machine, speed, tool_speed, length);
    Shares worst;
    for (int state = 0; state < 200; ++state) {
      const bool extreme = state % 2 == 0;
      const auto part = [&] { return extreme ? (random.coin() ? 1.0 : -1.0) : random.uniform(-1, 1); };
      const long double v = along.velocity * std::abs(part());
      const long double a = std::isfinite(along.acceleration) ? along.acceleration * part() : 0.0;
      const long double j = std::isfinite(along.jerk) ? along.jerk * part() : 0.0;
      const Shares now = shares(random, bounds, machine, tool_speed, v, a, j, extreme);
      worst.velocity = std::max(worst.velocity, now.velocity);
      worst.acceleration = std::max(worst.acceleration, now.acceleration);
      worst.jerk = std::max(worst.jerk, now.jerk);
    }
    INFO(describe(bounds, machine) << ", speed " << speed << ", of the tool " << tool_speed << ", length "
                                   << length);
    INFO("limits along " << along.velocity << ' ' << along.acceleration << ' ' << along.jerk);
    REQUIRE(along.velocity > 0);
    REQUIRE(along.velocity <= speed);
    REQUIRE(along.acceleration > 0);
    REQUIRE(along.jerk > 0);
    REQUIRE(static_cast<double>(worst.velocity) <= 1 + 1e-14);
    REQUIRE(static_cast<double>(worst.acceleration) <= 1 + 1e-13);
    REQUIRE(static_cast<double>(worst.jerk) <= 1 + 1e-10);
  }
}

// Something is used up: rules that are merely safe would pass the test before this one.
TEST_CASE("the limits along a path use up a limit of some axis or of the tool") {
  test::Random random;
  int cases = 0;
  for (int draws = 0; draws < 2000; ++draws) {
    const Bounds bounds = draw_bounds(random);
    const Mill machine = draw_mill(random);
    if (bounds.first.isZero() && bounds.tool.first == 0) continue;
    const double speed = random.log_uniform(0.1, 1000), tool_speed = machine.limits.velocity;
    const double length = random.coin() ? infinity : random.log_uniform(1e-3, 1e3);
    const Limits along = detail::limits_along(bounds, machine, speed, tool_speed, length);
    if (!std::isfinite(along.jerk)) continue;
    ++cases;
    // The state at all limits, every derivative at its bound and with the same sign.
    const long double v = along.velocity, a = along.acceleration, j = along.jerk;
    const long double v3 = v * v * v;
    long double most = 0;
    for (int i = 0; i < axis_count; ++i)
      most = std::max(most, (bounds.third[i] * v3 +
                             (std::isfinite(along.acceleration) ? 3 * bounds.second[i] * v * a : 0.0L) +
                             bounds.first[i] * j) /
                                machine.axes[static_cast<std::size_t>(i)].jerk);
    const auto& tool = bounds.tool;
    const long double reach = std::isfinite(along.acceleration) ? 3 * v * a : 0.0L;
    const Space jerk{tool.third_along * v3 + tool.second_along * reach + tool.first * j,
                     tool.third_across * v3 + tool.second_across * reach, 0};
    most = std::max(most, jerk.norm() / machine.limits.jerk);
    INFO(describe(bounds, machine) << ", speed " << speed);
    REQUIRE(static_cast<double>(most) > 1 - 1e-6);
  }
  CHECK(cases > 1000);
}

// docs/planning.md, "On curves", without a length: the bend takes 0.8 of A or half of J.
Limits on_circle(double k, const Limits& whole) {
  const auto& [velocity, acceleration, jerk] = whole;
  const double v = std::min({velocity, std::sqrt(0.8 * acceleration / k), std::cbrt(0.5 * jerk / (k * k))});
  const double m = v * v * v * k * k;
  const double least_jerk = (std::sqrt(117 * m * m + 4 * jerk * jerk) - 11 * m) / 2;
  const double a =
      std::min(std::sqrt(acceleration * acceleration - v * v * v * v * k * k), std::sqrt(least_jerk * v));
  return {v, a, std::sqrt(jerk * jerk - 9 * v * v * k * k * a * a) - m};
}

TEST_CASE("on a circle the limits are those of the vector sums' closed form") {
  test::Random random;
  double worst = 0;
  for (int draws = 0; draws < 1000; ++draws) {
    Mill machine;  // axes without limits of their own
    machine.limits = {random.log_uniform(1, 500), random.log_uniform(10, 1e4), random.log_uniform(100, 1e6)};
    const double radius = random.log_uniform(0.01, 1e3);
    const auto circle = path::arc_from_center(Vector3(radius, 0, 0), Vector3(0, radius, 0), Vector3(0, 0, 0),
                                              Turn::counterclockwise, Plane::xy);
    REQUIRE(circle);
    const Limits along = detail::limits_along(circle->bounds(0, circle->length()), machine,
                                              machine.limits.velocity, machine.limits.velocity);
    const Limits closed = on_circle(1 / radius, machine.limits);
    for (const auto limit : {&Limits::velocity, &Limits::acceleration, &Limits::jerk})
      worst = std::max(worst, std::abs(along.*limit / closed.*limit - 1));
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("a straight line keeps the machine's limits bit for bit") {
  test::Random random;
  for (int draws = 0; draws < 300; ++draws) {
    Mill machine;
    draw_limits(random, machine.limits);
    const Vector3 from(random.uniform(-99, 99), random.uniform(-99, 99), random.uniform(-99, 99));
    const Vector3 to(random.uniform(-99, 99), random.uniform(-99, 99), random.uniform(-99, 99));
    const path::Line<3> line(from, to);
    const Limits along = detail::limits_along(line.bounds(0, line.length()), machine, machine.limits.velocity,
                                              machine.limits.velocity);
    REQUIRE(along == machine.limits);
  }
}

TEST_CASE("an axis that moves alone has its own limits, the lower of both directions") {
  Machine<1> machine;
  machine.axes[0].velocity = 40;
  machine.axes[0].velocity_down = 25;
  machine.axes[0].acceleration = 300;
  machine.axes[0].acceleration_down = 200;
  machine.axes[0].jerk = 3000;
  const path::Line<1> line(VectorN<double, 1>(0), VectorN<double, 1>(7));
  CHECK(detail::limits_along(line.bounds(0, 7), machine, 1e9, infinity) == Limits{25, 200, 3000});
  machine.axes[0].velocity_down = 60;
  machine.axes[0].acceleration_down = 0;
  CHECK(detail::limits_along(line.bounds(0, 7), machine, 1e9, infinity) == Limits{40, 300, 3000});
}

TEST_CASE("the tool's limits do not act where the tool stands still") {
  Machine<4> machine{.limits = {.velocity = 1, .acceleration = 2, .jerk = 3}};
  machine.axes[3].velocity = 5;
  machine.axes[3].acceleration = 70;
  machine.axes[3].jerk = 900;
  using V = VectorN<double, 4>;
  const path::Line<4> turns(V(1, 2, 3, 0), V(1, 2, 3, 2), 2, 0);
  CHECK(detail::limits_along(turns.bounds(0, 2), machine, 1e9, 1.0) == Limits{5, 70, 900});
}

TEST_CASE("what has no limit stays without one") {
  const Mill machine;
  const path::Line<3> line({0, 0, 0}, {3, 4, 0});
  CHECK(detail::limits_along(line.bounds(0, 5), machine, 12.0, infinity) == Limits{12, infinity, infinity});
}

// At the highest speed of all, the bend alone takes the whole limit: rounding must not lose it.
TEST_CASE("the limits hold on bends that take all there is at the highest speed tried") {
  test::Random random;
  long double worst = 0;
  for (int draws = 0; draws < 20000; ++draws) {
    Mill machine;
    machine.limits = {1e6, random.log_uniform(10, 1e4), random.log_uniform(1e4, 1e9)};
    Bounds bounds;
    const double curvature = random.log_uniform(1e-3, 10);
    bounds.tool = {1, 0, curvature, curvature * curvature, 0};
    const Limits along =
        detail::limits_along(bounds, machine, 1e6, 1e6, random.log_uniform(1 / curvature, 100 / curvature));
    const long double v = along.velocity;
    REQUIRE(along.acceleration > 0);
    REQUIRE(along.jerk > 0);
    worst = std::max(worst, std::hypot(v * v * curvature, static_cast<long double>(along.acceleration)) /
                                machine.limits.acceleration);
  }
  CHECK(static_cast<double>(worst) <= 1 + 1e-12);
}
