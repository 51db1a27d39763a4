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

#include "options.hpp"
#include "plots.hpp"
#include "report.hpp"
#include "run.hpp"
#include "support/failure.hpp"
#include "support/gnuplot.hpp"
#include "support/main_program.hpp"
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
template <class P>
void check_size(const Route<P>& route, const Plan& plan, const Options& options, const Machine& machine) {
  constexpr double most = 1e10;
  const double samples = plan.duration / options.period;
  if (!(samples <= most))
    throw Failure(Exit::bad_input, fmt::format("the program takes {:.6g} s, which is {:.3g} samples at a "
                                               "period of {:.6g} s: more than {:.0e}",
                                               plan.duration, samples, options.period, most));
  if (!options.makes_steps()) return;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const MachineAxis& axis = machine.axes[i];
    double travelled = plan.length;
    if (axis.rotary) {
      travelled = 0.0;
      const auto k = static_cast<Eigen::Index>(i);
      for (const auto& [path, block] : route)
        travelled += std::abs(path.position(path.parameter_end())[k] - path.position(0.0)[k]) / axis.unit();
    }
    if (!(travelled * axis.drive.steps_per_unit <= most))
      throw Failure(
          Exit::bad_input,
          fmt::format("a path of {:.6g} {} at {:.6g} steps of {} for each: more than {:.0e} steps", travelled,
                      axis.rotary ? "degrees" : "mm", axis.drive.steps_per_unit, axis.letter, most));
  }
}

// What the options ask for and the machine cannot do.
void check_options(const Options& options, const Machine& machine) {
  const auto refuse = [](const char* why) { throw Failure(Exit::bad_input, why); };
  if (options.check && (options.motions || options.blocks || options.samples || options.steps ||
                        options.plot || options.events))
    refuse("--check plans nothing: it goes without outputs and events");
  const bool mill = machine.kinematics == Kinematics::cartesian;
  if (options.corner_time && mill) refuse("--corner-time is for machines with a rotary table");
  if (options.tool_length && machine.kinematics != Kinematics::tire_mold)
    refuse("--tool-length is for machines with a tilting axis");
  const bool as_planned = options.law == Law::seven && options.planning == Planning::span &&
                          options.interpolator == Interpolator::exact;
  if (options.events && !as_planned)
    refuse("--events goes with --profile seven, --plan span and --interpolator exact only");
  if (options.interpolator == Interpolator::taylor && !mill)
    refuse("--interpolator taylor is for machines without a rotary table");
}

// At most so many points are drawn.
constexpr std::size_t drawn_points = 20000;

template <class P>
int run(const Options& options, const Machine& machine, const Program& program, const Route<P>& route) {
  Measures measures;
  const Plan plan = make_plan(program, route, options, machine, measures);
  check_size(route, plan, options, machine);
  if (options.plot) support::make_folder(*options.plot);

  support::OutputFiles files;
  if (std::ostream* out = files.open(options.motions)) write_motions(*out, program);
  if (std::ostream* out = files.open(options.blocks)) {
    std::vector<std::size_t> blocks;
    for (const Piece<P>& piece : route) blocks.push_back(piece.block);
    write_blocks(*out, program, plan, blocks);
  }
  std::ostream* const samples = files.open(options.samples);
  std::ostream* const steps = files.open(options.steps);
  if (samples != nullptr) write_samples_header(*samples, machine);

  Progress progress(!options.quiet, plan.duration * (options.makes_steps() ? 2.0 : 1.0));
  std::vector<Sample> drawn;
  const auto every = static_cast<std::size_t>(plan.duration / options.period) / drawn_points + 1;
  make_samples(program, route, plan, options, measures, [&](const Sample& sample) {
    if (samples != nullptr) write_sample(*samples, program, machine, sample);
    if (options.plot && (measures.samples % every == 0 || !(sample.time < plan.duration)))
      drawn.push_back(sample);
    progress.reach(sample.time);
  });
  measure_axes(route, plan, machine, measures);

  const auto step = [&](const std::function<void(const cncplan::step::Edge&)>& take) {
    make_steps(program, route, plan, options, machine, measures, [&](const cncplan::step::Edge& edge) {
      take(edge);
      progress.reach(plan.duration + edge.time);
    });
  };
  if (steps != nullptr) {
    auto vcd = cncplan::step::vcd_writer(*steps, support::traces_of(machine));
    step([&](const cncplan::step::Edge& edge) {
      if (!vcd.accept(edge)) throw Failure(Exit::other, "an edge came out of order");
    });
    vcd.finish();
  } else if (options.makes_steps()) {
    step([](const cncplan::step::Edge&) {});
  }

  files.finish();
  if (options.plot) draw(*options.plot, options.quiet, machine, drawn);
  files.commit();
  progress.finish();
  if (options.json)
    support::print(json_summary(program, plan, options, machine, measures));
  else if (!options.quiet)
    support::print(table_summary(program, plan, machine, measures));
  return static_cast<int>(Exit::done);
}

// Most problems of a program that are told: of one that was to be run, and of one that is checked.
constexpr std::size_t told_problems = 20;
constexpr std::size_t checked_problems = 100;

// Says all that is wrong with a program, and by kind; plans nothing.
int check(const Options& options, const Machine& machine) {
  Problems problems(options.program, checked_problems);
  const Program program = read_program(options, machine, problems);
  if (problems.found().empty() && machine.kinematics == Kinematics::polar)
    (void)polar_route(program, machine);
  if (options.json)
    support::print(kinds_json(problems, program.lines, program.warnings));
  else if (!options.quiet)
    support::print(kinds_table(problems));
  problems.refuse();
  return static_cast<int>(Exit::done);
}

int run(const Options& options) {
  Machine machine;
  if (options.machine) machine = support::read_machine(*options.machine);
  check_options(options, machine);
  if (options.check) return check(options, machine);
  Problems problems(options.program, told_problems);
  const Program program = read_program(options, machine, problems);
  problems.refuse();
  switch (machine.kinematics) {
    case Kinematics::tire_mold:
      return run(options, machine, program, row_route(program));
    case Kinematics::polar:
      return run(options, machine, program, polar_route(program, machine));
    default:
      return run(options, machine, program, mill_route(program));
  }
}

}  // namespace

}  // namespace simulate

int main(int argc, char** argv) {
  return support::main_program([&] {
    const auto options = simulate::parse_options(argc, argv);
    return options ? simulate::run(*options) : 0;
  });
}
