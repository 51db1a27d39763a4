// Under a map: programs in parts and live, at the levels good and best: joints by differences, the tip by
// forward kinematics of the test's own.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "cncplan/block_reader.hpp"
#include "cncplan/executor_levels.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/table_table.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/smooth_stream.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "kinematics/tool_jog_run.hpp"
#include "maps/maps.hpp"
#include "plan/least_brake.hpp"
#include "plan/mapped_motion.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

constexpr double tolerance = 0.02;

template <class M>
void set_limits(M& machine) {
  for (auto& axis : machine.axes) {
    const double scale = axis.kind == AxisKind::rotary ? 0.03 : 1.0;
    axis.velocity = 100 * scale, axis.acceleration = 1000 * scale, axis.jerk = 20000 * scale;
  }
  machine.limits = {.velocity = 100, .acceleration = 1000, .jerk = 20000};
}

// Round a table, twice; C turns beyond a turn.
struct Polar {
  using Machine = MappedMachine<kinematics::PolarMap>;
  static Machine machine() {
    Machine m{
        .axes = {Axis{.letter = 'R'}, Axis{.letter = 'Z'}, Axis{.letter = 'C', .kind = AxisKind::rotary}}};
    set_limits(m);
    return m;
  }
  static Vector3 tip(const Vector3& q) { return {q[0] * std::cos(q[2]), q[0] * std::sin(q[2]), q[1]}; }
  static std::string text() {
    std::string result = "F3000\n";
    for (int i = 1; i <= 600; ++i) {
      const double r = 60 + 8 * std::sin(i * 0.05), a = i * 0.02 + 0.05 * std::sin(i * 0.3);
      result += "G1 X" + std::to_string(r * std::cos(a)) + " Y" + std::to_string(r * std::sin(a)) + " Z" +
                std::to_string(3 * std::sin(i * 0.11)) + "\n";
    }
    return result;
  }
  static PlanOptions options(SmoothLevel level) {
    return {.tolerance = tolerance, .level = level, .start = {60, 0, 0}};
  }
};

// A spiral round a cylinder, the tool along the normal or so.
struct FiveAxes {
  using Machine = MappedMachine<kinematics::FiveAxes>;
  static Machine machine() {
    Machine m{.map = kinematics::TableTableAC{.center = {0, 0, -60}},
              .axes = {Axis{.letter = 'X'}, Axis{.letter = 'Y'}, Axis{.letter = 'Z'},
                       Axis{.letter = 'A', .kind = AxisKind::rotary},
                       Axis{.letter = 'C', .kind = AxisKind::rotary}}};
    set_limits(m);
    return m;
  }
  static Vector3 tip(const VectorN<double, 5>& q) {
    const double ca = std::cos(q[3]), sa = std::sin(q[3]), cc = std::cos(q[4]), sc = std::sin(q[4]);
    const Vector3 d(q[0], q[1], q[2] + 60);
    const Vector3 tilted(d.x(), ca * d.y() + sa * d.z(), -sa * d.y() + ca * d.z());
    return {cc * tilted.x() + sc * tilted.y(), -sc * tilted.x() + cc * tilted.y(), tilted.z() - 60};
  }
  static std::string text() {
    std::string result = "F3000 G43.4\n";
    for (int i = 0; i <= 400; ++i) {
      const double a = i * 0.02;
      result += "G1 X" + std::to_string(30 * std::cos(a)) + " Y" + std::to_string(30 * std::sin(a)) + " Z" +
                std::to_string(0.02 * i) + " A" + std::to_string(40 + 10 * std::sin(i * 0.03)) + " C" +
                std::to_string(90 - i * 1.1459) + "\n";
    }
    return result;
  }
  static PlanOptions options(SmoothLevel level) {
    return {.tolerance = tolerance, .level = level, .orientation = Orientation::great_circle};
  }
};

double off_line(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 way = b - a;
  const double t = way.norm() > 0 ? std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - t * way).norm();
}

// Joints and tip at every tick.
template <class Case>
class Watch {
 public:
  static constexpr int n = Case::Machine::axis_count;
  using Joints = VectorN<double, n>;
  explicit Watch(double period) : period_(period) {}
  void add(const Joints& q) { q_.push_back(q); }

