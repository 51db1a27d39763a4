#include "cncplan/plan/motion_block.hpp"

#include <numbers>

#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr Limits limits{30.0, 1000.0, 10000.0};

gcode::Motion motion(gcode::MotionKind kind) {
  gcode::Motion m;
  m.kind = kind;
  m.start = {1.0, 2.0, 3.0};
  m.end = {1.0, 12.0, 3.0};
  m.offset = {100.0, 0.0, -5.0};
  return m;
}

double feed_of(const gcode::Motion& m, double rapid = 25.0) {
  return plan::block(m, limits, rapid)->limits.velocity;
}

}  // namespace

TEST_CASE("a line becomes a block in machine coordinates") {
  auto m = motion(gcode::MotionKind::line);
  m.feed = 12.0;
  const auto block = plan::block(m, limits, 25.0);
  REQUIRE(block);
  CHECK(block->segment.start() == Vector3(101, 2, -2));
  CHECK(block->segment.end() == Vector3(101, 12, -2));
  CHECK(block->limits == Limits{12.0, 1000.0, 10000.0});
  CHECK(block->kind == junction::Kind::line);
  CHECK_FALSE(block->stop_at_end);
  CHECK(block->pause == 0.0);
  m.exact_stop = true;
  CHECK(plan::block(m, limits, 25.0)->stop_at_end);
}

TEST_CASE("feeds: programmed, none so far, too fast, inverse time, rapid") {
  auto m = motion(gcode::MotionKind::line);
  CHECK(feed_of(m) == 30.0);
  m.feed = 8.0;
  CHECK(feed_of(m) == 8.0);
  m.feed = 80.0;
  CHECK(feed_of(m) == 30.0);
  m.feed_mode = gcode::FeedMode::inverse_time;
  m.feed = 0.5;  // 10 mm in 2 s
  CHECK(feed_of(m) == 5.0);
  m.kind = gcode::MotionKind::rapid;
  CHECK(feed_of(m) == 25.0);
  CHECK(feed_of(m, 1000.0) == 1000.0);  // the limit is that of feed moves
  CHECK(plan::block(m, limits, 25.0)->kind == junction::Kind::rapid);
}

TEST_CASE("limits, rapid rates and feeds that are not positive are refused") {
  auto m = motion(gcode::MotionKind::line);
  const auto field = [&](const Limits& l, double rapid) { return plan::block(m, l, rapid).error().field; };
  CHECK(field({0, 1000, 10000}, 25) == "velocity limit");
  CHECK(field({30, -1, 10000}, 25) == "acceleration limit");
  CHECK(field({30, 1000, std::nan("")}, 25) == "jerk limit");
  CHECK(field(limits, 0) == "rapid rate");
  CHECK(field(limits, std::nan("")) == "rapid rate");
  m.feed = 0.0;
  CHECK(field(limits, 25) == "velocity limit");
  m.end = m.start;
  CHECK(plan::block(m, limits, 25.0)->limits == limits);  // no way, no feed
}

TEST_CASE("an axis beyond the third has no place in space") {
  auto m = motion(gcode::MotionKind::line);
  m.end[3] = 0.5;
  const auto block = plan::block(m, limits, 25.0);
  REQUIRE(!block);
  CHECK(block.error().code == ErrorCode::not_supported);
  CHECK(block.error().value == 0.5);
}

TEST_CASE("both forms of an arc are moved by the offset, and feeds follow their length") {
  auto m = motion(gcode::MotionKind::arc_center);
  m.turn = Turn::counterclockwise;
  m.center = {1.0, 7.0, 3.0};
  m.feed_mode = gcode::FeedMode::inverse_time;
  m.feed = 1.0;
  const auto by_center = plan::block(m, limits, 25.0);
  m.kind = gcode::MotionKind::arc_radius;
  m.radius = 5.0;
  const auto by_radius = plan::block(m, limits, 25.0);
  for (const auto& block : {by_center, by_radius}) {
    REQUIRE(block);
    REQUIRE(block->segment.arc() != nullptr);
    CHECK(block->kind == junction::Kind::arc);
    CHECK((block->segment.arc()->center() - Vector3(101, 7, -2)).norm() < 1e-12);
    CHECK(block->segment.length() == Approx(5.0 * std::numbers::pi).epsilon(1e-12));
    CHECK(block->limits.velocity == Approx(5.0 * std::numbers::pi).epsilon(1e-12));
  }
  m.kind = gcode::MotionKind::arc_center;
  m.extra_turns = 2;
  CHECK(plan::block(m, limits, 25.0)->segment.length() == Approx(25.0 * std::numbers::pi).epsilon(1e-12));
}

TEST_CASE("an arc that is none comes back as its error") {
  auto m = motion(gcode::MotionKind::arc_radius);
  m.radius = 1.0;
  const auto block = plan::block(m, limits, 25.0);
  REQUIRE_FALSE(block);
  CHECK(block.error().code == ErrorCode::chord_exceeds_diameter);
}
