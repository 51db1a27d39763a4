// What a changing clock is proven to keep, against positions on a fine grid of time.
#include "cncplan/detail/executor/clock_proof.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cncplan/core/state.hpp"
#include "cncplan/detail/executor/path_brake.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/state/detail/velocity_change.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "least_brake.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

auto planned(const std::string& text, const Machine<3>& machine) {
  const auto program = read_text(text, machine);
  REQUIRE_FALSE(program.failed());
  auto trajectory = plan_blocks(program.blocks(), machine, {.tolerance = 0.01, .level = SmoothLevel::good});
  REQUIRE(trajectory);
  return *std::move(trajectory);
}

// A proof about one trajectory.
struct Clocked {
  using B = ProgramBlock<Machine<3>>;

  Clocked(const Trajectory<Machine<3>, B>& trajectory, const Machine<3>& machine) : proof(machine) {
    chain.push_back(trajectory, {}, {});
  }
  bool holds(const state::Motion& clock, bool backwards, double until, int& work) const {
    return proof.holds(chain, clock, backwards, until, work);
  }

  detail::TrajectoryChain<Machine<3>, B> chain;
  detail::ClockProof<Machine<3>, B> proof;
};

const AxisLimits straight = [] {
  AxisLimits limits;
  limits.acceleration_up = limits.acceleration_down = mill.limits.acceleration;
  limits.jerk = mill.limits.jerk;
  return limits;
}();

using AlongPath = detail::ClockProof<Machine<3>, Clocked::B>::Motion;

// From a rate of 1 or so to rest, with so much jerk and acceleration of the clock.
state::Motion change(double at, double rate, double to, double jerk, double acceleration) {
  AxisLimits limits;
  limits.velocity_up = limits.velocity_down = 2;
  limits.acceleration_up = limits.acceleration_down = acceleration;
  limits.jerk = jerk;
  return state::BasicVelocityChange<double>({at, rate, 0}, to, limits).fastest();
}

struct Most {
  double acceleration = 0, jerk = 0;  // as shares of the limits
};

// By differences of positions, so many seconds apart.
template <class Position>
Most most_of(const Position& at, double duration, const Machine<3>& machine, double period) {
  Most most;
  const auto share = [&](const Vector3& value, double tool, auto of_axis) {
    double result = value.norm() / tool;
    for (int i = 0; i < 3; ++i)
      result = std::max(result, std::abs(value[i]) / of_axis(machine.axes[static_cast<std::size_t>(i)]));
    return result;
  };
  Vector3 a = at(0), b = at(period), c = at(2 * period);
  for (double t = 0; t + 3 * period < duration; t += period) {
    const Vector3 d = at(t + 3 * period);
    const Vector3 bend = (c - 2 * b + a) / (period * period);
    const Vector3 jerk = (d - 3 * c + 3 * b - a) / (period * period * period);
    most.acceleration = std::max(most.acceleration, share(bend, machine.limits.acceleration,
                                                          [](const Axis& x) { return x.acceleration; }));
    most.jerk = std::max(most.jerk, share(jerk, machine.limits.jerk, [](const Axis& x) { return x.jerk; }));
    a = b, b = c, c = d;
  }
  return most;
}
template <class T>
Most most_of(const T& trajectory, const state::Motion& clock, const Machine<3>& machine) {
  return most_of([&](double t) -> Vector3 { return trajectory.at(clock.at(t).position).position; },
                 clock.duration(), machine, 1e-5);
}

Machine<3> slow_axes() {
  Machine<3> machine = mill;
  machine.axes[0].jerk = 8000;
  machine.axes[1].acceleration = 400;
  return machine;
}
const std::string corners_and_arcs =
    "F1800 G1 X8\nY5\nF900 X9 Y5.5\nG3 X14 Y0.5 R6\nF1500 G1 X20 Y0\nX20.3 Y0.4\nX20.6 Y0\nX20.9 Y0.4\nG1 X4 "
    "Y0\n";

}  // namespace

