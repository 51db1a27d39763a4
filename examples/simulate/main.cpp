// The reference integration, G-code in, step and direction out: reads a program, plans it, samples it, turns
// it into step edges, and says what it measured. Its options and outputs are the contract of
// docs/simulate.md.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/timer/progress_display.hpp>
#include <functional>
#include <iostream>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "html_report.hpp"
#include "options.hpp"
#include "plots.hpp"
#include "problems.hpp"
#include "read_program.hpp"
#include "report.hpp"
#include "run.hpp"
#include "serve.hpp"
#include "serve/web_server.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"
#include "support/gnuplot.hpp"
#include "support/main_program.hpp"
#include "support/motor_signals.hpp"
#include "support/output_file.hpp"
#include "tables.hpp"

namespace simulate {

using support::Exit;
using support::Failure;

namespace {

// Shows on a terminal how far a run is, and ends its line whatever ends the run.
class Progress {
 public:
  /// `total`: seconds of the program's time, counted for each stage.
  Progress(bool wanted, double total) : total_(total) {
    if (wanted && ::isatty(STDERR_FILENO) != 0)
      bar_ = std::make_unique<boost::timer::progress_display>(marks, std::cerr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (bar_ && bar_->count() < marks) std::cerr << std::endl;
  }

  /// Before the last mark, which `finish` sets.
  void reach(double done) {
    if (!bar_ || !(total_ > 0.0)) return;
    const auto reached = static_cast<unsigned long>(std::clamp(done / total_, 0.0, 1.0) * (marks - 1));
    if (reached > bar_->count()) *bar_ += reached - bar_->count();
  }
  void finish() {
    if (bar_) *bar_ += marks - bar_->count();
  }

 private:
  static constexpr unsigned long marks = 50;

  std::unique_ptr<boost::timer::progress_display> bar_;
  double total_;
};

// Refuses what would not come to its end: a period or a number of steps that is a slip of the keyboard.
void check_size(const Measures& measures, const Options& options, const support::Machine& machine) {
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

// An executor keeps the exact path; its corners are as fast as ones rounded within the tolerance.
void settle_for_executor(Options& options) {
  if (options.corner_tolerance < 0.0)
    throw Failure(Exit::bad_input, "--serve passes corners by --tolerance: it goes without --junction");
  if (options.tolerance > 0.0) {
    options.corner_tolerance = options.tolerance;
    options.junction = junction_choice(fmt::format("deviation={}", options.tolerance));
  }
  options.tolerance = 0.0;
}

// Refuses what the options ask for and the machine cannot do.
void settle(Options& options, const support::Machine& machine) {
  const auto refuse = [](const char* why) { throw Failure(Exit::bad_input, why); };
  const bool writes =
      options.motions || options.blocks || options.samples || options.steps || options.plot || options.report;
  if (options.check && (writes || options.events || options.serve))
    refuse("--check plans nothing: it goes without outputs and events");
  if (options.serve && (writes || options.events || options.json || options.count_steps || options.smooth))
    refuse("--serve runs the program as it is: it goes without outputs, events and --smooth");
  if (options.compare && !options.report) refuse("--compare goes with --report");
  if (options.tool_length && machine.kinematics != Kinematics::tire_mold)
    refuse("--tool-length is for machines with a tilting axis");
  const bool as_planned = options.law == Law::seven && options.planning == Planning::span &&
                          options.interpolator == Interpolator::exact;
  if (options.events && !as_planned)
    refuse("--events goes with --profile seven, --plan span and --interpolator exact only");
  if (options.serve && !as_planned)
    refuse("--serve goes with --profile seven, --plan span and --interpolator exact only");
  if (options.compare.value_or(0.0) > 0.0 && (!as_planned || machine.kinematics != Kinematics::cartesian))
    refuse("--compare above 0 is for what --tolerance above 0 is for");
  if (options.events && options.smooth == Smooth::best)
    refuse("--smooth best is for motion without events: its speed is planned as a whole");
  if (machine.kinematics != Kinematics::cartesian) {
    if (options.tolerance_given && options.tolerance > 0.0)
      refuse(
          "--tolerance above 0 is for machines whose axes are the program's: paths on a table or a mold are "
          "driven exactly");
    options.tolerance = 0.0;
  }
  if (options.serve) settle_for_executor(options);
  if (options.smooth && !(options.tolerance > 0.0)) refuse("--smooth goes with a --tolerance above 0");
  if (options.interpolator == Interpolator::taylor &&
      (machine.kinematics != Kinematics::cartesian || machine.axes.size() > 3))
    refuse("--interpolator taylor is for machines of X, Y and Z");
}

// At most so many points are drawn.
constexpr std::size_t drawn_points = 20000;

// Most problems of a program that are told: of one that was to be run, and of one that is checked.
constexpr std::size_t told_problems = 20;
constexpr std::size_t checked_problems = 100;

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
    support::print(table_summary(program, options, file, measures));
  return static_cast<int>(Exit::done);
}

// Plans a program and hands it to `take` with the blocks that it is planned as: pieces of its own, where it
// is a mill's within a tolerance at the level `best`.
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
             .rotary_tolerance = options.rotary_tolerance * cncplan::gcode::radians_per_degree});
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

template <class M>
int run(const Options& options, const support::Machine& file, const M& machine) {
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

int run(Options options) {
  support::Machine file;
  if (options.machine) file = support::read_machine(*options.machine);
  settle(options, file);
  if (options.report || options.serve) report::check_libraries();
  if (options.serve) serve::check_libraries();
  if (file.kinematics == Kinematics::tire_mold) {
    auto machine = machine_of<Rows>(file, options.limits);
    machine.tool_length = options.tool_length.value_or(0.0);
    return run(options, file, machine);
  }
  if (file.kinematics == Kinematics::polar) {
    auto machine = machine_of<Table>(file, options.limits);
    machine.smallest_radius = file.smallest_radius.value_or(machine.smallest_radius);
    return run(options, file, machine);
  }
  if (file.axes.size() > 3) return run(options, file, machine_of<Mill<6>>(file, options.limits));
  return run(options, file, machine_of<Mill<3>>(file, options.limits));
}

}  // namespace

}  // namespace simulate

int main(int argc, char** argv) {
  return support::main_program([&] {
    const auto options = simulate::parse_options(argc, argv);
    return options ? simulate::run(*options) : 0;
  });
}
