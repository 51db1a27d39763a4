// Jogs of the tool behind a map: straight in the program's coordinates, within the limits of the joints.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <Eigen/LU>

#include "cncplan/executor.hpp"
#include "cncplan/kinematics/ready_made.hpp"
#include "kinematics/tool_jog_run.hpp"
#include "maps/maps.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;
using test::ToolJogRun;

namespace {

constexpr double pi = std::numbers::pi;

using Arms = MappedMachine<kinematics::ThreeJoints>;
using ArmRunner = Executor<Arms, 16>;

// Joints that turn have a share of these, in rad. What lines bend in the joints takes a good part of the
// limits.
void set_limits(Arms& machine, std::array<bool, 3> turns, double share) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double scale = turns[i] ? share : 1;
    machine.axes[i] = {.letter = "RSZ"[i],
                       .kind = turns[i] ? AxisKind::rotary : AxisKind::linear,
                       .velocity = 100 * scale,
                       .acceleration = 150 * scale,
                       .jerk = 1500 * scale};
  }
  machine.limits = {.velocity = 100, .acceleration = 1000, .jerk = 20000};
}

struct OnXYZ {
  using Machine = Arms;
  static constexpr double hold_after = 0.4;
  static PlanOptions options() { return {.tolerance = 0, .start = {150, 0, 0}}; }
  static std::string text() { return "F3000\nG1 X130 Y90 Z10\n"; }
  static Vector3 away(const Vector3& from) { return from + Vector3(-35, 40, 6); }
  static Vector3 beside(const Vector3& from) { return from + Vector3(20, -25, -3); }
};

struct Polar : OnXYZ {
  static Arms machine() {
    Arms result{.map = kinematics::PolarMap{}};
    set_limits(result, {false, false, true}, 0.02);
    return result;
  }
  static Vector3 coordinates(const Vector3& q) {
    return {q[0] * std::cos(q[2]), q[0] * std::sin(q[2]), q[1]};
  }
};

struct Scara : OnXYZ {
  static Arms machine() {
    Arms result{.map = kinematics::Scara{.left = true}};
    set_limits(result, {true, true, false}, 0.02);
    return result;
  }
  static Vector3 coordinates(const Vector3& q) {
    return {200 * std::cos(q[0]) + 150 * std::cos(q[0] + q[1]),
            200 * std::sin(q[0]) + 150 * std::sin(q[0] + q[1]), q[2]};
  }
};

struct Delta : OnXYZ {
  static PlanOptions options() { return {.tolerance = 0, .start = {20, 0, 0}}; }
  static std::string text() { return "F3000\nG1 X30 Y90 Z10\n"; }
  static Arms machine() {
    Arms result{.map = kinematics::LinearDelta{.radius = 140, .rod = 300}};
    set_limits(result, {false, false, false}, 1);
    return result;
  }
  // The point below the slides that is a rod's length from all three, by Newton's method.
  static Vector3 coordinates(const Vector3& q) {
    Vector3 p(0, 0, q.mean() - 260);
    for (int round = 0; round < 30; ++round) {
      Eigen::Matrix3d rows;
      Vector3 lacks;
      for (int i = 0; i < 3; ++i) {
        const double angle = pi / 2 + i * 2 * pi / 3;
        const Vector3 rod = p - Vector3(140 * std::cos(angle), 140 * std::sin(angle), q[i]);
        rows.row(i) = 2 * rod.transpose();
        lacks[i] = 300.0 * 300.0 - rod.squaredNorm();
      }
      p += rows.partialPivLu().solve(lacks);
    }
    return p;
  }
};

}  // namespace

TEST_CASE("the tool is jogged straight behind a map, amid a program", "[tool jog]") {
  const auto run = [](auto which) {
    using Case = decltype(which);
    const auto runner = std::make_unique<ArmRunner>(Case::machine(), ArmRunner::Options{.tolerance = 0});
    test::jog_amid_program<Case>(*runner);
  };
  SECTION("polar") { run(Polar{}); }
  SECTION("SCARA") { run(Scara{}); }
  SECTION("delta") { run(Delta{}); }
}

