#include "deviation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "path_distance.hpp"

namespace simulate {

MotionPlaces::MotionPlaces(const ProgramText& program, const Plan& plan)
    : plan_(plan), starts_(program.motions.size(), 0.0) {
  for (std::size_t i = plan.motion_of.size(); i-- > 0;)
    starts_[plan.motion_of[i]] = plan.motion->block_start(i);
}

double largest_deviation(const ProgramText& program, const Plan& plan, const MotionPlaces& places) {
  constexpr int deepest = 12;     // times that a part of a phase is halved
  constexpr double close = 1e-4;  // share of the largest by which it may be missed
  struct Part {
    double from, to, first, middle, last;
    int depth;
  };
  const Planned& motion = *plan.motion;
  PathDistance distance(program);
  double largest = 0.0;
  for (const auto& [phase, piece] : motion.phases()) {
    const double length = motion.piece_length(piece);
    const double start = std::clamp(phase.position, 0.0, length);
    const double end = std::clamp(phase.at(phase.duration).position, 0.0, length);
    const std::size_t block = motion.block_of(piece);
    const Origin& origin = program.motions[plan.motion_of[block]];
    if (!(end > start) || motion.as_programmed(piece) || origin.driven_path() == nullptr) continue;
    const auto at = [&, piece = piece](double s) {
      const double along = motion.piece_start(piece) + s;
      const double gap = distance({&origin, motion.driven_point(piece, s), places.within(block, along)});
      largest = std::max(largest, gap);
      return gap;
    };
    std::array<Part, deepest + 2> open;
    const double half = (start + end) / 2, centre = at(half);
    open[0] = {start, half, at(start), at((start + half) / 2), centre, 0};
    open[1] = {half, end, centre, at((half + end) / 2), at(end), 0};
    for (std::size_t count = 2; count > 0;) {
      const auto [from, to, first, middle, last, depth] = open[--count];
      // The parabola through the three is higher than the highest of them by no more than this.
      const double bend = std::abs(first - 2 * middle + last) / 8;
      if (depth == deepest || !(std::max({first, middle, last}) + bend > largest * (1 + close))) continue;
      const double between = (from + to) / 2;
      const double left = at((from + between) / 2), right = at((between + to) / 2);
      open[count++] = {between, to, middle, right, last, depth + 1};
      open[count++] = {from, between, first, left, middle, depth + 1};
    }
  }
  return largest;
}

}  // namespace simulate