TEST_CASE("a motion by a clock has the derivatives of the function of the function", "[clock]") {
  const State of{3, 2, -5, 7};
  const State clock{1, 0.5, -2, 4};
  // s(u) = 3 + 2 u - 5 u^2/2 + 7 u^3/6 with u(t) = t/2 - t^2 + 4 t^3/6: the Taylor series of s(u(t)), by hand
  const State by = by_clock(of, clock);
  CHECK(by.position == 3);
  CHECK(by.velocity == Approx(2 * 0.5));
  CHECK(by.acceleration == Approx(2 * (2 * -1 - 2.5 * 0.25)));
  CHECK(by.jerk == Approx(6 * (2 * 4.0 / 6 - 2.5 * 2 * 0.5 * -1 + 7.0 / 6 * 0.125)));
}

TEST_CASE("clock: the third derivative of an arc changes by no more than its bound", "[clock]") {
  // r (cos u, sin u), h u with u = s w and w = 1 / sqrt(r^2 + h^2), a long way through a turn.
  const auto check = [](long double r, long double rise, double half) {
    INFO("radius " << static_cast<double>(r) << ", rise of a turn " << static_cast<double>(rise) << ", half "
                   << half);
    const auto program = "G17 F600\nG0 X" + std::to_string(static_cast<double>(r)) + "\nG3 X" +
                         std::to_string(static_cast<double>(r)) + " Y0 I" +
                         std::to_string(-static_cast<double>(r)) + " J0 Z" +
                         std::to_string(static_cast<double>(rise)) + "\n";
    const auto read = read_text(program, mill);
    REQUIRE_FALSE(read.failed());
    REQUIRE(read.blocks().size() == 2);
    const auto* arc = read.blocks()[1].path.arc();
    REQUIRE(arc != nullptr);
    const long double pi = std::acos(-1.0L), h = rise / (2 * pi), w = 1 / std::sqrt(r * r + h * h);
    const double middle = arc->length() / 2;
    const double bound = detail::path_near(*arc, middle, half).third_change[0];
    const long double u = static_cast<long double>(middle) * w, du = static_cast<long double>(half) * w;
    const long double scale = r * w * w * w;
    const auto change = [&](long double d) {
      return scale *
             std::max(std::abs(std::sin(u + d) - std::sin(u)), std::abs(std::cos(u + d) - std::cos(u)));
    };
    const auto most = static_cast<double>(std::max(change(du), change(-du)));
    CHECK(most <= bound * (1 + 1e-12));
    CHECK(bound <= 1.2 * most);  // near the middle of a turn the sine changes at its full rate
  };
  check(1, 20, 0.05);  // k^3 is eleven times too small
  check(1, 0, 0.01);
  Random random;
  for (int i = 0; i < 300; ++i) {
    const double r = random.log_uniform(0.1, 100), rise = random.uniform(0, 20) * r;
    check(std::round(r * 1e6) / 1e6, std::round(rise * 1e6) / 1e6, random.uniform(1e-3, 0.1) * r);
  }
}

TEST_CASE("clock: a hold on a line is proven just as far as the limits go", "[clock]") {
  const auto trajectory = planned("F1800 G1 X60\nY1\n", mill);
  const Clocked proof(trajectory, mill);
  const double jerk = 10000.0 / 30, acceleration = 1000.0 / 30;
  const auto holds = [&](double share) {
    int work = 10000;
    return proof.holds(change(0.5, 1, 0, share * jerk, acceleration), false, 1e9, work);
  };
  CHECK(holds(1));
  CHECK(holds(0.99));
  CHECK_FALSE(holds(1.001));
  int work = 3;  // not enough to look at all of it
  CHECK_FALSE(proof.holds(change(0.5, 1, 0, jerk / 4, acceleration), false, 1e9, work));
  CHECK(work < 0);
}

