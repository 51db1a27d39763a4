// What the exact path asks of the axes, inside blocks and at their joints.
#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "run.hpp"

namespace simulate {

namespace {

using namespace cncplan;

// Magnitudes of the axes' velocities and accelerations.
using Demand = std::array<double, 6>;

// A stretch of one phase within one block, in seconds of the phase.
struct Piece {
  const path::Segment& segment;
  const Phase& phase;
  double origin;  // phase position at which the block starts
  double first;
  double last;

  [[nodiscard]] Demand demand(double tau) const {
    State along = phase.at(tau);
    along.position = std::clamp(along.position - origin, 0.0, segment.length());
    const auto sample = interpolate::evaluate(segment, along);
    Demand result{};
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = std::abs(sample.velocity[static_cast<int>(i)]);
      result[i + 3] = std::abs(sample.acceleration[static_cast<int>(i)]);
    }
    return result;
  }
};

void grow(Demand& peak, const Demand& demand) {
  for (std::size_t i = 0; i < peak.size(); ++i) peak[i] = std::max(peak[i], demand[i]);
}

// Looks at points no more than a twentieth of a radian apart, and goes to the top between three of them where
// the parabola through them says that it is higher than all so far. On a line the ends are the highest.
void grow(Demand& peak, const Piece& piece) {
  constexpr double most_angle = 0.05;
  constexpr int bits = 26;  // half of a double's: all that a maximum's place can have
  const path::Arc* const arc = piece.segment.arc();
  const double travelled = piece.phase.at(piece.last).position - piece.phase.at(piece.first).position;
  const double angle =
      arc == nullptr ? 0.0 : std::abs(arc->sweep()) * std::abs(travelled) / piece.segment.length();
  const double count = 1.0 + std::ceil(angle / most_angle);
  const double step = (piece.last - piece.first) / count;
  Demand before = piece.demand(piece.first);
  Demand here = before;
  grow(peak, before);
  for (double k = 1.0; k <= count; k += 1.0) {
    const Demand after = piece.demand(k < count ? piece.first + k * step : piece.last);
    grow(peak, after);
    for (std::size_t i = 0; i < peak.size() && k > 1.0; ++i) {
      const double bend = 2.0 * here[i] - before[i] - after[i];
      const double rise = after[i] - before[i];
      if (!(bend > 0.0 && std::abs(rise) <= bend && here[i] + rise * rise / (8.0 * bend) > peak[i])) continue;
      const auto lower = [&](double tau) { return -piece.demand(tau)[i]; };
      const double middle = piece.first + (k - 1.0) * step;
      const auto [place, value] =
          boost::math::tools::brent_find_minima(lower, middle - step, middle + step, bits);
      peak[i] = std::max(peak[i], -value);
    }
    before = here;
    here = after;
  }
}

// The part of a phase that drives a block, cut where the speed is highest within it.
void grow(Demand& peak, const path::Segment& segment, const Phase& phase, double origin, double first,
          double last) {
  const double top = phase.jerk == 0.0 ? last : std::clamp(-phase.acceleration / phase.jerk, first, last);
  for (const auto& [from, to] : {std::pair{first, top}, std::pair{top, last}})
    if (from < to) grow(peak, Piece{segment, phase, origin, from, to});
}

}  // namespace

void measure_axes(const Program& program, const Plan& plan, Measures& measures) {
  Demand peak{};
  double start = 0.0;
  for (const plan::Span& span : plan.spans) {
    const auto phases = span.profile.phases();
    double origin = 0.0;
    for (std::size_t i = span.first; i < span.first + span.count; ++i) {
      const double begin = plan.timings[i].start - start;
      const double end = begin + plan.timings[i].duration;
      for (const Phase& phase : phases) {
        const double first = std::max(begin - phase.time, 0.0);
        const double last = std::min(end - phase.time, phase.duration);
        if (first < last && plan.lengths[i] > 0.0)
          grow(peak, program.blocks[i].segment, phase, origin, first, last);
      }
      origin += plan.lengths[i];
    }
    start += span.profile.duration();
  }
  measures.axis_velocity = {peak[0], peak[1], peak[2]};
  measures.axis_acceleration = {peak[3], peak[4], peak[5]};
  for (std::size_t i = 1; i < program.blocks.size(); ++i) {
    const path::Segment& before = program.blocks[i - 1].segment;
    const path::Segment& after = program.blocks[i].segment;
    if (!(before.length() > 0.0 && after.length() > 0.0)) continue;
    const Vector3 jump = after.start_tangent() * plan.timings[i].entry.velocity -
                         before.end_tangent() * plan.timings[i - 1].exit.velocity;
    measures.corner_velocity_step = std::max(measures.corner_velocity_step, jump.lpNorm<Eigen::Infinity>());
  }
}

}  // namespace simulate
