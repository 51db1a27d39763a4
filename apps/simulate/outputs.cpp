#include "outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "cncplan/step/vcd.hpp"
#include "cncplan_tools/motor_signals.hpp"
#include "deviation.hpp"
#include "html_report.hpp"
#include "plots.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "run.hpp"
#include "support/failure.hpp"
#include "support/gnuplot.hpp"
#include "support/main_program.hpp"
#include "support/output_file.hpp"
#include "support/report.hpp"
#include "tables.hpp"

namespace simulate {

namespace {

using support::Exit;
using support::Failure;

// Refuses what would not come to its end: a period or a number of steps that is a slip of the keyboard.
void check_size(const Measures& measures, const Options& options, const support::Machine& machine) {
  constexpr double most = 1e10;
  const double samples = measures.duration / options.period;
  if (options.makes_samples() && !(samples <= most))
    throw Failure(Exit::bad_input, fmt::format("the program takes {:.6g} s, which is {:.3g} samples at a "
                                               "period of {:.6g} s: more than {:.0e}",
                                               measures.duration, samples, options.period, most));
  if (!options.makes_steps()) return;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const support::MachineAxis& axis = machine.axes[i];
    const double between_ends = measures.travel[static_cast<Eigen::Index>(i)];
    const double travelled = axis.rotary ? between_ends : std::max(between_ends, measures.length);
    if (!(travelled * axis.drive.steps_per_unit <= most))
      throw Failure(
          Exit::bad_input,
          fmt::format("a path of {:.6g} {} at {:.6g} steps of {} for each: more than {:.0e} steps", travelled,
                      axis.rotary ? "degrees" : "mm", axis.drive.steps_per_unit, axis.letter, most));
  }
}

// At most so many points are drawn.
constexpr std::size_t drawn_points = 20000;

// The plans that are shown beside the program's own.
std::vector<report::Plan> compared(const Options& options, const ProgramText& program,
                                   const PlanAs& plan_as) {
  if (!options.compare) return {};
  Options other = options;
  other.tolerance = *options.compare;
  const Plan planned = plan_as(other);
  const double deviation =
      other.tolerance > 0.0 ? largest_deviation(program, planned, MotionPlaces(program, planned)) : 0.0;
  return {plan_of(other, program, planned, deviation)};
}

}  // namespace

int write_outputs(const Options& options, const support::Machine& file, const ProgramText& program,
                  const PlanAs& plan_as) {
  const std::vector<report::Plan> others = compared(options, program, plan_as);
  const Plan plan = plan_as(options);
  Run run(options, file, program, plan);
  const Measures& measures = run.measures();
  check_size(measures, options, file);
  if (options.plot) support::make_folder(*options.plot);

  support::OutputFiles files;
  if (std::ostream* out = files.open(options.motions)) write_motions(*out, program);
  if (std::ostream* out = files.open(options.blocks)) write_blocks(*out, program, measures);
  std::ostream* const samples = files.open(options.samples);
  std::ostream* const steps = files.open(options.steps);
  std::ostream* const page = files.open(options.report);
  if (samples != nullptr) write_samples_header(*samples, file);

  Progress progress(!options.quiet, measures.duration * (options.makes_steps() ? 2.0 : 1.0));
  std::vector<Sample> drawn;
  const auto every = static_cast<std::size_t>(measures.duration / options.period) / drawn_points + 1;
  if (options.makes_samples())
    run.sample([&](const Sample& sample) {
      if (samples != nullptr) write_sample(*samples, file, sample);
      if (options.plot && (measures.samples % every == 0 || !(sample.time < measures.duration)))
        drawn.push_back(sample);
      progress.reach(sample.time);
    });

  if (steps != nullptr) {
    auto vcd = cncplan::step::vcd_writer(*steps, cncplan::tools::MotorSignals(file).traces());
    run.step([&](const cncplan::step::Edge& edge) {
      if (!vcd.accept(edge)) throw Failure(Exit::other, "an edge came out of order");
      progress.reach(measures.duration + edge.time);
    });
    vcd.finish();
  } else if (options.makes_steps()) {
    run.step([&](const cncplan::step::Edge& edge) { progress.reach(measures.duration + edge.time); });
  }

  if (page != nullptr) {
    auto shown = html_report(options, file, program, measures, plan);
    shown.plans.insert(shown.plans.end(), others.begin(), others.end());
    report::write(*page, shown);
  }

  files.finish();
  if (options.plot) draw(*options.plot, options.quiet, file, drawn);
  files.commit();
  progress.finish();
  if (options.json)
    support::print(json_summary(program, options, file, measures));
  else if (!options.quiet)
    support::print(table_summary(program, options, file, measures), options.summary_aside ? stderr : stdout);
  return static_cast<int>(Exit::done);
}

}  // namespace simulate
