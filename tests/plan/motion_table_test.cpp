#include "cncplan/detail/speed/motion_table.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cncplan/trajectory.hpp"
#include "plan/plan_oracle.hpp"
#include "plan/planned.hpp"
#include "plan/random_program.hpp"

using namespace cncplan;

namespace {

// Blocks of one cell each.
detail::BasicCells<double> cells_of(const std::vector<detail::SegmentLimits>& segments) {
  detail::BasicCells<double> cells;
  cells.segment_limits.assign(segments.begin(), segments.end());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    cells.blocks.push_back(i);
    if (segments[i].pause > 0.0) cells.pauses.push_back({i + 1, i, segments[i].pause});
  }
  return cells;
}

std::pmr::vector<BasicPiecePhase<double>> phases_of(const std::vector<detail::SegmentLimits>& segments) {
  const auto spans = test::spans_of(segments);
  return detail::block_phases(std::span<const detail::Span>(spans), cells_of(segments));
}

// State at t by walking all spans from the start.
State walk(const std::vector<detail::Span>& spans, double t) {
  double origin = 0.0;
  for (std::size_t i = 0;; ++i) {
    State state = spans[i].profile.at(t);
    state.position += origin;
    if (t < spans[i].profile.duration() || i + 1 == spans.size()) return state;
    t -= spans[i].profile.duration();
    origin += spans[i].profile.length();
  }
}

// The segments' blocks on a straight line.
Trajectory<Machine<1>, Block<1>> straight(const std::vector<detail::SegmentLimits>& segments) {
  using V = VectorN<double, 1>;
  std::pmr::vector<Block<1>> blocks;
  double from = 0.0;
  for (const detail::SegmentLimits& block : segments) {
    blocks.push_back({.path = path::Line<1>(V(from), V(from + block.length)), .pause = block.pause});
    from += block.length;
  }
  return {Machine<1>{}, std::move(blocks), phases_of(segments)};
}

}  // namespace

TEST_CASE("phases of blocks follow each other and are where a search from the start finds them") {
  test::Random random;
  double gap = 0.0, position = 0.0, velocity = 0.0, acceleration = 0.0, travel = 0.0;
  std::vector<detail::SegmentLimits> where;
  for (int draws = 0; draws < 200; ++draws) {
    const auto blocks = test::random_program(random, test::LimitSpread::wide, 60);
    const auto spans = test::spans_of(blocks);
    const auto phases = phases_of(blocks);
    REQUIRE(!phases.empty());
    std::vector<double> start(blocks.size() + 1);
    for (std::size_t i = 0; i < blocks.size(); ++i) start[i + 1] = start[i] + blocks[i].length;
    double end = 0.0;
    std::size_t block = 0;
    for (const auto& [phase, number] : phases) {
      gap = std::max(gap, std::abs(phase.time - end) / (1e-3 + end));
      end = phase.time + phase.duration;
      REQUIRE(number >= block);
      block = number;
      const State here = phase.at(phase.duration / 2);
      const State expected = walk(spans, phase.time + phase.duration / 2);
      const Limits& limits = blocks[number].limits;
      const double off = std::abs(here.velocity - expected.velocity) / limits.velocity;
      if (off > velocity) velocity = off, where = blocks;
      position = std::max(
          position, std::abs(start[number] + here.position - expected.position) / (1.0 + expected.position));
      // next to a change of jerk, rounding of the time decides on which side it is
      if (phase.duration > 1e-6)
        acceleration =
            std::max(acceleration, std::abs(here.acceleration - expected.acceleration) / limits.acceleration);
      travel = std::max({travel, -here.position, here.position - blocks[number].length});
    }
    CHECK(end == Approx(test::duration(spans)).epsilon(1e-12));
  }
  INFO(test::literal(where));
  CHECK(gap < 1e-12);
  CHECK(position < 1e-12);
  CHECK(velocity < 1e-9);
  CHECK(acceleration < 1e-6);
  CHECK(travel < 1e-11);
}

TEST_CASE("blocks of a trajectory follow each other in time, at their own speeds") {
  test::Random random;
  double gap = 0.0, junction = 0.0, peak = 0.0, top = 0.0, above = 0.0;
  std::vector<detail::SegmentLimits> where;
  for (int draws = 0; draws < 100; ++draws) {
    auto segments = test::random_program(random, test::LimitSpread::wide, 60);
    std::erase_if(segments, [](const auto& block) { return !(block.length > 0.0); });
    if (segments.empty()) continue;
    segments.front().entry = 0.0;
    for (std::size_t i = 1; i < segments.size(); ++i)
      if (segments[i - 1].pause > 0.0) segments[i].entry = 0.0;
    const auto trajectory = straight(segments);
    const auto motions = trajectory.blocks();
    REQUIRE(motions.size() == segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const BlockMotion& motion = motions[i];
      REQUIRE(motion.block == i);
      const double fastest = segments[i].limits.velocity;
      const double end = motion.start + motion.duration + segments[i].pause;
      if (i + 1 < segments.size()) {
        gap = std::max(gap, std::abs(motions[i + 1].start - end) / (1e-3 + end));
        junction = std::max(junction, std::abs(motions[i + 1].entry - motion.exit) / fastest);
      }
      peak = std::max(peak, motion.peak / fastest - 1.0);
      double highest = 0.0;
      for (int k = 0; k <= 40; ++k)
        highest = std::max(highest, trajectory.at(motion.start + motion.duration * k / 40.0).along.velocity);
      const double off = (highest - motion.peak) / fastest;
      if (off > top) top = off, where = segments;
      // between two samples a speed rises by no more than its bend allows
      const double step = motion.duration / 40.0;
      above =
          std::max(above, (motion.peak - highest - segments[i].limits.jerk * step * step / 8.0) / fastest);
    }
  }
  INFO(test::literal(where));
  CHECK(gap < 1e-12);
  CHECK(junction < 1e-9);
  CHECK(peak < 1e-9);
  CHECK(top < 1e-9);
  CHECK(above < 1e-9);
}

TEST_CASE("a block's peak lies within it") {
  // 10 mm in three: up, at 30 mm/s, down
  const Limits kk22{30.0, 1000.0, 10000.0};
  const auto motions = straight({{1.0, 0.0, kk22}, {8.0, 30.0, kk22}, {1.0, 30.0, kk22}}).blocks();
  REQUIRE(motions.size() == 3);
  CHECK(motions[0].peak == motions[0].exit);
  CHECK(motions[0].peak < 30.0);
  CHECK(motions[1].peak == Approx(30.0).epsilon(1e-14));
  CHECK(motions[2].peak == motions[2].entry);
  CHECK(motions[2].exit == Approx(0.0).margin(1e-12));
}