  template <class Blocks>
  void check(const Blocks& blocks) const {
    const auto machine = Case::machine();
    double velocity = 0, acceleration = 0, jerk = 0, tool = 0, off = 0, missed = 0;
    std::vector<Vector3> tips;
    for (const auto& q : q_) tips.push_back(Case::tip(q));
    const double t = period_;
    for (std::size_t i = 3; i < q_.size(); ++i) {
      const Joints v = (q_[i] - q_[i - 1]) / t, a = (q_[i] - 2 * q_[i - 1] + q_[i - 2]) / (t * t),
                   j = (q_[i] - 3 * q_[i - 1] + 3 * q_[i - 2] - q_[i - 3]) / (t * t * t);
      for (int k = 0; k < n; ++k) {
        const auto& axis = machine.axes[static_cast<std::size_t>(k)];
        velocity = std::max(velocity, std::abs(v[k]) / axis.velocity);
        acceleration = std::max(acceleration, std::abs(a[k]) / axis.acceleration);
        jerk = std::max(jerk, std::abs(j[k]) / axis.jerk);
      }
      tool = std::max(tool, (tips[i] - 3 * tips[i - 1] + 3 * tips[i - 2] - tips[i - 3]).norm() / (t * t * t) /
                                machine.limits.jerk);
    }
    std::vector<Vector3> corners;
    for (const auto& block : blocks)
      for (const double s : {0.0, block.path.length()})
        corners.push_back(Case::tip(block.path.position_at(s)));
    for (const auto& p : tips) {
      double least = 1e9;
      for (std::size_t i = 1; i < corners.size(); ++i)
        least = std::min(least, off_line(p, corners[i - 1], corners[i]));
      off = std::max(off, least);
    }
    for (const auto& corner : corners) {
      double least = 1e9;
      for (std::size_t i = 1; i < tips.size(); ++i)
        least = std::min(least, off_line(corner, tips[i - 1], tips[i]));
      missed = std::max(missed, least);
    }
    CHECK(velocity <= 1 + 1e-6);
    CHECK(acceleration <= 1 + 1e-5);
    CHECK(jerk <= 1 + 1e-3);
    CHECK(tool <= 1 + 1e-3);
    CHECK(off <= tolerance * (1 + 1e-6) + 1e-6);
    CHECK(missed <= 2 * tolerance);
    REQUIRE(!q_.empty());
    CHECK((q_.back() - blocks.back().path.position_at(blocks.back().path.length())).norm() < 1e-6);
  }

 private:
  double period_;
  std::vector<Joints> q_;
};

template <class Case>
auto program_of(SmoothLevel level) {
  auto program = read_text(Case::text(), Case::machine(), Case::options(level));
  REQUIRE_FALSE(program.failed());
  return program;
}

// An executor with the options by default.
template <class Case>
auto leveled(SmoothLevel level) {
  using Runner = Executor<typename Case::Machine, 64>;
  return std::make_unique<Runner>(Case::machine(),
                                  typename Runner::LevelOptions{.tolerance = tolerance, .level = level});
}

template <class Case>
void in_parts(SmoothLevel level, std::size_t held) {
  using M = typename Case::Machine;
  const M machine = Case::machine();
  const auto program = program_of<Case>(level);
  const auto whole = plan_program(program, machine, Case::options(level));
  REQUIRE(whole);
  constexpr double period = 5e-4;
  Watch<Case> watch(period);
  SmoothStream<M, ProgramBlock<M>> stream(machine, Case::options(level), held);
  double time = 0, at = 0;
  std::size_t cuts = 0;
  const auto take = [&] {
    if (!stream.ready()) return;
    const auto part = stream.take();
    for (; at <= part.duration(); at += period) watch.add(part.at(at).position);
    at -= part.duration();
    time += part.duration();
    CHECK((part.at(part.duration()).velocity.norm() > 0) == stream.open());
    cuts += stream.open() ? 1 : 0;
  };
  for (const auto& block : program.blocks()) {
    REQUIRE(stream.push(block));
    take();
  }
  REQUIRE(stream.finish());
  take();
  CAPTURE(held, cuts, time, whole->duration());
  CHECK(cuts >= program.blocks().size() / held);
  CHECK(time - whole->duration() < 0.02 * static_cast<double>(cuts));
  watch.check(program.blocks());
}

