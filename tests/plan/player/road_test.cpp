#include "cncplan/plan/player/road.hpp"

#include <vector>

#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr Limits limits{30.0, 1000.0, 10000.0};

// Blocks of 1, 2, 3 ... mm on lines 1, 2, 3 ..., entered at 10, 11, 12 ... mm/s.
struct Street {
  explicit Street(int count) : memory(16), road(memory) {
    for (int i = 0; i < count; ++i)
      road.ring.push({{1.0 + i, 10.0 + i, limits, 0.0}, 20.0, i == 2, i == 3, i + 1});
    road.ring.take();
  }
  std::vector<plan::PlayedBlock> memory;
  plan::BasicRoad<double> road;
};

}  // namespace

TEST_CASE("overrides act on feed or rapid rate, up to what a block bears") {
  Street street(4);
  auto& asked = street.road.asked;
  asked.feed_share = 1.2;
  asked.rapid_share = 0.5;
  CHECK(street.road.wanted_speed(0) == 24.0);
  CHECK(street.road.wanted_speed(2) == 10.0);
  asked.feed_share = 2.0;
  CHECK(street.road.wanted_speed(0) == 30.0);
  CHECK_FALSE(street.road.must_rest(0));
  asked.feed_share = 0.0;
  CHECK(street.road.must_rest(0));
  CHECK_FALSE(street.road.must_rest(2));
  asked.held = true;
  CHECK(street.road.must_rest(2));
}

TEST_CASE("spots go on across junctions, in both directions") {
  Street street(4);
  auto& road = street.road;
  using Spot = plan::BasicSpot<double>;
  CHECK(road.advance(Spot{0, 0.5}, 0.25) == Spot{0, 0.75});
  CHECK(road.advance(Spot{0, 0.5}, 0.5) == Spot{1, 0.0});
  CHECK(road.advance(Spot{0, 0.5}, 3.0) == Spot{2, 0.5});
  CHECK(road.advance(Spot{3, 3.0}, 5.0) == Spot{3, 8.0});  // behind the end
  CHECK(road.snapped(Spot{1, 2.0 - 1e-12}) == Spot{2, 0.0});
  CHECK(road.snapped(Spot{1, 1e-12}) == Spot{1, 0.0});
  CHECK(road.snapped(Spot{1, 1.0}) == Spot{1, 1.0});
  CHECK(road.junction_cap(2) == 12.0);
  road.asked.direction = -1;
  CHECK(road.turn_round(Spot{1, 0.5}) == Spot{1, 1.5});
  CHECK(road.advance(Spot{1, 1.5}, 1.0) == Spot{0, 0.5});
  CHECK(road.junction_cap(1) == 12.0);  // it enters block 1 from block 2
  road.asked.direction = 1;
  CHECK(road.turn_round(Spot{-1, 0.0}) == Spot{0, 0.0});  // it had run back behind the first
}

TEST_CASE("a look-ahead ends at stops, at blocks that are held, and where it matters no more") {
  Street street(8);
  auto& road = street.road;
  std::vector<plan::BlockCaps> out(8);
  const auto blocks = [&](double speed) { return road.ahead({0, 0.5}, speed, out).blocks; };
  CHECK(blocks(5.0) == 3);  // to 20 mm/s and back takes 1.8 mm, and half as much again: 0.5 + 2 < 2.8
  CHECK_FALSE(road.ahead({0, 0.5}, 5.0, out).whole);
  CHECK(out[0].length == 0.5);
  CHECK(out[0].entry == 5.0);
  CHECK(out[1].entry == 11.0);
  CHECK(road.ahead({7, 0.0}, 5.0, out).whole);
  road.asked.pause_line = 2;
  CHECK(blocks(5.0) == 1);
  CHECK(road.ahead({0, 0.5}, 5.0, out).whole);
  road.passed_pause = 1;
  CHECK(blocks(5.0) == 3);
  road.asked.single_step = true;
  CHECK(blocks(5.0) == 1);
  road.asked = {};
  road.asked.rapid_share = 0.0;
  CHECK(road.ahead({1, 1.9}, 5.0, out).blocks == 1);
  CHECK(road.ahead({1, 1.9}, 5.0, out).whole);
  road.asked = {.optional_stops = true};
  CHECK(road.ahead({3, 0.0}, 0.0, out).blocks == 1);
  CHECK(road.ahead({0, 0.0}, 0.0, std::span(out).first(2)).blocks == 2);
}

TEST_CASE("zones join blocks of equal limits") {
  std::vector<plan::PlayedBlock> memory(8);
  plan::BasicRoad<double> road(memory);
  const Limits low{10.0, 500.0, 5000.0};
  for (const Limits& of_block : {limits, limits, low, low, limits})
    road.ring.push({{0.1, 30.0, of_block, 0.0}, 30.0});
  road.ring.take();
  std::vector<plan::BlockCaps> out(8);
  REQUIRE(road.zones({0, 0.05}, 30.0, out) == 3);
  CHECK(out[0].length == Approx(0.15));
  CHECK(out[1].length == Approx(0.2));
  CHECK(out[1].limits.jerk == 5000.0);
  CHECK(road.strongest({0, 0.05}, 30.0) == Limits{0.0, 1000.0, 10000.0});
  CHECK(road.strongest({2, 0.05}, 1.0) == Limits{0.0, 500.0, 5000.0});  // it rests before the last
}

TEST_CASE("where there is no room for all zones the last is as weak as all the rest") {
  std::vector<plan::PlayedBlock> memory(8);
  plan::BasicRoad<double> road(memory);
  for (const double share : {1.0, 0.9, 0.5, 0.8})
    road.ring.push({{0.1, 30.0, {30.0, 1000.0 * share, 10000.0 / share}, 0.0}, 30.0});
  road.ring.take();
  std::vector<plan::BlockCaps> out(2);
  REQUIRE(road.zones({0, 0.0}, 30.0, out) == 2);
  CHECK(out[0].limits.acceleration == 1000.0);
  CHECK(out[1].limits.acceleration == 500.0);
  CHECK(out[1].limits.jerk == 10000.0 / 0.9);
}

TEST_CASE("in float a spot is a junction but for rounding too") {
  std::vector<plan::BasicPlayedBlock<float>> memory(8);
  plan::BasicRoad<float> road(memory);
  for (int i = 0; i < 8; ++i) road.ring.push({{12.7F, 30.0F, {30.0F, 1e3F, 1e4F}, 0.0F}, 30.0F});
  road.ring.take();
  using Spot = plan::BasicSpot<float>;
  for (int blocks = 1; blocks < 8; ++blocks) {
    CAPTURE(blocks);
    CHECK(road.snapped(road.advance(Spot{0, 0.0F}, 12.7F * static_cast<float>(blocks))) ==
          Spot{blocks, 0.0F});
  }
}
