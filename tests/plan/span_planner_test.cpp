#include "cncplan/detail/speed/span_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "plan/plan_oracle.hpp"
#include "plan/planned.hpp"
#include "plan/random_program.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;
using test::LimitSpread;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Limits kk22{30.0, 1000.0, 10000.0};

std::vector<detail::SegmentLimits> draw(test::Random& random) {
  constexpr LimitSpread spreads[] = {LimitSpread::none, LimitSpread::slight, LimitSpread::wide};
  return test::random_program(random, spreads[random.integer(0, 2)]);
}

// Where the motion is, at times that do not decrease; in a pause, at the end of the block before.
struct Place {
  std::size_t block{};
  State state;  // position from the start
};
class Walk {
 public:
  Walk(const std::vector<detail::SegmentLimits>& blocks, const std::vector<detail::Span>& spans)
      : blocks_(blocks), spans_(spans) {}

  Place at(double time) {
    while (span_ + 1 < spans_.size() && time - start_ >= spans_[span_].profile.duration()) {
      start_ += spans_[span_].profile.duration();
      origin_ += spans_[span_++].profile.length();
    }
    State state = spans_[span_].profile.at(time - start_);
    state.position += origin_;
    while (block_ + 1 < blocks_.size() && state.position >= end_ + blocks_[block_].length)
      end_ += blocks_[block_++].length;
    return {block_, state};
  }

 private:
  const std::vector<detail::SegmentLimits>& blocks_;
  const std::vector<detail::Span>& spans_;
  std::size_t span_ = 0, block_ = 0;
  double start_ = 0.0, origin_ = 0.0, end_ = 0.0;
};

}  // namespace

TEST_CASE("a length has room for a ramp where it is above the room that one takes") {
  test::Random random;
  for (int i = 0; i < 10000; ++i) {
    const Limits limits{random.log_uniform(1e-3, 1e4), random.log_uniform(1, 1e6),
                        random.log_uniform(1, 1e9)};
    const double room = detail::room_for_ramp(limits);
    REQUIRE(detail::has_room_for_ramp(limits, room * (1 + 1e-12)));
    REQUIRE(!detail::has_room_for_ramp(limits, room * (1 - 1e-12)));
  }
  CHECK(detail::has_room_for_ramp(Limits{30, infinity, infinity}, 1e-9));
  CHECK(!detail::has_room_for_ramp(Limits{30, infinity, infinity}, 0.0));
}

TEST_CASE("random programs break no cap, no feed and no limit, and join without a jump") {
  test::Random random;
  test::PlanErrors worst;
  double worst_one = 0.0;
  std::vector<detail::SegmentLimits> where;
  for (int draws = 0; draws < 4000; ++draws) {
    const auto blocks = draw(random);
    for (const bool seven : {true, false}) {
      const auto spans = seven ? test::spans_of(blocks) : test::spans_of(blocks, profile::FivePhase{});
      const auto errors = test::examine_plan<double>(blocks, spans);
      if (errors.worst() > worst_one) worst_one = errors.worst(), where = blocks;
      worst.worst_of(errors);
    }
  }
  INFO("worst: " << test::literal(where));
  CHECK(worst.cap < 1e-11);
  CHECK(worst.velocity < 1e-12);
  CHECK(worst.acceleration < 1e-12);
  CHECK(worst.jerk < 1e-12);
  CHECK(worst.length < 1e-12);
  CHECK(worst.speed_jump < 1e-10);
  CHECK(worst.rest == 0.0);
  CHECK(worst.backward < 1e-12);
  CHECK(worst.misplaced == 0);
}

TEST_CASE("spans are never slower than block by block under the same caps") {
  test::Random random;
  double worst = 0.0, saved = 0.0;
  std::vector<detail::SegmentLimits> where;
  for (int draws = 0; draws < 8000; ++draws) {
    const auto blocks = test::random_program(random, LimitSpread::none);
    const double across = test::duration(test::spans_of(blocks));
    const double single = test::duration(test::single_blocks_of(blocks));
    saved = std::max(saved, 1.0 - across / single);
    if (across / single - 1.0 > worst) worst = across / single - 1.0, where = blocks;
  }
  INFO(where.size() << " blocks: " << test::literal(where));
  CHECK(worst < 1e-12);
  CHECK(saved > 0.5);
}

