// Exact step times against bisection in long double and against step counts known beforehand.
#include "cncplan/step/crossing.hpp"

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/step/detail/traced_path.hpp"
#include "cncplan/step/merge.hpp"
#include "doubles.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;
using test::SineAxis;
using test::Straight;

namespace {

// A curve without closed forms: what TracedPath gets.
struct BareSine {
  using Scalar = double;
  using Vector = VectorN<double, 2>;
  SineAxis<double> curve;
  [[nodiscard]] double length() const { return curve.length(); }
  [[nodiscard]] double parameter_end() const { return curve.end; }
  [[nodiscard]] double length_at(double u) const { return u; }
  [[nodiscard]] Vector position(double u) const { return curve.position(u); }
  [[nodiscard]] Vector derivative(double u) const { return curve.derivative(u); }
  [[nodiscard]] Vector second_derivative(double u) const { return curve.second_derivative(u); }
};

template <class P, class C>
std::vector<step::BasicEdge<typename P::Scalar>> all(step::StepCursor<P, C>& cursor) {
  std::vector<step::BasicEdge<typename P::Scalar>> edges;
  while (const auto edge = cursor.next()) edges.push_back(*edge);
  return edges;
}

long double length_at_time(const std::vector<Phase>& phases, long double t) {
  std::size_t i = 0;
  while (i + 1 < phases.size() && t > static_cast<long double>(phases[i + 1].time)) ++i;
  const Phase& p = phases[i];
  const long double x = t - static_cast<long double>(p.time);
  return p.position + x * (p.velocity + x * (p.acceleration / 2.0L + x * p.jerk / 6.0L));
}

struct Found {
  long double time;
  int direction;
};

// A dense scan in time with bisection between the samples, of count = the nearest integer with hysteresis.
std::vector<Found> brute_force(const std::vector<Phase>& phases, long double amplitude, double per_unit,
                               int samples) {
  const auto position = [&](long double t) {
    return amplitude * std::sin(length_at_time(phases, t)) * static_cast<long double>(per_unit);
  };
  const long double end = static_cast<long double>(phases.back().time + phases.back().duration);
  std::vector<Found> found;
  std::int64_t count = 0;
  for (int k = 1; k <= samples; ++k) {
    const long double from = end * (k - 1) / samples, to = end * k / samples, q = position(to);
    for (;;) {
      const int direction = q > static_cast<long double>(count) ? 1 : -1;
      long double boundary = static_cast<long double>(count) + direction * 0.5L;
      if (!found.empty() && found.back().direction == -direction) {  // the first one back is a bit late
        const long double turned = -direction * amplitude * static_cast<long double>(per_unit);
        boundary = direction * std::max(direction * boundary, direction * turned + 1e-4L);
      }
      if ((q - boundary) * direction <= 0.0L) break;
      long double low = from, high = to;
      for (int i = 0; i < 70; ++i) {
        const long double middle = (low + high) / 2;
        ((position(middle) - boundary) * direction > 0 ? high : low) = middle;
      }
      found.push_back({high, direction});
      count += direction;
    }
  }
  return found;
}

}  // namespace

TEMPLATE_TEST_CASE("a steady line steps at equal times, half a period after its start", "", float, double) {
  using S = TestType;
  const Straight<S> line{S(0), S(10)};
  const auto phases = test::steady(S(10), S(2));
  step::StepCursor cursor(line, step::PhaseClock(phases, S(1)), 0, S(4), 0);
  const auto edges = all(cursor);
  REQUIRE(edges.size() == 40);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    CHECK(edges[i].time == Approx(1.0 + (static_cast<double>(i) + 0.5) / 8.0));
    CHECK(edges[i].direction == 1);
  }
  CHECK(cursor.count() == 40);
}

