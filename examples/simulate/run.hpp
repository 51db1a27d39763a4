// A program planned, sampled and stepped, and what was measured on the way.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "contour.hpp"
#include "events.hpp"
#include "machine.hpp"
#include "measures.hpp"
#include "options.hpp"
#include "program.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"
#include "support/motor_signals.hpp"

namespace simulate {

/// Which rule of a drive is broken, and what helps.
[[nodiscard]] inline std::string drive_message(const cncplan::step::Violation& broken, char letter) {
  const std::string_view unit = broken.error.field == "step rate" ? "steps/s" : "s";
  return fmt::format(
      "error: axis {} at {:.9f} s: {} of {:.6g} {} {} of {:.6g} {}; slower corners or a lower speed give the "
      "drive more time",
      letter, broken.time, broken.error.field, broken.error.value, unit, message(broken.error.code),
      broken.error.bound, unit);
}

/// A program on its machine, from plan to pulses.
template <class M>
class Run {
 public:
  using Block = typename M::Block;
  using Trajectory = cncplan::Trajectory<M, Block>;

  /// Plans. Throws `Failure` for what cannot be planned.
  Run(const Options& options, const support::Machine& file, const M& machine, const Program<M>& program)
      : options_(options), file_(file), program_(program), trajectory_(plan(machine)) {
    measure();
  }

  /// With a trajectory that was planned in so many seconds; the program's blocks are its.
  Run(const Options& options, const support::Machine& file, const Program<M>& program, Trajectory trajectory,
      double seconds)
      : options_(options), file_(file), program_(program), trajectory_(std::move(trajectory)) {
    measures_.plan_seconds = seconds;
    measure();
  }

  [[nodiscard]] const Measures& measures() const { return measures_; }
  [[nodiscard]] const Trajectory& trajectory() const { return trajectory_; }

  /// Hands every sample to `take`, in order.
  void sample(const std::function<void(const Sample&)>& take) {
    std::optional<TaylorFollower<Trajectory>> follow;
    if constexpr (std::is_same_v<M, Mill<3>>)
      if (options_.interpolator == Interpolator::taylor) follow.emplace(trajectory_);
    PathDistance distance;
    Sample row;
    std::size_t point_block = 0;
    const auto all = trajectory_.samples(options_.period);
    for (auto it = all.begin(); it != all.end(); ++it) {
      {
        const Stopwatch watch(measures_.interpolate_seconds);
        const auto point = *it;
        point_block = point.block;
        const std::size_t motion = program_.motion_of[point.block];
        row = {point.time,
               &program_.motions[motion],
               tool_at(trajectory_.machine(), point),
               point.position,
               point.velocity,
               point.acceleration,
               point.along};
        if constexpr (std::is_same_v<M, Mill<3>>)
          if (follow && point.time < trajectory_.duration()) row.position = (*follow)(point);
        if (!std::is_same_v<M, Rows>)  // a row is what the axes do: there is nothing else to follow
          row.within = point.along.position - motion_start_[motion];
      }
      if (!std::is_same_v<M, Rows>) measure_distance(point_block, distance(row));
      ++measures_.samples;
      take(row);
    }
    measures_.end_error = (row.position - program_.motions.back().path.end()).norm();
  }

  /// Turns the plan into edges at their exact times and hands them to `take` in order, as signals of the
  /// machine's motors. Throws `Failure` for a plan that breaks a rule of a drive.
  void step(const std::function<void(const cncplan::step::Edge&)>& take) {
    const Stopwatch watch(measures_.steps_seconds);
    const support::MotorSignals signals(file_);
    for (const cncplan::step::Edge& edge : signals.squaring()) take(edge);
    const auto reports = cncplan::follow_steps(trajectory_, options_.period,
                                               [&](const auto& edge) { take(signals.signal(edge)); });
    if (!reports)
      throw support::Failure(
          support::Exit::bad_input,
          fmt::format("{}: {}", program_.place(trajectory_.at(reports.error().time).block),
                      drive_message(reports.error(),
                                    file_.axes[static_cast<std::size_t>(reports.error().axis)].letter)));
    for (std::size_t i = 0; i < file_.axes.size(); ++i) {
      auto& report = measures_.steps.emplace_back((*reports)[i]);
      for (double* value : {&report.position, &report.rms_error, &report.max_error})
        *value = file_.shown(i, *value);
      if (file_.axes[i].drive.inverted) report.net_steps = -report.net_steps;
    }
  }

