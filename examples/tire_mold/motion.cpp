#include "motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "conversion.hpp"
#include "support/failure.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;
using support::Exit;
using support::Failure;

using Course = plan::JointCourse<plan::SidewallGuide>;
using Block = Course::Block;

Course course_of(const Artwork& artwork, const kinematics::Sidewall& sidewall, const Machine& machine) {
  Course course{plan::SidewallGuide(sidewall, machine.smallest_radius)};
  bool over_mold = false;
  std::size_t number = 0;
  for (std::size_t i = 0; i < artwork.lines.size(); ++i) {
    const Line& line = artwork.lines[i];
    for (const Move& move : line.moves) {
      if (!std::exchange(over_mold, over_mold || leads_to_mold(move))) continue;
      const double feed = move.rapid || move.feed == 0.0 ? machine.rapid_rate : move.feed;
      if (const auto ok = course.append(move.segment, std::min(feed, machine.rapid_rate), number++); !ok)
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
  const auto& path = motion.blocks[place.block].path;
  const double u = path.parameter_at(place.along);
  const auto rates = path.rates(u);
  const double v = place.state.velocity;
  auto flat = path.point(u);
  if (path.chart().piece.is_kink()) {  // whose radii are the angle turned
    const double radius = std::hypot(flat[0], flat[1]);
    for (const std::size_t i : {0U, 1U}) flat[i] *= path.chart().begins / radius;
  }
  return {time,
          place.state,
          flat,
          path.position(u),
          rates.first * v,
          rates.second * (v * v) + rates.first * place.state.acceleration};
}

void grow(AxisPeaks& peaks, const Sample& sample) {
  peaks.velocity = peaks.velocity.cwiseMax(sample.velocity.cwiseAbs());
  peaks.acceleration = peaks.acceleration.cwiseMax(sample.acceleration.cwiseAbs());
}

}  // namespace

Motion plan_motion(const Artwork& artwork, const kinematics::Sidewall& sidewall, const Machine& machine,
                   const Options& options) {
  const Course course = course_of(artwork, sidewall, machine);
  Motion motion;
  motion.blocks = course.blocks();
  if (motion.blocks.empty()) return motion;
  std::vector<plan::BlockCaps> caps;
  plan::joint_caps(std::span<const Block>(motion.blocks), machine.limits, options.corner_time,
                   std::back_inserter(caps));
  for (const auto& block : caps) motion.lengths.push_back(block.length);
  std::vector<plan::Gate> gates(caps.size() + 1);
  const auto law = [](const Limits& limits) { return profile::seven_phase_solver(limits); };
  const auto planned = plan::plan_spans(std::span<const plan::BlockCaps>(caps), law, std::span(gates),
                                        std::back_inserter(motion.spans));
  if (!planned)
    throw Failure(Exit::other,
                  fmt::format("planning: {} {}", planned.error().field, message(planned.error().code)));
  for (const auto& span : motion.spans) motion.duration += span.profile.duration();
  return motion;
}

void make_samples(const Motion& motion, double period, const std::function<void(const Sample&)>& take) {
  if (motion.blocks.empty()) return;
  plan::Cursor cursor(motion.spans, motion.lengths);
  double time = 0.0;
  for (std::size_t k = 0; time < motion.duration; time = static_cast<double>(++k) * period)
    take(evaluate(motion, cursor.at(time), time));
  take(evaluate(motion, cursor.at(motion.duration), motion.duration));
}

AxisPeaks axis_peaks(const Motion& motion) {
  AxisPeaks peaks;
  if (motion.blocks.empty()) return peaks;
  std::vector<double> times;
  double start = 0.0;
  for (const plan::Span& span : motion.spans) {
    const auto add = [&](double from, double to) {
      for (const double part : {0.0, 0.5, 1.0}) times.push_back(start + from + part * (to - from));
    };
    for (const Phase& phase : span.profile.phases()) add(phase.time, phase.time + phase.duration);
    double position = 0.0, before = 0.0;
    for (std::size_t i = span.first; i < span.first + span.count; ++i) {
      position += motion.lengths[i];
      const double until = span.profile.time_at(position);
      add(before, until);
      before = until;
    }
    start += span.profile.duration();
  }
  std::sort(times.begin(), times.end());
  plan::Cursor cursor(motion.spans, motion.lengths);
  for (const double time : times) grow(peaks, evaluate(motion, cursor.at(time), time));
  return peaks;
}

void make_steps(const Motion& motion, const Machine& machine,
                const std::function<void(const step::Edge&)>& take) {
  if (motion.blocks.empty()) return;
  std::array<std::int64_t, 4> counts{};
  const Joints first = motion.blocks.front().path.position(0.0);
  for (std::size_t i = 0; i < 4; ++i)
    counts[i] = step::count_at(first[static_cast<Eigen::Index>(i)] * machine.steps_per_unit[i]);
  double start = 0.0;
  for (const plan::Span& span : motion.spans) {
    const auto phases = span.profile.phases();
    double origin = 0.0;
    for (std::size_t i = span.first; i < span.first + span.count; ++i) {
      const step::TracedPath path(motion.blocks[i].path, 2);
      auto edges = step::block_edges(path, step::PhaseClock(std::span<const Phase>(phases), start, origin),
                                     machine.steps_per_unit, counts);
      while (const auto edge = edges.next()) take(*edge);
      counts = step::counts(edges);
      origin += motion.lengths[i];
    }
    start += span.profile.duration();
  }
}

}  // namespace tire_mold
