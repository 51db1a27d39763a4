#include "motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "conversion.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;

using Course = plan::JointCourse<plan::SidewallGuide>;
using Block = Course::Block;

Course course_of(const Artwork& artwork, const kinematics::Sidewall& sidewall, const Machine& machine) {
  Course course{plan::SidewallGuide(sidewall, smallest_radius(machine))};
  const double rapid = rapid_rate(machine);
  bool over_mold = false;
  for (std::size_t i = 0; i < artwork.lines.size(); ++i) {
    const Line& line = artwork.lines[i];
    for (const Move& move : line.moves) {
      if (!std::exchange(over_mold, over_mold || leads_to_mold(move))) continue;
      const double feed = move.rapid || move.feed == 0.0 ? rapid : move.feed;
      if (const auto ok = course.append(move.segment, std::min(feed, rapid), i); !ok)
        refuse_move(artwork, i, move, ok.error());
      if (move.exact_stop) course.stop();
    }
    if (line.stops) course.stop();
    course.pause(line.pause);
  }
  return course;
}

// What the joints do at a place of the plan.
Sample evaluate(const Motion& motion, const plan::Place& place, double time) {
  const Path& path = motion.path(place.block);
  State within = place.state;
  within.position = place.along;
  const auto axes = support::axis_motion(path, within);
  auto flat = path.point(path.parameter_at(place.along));
  if (path.chart().piece.is_kink()) {  // whose radii are the angle turned
    const double radius = std::hypot(flat[0], flat[1]);
    for (const std::size_t i : {0U, 1U}) flat[i] *= path.chart().begins / radius;
  }
  return {time, place.state, flat, axes.position, axes.velocity, axes.acceleration};
}

}  // namespace

Motion plan_motion(const Artwork& artwork, const kinematics::Sidewall& sidewall, const Machine& machine,
                   const Options& options) {
  Motion motion{course_of(artwork, sidewall, machine).blocks(), {}};
  if (motion.blocks.empty()) return motion;
  std::vector<plan::BlockCaps> caps;
  plan::joint_caps(std::span<const Block>(motion.blocks), machine.joint_limits<4>(), options.corner_time,
                   std::back_inserter(caps));
  auto spans = support::spans_of(caps, plan::SevenPhase{});
  motion.plan = support::plan_of(std::move(caps), std::move(spans));
  return motion;
}

void make_samples(const Motion& motion, double period, const std::function<void(const Sample&)>& take) {
  if (motion.blocks.empty()) return;
  const double end = motion.plan.duration;
  plan::Cursor cursor(motion.plan.spans, motion.plan.lengths);
  double time = 0.0;
  for (std::size_t k = 0; time < end; time = static_cast<double>(++k) * period)
    take(evaluate(motion, cursor.at(time), time));
  take(evaluate(motion, cursor.at(end), end));
}

AxisPeaks axis_peaks(const Motion& motion) {
  return support::axis_peaks<Path>(motion.plan, [&](std::size_t i) -> const Path& { return motion.path(i); });
}

support::StepReports make_steps(const Motion& motion, const Machine& machine, const Artwork& artwork,
                                double period, const std::function<void(const step::Edge&)>& take) {
  if (motion.blocks.empty()) return support::StepReports(machine.axes.size());
  const auto path = [&](std::size_t i) -> const Path& { return motion.path(i); };
  const auto where = [&](std::size_t i) {
    return fmt::format("{}:{}:1", artwork.file, motion.blocks[i].motion + 1);
  };
  return support::make_steps<Path>(motion.plan, machine, period, path, where, take);
}

}  // namespace tire_mold
