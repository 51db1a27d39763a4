#include "cncplan/follow_steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr std::string_view program = "G1 X7.3 Y-2 Z1 F1500\nG2 X12 Y3 R6\nG3 X20 Y3 Z4 I4 J0 P2\nG1 X0 Y0\n";

Machine<3> stepped(double backlash) {
  Machine<3> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  machine.axes[0].motors = {{.steps_per_unit = 80, .backlash = backlash}};
  machine.axes[1].motors = {{.steps_per_unit = 123.4}, {.steps_per_unit = 50}};  // a gantry; Z has no motor
  return machine;
}

// What an axis has done, from the list of its first motor's edges: the load is a slider that the motor pushes
// from both sides, with play of so many steps between them.
struct Followed {
  std::int64_t net{}, total{};
  double position{}, mean_square{}, largest{}, closest = 1e9;
};

template <class T>
Followed follow(const T& trajectory, const std::vector<MotorEdge>& edges, std::size_t motor, int axis,
                double scale, double play, double period) {
  Followed result;
  std::vector<MotorEdge> own;
  std::copy_if(edges.begin(), edges.end(), std::back_inserter(own),
               [motor](const MotorEdge& edge) { return edge.motor == motor; });
  auto load = static_cast<double>(std::llround(trajectory.at(0).position[axis] * scale));
  double low = own.front().direction > 0 ? load : load - play;  // where the motor's jaws stand
  double square = 0;
  std::size_t next = 0;
  std::vector<double> times;
  for (int k = 0; k * period < trajectory.duration(); ++k) times.push_back(k * period);
  times.push_back(trajectory.duration());
  for (const double time : times) {
    for (; next < own.size() && (own[next].time <= time || time == times.back()); ++next) {
      low += own[next].direction;
      load = std::clamp(load, low, low + play);
      result.net += own[next].direction;
      ++result.total;
      if (next > 0 && own[next].direction == own[next - 1].direction)
        result.closest = std::min(result.closest, own[next].time - own[next - 1].time);
    }
    const double error = load / scale - trajectory.at(time).position[axis];
    square += error * error;
    result.largest = std::max(result.largest, std::abs(error));
  }
  result.position = load / scale;
  result.mean_square = square / static_cast<double>(times.size());
  return result;
}

}  // namespace

TEST_CASE("what steps have done is what a count of the edges says, with backlash and without",
          "[follow_steps]") {
  constexpr double period = 1e-3;
  for (const double backlash : {0.0, 0.1}) {
    CAPTURE(backlash);
    const auto planned = plan_text(program, stepped(backlash), {.tolerance = 0});
    REQUIRE(planned);
    std::vector<MotorEdge> edges;
    const auto reports =
        follow_steps(*planned, period, [&](const MotorEdge& edge) { edges.push_back(edge); });
    REQUIRE(reports);
    CHECK(std::is_sorted(edges.begin(), edges.end(),
                         [](const MotorEdge& a, const MotorEdge& b) { return a.time < b.time; }));
    CHECK(std::any_of(edges.begin(), edges.end(), [](const MotorEdge& edge) { return edge.motor == 2; }));
    struct Case {
      std::size_t motor;
      int axis;
      double scale, play;
    };
    for (const auto& [motor, axis, scale, play] :
         {Case{0, 0, 80, std::round(80 * backlash)}, Case{1, 1, 123.4, 0}}) {
      CAPTURE(axis);
      const auto& report = (*reports)[static_cast<std::size_t>(axis)];
      const Followed expected = follow(*planned, edges, motor, axis, scale, play, period);
      CHECK(report.net_steps == expected.net);
      CHECK(report.total_steps == expected.total);
      CHECK(report.total_steps > 1000);
      CHECK(report.position == Approx(expected.position).margin(1e-12));
      CHECK(report.mean_square_error == Approx(expected.mean_square).epsilon(1e-9));
      CHECK(report.rms_error == Approx(std::sqrt(expected.mean_square)).epsilon(1e-9));
      CHECK(report.max_error == Approx(expected.largest).epsilon(1e-9));
      CHECK(report.max_error < 0.501 / scale);  // the nearest step, at every instant
      CHECK(report.peak_rate == Approx(1 / expected.closest).epsilon(1e-9));
    }
    CHECK((*reports)[2] == step::AxisReport{});  // no motor
  }
}

TEST_CASE("the first edge that breaks a drive's rule ends the following of steps", "[follow_steps]") {
  Machine<3> machine = stepped(0);
  machine.axes[0].motors[0].max_rate = 1000;  // 12.5 mm/s, of 25
  const auto planned = plan_text(program, machine, {.tolerance = 0});
  REQUIRE(planned);
  double first = 0, before = 0;
  for (const MotorEdge& edge : planned->step_edges()) {
    if (edge.motor != 0) continue;
    if (before > 0 && edge.time - before < 1e-3 - 1e-9) {
      first = edge.time;
      break;
    }
    before = edge.time;
  }
  REQUIRE(first > 0);
  std::size_t taken = 0;
  const auto refused = follow_steps(*planned, 1e-3, [&](const MotorEdge&) { ++taken; });
  REQUIRE(!refused);
  CHECK(refused.error().axis == 0);
  CHECK(refused.error().time == first);
  CHECK(refused.error().error.code == ErrorCode::above_limit);
  CHECK(taken > 10);
}

TEST_CASE("steps are not held against positions at no period", "[follow_steps]") {
  const auto planned = plan_text(program, stepped(0), {.tolerance = 0});
  REQUIRE(planned);
  for (const double period : {0.0, -1.0, std::nan("")}) {
    int edges = 0;
    const auto reports = follow_steps(*planned, period, [&](const MotorEdge&) { ++edges; });
    REQUIRE_FALSE(reports);
    CHECK(reports.error().error.field == "period");
    CHECK(edges == 0);
  }
}