TEST_CASE("clock: what is proven is within the limits, both ways, on lines, arcs and corners", "[clock]") {
  Machine<3> machine = mill;
  machine.axes[0].jerk = 8000;
  machine.axes[1].acceleration = 400;
  const auto trajectory = planned(
      "F1800 G1 X8\nY5\nX9 Y5.5\nG3 X14 Y0.5 R6\nG1 X20 Y0\nX20.3 Y0.4\nX20.6 Y0\nX20.9 Y0.4\nG1 X4 Y0\n",
      with_reserve(machine, 0.1));
  const Clocked proof(trajectory, machine);
  Random random;
  int proven = 0, refused = 0;
  for (int i = 0; i < 600; ++i) {
    const bool back = random.coin();
    const double at = random.uniform(0, trajectory.duration());
    const double sense = back ? -1 : 1, from = sense * (random.coin() ? 1 : random.uniform(0, 1));
    const double to = sense * (random.coin() ? 0 : random.uniform(0, 1));
    const double v = random.log_uniform(2, 400);
    const auto clock = change(at, from, to, 10000 / v, 400 / v);
    const double end = clock.end().position;
    if (end < 0 || end > trajectory.duration()) continue;
    int work = 20000;
    const bool ok = proof.holds(clock, back, back ? 0 : trajectory.duration(), work);
    (ok ? proven : refused)++;
    if (!ok) continue;
    INFO("from " << at << " at " << from << " to " << to << ", v " << v);
    const Most most = most_of(trajectory, clock, machine);
    CHECK(most.acceleration < 1 + 1e-5);
    CHECK(most.jerk < 1 + 1e-3);  // rounding of positions
  }
  CHECK(proven > 100);
  CHECK(refused > 100);
}

namespace {

// Brakes along the path of a trajectory, which do not end at its end.
struct Brakes : Clocked {
  using Clocked::Clocked;

  // From the place and speed of a time, with so much jerk and acceleration.
  state::Motion from(double at, double jerk, double acceleration) const {
    const auto& all = *trajectory;
    const auto now = all.at(at).along;
    const double start = all.at(all.phases()[all.phase_at(at)].phase.time).along.position;
    AxisLimits limits;
    limits.acceleration_up = limits.acceleration_down = acceleration;
    limits.jerk = jerk;
    return state::BasicVelocityChange<double>({now.position - start, now.velocity, now.acceleration}, 0,
                                              limits)
        .fastest();
  }
  bool proven(double at, const state::Motion& brake) const {
    int work = 20000;
    const detail::PhasesByLength<Machine<3>, B> way(chain, trajectory->phase_at(at), 0.0);
    return proof.moves(chain, way, trajectory->phases().size() - 1, AlongPath(brake), 1, work);
  }

  const Trajectory<Machine<3>, B>* trajectory{};
};

}  // namespace

TEST_CASE("clock: a brake along the path is refused where the plan is slower", "[clock]") {
  const auto trajectory = planned("F1800 G1 X20\nF300 G1 X40\n", with_reserve(mill, 0.1));
  Brakes brakes(trajectory, mill);
  brakes.trajectory = &trajectory;
  double at = 0.3;  // where it begins to slow down for the second line
  while (trajectory.at(at).along.acceleration > -100) at += 1e-3;
  REQUIRE(trajectory.at(at).position.x() < 20);
  const auto hard = brakes.from(at, 10000, 1000), soft = brakes.from(at, 1000, 1000);
  CHECK(brakes.proven(at, hard));
  CHECK_FALSE(brakes.proven(at, soft));  // it is at rest behind X20, where the feed is 5 mm/s
  CHECK_FALSE(brakes.proven(at, brakes.from(at, 10100, 1000)));
  // Not to rest before the end of the path.
  const double last = trajectory.duration() - 0.05;
  CHECK_FALSE(brakes.proven(last, brakes.from(last, 2000, 200)));
}

