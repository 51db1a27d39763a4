#include "cncplan/plan/cursor.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "cncplan/plan/timing.hpp"
#include "plan/plan_oracle.hpp"
#include "plan/planned.hpp"
#include "plan/random_program.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;

namespace {

std::vector<double> lengths_of(const std::vector<plan::BlockCaps>& blocks) {
  std::vector<double> lengths;
  for (const auto& block : blocks) lengths.push_back(block.length);
  return lengths;
}

// State at t by walking all spans from the start.
State brute(const std::vector<plan::Span>& spans, double t) {
  double origin = 0.0;
  for (std::size_t i = 0;; ++i) {
    State state = spans[i].profile.at(t);
    state.position += origin;
    if (t < spans[i].profile.duration() || i + 1 == spans.size()) return state;
    t -= spans[i].profile.duration();
    origin += spans[i].profile.length();
  }
}

}  // namespace

TEST_CASE("a cursor is where a search from the start finds it, whatever its strides") {
  test::Random random;
  double position = 0.0, velocity = 0.0, along = 0.0, early = 0.0;
  for (int draws = 0; draws < 200; ++draws) {
    const auto blocks = test::random_program(random, test::LimitSpread::wide, 60);
    const auto spans = test::spans_of(blocks);
    const auto lengths = lengths_of(blocks);
    std::vector<plan::BlockTiming> timings;
    plan::block_timings(std::span<const plan::Span>(spans), std::span<const double>(lengths),
                        std::back_inserter(timings));
    const double total = test::duration(spans);
    plan::Cursor cursor(spans, lengths);
    const double stride = random.log_uniform(1e-4, 1.5);
    for (double t = 0.0; t < total * 1.1; t += total * stride * random.uniform(0, 1)) {
      const plan::Place place = cursor.at(t);
      const State expected = brute(spans, t);
      const double rounding = 1e-12 * (1.0 + expected.position);
      position = std::max(position, std::abs(place.state.position - expected.position) / rounding);
      const Limits& limits = blocks[place.block].limits;
      velocity = std::max(velocity, std::abs(place.state.velocity - expected.velocity) / limits.velocity);
      double start = 0.0;
      for (std::size_t i = 0; i < place.block; ++i) start += lengths[i];
      along = std::max(along, std::abs(start + place.along - place.state.position) / rounding);
      const plan::BlockTiming& block = timings[place.block];
      const double end = block.start + block.duration + blocks[place.block].pause;
      if (t < total) early = std::max({early, block.start - t, t - end});
      REQUIRE(place.along <= lengths[place.block]);
    }
  }
  CHECK(position < 1.0);
  CHECK(velocity < 1e-9);
  CHECK(along < 1.0);
  CHECK(early < 1e-6);  // where blocks meet near rest, rounding of the place is that much time
}

TEST_CASE("during a pause the cursor rests at the end of the block before") {
  const Limits kk22{30.0, 1000.0, 10000.0};
  const std::vector<plan::BlockCaps> blocks{
      {0.0, 0.0, kk22, 0.5}, {10.0, 0.0, kk22, 0.25}, {10.0, 0.0, kk22, 0.0}};
  const auto spans = test::spans_of(blocks);
  const auto lengths = lengths_of(blocks);
  const double ride = profile::seven_phase(10.0, {0.0, 0.0}, kk22)->duration();
  plan::Cursor cursor(spans, lengths);
  CHECK(cursor.at(0.3) == plan::Place{0, 0.0, {0.0, 0.0, 0.0, 0.0}});
  CHECK(cursor.at(0.5 + ride + 0.1) == plan::Place{1, 10.0, {10.0, 0.0, 0.0, 0.0}});
  CHECK(cursor.at(0.75 + ride).block == 2);
  CHECK(cursor.at(100.0) == plan::Place{2, 10.0, {20.0, 0.0, 0.0, 0.0}});
}

TEST_CASE("a cursor over nothing stands at the origin") {
  plan::Cursor cursor({}, {});
  CHECK(cursor.at(1.0) == plan::Place{});
}

TEST_CASE("a cursor needs no heap") {
  test::Random random;
  const auto blocks = test::random_program(random, test::LimitSpread::none);
  const auto spans = test::spans_of(blocks);
  const auto lengths = lengths_of(blocks);
  const double total = test::duration(spans);
  CHECK(test::heap_allocations_of([&] {
          plan::Cursor cursor(spans, lengths);
          for (int k = 0; k <= 1000; ++k) (void)cursor.at(total * k / 1000.0);
        }) == 0);
}