TEST_CASE("an axis that turns round steps when brute force says, with and without closed forms") {
  test::Random random;
  double worst = 0, worst_traced = 0, worst_amplitude = 0, worst_end = 0, worst_per_unit = 0;
  for (int run = 0; run < 60; ++run) {
    const double amplitude = random.log_uniform(0.05, 20.0);
    const double end = random.uniform(0.1, 20.0);
    const double per_unit = random.log_uniform(0.5, 20.0);
    const auto array = test::rest_to_rest(end, random.log_uniform(0.1, 1000.0));
    const std::vector<Phase> phases(array.begin(), array.end());
    const SineAxis<double> path{amplitude, 1.0, end, 0.0};
    CAPTURE(run, amplitude, end, per_unit);
    const auto expected = brute_force(phases, static_cast<long double>(amplitude), per_unit, 20000);

    step::StepCursor cursor(path, step::PhaseClock(phases), 0, per_unit, 0);
    const auto edges = all(cursor);
    const BareSine bare{path};
    const step::TracedPath traced(bare, 16);
    step::StepCursor traced_cursor(traced, step::PhaseClock(phases), 0, per_unit, 0);
    const auto traced_edges = all(traced_cursor);
    REQUIRE(edges.size() == expected.size());
    REQUIRE(traced_edges.size() == expected.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const bool same =
          edges[i].direction == expected[i].direction && traced_edges[i].direction == expected[i].direction;
      if (!same) FAIL("direction of edge " << i);
      // Allowed: 1 ns, or what four units in the last place of the position take at this speed and bend.
      const double t = edges[i].time;
      const double s = static_cast<double>(length_at_time(phases, expected[i].time));
      const double before = static_cast<double>(length_at_time(phases, expected[i].time - 1e-6L));
      const double speed = std::abs(amplitude * std::cos(s)) * (s - before) / 1e-6;
      const double rounding = 1e-15 * std::max(amplitude, 1.0);
      const double allowed = 1e-9 + rounding / std::max(speed, 1e-9);
      const double error = std::abs(t - static_cast<double>(expected[i].time)) / allowed;
      const double traced_error =
          std::abs(traced_edges[i].time - static_cast<double>(expected[i].time)) / allowed;
      if (error > worst)
        worst = error, worst_amplitude = amplitude, worst_end = end, worst_per_unit = per_unit;
      worst_traced = std::max(worst_traced, traced_error);
    }
  }
  CAPTURE(worst_amplitude, worst_end, worst_per_unit);
  CHECK(worst < 1.0);
  CHECK(worst_traced < 1.0);
}

TEST_CASE("a straight cut on a machine that swings and turns: radius and angle step where they should") {
  // Kinematics of a rotary table: y = hypot, c = atan2 of a straight tool path passing the centre at 0.3 mm.
  struct Table {
    using Scalar = double;
    using Vector = VectorN<double, 2>;
    [[nodiscard]] double length() const { return 20.0; }
    [[nodiscard]] double parameter_end() const { return 20.0; }
    [[nodiscard]] double parameter_at(double s) const { return s; }
    [[nodiscard]] double length_at(double u) const { return u; }
    [[nodiscard]] Vector position(double u) const { return {std::hypot(u - 7, 0.3), std::atan2(0.3, u - 7)}; }
    [[nodiscard]] Vector derivative(double u) const {
      const double r_sq = (u - 7) * (u - 7) + 0.09;
      return {(u - 7) / std::sqrt(r_sq), -0.3 / r_sq};
    }
    [[nodiscard]] Vector second_derivative(double u) const {
      const double r_sq = (u - 7) * (u - 7) + 0.09;
      return {0.09 / (r_sq * std::sqrt(r_sq)), 0.6 * (u - 7) / (r_sq * r_sq)};
    }
  };
  const Table table;
  const step::TracedPath traced(table);
  const auto phases = test::steady(20.0, 1.0);
  const std::array per_unit{100.0, 1000.0};
  const VectorN<double, 2> start = table.position(0.0);
  step::StepCursor radius(traced, step::PhaseClock(phases), 0, per_unit[0],
                          step::count_at(start(0) * per_unit[0]));
  step::StepCursor angle(traced, step::PhaseClock(phases), 1, per_unit[1],
                         step::count_at(start(1) * per_unit[1]));
  std::int64_t r = radius.count(), c = angle.count();
  double worst = 0.0;
  while (const auto edge = radius.next()) {
    // At constant speed 1 the time is the place: y^2 = (u - 7)^2 + 0.09 solved by hand.
    const double y = (static_cast<double>(r) + edge->direction * 0.5) / per_unit[0];
    r += edge->direction;
    worst = std::max(worst, std::abs(edge->time - (7 + edge->direction * std::sqrt(y * y - 0.09))));
  }
  while (const auto edge = angle.next()) {
    const double at = (static_cast<double>(c) + edge->direction * 0.5) / per_unit[1];
    c += edge->direction;
    worst = std::max(worst, std::abs(edge->time - (7 + 0.3 / std::tan(at))));
  }
  CHECK(worst < 1e-9);
  CHECK(r == step::count_at(table.position(20.0)(0) * per_unit[0]));
  CHECK(c == step::count_at(table.position(20.0)(1) * per_unit[1]));
}