TEST_CASE("clock: proven brakes along the path keep the limits and the planned speed", "[clock]") {
  const Machine<3> machine = slow_axes();
  const auto trajectory = planned(corners_and_arcs, with_reserve(machine, 0.1));
  Brakes brakes(trajectory, machine);
  brakes.trajectory = &trajectory;
  Random random;
  int proven = 0, refused = 0;
  for (int i = 0; i < 300; ++i) {
    const double at = random.uniform(0.01, trajectory.duration() - 0.01);
    const auto brake = brakes.from(at, random.log_uniform(500, 10000), random.log_uniform(50, 1000));
    if (!(brake.extrema().highest <= brake.end().position)) continue;  // too soft: it would come back
    const bool ok = brakes.proven(at, brake);
    (ok ? proven : refused)++;
    if (!ok) continue;
    INFO("at " << at << ", for " << brake.duration() << " s");
    const detail::ClockRamp<Machine<3>, Clocked::B> ramp(AlongPath(brake), trajectory.phase_at(at));
    double speed = 0;
    const auto place = [&](double t) -> Vector3 {
      const auto planned = trajectory.at(ramp.at(brakes.chain, t).position);
      if (planned.along.velocity > 1e-3)
        speed = std::max(speed, brake.at(t).velocity / planned.along.velocity);
      return planned.position;
    };
    const Most most = most_of(place, brake.duration(), machine, 1e-5);
    CHECK(most.acceleration < 1 + 1e-5);
    CHECK(most.jerk < 1 + 1e-3);  // rounding of positions
    CHECK(speed < 1 + 1e-6);
  }
  CHECK(proven > 30);
  CHECK(refused > 30);
}

TEST_CASE("clock: a ramp at a share of its speeds passes the same places, later", "[clock]") {
  const Machine<3> machine = slow_axes();
  const auto trajectory = planned(corners_and_arcs, with_reserve(machine, 0.1));
  Brakes brakes(trajectory, machine);
  brakes.trajectory = &trajectory;
  using Ramp = detail::ClockRamp<Machine<3>, Clocked::B>;
  for (const double at : {0.1, 0.4, 0.9}) {
    const auto brake = brakes.from(at, 9000, 900);
    const state::BasicMotion<double> by_time(
        state::BasicVelocityChange<double>({at, 1, 0}, 0, {2, 2, 20, 20, 300}).fastest());
    for (const Ramp& ramp : {Ramp(AlongPath(brake), trajectory.phase_at(at)), Ramp(by_time)})
      for (const double share : {0.9, 0.25}) {
        const Ramp slower = ramp.at_share(share);
        CHECK(slower.duration() == Approx(ramp.duration() / share));
        CHECK(slower.ends_at_rest());
        for (double t = 0; t < ramp.duration(); t += ramp.duration() / 17) {
          const State own = ramp.at(brakes.chain, t), then = slower.at(brakes.chain, t / share);
          CAPTURE(at, share, t);
          CHECK(then.position == Approx(own.position).epsilon(1e-12));
          CHECK(then.velocity == Approx(share * own.velocity).margin(1e-9));
          CHECK(then.acceleration == Approx(share * share * own.acceleration).margin(1e-6));
        }
      }
  }
}

TEST_CASE("clock: brakes that are made step by step keep the limits, wherever they begin", "[clock]") {
  const Machine<3> machine = slow_axes();
  const auto trajectory = planned(corners_and_arcs, with_reserve(machine, 0.1));
  Clocked clocked(trajectory, machine);
  const auto tool = tool_axes(machine);
  const detail::PathBrake<Machine<3>, Clocked::B> path_brake(clocked.proof, tool, clocked.chain, 1);
  Random random;
  int found = 0, tried = 0;
  for (int i = 0; i < 200; ++i) {
    const double at = random.uniform(0.01, trajectory.duration() - 0.01);
    const auto now = trajectory.at(at).along;
    const std::size_t phase = trajectory.phase_at(at);
    const auto& own = trajectory.phases()[phase].phase;
    const double s = own.at(at - own.time).position - own.position;
    ++tried;
    for (int level = 0; level < path_brake.levels; ++level) {
      int work = 4000;
      const auto brake = path_brake
                             .find({s, now.velocity, now.acceleration}, phase, trajectory.phases().size() - 1,
                                   straight, level, {}, work)
                             .motion;
      if (!brake) continue;
      found += level == 0;
      INFO("at " << at << ", level " << level << ", for " << brake->duration() << " s");
      CHECK(brake->end().velocity == 0);
      CHECK(brake->end().acceleration == 0);
      const auto& last = brake->phases().back();
      auto end = brake->start();
      for (const auto& step : brake->phases()) end = step.after(end, step.duration);
      CHECK(std::abs(end.velocity) < 1e-9);
      CHECK(std::abs(last.acceleration + last.jerk * last.duration) < 1e-9);
      const detail::ClockRamp<Machine<3>, Clocked::B> ramp(*brake, phase);
      double speed = 0;
      const auto place = [&](double t) -> Vector3 {
        const auto planned = trajectory.at(ramp.at(clocked.chain, t).position);
        if (planned.along.velocity > 1e-3)
          speed = std::max(speed, brake->at(t).velocity / planned.along.velocity);
        return planned.position;
      };
      const Most most = most_of(place, brake->duration(), machine, 4e-5);
      CHECK(most.acceleration < 1 + 1e-5);
      CHECK(most.jerk < 1 + 1e-3);  // rounding of positions
      CHECK(speed < 1 + 1e-6);
    }
  }
  CHECK(found > tried / 2);
}

