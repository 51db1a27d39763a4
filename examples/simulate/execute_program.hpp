// What `execute` does, for the files that define it for one kind of machine each.
#pragma once

#include <fmt/format.h>

#include <type_traits>
#include <utility>
#include <vector>

#include "execute.hpp"
#include "html_report.hpp"
#include "plots.hpp"
#include "problems.hpp"
#include "progress.hpp"
#include "read_program.hpp"
#include "report.hpp"
#include "run.hpp"
#include "serve.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"
#include "support/gnuplot.hpp"
#include "support/main_program.hpp"
#include "support/motor_signals.hpp"
#include "support/output_file.hpp"
#include "tables.hpp"

namespace simulate {

namespace detail {

using support::Exit;
using support::Failure;

// Refuses what would not come to its end: a period or a number of steps that is a slip of the keyboard.
inline void check_size(const Measures& measures, const Options& options, const support::Machine& machine) {
  constexpr double most = 1e10;
  const double samples = measures.duration / options.period;
  if (!(samples <= most))
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
inline constexpr std::size_t drawn_points = 20000;

// Most problems of a program that are told: of one that was to be run, and of one that is checked.
inline constexpr std::size_t told_problems = 20;
inline constexpr std::size_t checked_problems = 100;

// Samples, steps and all else that is wanted of a run.
template <class M>
int write_out(const Options& options, const support::Machine& file, const Program<M>& program, Run<M> run,
              const std::vector<report::Plan>& others) {
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
    auto shown = html_report(options, file, program, measures, run.trajectory());
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

// Plans a program and hands it to `take` with the blocks that it is planned as: pieces of its own, where it
// is a mill's within a tolerance at the level `good` or `best`.
template <class M, class Take>
int with_plan(const Options& options, const support::Machine& file, const M& machine,
              const Program<M>& program, const Take& take) {
  if constexpr (std::is_same_v<M, Mill<3>> || std::is_same_v<M, Mill<6>>)
    if (options.tolerance > 0.0 && !options.events && options.smooth != Smooth::fast) {
      using Smoothed = SmoothMill<M::axis_count>;
      double seconds = 0.0;
      const auto planned = [&] {
        const Stopwatch watch(seconds);
        return cncplan::plan_smooth(
            program.blocks, Smoothed{machine},
            {.tolerance = options.tolerance,
             .rotary_tolerance = options.rotary_tolerance * cncplan::gcode::radians_per_degree},
            options.smooth == Smooth::good ? cncplan::SmoothLevel::good : cncplan::SmoothLevel::best);
      }();
      if (!planned) {
        auto error = planned.error();
        error.file = program.file;
        throw Failure(Exit::bad_input, cncplan::to_text(error));
      }
      Program<Smoothed> pieces{program, {planned->program().begin(), planned->program().end()}};
      pieces.motion_of.clear();
      for (const auto& piece : pieces.blocks) pieces.motion_of.push_back(program.motion_of[piece.source]);
      return take(pieces, Run<Smoothed>(options, file, pieces, *planned, seconds));
    }
  return take(program, Run<M>(options, file, machine, program));
}

}  // namespace detail

template <class M>
int execute(const Options& options, const support::Machine& file, const M& machine) {
  using namespace detail;
  Problems problems(options.program, options.check ? checked_problems : told_problems);
  const auto program = read_program(options, file, machine, problems);
  if (options.check) {  // says all that is wrong, and by kind; plans nothing
    if (options.json)
      support::print(kinds_json(problems, program.lines, program.warnings.size()));
    else if (!options.quiet)
      support::print(kinds_table(problems));
  }
  problems.refuse();
  if (options.check) return static_cast<int>(Exit::done);

  if (options.serve) {
    const Run<M> planned(options, file, machine, program);
    return serve_program(options, file, machine, program,
                         html_report(options, file, program, planned.measures(), planned.trajectory()));
  }
  std::vector<report::Plan> others;
  if (options.compare) {
    Options other = options;
    other.tolerance = *options.compare;
    with_plan(other, file, machine, program, [&](const auto& planned, const auto& run) {
      others.push_back(plan_of(other, file, planned, run.trajectory()));
      return 0;
    });
  }
  return with_plan(options, file, machine, program, [&](const auto& planned, auto run) {
    return write_out(options, file, planned, std::move(run), others);
  });
}

}  // namespace simulate
