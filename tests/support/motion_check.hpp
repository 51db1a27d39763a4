// A motion executor driven by random requests, and every tick held against the limits of the blocks it ran
// on: by differencing what it reports, with nothing of the planner's.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "cncplan/detail/executor/motion_executor.hpp"
#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "support/random.hpp"

namespace cncplan::test {

struct MotionFaults {
  double jerk{};          ///< change of acceleration over a tick, over what the jerk limit allows, relative
  double acceleration{};  ///< above the limit, relative
  double speed{};         ///< above what the block bears, relative
  double junction{};      ///< mm/s above a junction's cap, beyond what a tick hides
  double travel{};  ///< mm between travelled distance and the integral of the speed, beyond a tick's rounding
  double sum_acceleration{};  ///< of the point in space, by its velocity at both ends of a tick, above the
                              ///< limit, relative
  double sum_jerk{};  ///< of the point in space, by its acceleration at both ends of a tick, above the limit
  double dwell{};     ///< s of a dwell that were not waited for, beyond two ticks
  double end{};       ///< mm from the end of the last block
  bool finished{};
  long ticks{};
  long requests{};
};

/// Cells to be played, and the block and the machine's limits that each stands for.
struct MotionProgram {
  struct Motion {
    Block<3>::Path path;
    double from{};  ///< mm from the block's start to the cell's
    Limits limits;
  };
  std::vector<detail::MotionBlock> blocks;
  std::vector<Motion> motions;
};

/// A line or an arc of about `length` mm from a point on; a third of the arcs are helices.
inline path::Segment<3> random_segment(Random& random, const Vector3& start, double length) {
  constexpr double pi = std::numbers::pi;
  const double heading = random.uniform(-pi, pi);
  const double rise = random.integer(0, 2) == 0 ? random.uniform(-0.5, 0.5) * length : 0.0;
  const Vector3 along(std::cos(heading), std::sin(heading), 0.0);
  if (random.coin()) return path::Line<3>(start, start + length * along + rise * Vector3::UnitZ());
  const double radius = random.log_uniform(0.1, 50.0);
  const double sweep = std::min(length / radius, 6.0) * (random.coin() ? 1.0 : -1.0);
  const Vector3 center = start - radius * along;
  const Vector3 end =
      center + Vector3(radius * std::cos(heading + sweep), radius * std::sin(heading + sweep), rise);
  const auto arc = path::arc_from_center(start, end, center,
                                         sweep < 0.0 ? Turn::clockwise : Turn::counterclockwise, Plane::xy);
  return arc ? path::Segment<3>(*arc) : path::Segment<3>(path::Line<3>(start, end));
}

/// Short and long lines, arcs and helices, slow and free junctions, some with lower limits.
inline MotionProgram random_motion_program(Random& random, int count) {
  MotionProgram program;
  const double longest = random.log_uniform(0.05, 10.0);
  const double deviation = random.coin() ? 0.01 : 1.0;
  const junction::Deviation policy{deviation};
  const detail::JunctionRules rules{policy, -1.0, -1.0};
  Vector3 at = Vector3::Zero();
  std::vector<Block<3>> pair;  // the block before, and the new one
  for (int i = 0; i < count; ++i) {
    Block<3> block{.path = random_segment(random, at, random.log_uniform(0.01, longest)), .line = i + 1};
    at = block.path.end();
    Machine<3> machine{.limits = {30.0, 1000.0, 10000.0}};
    if (random.integer(0, 5) == 0) {
      machine.limits.velocity = random.uniform(3.0, 30.0);
      machine.limits.acceleration *= random.uniform(0.4, 1.0);
      machine.limits.jerk *= random.uniform(0.3, 1.0);
    }
    if (random.integer(0, 7) == 0) block.pause = 0.01;
    if (pair.size() == 2) pair.erase(pair.begin());
    pair.push_back(block);  // both under the limits of the new one
    const auto cells = detail::make_cells(std::span<const Block<3>>(pair), machine, rules).value();
    const double slow = random.uniform(0.0, 30.0);
    const bool slowed = random.integer(0, 3) == 0;
    const double feed = random.uniform(5.0, 30.0);
    const bool rapid = random.integer(0, 6) == 0;
    double from = 0.0;
    for (std::size_t k = 0; k < cells.segment_limits.size(); ++k) {
      if (cells.blocks[k] + 1 != pair.size()) continue;
      detail::MotionBlock cell{
          .segment_limits = cells.segment_limits[k], .feed = feed, .rapid = rapid, .line = block.line};
      if (slowed && from == 0.0) cell.segment_limits.entry = std::min(cell.segment_limits.entry, slow);
      program.blocks.push_back(cell);
      program.motions.push_back({block.path, from, machine.limits});
      from += cells.segment_limits[k].length;
    }
  }
  return program;
}

/// Where the point of a motion is, and how its velocity changes, by its state along the path.
struct PointMotion {
  Vector3 position;
  Vector3 velocity;
  Vector3 acceleration;