TEST_CASE("samples of a plan differ by what the limits allow") {
  test::Random random;
  double speed = 0.0, acceleration = 0.0, jerk = 0.0, backward = 0.0;
  for (int draws = 0; draws < 100; ++draws) {
    const auto blocks = draw(random);
    const auto spans = test::spans_of(blocks);
    const double total = test::duration(spans);
    constexpr int samples = 5000;
    const double h = total / samples;
    Walk walk(blocks, spans);
    Place before = walk.at(0.0);
    for (int k = 1; k <= samples; ++k) {
      const Place here = walk.at(h * k);
      Limits most = blocks[before.block].limits;
      for (std::size_t i = before.block; i <= here.block; ++i) {
        most.velocity = std::max(most.velocity, blocks[i].limits.velocity);
        most.acceleration = std::max(most.acceleration, blocks[i].limits.acceleration);
        most.jerk = std::max(most.jerk, blocks[i].limits.jerk);
      }
      const double clock = 1.0 + 1e-15 * total / h * 8.0;
      const double travel = here.state.position - before.state.position;
      backward = std::max(backward, -travel);
      speed = std::max(speed, travel / (h * most.velocity * clock) - 1.0);
      acceleration = std::max(
          acceleration,
          std::abs(here.state.velocity - before.state.velocity) / (h * most.acceleration * clock) - 1.0);
      jerk = std::max(
          jerk,
          std::abs(here.state.acceleration - before.state.acceleration) / (h * most.jerk * clock) - 1.0);
      before = here;
    }
  }
  CHECK(speed < 1e-9);
  CHECK(acceleration < 1e-9);
  CHECK(jerk < 1e-9);
  CHECK(backward < 1e-10);
}

TEST_CASE("a straight line in pieces is driven as one") {
  std::vector<detail::SegmentLimits> pieces(64, {100.0 / 64.0, infinity, kk22, 0.0});
  pieces.front().entry = 0.0;
  const auto spans = test::spans_of(pieces);
  REQUIRE(spans.size() == 1);
  CHECK(spans[0].profile == *profile::seven_phase(100.0, {0.0, 0.0}, kk22));
}

TEST_CASE("a cap that a ramp does not reach costs nothing") {
  // half a millimetre from rest the ramp is at 21.05 mm/s
  const std::vector<detail::SegmentLimits> free{{0.5, 0.0, kk22, 0.0}, {10.0, 21.1, kk22, 0.0}};
  CHECK(test::duration(test::spans_of(free)) ==
        Approx(profile::seven_phase(10.5, {0.0, 0.0}, kk22)->duration()).epsilon(1e-14));
  const std::vector<detail::SegmentLimits> capped{{5.0, 0.0, kk22, 0.0}, {5.0, 15.0, kk22, 0.0}};
  const auto spans = test::spans_of(capped);
  REQUIRE(spans.size() == 2);
  CHECK(spans[1].profile.start_velocity() == 15.0);
}

TEST_CASE("pauses stand between the spans they divide, and a dwell may come first") {
  const std::vector<detail::SegmentLimits> blocks{
      {0.0, 0.0, kk22, 0.5}, {10.0, 0.0, kk22, 0.25}, {10.0, 0.0, kk22, 0.0}, {0.0, infinity, kk22, 0.125}};
  const auto spans = test::spans_of(blocks);
  double pauses = 0.0;
  for (const auto& span : spans)
    if (span.count == 0) pauses += span.profile.duration();
  CHECK(pauses == 0.875);
  CHECK(test::examine_plan<double>(blocks, spans).worst() < 1e-12);
  CHECK(test::duration(spans) ==
        Approx(0.875 + 2.0 * profile::seven_phase(10.0, {0.0, 0.0}, kk22)->duration()).epsilon(1e-14));
}

