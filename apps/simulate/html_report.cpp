#include "html_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "cncplan_tools/detail/channels.hpp"
#include "cncplan_tools/motion_data.hpp"
#include "deviation.hpp"
#include "events.hpp"
#include "path_distance.hpp"
#include "report.hpp"
#include "support/report.hpp"

namespace simulate {

namespace {

// From the programmed path to the driven one; nothing where the programmed one is driven.
report::Deviation deviation_of(const Options& options, const ProgramText& program, const Plan& plan,
                               double largest) {
  report::Deviation result;
  const Planned& motion = *plan.motion;
  if (!(options.tolerance > 0.0) || !(motion.duration() > 0.0)) return result;
  constexpr double shortest = 0.0005, most = 60000;
  const double count = std::ceil(std::min(most, motion.duration() / shortest));
  result.period = motion.duration() / count;
  const auto [least, most_tolerance] = program.tolerances(options.tolerance);
  result.tolerance = least < most_tolerance ? 0.0 : most_tolerance;
  result.largest = largest;
  const MotionPlaces places(program, plan);
  PathDistance distance(program);
  for (double k = 0.0; k <= count; ++k) {
    const auto [piece, along] = motion.at(k * result.period);
    const std::size_t block = motion.block_of(piece);
    const double within = along.position - motion.piece_start(piece);
    const Origin& origin = program.motions[plan.motion_of[block]];
    cncplan::Vector3 gap = cncplan::Vector3::Zero();
    if (origin.driven_path() != nullptr)
      gap = distance.gap({&origin, motion.driven_point(piece, within), places.within(block, along.position)});
    for (const double part : gap) result.vectors.push_back(static_cast<float>(part));
  }
  return result;
}

}  // namespace

report::Plan plan_of(const Options& options, const ProgramText& program, const Plan& plan, double deviation) {
  const std::string name =
      options.tolerance > 0.0 ? fmt::format("tolerance {} mm", options.tolerance) : std::string("exact path");
  const auto place_of = [&](std::size_t piece) {
    const Origin& motion = program.motions[plan.motion_of[plan.motion->block_of(piece)]];
    return report::Place{motion.line, motion.kind, motion.offset};
  };
  return {name, report::motion_data(*plan.motion, place_of), deviation_of(options, program, plan, deviation)};
}

report::Report html_report(const Options& options, const support::Machine& file, const ProgramText& program,
                           const Measures& measures, const Plan& plan) {
  report::Report result{
      .file = program.file,
      .text = program.text,
      .summary = summary_rows(program, options, measures),
      .warnings = program.warnings,
      .limits = options.limits,
      .tool_peak = measures.peaks.tool,
      .axes = report::report_axes(file, cncplan::tools::report::channels_of(file), measures.peaks.velocity,
                                  measures.peaks.acceleration, measures.peaks.jerk),
      .marks = {},
      .drawings = {},
      .plans = {}};
  if (options.events)
    for (const Event& event : read_events(*options.events))
      result.marks.push_back({event.time, event_text(event)});
  result.plans.push_back(plan_of(options, program, plan, measures.deviation));
  return result;
}

}  // namespace simulate
