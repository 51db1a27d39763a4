#include "cncplan/detail/executor/path_ahead.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "cncplan/detail/executor/brake_ahead.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr Limits limits{30.0, 1000.0, 10000.0};

// Blocks of 1, 2, 3 ... mm on lines 1, 2, 3 ..., entered at 10, 11, 12 ... mm/s.
struct Blocks {
  explicit Blocks(int count) : memory(16), path(memory) {
    for (int i = 0; i < count; ++i)
      path.ring.push({{1.0 + i, 10.0 + i, limits, 0.0}, 20.0, i == 2, i == 3, i + 1});
    path.ring.take();
  }
  std::vector<detail::MotionBlock> memory;
  detail::BasicPathAhead<double> path;
};

}  // namespace

TEST_CASE("overrides act on feed or rapid rate, up to what a block bears") {
  Blocks given(4);
  auto& asked = given.path.asked;
  asked.feed_share = 1.2;
  asked.rapid_share = 0.5;
  CHECK(given.path.requested_speed(0) == 24.0);
  CHECK(given.path.requested_speed(2) == 10.0);
  asked.feed_share = 2.0;
  CHECK(given.path.requested_speed(0) == 30.0);
  CHECK_FALSE(given.path.must_rest(0));
  asked.feed_share = 0.0;
  CHECK(given.path.must_rest(0));
  CHECK_FALSE(given.path.must_rest(2));
  asked.held = true;
  CHECK(given.path.must_rest(2));
}

TEST_CASE("places go on across junctions, in both directions") {
  Blocks given(4);
  auto& path = given.path;
  using Place = detail::BasicPlace<double>;
  CHECK(path.advance(Place{0, 0.5}, 0.25) == Place{0, 0.75});
  CHECK(path.advance(Place{0, 0.5}, 0.5) == Place{1, 0.0});
  CHECK(path.advance(Place{0, 0.5}, 3.0) == Place{2, 0.5});
  CHECK(path.advance(Place{3, 3.0}, 5.0) == Place{3, 8.0});         // behind the end
  CHECK(path.advance(Place{0, 0.5}, 0.5, 1e-10) == Place{0, 1.0});  // the end of a profile is in block 0
  CHECK(path.advance(Place{0, 0.5}, 0.5, 1.0) == Place{1, 0.0});
  CHECK(path.advance(Place{0, 0.5}, 2.5, 0.0) == Place{1, 2.0});
  CHECK(path.snapped(Place{1, 2.0 - 1e-12}) == Place{2, 0.0});
  CHECK(path.snapped(Place{1, 1e-12}) == Place{1, 0.0});
  CHECK(path.snapped(Place{1, 1.0}) == Place{1, 1.0});
  CHECK(path.junction_cap(2) == 12.0);
  path.asked.direction = -1;
  CHECK(path.turn_round(Place{1, 0.5}) == Place{1, 1.5});
  CHECK(path.advance(Place{1, 1.5}, 1.0) == Place{0, 0.5});
  CHECK(path.junction_cap(1) == 12.0);  // it enters block 1 from block 2
  path.asked.direction = 1;
  CHECK(path.turn_round(Place{-1, 0.0}) == Place{0, 0.0});  // it had run back behind the first
}

TEST_CASE("a look-ahead ends at stops, at blocks that are held, and where it matters no more") {
  Blocks given(8);
  auto& path = given.path;
  std::vector<detail::SegmentLimits> out(8);
  const auto blocks = [&](double speed) { return path.ahead({0, 0.5}, speed, out).blocks; };
  CHECK(blocks(5.0) == 3);  // to 20 mm/s and back takes 1.8 mm, and half as much again: 0.5 + 2 < 2.8
  CHECK_FALSE(path.ahead({0, 0.5}, 5.0, out).whole);
  CHECK(out[0].length == 0.5);
  CHECK(out[0].entry == 5.0);
  CHECK(out[1].entry == 11.0);
  CHECK(path.ahead({7, 0.0}, 5.0, out).whole);
  path.asked.pause_line = 2;
  CHECK(blocks(5.0) == 1);
  CHECK(path.ahead({0, 0.5}, 5.0, out).whole);
  path.passed_pause = 1;
  CHECK(blocks(5.0) == 3);
  path.asked.single_step = true;
  CHECK(blocks(5.0) == 1);
  path.asked = {};
  path.asked.rapid_share = 0.0;
  CHECK(path.ahead({1, 1.9}, 5.0, out).blocks == 1);
  CHECK(path.ahead({1, 1.9}, 5.0, out).whole);
  path.asked = {.optional_stops = true};
  CHECK(path.ahead({3, 0.0}, 0.0, out).blocks == 1);
  CHECK(path.ahead({0, 0.0}, 0.0, std::span(out).first(2)).blocks == 2);
}