template <class Case>
void live(SmoothLevel level, bool disturbed) {
  const auto program = program_of<Case>(level);
  const auto blocks = program.blocks();
  const auto runner = leveled<Case>(level);
  constexpr double period = 1e-3;
  Watch<Case> watch(period);
  test::Random random;
  std::size_t fed = 0, ticks = 0, rests = 0, told = 0;
  int until_resume = 0;
  bool stood = true;
  for (; !runner->finished() && ticks < 200000; ++ticks) {
    const std::size_t most = disturbed ? static_cast<std::size_t>(random.integer(0, 2)) : 1000;
    for (std::size_t i = 0; i < most && fed < blocks.size() && runner->push(blocks[fed]); ++i)
      if (++fed == blocks.size()) runner->end_of_program();
    if (disturbed && random.integer(0, 400) == 0) runner->feed_override(random.uniform(0.3, 1));
    if (disturbed && random.integer(0, 1500) == 0) runner->feed_hold(), until_resume = 700;
    if (until_resume > 0 && --until_resume == 0) runner->resume();
    const auto point = runner->tick(period);
    watch.add(point.position);
    told += (Case::tip(point.position) - point.tool).norm() > 1e-8 ? 1 : 0;
    const bool stands = point.velocity.norm() == 0;
    rests += stands && !stood ? 1 : 0;
    stood = stands;
  }
  CHECK(runner->finished());
  CHECK_FALSE(runner->error());
  CHECK(told == 0);
  if (!disturbed) CHECK(rests <= 2);  // where the map is switched on, and at the end
  watch.check(blocks);
}

// Holds at random instants at the planned speed come to rest within what is told; joints and tip keep their
// limits.
template <class Case>
void holds(SmoothLevel level) {
  const auto program = program_of<Case>(level);
  const auto blocks = program.blocks();
  const auto runner = leveled<Case>(level);
  constexpr double period = 1e-3;
  Watch<Case> watch(period);
  test::Random random;
  INFO("CNCPLAN_SEED=" << test::seed() << ", level " << static_cast<int>(level));
  std::size_t fed = 0;
  int rests = 0, asked = -1, until_hold = random.integer(1, 600);
  double longest = 0;
  for (int tick = 0; !runner->finished(); ++tick) {
    REQUIRE(tick < 200000);
    while (fed < blocks.size() && runner->push(blocks[fed]))
      if (++fed == blocks.size()) runner->end_of_program();
    if (asked < 0 && --until_hold == 0) runner->feed_hold(), asked = tick;
    watch.add(runner->tick(period).position);
    if (asked < 0 || runner->state() != ExecutorState::held) continue;
    longest = std::max(longest, (tick - asked) * period);
    runner->resume();
    asked = -1, ++rests, until_hold = random.integer(400, 1000);  // it is at the planned speed again
  }
  REQUIRE(runner->worst_hold());
  CAPTURE(rests, longest, *runner->worst_hold());
  CHECK(rests > 8);
  CHECK(longest <= *runner->worst_hold() + 2 * period);
  // No joint takes twice as long to brake as the tip.
  CHECK(*runner->worst_hold() <= 1.5 * 2 * least_time(50, 0, 1000, 20000));
  watch.check(blocks);
}

// Requests to a plan that is there as a whole.
template <class Case>
void given() {
  const auto machine = Case::machine();
  const auto program = program_of<Case>(SmoothLevel::good);
  const auto trajectory = plan_program(program, machine, Case::options(SmoothLevel::good));
  REQUIRE(trajectory);
  TrajectoryExecutor executor(*trajectory, machine);
  REQUIRE_FALSE(executor.error());
  REQUIRE(executor.worst_hold());
  constexpr double period = 1e-3;
  Watch<Case> watch(period);
  int rests = 0;
  for (int tick = 0; executor.state() != ExecutorState::finished; ++tick) {
    REQUIRE(tick < 200000);
    if (tick % 3000 == 1500) executor.feed_hold();
    if (tick % 3000 == 2500) rests += executor.state() == ExecutorState::held ? 1 : 0, executor.resume();
    executor.feed_override(tick % 7000 < 2000 ? 0.6 : 1);
    watch.add(executor.tick(period).position);
  }
  CHECK(rests > 2);
  watch.check(program.blocks());
}

// Jogs amid a line, without a corner that an exact path jumps at; to points in all coordinates.
struct PolarJogs : Polar {
  static constexpr double hold_after = 0.5;
  static Vector3 coordinates(const Vector3& q) { return tip(q); }
  static std::string text() { return "F3000\nG1 X30 Y60 Z5\n"; }
  static PlanOptions options() { return {.start = {60, 0, 0}}; }
  static Vector3 away(const Vector3& from) { return from + Vector3(-15, 20, 6); }
  static Vector3 beside(const Vector3& from) { return from + Vector3(12, -15, -3); }
};
struct FiveAxesJogs : FiveAxes {
  using Coordinates = VectorN<double, 5>;
  static constexpr double hold_after = 0.6;
  static Coordinates coordinates(const Coordinates& q) {
    Coordinates result;
    result << tip(q), q[3], q[4];
    return result;
  }
  static std::string text() { return "F3000 G43.4\nG1 X30 Y40 Z5 A30 C90\n"; }
  static PlanOptions options() { return {}; }
  static Coordinates away(const Coordinates& from) { return from + step(-15, 20, 6, -0.3, 0.6); }
  static Coordinates beside(const Coordinates& from) { return from + step(12, -15, -3, 0.2, 0.1); }
  static Coordinates step(double x, double y, double z, double a, double c) {
    Coordinates result;
    result << x, y, z, a, c;
    return result;
  }
};

}  // namespace