TEST_CASE("no blocks, no spans") { CHECK(test::spans_of(std::vector<detail::SegmentLimits>{}).empty()); }

TEST_CASE("the same blocks give the same bits, without heap") {
  test::Random random;
  for (int draws = 0; draws < 20; ++draws) {
    const auto blocks = draw(random);
    std::vector<detail::ConstrainedJunction> junctions(blocks.size() + 1);
    std::vector<detail::Span> first(2 * blocks.size()), second(2 * blocks.size());
    const auto plan = [&](std::vector<detail::Span>& out) {
      (void)detail::plan_spans(std::span<const detail::SegmentLimits>(blocks), profile::SevenPhase{},
                               std::span(junctions), out.begin());
    };
    plan(first);
    CHECK(test::heap_allocations_of([&] { plan(second); }) == 0);
    CHECK(first == second);
  }
}

TEST_CASE("where blocks are alike but for rounding, that decides nothing") {
  // Chords of circles: the same few blocks again and again, and back.
  test::Random random;
  constexpr double last_bit = std::numeric_limits<double>::epsilon();
  double worst = 0.0;
  std::vector<detail::SegmentLimits> where;
  for (int draws = 0; draws < 2000; ++draws) {
    std::vector<detail::SegmentLimits> blocks;
    const int kinds = random.integer(1, 6), rings = random.integer(2, 12);
    for (int i = 0; i < kinds; ++i)
      blocks.push_back({random.log_uniform(0.05, 2),
                        random.coin() ? infinity : random.uniform(3, 30),
                        {random.uniform(3, 30), random.log_uniform(100, 1000), random.log_uniform(1e3, 1e4)},
                        0.0});
    if (random.coin())
      for (int i = kinds; i-- > 0;) blocks.push_back(blocks[static_cast<std::size_t>(i)]);
    const std::vector<detail::SegmentLimits> ring = blocks;
    for (int i = 1; i < rings; ++i) blocks.insert(blocks.end(), ring.begin(), ring.end());
    const double planned = test::duration(test::spans_of(blocks));
    std::vector<detail::SegmentLimits> other = blocks;
    const auto shake = [&](double& number) { number *= 1.0 + random.integer(-4, 4) * last_bit; };
    for (detail::SegmentLimits& block : other) {
      shake(block.length);
      shake(block.entry);
      shake(block.limits.velocity);
      shake(block.limits.acceleration);
      shake(block.limits.jerk);
    }
    const double change = std::abs(test::duration(test::spans_of(other)) / planned - 1.0);
    if (change > worst) worst = change, where = blocks;
  }
  INFO("seed " << test::seed() << ", worst: " << test::literal(where));
  CHECK(worst < 1e-9);
}

TEST_CASE("random programs in float keep their limits to float's digits") {
  test::Random random;
  test::PlanErrors worst;
  std::vector<detail::SegmentLimits> where;
  double worst_one = 0.0;
  for (int draws = 0; draws < 1000; ++draws) {
    const auto blocks = test::random_program(random, LimitSpread::wide, 60);
    std::vector<detail::BasicSegmentLimits<float>> narrow;
    for (const auto& b : blocks)
      narrow.push_back({static_cast<float>(b.length),
                        static_cast<float>(b.entry),
                        {static_cast<float>(b.limits.velocity), static_cast<float>(b.limits.acceleration),
                         static_cast<float>(b.limits.jerk)},
                        static_cast<float>(b.pause)});
    const auto errors = test::examine_plan<float>(narrow, test::spans_of(narrow));
    if (errors.worst() > worst_one) worst_one = errors.worst(), where = blocks;
    worst.worst_of(errors);
  }
  INFO("worst: " << test::literal(where));
  CHECK(worst.cap < 1e-4);
  CHECK(worst.length < 1e-5);
  CHECK(worst.speed_jump < 1e-5);
  CHECK(worst.backward < 1e-4);
  CHECK(worst.velocity < 1e-4);
  CHECK(worst.acceleration < 1e-4);
  CHECK(worst.jerk < 1e-4);
  CHECK(worst.rest == 0.0);
  CHECK(worst.misplaced == 0);
}