TEST_CASE("an axis that turns round on the border of a step goes back by the hysteresis first") {
  const Straight<double> there{0.0, 2.5 + 1e-12}, back{2.5 + 1e-12, 0.0};
  const auto phases = test::steady(2.5, 1.0);
  step::StepCursor forward(there, step::PhaseClock(phases), 0, 1.0, 0);
  REQUIRE(all(forward).size() == 3);
  const auto first_back = [&](const step::Reversal<double>& reversal) {
    step::StepCursor cursor(back, step::PhaseClock(phases), 0, 1.0, forward.count(), false, reversal);
    const auto edges = all(cursor);
    REQUIRE(edges.size() == 3);
    CHECK(cursor.count() == 0);
    CHECK(edges[1].time == Approx(1.0).epsilon(1e-9));
    return edges[0].time;
  };
  CHECK(first_back({}) == Approx(0.0).margin(1e-9));  // it did not go forward before
  CHECK(first_back({1}) == Approx(1e-4).epsilon(1e-6));
  CHECK(first_back({1, 0.25}) == Approx(0.25).epsilon(1e-6));
  // a way back that ends before the hysteresis does, behind the border
  const Straight<double> hardly{2.5 + 1e-12, 2.5 - 1e-6};
  step::StepCursor cursor(hardly, step::PhaseClock(phases), 0, 1.0, 3, false, step::Reversal<double>{1});
  const auto edges = all(cursor);
  REQUIRE(edges.size() == 1);
  CHECK(edges[0].time == Approx(1e-6).epsilon(1e-4));
  CHECK(cursor.count() == 2);
}

TEST_CASE("a turning inside a block hardly beyond a border: the edges there and back are apart") {
  const SineAxis<double> path{2.5 + 1e-9, 0.0, std::numbers::pi, 0.0};
  const auto phases = test::steady(path.length(), 1.0);
  step::StepCursor cursor(path, step::PhaseClock(phases), 0, 1.0, 0);
  const auto edges = all(cursor);
  REQUIRE(edges.size() == 6);
  CHECK(edges[2].direction == 1);
  CHECK(edges[3].direction == -1);
  // sqrt(2 h / amplitude) behind the top
  CHECK(edges[3].time - std::numbers::pi / 2 == Approx(std::sqrt(2e-4 / 2.5)).epsilon(1e-3));
}

TEST_CASE("a boundary touched and not crossed gives no edge") {
  // Amplitude 2.5 steps: the extremum is the boundary between 2 and 3, up to rounding of the sine.
  const SineAxis<double> path{2.5, 0.0, 20 * std::numbers::pi, 0.0};
  const auto phases = test::steady(path.length(), 1.0);
  step::StepCursor cursor(path, step::PhaseClock(phases), 0, 1.0, 0);
  const auto edges = all(cursor);
  CHECK(edges.size() == 80);  // ten turns of 2 up, 4 down, 2 up
  CHECK(cursor.count() == 0);

  // The same at scales where the product of amplitude and steps per unit is rounded either way.
  test::Random random;
  int wrong = 0;
  for (int run = 0; run < 500; ++run) {
    const double per_unit = random.log_uniform(0.1, 1e4);
    const int steps = random.integer(1, 30);
    const SineAxis<double> scaled{(steps + 0.5) / per_unit, 0.0, 20 * std::numbers::pi, 0.0};
    step::StepCursor touching(scaled, step::PhaseClock(phases), 0, per_unit, 0);
    wrong += all(touching).size() != static_cast<std::size_t>(40 * steps);
  }
  CHECK(wrong == 0);

  const SineAxis<double> beyond{2.5 * (1 + 1e-12), 0.0, 20 * std::numbers::pi, 0.0};
  step::StepCursor crossing(beyond, step::PhaseClock(phases), 0, 1.0, 0);
  CHECK(all(crossing).size() == 120);
}

