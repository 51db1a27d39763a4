// SPDX-License-Identifier: GPL-2.0-or-later
// Programs through the module's functions: limits, tolerance, order, ends.
#include <cstring>
#include <string>

#include "run.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/shared.hpp"

using namespace cncplan::linuxcnc;
using namespace cncplan::linuxcnc::test;
using cncplan::test::Random;

namespace {

constexpr double path_tolerance = 0.01;

Run driven(const HostOptions& options, const std::vector<CanonMove>& moves,
           double tolerance = path_tolerance) {
  Host host(options);
  host.blend(tolerance / (options.linear_units == "inch" ? 25.4 : 1.0));
  return drive(host, moves);
}

void check_program(const HostOptions& options, const std::vector<CanonMove>& moves, double jerk) {
  const Run run = driven(options, moves);
  REQUIRE(printed().empty());
  REQUIRE(run.ended);
  CHECK(beyond_limits(run, options, jerk) == "");
  CHECK(deviation(run, moves) <= path_tolerance * 1.0001);
  CHECK(ids_ascend(run));
  CHECK((run.samples.back().position - moves.back().end).cwiseAbs().maxCoeff() < 1e-9);
}

std::vector<CanonMove> within(std::vector<CanonMove> moves, std::size_t most) {
  if (moves.size() > most) moves.resize(most);
  return moves;
}

}  // namespace

TEST_CASE("real programs keep limits and tolerance") {
  const auto folder = cncplan::test::shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  const HostOptions options;
  check_program(options, read_lines(*folder + "/data/ball.nc", 800), 1e4);
  for (const char* name : {"3dtest", "tort", "cds", "arcspiral", "Cereal"}) {
    INFO(name);
    check_program(options, within(read_motions(*folder + "/data/ngc/" + name + ".motions"), 120), 1e4);
  }
}

TEST_CASE("random programs keep limits and tolerance") {
  Random random;
  for (int i = 0; i < 6; ++i) {
    HostOptions options;
    options.velocity = random.log_uniform(5.0, 100.0);
    options.acceleration = random.log_uniform(200.0, 3000.0);
    const double jerk = random.log_uniform(3e3, 1e5);
    options.jerk = std::to_string(jerk);
    const auto moves = random_program(random, 60);
    INFO("seed " << cncplan::test::seed() << ", program " << i << ", velocity " << options.velocity
                 << ", acceleration " << options.acceleration << ", jerk " << jerk);
    check_program(options, moves, jerk);
  }
}

TEST_CASE("an inch machine goes the same way") {
  Random random;
  const auto moves = random_program(random, 40);
  const HostOptions metric;
  HostOptions imperial;
  imperial.linear_units = "inch";
  imperial.velocity = metric.velocity / 25.4;
  imperial.acceleration = metric.acceleration / 25.4;
  imperial.jerk = std::to_string(1e4 / 25.4);
  const Run one = driven(metric, moves), other = driven(imperial, moves);
  REQUIRE(one.ended);
  REQUIRE(other.ended);
  CHECK(beyond_limits(other, imperial, 1e4 / 25.4) == "");
  CHECK(deviation(other, moves) <= path_tolerance * 1.0001);
  // other rounding, other splines: as much as a few ramps
  CHECK(static_cast<double>(other.samples.size()) ==
        Approx(static_cast<double>(one.samples.size())).epsilon(0.005));
}

TEST_CASE("all nine axes keep their limits") {
  Random random;
  HostOptions options;
  options.level = "";  // good is for six
  options.coordinates = "X Y Z A B C U V W";
  options.rotary_jerk = "10000";
  auto moves = random_program(random, 40);
  Coordinates at = Coordinates::Zero();
  for (std::size_t i = 0; i < moves.size(); ++i) {
    for (int c = 3; c < coordinate_count; ++c)
      if (random.coin()) at[c] += random.uniform(-10.0, 10.0);
    moves[i].end.tail<6>() = at.tail<6>();
    if (i % 7 == 6 && moves[i].rotation == 0) moves[i].end.head<3>() = moves[i - 1].end.head<3>();
    if (i % 7 == 6) moves[i].rotation = 0;
  }
  const Run run = driven(options, moves);
  INFO("seed " << cncplan::test::seed() << ' ' << printed());
  REQUIRE(run.ended);
  CHECK(beyond_limits(run, options, 1e4, 1e4) == "");
  CHECK((run.samples.back().position - moves.back().end).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("the same program gives the same bytes") {
  Random random;
  const auto moves = random_program(random, 80);
  const Run one = driven({}, moves), other = driven({}, moves);
  REQUIRE(one.ended);
  REQUIRE(one.samples.size() == other.samples.size());
  bool same = true;
  for (std::size_t i = 0; i < one.samples.size(); ++i)
    same = same && std::memcmp(one.samples[i].position.data(), other.samples[i].position.data(),
                               sizeof(Coordinates)) == 0;
  CHECK(same);
}

TEST_CASE("exact paths and exact stops are exact") {
  Random random;
  const auto moves = random_program(random, 30);
  for (const bool stops : {false, true}) {
    Host host({});
    stops ? host.exact_stop() : host.exact_path();
    const Run run = drive(host, moves);
    REQUIRE(run.ended);
    CHECK(deviation(run, moves) < 1e-8);
  }
}

TEST_CASE("G64 without P takes the module's tolerance") {
  Random random;
  const auto moves = random_program(random, 40);
  double last = 0.0;
  for (const double tolerance : {0.005, 0.05}) {
    HostOptions options;
    options.tolerance = std::to_string(tolerance);
    const Run run = driven(options, moves, 0.0);
    REQUIRE(run.ended);
    const double far = deviation(run, moves);
    CHECK(far <= tolerance * 1.0001);
    CHECK(far > last);
    last = 0.005;
  }
}

TEST_CASE("the servo cycle keeps off the heap") {
  Random random;
  const auto moves = random_program(random, 60);
  Host host({});
  host.blend(path_tolerance);
  std::size_t allocations = 0, sent = 0;
  for (int i = 0; i < 100'000; ++i) {
    host.plan();
    allocations += cncplan::test::heap_allocations_of([&] {
      if (sent < moves.size() && !host.queue_full() && send(host, moves[sent]) == 0) ++sent;
      host.servo_period();
    });
    if (sent == moves.size() && host.tp.done != 0) break;
  }
  CHECK(host.tp.done == 1);
  CHECK(allocations == 0);
}
