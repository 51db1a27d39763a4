#include "cncplan/published/block_planning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "plan/plan_oracle.hpp"
#include "plan/planned.hpp"
#include "plan/random_program.hpp"
#include "support/profile_oracle.hpp"

using namespace cncplan;
using test::LimitSpread;

namespace {

std::vector<double> speeds_of(const std::vector<detail::SegmentLimits>& blocks) {
  std::vector<double> speeds(blocks.size() + 1);
  published::junction_speeds(std::span<const detail::SegmentLimits>(blocks), profile::SevenPhase{},
                             std::span(speeds));
  return speeds;
}

// The highest speed of a junction as its own cap and the feeds of its two blocks leave it.
double cap(const std::vector<detail::SegmentLimits>& blocks, std::size_t junction) {
  if (junction == 0 || junction == blocks.size()) return 0.0;
  return std::min(
      {blocks[junction].entry, blocks[junction - 1].limits.velocity, blocks[junction].limits.velocity});
}

// Time of a program with the given speeds at its junctions, infinite where they do not fit.
double time_of(const std::vector<detail::SegmentLimits>& blocks, const std::vector<double>& speeds) {
  double sum = 0.0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto profile =
        profile::seven_phase_solver(blocks[i].limits)(blocks[i].length, {speeds[i], speeds[i + 1]});
    if (!profile) return std::numeric_limits<double>::infinity();
    sum += profile->duration();
  }
  return sum;
}

}  // namespace

TEST_CASE("no grid of junction speeds takes less time") {
  test::Random random;
  double saved = 0.0;
  int feasible = 0;
  std::vector<detail::SegmentLimits> where;
  for (int draws = 0; draws < 150; ++draws) {
    auto blocks = test::random_program(random, LimitSpread::wide, 4);
    blocks.resize(4, blocks.back());
    for (auto& block : blocks) block.length = random.log_uniform(0.02, 2), block.pause = 0.0;
    const auto speeds = speeds_of(blocks);
    const double planned = time_of(blocks, speeds);
    constexpr int grid = 16;
    std::vector<double> v(5);
    for (int code = 0; code < grid * grid * grid; ++code) {
      for (std::size_t i = 1, rest = static_cast<std::size_t>(code); i < 4; ++i, rest /= grid)
        v[i] = std::min(cap(blocks, i), 2.5 * speeds[i]) * static_cast<double>(rest % grid + 1) / grid;
      const double time = time_of(blocks, v);
      feasible += std::isfinite(time);
      if (1.0 - time / planned > saved) saved = 1.0 - time / planned, where = blocks;
    }
  }
  INFO(test::literal(where));
  CHECK(saved < 1e-12);
  CHECK(feasible > 1000);
}

TEST_CASE("no junction can be faster while the others stay") {
  test::Random random;
  int raised = 0;
  for (int draws = 0; draws < 300; ++draws) {
    const auto blocks = test::random_program(random, LimitSpread::wide, 100);
    auto speeds = speeds_of(blocks);
    for (std::size_t i = 1; i < blocks.size(); ++i) {
      const double planned = speeds[i];
      speeds[i] = planned * (1.0 + 1e-9) + 1e-12;
      if (speeds[i] > cap(blocks, i)) speeds[i] = planned;
      const auto fits = [&](std::size_t k) {
        const double length = static_cast<double>(test::ramp_distance(
            speeds[k], speeds[k + 1], blocks[k].limits.acceleration, blocks[k].limits.jerk, true));
        return length <= blocks[k].length;
      };
      raised += speeds[i] > planned && fits(i - 1) && fits(i);
      speeds[i] = planned;
    }
  }
  CHECK(raised == 0);
}

TEST_CASE("plans block by block break nothing, under both laws") {
  test::Random random;
  test::PlanErrors worst;
  for (int draws = 0; draws < 2000; ++draws) {
    const auto blocks = test::random_program(random, LimitSpread::wide);
    const auto spans = draws % 2 == 0 ? test::single_blocks_of(blocks)
                                      : test::single_blocks_of(blocks, profile::FivePhase{});
    worst.worst_of(test::examine_plan<double>(blocks, spans));
    for (const auto& span : spans) REQUIRE(span.count <= 1);
  }
  CHECK(worst.worst() < 1e-10);
}

TEST_CASE("a chain of ramps up and down") {
  // 1 mm blocks without caps: from each junction the next is just within reach
  const Limits limits{1000.0, 1e6, 10000.0};
  std::vector<detail::SegmentLimits> blocks(6, {1.0, 1e9, limits, 0.0});
  blocks.front().entry = 0.0;
  const auto v = speeds_of(blocks);
  CHECK(v[1] == Approx(std::cbrt(10000.0)).epsilon(1e-12));  // v sqrt(v/J) = 1 mm
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK((v[i] + v[i + 1]) * std::sqrt((v[i + 1] - v[i]) / 10000.0) == Approx(1.0).epsilon(1e-12));
    CHECK(v[i] == Approx(v[6 - i]).epsilon(1e-12));
  }
}