TEST_CASE("random jogs of the tool and of joints keep all limits", "[tool jog]") {
  test::Random random;
  INFO("CNCPLAN_SEED=" << test::seed());
  const auto run = [&](auto which) {
    using Case = decltype(which);
    const auto runner = std::make_unique<ArmRunner>(Case::machine(), ArmRunner::Options{.tolerance = 0});
    test::jog_at_random<Case>(*runner, random, 150);
  };
  run(Polar{});
  run(Scara{});
  run(Delta{});
}

TEST_CASE("a jog of the tool is refused beforehand, and what goes on goes on", "[tool jog]") {
  Arms machine = Polar::machine();
  machine.axes[0].high = 170;
  machine.axes[1].low = -20;
  ArmRunner runner(machine);
  REQUIRE(runner.jog_to({100, 0, 0.5}));
  for (int i = 0; i < 5000; ++i) runner.tick(1e-3);
  const auto refused = [&](const Vector3& point, const ArmRunner::JogSpeed& speed = {}) {
    const auto done = runner.jog_tool_to(point, speed);
    REQUIRE_FALSE(done);
    return done.error();
  };
  const auto check = [&] {
    auto error = refused({180, 0, 0});
    CHECK(error.code == ErrorCode::above_limit);
    CHECK(error.field == "axis R");
    CHECK(error.value == Approx(180).epsilon(1e-2));
    CHECK(error.bound == 170);
    error = refused({100, 0, -21});
    CHECK(error.code == ErrorCode::below_limit);
    CHECK(error.field == "axis S");
    CHECK(error.value == Approx(-21));
    CHECK(error.bound == -20);
    CHECK(refused({std::nan(""), 0, 0}).code == ErrorCode::not_finite);
    CHECK(refused({1, 2, 3}, {.tool = 0}).code == ErrorCode::not_positive);
    CHECK(refused({1, 2, 3}, {.axes = {1, -1, 1}}).code == ErrorCode::not_positive);
  };
  check();
  // Through the axis of the table: by the name of the first joint whose velocity would jump.
  const Vector3 here(100 * std::cos(0.5), 100 * std::sin(0.5), 0);
  CHECK(refused(-here).field == "axis R");
  CHECK(runner.state() != ExecutorState::jogging);
  REQUIRE(runner.jog_tool_to({60, 60, 0}));
  for (int i = 0; i < 200; ++i) runner.tick(1e-3);
  REQUIRE(runner.state() == ExecutorState::jogging);
  check();
  CHECK(runner.jog_tool_by({200, 0, 0}).error().code == ErrorCode::above_limit);
  SetPoint<3> point;
  for (int i = 0; i < 5000; ++i) point = runner.tick(1e-3);
  CHECK((Polar::coordinates(point.position) - Vector3(60, 60, 0)).norm() < 1e-9);
}

TEST_CASE("an arm that stands with its other elbow is not jogged at the tool", "[tool jog]") {
  ArmRunner runner(Scara::machine());
  REQUIRE(runner.jog_to({0, 1, 0}));
  for (int i = 0; i < 5000; ++i) runner.tick(1e-3);
  const auto done = runner.jog_tool_by({1, 0, 0});
  REQUIRE_FALSE(done);
  CHECK(done.error().code == ErrorCode::discontinuous);
  CHECK(done.error().field.substr(0, 5) == "axis ");
  REQUIRE(runner.jog_to({0, -1, 0}));
  for (int i = 0; i < 5000; ++i) runner.tick(1e-3);
  CHECK(runner.jog_tool_by({1, 0, 0}));
}

