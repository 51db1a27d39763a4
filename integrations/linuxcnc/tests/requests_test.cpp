// SPDX-License-Identifier: GPL-2.0-or-later
// What the operator and the program ask for besides motion: pauses, steps, backwards, aborts, overrides,
// outputs, the spindle.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "run.hpp"
#include "support/catch.hpp"

using namespace cncplan::linuxcnc;
using namespace cncplan::linuxcnc::test;
using cncplan::Vector3;
using cncplan::test::Random;

namespace {

Coordinates at(double x, double y = 0.0, double z = 0.0) {
  Coordinates result = Coordinates::Zero();
  result.head<3>() << x, y, z;
  return result;
}
CanonMove line_to(double x, double y, double feed = 20.0) {
  CanonMove move;
  move.end = at(x, y);
  move.feed = feed;
  return move;
}
// A square of 20 mm sides and back.
std::vector<CanonMove> square() { return {line_to(20, 0), line_to(20, 20), line_to(0, 20), line_to(0, 0)}; }

}  // namespace

TEST_CASE("pauses at random instants come to rest and go on") {
  Random random;
  for (int i = 0; i < 8; ++i) {
    const auto moves = random_program(random, 25);
    Host host({});
    host.blend(0.01);
    long next = random.integer(1, 600);
    bool paused = false;
    int still = 0;
    const Run run = drive(host, moves, [&](long period) {
      if (paused) still = host.status.current_vel == 0.0 ? still + 1 : 0;
      if (period < next || (paused && still < 5)) return;
      paused = !paused;
      paused ? host.pause() : host.resume();
      still = 0;
      next = period + random.integer(1, 900);
    });
    INFO("seed " << cncplan::test::seed() << ", program " << i);
    REQUIRE(run.ended);
    CHECK(beyond_limits(run, host.options, 1e4) == "");
    CHECK(deviation(run, moves) <= 0.010001);
    CHECK((run.samples.back().position - moves.back().end).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("a pause takes no longer than the limits ask") {
  Host host({});
  Run run = drive(host, {line_to(200, 0, 30.0)}, {}, 2000);  // in the midst of it, at 30 mm/s
  REQUIRE(host.status.current_vel == Approx(30.0));
  host.pause();
  int periods = 0;
  for (; host.status.current_vel != 0.0 && periods < 1000; ++periods) host.cycle();
  // 30 mm/s at 1e4 mm/s^3, 547 mm/s^2 at most: 2 sqrt(v / J), and a period or two
  CHECK(periods <= std::ceil(2.0 * std::sqrt(30.0 / 1e4) * 1e3) + 2);
  CHECK(host.tp.done == 0);
}

TEST_CASE("an abort at a random instant comes to rest, and the next program runs") {
  Random random;
  for (int i = 0; i < 10; ++i) {
    const auto moves = random_program(random, 25);
    Host host({});
    host.blend(0.01);
    const long when = random.integer(0, 4000);
    Run run = drive(
        host, moves,
        [&](long period) {
          if (period == when) host.abort();
        },
        when + 1);
    for (int k = 0; k < 2000 && host.tp.aborting != 0; ++k) {
      host.cycle();
      run.samples.push_back({host.position(), host.tp.execId, 0.0});
    }
    INFO("seed " << cncplan::test::seed() << ", program " << i << ", abort at " << when);
    CHECK(host.tp.aborting == 0);
    CHECK(host.tp.done == 1);
    CHECK(host.tp.depth == 0);
    CHECK(host.goal() == host.position());
    CHECK(beyond_limits(run, host.options, 1e4) == "");
    REQUIRE(host.line(host.position() + at(1.0), 10.0) == TP_ERR_OK);
    CHECK(host.run(5000));
  }
}

TEST_CASE("no move is taken while an abort is under way") {
  Host host({});
  REQUIRE(host.line(at(50), 20.0) == TP_ERR_OK);
  for (int i = 0; i < 500; ++i) host.cycle();
  host.abort();
  CHECK(host.line(at(60), 20.0) == TP_ERR_FAIL);
  CHECK(printed().find("aborted") != std::string::npos);
}

TEST_CASE("clearing forgets all at once") {
  Host host({});
  REQUIRE(host.line(at(50), 20.0) == TP_ERR_OK);
  for (int i = 0; i < 500; ++i) host.cycle();
  const Coordinates before = host.position();
  host.functions.clear(&host.tp);  // the machine has been switched off
  host.cycle();
  CHECK(host.position() == before);
  CHECK(host.tp.done == 1);
  CHECK(host.status.distance_to_go == 0.0);
}

TEST_CASE("steps end at the end of each move") {
  Host host({});
  host.exact_stop();
  const auto moves = square();
  for (const CanonMove& move : moves) REQUIRE(send(host, move) == TP_ERR_OK);
  host.pause();
  for (int i = 0; i < 20; ++i) host.cycle();
  for (std::size_t k = 0; k < moves.size(); ++k) {
    INFO("step " << k);
    host.step();
    for (int i = 0; i < 5000 && (host.status.stepping != 0 || host.status.current_vel > 0.0); ++i)
      host.cycle();
    for (int i = 0; i < 100; ++i) host.cycle();
    CHECK((host.position() - moves[k].end).norm() < 1e-9);
  }
  CHECK(host.tp.done == 1);
}

TEST_CASE("a resume in the period in which a step ends goes on") {
  Host host({});
  host.exact_stop();
  for (const CanonMove& move : square()) REQUIRE(send(host, move) == TP_ERR_OK);
  host.pause();
  for (int i = 0; i < 20; ++i) host.cycle();
  host.step();
  for (int i = 0; i < 5000 && host.status.stepping != 0; ++i) host.cycle();
  REQUIRE(host.status.stepping == 0);
  host.resume();
  CHECK(host.run(20000));
  CHECK(host.tp.done == 1);
}

TEST_CASE("backwards goes the same way back, and forwards again to the end") {
  Host host({});
  host.blend(0.01);
  const auto moves = square();
  int phase = 0;
  long since = 0;
  std::set<int> backward_ids;
  const Run run = drive(
      host, moves,
      [&](long period) {
        const bool rests = host.status.current_vel == 0.0 && period > since + 50;
        if (phase == 0 && period == 2300) host.pause(), phase = 1, since = period;
        if (phase == 1 && rests) {
          CHECK(host.functions.set_run_dir(&host.tp, TC_DIR_REVERSE) == TP_ERR_OK);
          host.resume(), phase = 2, since = period;
        }
        if (phase == 2) backward_ids.insert(host.tp.execId);
        if (phase == 2 && period == since + 100)
          CHECK(host.functions.set_run_dir(&host.tp, TC_DIR_FORWARD) == TP_ERR_FAIL);  // it moves
        if (phase == 2 && rests && host.position().norm() < 1e-9) {
          CHECK(host.tp.done == 0);
          CHECK(host.functions.set_run_dir(&host.tp, TC_DIR_FORWARD) == TP_ERR_OK);
          phase = 3;
        }
      },
      30000);
  CHECK(phase == 3);
  CHECK(backward_ids == std::set<int>{1, 2, 3});
  REQUIRE(run.ended);
  CHECK(beyond_limits(run, host.options, 1e4) == "");
  CHECK(deviation(run, moves) <= 0.010001);
}

TEST_CASE("adaptive feed below 0 goes back") {
  Host host({});
  host.status.enables_new |= AF_ENABLED;
  const std::vector<CanonMove> moves{line_to(60, 0), line_to(60, 60)};
  double furthest = 0.0, back = 0.0;
  const Run run = drive(host, moves, [&](long period) {
    if (period < 2000) furthest = host.position()[0];
    if (period == 2000) host.adaptive_feed = -0.5;
    if (period == 3500) back = host.position()[0], host.adaptive_feed = 1.0;
  });
  CHECK(back < furthest - 5.0);
  REQUIRE(run.ended);
  CHECK(beyond_limits(run, host.options, 1e4) == "");
}

TEST_CASE("overrides scale feed and rapids each by its own share") {
  const auto top = [](bool rapid, double feed_scale, double rapid_scale, double adaptive) {
    Host host({});
    host.status.enables_new |= AF_ENABLED;
    host.status.feed_scale = feed_scale, host.status.rapid_scale = rapid_scale, host.adaptive_feed = adaptive;
    CanonMove move = line_to(60, 0, 10.0);
    move.rapid = rapid;
    const Run run = drive(host, {move});
    REQUIRE(run.ended);
    return peaks(run, 0).velocity;
  };
  CHECK(top(false, 0.5, 1.0, 1.0) == Approx(5.0));
  CHECK(top(false, 1.5, 0.1, 1.0) == Approx(15.0));
  CHECK(top(false, 1.5, 0.1, 0.4) == Approx(6.0));
  CHECK(top(true, 0.1, 0.5, 1.0) == Approx(15.0));
  CHECK(top(true, 2.0, 1.0, 1.0) == Approx(30.0));
}

TEST_CASE("M49 and M53 hold for the moves that were sent with them") {
  Host host({});
  host.status.feed_scale = 0.5;
  host.status.enables_new = SS_ENABLED;
  const Run run = drive(host, {line_to(60, 0, 10.0)});
  REQUIRE(run.ended);
  CHECK(peaks(run, 0).velocity == Approx(10.0));
}

TEST_CASE("the slider of the highest velocity holds in mid-move, and gives back") {
  Host host({});
  double slow = 0.0;
  const Run run = drive(host, {line_to(100, 0, 20.0)}, [&](long period) {
    if (period == 1000) host.functions.set_v_limit(&host.tp, 5.0);
    if (period == 2000) slow = host.status.current_vel, host.functions.set_v_limit(&host.tp, 100.0);
    if (period == 3000) CHECK(host.status.current_vel == Approx(20.0));
  });
  CHECK(slow == Approx(5.0));
  REQUIRE(run.ended);
  CHECK(beyond_limits(run, host.options, 1e4) == "");
}

TEST_CASE("feed hold rests, and lets go") {
  Host host({});
  const Run run = drive(host, square(), [&](long period) {
    if (period == 700) host.feed_hold = true;
    if (period == 1500) {
      CHECK(host.status.current_vel == 0.0);
      CHECK(host.tp.done == 0);
      host.feed_hold = false;
    }
  });
  REQUIRE(run.ended);
  CHECK(beyond_limits(run, host.options, 1e4) == "");
}

TEST_CASE("what is told of the move that runs") {
  Host host({});
  host.exact_stop();
  REQUIRE(send(host, line_to(60, 0, 20.0)) == TP_ERR_OK);
  REQUIRE(host.circle(at(60, 40), Vector3(60, 20, 0), Vector3(0, 0, 1), 0, 10.0) == TP_ERR_OK);
  while (host.tp.execId < 2 && periods() < 20000) {
    host.cycle();
    if (host.tp.execId != 1) continue;
    const double to_go = 60.0 - host.position()[0];
    if (std::abs(host.status.distance_to_go - to_go) > 1e-9) FAIL("distance to go");
    if (std::abs(host.status.dtg.tran.x - to_go) > 1e-9) FAIL("distances of the axes");
    if (host.status.requested_vel != 20.0 || host.tp.motionType != EMC_MOTION_TYPE_FEED) FAIL("move");
  }
  for (int i = 0; i < 1500; ++i) host.cycle();
  CHECK(host.tp.execId == 2);
  CHECK(host.tp.motionType == EMC_MOTION_TYPE_ARC);
  CHECK(host.status.current_vel == Approx(10.0));
  const Coordinates p = host.position();
  // a half turn upwards from -90 degrees
  const double turned = std::atan2(p[1] - 20.0, p[0] - 60.0) + std::acos(0.0);
  CHECK(host.status.distance_to_go == Approx(20.0 * (2.0 * std::acos(0.0) - turned)).epsilon(1e-6));
  CHECK(host.tp.depth == 1);
  CHECK(host.run(20000));
}

TEST_CASE("outputs are switched where their move begins, in order, once") {
  Host host({});
  host.blend(0.01);
  std::vector<double> places;
  const auto watch = [&](long) {
    while (places.size() < switched().size()) places.push_back(host.position()[0]);
  };
  REQUIRE(send(host, line_to(10, 0)) == TP_ERR_OK);
  host.functions.set_dout(&host.tp, 1, 1, 1);
  host.functions.set_aout(&host.tp, 0, 2.5, 2.5);
  REQUIRE(send(host, line_to(20, 0)) == TP_ERR_OK);
  host.functions.set_dout(&host.tp, 1, 0, 0);
  REQUIRE(send(host, line_to(30, 10)) == TP_ERR_OK);
  const Run run = drive(host, {line_to(40, 0)}, watch);
  watch(0);
  REQUIRE(run.ended);
  REQUIRE(switched() == std::vector<std::string>{"D1=1", "A0=2.5", "D1=0"});
  // within a period's way of the corner
  CHECK(places[0] == Approx(10.0).margin(0.05));
  CHECK(places[2] == Approx(20.0).margin(0.05));
}

TEST_CASE("an abort forgets outputs that wait for a move") {
  Host host({});
  host.functions.set_dout(&host.tp, 1, 1, 1);
  host.abort();
  host.cycle();
  REQUIRE(send(host, line_to(5, 0)) == TP_ERR_OK);
  CHECK(host.run(10000));
  CHECK(switched().empty());
}

TEST_CASE("a move waits at rest for its spindle") {
  Host host({});
  host.blend(0.01);
  REQUIRE(host.line(at(10), 20.0) == TP_ERR_OK);
  REQUIRE(host.line(at(20), 20.0, EMC_MOTION_TYPE_FEED, true) == TP_ERR_OK);
  for (int i = 0; i < 2000; ++i) host.cycle();
  CHECK(host.position()[0] == Approx(10.0).margin(1e-9));
  CHECK(host.tp.done == 0);
  CHECK(host.status.current_vel == 0.0);
  host.status.spindle_status[0].at_speed = 1;
  CHECK(host.run(10000));
  CHECK(host.position()[0] == 20.0);
}

TEST_CASE("an abort while a move waits for its spindle") {
  Host host({});
  REQUIRE(host.line(at(10), 20.0, EMC_MOTION_TYPE_FEED, true) == TP_ERR_OK);
  for (int i = 0; i < 50; ++i) host.cycle();
  host.abort();
  host.cycle();
  CHECK(host.tp.done == 1);
  CHECK(host.tp.aborting == 0);
  CHECK(host.position() == at(0));
}

// A spindle that turns ten times a second and passes its index.
struct Spindle {
  double speed = 10.0, revolutions = 0.3;
  void turn(Host& host) {
    auto& spindle = host.status.spindle_status[0];
    const double before = revolutions;
    spindle.at_speed = 1;
    spindle.direction = speed > 0.0 ? 1 : -1;
    spindle.speed = 60.0 * speed;
    revolutions += std::abs(speed) * 1e-3;
    if (spindle.spindle_index_enable != 0 && std::floor(revolutions) > std::floor(before)) {
      spindle.spindle_index_enable = 0;
      revolutions -= std::floor(revolutions);
    }
    spindle.spindleRevs = revolutions;
  }
};

// How far a thread of pitch 1 is from its spindle between Z3 and Z-13, at most, and that the program ends.
double thread_error(const TpFunctions& planner) {
  Host host({}, planner);
  host.blend(0.01);
  Spindle spindle;
  REQUIRE(host.line(at(0, 0, 5), 20.0) == TP_ERR_OK);
  host.functions.set_spindle_sync(&host.tp, 0, 1.0, 0);
  REQUIRE(host.line(at(0, 0, -15), 20.0) == TP_ERR_OK);
  host.functions.set_spindle_sync(&host.tp, 0, 0.0, 0);
  REQUIRE(host.line(at(10, 0, -15), 20.0) == TP_ERR_OK);
  double worst = 0.0;
  int synchronized = 0;
  for (int i = 0; i < 20000 && host.tp.done == 0; ++i) {
    spindle.turn(host);
    host.cycle();
    const double z = host.position()[2];
    if (host.tp.execId != 2 || z > 3.0 || z < -13.0) continue;
    worst = std::max(worst, std::abs((5.0 - z) - spindle.revolutions));
    ++synchronized;
  }
  INFO(printed());
  CHECK(host.tp.done == 1);
  CHECK((host.position() - at(10, 0, -15)).norm() < 1e-9);
  CHECK(synchronized > 1000);
  return worst;
}

TEST_CASE("a thread between moves of cncplan follows the spindle as LinuxCNC's own planner does") {
  const double own = thread_error(debians_functions());
  CHECK(own < 0.2);
  CHECK(thread_error(our_functions()) == Approx(own).margin(0.01));
}

TEST_CASE("a rigid tap goes in and comes back, and the program goes on") {
  Host host({});
  host.blend(0.01);
  Spindle spindle;
  REQUIRE(host.line(at(5, 5, 2), 20.0) == TP_ERR_OK);
  REQUIRE(host.tap(at(5, 5, -8), 20.0, 1.0) == TP_ERR_OK);
  REQUIRE(host.line(at(15, 5, 2), 20.0) == TP_ERR_OK);
  double deepest = 2.0, jump = 0.0;
  Coordinates last = host.position();
  for (int i = 0; i < 40000 && host.tp.done == 0; ++i) {
    spindle.speed = host.status.spindle_status[0].speed < 0.0 ? -10.0 : 10.0;
    spindle.turn(host);
    const double speed = host.status.spindle_status[0].speed;
    host.cycle();
    // the tap turns the spindle by its commanded speed
    if (host.status.spindle_status[0].speed != speed) spindle.speed = -spindle.speed;
    deepest = std::min(deepest, host.position()[2]);
    jump = std::max(jump, (host.position() - last).norm());
    last = host.position();
  }
  INFO(printed());
  CHECK(host.tp.done == 1);
  CHECK(deepest == Approx(-8.0).margin(1.0));
  CHECK((host.position() - at(15, 5, 2)).norm() < 1e-9);
  CHECK(jump < 0.031);
}

TEST_CASE("a rigid tap without its spindle is refused") {
  Host host({});
  CHECK(host.functions.add_rigid_tap(&host.tp, pose(at(0, 0, -5)), 10.0, 30.0, 1000.0,
                                     CNCPLAN_TP_JERK_ARGUMENT(1e9) 0, 1.0, state_tag_t{}) == TP_ERR_FAIL);
}

TEST_CASE("a circle in a tilted plane is run by LinuxCNC's own planner") {
  Host host({});
  const double s = std::sqrt(0.5);
  REQUIRE(host.line(at(10), 20.0) == TP_ERR_OK);
  // about the axis (1, 0, 1), a half turn round (5, 5, 5)
  const Vector3 center(10, 5, 0), normal(s, 0, s);
  REQUIRE(host.circle(at(10, 10, 0), center, normal, 0, 10.0) == TP_ERR_OK);
  double worst = 0.0;
  for (int i = 0; i < 10000 && host.tp.done == 0; ++i) {
    host.cycle();
    if (host.tp.execId != 2) continue;
    const Vector3 out = host.position().head<3>() - center;
    worst = std::max({worst, std::abs(out.norm() - 5.0), std::abs(out.dot(normal))});
  }
  CHECK(host.tp.done == 1);
  CHECK((host.position() - at(10, 10)).norm() < 1e-9);
  CHECK(worst < 1e-6);
}

TEST_CASE("a move that cannot be planned stops the motion within limits, and says why") {
  Host host({});
  host.blend(0.01);
  auto moves = square();
  moves[2].feed = std::numeric_limits<double>::quiet_NaN();
  Run run;
  run.samples.push_back({host.position(), 0, 0.0});
  for (const CanonMove& move : moves) REQUIRE(send(host, move) == TP_ERR_OK);
  for (int i = 0; i < 20000 && host.tp.done == 0; ++i) {
    host.cycle();
    run.samples.push_back({host.position(), host.tp.execId, 0.0});
  }
  CHECK(host.tp.done == 1);
  CHECK((host.status.motionFlag & EMCMOT_MOTION_ERROR_BIT) != 0);
  INFO(printed());
  CHECK(printed().find("cncplan_tp: error: line 3: feed") != std::string::npos);
  CHECK(beyond_limits(run, host.options, 1e4) == "");
}

TEST_CASE("a machine without limits says so and does not move") {
  HostOptions options;
  options.velocity = 0.0;
  Host host(options);
  REQUIRE(host.functions.add_line(&host.tp, pose(at(5)), EMC_MOTION_TYPE_FEED, 10.0, 10.0, 100.0,
                                  CNCPLAN_TP_JERK_ARGUMENT(1e9) 0, 0, -1, state_tag_t{}) == TP_ERR_OK);
  CHECK(host.run(1000));
  CHECK(host.position() == at(0));
  INFO(printed());
  CHECK(printed().find("velocity limit") != std::string::npos);
}

TEST_CASE("moves of length zero, of axes that are not there, and bad numbers") {
  Host host({});
  CHECK(host.line(at(0), 10.0) == TP_ERR_ZERO_LENGTH);
  Coordinates turned = at(0);
  turned[3] = 10.0;
  CHECK(host.line(turned, 10.0) < 0);
  CHECK(printed().find("axis A is not in [TRAJ]COORDINATES") != std::string::npos);
  CHECK(host.line(at(std::numeric_limits<double>::quiet_NaN()), 10.0) < 0);
  CHECK(host.circle(at(10), Vector3(std::nan(""), 0, 0), Vector3(0, 0, 1), 0, 10.0) < 0);
  host.cycle();
  CHECK(host.tp.done == 1);
  CHECK(host.position() == at(0));
}

TEST_CASE("the queue says when it is full, and takes some more") {
  Host host({});
  int sent = 0;
  while (!host.queue_full() && sent < 10000) REQUIRE(host.line(at(0.01 * ++sent), 10.0) == TP_ERR_OK);
  CHECK(sent > 1000);
  for (int i = 0; i < 20; ++i) CHECK(host.line(at(0.01 * ++sent), 10.0) == TP_ERR_OK);
  CHECK(host.tp.depth == sent);
  CHECK(host.run(200000));
  CHECK(host.position()[0] == 0.01 * sent);
}

TEST_CASE("random requests at random instants") {
  const char* const count = std::getenv("CNCPLAN_TP_SEQUENCES");
  const int sequences = count != nullptr ? std::atoi(count) : 20;
  const auto first = cncplan::test::seed();
  for (int k = 0; k < sequences; ++k) {
    Random random(first + static_cast<std::uint64_t>(k));
    const auto moves = random_program(random, random.integer(3, 25));
    HostOptions options;
    options.velocity = random.log_uniform(5.0, 100.0);
    options.acceleration = random.log_uniform(200.0, 3000.0);
    Host host(options);
    if (random.coin()) host.status.enables_new |= AF_ENABLED;
    const double tolerance = random.log_uniform(0.002, 0.2);
    host.blend(tolerance);
    long asks = random.integer(1, 12);
    bool ended = false;
    const Run run = drive(
        host, moves,
        [&](long period) {
          if (period > 20000 || asks == 0) {  // let it end
            if (!ended) host.resume(), host.feed_hold = false, host.adaptive_feed = 1.0;
            ended = true;
            if (host.status.current_vel == 0.0 && host.tp.reverse_run == TC_DIR_REVERSE)
              host.functions.set_run_dir(&host.tp, TC_DIR_FORWARD);
            host.status.feed_scale = host.status.rapid_scale = 1.0;
            host.functions.set_v_limit(&host.tp, 1e9);
            return;
          }
          if (random.integer(0, 79) != 0) return;
          --asks;
          switch (random.integer(0, 8)) {
            case 0:
              host.pause();
              break;
            case 1:
              host.resume();
              break;
            case 2:
              host.step();
              break;
            case 3:
              host.status.feed_scale = random.coin() ? random.uniform(0.0, 1.5) : 1.0;
              break;
            case 4:
              host.status.rapid_scale = random.uniform(0.0, 1.0);
              break;
            case 5:
              host.feed_hold = !host.feed_hold;
              break;
            case 6:
              host.adaptive_feed = random.uniform(-1.0, 1.0);
              break;
            case 7:
              host.functions.set_v_limit(&host.tp, random.log_uniform(1.0, 100.0));
              break;
            default:
              host.functions.set_run_dir(&host.tp, random.coin() ? TC_DIR_REVERSE : TC_DIR_FORWARD);
              break;
          }
        },
        300'000);
    INFO("CNCPLAN_SEED=" << first + static_cast<std::uint64_t>(k) << " CNCPLAN_TP_SEQUENCES=1");
    REQUIRE(printed().empty());
    REQUIRE(run.ended);
    REQUIRE(beyond_limits(run, options, 1e4) == "");
    REQUIRE(deviation(run, moves) <= tolerance * 1.0001);
    REQUIRE((run.samples.back().position - moves.back().end).cwiseAbs().maxCoeff() < 1e-9);
  }
}
