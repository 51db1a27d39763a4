// Trajectories in float, held against the same in double.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

template <class S>
BasicMachine<S, 3> mill() {
  BasicMachine<S, 3> machine;
  machine.limits = {S(30), S(1000), S(10000)};
  for (auto& axis : machine.axes) {
    axis.acceleration = S(800);
    axis.motors = {{.steps_per_unit = S(100)}};
  }
  return machine;
}

// Lines, arcs, helices, spirals; stops and joints at speed.
const std::string program =
    "G1 X7.3 Y-2 Z1 F1500\nG2 X12 Y3 R6\nG4 P0.3\nG3 X20 Y3 Z4 I4 J0 P2\nG1 X19.99\nG1 X0 Y0\n"
    "G2 X30.003 Y0 I15 J0\nG1 X31 Y0.1\nX32 Y0.3\nX33 Y0.6\nX80 Y40 Z-3\nM0\nG0 Z10\nX-5 Y-5\n";

template <class S>
auto planned() {
  auto trajectory = plan_text(program, mill<S>(), {.tolerance = 0});
  INFO((trajectory ? std::string() : to_text(trajectory.error())));
  REQUIRE(trajectory);
  return std::move(*trajectory);
}

}  // namespace

TEST_CASE("float: the same blocks in the same time", "[float]") {
  const auto single = planned<float>();
  const auto exact = planned<double>();
  CHECK(static_cast<double>(single.duration()) == Approx(exact.duration()).epsilon(1e-5));
  CHECK(static_cast<double>(single.length()) == Approx(exact.length()).epsilon(1e-6));
  const auto a = single.blocks();
  const auto b = exact.blocks();
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CAPTURE(a[i].line);
    CHECK(a[i].block == b[i].block);
    CHECK(a[i].line == b[i].line);
    CHECK(static_cast<double>(a[i].start) == Approx(b[i].start).margin(2e-4));
    CHECK(static_cast<double>(a[i].entry) == Approx(b[i].entry).margin(3e-3));
    CHECK(static_cast<double>(a[i].peak) == Approx(b[i].peak).margin(3e-3));
  }
}

TEST_CASE("float: samples are where those of double are, one by one and many at once", "[float]") {
  const auto single = planned<float>();
  const auto exact = planned<double>();
  constexpr float period = 1e-3F;
  double place = 0, velocity = 0, batch = 0;
  std::vector<BasicVector3<float>> positions(static_cast<std::size_t>(single.samples(period).size()));
  REQUIRE(single.positions(period, 0, points<float, 3>(std::span(positions))) ==
          static_cast<Eigen::Index>(positions.size()));
  std::size_t i = 0;
  for (const auto& point : single.samples(period)) {
    const auto truth = exact.at(static_cast<double>(point.time));
    place = std::max(place, (point.position.cast<double>() - truth.position).norm());
    velocity = std::max(velocity, (point.velocity.cast<double>() - truth.velocity).norm());
    batch = std::max(batch, static_cast<double>((positions[i++] - point.position).norm()));
  }
  CHECK(i == positions.size());
  CHECK(place < 2e-4);     // mm
  CHECK(velocity < 2e-3);  // mm/s
  CHECK(batch < 2e-5);     // mm
  CHECK((single.at(single.duration()).position.cast<double>() - exact.at(exact.duration()).position).norm() <
        1e-5);
}

TEST_CASE("float: motors make the steps of double, at the same places", "[float]") {
  const auto single = planned<float>();
  const auto exact = planned<double>();
  struct Motor {
    std::vector<int> directions;
    std::vector<double> times;
  };
  const auto edges_of = [](const auto& trajectory) {
    std::map<std::size_t, Motor> motors;
    double last = 0;
    for (const auto& edge : trajectory.step_edges()) {
      REQUIRE(static_cast<double>(edge.time) >= last);
      last = static_cast<double>(edge.time);
      motors[edge.motor].directions.push_back(edge.direction);
      motors[edge.motor].times.push_back(last);
    }
    return motors;
  };
  auto a = edges_of(single);
  auto b = edges_of(exact);
  for (std::size_t motor = 0; motor < 3; ++motor) {
    CAPTURE(motor);
    REQUIRE(a[motor].directions == b[motor].directions);
    double worst = 0;  // steps that the axis is away in float's trajectory at float's time of the edge
    auto count = static_cast<double>(std::llround(exact.at(0).position[static_cast<int>(motor)] * 100));
    for (std::size_t i = 0; i < a[motor].times.size(); ++i) {
      const double boundary = count + 0.5 * a[motor].directions[i];
      const auto at = single.at(static_cast<float>(a[motor].times[i])).position[static_cast<int>(motor)];
      worst = std::max(worst, std::abs(static_cast<double>(at) * 100 - boundary));
      count += a[motor].directions[i];
    }
    CHECK(worst < 0.01);
  }
}