TEST_CASE("an axis that ends on a boundary steps only if the next block goes on") {
  const Straight<double> up{0.0, 2.5}, on{2.5, 4.0}, back{2.5, 1.0};
  const auto clock = [](const auto& phases) { return step::PhaseClock(phases); };
  const auto first_phases = test::steady(2.5, 1.0);
  const auto next_phases = test::steady(1.5, 1.0);
  step::StepCursor first(up, clock(first_phases), 0, 1.0, 0);
  CHECK(all(first).size() == 2);
  step::StepCursor onward(on, clock(next_phases), 0, 1.0, first.count());
  const auto onward_edges = all(onward);
  REQUIRE(onward_edges.size() == 2);
  CHECK(onward_edges[0] == step::Edge{0.0, 0, 1});
  CHECK(onward_edges[1] == step::Edge{1.0, 0, 1});
  CHECK(onward.count() == 4);
  step::StepCursor backward(back, clock(next_phases), 0, 1.0, first.count());
  const auto back_edges = all(backward);
  REQUIRE(back_edges.size() == 1);
  CHECK(back_edges[0] == step::Edge{1.0, 0, -1});
  // A start on a boundary, rounded away from zero, and left downwards at once.
  step::StepCursor started(back, clock(next_phases), 0, 1.0, step::count_at(2.5));
  const auto started_edges = all(started);
  REQUIRE(started_edges.size() == 2);
  CHECK(started_edges[0] == step::Edge{0.0, 0, -1});
  CHECK(started.count() == 1);
}

TEST_CASE("steps left over from before come at the block's start") {
  const Straight<double> line{10.0, 12.0};
  const auto phases = test::steady(2.0, 1.0);
  step::StepCursor late(line, step::PhaseClock(phases, 3.0), 0, 1.0, 7);
  CHECK(all(late) == std::vector<step::Edge>{{3, 0, 1}, {3, 0, 1}, {3, 0, 1}, {3.5, 0, 1}, {4.5, 0, 1}});
  CHECK(late.count() == 12);
}

TEST_CASE("a traced curve's velocity may dip through zero within a piece") {
  // x = w^3 - w/100 with w = u - 1: turns round at w = -+sqrt(1/300), inside the first of two pieces.
  struct Dip {
    using Scalar = double;
    using Vector = VectorN<double, 1>;
    [[nodiscard]] double length() const { return 2.2; }
    [[nodiscard]] double parameter_end() const { return 2.2; }
    [[nodiscard]] double length_at(double u) const { return u; }
    [[nodiscard]] Vector position(double u) const { return Vector((u - 1) * ((u - 1) * (u - 1) - 0.01)); }
    [[nodiscard]] Vector derivative(double u) const { return Vector(3 * (u - 1) * (u - 1) - 0.01); }
    [[nodiscard]] Vector second_derivative(double u) const { return Vector(6 * (u - 1)); }
  };
  const Dip curve;
  const step::TracedPath traced(curve, 2);
  const double first = traced.next_reversal(0, 0.0);
  CHECK(first == Approx(1 - std::sqrt(1.0 / 300)).epsilon(1e-14));
  const double second = traced.next_reversal(0, first);
  CHECK(second == Approx(1 + std::sqrt(1.0 / 300)).epsilon(1e-14));
  CHECK(traced.next_reversal(0, second) == 2.2);
}

