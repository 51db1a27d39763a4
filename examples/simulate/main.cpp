// The reference integration, G-code in, step and direction out: reads a program, plans it, samples it, turns
// it into step edges, and says what it measured. Its options and outputs are the contract of
// docs/simulate.md.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/timer/progress_display.hpp>
#include <cstdio>
#include <iostream>
#include <memory>

#include "failure.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "plots.hpp"
#include "report.hpp"
#include "run.hpp"
#include "tables.hpp"

namespace simulate {

namespace {

// Shows on a terminal how far the samples are.
class Progress {
 public:
  Progress(bool wanted, double duration, double period)
      : stride_(std::max<std::size_t>(1, static_cast<std::size_t>(duration / period) / 50)) {
    if (wanted && ::isatty(STDERR_FILENO) != 0)
      bar_ = std::make_unique<boost::timer::progress_display>(
          static_cast<unsigned long>(duration / period) + 1, std::cerr);
  }
  void step() {
    if (bar_ && ++since_ == stride_) {
      *bar_ += static_cast<unsigned long>(stride_);
      since_ = 0;
    }
  }

 private:
  std::unique_ptr<boost::timer::progress_display> bar_;
  std::size_t stride_;
  std::size_t since_ = 0;
};

std::unique_ptr<OutputFile> open(const std::optional<std::string>& path) {
  return path ? std::make_unique<OutputFile>(*path) : nullptr;
}

void print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0)
    throw Failure(Exit::other, "standard output cannot be written");
}

// Refuses what would not come to its end: a period or a number of steps that is a slip of the keyboard.
void check_size(const Plan& plan, const Options& options, const Machine& machine) {
  constexpr double most = 1e10;
  const double samples = plan.duration / options.period;
  if (!(samples <= most))
    throw Failure(Exit::bad_input, fmt::format("the program takes {:.6g} s, which is {:.3g} samples at a "
                                               "period of {:.6g} s: more than {:.0e}",
                                               plan.duration, samples, options.period, most));
  for (const MachineAxis& axis : machine.axes) {
    const double steps = plan.length * axis.drive.steps_per_unit;
    if (!(steps <= most))
      throw Failure(Exit::bad_input, fmt::format("a path of {:.6g} mm at {:.6g} steps of {} per mm: more "
                                                 "than {:.0e} steps",
                                                 plan.length, axis.drive.steps_per_unit, axis.letter, most));
  }
}

// At most so many points are drawn.
constexpr std::size_t drawn_points = 20000;

int run(const Options& options) {
  Machine machine;
  if (options.machine) machine = read_machine(*options.machine);
  const Program program = read_program(options.program, machine, options.limits);
  Measures measures;
  const Plan plan = make_plan(program, options, measures);
  check_size(plan, options, machine);
  if (options.plot) make_folder(*options.plot);

  const auto motions = open(options.motions), blocks = open(options.blocks), samples = open(options.samples),
             steps = open(options.steps);
  if (motions) write_motions(motions->stream(), program);
  if (blocks) write_blocks(blocks->stream(), program, plan);
  if (samples) write_samples_header(samples->stream());

  Progress progress(!options.quiet, plan.duration, options.period);
  std::vector<Sample> drawn;
  const auto every = static_cast<std::size_t>(plan.duration / options.period) / drawn_points + 1;
  make_samples(program, plan, options, measures, [&](const Sample& sample) {
    if (samples) write_sample(samples->stream(), program, sample);
    if (options.plot && (measures.samples % every == 0 || !(sample.time < plan.duration)))
      drawn.push_back(sample);
    progress.step();
  });
  measure_axes(program, plan, measures);

  if (steps) {
    std::vector<cncplan::step::Trace> traces;
    for (const MachineAxis& axis : machine.axes)
      traces.push_back({std::string(1, axis.letter), axis.drive.high_time, axis.drive.direction_setup});
    auto vcd = cncplan::step::vcd_writer(steps->stream(), traces);
    make_steps(program, plan, options, machine, measures, [&](const cncplan::step::Edge& edge) {
      if (!vcd.accept(edge)) throw Failure(Exit::other, "an edge came out of order");
    });
    vcd.finish();
  } else {
    make_steps(program, plan, options, machine, measures, [](const cncplan::step::Edge&) {});
  }

  const std::array files{motions.get(), blocks.get(), samples.get(), steps.get()};
  for (OutputFile* file : files)
    if (file != nullptr) file->finish();
  if (options.plot) draw(*options.plot, drawn);
  for (OutputFile* file : files)
    if (file != nullptr) file->commit();
  if (options.json)
    print(json_summary(program, plan, options, machine, measures));
  else if (!options.quiet)
    print(table_summary(program, plan, machine, measures));
  return static_cast<int>(Exit::done);
}

// One line, whatever it quotes.
void complain(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  fmt::print(stderr, "{}{}\n", text.find(": error: ") == std::string::npos ? "error: " : "", text);
}

}  // namespace

}  // namespace simulate

int main(int argc, char** argv) {
  try {
    const auto options = simulate::parse_options(argc, argv);
    return options ? simulate::run(*options) : 0;
  } catch (const simulate::Failure& failure) {
    simulate::complain(failure.what());
    return static_cast<int>(failure.code);
  } catch (const std::exception& error) {
    simulate::complain(error.what());
    return static_cast<int>(simulate::Exit::other);
  }
}
