// The reference integration, G-code in, step and direction out: reads a program, plans it, samples it, turns
// it into step edges, and says what it measured. Its options and outputs are the contract of
// docs/simulate.md.

#include <fmt/format.h>

#include <variant>

#include "execute.hpp"
#include "machine.hpp"
#include "options.hpp"
#include "serve/web_server.hpp"
#include "support/failure.hpp"
#include "support/main_program.hpp"
#include "support/report.hpp"

namespace simulate {

namespace {

using cncplan::SmoothLevel;
using support::Exit;
using support::Failure;

// An executor smooths in closed form unless another level is asked for, or a map has no such form.
void settle_for_executor(Options& options, bool mapped) {
  if (options.corner_tolerance < 0.0)
    throw Failure(Exit::bad_input, "--serve passes corners by --tolerance: it goes without --junction");
  if (options.tolerance > 0.0 && !options.smooth)
    options.smooth = mapped ? SmoothLevel::good : SmoothLevel::fast;
}

// Refuses what the options ask for and the machine cannot do.
void settle(Options& options, const support::Machine& machine) {
  const auto refuse = [](const char* why) { throw Failure(Exit::bad_input, why); };
  const bool writes =
      options.motions || options.blocks || options.samples || options.steps || options.plot || options.report;
  if (options.check && (writes || options.events || options.serve))
    refuse("--check plans nothing: it goes without outputs and events");
  if (options.serve && (writes || options.events || options.json || options.count_steps))
    refuse("--serve runs the program as it is: it goes without outputs and events");
  if (options.compare && !options.report) refuse("--compare goes with --report");
  if (options.orientation && !machine.map.has_tool_point_control())
    refuse("--orientation is for the five-axis machines that kinematics names");
  if (options.tool_length && machine.kinematics != Kinematics::tire_mold)
    refuse("--tool-length is for machines with a tilting axis");
  const bool as_planned = options.law == Law::seven && options.planning == Planning::span &&
                          options.interpolator == Interpolator::exact;
  if (options.events && !as_planned)
    refuse("--events goes with --profile seven, --plan span and --interpolator exact only");
  if (options.serve && !as_planned)
    refuse("--serve goes with --profile seven, --plan span and --interpolator exact only");
  if (options.compare.value_or(0.0) > 0.0 && (!as_planned || machine.kinematics == Kinematics::tire_mold))
    refuse("--compare above 0 is for what --tolerance above 0 is for");
  if (machine.kinematics == Kinematics::tire_mold && options.tolerance_given && options.tolerance > 0.0)
    refuse(
        "--tolerance above 0 is for programs that say where the tool goes: rows name the axes, and are "
        "driven "
        "exactly");
  const bool exact = machine.kinematics == Kinematics::tire_mold || machine.kinematics == Kinematics::polar;
  if (exact && !options.tolerance_given) options.tolerance = 0.0;
  const bool mapped = machine.kinematics == Kinematics::polar || machine.kinematics == Kinematics::mapped;
  if (options.serve) settle_for_executor(options, mapped);
  if (options.smooth && !(options.tolerance > 0.0)) refuse("--smooth goes with a --tolerance above 0");
  if (options.interpolator == Interpolator::taylor &&
      (machine.kinematics != Kinematics::cartesian || machine.axes.size() > 3))
    refuse("--interpolator taylor is for machines of X, Y and Z");
}

int run(Options options) {
  support::Machine file;
  if (options.machine) file = support::read_machine(*options.machine);
  settle(options, file);
  if (options.report || options.serve) support::check_report_libraries();
  if (options.serve) serve::check_libraries();
  using cncplan::tools::with_axes;
  switch (file.kinematics) {
    case Kinematics::cartesian:
      if (const auto ok = cncplan::tools::fits(file, 6); !ok)
        throw Failure(Exit::bad_input, fmt::format("{}: error: {}", *options.machine, to_text(ok.error())));
      if (file.axes.size() > 3) return execute(options, file, with_axes(Mill<6>{}, file, options.limits));
      return execute(options, file, with_axes(Mill<3>{}, file, options.limits));
    case Kinematics::tire_mold: {
      auto machine = with_axes(Rows{}, file, options.limits);
      machine.tool_length = options.tool_length.value_or(0.0);
      return execute(options, file, machine);
    }
    case Kinematics::polar:
    case Kinematics::mapped:
      break;
  }
  const support::Machine mapped = support::with_table_map(file);
  file.map = mapped.map;
  return std::visit(
      [&]<class Map>(const Map& map) {
        return execute(options, file, with_axes(Mapped<Map>{.map = map}, mapped, options.limits));
      },
      mapped.map.map);
}

}  // namespace

}  // namespace simulate

int main(int argc, char** argv) {
  return support::main_program([&] {
    const auto options = simulate::parse_options(argc, argv);
    return options ? simulate::run(*options) : 0;
  });
}