TEST_CASE("under a map: a long run in parts is cut at a speed", "[mapped-live]") {
  in_parts<Polar>(SmoothLevel::good, 60);
  in_parts<FiveAxes>(SmoothLevel::good, 60);
  in_parts<FiveAxes>(SmoothLevel::best, 150);
}

TEST_CASE("under a map: an executor at the level good does not rest between blocks", "[mapped-live]") {
  live<Polar>(SmoothLevel::good, false);
  live<FiveAxes>(SmoothLevel::good, false);
  live<FiveAxes>(SmoothLevel::best, false);
}

TEST_CASE("under a map: an executor at the level good under random requests", "[mapped-live]") {
  live<Polar>(SmoothLevel::good, true);
  live<FiveAxes>(SmoothLevel::good, true);
}

TEST_CASE("under a map: a hold always comes", "[mapped-live]") {
  holds<Polar>(SmoothLevel::good);
  holds<FiveAxes>(SmoothLevel::good);
}

TEST_CASE("under a map: a plan that is there as a whole is run and held", "[mapped-live]") {
  given<Polar>();
  given<FiveAxes>();
}

TEST_CASE("under a map: the tool and joints are jogged amid a program at every level", "[mapped-live]") {
  const auto level = GENERATE(SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best);
  CAPTURE(level);
  jog_amid_program<PolarJogs>(*leveled<PolarJogs>(level));
  jog_joints_amid_program<PolarJogs>(*leveled<PolarJogs>(level));
  jog_amid_program<FiveAxesJogs>(*leveled<FiveAxesJogs>(level));
  jog_joints_amid_program<FiveAxesJogs>(*leveled<FiveAxesJogs>(level));
}

TEST_CASE("under a map: random jogs amid a five-axis program keep all limits", "[mapped-live]") {
  test::Random random;
  INFO("CNCPLAN_SEED=" << test::seed());
  jog_at_random<FiveAxesJogs>(*leveled<FiveAxesJogs>(SmoothLevel::good), random, 150);
}

TEST_CASE("under a map: jogs of the tool are in the coordinates of the block", "[mapped-live]") {
  const auto machine = FiveAxes::machine();
  gcode::Dialect dialect = dialect_of(machine);
  dialect.tools = {{.number = 1, .length = 50}};
  BlockReader reader(machine, PlanOptions{.dialect = dialect});
  const bool on = GENERATE(true, false);
  const auto runner = leveled<FiveAxesJogs>(GENERATE(SmoothLevel::fast, SmoothLevel::good));
  CAPTURE(on);
  for (const std::string line : {on ? "F3000 G43.4 H1" : "F3000", "G1 X20 Z5 A30 C20"}) {
    const auto blocks = reader.read_line(line);
    REQUIRE(blocks);
    for (const auto& block : *blocks) REQUIRE(runner->push(block));
  }
  runner->end_of_program();
  const auto tip_of = [&](VectorN<double, 5> q) {
    if (on) q[2] -= 50;
    return FiveAxes::tip(q);
  };
  SetPoint<5> point;
  double off = 0, beside = 0;
  const auto run = [&] {
    for (int i = 0; i < 5000; ++i) {
      point = runner->tick(1e-3);
      off = std::max(off, (tip_of(point.position) - point.tool).norm());
    }
  };
  run();
  CHECK(runner->finished());
  const auto from = point;
  VectorN<double, 5> step = FiveAxesJogs::step(3, -4, 2, 0.1, 0.2);
  REQUIRE(runner->jog_tool_by(step));
  for (int i = 0; i < 3000; ++i) {
    point = runner->tick(1e-3);
    off = std::max(off, (tip_of(point.position) - point.tool).norm());
    const Vector3 now = on ? Vector3(point.tool) : Vector3(point.position.head<3>());
    const Vector3 start = on ? Vector3(from.tool) : Vector3(from.position.head<3>());
    beside = std::max(beside, off_line(now, start, start + step.head<3>()));
  }
  CHECK(beside < 1e-9);
  CHECK(off < 1e-9);
  if (on)
    CHECK((point.tool - from.tool - step.head<3>()).norm() < 1e-9);
  else
    CHECK((point.position - from.position - step).norm() < 1e-9);
}
