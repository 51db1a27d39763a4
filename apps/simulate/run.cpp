#include "run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "cncplan_tools/motor_signals.hpp"
#include "path_distance.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

// Which rule of a drive is broken, and what helps.
[[nodiscard]] std::string drive_message(const cncplan::step::Violation& broken, char letter) {
  const std::string_view unit = broken.error.field == "step rate" ? "steps/s" : "s";
  return fmt::format(
      "error: axis {} at {:.9f} s: {} of {:.6g} {} {} of {:.6g} {}; slower corners or a lower speed give the "
      "drive more time",
      letter, broken.time, broken.error.field, broken.error.value, unit, message(broken.error.code),
      broken.error.bound, unit);
}

// Values of the axes in mm and degrees.
[[nodiscard]] PerAxis shown(const support::Machine& file, const PerAxis& values) {
  PerAxis result = values;
  for (Eigen::Index k = 0; k < result.size(); ++k)
    result[k] = file.shown(static_cast<std::size_t>(k), values[k]);
  return result;
}

}  // namespace

Run::Run(const Options& options, const support::Machine& file, const ProgramText& program, const Plan& plan)
    : options_(options), file_(file), program_(program), plan_(plan), places_(program, plan) {
  measures_.plan_seconds = plan.seconds;
  const Stopwatch watch(measures_.measure_seconds);
  measure();
}

void Run::sample(const std::function<void(const Sample&)>& take) {
  PathDistance distance(program_);
  Sample row;
  double elsewhere = 0.0;
  {
    const Stopwatch watch(measures_.interpolate_seconds);
    plan_.motion->sample(options_.period, [&](const SetPoint& point) {
      const Stopwatch not_counted(elsewhere);
      const Origin& motion = program_.motions[plan_.motion_of[point.block]];
      row = {point, &motion, places_.within(point.block, point.along.position)};
      if (motion.driven_path() != nullptr) {
        const bool exact = plan_.motion->as_programmed(point.piece);
        double& largest = exact ? measures_.contour_error : measures_.deviation;
        const cncplan::Vector3 driven =
            motion.axes_path ? cncplan::Vector3(point.position.head<3>()) : point.tool;
        largest = std::max(largest, distance({&motion, driven, row.within}));
      }
      ++measures_.samples;
      take(row);
    });
  }
  measures_.interpolate_seconds -= elsewhere;
  measures_.end_error = (row.tool - program_.motions.back().path.end()).norm();
}

void Run::step(const std::function<void(const cncplan::step::Edge&)>& take) {
  const Stopwatch watch(measures_.steps_seconds);
  const cncplan::tools::MotorSignals signals(file_);
  for (const cncplan::step::Edge& edge : signals.squaring()) take(edge);
  const auto reports = plan_.motion->step(
      options_.period, [&](const cncplan::MotorEdge& edge) { take(signals.signal(edge)); });
  if (!reports) {
    const std::size_t block = plan_.motion->block_of(plan_.motion->at(reports.error().time).piece);
    throw support::Failure(
        support::Exit::bad_input,
        fmt::format("{}: {}", program_.place(program_.motions[plan_.motion_of[block]]),
                    drive_message(reports.error(),
                                  file_.axes[static_cast<std::size_t>(reports.error().axis)].letter)));
  }
  for (std::size_t i = 0; i < file_.axes.size(); ++i) {
    auto& report = measures_.steps.emplace_back((*reports)[i]);
    const double unit = file_.axes[i].unit();
    for (double* value : {&report.position, &report.rms_error, &report.max_error}) *value /= unit;
    report.mean_square_error /= unit * unit;
    if (file_.axes[i].drive.inverted) report.net_steps = -report.net_steps;
  }
}

void Run::measure() {
  const Planned& motion = *plan_.motion;
  measures_.duration = motion.duration();
  measures_.length = motion.length();
  measures_.completed = motion.completed();
  PlanPeaks& peaks = measures_.peaks = motion.peaks();
  for (PerAxis* values : {&peaks.velocity, &peaks.acceleration, &peaks.jerk, &peaks.corner_velocity_step})
    *values = shown(file_, *values);
  measures_.junctions_limited = plan_.junctions_limited;
  measures_.fallbacks = plan_.fallbacks;
  if (options_.tolerance > 0.0) measures_.deviation = largest_deviation(program_, plan_, places_);
  measures_.travel = PerAxis::Zero(static_cast<Eigen::Index>(file_.axes.size()));
  for (std::size_t i = 0; i < motion.block_count(); ++i) measures_.travel += shown(file_, motion.way(i));
  measures_.motions.resize(program_.motions.size());
  for (const BlockTiming& block : motion.timings()) {
    MotionTiming& timing = measures_.motions[plan_.motion_of[block.block]];
    if (!(timing.duration > 0.0)) timing.entry = block.entry;
    timing.peak = std::max(timing.peak, block.peak);
    timing.exit = options_.interpolator == Interpolator::constant ? block.entry : block.exit;
    timing.duration += block.duration;
  }
}

}  // namespace simulate