TEST_CASE("a block of length zero and an axis at rest have no edges") {
  const Straight<double> nowhere{3.0, 3.0};
  const std::array<Phase, 0> none{};
  step::StepCursor still(nowhere, step::PhaseClock<double>(none), 0, 100.0, 300);
  CHECK_FALSE(still.next());
  CHECK_FALSE(still.next());
  CHECK(still.count() == 300);
  const SineAxis<double> path{1.0, 0.0, 5.0, 0.25};
  const auto phases = test::steady(5.0, 1.0);
  step::StepCursor flat(path, step::PhaseClock(phases), 1, 10.0, 3);
  CHECK_FALSE(flat.next());
}

TEST_CASE("a program of random blocks ends on the rounded target, whatever its borders") {
  test::Random random;
  double at = 0.0;
  const double per_unit = 173.2;
  std::int64_t count = step::count_at(at * per_unit);
  double start = 0.0;
  double last = 0.0;
  bool in_order = true, on_target = true;
  for (int block = 0; block < 20000; ++block) {
    // Some targets on boundaries, some in place, some a rounding away from where the axis is.
    double to = random.uniform(-1.0, 1.0);
    if (random.integer(0, 3) == 0) to = (std::round(to * per_unit) + 0.5) / per_unit;
    if (random.integer(0, 9) == 0) to = std::nextafter(at, to);
    const Straight<double> line{at, to};
    const auto phases = test::steady(line.length(), random.log_uniform(0.1, 100.0));
    step::StepCursor cursor(line, step::PhaseClock(phases, start), 0, per_unit, count);
    while (const auto edge = cursor.next()) {
      in_order = in_order && edge->time >= last;
      last = edge->time;
    }
    count = cursor.count();
    at = to;
    start += line.length() > 0.0 ? phases[0].duration : 0.0;
    on_target = on_target && std::abs(at * per_unit - static_cast<double>(count)) <= 0.5;
  }
  CHECK(in_order);
  CHECK(on_target);
}

TEST_CASE("1e8 steps are counted exactly") {
  const Straight<double> line{0.0, 100000.0};
  const auto phases = test::rest_to_rest(100000.0, 1000.0);
  step::StepCursor cursor(line, step::PhaseClock(phases), 0, 1000.0, 0);
  std::int64_t edges = 0;
  double last = 0.0;
  bool in_order = true;
  while (const auto edge = cursor.next()) {
    ++edges;
    in_order = in_order && edge->time >= last;
    last = edge->time;
  }
  CHECK(edges == 100000000);
  CHECK(cursor.count() == 100000000);
  CHECK(in_order);
  CHECK(last <= phases[3].time + phases[3].duration);
}

TEST_CASE("merged axes come in order of time, and leave their counts") {
  const SineAxis<double> path{3.0, 0.7, 30.0, 0.0};
  const auto phases = test::rest_to_rest(30.0, 50.0);
  auto edges = step::block_edges(path, step::PhaseClock(phases, 5.0), std::array{40.0, 25.0},
                                 std::array<std::int64_t, 2>{});
  std::array<std::int64_t, 2> sum{};
  double last = 5.0;
  bool in_order = true;
  const std::size_t allocations = test::heap_allocations_of([&] {
    while (const auto edge = edges.next()) {
      in_order = in_order && edge->time >= last;
      last = edge->time;
      sum[static_cast<std::size_t>(edge->axis)] += edge->direction;
    }
  });
  CHECK(allocations == 0);
  CHECK(in_order);
  CHECK(sum == step::counts(edges));
  CHECK(sum[0] == step::count_at(3.0 * std::sin(30.0) * 40.0));
  CHECK(sum[1] == step::count_at(0.7 * 30.0 * 25.0));
  CHECK_FALSE(edges.next());
  // Nothing before the last edge of the block before.
  auto later = step::block_edges(path, step::PhaseClock(phases, 5.0), std::array{40.0, 25.0},
                                 std::array<std::int64_t, 2>{}, 6.0);
  CHECK(later.next()->time == 6.0);
}

