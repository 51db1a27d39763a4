#include "execute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "cncplan/step/vcd.hpp"
#include "deviation.hpp"
#include "html_report.hpp"
#include "machine.hpp"
#include "pause_places.hpp"
#include "plan.hpp"
#include "plots.hpp"
#include "problems.hpp"
#include "progress.hpp"
#include "read_program.hpp"
#include "report.hpp"
#include "run.hpp"
#include "serve.hpp"
#include "support/failure.hpp"
#include "support/gnuplot.hpp"
#include "support/main_program.hpp"
#include "support/motor_signals.hpp"
#include "support/output_file.hpp"
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
    const MachineAxis& axis = machine.axes[i];
    const double travelled = axis.rotary ? measures.travel[static_cast<Eigen::Index>(i)] : measures.length;
    if (!(travelled * axis.drive.steps_per_unit <= most))
      throw Failure(
          Exit::bad_input,
          fmt::format("a path of {:.6g} {} at {:.6g} steps of {} for each: more than {:.0e} steps", travelled,
                      axis.rotary ? "degrees" : "mm", axis.drive.steps_per_unit, axis.letter, most));
  }
}

// At most so many points are drawn.
constexpr std::size_t drawn_points = 20000;

// Most problems of a program that are told: of one that was to be run, and of one that is checked.
constexpr std::size_t told_problems = 20;
constexpr std::size_t checked_problems = 100;

// Samples, steps and all else that is wanted of a run.
int write_out(const Options& options, const support::Machine& file, const ProgramText& program,
              const Plan& plan, const std::vector<report::Plan>& others) {
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
    auto vcd = cncplan::step::vcd_writer(*steps, support::MotorSignals(file).traces());
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

// A pause before a line without motion never comes.
void tell_pauses(const Options& options, ProgramText& program) {
  if (!options.events) return;
  for (const auto& [line, row, column] : pause_places(*options.events)) {
    const auto is_there = [number = line](const Origin& motion) { return motion.line == number; };
    if (line == 0 || std::any_of(program.motions.begin() + 1, program.motions.end(), is_there)) continue;
    program.warnings.push_back(fmt::format("{}:{}:{}: warning: pause: {} has no motion on line {}",
                                           *options.events, row, column, program.file, line));
    fmt::print(stderr, "{}\n", program.warnings.back());
  }
}

}  // namespace

template <class M>
int execute(const Options& options, const support::Machine& file, const M& machine) {
  Problems problems(options.program, options.check ? checked_problems : told_problems);
  auto program = read_program(options, file, machine, problems);
  if (options.check) {  // says all that is wrong, and by kind; plans nothing
    if (options.json)
      support::print(kinds_json(problems, program.lines, program.warnings.size()));
    else if (!options.quiet)
      support::print(kinds_table(problems));
  }
  problems.refuse();
  if (options.check) return static_cast<int>(Exit::done);
  tell_pauses(options, program);

  if (options.serve) {
    const Plan planned = plan(options, file, machine, program);
    const Run run(options, file, program, planned);
    return serve_program(options, html_report(options, file, program, run.measures(), planned),
                         live_machines(options, file, machine, program));
  }
  std::vector<report::Plan> others;
  if (options.compare) {
    Options other = options;
    other.tolerance = *options.compare;
    const Plan planned = plan(other, file, machine, program);
    const double deviation =
        other.tolerance > 0.0 ? largest_deviation(program, planned, MotionPlaces(program, planned)) : 0.0;
    others.push_back(plan_of(other, program, planned, deviation));
  }
  return write_out(options, file, program, plan(options, file, machine, program), others);
}

template int execute(const Options&, const support::Machine&, const Mill<3>&);
template int execute(const Options&, const support::Machine&, const Mill<6>&);
template int execute(const Options&, const support::Machine&, const Table&);
template int execute(const Options&, const support::Machine&, const Rows&);

}  // namespace simulate