TEST_CASE("zones join blocks of equal limits") {
  std::vector<detail::MotionBlock> memory(8);
  detail::BasicPathAhead<double> path(memory);
  const Limits low{10.0, 500.0, 5000.0};
  for (const Limits& of_block : {limits, limits, low, low, limits})
    path.ring.push({{0.1, 30.0, of_block, 0.0}, 30.0});
  path.ring.take();
  std::vector<detail::SegmentLimits> out(8);
  REQUIRE(path.zones({0, 0.05}, 30.0, out) == 3);
  CHECK(out[0].length == Approx(0.15));
  CHECK(out[1].length == Approx(0.2));
  CHECK(out[1].limits.jerk == 5000.0);
}

TEST_CASE("where there is no room for all zones the last is as weak as all the rest") {
  std::vector<detail::MotionBlock> memory(8);
  detail::BasicPathAhead<double> path(memory);
  for (const double share : {1.0, 0.9, 0.5, 0.8})
    path.ring.push({{0.1, 30.0, {30.0, 1000.0 * share, 10000.0 / share}, 0.0}, 30.0});
  path.ring.take();
  std::vector<detail::SegmentLimits> out(2);
  REQUIRE(path.zones({0, 0.0}, 30.0, out) == 2);
  CHECK(out[0].limits.acceleration == 1000.0);
  CHECK(out[1].limits.acceleration == 500.0);
  CHECK(out[1].limits.jerk == 10000.0 / 0.9);
}

TEST_CASE("in float a place is a junction but for rounding too") {
  std::vector<detail::BasicMotionBlock<float>> memory(8);
  detail::BasicPathAhead<float> path(memory);
  for (int i = 0; i < 8; ++i) path.ring.push({{12.7F, 30.0F, {30.0F, 1e3F, 1e4F}, 0.0F}, 30.0F});
  path.ring.take();
  using Place = detail::BasicPlace<float>;
  for (int blocks = 1; blocks < 8; ++blocks) {
    CAPTURE(blocks);
    CHECK(path.snapped(path.advance(Place{0, 0.0F}, 12.7F * static_cast<float>(blocks))) ==
          Place{blocks, 0.0F});
  }
}

TEST_CASE("a block as short as rounding is passed by from its farther half only, one of no length always") {
  std::vector<detail::BasicMotionBlock<float>> memory(4);
  detail::BasicPathAhead<float> path(memory);
  constexpr float length = 3e-5F;
  for (const float own : {1.0F, length, 0.0F, 1.0F})
    path.ring.push({{own, 30.0F, {30.0F, 1e3F, 1e4F}, 0.0F}, 30.0F});
  path.ring.take();
  using Place = detail::BasicPlace<float>;
  CHECK(path.snapped({0, 1.0F}) == Place{1, 0.0F});
  CHECK(path.snapped({1, 0.0F}) == Place{1, 0.0F});
  CHECK(path.snapped({1, 0.4F * length}) == Place{1, 0.0F});
  CHECK(path.snapped({1, 0.6F * length}) == Place{2, 0.0F});
  CHECK(path.snapped({2, 0.0F}) == Place{3, 0.0F});
}

// The oracle: from v to rest, jerk alone binding, the way is v sqrt(v / j).
TEST_CASE("a brake that would rest behind the last block is none, in both directions") {
  Blocks given(3);
  auto& path = given.path;
  std::array<detail::SegmentLimits, 8> zones{};
  constexpr double v = 10.0;
  const double way = v * std::sqrt(v / limits.jerk);
  const State now{0, v, 0, 0};
  for (const int direction : {1, -1}) {
    path.direction = path.asked.direction = direction;
    const std::int64_t last = direction > 0 ? 2 : 0;
    const double end = path.ring.length(last);
    CAPTURE(direction);
    CHECK(detail::brake_ahead<double>(path, {last, end - way - 1e-6}, now, zones));
    CHECK(detail::brake_ahead<double>(path, {last, end - way}, now, zones));
    CHECK_FALSE(detail::brake_ahead<double>(path, {last, end - way + 1e-6}, now, zones));
    CHECK_FALSE(detail::brake_ahead<double>(path, {last, end - way / 2}, now, zones));
  }
}