TEST_CASE("a jog of the tool winds a joint on, and keeps a speed of it", "[tool jog]") {
  ArmRunner runner(Polar::machine());
  REQUIRE(runner.jog_to({100, 0, 2 * pi + 3}));  // one turn and nearly a half
  for (int i = 0; i < 9000; ++i) runner.tick(1e-3);
  const Vector3 target(-80, -60, 5);  // beyond the ray where the formula jumps
  REQUIRE(runner.jog_tool_to(target, {.axes = {INFINITY, INFINITY, 0.2}}));
  double fastest = 0;
  SetPoint<3> point;
  for (int i = 0; i < 9000; ++i) {
    point = runner.tick(1e-3);
    fastest = std::max(fastest, point.velocity.cwiseAbs()[2]);
  }
  CHECK((Polar::coordinates(point.position) - target).norm() < 1e-9);
  CHECK(point.position[2] == Approx(3 * pi + std::atan2(60, 80)));
  CHECK(fastest <= 0.2 * (1 + 1e-9));
  CHECK(fastest > 0.1);
}

TEST_CASE("a quick stop ends a jog of the tool on its line with more than the limits", "[tool jog]") {
  const auto braked = [](double share) {
    ArmRunner runner(Scara::machine(), {.quick_stop_share = share});
    ToolJogRun<Scara, ArmRunner> jog(runner);
    REQUIRE(runner.jog_to({0.2, -1.4, 0}));
    jog.run(3);
    REQUIRE(jog.to({200, 30, 8}));
    jog.run(0.4);
    REQUIRE_FALSE(jog.rests);
    int ticks = 0;
    for (runner.quick_stop(); !jog.rests; ++ticks) jog.tick();
    CHECK(runner.state() != ExecutorState::jogging);
    jog.check(share);
    return ticks;
  };
  const int gentle = braked(1);
  CHECK(gentle > 10);
  CHECK(braked(4) < 0.6 * gentle);
}

TEST_CASE("joints that are jogged during a quick stop of the tool wait until it rests", "[tool jog]") {
  constexpr double share = 4;
  const bool back_to_tool = GENERATE(false, true);
  ArmRunner runner(Scara::machine(), {.quick_stop_share = share});
  ToolJogRun<Scara, ArmRunner> braking(runner);
  REQUIRE(runner.jog_to({0.2, -1.4, 0}));
  braking.run(3);
  REQUIRE(braking.to({200, 30, 8}));
  braking.run(0.4);
  runner.quick_stop();
  braking.run(0.005);
  REQUIRE_FALSE(braking.rests);
  REQUIRE(runner.jog_to({0.3, -1.2, 1}));
  if (back_to_tool) REQUIRE(runner.jog_tool_to({200, 20, 5}));  // the last request is the one that counts
  while (!braking.rests) braking.tick();
  braking.check(share);
  ToolJogRun<Scara, ArmRunner> behind(runner);
  behind.run(5);
  if (back_to_tool)
    CHECK((behind.at() - Vector3(200, 20, 5)).norm() < 1e-7);
  else
    CHECK(behind.joints().isApprox(Vector3(0.3, -1.2, 1)));
  CHECK(behind.velocity > 0.01);
  behind.check();
}

TEST_CASE("jogs of the tool ask for no memory", "[tool jog]") {
  const auto runner = std::make_unique<ArmRunner>(Delta::machine(), ArmRunner::Options{.tolerance = 0});
  const std::size_t before = test::heap_allocations();
  REQUIRE(runner->jog_to({270, 275, 280}));
  for (int i = 0; i < 3000; ++i) runner->tick(1e-3);
  bool all = true;
  for (int i = 0; i < 20; ++i) {
    all = runner->jog_tool_by({i % 2 == 0 ? 5.0 : -3.0, 1, -2}).has_value() && all;
    for (int k = 0; k < 100; ++k) runner->tick(1e-3);
  }
  CHECK(all);
  CHECK(test::heap_allocations() == before);
}