TEST_CASE("clock: a brake that is wanted soon is the usual one, or none where that is later", "[clock]") {
  const Machine<3> machine = slow_axes();
  const auto trajectory = planned(corners_and_arcs, with_reserve(machine, 0.1));
  Clocked clocked(trajectory, machine);
  const auto tool = tool_axes(machine);
  const detail::PathBrake<Machine<3>, Clocked::B> path_brake(clocked.proof, tool, clocked.chain, 1);
  using Wanted = decltype(path_brake)::Wanted;
  Random random;
  int found = 0, lost = 0, too_long = 0, wrong = 0;
  for (int i = 0; i < 200; ++i) {
    const double at = random.uniform(0.01, trajectory.duration() - 0.01);
    const auto now = trajectory.at(at).along;
    const std::size_t phase = trajectory.phase_at(at), last = trajectory.phases().size() - 1;
    const auto& own = trajectory.phases()[phase].phase;
    const double s = own.at(at - own.time).position - own.position;
    const auto duration_of = [&](int level, const Wanted& wanted) {
      int work = 4000;
      const auto result =
          path_brake.find({s, now.velocity, now.acceleration}, phase, last, straight, level, wanted, work);
      return std::pair(result.motion ? result.motion->duration() : std::numeric_limits<double>::infinity(),
                       result.gentler_too_long);
    };
    for (int level = 0; level < path_brake.levels; ++level) {
      const double usual = duration_of(level, {}).first;
      CAPTURE(at, level, usual);
      if (!std::isfinite(usual)) continue;
      CHECK(duration_of(level, {1.000001 * usual, false}).first == usual);  // as it is made again
      const double most = usual * random.uniform(0.3, 2);
      const auto [duration, gentler] = duration_of(level, {.most = most});
      CHECK((!std::isfinite(duration) || duration < most));
      (duration < most ? found : lost) += usual < most;
      if (!gentler) continue;
      ++too_long;
      for (int other = level + 1; other < path_brake.levels; ++other)
        wrong += duration_of(other, {}).first < most;
    }
  }
  CAPTURE(found, lost, too_long, wrong);
  CHECK(found > 100);
  CHECK(lost < 0.02 * found);
  CHECK(too_long > 100);
  CHECK(wrong < 0.02 * too_long);
}

TEST_CASE("clock: a brake on a straight line takes little more than the least time", "[clock]") {
  const auto trajectory = planned("F1800 G1 X50\n", with_reserve(mill, 0.05));
  Clocked clocked(trajectory, mill);
  const auto tool = tool_axes(mill);
  const detail::PathBrake<Machine<3>, Clocked::B> path_brake(clocked.proof, tool, clocked.chain, 1);
  for (double at = 0.005; at < 1.4; at += 0.03) {
    const auto now = trajectory.at(at).along;
    const std::size_t phase = trajectory.phase_at(at);
    const auto& own = trajectory.phases()[phase].phase;
    const double s = own.at(at - own.time).position - own.position;
    int work = 4000;
    const auto brake = path_brake
                           .find({s, now.velocity, now.acceleration}, phase, trajectory.phases().size() - 1,
                                 straight, 0, {}, work)
                           .motion;
    CAPTURE(at, now.velocity, now.acceleration);
    REQUIRE(brake);
    const double least = least_time(now.velocity, now.acceleration, 1000, 10000);
    CHECK(brake->duration() >= least * (1 - 1e-9));
    CHECK(brake->duration() <= least * 1.04 + 1e-3);
  }
}