  PointMotion(const MotionProgram::Motion& motion, const detail::MotionSetPoint& now) {
    const auto& path = motion.path;
    const double u = path.parameter_at(motion.from + now.along);
    const Vector3 first = path.derivative(u);
    const Vector3 second = path.second_derivative(u);
    const double speed_sq = first.squaredNorm();
    const Vector3 tangent = first / std::sqrt(speed_sq);
    const Vector3 curvature = (second - tangent * tangent.dot(second)) / speed_sq;
    position = path.position(u);
    velocity = now.velocity * tangent;
    acceleration = now.acceleration * tangent + now.velocity * now.velocity * curvature;
  }
};

/// Runs a program with a request about every `mean_gap` ticks for `restless` ticks, then undisturbed until
/// it is finished.
inline MotionFaults run(const MotionProgram& of, Random& random, int mean_gap, std::size_t window,
                        long restless) {
  const std::vector<detail::MotionBlock>& program = of.blocks;
  constexpr double period = 1e-3;
  constexpr long most_ticks = 1'000'000;
  std::vector<detail::MotionBlock> blocks(window + 24);
  std::vector<detail::SegmentLimits> ahead(window);
  std::vector<detail::ConstrainedJunction> junctions(window + 1), spare(window + 1);
  detail::MotionExecutor executor({blocks, ahead, junctions, spare}, 16);
  std::vector<double> start(program.size() + 1);
  for (std::size_t i = 0; i < program.size(); ++i) start[i + 1] = start[i] + program[i].segment_limits.length;

  MotionFaults faults;
  const auto grow = [](double& worst, double value) { worst = std::max(worst, value); };
  detail::MotionSetPoint before{0, 0.0, 0.0, 0.0, 0.0, true};
  double position = 0.0;
  long still = 0;  // ticks at the place where it is
  std::size_t fed = 0;
  for (; faults.ticks < most_ticks; ++faults.ticks) {
    const bool calm = faults.ticks >= restless;
    const bool starving = !calm && random.integer(0, 9) == 0;
    while (!starving && fed < program.size() && executor.push(program[fed])) ++fed;
    if (calm ? faults.ticks == restless : random.integer(0, mean_gap - 1) == 0) {
      ++faults.requests;
      switch (calm ? 100 : random.integer(0, 9)) {
        case 0:
          executor.hold();
          break;
        case 1:
          executor.backwards(true);
          break;
        case 2:
          executor.feed_override(0.0);
          break;
        case 3:
        case 4:
          executor.feed_override(random.uniform(0.0, 2.0));
          break;
        case 5:
          executor.rapid_override(random.uniform(0.1, 1.0));
          break;
        case 6:
          executor.backwards(false);
          break;
        default:
          executor.resume();
          executor.backwards(false);
          executor.feed_override(random.uniform(0.5, 2.0));
      }
    }
    const detail::MotionSetPoint now = executor.tick(period);
    if (fed == 0) continue;
    const auto low = static_cast<std::size_t>(std::min(before.block, now.block));
    const auto high = static_cast<std::size_t>(std::max(before.block, now.block));
    // it may have been in the block beside: where it turned round within the tick, or but for rounding
    const auto at_junction = [&](const detail::MotionSetPoint& at) {
      const double length = program[static_cast<std::size_t>(at.block)].segment_limits.length;
      return std::min(at.along, length - at.along) < 1e-9;
    };
    const bool turned = before.velocity * now.velocity < 0.0;
    const std::size_t beside = turned || at_junction(before) || at_junction(now) ? 1 : 0;
    Limits limits{0.0, 0.0, 0.0};
    for (std::size_t i = low - std::min(low, beside); i <= std::min(high + beside, program.size() - 1); ++i) {
      limits.velocity = std::max(limits.velocity, program[i].segment_limits.limits.velocity);
      limits.acceleration = std::max(limits.acceleration, program[i].segment_limits.limits.acceleration);
      limits.jerk = std::max(limits.jerk, program[i].segment_limits.limits.jerk);
    }
    {
      const double here = start[static_cast<std::size_t>(now.block)] + now.along;
      for (std::size_t i = low; i <= high; ++i) {
        const double pause = i > 0 ? program[i - 1].segment_limits.pause : 0.0;
        const bool passed = position < start[i] + 1e-9 && here > start[i] + 1e-9;
        const double waited =
            std::abs(position - start[i]) < 1e-9 ? static_cast<double>(still) * period : 0.0;
        if (passed && pause > 0.0) grow(faults.dwell, pause - waited - 2.0 * period);
      }
    }
    const double change = limits.jerk * period;
    const double slack = change * period;  // speed that may hide within a tick
    grow(faults.jerk, std::abs(now.acceleration - before.acceleration) / change - 1);
    grow(faults.acceleration, std::abs(now.acceleration) / limits.acceleration - 1);
    grow(faults.speed, std::abs(now.velocity) / limits.velocity - 1);
    for (std::size_t i = low + 1; i <= high; ++i)
      grow(faults.junction, std::min(std::abs(now.velocity), std::abs(before.velocity)) - slack -
                                program[i].segment_limits.entry);
    const double moved = start[static_cast<std::size_t>(now.block)] + now.along - position;
    grow(
        faults.travel,
        std::max(-now.along, now.along - program[static_cast<std::size_t>(now.block)].segment_limits.length));
    grow(faults.travel, std::abs(moved - period * (now.velocity + before.velocity) / 2) - slack * period / 4);
    still = std::abs(moved) < 1e-9 ? still + 1 : 0;
    position += moved;
    if (now.block == before.block && !turned) {
      // over a tick in one block a difference is a mean, and so within the limit too
      const auto& motion = of.motions[static_cast<std::size_t>(now.block)];
      const PointMotion from(motion, before), to(motion, now);
      grow(faults.sum_acceleration,
           (to.velocity - from.velocity).norm() / period / motion.limits.acceleration - 1);
      grow(faults.sum_jerk, (to.acceleration - from.acceleration).norm() / period / motion.limits.jerk - 1);
    }
    before = now;
    if (fed == program.size() && executor.finished()) {
      faults.finished = true;
      break;
    }
  }
  faults.end = std::abs(position - start.back());
  return faults;
}

}  // namespace cncplan::test
