// Jogs of the tool behind a map: straight in the program's coordinates, within the limits of the joints.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <Eigen/LU>

#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan/plan/executor.hpp"
#include "kinematics/tool_jog_run.hpp"
#include "maps/maps.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using test::ToolJogRun;

namespace {

constexpr double pi = std::numbers::pi;

using Arms = MappedMachine<kinematics::ThreeJoints>;
using ArmRunner = Executor<Arms, 16>;

// Joints that turn have a share of these, in rad.
void set_limits(Arms& machine, std::array<bool, 3> turns, double share) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double scale = turns[i] ? share : 1;
    machine.axes[i] = {.letter = "RSZ"[i],
                       .kind = turns[i] ? AxisKind::rotary : AxisKind::linear,
                       .velocity = 100 * scale,
                       .acceleration = 1000 * scale,
                       .jerk = 20000 * scale};
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