 private:
  using Cells = cncplan::plan::BasicCells<double>;

  // A mill's paths are; a table's and rows R Z A C are driven exactly.
  static constexpr bool smoothed = !std::is_same_v<M, Table> && !std::is_same_v<M, Rows>;

  Trajectory plan(const M& machine) {
    namespace plan = cncplan::plan;
    const Stopwatch watch(measures_.plan_seconds);
    const double to_rad = cncplan::gcode::radians_per_degree;
    const plan::JointRules<double, JunctionChoice> rules{options_.junction, options_.corner_tolerance,
                                                         options_.rotary_tolerance * to_rad};
    std::pmr::vector<Block> driven(program_.blocks.begin(), program_.blocks.end());
    typename Trajectory::Smoothing smoothing;
    if constexpr (smoothed)
      if (options_.tolerance > 0.0) {
        const plan::SmoothingRules<double> within{options_.tolerance, options_.rotary_tolerance * to_rad};
        cncplan::merge_lines(std::span(driven), machine, within);
        smoothing = plan::smoothing(std::span<const Block>(driven), machine, within);
      }
    std::vector<Event> events;
    std::pmr::vector<Block> blocks = driven;
    if (options_.events) {  // limits are made for the highest feed
      events = read_events(*options_.events);
      for (Block& block : blocks) block.feed *= highest_feed(events);
    }
    const bool whole =
        options_.planning == Planning::block || options_.interpolator == Interpolator::constant;
    const std::span<const Block> all(blocks);
    const auto cells = whole
                           ? plan::make_cells<cncplan::published::WholeBlocks>(all, machine, rules, smoothing)
                           : plan::make_cells(all, machine, rules, smoothing);
    if (!cells) {
      auto error = plan::error_in(all, cells.error());
      error.file = program_.file;
      throw support::Failure(support::Exit::bad_input, cncplan::to_text(error));
    }
    count_limited(*cells, machine);
    if (options_.events)
      return Trajectory(machine, std::move(driven), played(*cells, machine, events), std::move(smoothing));
    const auto spans = spans_of(cells->caps);
    return Trajectory(machine, std::move(driven),
                      plan::block_phases(std::span<const plan::Span>(spans), *cells), std::move(smoothing));
  }

  std::vector<cncplan::plan::Span> spans_of(std::span<const cncplan::plan::BlockCaps> caps) const {
    namespace plan = cncplan::plan;
    namespace published = cncplan::published;
    std::vector<plan::Span> spans;
    if (options_.interpolator == Interpolator::constant) {
      for (std::size_t i = 0; i < caps.size(); ++i) {
        spans.push_back({i, 1, published::constant_speed(caps[i].length, caps[i].limits.velocity)});
        if (caps[i].pause > 0.0) spans.push_back(plan::pause_span(i + 1, caps[i].pause));
      }
      return spans;
    }
    const auto law = options_.law == Law::five ? cncplan::profile::five_phase_solver<double>
                                               : cncplan::profile::seven_phase_solver<double>;
    const std::span<const plan::BlockCaps> all(caps);
    const auto refuse = [](const auto& planned) {
      if (!planned)
        throw support::Failure(support::Exit::bad_input, fmt::format("planning: {} {}", planned.error().field,
                                                                     message(planned.error().code)));
    };
    if (options_.planning == Planning::block) {
      std::vector<double> speeds(caps.size() + 1);
      refuse(published::plan_blocks(all, law, std::span(speeds), std::back_inserter(spans)));
    } else {
      std::vector<plan::Waypoint> waypoints(caps.size() + 1);
      refuse(plan::plan_spans(all, law, std::span(waypoints), std::back_inserter(spans)));
    }
    return spans;
  }