TEST_CASE("a traced curve of no pieces is one of a single piece") {
  const BareSine curve{{1.0, 0.0, 2.0, 0.0}};
  for (const int pieces : {1, 0, -1, std::numeric_limits<int>::min()})
    CHECK(step::TracedPath(curve, pieces).next_reversal(0, 0.0) ==
          Approx(std::numbers::pi / 2).epsilon(1e-14));
  const step::TracedPath finest(curve, 1000);
  CHECK(finest.next_reversal(0, 0.0) == Approx(std::numbers::pi / 2).epsilon(1e-14));
  CHECK(finest.next_reversal(0, 1.6) == 2.0);
  CHECK(finest.next_reversal(0, -1e300) == 2.0);  // outside the curve, but an answer
}

TEST_CASE("a turning on a curve too short for rounding is found") {
  // x = u (e - u): turns round in the middle.
  struct Tiny {
    using Scalar = double;
    using Vector = VectorN<double, 1>;
    [[nodiscard]] double length() const { return parameter_end(); }
    [[nodiscard]] double parameter_end() const { return 1e-310; }
    [[nodiscard]] double length_at(double u) const { return u; }
    [[nodiscard]] Vector position(double u) const { return Vector(u * (parameter_end() - u)); }
    [[nodiscard]] Vector derivative(double u) const { return Vector(parameter_end() / 2 - u); }
    [[nodiscard]] Vector second_derivative(double) const { return Vector(-1.0); }
  };
  const Tiny curve;
  CHECK(step::TracedPath(curve, 1).next_reversal(0, 0.0) == Approx(0.5e-310));
}

TEST_CASE("positions beyond all counts and no positions at all are counted within bounds") {
  constexpr std::int64_t most = std::int64_t{1} << 53;
  for (const double far : {1e20, 1e300, std::numeric_limits<double>::infinity()}) {
    CHECK(step::count_at(far) == most);
    CHECK(step::count_at(-far) == -most);
  }
  CHECK(step::count_at(1e20F) == most);
  CHECK(std::abs(step::count_at(std::numeric_limits<double>::quiet_NaN())) <= most);
  const auto phases = test::steady(1e15, 1e15);
  const Straight<double> away{0.0, 1e15}, back{0.0, -1e15};
  step::StepCursor forward(away, step::PhaseClock(phases), 0, 1e5, most - 2);
  int edges = 0;
  while (forward.next() && edges < 10) ++edges;
  CHECK(edges == 2);
  step::StepCursor backward(back, step::PhaseClock(phases), 0, 1e5, 2 - most);
  for (edges = 0; backward.next() && edges < 10;) ++edges;
  CHECK(edges == 2);
  const Straight<double> nowhere{0.0, std::numeric_limits<double>::quiet_NaN()};
  step::StepCursor lost(nowhere, step::PhaseClock(phases), 0, 1e5, 0);
  CHECK_FALSE(lost.next());
}

// What a clock or a cursor would only point to must stay.
static_assert(!std::constructible_from<step::PhaseClock<double>, std::array<Phase, 7>>);
static_assert(!std::constructible_from<step::PhaseClock<double>, std::vector<Phase>, double>);
static_assert(std::constructible_from<step::PhaseClock<double>, std::span<const Phase>>);
static_assert(std::constructible_from<step::PhaseClock<double>, const std::array<Phase, 7>&, double>);
static_assert(!std::constructible_from<step::TracedPath<BareSine>, BareSine, int>);
static_assert(std::constructible_from<step::TracedPath<BareSine>, const BareSine&, int>);
static_assert(!std::constructible_from<step::StepCursor<Straight<double>, step::PhaseClock<double>>,
                                       Straight<double>, step::PhaseClock<double>, int, double, int>);
template <class P>
constexpr bool has_edges = requires(P&& path, const step::PhaseClock<double>& clock) {
  step::block_edges(std::forward<P>(path), clock, std::array{1.0});
};
static_assert(has_edges<const Straight<double>&> && !has_edges<Straight<double>>);
