#include "cncplan/plan/timing.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "plan/plan_oracle.hpp"
#include "plan/planned.hpp"
#include "plan/random_program.hpp"

using namespace cncplan;

TEST_CASE("blocks follow each other in time and meet their spans' profiles") {
  test::Random random;
  double gap = 0.0, travel = 0.0, junction = 0.0, total = 0.0, peak = 0.0, top = 0.0, above = 0.0;
  std::vector<plan::BlockCaps> where;
  for (int draws = 0; draws < 500; ++draws) {
    const auto blocks = test::random_program(random, test::LimitSpread::wide, 100);
    const auto spans = test::spans_of(blocks);
    std::vector<double> lengths;
    for (const auto& block : blocks) lengths.push_back(block.length);
    std::vector<plan::BlockTiming> timings;
    plan::block_timings(std::span<const plan::Span>(spans), std::span<const double>(lengths),
                        std::back_inserter(timings));
    REQUIRE(timings.size() == blocks.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const plan::BlockTiming& t = timings[i];
      const double fastest = blocks[i].limits.velocity;
      sum += t.duration + blocks[i].pause;
      const double end = t.start + t.duration + blocks[i].pause;
      if (i + 1 < blocks.size()) gap = std::max(gap, std::abs(timings[i + 1].start - end) / (1e-3 + end));
      if (i + 1 < blocks.size())
        junction = std::max(junction, std::abs(timings[i + 1].entry.velocity - t.exit.velocity) / fastest);
      travel = std::max(travel,
                        std::abs(t.exit.position - t.entry.position - lengths[i]) / (1.0 + t.exit.position));
      peak = std::max(peak, t.peak_velocity / fastest - 1.0);
    }
    const double duration = test::duration(spans);
    total = std::max(total, std::abs(sum / duration - 1.0));
    // the highest speed within each block, by dense samples of the profile
    for (const auto& span : spans) {
      double start = 0.0;
      for (std::size_t i = span.first; i < span.first + span.count; ++i) {
        double highest = 0.0;
        for (int k = 0; k <= 40; ++k)
          highest = std::max(highest, span.profile.at(start + timings[i].duration * k / 40.0).velocity);
        start += timings[i].duration;
        const double fastest = blocks[i].limits.velocity;
        const double off = (highest - timings[i].peak_velocity) / fastest;
        if (off > top) top = off, where = blocks;
        // between two samples a speed rises by no more than its bend allows
        const double step = timings[i].duration / 40.0;
        const double hidden = blocks[i].limits.jerk * step * step / 8.0;
        above = std::max(above, (timings[i].peak_velocity - highest - hidden) / fastest);
      }
    }
  }
  INFO(test::literal(where));
  CHECK(gap < 1e-12);
  CHECK(travel < 1e-12);
  CHECK(junction < 1e-12);
  CHECK(total < 1e-12);
  CHECK(peak < 1e-9);
  CHECK(top < 1e-9);
  CHECK(above < 1e-9);
}

TEST_CASE("a block's peak lies within it") {
  // 10 mm in three: up, at 30 mm/s, down
  const Limits kk22{30.0, 1000.0, 10000.0};
  const std::vector<plan::BlockCaps> blocks{{1.0, 0.0, kk22}, {8.0, 30.0, kk22}, {1.0, 30.0, kk22}};
  const auto spans = test::spans_of(blocks);
  const std::vector<double> lengths{1.0, 8.0, 1.0};
  std::vector<plan::BlockTiming> timings;
  plan::block_timings(std::span<const plan::Span>(spans), std::span<const double>(lengths),
                      std::back_inserter(timings));
  CHECK(timings[0].peak_velocity == timings[0].exit.velocity);
  CHECK(timings[0].peak_velocity < 30.0);
  CHECK(timings[1].peak_velocity == Approx(30.0).epsilon(1e-14));
  CHECK(timings[2].peak_velocity == timings[2].entry.velocity);
  CHECK(timings[2].exit.velocity == 0.0);
}