  // The program played: nothing is known of the events before they come, but how far the feed goes.
  auto played(const Cells& cells, const M& machine, const std::vector<Event>& events) const {
    const auto feed_of = [&](const Block& block) {
      if (block.rapid) return rapid_speed(machine);
      return std::isfinite(block.feed) ? block.feed : feed_speed(machine);
    };
    std::vector<cncplan::plan::TimedRequest> requests;
    for (const Event& event : events)
      requests.push_back({event.time, [&event](cncplan::plan::Player& player) { ask(player, event); }});
    auto phases =
        cncplan::plan::play(std::span<const Block>(program_.blocks), cells,
                            std::span<const cncplan::plan::TimedRequest>(requests), options_.period, feed_of);
    if (!phases)
      throw support::Failure(
          support::Exit::bad_input,
          fmt::format("with its events the program takes more than {:.0e} periods of {:.6g} s",
                      phases.error().bound, options_.period));
    return *phases;
  }

  // Joints between motions that are slower than the feeds on both sides.
  void count_limited(const Cells& cells, const M& machine) {
    const auto wanted = [&](std::size_t block) {
      const Block& b = program_.blocks[block];
      return cncplan::plan::wanted_speed(b, machine, cncplan::length_of(b.path, machine));
    };
    for (std::size_t i = 1; i < cells.caps.size(); ++i) {
      const std::size_t before = cells.blocks[i - 1], after = cells.blocks[i];
      if (program_.motion_of[before] != program_.motion_of[after] &&
          cells.caps[i].entry < std::min(wanted(before), wanted(after)))
        ++measures_.junctions_limited;
    }
  }

  // Of a sample from the programmed path: an error where that is driven, else what smoothing takes.
  void measure_distance(std::size_t block, double distance) {
    const Block& driven = trajectory_.program()[block];
    bool programmed = trajectory_.path(block).exact() && !(driven.merged > 0.0);
    if constexpr (requires(const Block& b) { b.source; }) {
      const auto& path = driven.path;
      programmed = programmed && (path.line() != nullptr || path.arc() != nullptr ||
                                  path.template as<cncplan::path::Spline<M::axis_count>>() != nullptr);
    }
    double& largest = programmed ? measures_.contour_error : measures_.deviation;
    largest = std::max(largest, distance);
  }

  void measure() {
    const auto axes = static_cast<Eigen::Index>(file_.axes.size());
    const auto shown = [&](const auto& values) {
      PerAxis result(axes);
      for (Eigen::Index k = 0; k < axes; ++k) result[k] = file_.shown(static_cast<std::size_t>(k), values[k]);
      return result;
    };
    const auto peaks = cncplan::peaks(trajectory_);
    const auto jumps = cncplan::joint_jumps(trajectory_);
    measures_.duration = trajectory_.duration();
    measures_.length = trajectory_.length();
    measures_.completed = trajectory_.completed();
    measures_.peak = peaks.along;
    measures_.tool_peak = peaks.tool;
    measures_.axis_velocity = shown(peaks.velocity);
    measures_.axis_acceleration = shown(peaks.acceleration);
    measures_.axis_jerk = shown(peaks.jerk);
    measures_.corner_velocity_step = shown(jumps.velocity).maxCoeff();
    measures_.acceleration_jumps = jumps.accelerations;
    measures_.travel = PerAxis::Zero(axes);
    motion_start_.assign(program_.motions.size(), 0.0);
    for (std::size_t i = program_.blocks.size(); i-- > 0;) {
      const auto& path = program_.blocks[i].path;
      motion_start_[program_.motion_of[i]] = trajectory_.start_length(i);
      if (path.length() > 0.0)
        measures_.travel += shown((path.position_at(path.length()) - path.position_at(0.0)).cwiseAbs());
    }
    measures_.motions.resize(program_.motions.size());
    for (const auto& block : trajectory_.blocks()) {
      MotionTiming& motion = measures_.motions[program_.motion_of[block.block]];
      if (!(motion.duration > 0.0)) motion.entry = block.entry;
      motion.peak = std::max(motion.peak, block.peak);
      motion.exit = options_.interpolator == Interpolator::constant ? block.entry : block.exit;
      motion.duration += block.duration;
    }
  }

  const Options& options_;
  const support::Machine& file_;
  const Program<M>& program_;
  Measures measures_;
  Trajectory trajectory_;
  std::vector<double> motion_start_;  // mm at which each motion begins
};

}  // namespace simulate
